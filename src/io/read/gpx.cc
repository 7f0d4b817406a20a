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
#include "io/read/open_text.h"
#include "io/read/text_lines.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::size_t kLargestText = std::size_t{1} << 29;

/// As TextLines reads it, each line with its end.
std::string TextOf(const std::string& path) {
  TextLines lines(path);
  std::string text;
  std::string_view line;
  while (lines.Next(&line)) {
    text.append(line).push_back('\n');
    if (text.size() > kLargestText) {
      throw InputError(path, 0, "is longer than 512 MB; expected a GPX track");
    }
  }
  return text;
}

/// The document, and the lines of its nodes.
class GpxFile {
 public:
  /// Throws InputError of what is no GPX, naming the line.
  explicit GpxFile(const std::string& path) : path_(path), text_(TextOf(path)) {
    const pugi::xml_parse_result result =
        document_.load_buffer(text_.data(), text_.size());
    if (!result) {
      FailAt(result.offset,
             fmt::format("is not valid XML: {}", result.description()));
    }
    const pugi::xml_node gpx = document_.child("gpx");
    if (!gpx) FailAt(0, "holds no <gpx>; expected a GPX track");
    const std::size_t end = text_.rfind('>') + 1;
    if (document_.last_child() != gpx ||
        text_.find_first_not_of(" \t\n", end) != text_.npos) {
      FailAt(std::ssize(text_), "goes on behind </gpx>");
    }
  }

  /// All track points, in the order of the file, which must outlive them.
  std::vector<pugi::xml_node> Points() const {
    std::vector<pugi::xml_node> points;
    for (const pugi::xml_node track : document_.child("gpx").children("trk")) {
      for (const pugi::xml_node part : track.children("trkseg")) {
        for (const pugi::xml_node child : part.children()) {
          if (child.type() == pugi::node_pcdata) {
            const auto begin = static_cast<std::size_t>(child.offset_debug());
            FailAt(static_cast<std::ptrdiff_t>(
                       text_.find_first_not_of(" \t\n", begin)),
                   "text between the points of a track");
          }
          if (child.name() == std::string_view("trkpt")) {
            points.push_back(child);
          }
        }
      }
    }
    return points;
  }

  /// Of a node; quick where they are asked for in the order of the file.
  long LineOf(const pugi::xml_node& node) {
    const std::ptrdiff_t offset = node.offset_debug();
    if (offset < offset_) line_ = 1, offset_ = 0;
    line_ += std::count(text_.begin() + offset_, text_.begin() + offset, '\n');
    offset_ = offset;
    return line_;
  }

  [[noreturn]] void Fail(const pugi::xml_node& point,
                         const std::string& what) const {
    FailAt(point.offset_debug(), what);
  }

  /// The text as a number of that size at most.
  double Number(const pugi::xml_node& point, const char* name, const char* text,
                double limit) const {
    const auto number = ParseNumber(Trim(text));
    if (!number || std::abs(*number) > limit) {
      Fail(point, fmt::format("{} '{}' of a trkpt is not a number up to {}",
                              name, text, limit));
    }
    return *number;
  }

 private:
  [[noreturn]] void FailAt(std::ptrdiff_t offset,
                           const std::string& what) const {
    const auto end = text_.begin() +
                     std::clamp(offset, std::ptrdiff_t{0}, std::ssize(text_));
    throw InputError(path_, 1 + std::count(text_.begin(), end, '\n'), what);
  }

  std::string path_;
  std::string text_;
  pugi::xml_document document_;
  std::ptrdiff_t offset_ = 0;  ///< of the line last asked for
  long line_ = 1;
};

bool HasHeight(const pugi::xml_node& point) {
  return !point.child("ele").empty();
}

RowBuffer ReadGpx(const TableRequest& request) {
  constexpr double kHighest = 1e5;  // [m]
  GpxFile file(request.path);
  RowBuffer rows(request.path, request.fields, request.options.allow_absent);
  for (const char* field : {"lat", "lon", "h"}) rows.Declare(field);
  const std::vector<pugi::xml_node> points = file.Points();
  const bool flat = std::none_of(points.begin(), points.end(), HasHeight);
  long without_time = 0;
  for (const pugi::xml_node& point : points) {
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
    rows.Append(*stamp, file.LineOf(point));
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
    const GpxFile file(path.string());
    const std::vector<pugi::xml_node> points = file.Points();
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
