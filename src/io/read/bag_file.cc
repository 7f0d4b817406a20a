#include "io/read/bag_file.h"

#include <array>
#include <cstring>
#include <map>
#include <type_traits>

#include "base/error.h"
#include "io/read/unpack.h"

namespace hindsight {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

enum Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndexData = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

using BagFields = std::map<std::string, std::string, std::less<>>;

std::uint32_t BagWord(std::string_view bytes) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data(), sizeof(word));
  return word;
}

/// Takes `count` bytes from the front of `bytes`; false if there are fewer.
bool Cut(std::size_t count, std::string_view* bytes, std::string_view* front) {
  if (count > bytes->size()) return false;
  *front = bytes->substr(0, count);
  bytes->remove_prefix(count);
  return true;
}

/// Takes a length and that many bytes.
bool CutSized(std::string_view* bytes, std::string_view* front) {
  std::string_view length;
  return Cut(4, bytes, &length) && Cut(BagWord(length), bytes, front);
}

/// "name=value", each behind its length.
bool ParseBagFields(std::string_view bytes, BagFields* fields) {
  while (!bytes.empty()) {
    std::string_view field;
    if (!CutSized(&bytes, &field)) return false;
    const std::size_t equals = field.find('=');
    if (equals == field.npos) return false;
    fields->emplace(field.substr(0, equals), field.substr(equals + 1));
  }
  return true;
}

}  // namespace

struct BagFile::Record {
  const BagFile* bag = nullptr;
  BagFields fields;
  std::string held;  ///< the data of a record read from the file
  std::string_view data;

  std::string_view Text(std::string_view name) const {
    const auto found = fields.find(name);
    if (found == fields.end()) {
      bag->Fail("a record has no " + std::string(name));
    }
    return found->second;
  }
  template <typename T>
  T Number(std::string_view name) const {
    const std::string_view text = Text(name);
    if (text.size() != sizeof(T)) {
      bag->Fail("a record has a damaged " + std::string(name));
    }
    T number;
    std::memcpy(&number, text.data(), sizeof(T));
    return number;
  }
  std::uint8_t op() const { return Number<std::uint8_t>("op"); }
};

void BagFile::Fail(const std::string& what) const {
  throw InputError(path(), 0, "cannot be read as a ROS 1 bag: " + what);
}

BagFile::BagFile(const std::string& path) : file_(path) {
  std::array<char, kBagMagic.size()> magic;
  const std::size_t count = file_.ReadAt(0, magic.data(), magic.size());
  if (count == 0) throw InputError(path, 0, "the file is empty");
  const std::string_view start(magic.data(), count);
  if (start != kBagMagic) {
    Fail(start.starts_with("#ROSBAG") ? "expected version 2.0"
                                      : "expected '#ROSBAG V2.0' at its start");
  }
  first_ = kBagMagic.size();
  const Record header = ReadRecord(&first_, file_.size());
  if (header.op() != kBagHeader) Fail("it has no header");
  const auto encryptor = header.fields.find("encryptor");
  if (encryptor != header.fields.end() && !encryptor->second.empty()) {
    Fail("it is encrypted");
  }
  const auto index = header.Number<std::uint64_t>("index_pos");
  if (index == 0) {
    Fail("it was not closed and has no index (rosbag reindex makes one)");
  }
  if (index < first_ || index > file_.size()) Fail("it is cut off");
  index_ = static_cast<std::size_t>(index);
  ReadIndex();
  if (connections_.size() != header.Number<std::uint32_t>("conn_count")) {
    Fail("it is cut off within its index");
  }
  const std::size_t chunks = header.Number<std::uint32_t>("chunk_count");
  if (chunks_ != chunks) {
    Fail("its index tells of " + std::to_string(chunks_) +
         " chunks, its header of " + std::to_string(chunks));
  }
}

void BagFile::ReadChunkInfo(const Record& record) {
  ++chunks_;
  std::string_view data = record.data;
  const std::uint64_t count = record.Number<std::uint32_t>("count");
  if (data.size() != 8 * count) Fail("its index is damaged");
  for (; !data.empty(); data.remove_prefix(8)) {
    const std::uint64_t messages = BagWord(data.substr(4));
    if (messages > 0) messages_[BagWord(data)] += messages;
  }
}

