#include "dataset/magnetic_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/units.h"
#include "earth/geomagnetic_dipole.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

constexpr double kWindow = 10.0;  // [s]
constexpr int kMostWindows = 60;
constexpr double kTurn = 20.0 * kDegree;
constexpr double kLeastScatter = 0.02;
constexpr int kMostCounted = 20;
constexpr double kDipSigma = 0.35;
constexpr double kClearlyBetter = 9.0;
constexpr double kAsGood = 4.0;
constexpr double kClearSine = 0.3;

using Signs = std::array<bool, 3>;  // flipped

Signs SignsOf(int number) {
  return {(number & 1) != 0, (number & 2) != 0, (number & 4) != 0};
}

Eigen::Vector3d Flip(const Signs& flipped, const Eigen::Vector3d& m) {
  return {flipped[0] ? -m.x() : m.x(), flipped[1] ? -m.y() : m.y(),
          flipped[2] ? -m.z() : m.z()};
}

template <typename... Values>
std::string Words(const char* format, Values... values) {
  std::array<char, 320> text;
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

double DipSine(const Eigen::Vector3d& field_n) {
  return field_n.z() / field_n.norm();
}

std::string DipWords(double sine) {
  return Words("%s by %.0f deg", sine > 0.0 ? "down" : "up",
               std::asin(std::min(std::abs(sine), 1.0)) / kDegree);
}

std::string LatitudeWords(const Eigen::Vector3d& p_e) {
  return Words("%.0f deg", GeodeticFromEcef(p_e).latitude / kDegree);
}

/// Readings of one window in the body axes of its begin, for each choice of
/// signs.
struct FieldWindow {
  std::array<Eigen::Vector3d, 8> mean;
  std::array<double, 8> squares;  ///< mean squared norm about the mean
  double squared_norm = 0.0;
  double turn = 0.0;     ///< largest from the begin [rad]
  Eigen::Vector3d down;  ///< against the mean specific force
};

/// Means over all windows.
struct SignCosts {
  std::array<double, 8> scatter = {};   ///< T
  std::array<double, 8> dip_sine = {};  ///< s
  int turned = 0;                       ///< windows with a turn
  double norm = 0.0;                    ///< root mean square [uT]
};

class FieldReader {
 public:
  FieldReader(const Dataset& dataset, const AidingStream& stream)
      : imu_(dataset.imu),
        stream_(stream),
        b_g_(dataset.initial.gyro_bias),
        integrator_(dataset.imu) {}

  SignCosts Read() {
    const std::vector<std::size_t> begins = WindowBegins();
    SignCosts costs;
    double squared_norm = 0.0;
    double turned = 0.0;  // squared norms
    int windows = 0;
    for (const std::size_t begin : begins) {
      const std::optional<FieldWindow> window = ReadWindow(begin);
      if (!window) continue;
      ++windows;
      squared_norm += window->squared_norm;
      const bool turns = window->turn > kTurn;
      if (turns) {
        turned += window->squared_norm;
        ++costs.turned;
      }
      for (std::size_t i = 0; i < 8; ++i) {
        costs.dip_sine[i] +=
            window->mean[i].dot(window->down) / std::sqrt(window->squared_norm);
        if (turns) costs.scatter[i] += window->squares[i];
      }
    }
    if (windows == 0) return costs;
    costs.norm = std::sqrt(squared_norm / windows);
    for (std::size_t i = 0; i < 8; ++i) {
      costs.dip_sine[i] /= windows;
      if (costs.turned > 0) costs.scatter[i] /= turned;
    }
    return costs;
  }

 private:
  double Time(std::size_t k) const {
    return stream_.measurements[k].t + stream_.sensor.time_offset;
  }
  bool IsInside(std::size_t k) const {
    return Time(k) >= imu_.t_begin() && Time(k) <= imu_.t_end();
  }

  /// First readings of windows one after another, thinned to kMostWindows.
  std::vector<std::size_t> WindowBegins() const {
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < stream_.measurements.size(); ++k) {
      if (IsInside(k) &&
          (all.empty() || Time(k) >= Time(all.back()) + kWindow)) {
        all.push_back(k);
      }
    }
    const std::size_t stride = all.size() / kMostWindows + 1;
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < all.size(); i += stride) {
      begins.push_back(all[i]);
    }
    return begins;
  }

  std::optional<FieldWindow> ReadWindow(std::size_t begin) {
    FieldWindow out;
    out.mean.fill(Eigen::Vector3d::Zero());
    out.squares.fill(0.0);
    ImuCalibration calibration;
    calibration.b_g = b_g_;
    const double t_0 = Time(begin);
    Eigen::Quaterniond dR = Eigen::Quaterniond::Identity();
    Eigen::Vector3d dv = Eigen::Vector3d::Zero();
    double t = t_0;
    int count = 0;
    for (std::size_t k = begin; k < stream_.measurements.size() &&
                                IsInside(k) && Time(k) < t_0 + kWindow;
         ++k) {
      const auto* field =
          std::get_if<MagneticField>(&stream_.measurements[k].model);
      if (field == nullptr) continue;
      if (Time(k) > t) {
        const ImuSummary s = integrator_.Summarize(t, Time(k), calibration);
        dv += dR * s.dv;
        dR = (dR * s.dR).normalized();
        t = Time(k);
      }
      out.turn = std::max(out.turn, Log(dR).norm());
      const Eigen::Vector3d m_b =
          field->field_b - stream_.sensor.magnetic.hard_iron_b;
      out.squared_norm += m_b.squaredNorm();
      for (std::size_t i = 0; i < 8; ++i) {
        out.mean[i] += dR * Flip(SignsOf(static_cast<int>(i)), m_b);
      }
      ++count;
    }
    if (count < 2 || dv.isZero(0.0) || out.squared_norm == 0.0) {
      return std::nullopt;
    }
    out.squared_norm /= count;
    for (std::size_t i = 0; i < 8; ++i) {
      out.mean[i] /= count;
      out.squares[i] = out.squared_norm - out.mean[i].squaredNorm();
    }
    out.down = -dv.normalized();
    return out;
  }

  const ImuStream& imu_;
  const AidingStream& stream_;
  Eigen::Vector3d b_g_;
  ImuIntegrator integrator_;
};

