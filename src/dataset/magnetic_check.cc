#include "dataset/magnetic_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "dataset/field_windows.h"
#include "earth/geomagnetic_dipole.h"
#include "earth/wgs84.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kLeastScatter = 0.02;
constexpr int kMostCounted = 20;
constexpr double kDipSigma = 0.35;
constexpr double kClearlyBetter = 9.0;
constexpr double kAsGood = 4.0;
constexpr double kClearSine = 0.3;

double DipSine(const Eigen::Vector3d& field_n) {
  return field_n.z() / field_n.norm();
}

std::string DipWords(double sine) {
  return fmt::format("{} by {:.0f} deg", sine > 0.0 ? "down" : "up",
                     std::asin(std::min(std::abs(sine), 1.0)) / kDegree);
}

std::string LatitudeWords(const Eigen::Vector3d& p_e) {
  return fmt::format("{:.0f} deg", GeodeticFromEcef(p_e).latitude / kDegree);
}

double ScatterOf(const ArrangementCosts& costs, std::size_t i) {
  return costs.scatter[i] + kLeastScatter * kLeastScatter;
}

/// Axes that read something else than themselves.
int CountChanged(std::size_t number) {
  const Eigen::Vector3d kept = AxisArrangements()[number].diagonal();
  return static_cast<int>((kept.array() != 1.0).count());
}

/// chi2 of each arrangement; see CheckMagnetometers.
std::array<double, kAxisArrangements> Compare(
    const ArrangementCosts& costs, const std::optional<double>& sine) {
  std::array<double, kAxisArrangements> chi2 = {};
  for (std::size_t i = 0; i < kAxisArrangements; ++i) {
    chi2[i] =
        static_cast<double>(CountChanged(i)) +
        std::min(costs.turned, kMostCounted) * std::log(ScatterOf(costs, i));
    if (!sine) continue;
    const double off = (costs.dip_sine[i] - *sine) / kDipSigma;
    chi2[i] += off * off;
  }
  return chi2;
}

/// Whether only signs change.
bool IsOfSigns(std::size_t number) {
  return AxisArrangements()[number].isDiagonal(0.0);
}

/// Flipped axes, "y and z"; or what the axes are to read, "[y, -x, z]".
std::string AxesWords(std::size_t number) {
  const Eigen::Matrix3d& arrangement = AxisArrangements()[number];
  std::string words;
  if (IsOfSigns(number)) {
    for (int i = 0; i < 3; ++i) {
      if (arrangement(i, i) > 0.0) continue;
      words += (words.empty() ? "" : " and ");
      words += "xyz"[i];
    }
    return words;
  }
  for (int i = 0; i < 3; ++i) {
    Eigen::Index from = 0;
    arrangement.row(i).cwiseAbs().maxCoeff(&from);
    words += (words.empty() ? "[" : ", ");
    if (arrangement(i, from) < 0.0) words += "-";
    words += "xyz"[from];
  }
  return words + "]";
}

void CheckAxes(const std::string& name, const ArrangementCosts& costs,
               const std::optional<Eigen::Vector3d>& p_e,
               std::vector<std::string>* warnings) {
  std::optional<double> sine;
  if (p_e) sine = DipSine(DipoleField(*p_e));
  const auto chi2 = Compare(costs, sine);
  const auto best = static_cast<std::size_t>(
      std::min_element(chi2.begin(), chi2.end()) - chi2.begin());
  if (best == 0 || chi2[0] - chi2[best] < kClearlyBetter) return;
  std::string axes = AxesWords(best);
  for (std::size_t i = 1; i < kAxisArrangements; ++i) {
    if (i == best || CountChanged(i) != CountChanged(best) ||
        IsOfSigns(i) != IsOfSigns(best)) {
      continue;
    }
    if (chi2[i] < chi2[best] + kAsGood) axes += ", or " + AxesWords(i) + ",";
  }
  if (axes.ends_with(',')) axes.pop_back();
  std::string why;
  if (sine && costs.dip_sine[0] * *sine < 0.0) {
    why = "the field points " + DipWords(costs.dip_sine[0]) + ", at latitude " +
          LatitudeWords(*p_e) + " it should point " + DipWords(*sine);
  }
  if (costs.turned > 0 && ScatterOf(costs, best) < 0.25 * ScatterOf(costs, 0)) {
    why += std::string(why.empty() ? "" : "; ") +
           fmt::format(
               "where the body turns the field does not turn back: it "
               "scatters by {:.0f} %, with that changed by {:.0f} %",
               100.0 * std::sqrt(costs.scatter[0]),
               100.0 * std::sqrt(std::max(costs.scatter[best], 0.0)));
  }
  if (why.empty()) return;
  warnings->push_back(name +
                      (IsOfSigns(best) ? ": axis " + axes + " looks flipped: "
                                       : ": its axes look like " + axes +
                                             " of those they are taken for: ") +
                      why);
}

