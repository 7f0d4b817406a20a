#ifndef HINDSIGHT_TESTS_IO_DAMAGES_H_
#define HINDSIGHT_TESTS_IO_DAMAGES_H_

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "io/sample_streams.h"

namespace hindsight {

/// One thing that can be wrong with a stream's file.
struct Damage {
  std::string name;
  /// Does it to the sound files in the folder.
  std::function<void(const std::filesystem::path& folder)> apply;
  int line = 0;       ///< that the error must name; 0: of the whole file
  std::string place;  ///< that it must name instead of the stream's file
  std::string file;   ///< for the configuration instead of the stream's
};

/// The row that is damaged where one is.
constexpr int kDamagedRow = 20;

class DamageList {
 public:
  explicit DamageList(const SampleStream& stream) : stream_(stream) {}

  std::vector<Damage> Make() {
    AddPaths();
    AddBytes();
    if (IsText(stream_.encoding)) AddText();
    if (!stream_.table.rows.empty() && !IsEpoch()) AddRows();
    if (IsTable(stream_.encoding)) AddTable();
    if (stream_.encoding == Encoding::kCsv) AddHeader();
    if (stream_.encoding == Encoding::kNmea) AddNmea();
    if (IsEpoch()) AddEpoch();
    if (stream_.encoding == Encoding::kNpy) AddNpy();
    if (stream_.encoding == Encoding::kMat) AddMat();
    if (stream_.encoding == Encoding::kBag) AddBag();
    return std::move(damages_);
  }

 private:
  using Path = std::filesystem::path;
  using Change = std::function<std::string(std::string)>;

  bool IsEpoch() const {
    return stream_.file.find("data/") != std::string::npos;
  }
  bool IsImu() const { return stream_.keys.starts_with("imu:"); }
  int Line(int row) const { return LineOf(stream_, row); }

