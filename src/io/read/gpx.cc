#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "io/read/date_text.h"
#include "io/read/file_formats.h"
#include "io/read/fix_lines.h"
#include "io/read/input_file.h"
#include "io/read/open_text.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 29;

/// The text of the file and what it says, for as long as both are needed.
class GpxFile {
 public:
  /// Throws InputError of what is no XML, naming the line.
  explicit GpxFile(const std::string& path) : path_(path) {
    const InputFile file(path);
    if (file.size() > kLargestFile) {
      throw InputError(path, 0, "is longer than 512 MB; expected a GPX track");
    }
    text_.resize(file.size());
    file.ReadAt(0, text_.data(), text_.size());
    const pugi::xml_parse_result result =
        document_.load_buffer(text_.data(), text_.size());
    if (!result) {
      throw InputError(
          path, LineOf(result.offset),
          fmt::format("is not valid XML: {}", result.description()));
    }
    if (!document_.child("gpx")) {
      throw InputError(path, 1, "holds no <gpx>; expected a GPX track");
    }
  }

  /// All track points, in the order of the file.
  std::vector<pugi::xml_node> Points() const {
    std::vector<pugi::xml_node> points;
    for (const pugi::xml_node track : document_.child("gpx").children("trk")) {
      for (const pugi::xml_node part : track.children("trkseg")) {
        for (const pugi::xml_node point : part.children("trkpt")) {
          points.push_back(point);
        }
      }
    }
    return points;
  }

  long LineOf(std::ptrdiff_t offset) const {
    const auto end = text_.begin() +
                     std::clamp(offset, std::ptrdiff_t{0}, std::ssize(text_));
    return 1 + std::count(text_.begin(), end, '\n');
  }

  [[noreturn]] void Fail(const pugi::xml_node& point,
                         const std::string& what) const {
    throw InputError(path_, LineOf(point.offset_debug()), what);
  }

  double Number(const pugi::xml_node& point, const char* name, const char* text,
                double limit) const {
    const auto number = ParseNumber(Trim(text));
    if (!number || std::abs(*number) > limit) {
      Fail(point, fmt::format("{} '{}' of a trkpt is not a number up to {}",
                              name, text, limit));
    }
    return *number;
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string text_;
  pugi::xml_document document_;
};

bool HasHeight(const pugi::xml_node& point) {
  return !point.child("ele").empty();
}

RowBuffer ReadGpx(const TableRequest& request) {
  constexpr double kHighest = 1e5;  // [m]
  const GpxFile file(request.path);
  RowBuffer rows(request.path, request.fields, request.options.allow_absent);
  for (const char* field : {"lat", "lon", "h"}) rows.Declare(field);
  const std::vector<pugi::xml_node> points = file.Points();
  const bool flat = std::none_of(points.begin(), points.end(), HasHeight);
  long line = 0;
  long without_time = 0;
  for (const pugi::xml_node& point : points) {
    ++line;
    const char* time = point.child_value("time");
    if (*time == '\0') {
      ++without_time;
      continue;
    }
    const auto stamp = ParseIsoTime(Trim(time), /*utc=*/true);
    if (!stamp) {
      file.Fail(point, fmt::format("time '{}' of a trkpt is none; expected "
                                   "yyyy-mm-ddThh:mm:ssZ",
                                   time));
    }
    rows.Append(*stamp, line);
    const auto angle = [&](const char* name, double limit) {
      return kDegree *
             file.Number(point, name, point.attribute(name).value(), limit);
    };
    rows.Set("lat", angle("lat", 90.0));
    rows.Set("lon", angle("lon", 180.0));
    if (flat) rows.Set("h", 0.0);
    if (HasHeight(point)) {
      rows.Set("h",
               file.Number(point, "ele", point.child_value("ele"), kHighest));
    }
  }
  if (rows.size() == 0) {
    throw InputError(request.path, 0,
                     "holds no trkpt with a time; expected a track of points "
                     "with their times");
  }
  if (without_time > 0) rows.LeaveOut("point without a time", without_time);
  return rows;
}

std::optional<FoundStream> RecogniseGpx(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (extension != ".gpx") return std::nullopt;
  FoundStream found = FoundAiding({&PositionKind()});
  found.sigmas = false;
  try {
    const std::vector<pugi::xml_node> points = GpxFile(path.string()).Points();
    if (std::none_of(points.begin(), points.end(), HasHeight)) {
      SetLine(SigmaWithoutHeight(static_cast<double>(points.size())),
              &found.lines);
      found.sigmas = true;
    } else {
      found.assumptions.emplace_back(kSeaHeights);
    }
  } catch (const InputError&) {
    // Reading it will say so.
  }
  return found;
}

}  // namespace

const FileFormat& GpxFormat() {
  static const FileFormat kFormat = {.name = "gpx",
                                     .help = "GPX: the points of tracks",
                                     .streams = "position",
                                     .dated = true,
                                     .open =
                                         [](const TableRequest& request) {
                                           return OpenBuffer(ReadGpx(request),
                                                             true);
                                         },
                                     .recognise_name = RecogniseGpx};
  return kFormat;
}

}  // namespace hindsight