void BagFile::ReadIndex() {
  for (std::size_t offset = index_; offset < file_.size();) {
    const Record record = ReadRecord(&offset, file_.size());
    if (record.op() == kChunkInfo) {
      ReadChunkInfo(record);
      continue;
    }
    if (record.op() != kConnection) {
      Fail("its index holds a record that is none of an index");
    }
    BagFields fields;
    if (!ParseBagFields(record.data, &fields)) Fail("a connection is damaged");
    connections_.push_back({record.Number<std::uint32_t>("conn"),
                            std::string(record.Text("topic")), fields["type"]});
  }
}

BagFile::Record BagFile::ReadRecord(std::size_t* offset,
                                    std::size_t end) const {
  Record record;
  record.bag = this;
  const auto read = [&] {
    std::array<char, 4> length;
    if (end - *offset < length.size()) Fail("it is cut off");
    file_.ReadAt(*offset, length.data(), length.size());
    *offset += length.size();
    const std::size_t size = BagWord({length.data(), length.size()});
    if (end - *offset < size) Fail("it is cut off");
    std::string bytes(size, '\0');
    file_.ReadAt(*offset, bytes.data(), size);
    *offset += size;
    return bytes;
  };
  if (!ParseBagFields(read(), &record.fields)) Fail("a record is damaged");
  record.held = read();
  record.data = record.held;
  return record;
}

BagFile::Record BagFile::ParseRecord(std::string_view* bytes) const {
  Record record;
  record.bag = this;
  std::string_view header;
  if (!CutSized(bytes, &header) || !ParseBagFields(header, &record.fields) ||
      !CutSized(bytes, &record.data)) {
    Fail("a record within a chunk is damaged");
  }
  return record;
}

std::string BagFile::Unpack(const Record& chunk) const {
  const std::string_view compression = chunk.Text("compression");
  const std::size_t size = chunk.Number<std::uint32_t>("size");
  std::optional<std::string> bytes;
  if (compression == "none") {
    if (chunk.data.size() == size) bytes = chunk.data;
  } else if (compression == "bz2") {
    bytes = UnpackBz2(chunk.data, size);
  } else if (compression == "lz4") {
    bytes = UnpackLz4(chunk.data, size);
  } else {
    Fail("a chunk has the compression '" + std::string(compression) +
         "'; expected none, bz2 or lz4");
  }
  if (!bytes) Fail("a chunk is damaged");
  return std::move(*bytes);
}

void BagFile::Visit(const Take& take) const {
  MessageCounts found;
  std::size_t chunks = 0;
  for (std::size_t offset = first_; offset < index_;) {
    const Record chunk = ReadRecord(&offset, index_);
    if (chunk.op() == kIndexData) continue;
    if (chunk.op() != kChunk) {
      Fail("it holds a record that is neither a chunk nor its index");
    }
    ++chunks;
    const std::string bytes = Unpack(chunk);
    for (std::string_view rest = bytes; !rest.empty();) {
      const Record record = ParseRecord(&rest);
      if (record.op() == kConnection) continue;
      if (record.op() != kMessage) {
        Fail(
            "a chunk holds a record that is neither a message nor a "
            "connection");
      }
      constexpr std::uint64_t kSecond = 1'000'000'000;
      const auto time = record.Number<std::uint64_t>("time");
      const auto connection = record.Number<std::uint32_t>("conn");
      ++found[connection];
      take(connection, (time & 0xffffffff) * kSecond + (time >> 32),
           record.data);
    }
  }
  if (chunks != chunks_) {
    Fail("it holds " + std::to_string(chunks) + " chunks, its index tells of " +
         std::to_string(chunks_));
  }
  if (found != messages_) FailOfMessages(found);
}

void BagFile::FailOfMessages(const MessageCounts& found) const {
  const auto of = [](const MessageCounts& counts, std::uint32_t connection) {
    const auto at = counts.find(connection);
    return std::to_string(at == counts.end() ? 0 : at->second);
  };
  for (const BagConnection& connection : connections_) {
    const std::uint32_t id = connection.id;
    if (of(found, id) == of(messages_, id)) continue;
    Fail("it holds " + of(found, id) + " messages of " + connection.topic +
         ", its index tells of " + of(messages_, id));
  }
  Fail("it holds messages of a connection that it has not");
}

}  // namespace hindsight
