#ifndef HINDSIGHT_TESTS_IO_DAMAGES_OF_FORMATS_H_
#define HINDSIGHT_TESTS_IO_DAMAGES_OF_FORMATS_H_

// What single formats can have wrong; included by damages.h.

#include <string>
#include <vector>

#include "io/damages.h"

namespace hindsight {

inline std::string ReplacedIn(std::string text, const std::string& from,
                              const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline void DamageList::AddRows() {
  const bool oxts = stream_.encoding == Encoding::kOxts;
  const bool bag = stream_.encoding == Encoding::kBag;
  const auto time = [&](Damage& damage) {
    // The error of a stamp is that of its epoch's file.
    if (oxts) damage.place = "oxts/data/0000000021.txt:1: ";
  };
  time(OfTable(
      "time backwards",
      [](TextRows* table) {
        std::swap(table->rows[kDamagedRow][0], table->rows[kDamagedRow + 1][0]);
      },
      Line(kDamagedRow + 1)));
  time(OfTable(
      "a time twice",
      [](TextRows* table) {
        table->rows[kDamagedRow + 1][0] = table->rows[kDamagedRow][0];
      },
      Line(kDamagedRow + 1)));
  OfTable("no rows", [](TextRows* table) { table->rows.clear(); });
  if (!bag) OfCell("a time of 1e300", 0, "1e300");
  if (IsText(stream_.encoding)) OfCell("text as time", 0, "noon");
  if (oxts) {
    OfTable("a stamp too few", [](TextRows* table) { table->rows.pop_back(); });
    OfTable(
        "a stamp too many",
        [](TextRows* table) {
          table->rows.push_back({"2017-01-01 00:00:02.000000000"});
        },
        kSampleRows + 1);
    OfCell("a stamp missing", 0, "");
    const auto first = [](const Path& path) {
      std::filesystem::remove(path.parent_path() / "data/0000000000.txt");
    };
    OfPath("the first epoch missing", first).line = 1;
    OfPath("the first epoch and the last stamp missing", [=, stream = stream_](
                                                             const Path& path) {
      first(path);
      TextRows table = stream.table;
      table.rows.pop_back();
      WriteAll(path, Encode(stream, table));
    }).line = 1;
    OfCell("a day that is none", 0, "2017-02-30 00:00:01.000000000");
    OfCell("a minute that is none", 0, "2017-01-01 00:61:01.000000000");
    return;
  }
  OfCell("not a number", stream_.value_column, "nan");
  OfCell("infinity", stream_.value_column, "inf");
  OfCell("a value of 1e300", stream_.value_column, "1e300");
  if (IsText(stream_.encoding)) {
    OfCell("text in a number", stream_.value_column, "1.2x4");
    OfCell("a number with a comma", stream_.value_column, "48,5");
    OfCell("an empty value", stream_.value_column, "");
  }
  if (IsImu()) {
    OfTable("a single row", [](TextRows* table) { table->rows.resize(1); });
    OfTable(
        "a gap",
        [](TextRows* table) {
          table->rows.erase(table->rows.begin() + kDamagedRow,
                            table->rows.begin() + kDamagedRow + 15);
        },
        Line(kDamagedRow));
  }
  if (stream_.encoding == Encoding::kNmea) return;
  OfTable("without its last column", [](TextRows* table) {
    for (auto& row : table->rows) row.pop_back();
    table->titles.pop_back();
  });
}

inline void DamageList::AddTable() {
  OfTable(
      "a column too few",
      [](TextRows* table) { table->rows[kDamagedRow].pop_back(); },
      Line(kDamagedRow));
  OfTable(
      "a column too many",
      [](TextRows* table) { table->rows[kDamagedRow].push_back("1.0"); },
      Line(kDamagedRow));
  OfTable(stream_.encoding == Encoding::kCsv ? "unknown column"
                                             : "a further column everywhere",
          [](TextRows* table) {
            table->titles.emplace_back("further[m]");
            for (auto& row : table->rows) row.emplace_back("1.000000");
          });
  const char delimiter = stream_.encoding == Encoding::kPlain
                             ? stream_.delimiter
                         : stream_.encoding == Encoding::kCsv ? ','
                                                              : ' ';
  OfBytes("another delimiter", [=](std::string bytes) {
    std::replace(bytes.begin(), bytes.end(), delimiter, '|');
    return bytes;
  });
  OfCell("an empty time", 0, "");
  OfCell("two numbers in one", stream_.value_column, "1.5 2.5");
  OfCell("a number in hexadecimal", stream_.value_column, "0x1A");
  OfBytes(
      "bytes that are no text",
      [line = Line(kDamagedRow)](std::string bytes) {
        std::size_t at = 0;
        for (int i = 1; i < line; ++i) at = bytes.find('\n', at) + 1;
        return bytes.replace(at, 4, "\xFF\xFE\xFD\xFC");
      },
      Line(kDamagedRow));
  if (stream_.table.rows.back().back().size() > 1) {
    OfBytes("cut within its last number, which another is as short as",
            [stream = stream_](const std::string&) {
              TextRows table = stream.table;
              table.rows[kDamagedRow].back().pop_back();
              table.rows.back().back().pop_back();
              std::string bytes = Encode(stream, table);
              bytes.pop_back();
              return bytes;
            });
  }
  OfTable(
      "a row cut short before a comment",
      [](TextRows* table) {
        auto& row = table->rows[kDamagedRow];
        row.back() = row.back().substr(0, 1) + " # 3";
      },
      Line(kDamagedRow));
}

inline void DamageList::AddHeader() {
  const auto titles = [this](const std::string& name,
                             const std::function<void(TextRows*)>& change) {
    OfTable(name, change, 1);
  };
  titles("a title twice", [](TextRows* table) {
    table->titles.back() = table->titles[table->titles.size() - 2];
  });
  titles("a unit of another quantity", [](TextRows* table) {
    std::string& title = table->titles[1];
    title = title.substr(0, title.find('[')) + "[Hz]";
  });
  titles("a unit that is none", [](TextRows* table) {
    std::string& title = table->titles[1];
    title = title.substr(0, title.find('[')) + "[furlong]";
  });
  titles("no unit", [](TextRows* table) {
    std::string& title = table->titles[1];
    title = title.substr(0, title.find('['));
  });
  OfBytes("no titles", [](const std::string& bytes) {
    return bytes.substr(bytes.find('\n') + 1);
  });
  OfTable("a title misspelt",
          [](TextRows* table) { table->titles[1] = "x" + table->titles[1]; });
  OfTable(
      "titles again",
      [](TextRows* table) {
        table->rows.insert(table->rows.begin() + kDamagedRow, table->titles);
      },
      Line(kDamagedRow));
}

inline void DamageList::AddNmea() {
  const int line = Line(kDamagedRow);
  const auto in_line = [&](const std::string& name, const Change& change) {
    OfBytes(
        name,
        [=](std::string bytes) {
          std::size_t at = 0;
          for (int i = 1; i < line; ++i) at = bytes.find('\n', at) + 1;
          const std::size_t end = bytes.find('\n', at);
          return bytes.replace(at, end - at,
                               change(bytes.substr(at, end - at)));
        },
        line);
  };
  in_line("a wrong checksum", [](std::string s) {
    s[10] = s[10] == '1' ? '2' : '1';
    return s;
  });
  in_line("no checksum",
          [](const std::string& s) { return s.substr(0, s.find('*')); });
  in_line("no dollar sign", [](const std::string& s) { return s.substr(1); });
  in_line("half a sentence",
          [](const std::string& s) { return s.substr(0, s.size() / 2); });
  in_line("two sentences in a line",
          [](const std::string& s) { return s + s; });
  OfCell("a time of 25 h", 0, "250000.000");
  OfCell("a time of 61 min", 0, "006100.000");
  OfTable("a further field", [](TextRows* table) {
    for (auto& row : table->rows) row.emplace_back("1");
  });
}

inline void DamageList::AddEpoch() {
  // Of the specific force along the vehicle's x axis.
  const auto value = [this](const std::string& name, const std::string& text) {
    OfBytes(
        name,
        [=](std::string bytes) {
          std::size_t at = 0;
          for (int i = 0; i < 11; ++i) at = bytes.find(' ', at) + 1;
          return bytes.replace(at, bytes.find(' ', at) - at, text);
        },
        1);
  };
  value("not a number", "nan");
  value("infinity", "inf");
  value("text in a number", "1.2x4");
  value("a number with a comma", "48,5");
  value("a value of 1e300", "1e300");
  value("a value of 1e7", "1e7");
  value("an empty value", "");
  value("two numbers in one", "1 2");
  value("a number in hexadecimal", "0x1A");
  OfBytes(
      "a second epoch", [](const std::string& bytes) { return bytes + bytes; },
      2);
  OfBytes(
      "semicolons",
      [](std::string bytes) {
        std::replace(bytes.begin(), bytes.end(), ' ', ';');
        return bytes;
      },
      1);
  OfBytes("an empty line before",
          [](const std::string& bytes) { return "\n" + bytes; });
  OfPath("a name that is no number", [](const Path& path) {
    std::filesystem::rename(path, path.parent_path() / "x.txt");
  }).place = "oxts/data/x.txt: ";
  OfPath("a number twice", [](const Path& path) {
    std::filesystem::copy(path, path.parent_path() / "20.txt");
  }).place = "oxts/data/20.txt: ";
  OfPath("a file too many", [](const Path& path) {
    std::filesystem::copy(path, path.parent_path() / "0000000040.txt");
  }).place = "oxts/timestamps.txt: ";
}

inline void DamageList::AddNpy() {
  const auto header = [this](const std::string& name, const std::string& from,
                             const std::string& to) {
    OfBytes(name, [=](const std::string& bytes) {
      return ReplacedIn(bytes, from, to);
    });
  };
  header("big-endian", "<f8", ">f8");
  header("complex numbers", "<f8", "<c8");
  header("a structure", "'<f8'", "[('t'");
  header("three dimensions", "(40, 7)", "(8,5,7)");
  header("another shape", "(40, 7)", "(41, 7)");
  header("a shape without end", "(40, 7)", "(40, 7 ");
  header("no order", "False", "Maybe");
  header("no type", "'descr'", "'decsr'");
  header("a version of its own", std::string("Y\x01", 2),
         std::string("Y\x07", 2));
  OfBytes("a header beyond the end", [](std::string bytes) {
    bytes[9] = '\x7f';
    return bytes;
  });
}

inline void DamageList::AddMat() {
  const TextCells rows = stream_.table.rows;
  const auto file = [this](const std::string& name,
                           const std::string& elements) {
    OfBytes(name, [=](const std::string&) { return MatFile(elements); });
  };
  const std::string zeros(8 * 7 * kSampleRows, '\0');
  const auto matrix = [&](std::uint32_t array_class, const std::string& parts) {
    return MatMatrix("data", array_class, kSampleRows, 7, parts);
  };
  file("a sparse matrix", matrix(5, MatElement(5, BytesOf(0)) +
                                        MatElement(5, zeros.substr(0, 32)) +
                                        MatElement(9, zeros.substr(0, 8))));
  file("text", matrix(4, MatElement(4, zeros.substr(0, 2 * 7 * kSampleRows))));
  file("a complex matrix",
       matrix(6 | 0x0800, MatElement(9, zeros) + MatElement(9, zeros)));
  file("a cell array", matrix(1, ""));
  file("a structure", matrix(2, ""));
  file("a class that is none", matrix(99, MatElement(9, zeros)));
  file("numbers that are none", matrix(6, MatElement(77, zeros)));
  file("values missing", matrix(6, MatElement(9, zeros.substr(800))));
  file("no values", matrix(6, ""));
  file("integers stored as floating-point numbers",
       matrix(12, MatElement(7, zeros.substr(zeros.size() / 2))));
  file("values behind its values",
       matrix(6, MatElement(9, zeros) + MatElement(9, zeros.substr(0, 8))));
  const std::string data = MatDoubles("data", rows);
  file("the variable twice", data + data);
  file("another variable twice",
       data + MatDoubles("other", rows) + MatDoubles("other", rows));
  for (const std::size_t count : {1u, 8u, 64u, 4096u}) {
    file(std::to_string(count) + " zeros behind it",
         data + std::string(count, '\0'));
  }
  file("something that is no variable", MatElement(9, zeros) + data);
  file("compressed numbers that are no variable",
       data + MatCompressed(MatElement(9, zeros)));
  file("another variable", MatBytes({{"date", rows}}).substr(128));
  OfBytes("version 7.3", [](std::string bytes) {
    bytes.at(125) = '\x02';
    return bytes;
  });
  OfBytes("without 800 bytes", [](const std::string& bytes) {
    return bytes.substr(0, bytes.size() - 800);
  });
  const std::string packed = MatCompressed(MatDoubles("data", rows));
  file("compressed, damaged",
       ReplacedIn(packed, packed.substr(packed.size() / 2, 4), "oops"));
  file("compressed, cut off", packed.substr(0, packed.size() - 20));
}

inline void DamageList::AddBag() {
  const auto replaced = [this](const std::string& name, const std::string& from,
                               const std::string& to) {
    OfBytes(name, [=](const std::string& bytes) {
      return ReplacedIn(bytes, from, to);
    });
  };
  replaced("version 1.2", "V2.0", "V1.2");
  replaced("a compression that is none", "=none", "=lzma");
  OfBytes("another type of message", [](std::string bytes) {
    return bytes.replace(bytes.rfind("sensor_msgs/Imu"), 15, "sensor_msgs/Xmu");
  });
  replaced("no connection", "conn_count=\x01",
           std::string("conn_count=\0", 12));
  replaced("a message of another length", Sized("imu"),
           std::string("\x02\0\0\0imu", 7));
  OfBytes("never closed", [](std::string bytes) {
    const std::size_t at = bytes.find("index_pos=") + 10;
    return bytes.replace(at, 8, 8, '\0');
  });
  OfBytes("an index beyond the end", [](std::string bytes) {
    bytes[bytes.find("index_pos=") + 13] = '\x7f';
    return bytes;
  });
  const auto of_message = [this](const std::string& name, const char* op) {
    OfBytes(name, [=](std::string bytes) {
      return bytes.replace(bytes.rfind("op=\x02"), 4, op);
    });
  };
  of_message("a message of another kind of record", "op=\x22");
  of_message("a message taken for a connection", "op=\x07");
  of_message("a message taken for an index", "op=\x04");
  replaced("a chunk of another kind of record", "op=\x05", "op=\x55");
  replaced("a chunk too many", "chunk_count=\x01", "chunk_count=\x02");
  const auto of_index = [this](
                            const std::string& name,
                            const std::function<void(std::string*)>& change) {
    OfBytes(name, [=](std::string bytes) {
      change(&bytes);
      return bytes;
    });
  };
  of_index("a message more in the index",
           [](std::string* bytes) { ++(*bytes)[bytes->size() - 4]; });
  of_index("another connection in the index",
           [](std::string* bytes) { ++(*bytes)[bytes->size() - 8]; });
  of_index("no chunk in the index", [](std::string* bytes) {
    bytes->resize(bytes->size() - BagChunkInfo(kSampleRows).size());
  });
  of_index("a chunk twice in the index",
           [](std::string* bytes) { *bytes += BagChunkInfo(kSampleRows); });
  of_index("a foreign record behind the index", [](std::string* bytes) {
    *bytes += BagRecord({{"op", "\x66"}}, "foreign");
  });
  OfBytes("a record of 4 GB", [](std::string bytes) {
    const std::size_t at = bytes.rfind("op=\x02");
    return bytes.replace(at - 8, 4, "\xFF\xFF\xFF\xFF");
  });
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_DAMAGES_OF_FORMATS_H_