/// What a unit mistaken for another does to the norm, by its power of ten.
std::string UnitWords(double norm) {
  struct Case {
    double factor;
    const char* words;
  };
  constexpr std::array<Case, 6> kCases = {{
      {1e4, "gauss read as tesla"},
      {1e3, "nanotesla read as microtesla"},
      {10.0, "milligauss read as microtesla"},
      {0.1, "microtesla read as milligauss"},
      {1e-2, "gauss read as microtesla"},
      {1e-6, "tesla read as microtesla"},
  }};
  for (const Case& candidate : kCases) {
    const double right = norm / candidate.factor;
    if (right > kLeastMagneticField && right < kLargestMagneticField) {
      return std::string(": ") + candidate.words + "?";
    }
  }
  return ": check the unit, the scale and what is magnetic nearby";
}

void CheckNorm(const std::string& name, double norm,
               std::vector<std::string>* warnings) {
  if (norm == 0.0) return;
  if (norm >= kLeastMagneticField && norm <= kLargestMagneticField) return;
  warnings->push_back(fmt::format(
      "{}: the field has {:.4g} uT, the Earth's has {:.0f} to {:.0f} uT{}",
      name, norm, kLeastMagneticField, kLargestMagneticField, UnitWords(norm)));
}

void CheckDown(const AidingStream& stream, const Eigen::Vector3d& p_e,
               std::vector<std::string>* warnings) {
  const MeasurementModel model = stream.measurements.front().model;
  const auto* first = std::get_if<MagneticField>(&model);
  if (first == nullptr || first->form != MagneticField::Form::kVector) return;
  const double sine = DipSine(DipoleField(p_e));
  const double down = stream.sensor.magnetic.down;
  if (down * sine >= 0.0 || std::abs(sine) < kClearSine) return;
  warnings->push_back(stream.sensor.name +
                      fmt::format(": down is {:.4g} uT; at latitude ", down) +
                      LatitudeWords(p_e) + " the field points " +
                      DipWords(sine));
}

}  // namespace

std::optional<Eigen::Vector3d> RoughPosition(const Dataset& dataset) {
  if (dataset.initial.position) {
    return EcefFromGeodetic(*dataset.initial.position);
  }
  if (dataset.place) return EcefFromGeodetic(*dataset.place);
  for (const AidingStream& stream : dataset.streams) {
    if (stream.measurements.empty()) continue;
    const Measurement z = stream.measurements.front();
    if (const auto* fix = std::get_if<PositionFix>(&z.model)) return fix->p_e;
  }
  return std::nullopt;
}

std::string FieldContradiction(const Eigen::Vector3d& field_level,
                               const Eigen::Vector3d& p_e) {
  const double norm = field_level.norm();
  if (norm < 0.5 * kLeastMagneticField || norm > 2.0 * kLargestMagneticField) {
    return fmt::format(
        "the field has {:.4g} uT, the Earth's has {:.0f} to {:.0f} uT", norm,
        kLeastMagneticField, kLargestMagneticField);
  }
  const double sine = DipSine(DipoleField(p_e));
  const double found = DipSine(field_level);
  if (found * sine > 0.0 || std::abs(found) < kClearSine ||
      std::abs(sine) < kClearSine) {
    return "";
  }
  return "the field points " + DipWords(found) + ", at latitude " +
         LatitudeWords(p_e) + " it should point " + DipWords(sine) +
         ": is an axis flipped?";
}

std::vector<std::string> CheckMagnetometers(const Dataset& dataset) {
  std::vector<std::string> warnings;
  if (dataset.imu.empty()) return warnings;
  const std::optional<Eigen::Vector3d> p_e = RoughPosition(dataset);
  for (const AidingStream& stream : dataset.streams) {
    if (!stream.sensor.kind->magnetic || stream.measurements.empty()) {
      continue;
    }
    const ArrangementCosts costs = ReadFieldWindows(dataset, stream);
    CheckNorm(stream.sensor.name, costs.norm, &warnings);
    CheckAxes(stream.sensor.name, costs, p_e, &warnings);
    if (p_e) CheckDown(stream, *p_e, &warnings);
  }
  return warnings;
}

}  // namespace hindsight
