#include "io/read/text_file.h"

#include "io/read/input_file.h"

namespace hindsight {

std::string ReadTextFile(const std::string& path) {
  const InputFile file(path);
  std::string text(file.size(), '\0');
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t count =
        file.ReadAt(begin, text.data() + begin, text.size() - begin);
    if (count == 0) break;
    begin += count;
  }
  text.resize(begin);
  return text;
}

}  // namespace hindsight
