#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/units.h"
#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "io/read/text_tokens.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

struct PosColumn {
  const char* title;
  const char* field;
  double factor;
};

constexpr std::array kPosColumns = {
    PosColumn{"latitude(deg)", "lat", kDegree},
    PosColumn{"longitude(deg)", "lon", kDegree},
    PosColumn{"height(m)", "h", 1.0},
    PosColumn{"Q", "quality", 1.0},
    PosColumn{"ns", "satellites", 1.0},
    PosColumn{"sdn(m)", "sigma_n", 1.0},
    PosColumn{"sde(m)", "sigma_e", 1.0},
    PosColumn{"sdu(m)", "sigma_d", 1.0},
    PosColumn{"sdne(m)", "sd_ne", 1.0},
    PosColumn{"sdeu(m)", "sd_ed", -1.0},
    PosColumn{"sdun(m)", "sd_dn", -1.0},
    PosColumn{"vn(m/s)", "v_n", 1.0},
    PosColumn{"ve(m/s)", "v_e", 1.0},
    PosColumn{"vu(m/s)", "v_d", -1.0},
    PosColumn{"sdvn", "sigma_v_n", 1.0},
    PosColumn{"sdve", "sigma_v_e", 1.0},
    PosColumn{"sdvu", "sigma_v_d", 1.0},
    PosColumn{"sdvne", "sd_v_ne", 1.0},
    PosColumn{"sdveu", "sd_v_ed", -1.0},
    PosColumn{"sdvun", "sd_v_dn", -1.0},
};

/// Height fixes take the vertical columns under their own names.
std::string_view PosField(std::string_view field) {
  return field == "sigma_h" ? "sigma_d" : field;
}

TableLayout PosLayout(const std::string& path, long line,
                      std::string_view header, std::string_view first_row,
                      const std::vector<FieldName>& fields) {
  const std::size_t text = header.find_first_not_of("% ");
  const std::vector<std::string_view> titles =
      text == header.npos ? std::vector<std::string_view>()
                          : SplitLine(header.substr(text), ' ', true);
  for (const char* needed : {"latitude(deg)", "longitude(deg)", "height(m)"}) {
    if (std::find(titles.begin(), titles.end(), needed) == titles.end()) {
      throw InputError(path, line,
                       std::string("no column ") + needed +
                           " in the header; expected an RTKLIB solution in "
                           "latitude, longitude (deg) and height");
    }
  }
  const bool utc = titles[0] == "UTC";
  if (!utc && titles[0] != "GPST") {
    throw InputError(path, line,
                     "time system '" + std::string(titles[0]) +
                         "' is not read; expected GPST or UTC");
  }
  const std::vector<std::string_view> row = SplitLine(first_row, ' ', true);
  const bool date =
      !row.empty() && row[0].find_first_of("/-") != std::string_view::npos;
  if (utc && !date) {
    throw InputError(path, line,
                     "UTC as week and seconds is ambiguous; expected "
                     "yyyy/mm/dd hh:mm:ss");
  }
  TableLayout layout;
  layout.clock = !date ? TableLayout::Clock::kWeek
                 : utc ? TableLayout::Clock::kDateUtc
                       : TableLayout::Clock::kDate;
  layout.time_column = 0;
  layout.delimiter = ' ';
  layout.comma_is_blank = true;
  for (const FieldName& name : fields) {
    TableLayout::Field field{name.name, -1, 1.0};
    for (const PosColumn& column : kPosColumns) {
      if (PosField(name.name) != column.field) continue;
      const auto at = std::find(titles.begin(), titles.end(), column.title);
      // The time takes one title and two columns.
      if (at != titles.end()) {
        field.column = static_cast<int>(at - titles.begin()) + 1;
      }
      field.factor = column.factor;
    }
    layout.fields.push_back(field);
  }
  return layout;
}

OpenedTable OpenPos(const TableRequest& request) {
  OpenedTable opened = OpenLines(request);
  std::string header;
  std::string row;
  long header_line = 0;
  std::string_view view;
  while (row.empty() && opened.lines->Next(&view)) {
    if (view.starts_with('%')) {
      header = view;
      header_line = opened.lines->number();
    } else if (!IsComment(view)) {
      row = view;
    }
  }
  if (row.empty()) FailWithoutRows(request.path);
  TableLayout layout =
      PosLayout(request.path, header_line, header, row, request.fields);
  opened.dated = true;
  opened.table = std::make_unique<TextTable>(
      opened.lines.get(), std::move(layout), request.options, std::move(row));
  return opened;
}

/// The share of rows whose integer ambiguities are resolved.
double FixedShare(const std::string& path) {
  TextFormat format;
  format.kind = &RtklibPosFormat();
  const OpenedTable opened =
      OpenTable(path, format, {{"quality", Quantity::kRatio}}, {});
  long rows = 0;
  long fixed = 0;
  while (opened.table->Next()) {
    ++rows;
    if (opened.table->value(0) == 1.0) ++fixed;
  }
  return rows == 0 ? 0.0
                   : static_cast<double>(fixed) / static_cast<double>(rows);
}

std::optional<FoundStream> RecognisePos(const TextProbe& probe) {
  if (probe.comments.empty() ||
      probe.comments.back().find("latitude(deg)") == std::string::npos) {
    return std::nullopt;
  }
  FoundStream found = FoundAiding({&PositionKind()});
  constexpr double kMostlyFixed = 0.5;
  if (FixedShare(probe.path) > kMostlyFixed) {
    found.lines.push_back(
        {"accept_quality", "[1]", "integer ambiguities resolved"});
  }
  found.lines.push_back(
      {"every", "1 s", "errors of neighbouring fixes are alike"});
  return found;
}

}  // namespace

const FileFormat& RtklibPosFormat() {
  static const FileFormat kFormat = {.name = "rtklib_pos",
                                     .help = "RTKLIB solution",
                                     .streams = "position, velocity, height",
                                     .dated = true,
                                     .zeros_are_absent = true,
                                     .open = OpenPos,
                                     .recognise_text = RecognisePos};
  return kFormat;
}

}  // namespace hindsight
