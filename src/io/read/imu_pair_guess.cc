#include "io/read/imu_pair_guess.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "base/error.h"
#include "io/read/column_choice.h"
#include "io/read/column_lines.h"
#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"
#include "io/read/file_format.h"

namespace hindsight {
namespace {

using HalfNames = std::vector<std::string>;

/// One file of the two.
struct HalfImu {
  HalfImu(std::string file, FileColumns numbers)
      : file_name(std::move(file)),
        name(numbers.row_word.column < 0 ? file_name : numbers.row_word.Name()),
        columns(std::move(numbers)),
        lines(columns) {}
  // `lines` speaks of `columns` where they are.
  HalfImu(const HalfImu&) = delete;
  HalfImu& operator=(const HalfImu&) = delete;

  std::string file_name;
  std::string name;  ///< of the file, or the word of its rows
  FileColumns columns;
  ColumnLines lines;
  std::string family = {};  ///< "gyro_" or "accel_"
  std::vector<double> t = {};
};

HalfNames AxesOf(const std::string& family) {
  return {family + "x", family + "y", family + "z"};
}

/// Its stamps and which half it is; false if it is none.
bool TellHalf(HalfImu* half) {
  ColumnLines& lines = half->lines;
  const bool gyros = lines.HasAll(AxesOf("gyro_"));
  const bool accels = lines.HasAll(AxesOf("accel_"));
  if (gyros && accels) return false;
  half->family = gyros ? "gyro_" : accels ? "accel_" : HalfOfName(half->name);
  if (half->family.empty()) return false;
  if (!gyros && !accels) lines.TakeAxesFor(half->family);
  if (!lines.HasAll(AxesOf(half->family))) return false;
  StampHints hints;
  hints.slowest = 4.0;
  lines.set_stamps(GuessStamps(half->columns, lines.meanings(), hints));
  const auto& stamps = lines.stamps();
  if (!stamps || stamps->column < 0 || stamps->rate) return false;
  half->t = TimesOf(half->columns, *stamps);
  return std::is_sorted(half->t.begin(), half->t.end());
}

/// Where in `t` its interval begins; nothing outside.
std::optional<std::size_t> IntervalOf(const std::vector<double>& t, double at) {
  const auto behind = std::upper_bound(t.begin(), t.end(), at);
  if (behind == t.begin() || behind == t.end()) return std::nullopt;
  return static_cast<std::size_t>(behind - t.begin()) - 1;
}

/// The rows of the gyros, with the accelerometers' readings at their stamps as
/// further columns.
FileColumns MergedColumns(const HalfImu& gyro, const HalfImu& accel) {
  FileColumns merged;
  merged.format = gyro.columns.format;
  merged.columns.resize(6);
  for (std::size_t row = 0; row < gyro.t.size(); ++row) {
    const auto before = IntervalOf(accel.t, gyro.t[row]);
    if (!before) continue;
    const double interval = accel.t[*before + 1] - accel.t[*before];
    const double share =
        interval > 0.0 ? (gyro.t[row] - accel.t[*before]) / interval : 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto column = [&](const HalfImu& half) -> const auto& {
        const int at = half.lines.Titled(half.family + "xyz"[i]);
        return half.columns.columns[static_cast<std::size_t>(at)].values;
      };
      const auto& f = column(accel);
      merged.columns[i].values.push_back(column(gyro)[row]);
      merged.columns[3 + i].values.push_back(
          f[*before] + share * (f[*before + 1] - f[*before]));
    }
    ++merged.rows;
  }
  return merged;
}

/// Of MergedColumns.
std::vector<ColumnMeaning> MergedMeanings(const HalfImu& gyro,
                                          const HalfImu& accel) {
  std::vector<ColumnMeaning> meanings;
  for (const HalfImu* half : {&gyro, &accel}) {
    for (const std::string& axis : AxesOf(half->family)) {
      meanings.push_back(
          half->lines
              .meanings()[static_cast<std::size_t>(half->lines.Titled(axis))]);
    }
  }
  return meanings;
}

/// With the columns as the half's own file counts them.
TripleGuess InFile(TripleGuess guess, const HalfImu& half) {
  for (std::size_t i = 0; i < 3; ++i) {
    guess.columns[i] = half.lines.Titled(half.family + "xyz"[i]);
  }
  return guess;
}

/// Empty if their stamps are of one scale and overlap by half of the shorter.
std::string WhyApart(const HalfImu& gyro, const HalfImu& accel) {
  constexpr double kHalf = 0.5;
  const std::string files =
      fmt::format("{} and {} look like its gyros and its accelerometers, but ",
                  gyro.name, accel.name);
  if (gyro.lines.stamps()->scale != accel.lines.stamps()->scale) {
    return files + "their times are of different scales";
  }
  const double overlap = std::min(gyro.t.back(), accel.t.back()) -
                         std::max(gyro.t.front(), accel.t.front());
  const double shorter = std::min(gyro.t.back() - gyro.t.front(),
                                  accel.t.back() - accel.t.front());
  if (overlap > kHalf * shorter) return "";
  return files + fmt::format(
                     "their times hardly overlap: {:.10g} to {:.10g} s "
                     "and {:.10g} to {:.10g} s",
                     gyro.t.front(), gyro.t.back(), accel.t.front(),
                     accel.t.back());
}

/// Of files that are not apart.
std::optional<ImuPair> Paired(const HalfImu& gyro, const HalfImu& accel) {
  auto guess = GuessImu(MergedColumns(gyro, accel), MergedMeanings(gyro, accel),
                        -1, gyro.lines.stamps()->step);
  // Phones write accelerations without gravity as well.
  if (!guess || guess->accel.scale != 1.0 || !FeelsGravity(*guess)) {
    return std::nullopt;
  }
  guess->gyro = InFile(guess->gyro, gyro);
  guess->accel = InFile(guess->accel, accel);
  ImuPair pair = {gyro.lines.ImuStreamOf(*guess), accel.file_name};
  gyro.lines.AddTriple("gyro_", guess->gyro, &pair.imu);
  FoundStream other = accel.lines.Stream();
  accel.lines.AddTriple("accel_", guess->accel, &other);
  std::vector<KeyLine>& lines = pair.imu.lines;
  const bool rows = accel.columns.row_word.column >= 0;
  lines.push_back({"accelerometer", "",
                   std::string(rows ? "rows" : "a file") +
                       " of its own, interpolated at the gyros' stamps"});
  lines.push_back({"  file", '"' + accel.file_name + '"'});
  lines.push_back({"  format", std::string(other.format->name)});
  for (KeyLine& line : other.lines) {
    line.key.insert(0, "  ");
    lines.push_back(std::move(line));
  }
  pair.imu.imu_guess = std::move(guess);
  pair.imu.file = gyro.file_name;
  return pair;
}

}  // namespace

ImuPairSearch FindImuPair(const std::filesystem::path& folder,
                          const std::vector<std::string>& names) {
  std::vector<std::unique_ptr<HalfImu>> gyros;
  std::vector<std::unique_ptr<HalfImu>> accels;
  for (const std::string& name : names) {
    std::vector<FileColumns> tables;
    try {
      tables = ReadTextTables((folder / name).string());
    } catch (const InputError&) {
      continue;  // which whoever loads it is told
    }
    for (FileColumns& table : tables) {
      auto half = std::make_unique<HalfImu>(name, std::move(table));
      if (!TellHalf(half.get())) continue;
      (half->family == "gyro_" ? gyros : accels).push_back(std::move(half));
    }
  }
  ImuPairSearch search;
  for (const auto& gyro : gyros) {
    for (const auto& accel : accels) {
      std::string apart = WhyApart(*gyro, *accel);
      if (!apart.empty()) {
        search.apart = std::move(apart);
      } else if ((search.pair = Paired(*gyro, *accel))) {
        return search;
      }
    }
  }
  return search;
}

}  // namespace hindsight
