#ifndef HINDSIGHT_TESTS_IO_BINARY_FILES_H_
#define HINDSIGHT_TESTS_IO_BINARY_FILES_H_

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace hindsight {

template <typename T>
std::string BytesOf(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

using TextCells = std::vector<std::vector<std::string>>;

inline double Cell(const TextCells& rows, std::size_t i, std::size_t j) {
  return j < rows[i].size() ? std::strtod(rows[i][j].c_str(), nullptr)
                            : std::nan("");
}

/// A .npy file of version 1 around `data`.
inline std::string NpyFile(const std::string& type, const std::string& shape,
                           const std::string& data) {
  std::string header = "{'descr': '" + type +
                       "', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize((10 + header.size() + 64) / 64 * 64 - 11, ' ');
  header += '\n';
  return "\x93NUMPY" + std::string("\x01\x00", 2) +
         BytesOf(static_cast<std::uint16_t>(header.size())) + header + data;
}

inline std::string NpyBytes(const TextCells& rows) {
  std::string data;
  const std::size_t columns = rows.empty() ? 1 : rows[0].size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) data += BytesOf(Cell(rows, i, j));
  }
  return NpyFile("<f8",
                 std::to_string(rows.size()) + ", " + std::to_string(columns),
                 data);
}

/// An element of a MATLAB file of version 5, padded.
inline std::string MatElement(std::uint32_t type, const std::string& data) {
  std::string bytes =
      BytesOf(type) + BytesOf(static_cast<std::uint32_t>(data.size())) + data;
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}

/// A matrix of class `array_class` (6: double) with `parts` behind its name.
inline std::string MatMatrix(const std::string& name, std::uint32_t array_class,
                             std::int32_t rows, std::int32_t columns,
                             const std::string& parts) {
  return MatElement(14, MatElement(6, BytesOf(array_class) + BytesOf(0)) +
                            MatElement(5, BytesOf(rows) + BytesOf(columns)) +
                            MatElement(1, name) + parts);
}

inline std::string MatFile(const std::string& elements) {
  std::string header = "MATLAB 5.0 MAT-file";
  header.resize(124, ' ');
  return header + std::string("\x00\x01IM", 4) + elements;
}

inline std::string MatCompressed(const std::string& element) {
  uLongf size = compressBound(element.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(element.data()), element.size());
  packed.resize(size);
  return BytesOf(std::uint32_t{15}) +
         BytesOf(static_cast<std::uint32_t>(size)) + packed;
}

/// A matrix of doubles, column by column.
inline std::string MatDoubles(const std::string& name, const TextCells& rows) {
  std::string data;
  const std::size_t columns = rows.empty() ? 1 : rows[0].size();
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      data += BytesOf(Cell(rows, i, j));
  }
  return MatMatrix(name, 6, static_cast<std::int32_t>(rows.size()),
                   static_cast<std::int32_t>(columns), MatElement(9, data));
}

inline std::string MatBytes(
    const std::vector<std::pair<std::string, TextCells>>& variables) {
  std::string elements;
  for (const auto& [name, rows] : variables) elements += MatDoubles(name, rows);
  return MatFile(elements);
}

inline std::string Sized(const std::string& bytes) {
  return BytesOf(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

/// "name=value" fields and data of a record of a ROS 1 bag.
inline std::string BagRecord(
    const std::vector<std::pair<std::string, std::string>>& fields,
    const std::string& data) {
  std::string header;
  for (const auto& [name, value] : fields) header += Sized(name + "=" + value);
  return Sized(header) + Sized(data);
}

/// What the index of a bag says of a chunk of connection 0.
inline std::string BagChunkInfo(std::size_t messages) {
  const std::string time(8, '\0');
  return BagRecord({{"op", "\x06"},
                    {"ver", BytesOf(std::uint32_t{1})},
                    {"chunk_pos", time},
                    {"start_time", time},
                    {"end_time", time},
                    {"count", BytesOf(std::uint32_t{1})}},
                   BytesOf(std::uint32_t{0}) +
                       BytesOf(static_cast<std::uint32_t>(messages)));
}

/// A bag of one topic of sensor_msgs/Imu: time [s since 1970], three rates,
/// three forces.
inline std::string BagBytes(const TextCells& rows) {
  const std::string id = BytesOf(std::uint32_t{0});
  const std::string connection =
      BagRecord({{"op", "\x07"}, {"conn", id}, {"topic", "/imu"}},
                Sized("topic=/imu") + Sized("type=sensor_msgs/Imu"));
  std::string chunk = connection;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t = std::strtod(rows[i][0].c_str(), nullptr);
    const auto seconds = static_cast<std::uint32_t>(t);
    const auto rest = static_cast<std::uint32_t>(
        std::llround(1e9 * (t - static_cast<double>(seconds))));
    const std::string stamp = BytesOf(seconds) + BytesOf(rest);
    std::string message =
        BytesOf(static_cast<std::uint32_t>(i)) + stamp + Sized("imu");
    const auto zeros = [&](std::size_t n) { message.append(8 * n, '\0'); };
    zeros(4 + 9);
    for (std::size_t j = 1; j < 4; ++j) message += BytesOf(Cell(rows, i, j));
    zeros(9);
    for (std::size_t j = 4; j < 7; ++j) message += BytesOf(Cell(rows, i, j));
    zeros(9);
    // Received in the order of the rows.
    const std::string received = BytesOf(std::uint32_t{1483228800}) +
                                 BytesOf(static_cast<std::uint32_t>(i));
    chunk +=
        BagRecord({{"op", "\x02"}, {"conn", id}, {"time", received}}, message);
  }
  const std::string body =
      BagRecord({{"op", "\x05"},
                 {"compression", "none"},
                 {"size", BytesOf(static_cast<std::uint32_t>(chunk.size()))}},
                chunk);
  const auto header = [&](std::size_t index) {
    return "#ROSBAG V2.0\n" +
           BagRecord({{"op", "\x03"},
                      {"index_pos", BytesOf(std::uint64_t{index})},
                      {"conn_count", BytesOf(std::uint32_t{1})},
                      {"chunk_count", BytesOf(std::uint32_t{1})}},
                     std::string(64, ' '));
  };
  return header(header(0).size() + body.size()) + body + connection +
         BagChunkInfo(rows.size());
}

inline std::string Gzipped(const std::string& text) {
  z_stream stream = {};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8,
               Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_BINARY_FILES_H_
