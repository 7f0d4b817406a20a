#include "dataset/imu_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

constexpr std::size_t kCellsOfWindow = 4;
constexpr double kShaken = 10.0;  // times the thresholds

/// Sums over readings.
struct Sums {
  long count = 0;
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  double w2 = 0.0;
  double f2 = 0.0;

  void Add(const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
    ++count;
    w += rate;
    f += force;
    w2 += rate.squaredNorm();
    f2 += force.squaredNorm();
  }

  void Add(const Sums& other) {
    count += other.count;
    w += other.w;
    f += other.f;
    w2 += other.w2;
    f2 += other.f2;
  }

  static double Deviation(const Eigen::Vector3d& mean, double squares) {
    return std::sqrt(std::max(0.0, squares - mean.squaredNorm()));
  }
};

struct Window {
  bool whole = false;  ///< without a gap, of enough readings
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  double w_sd = 0.0;
  double f_sd = 0.0;
};

class Examination {
 public:
  explicit Examination(const Dataset& dataset)
      : imu_(dataset.imu), options_(dataset.stationary) {
    constexpr double kSigmas = 5.0;
    bias_ = dataset.initial.gyro_bias;
    told_ = kSigmas * std::hypot(options_.rate_sigma,
                                 dataset.imu.noise.gyro_noise_density /
                                     std::sqrt(options_.window));
    most_ =
        kSigmas * GyroBiasSigma(dataset.initial).array() + kEarthRate + told_;
    if (!imu_.empty()) Cut();
  }

  std::vector<ImuCell> Cells() {
    for (std::size_t i = 0; i + kCellsOfWindow <= cells_.size(); ++i) {
      const Window window = WindowFrom(i);
      if (window.whole && IsExplained(window) && IsCalm(window, kShaken)) {
        Join(i, window);
      } else {
        open_ = false;
      }
    }
    return std::move(cells_);
  }

  UnexplainedRate Unexplained() const {
    UnexplainedRate out;
    double counted = imu_.empty() ? 0.0 : imu_.t_begin();
    for (std::size_t i = 0; i + kCellsOfWindow <= cells_.size(); ++i) {
      const Window window = WindowFrom(i);
      if (!window.whole || IsExplained(window) || !IsQuiet(window)) continue;
      const double end = cells_[i + kCellsOfWindow - 1].end;
      out.seconds += end - std::max(counted, cells_[i].begin);
      counted = end;
      out.rate = std::max(out.rate, (window.w - bias_).norm());
    }
    return out;
  }

 private:
  void Cut() {
    const double length = options_.window / static_cast<double>(kCellsOfWindow);
    const bool increments = imu_.kind == ImuStream::Kind::kIncrements;
    const double longest =
        imu_.nominal_dt > 0.0
            ? std::min(imu_.max_gap, ImuStream::kGapFactor * imu_.nominal_dt)
            : imu_.max_gap;
    const auto most = static_cast<std::size_t>(
        std::min((imu_.t_end() - imu_.t_begin()) / length + 1.0,
                 static_cast<double>(imu_.samples.size())));
    cells_.reserve(most);
    sums_.reserve(most);
    Sums sums;
    double begin = imu_.t_begin();
    double before = begin;
    for (std::size_t k = 1; k < imu_.samples.size();) {
      const std::span<const ImuSample> piece = imu_.samples.Piece(k);
      for (const ImuSample& s : piece) {
        const double dt = s.t - std::exchange(before, s.t);
        if (dt > longest) {
          sums = Sums();
          begin = s.t;
          continue;
        }
        const double scale = increments ? 1.0 / dt : 1.0;
        sums.Add(scale * s.gyro, scale * s.accel);
        if (s.t - begin < length - 0.5 * dt) continue;
        EndCell(begin, s.t, std::exchange(sums, Sums()));
        begin = s.t;
      }
      k += piece.size();
    }
  }

  void EndCell(double begin, double end, const Sums& sums) {
    const auto n = static_cast<double>(sums.count);
    cells_.push_back({begin, end, sums.w / n, sums.f / n, -1, false});
    sums_.push_back(sums);
  }

  Window WindowFrom(std::size_t i) const {
    constexpr long kFewest = 5;
    Window window;
    Sums sums;
    window.whole = true;
    for (std::size_t k = i; k < i + kCellsOfWindow; ++k) {
      sums.Add(sums_[k]);
      if (k > i && cells_[k].begin > cells_[k - 1].end) window.whole = false;
    }
    window.whole = window.whole && sums.count >= kFewest;
    const auto n = static_cast<double>(sums.count);
    window.w = sums.w / n;
    window.f = sums.f / n;
    window.w_sd = Sums::Deviation(window.w, sums.w2 / n);
    window.f_sd = Sums::Deviation(window.f, sums.f2 / n);
    return window;
  }

  bool IsExplained(const Window& window) const {
    return ((window.w - bias_).array().abs() < most_).all();
  }

  bool IsCalm(const Window& window, double factor) const {
    return window.w_sd < factor * options_.gyro_threshold &&
           window.f_sd < factor * options_.accel_threshold;
  }

  bool IsQuiet(const Window& window) const {
    constexpr double kGravityTolerance = 0.03;
    return IsCalm(window, 1.0) && std::abs(window.f.norm() / kStandardGravity -
                                           1.0) < kGravityTolerance;
  }

  /// Whether the window goes on as the span began.
  bool IsAsBefore(const Window& window) const {
    constexpr double kForceThresholds = 3.0;
    return (window.w - span_w_ / span_time_).norm() < told_ &&
           (window.f - span_f_ / span_time_).norm() <
               kForceThresholds * options_.accel_threshold;
  }

  void Join(std::size_t i, const Window& window) {
    const bool quiet = IsQuiet(window);
    if (!open_ || !IsAsBefore(window)) {
      // What is shaken, and lasts until then, gives way to what is not.
      open_ = i >= next_free_ || (quiet && !span_is_quiet_);
      if (!open_) return;
      ++span_;
      span_is_quiet_ = false;
      span_w_.setZero();
      span_f_.setZero();
      span_time_ = 0.0;
    }
    span_is_quiet_ = span_is_quiet_ || quiet;
    for (std::size_t k = i; k < i + kCellsOfWindow; ++k) {
      ImuCell& cell = cells_[k];
      cell.quiet = cell.quiet || quiet;
      if (cell.span == span_) continue;
      cell.span = span_;
      span_w_ += cell.length() * cell.w;
      span_f_ += cell.length() * cell.f;
      span_time_ += cell.length();
    }
    next_free_ = i + kCellsOfWindow;
  }

  const ImuStream& imu_;
  const StationaryOptions& options_;
  Eigen::Vector3d bias_;
  double told_ = 0.0;    ///< least turn that a window tells [rad/s]
  Eigen::Array3d most_;  ///< that the bias may have [rad/s]
  std::vector<ImuCell> cells_;
  std::vector<Sums> sums_;
  bool open_ = false;
  int span_ = -1;
  bool span_is_quiet_ = false;
  std::size_t next_free_ = 0;
  Eigen::Vector3d span_w_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d span_f_ = Eigen::Vector3d::Zero();
  double span_time_ = 0.0;
};

}  // namespace

std::vector<ImuCell> ExamineImu(const Dataset& dataset) {
  return Examination(dataset).Cells();
}

UnexplainedRate FindUnexplainedRate(const Dataset& dataset) {
  return Examination(dataset).Unexplained();
}

}  // namespace hindsight
