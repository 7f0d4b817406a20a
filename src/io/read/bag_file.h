#ifndef HINDSIGHT_IO_READ_BAG_FILE_H_
#define HINDSIGHT_IO_READ_BAG_FILE_H_

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/input_file.h"

namespace hindsight {

/// One connection of a bag: messages of one type under one topic.
struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;  ///< "sensor_msgs/Imu"
};

/// A ROS 1 bag of version 2.0, its chunks plain, bz2 or lz4. Memory is that of
/// one chunk, as long as the file really makes it. Every function throws
/// InputError for a bag that is damaged, cut off, encrypted or was never
/// closed (it has no index: `rosbag reindex` makes one), and if its chunks and
/// connections are not as many as its header says.
class BagFile {
 public:
  explicit BagFile(const std::string& path);

  const std::string& path() const { return file_.path(); }
  const std::vector<BagConnection>& connections() const { return connections_; }

  /// Calls `take` for every message in the file's order: its connection, when
  /// it was received [ns] and its bytes. Throws InputError, at the latest
  /// behind the last, unless every connection has as many as the index says.
  using Take =
      std::function<void(std::uint32_t connection, std::uint64_t received,
                         std::string_view bytes)>;
  void Visit(const Take& take) const;

  [[noreturn]] void Fail(const std::string& what) const;

 private:
  struct Record;
  /// Messages of each connection that has some.
  using MessageCounts = std::map<std::uint32_t, std::uint64_t>;
  Record ReadRecord(std::size_t* offset, std::size_t end) const;
  Record ParseRecord(std::string_view* bytes) const;
  std::string Unpack(const Record& chunk) const;
  void ReadIndex();
  void ReadChunkInfo(const Record& record);
  [[noreturn]] void FailOfMessages(const MessageCounts& found) const;

  InputFile file_;
  std::size_t first_ = 0;  ///< offset of the first chunk
  std::size_t index_ = 0;  ///< offset of the index behind the last
  std::vector<BagConnection> connections_;
  std::size_t chunks_ = 0;  ///< of which the index tells
  MessageCounts messages_;  ///< by the index
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_BAG_FILE_H_
