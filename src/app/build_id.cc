#include "app/build_id.h"

#include <elf.h>
#include <fmt/core.h>
#include <link.h>

#include <cstdint>
#include <cstring>
#include <string_view>

namespace hindsight {
namespace {

constexpr std::size_t kAlignment = 4;

std::size_t Aligned(std::size_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

/// The identifier among the notes of a segment.
std::string FindIn(std::string_view notes) {
  while (notes.size() > sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head = {};
    std::memcpy(&head, notes.data(), sizeof head);
    const std::size_t name = sizeof head;
    const std::size_t value = name + Aligned(head.n_namesz);
    const std::size_t end = value + Aligned(head.n_descsz);
    if (end > notes.size()) break;
    if (head.n_type == NT_GNU_BUILD_ID &&
        notes.substr(name, head.n_namesz) == std::string_view("GNU\0", 4)) {
      std::string text;
      for (const char byte : notes.substr(value, head.n_descsz)) {
        text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
      }
      return text;
    }
    notes.remove_prefix(end);
  }
  return "";
}

/// Of the program, which is the first object; the libraries have their own.
int Take(dl_phdr_info* object, std::size_t, void* text) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* notes =
        // NOLINTNEXTLINE(performance-no-int-to-ptr): where the loader put it
        reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
    const std::string id = FindIn({notes, segment.p_memsz});
    if (!id.empty()) *static_cast<std::string*>(text) = id;
  }
  return 1;
}

}  // namespace

std::string BuildId() {
  std::string id;
  dl_iterate_phdr(Take, &id);
  return id;
}

}  // namespace hindsight
