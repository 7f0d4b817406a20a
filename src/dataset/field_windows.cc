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

/// Readings of one window in the body axes of its begin, for any arrangement.
struct FieldWindow {
  /// Means of C e_i m_j: body axis i turned back, times axis j of the reading.
  std::array<std::array<Eigen::Vector3d, 3>, 3> parts;
  double squared_norm = 0.0;
  double turn = 0.0;     ///< largest from the begin [rad]
  Eigen::Vector3d down;  ///< against the mean specific force

  Eigen::Vector3d Mean(const Eigen::Matrix3d& arrangement) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        mean +=
            arrangement(static_cast<int>(i), static_cast<int>(j)) * parts[i][j];
      }
    }
    return mean;
  }
};

std::array<Eigen::Matrix3d, kAxisArrangements> MakeArrangements() {
  std::array<Eigen::Matrix3d, kAxisArrangements> all;
  std::array<int, 3> from = {0, 1, 2};
  std::size_t count = 0;
  do {
    for (int signs = 0; signs < 8; ++signs) {
      all[count].setZero();
      for (int i = 0; i < 3; ++i) {
        all[count](i, from[static_cast<std::size_t>(i)]) =
            (signs >> i & 1) != 0 ? -1.0 : 1.0;
      }
      ++count;
    }
  } while (std::next_permutation(from.begin(), from.end()));
  return all;
}

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

  ArrangementCosts Read() {
    const std::vector<std::size_t> begins = WindowBegins();
    ArrangementCosts costs;
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
      for (std::size_t i = 0; i < kAxisArrangements; ++i) {
        const Eigen::Vector3d mean = window->Mean(AxisArrangements()[i]);
        costs.dip_sine[i] +=
            mean.dot(window->down) / std::sqrt(window->squared_norm);
        if (turns) {
          costs.scatter[i] += window->squared_norm - mean.squaredNorm();
        }
      }
    }
    if (windows == 0) return costs;
    costs.norm = std::sqrt(squared_norm / windows);
    for (std::size_t i = 0; i < kAxisArrangements; ++i) {
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
    for (auto& row : out.parts) row.fill(Eigen::Vector3d::Zero());
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
      const Eigen::Matrix3d C = dR.toRotationMatrix();
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          out.parts[i][j] +=
              m_b(static_cast<int>(j)) * C.col(static_cast<int>(i));
        }
      }
      ++count;
    }
    if (count < 2 || dv.isZero(0.0) || out.squared_norm == 0.0) {
      return std::nullopt;
    }
    out.squared_norm /= count;
    for (auto& row : out.parts) {
      for (Eigen::Vector3d& part : row) part /= count;
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

const std::array<Eigen::Matrix3d, kAxisArrangements>& AxisArrangements() {
  static const auto kAll = MakeArrangements();
  return kAll;
}

ArrangementCosts ReadFieldWindows(const Dataset& dataset,
                                  const AidingStream& stream) {
  return FieldReader(dataset, stream).Read();
}

}  // namespace hindsight