  static std::string ReadAll(const Path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void WriteAll(const Path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }

  /// Of the file's path.
  Damage& OfPath(const std::string& name,
                 const std::function<void(const Path&)>& change) {
    const std::string file = stream_.file;
    damages_.push_back(
        {name, [=](const Path& folder) { change(folder / file); }, 0, "", ""});
    return damages_.back();
  }
  Damage& OfBytes(const std::string& name, const Change& change, int line = 0) {
    Damage& damage = OfPath(
        name, [=](const Path& path) { WriteAll(path, change(ReadAll(path))); });
    damage.line = line;
    return damage;
  }
  Damage& OfTable(const std::string& name,
                  const std::function<void(TextRows*)>& change, int line = 0) {
    const SampleStream stream = stream_;
    return OfBytes(
        name,
        [=](const std::string&) {
          TextRows table = stream.table;
          change(&table);
          return Encode(stream, table);
        },
        line);
  }
  /// A cell of the damaged row.
  Damage& OfCell(const std::string& name, std::size_t column,
                 const std::string& value) {
    return OfTable(
        name,
        [=](TextRows* table) { table->rows[kDamagedRow][column] = value; },
        Line(kDamagedRow));
  }

  void AddPaths() {
    namespace fs = std::filesystem;
    const auto removed = [this](const std::string& name,
                                const std::function<void(const Path&)>& put) {
      OfPath(name, [=](const Path& path) {
        fs::remove(path);
        put(path);
      });
    };
    removed("no file", [](const Path&) {});
    removed("a link to nothing",
            [](const Path& path) { fs::create_symlink("nowhere", path); });
    removed("a folder", [](const Path& path) { fs::create_directory(path); });
    removed("a pipe", [](const Path& path) { mkfifo(path.c_str(), 0600); });
    removed("a device",
            [](const Path& path) { fs::create_symlink("/dev/zero", path); });
    removed("a link to itself", [](const Path& path) {
      fs::create_symlink(path.filename(), path);
    });
    if (IsEpoch()) {
      damages_[0].place = "oxts/timestamps.txt:21: ";
    } else if (geteuid() != 0) {
      OfPath("a file of others",
             [](const Path& path) { chmod(path.c_str(), 0); });
    }
    if (stream_.encoding == Encoding::kOxts) return;
    const std::string other = "other.bin";
    OfPath("another extension", [=](const Path& path) {
      fs::rename(path, path.parent_path() / other);
    }).file = other;
  }

  void AddBytes() {
    OfBytes("no bytes", [](const std::string&) { return std::string(); });
    OfBytes("an empty line",
            [](const std::string&) { return std::string("\n"); });
    OfBytes("the first half", [this_half = Half()](const std::string& bytes) {
      return bytes.substr(0, this_half(bytes));
    });
    OfBytes("without its last bytes", [](std::string bytes) {
      bytes.resize(bytes.size() - 4);
      return bytes;
    });
    OfBytes("one byte more",
            [](const std::string& bytes) { return bytes + '7'; });
    OfBytes("the file twice",
            [](const std::string& bytes) { return bytes + bytes; });
    OfBytes("binary rubbish", [](std::string bytes) {
      unsigned x = 12345;
      for (char& c : bytes) {
        x ^= x << 13, x ^= x >> 17, x ^= x << 5;
        c = static_cast<char>(x);
      }
      return bytes;
    });
    OfBytes("nothing but zeros", [](const std::string& bytes) {
      return std::string(bytes.size(), '\0');
    });
    OfBytes("zeros at its end", [](std::string bytes) {
      std::fill(bytes.end() - static_cast<long>(bytes.size() / 5), bytes.end(),
                '\0');
      return bytes;
    });
    OfBytes("UTF-16", [](const std::string& bytes) {
      std::string wide = "\xFF\xFE";
      for (const char c : bytes) wide += {c, '\0'};
      return wide;
    });
    OfBytes("byte order mark",
            [](const std::string& bytes) { return "\xEF\xBB\xBF" + bytes; });
    OfBytes("another kind of file", [imu = IsImu()](const std::string&) {
      return imu ? std::string("t[s],lat[deg],lon[deg],h[m]\n0,48,11,500\n")
                 : std::string("t[s],gyro_x[rad/s],gyro_y[rad/s]\n0,0,0\n");
    });
    OfBytes("gzip", Gzipped);
    OfBytes("gzip cut off", [](const std::string& bytes) {
      const std::string packed = Gzipped(bytes);
      return packed.substr(0, packed.size() - 9);
    });
    OfBytes("gzip with another byte in it", [](const std::string& bytes) {
      std::string packed = Gzipped(bytes);
      packed[packed.size() / 2] = static_cast<char>(~packed[packed.size() / 2]);
      return packed;
    });
    OfBytes("gzip and text behind it", [](const std::string& bytes) {
      return Gzipped(bytes) + bytes.substr(0, 40);
    });
    OfBytes("gzip and zeros behind it", [](const std::string& bytes) {
      return Gzipped(bytes) + std::string(512, '\0');
    });
    OfBytes("gzip within gzip",
            [](const std::string& bytes) { return Gzipped(Gzipped(bytes)); });
  }

  /// Where a half ends, of text within a number.
  std::function<std::size_t(const std::string&)> Half() const {
    const bool text = IsText(stream_.encoding);
    return [text](const std::string& bytes) {
      const std::size_t half = bytes.size() / 2;
      return text ? bytes.find_first_of("123456789", half + 12) : half;
    };
  }

  void AddText() {
    if (!IsEpoch()) {
      OfBytes("mixed line ends", [](const std::string& bytes) {
        std::string mixed;
        int line = 0;
        for (const char c : bytes) {
          if (c == '\n' && ++line % 2 == 0) mixed += '\r';
          mixed += c;
        }
        return mixed;
      });
    }
    if (!IsEpoch()) {
      OfBytes("CR alone as line end", [](std::string bytes) {
        std::replace(bytes.begin(), bytes.end(), '\n', '\r');
        return bytes + "\n";
      });
    }
    const int line = IsEpoch() ? 2 : Line(kDamagedRow);
    const auto insert = [line](std::string bytes, const std::string& text) {
      std::size_t at = 0;
      for (int i = 1; i < line; ++i) at = bytes.find('\n', at) + 1;
      return bytes.insert(at, text + "\n");
    };
    OfBytes(
        "a line of words",
        [=](const std::string& bytes) { return insert(bytes, "some words"); },
        line);
    OfBytes(
        "a line of 2 MB",
        [=](const std::string& bytes) {
          return insert(bytes, std::string(2u << 20, '1'));
        },
        line);
    OfBytes(
        "a NUL byte in a line",
        [=](const std::string& bytes) {
          return insert(bytes, std::string("1,\0 2", 5));
        },
        line);
  }

  void AddRows();
  void AddTable();
  void AddHeader();
  void AddNmea();
  void AddEpoch();
  void AddNpy();
  void AddMat();
  void AddBag();

  const SampleStream& stream_;
  std::vector<Damage> damages_;
};

inline std::vector<Damage> Damages(const SampleStream& stream) {
  return DamageList(stream).Make();
}

}  // namespace hindsight

#include "io/damages_of_formats.h"

#endif  // HINDSIGHT_TESTS_IO_DAMAGES_H_
