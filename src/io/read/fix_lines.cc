#include "io/read/fix_lines.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/median.h"
#include "io/read/column_choice.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using Names = std::vector<std::string>;

/// Errors of a receiver on its own last for many seconds.
void SetGrossNoise(double sigma, FoundStream* found) {
  constexpr double kFine = 0.3;  // m
  if (!(sigma > kFine)) return;
  SetLine(SlowFixNoise(sigma, 0.1 * sigma,
                       "the file's median sigma; errors of a receiver on "
                       "its own last (a guess)"),
          &found->lines);
}

}  // namespace

FileColumns FixLines::RowsWithPlaces() const {
  FileColumns rows = file_;
  const std::vector<double>& lat = Values(lines_.Titled("lat"));
  const std::vector<double>& lon = Values(lines_.Titled("lon"));
  std::vector<bool> absent(file_.rows);
  for (std::size_t k = 0; k < absent.size(); ++k) {
    absent[k] = std::isnan(lat[k]) || std::isnan(lon[k]) ||
                (lat[k] == 0.0 && lon[k] == 0.0);
  }
  for (FileColumn& column : rows.columns) {
    std::size_t k = 0;
    std::erase_if(column.values, [&](double) { return absent[k++]; });
  }
  rows.rows -=
      static_cast<std::size_t>(std::count(absent.begin(), absent.end(), true));
  return rows;
}

FoundStream FixLines::Position(const FixGuess& fixes) const {
  FoundStream found = lines_.Stream();
  found.kinds = {&PositionKind()};
  found.top_speed = fixes.top_speed;
  found.place_unit_told = fixes.place_unit_told;
  found.place_order_told = fixes.place_order_told;
  found.place = fixes.place;
  lines_.AddColumn("lat", fixes.lat, &found);
  lines_.AddColumn("lon", fixes.lon, &found);
  for (const int place : {fixes.lat.column, fixes.lon.column}) {
    const auto next = static_cast<std::size_t>(place) + 1;
    if (next >= file_.columns.size() || file_.columns[next].side != '?') {
      continue;
    }
    found.assumptions.emplace_back(
        "its letters N and S, or E and W, change: all are taken for the "
        "positive side");
  }
  if (fixes.h.column < 0) {
    AddWithoutHeight(fixes, &found);
    return found;
  }
  lines_.AddColumn("h", fixes.h, &found);
  if (CountsFromSea(file_, fixes.h.column)) {
    found.assumptions.emplace_back(kSeaHeights);
  }
  const Names sigmas = {"sigma_n", "sigma_e", "sigma_d"};
  found.sigmas = lines_.HasAll(sigmas);
  if (found.sigmas) {
    lines_.AddFieldsOf(PositionKind(), sigmas, &found);
    SetGrossNoise(MedianOf(lines_.Titled("sigma_n")), &found);
  } else {
    AddAccuracies(&found);
  }
  constexpr double kStale = 0.5;
  if (fixes.repeated > kStale) {
    SetLine({"on_repeat", "drop",
             fmt::format("{:.0f} % of the rows repeat the one before",
                         100.0 * fixes.repeated)},
            &found.lines);
  }
  return found;
}

std::optional<FoundStream> FixLines::EarthCentred() const {
  const Names axes = {"p_x", "p_y", "p_z"};
  if (!lines_.HasAll(axes) || !AreEarthCentred()) return std::nullopt;
  FoundStream found = lines_.Stream();
  found.kinds = {&PositionKind()};
  for (const std::string& axis : axes) {
    lines_.AddTitledColumn(axis, Quantity::kLength, &found);
  }
  SetFrame(&found);
  const int sigma = StatedSigma("sigma");
  found.sigmas = sigma >= 0;
  for (const char* name : {"sigma_x", "sigma_y", "sigma_z"}) {
    if (sigma < 0) break;
    lines_.AddColumn(name, SigmaGuess(sigma, Quantity::kLength, 1.0, ""),
                     &found);
  }
  if (sigma >= 0) SetGrossNoise(MedianOf(sigma), &found);
  return found;
}

std::optional<FoundStream> FixLines::Utm() const {
  constexpr double kWest = 1e5;  // [m]
  constexpr double kEast = 9e5;
  constexpr double kPole = 1e7;
  if (!lines_.HasAll({"easting", "northing"})) return std::nullopt;
  const auto within = [&](const char* name, double low, double high) {
    const double middle = MedianOf(lines_.Titled(name));
    return middle > low && middle < high;
  };
  if (!within("easting", kWest, kEast) || !within("northing", 0.0, kPole)) {
    return std::nullopt;
  }
  FoundStream found = lines_.Stream();
  found.kinds = {&PositionKind()};
  found.sigmas = false;
  for (const auto& [axis, name] :
       {std::pair("p_x", "easting"), {"p_y", "northing"}, {"p_z", "h"}}) {
    const int column = lines_.Titled(name);
    if (column >= 0) {
      const std::string& unit =
          lines_.meanings()[static_cast<std::size_t>(column)].unit;
      const bool known = UnitFactor(unit, Quantity::kLength).has_value();
      lines_.AddColumn(axis,
                       {column, known ? unit : "m", 1.0, Certainty::kCertain,
                        "by its title"},
                       &found);
      continue;
    }
    ColumnLines::AddLine({"  p_z", "{constant: 0 m}", "the file states none"},
                         &found);
    SetLine(SigmaWithoutHeight(1.0 + lines_.stamps()->span), &found.lines);
    found.sigmas = true;
  }
  AddZone(&found);
  return found;
}

