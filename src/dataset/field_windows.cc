#include "dataset/field_windows.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/units.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

constexpr double kFieldWindow = 10.0;  // [s]
constexpr int kMostFieldWindows = 60;
constexpr double kFieldTurn = 20.0 * kDegree;

Eigen::Vector3d Flip(const AxisSigns& flipped, const Eigen::Vector3d& m) {
  return {flipped[0] ? -m.x() : m.x(), flipped[1] ? -m.y() : m.y(),
          flipped[2] ? -m.z() : m.z()};
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

class FieldReader {
 public:
  FieldReader(const Dataset& dataset, const AidingStream& stream)
      : imu_(dataset.imu),
        stream_(stream),
        b_g_(dataset.initial.gyro_bias),
        integrator_(dataset.imu) {
    times_.reserve(stream.measurements.size());
    for (const Measurement& z : stream.measurements) {
      times_.push_back(z.t + stream.sensor.time_offset);
    }
  }

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
      const bool turns = window->turn > kFieldTurn;
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
  double Time(std::size_t k) const { return times_[k]; }
  bool IsInside(std::size_t k) const {
    return Time(k) >= imu_.t_begin() && Time(k) <= imu_.t_end();
  }

  /// First readings of windows one after another, thinned to kMostFieldWindows.
  std::vector<std::size_t> WindowBegins() const {
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < stream_.measurements.size(); ++k) {
      if (IsInside(k) &&
          (all.empty() || Time(k) >= Time(all.back()) + kFieldWindow)) {
        all.push_back(k);
      }
    }
    const std::size_t stride = all.size() / kMostFieldWindows + 1;
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
                                IsInside(k) && Time(k) < t_0 + kFieldWindow;
         ++k) {
      const Measurement z = stream_.measurements[k];
      const auto* field = std::get_if<MagneticField>(&z.model);
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
        out.mean[i] += dR * Flip(AxisSignsOf(static_cast<int>(i)), m_b);
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
  std::vector<double> times_;  ///< of the measurements [s]
};

}  // namespace

AxisSigns AxisSignsOf(int number) {
  return {(number & 1) != 0, (number & 2) != 0, (number & 4) != 0};
}

SignCosts ReadFieldWindows(const Dataset& dataset, const AidingStream& stream) {
  return FieldReader(dataset, stream).Read();
}

}  // namespace hindsight