double ScatterOf(const SignCosts& costs, std::size_t i) {
  return costs.scatter[i] + kLeastScatter * kLeastScatter;
}

/// chi2 of each choice of signs; see CheckMagnetometers.
std::array<double, 8> Compare(const SignCosts& costs,
                              const std::optional<double>& sine) {
  std::array<double, 8> chi2 = {};
  for (std::size_t i = 0; i < 8; ++i) {
    const Signs flipped = SignsOf(static_cast<int>(i));
    chi2[i] =
        static_cast<double>(std::count(flipped.begin(), flipped.end(), true)) +
        std::min(costs.turned, kMostCounted) * std::log(ScatterOf(costs, i));
    if (!sine) continue;
    const double off = (costs.dip_sine[i] - *sine) / kDipSigma;
    chi2[i] += off * off;
  }
  return chi2;
}

std::string AxesWords(std::size_t number) {
  const Signs flipped = SignsOf(static_cast<int>(number));
  std::string words;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!flipped[axis]) continue;
    words += (words.empty() ? "" : " and ");
    words += "xyz"[axis];
  }
  return words;
}

int CountOf(std::size_t number) {
  const Signs flipped = SignsOf(static_cast<int>(number));
  return static_cast<int>(std::count(flipped.begin(), flipped.end(), true));
}

void CheckSigns(const std::string& name, const SignCosts& costs,
                const std::optional<Eigen::Vector3d>& p_e,
                std::vector<std::string>* warnings) {
  std::optional<double> sine;
  if (p_e) sine = DipSine(DipoleField(*p_e));
  const std::array<double, 8> chi2 = Compare(costs, sine);
  const auto best = static_cast<std::size_t>(
      std::min_element(chi2.begin(), chi2.end()) - chi2.begin());
  if (best == 0 || chi2[0] - chi2[best] < kClearlyBetter) return;
  std::string axes = AxesWords(best);
  for (std::size_t i = 1; i < 8; ++i) {
    if (i == best || CountOf(i) != CountOf(best)) continue;
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
           Words(
               "where the body turns the field does not turn back: it "
               "scatters by %.0f %%, with that sign changed by %.0f %%",
               100.0 * std::sqrt(costs.scatter[0]),
               100.0 * std::sqrt(std::max(costs.scatter[best], 0.0)));
  }
  if (why.empty()) return;
  warnings->push_back(name + ": axis " + axes + " looks flipped: " + why);
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
  warnings->push_back(
      Words("%s: the field has %.4g uT, the Earth's has %.0f to %.0f uT%s",
            name.c_str(), norm, kLeastMagneticField, kLargestMagneticField,
            UnitWords(norm).c_str()));
}

void CheckDown(const AidingStream& stream, const Eigen::Vector3d& p_e,
               std::vector<std::string>* warnings) {
  const auto* first =
      std::get_if<MagneticField>(&stream.measurements.front().model);
  if (first == nullptr || first->form != MagneticField::Form::kVector) return;
  const double sine = DipSine(DipoleField(p_e));
  const double down = stream.sensor.magnetic.down;
  if (down * sine >= 0.0 || std::abs(sine) < kClearSine) return;
  warnings->push_back(
      stream.sensor.name + Words(": down is %.4g uT; at latitude ", down) +
      LatitudeWords(p_e) + " the field points " + DipWords(sine));
}

}  // namespace

std::optional<Eigen::Vector3d> RoughPosition(const Dataset& dataset) {
  if (dataset.initial.position) {
    return EcefFromGeodetic(*dataset.initial.position);
  }
  if (dataset.place) return EcefFromGeodetic(*dataset.place);
  for (const AidingStream& stream : dataset.streams) {
    for (const Measurement& z : stream.measurements) {
      if (const auto* fix = std::get_if<PositionFix>(&z.model)) {
        return fix->p_e;
      }
    }
  }
  return std::nullopt;
}

std::string FieldContradiction(const Eigen::Vector3d& field_level,
                               const Eigen::Vector3d& p_e) {
  const double norm = field_level.norm();
  if (norm < 0.5 * kLeastMagneticField || norm > 2.0 * kLargestMagneticField) {
    return Words("the field has %.4g uT, the Earth's has %.0f to %.0f uT", norm,
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
    if (stream.sensor.type != SensorType::kMagnetometer ||
        stream.measurements.empty()) {
      continue;
    }
    const SignCosts costs = FieldReader(dataset, stream).Read();
    CheckNorm(stream.sensor.name, costs.norm, &warnings);
    CheckSigns(stream.sensor.name, costs, p_e, &warnings);
    if (p_e) CheckDown(stream, *p_e, &warnings);
  }
  return warnings;
}

}  // namespace hindsight