/// All zones look alike: what the data cannot show moves the longitude alone.
void FixLines::AddZone(FoundStream* found) const {
  SetLine({"frame", "utm", "easting and northing by their titles"},
          &found->lines);
  const int column = lines_.Titled("zone");
  const double zone = column < 0 ? 0.0 : MedianOf(column);
  if (zone >= 1.0 && zone <= 60.0 && zone == std::floor(zone)) {
    SetLine({"zone", fmt::format("{:.0f}", zone), "as the file says"},
            &found->lines);
  } else {
    SetLine({"zone", "31", "(a guess)"}, &found->lines);
    found->assumptions.emplace_back(
        "its zone of UTM is not stated: 31 is taken; in another the longitude "
        "differs by a multiple of 6 deg, and nothing else");
  }
  SetLine({"hemisphere", "north", "(a guess)"}, &found->lines);
  found->assumptions.emplace_back(
      "its northings are taken for the northern hemisphere's");
}

KeyLine SigmaWithoutHeight(double fixes) {
  constexpr double kKilometre = 1000.0;
  return {"sigma",
          fmt::format("[3, 3, {:.0f} m]", kKilometre * std::sqrt(fixes)),
          "usual of a single receiver (a guess); a height that is not "
          "known, to a kilometre by all fixes together"};
}

void FixLines::AddWithoutHeight(const FixGuess& fixes,
                                FoundStream* found) const {
  const double rows = static_cast<double>(file_.rows) * (1.0 - fixes.repeated);
  const double used = std::clamp(rows, 1.0, 1.0 + lines_.stamps()->span);
  ColumnLines::AddLine({"  h", "{constant: 0 m}", "the file states none"},
                       found);
  SetLine(SigmaWithoutHeight(used), &found->lines);
  found->sigmas = true;
}

double FixLines::MedianOf(int column) const {
  std::vector<double> present = Values(column);
  std::erase_if(present, [](double x) { return std::isnan(x); });
  return Median(std::move(present));
}

int FixLines::StatedSigma(const std::string& quantity) const {
  const int column = lines_.Titled(quantity);
  if (column < 0) return -1;
  const std::vector<double>& v = Values(column);
  return std::none_of(v.begin(), v.end(), [](double x) { return x <= 0.0; })
             ? column
             : -1;
}

ColumnGuess FixLines::SigmaGuess(int column, Quantity dimension, double factor,
                                 const std::string& reason) const {
  const std::string& unit =
      lines_.meanings()[static_cast<std::size_t>(column)].unit;
  const bool known = UnitFactor(unit, dimension).has_value();
  return {column, known ? unit : SiUnit(dimension), factor, Certainty::kLikely,
          reason};
}

void FixLines::AddAccuracies(FoundStream* found) const {
  constexpr double kAxis = 0.66;  // of a radius of 68 %, circular normal
  const int sigma = StatedSigma("sigma");
  const int radius = sigma >= 0 ? sigma : StatedSigma("accuracy_h");
  if (radius < 0) return;
  const bool is_radius = sigma < 0;
  const double factor = is_radius ? kAxis : 1.0;
  const std::string why =
      is_radius ? "of an axis, where 68 % are within the radius" : "";
  for (const char* name : {"sigma_n", "sigma_e"}) {
    lines_.AddColumn(name, SigmaGuess(radius, Quantity::kLength, factor, why),
                     found);
  }
  const int up = is_radius ? StatedSigma("accuracy_v") : sigma;
  lines_.AddColumn("sigma_d",
                   SigmaGuess(up >= 0 ? up : radius, Quantity::kLength, 1.0,
                              up >= 0 ? "" : "half as much again upwards"),
                   found);
  found->sigmas = true;
  const auto unit = UnitFactor(
      SigmaGuess(radius, Quantity::kLength, 1.0, "").unit, Quantity::kLength);
  SetGrossNoise(*unit * factor * MedianOf(radius), found);
}

void FixLines::AddSpeedAccuracy(FoundStream* found) const {
  const int column = StatedSigma("accuracy_speed");
  if (found->sigmas || column < 0) return;
  for (const char* name : {"sigma_v_n", "sigma_v_e", "sigma_v_d"}) {
    lines_.AddColumn(name, SigmaGuess(column, Quantity::kSpeed, 1.0, ""),
                     found);
  }
  found->sigmas = true;
}

bool FixLines::AreEarthCentred() const {
  constexpr double kNearSurface = 6.2e6;
  constexpr double kFarthest = 7e6;
  double squares = 0.0;
  for (const char* name : {"p_x", "p_y", "p_z"}) {
    squares += std::pow(Values(lines_.Titled(name)).front(), 2);
  }
  return std::sqrt(squares) > kNearSurface && std::sqrt(squares) < kFarthest;
}

void FixLines::SetFrame(FoundStream* found) const {
  if (AreEarthCentred()) {
    SetLine({"frame", "ecef", "as far from the origin as the ground"},
            &found->lines);
    return;
  }
  SetLine({"frame", "ned", "x north, y east, z down (a guess)"}, &found->lines);
  SetLine({"origin", "[0 deg, 0 deg, 0 m]",
           "the file does not say where (a guess)"},
          &found->lines);
}

}  // namespace hindsight
