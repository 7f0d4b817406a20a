#ifndef HINDSIGHT_TESTS_IO_SAMPLE_STREAMS_H_
#define HINDSIGHT_TESTS_IO_SAMPLE_STREAMS_H_

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "io/binary_files.h"

namespace hindsight {

/// A table as text, for any format to encode: titles with units and rows whose
/// first column is the time.
struct TextRows {
  std::vector<std::string> titles;
  std::vector<std::vector<std::string>> rows;
};

/// How a format writes a table, and what it has that can be damaged.
enum class Encoding {
  kCsv,
  kPlain,
  kPos,
  kNmea,
  kGpx,
  kOxts,
  kNpy,
  kMat,
  kBag
};

inline bool IsText(Encoding e) { return e <= Encoding::kOxts; }
/// Its rows are lines of fields behind delimiters.
inline bool IsTable(Encoding e) { return e <= Encoding::kPos; }

/// One stream of a recording in one format.
struct SampleStream {
  std::string name;
  Encoding encoding = Encoding::kCsv;
  std::string file;  ///< that a damage hits, below the configuration's folder
  /// Its keys: "imu:" or "aiding:" or "truth:" and on, with FILE for `file`.
  std::string keys;
  TextRows table;
  char delimiter = ',';
  std::size_t value_column = 1;  ///< that is read, from 0
  std::string error = {};        ///< held by the error of the undamaged stream
};

inline std::string Printed(double value, int digits = 6) {
  return fmt::format("{:.{}f}", value, digits);
}

constexpr int kSampleRows = 40;
constexpr double kSampleStep = 0.05;

/// Rows of the time and, about each of `values`, a little that differs.
inline TextRows MakeRows(const std::vector<std::string>& titles,
                         const std::vector<double>& values,
                         const std::function<std::string(double)>& time) {
  TextRows table;
  table.titles = titles;
  for (int i = 0; i < kSampleRows; ++i) {
    std::vector<std::string> row = {time(kSampleStep * i)};
    for (std::size_t j = 0; j < values.size(); ++j) {
      const double wave = 1e-6 * ((i * 7 + static_cast<int>(j) * 3) % 11);
      row.push_back(Printed(values[j] + wave));
    }
    table.rows.push_back(row);
  }
  return table;
}

inline std::string Seconds(double t) { return Printed(t, 3); }
/// Of 2017-01-01 0 h UTC, in units of 1/`ticks` s since 1970.
inline std::string UnixTicks(double t, long ticks) {
  return std::to_string(1483228800L * ticks +
                        std::lround(t * static_cast<double>(ticks)));
}

inline std::string Joined(const std::vector<std::string>& words, char by) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += by;
    line += word;
  }
  return line;
}

/// The lines of `table`, its titles in front if there is a header.
inline std::string Lines(const TextRows& table, char delimiter, bool header) {
  std::string text;
  if (header) text = Joined(table.titles, delimiter) + "\n";
  for (const auto& row : table.rows) text += Joined(row, delimiter) + "\n";
  return text;
}

/// t, lat, lon, h of a table as GGA, or t, speed, course as RMC.
inline std::string Nmea(const TextRows& table, bool rmc) {
  std::string text;
  for (const auto& row : table.rows) {
    std::string body;
    if (rmc) {
      body = "GPRMC," + Joined(row, ',');
      body.insert(body.find(',', 6) + 1, "A,4800.0,N,01100.0,E,");
      body += ",010117,,";
    } else {
      body = "GPGGA," + row[0] + "," + row[1] + ",N," + row[2] +
             ",E,4,12,0.8," + row[3] + ",M,47.0,M,,";
      for (std::size_t i = 4; i < row.size(); ++i) body += "," + row[i];
    }
    unsigned sum = 0;
    for (const char c : body) sum ^= static_cast<unsigned char>(c);
    text += fmt::format("${}*{:02X}\n", body, sum);
  }
  return text;
}

/// t, lat, lon, ele of a table as the points of a track.
inline std::string Gpx(const TextRows& table) {
  std::string text = "<gpx><trk><trkseg>\n";
  for (const auto& row : table.rows) {
    text += "<trkpt lat=\"" + row[1] + "\" lon=\"" + row[2] + "\">";
    if (row.size() > 3) text += "<ele>" + row[3] + "</ele>";
    text += "<time>" + row[0] + "</time></trkpt>\n";
  }
  return text + "</trkseg></trk></gpx>\n";
}

/// The bytes of the stream's file, made of `table`.
inline std::string Encode(const SampleStream& stream, const TextRows& table) {
  switch (stream.encoding) {
    case Encoding::kCsv:
      return Lines(table, ',', true);
    case Encoding::kPlain:
      return Lines(table, stream.delimiter, false);
    case Encoding::kPos:
      return "%  GPST  latitude(deg) longitude(deg)  height(m)   Q  sdn(m)   "
             "sde(m)   sdu(m)\n" +
             Lines(table, ' ', false);
    case Encoding::kNmea:
      return Nmea(table, table.titles[1] == "speed");
    case Encoding::kGpx:
      return Gpx(table);
    case Encoding::kOxts: {
      // The stamps alone: an epoch's file is written apart.
      std::string text;
      for (const auto& row : table.rows) text += row[0] + "\n";
      return text;
    }
    case Encoding::kNpy:
      return NpyBytes(table.rows);
    case Encoding::kMat:
      return MatBytes({{"data", table.rows}});
    default:
      return BagBytes(table.rows);
  }
}

/// Line or row of the file in which a row of the table stands.
inline int LineOf(const SampleStream& stream, int row) {
  const bool header = stream.encoding == Encoding::kCsv ||
                      stream.encoding == Encoding::kPos ||
                      stream.encoding == Encoding::kGpx;
  return row + (header ? 2 : 1);
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_SAMPLE_STREAMS_H_
