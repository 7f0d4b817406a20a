#include "dataset/gyro_unit.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/units.h"
#include "dataset/ground_motion.h"
#include "dataset/row_rate.h"
#include "imu/sample_search.h"

namespace hindsight {

namespace {

std::string UnitWarning(const std::string& turns, double factor,
                        ImuStream::Kind kind = ImuStream::Kind::kRates) {
  const bool rates = kind == ImuStream::Kind::kRates;
  std::string seen = rates ? "deg/s" : "deg";
  std::string declared = rates ? "rad/s" : "rad";
  if (factor > 1.0) std::swap(seen, declared);
  const std::string stem = rates ? "gyro" : "dtheta";
  return fmt::format(
      "imu: {} {:.3g} times as far as the gyros say: they look like {}, "
      "declared as {}; correct the unit of {}_x, {}_y, {}_z under `columns`",
      turns, factor, seen, declared, stem, stem, stem);
}

/// By gravity between quiet spells.
std::string ByGravity(const ImuStream& stream) {
  const double span = stream.t_end() - stream.t_begin();
  std::vector<Eigen::Vector3d> f;
  std::vector<Eigen::Vector3d> w;
  constexpr std::size_t kMost = 20'000;
  const std::size_t rows = std::min(stream.samples.size(), kMost);
  for (std::size_t k = 0; k < rows; ++k) {
    f.emplace_back(stream.samples[k].accel / kStandardGravity);
    w.emplace_back(stream.samples[k].gyro);
  }
  const GravityBalance balance(f, w);
  if (balance.spans().size() < kFewestBalanced) return "";
  const double rate = static_cast<double>(stream.samples.size() - 1) / span;
  const double never = balance.Squares(std::numeric_limits<double>::infinity());
  const double least = kMostUnbalanced * std::min(never, balance.Squares(rate));
  for (const double factor : {kDegree, 1.0 / kDegree}) {
    if (balance.Squares(rate / factor) > least) continue;
    return UnitWarning("gravity turns", factor);
  }
  return "";
}

/// How far the gyros turn about the mean specific force from the first sample to
/// ascending times [rad].
class TurnAboutVertical {
 public:
  explicit TurnAboutVertical(const ImuStream& stream)
      : stream_(stream),
        rates_(stream.kind == ImuStream::Kind::kRates),
        down_(-FactsOf(stream)->readings.accel_sum.normalized()) {}

  double At(double t) {
    const auto add = [&](const ImuSample& before, const ImuSample& next) {
      if (before.t >= t) return false;
      turn_ += (rates_ ? next.t - before.t : 1.0) * down_.dot(next.gyro);
      ++k_;
      return true;
    };
    WalkSamples(stream_, k_ + 1, stream_.samples.size(), add);
    return turn_;
  }

 private:
  const ImuStream& stream_;
  bool rates_;
  Eigen::Vector3d down_;
  std::size_t k_ = 0;  ///< the sample that it has come to
  double turn_ = 0.0;
};

/// Sums over pairs of moments of a vehicle that is level on average, of how far it
/// turned between them by its course over the ground and by the gyros [rad^2].
struct Turns {
  double by_course = 0.0;
  double by_gyros = 0.0;
  double both = 0.0;
  int count = 0;
};

Turns TurnsOf(const Dataset& dataset) {
  constexpr double kShortest = 2.0;  // s, above the offsets of clocks
  constexpr double kLongest = 6.0;   // s
  constexpr double kMoving = 3.0;    // m/s
  constexpr double kFarthest = 2.0;  // rad, below half a turn
  const ImuStream& imu = dataset.imu;
  TurnAboutVertical gyros(imu);
  Turns turns;
  double last_turn = 0.0;
  std::optional<TimedVelocity> last;
  for (const TimedVelocity& v :
       GroundVelocities(dataset, imu.t_begin(), imu.t_end())) {
    const bool moves =
        v.v_n.head<2>().norm() > std::max(kMoving, 5.0 * v.sigma);
    if (!moves || (last && v.t - last->t > kLongest)) last.reset();
    if (!moves || (last && v.t - last->t < kShortest)) continue;
    const double turn = gyros.At(v.t);
    if (last) {
      const double course = std::atan2(
          last->v_n.cross(v.v_n).z(), last->v_n.head<2>().dot(v.v_n.head<2>()));
      const double gyro = turn - last_turn;
      if (std::abs(course) < kFarthest) {
        turns.by_course += course * course;
        turns.by_gyros += gyro * gyro;
        turns.both += course * gyro;
        ++turns.count;
      }
    }
    last = v;
    last_turn = turn;
  }
  return turns;
}

/// By how far the course turns over what the gyros say.
std::string ByCourse(double ratio, ImuStream::Kind kind) {
  if (ratio < 0.0) {
    return "imu: the course turns against the gyros: they have the other sign, "
           "or the accelerometers (phones and watches of Apple read -1 g along "
           "the axis that points up), or an axis is mirrored; put a \"-\" "
           "before its column under `columns`";
  }
  for (const double factor : {kDegree, 1.0 / kDegree}) {
    if (IsNearRatio(ratio, factor)) {
      return UnitWarning("the course turns", factor, kind);
    }
  }
  if (IsNearRatio(ratio, 1.0)) return "";
  return fmt::format(
      "imu: the course turns {:.3g} times as far as the gyros say: their "
      "unit or scale is that factor off",
      ratio);
}

}  // namespace

bool IsNearRatio(double ratio, double expected) {
  constexpr double kNear = 1.25;
  return std::abs(std::log(ratio / expected)) < std::log(kNear);
}

std::optional<double> CourseOverGyros(const Dataset& dataset) {
  constexpr double kTurned = 0.1;  // rad, root mean square
  constexpr double kAlike = 0.8;   // correlation
  const ImuStream& imu = dataset.imu;
  if (imu.samples.size() < 2) return std::nullopt;
  const auto [courses, gyros, both, count] = TurnsOf(dataset);
  if (count == 0 || courses < count * kTurned * kTurned || gyros <= 0.0 ||
      std::abs(both) < kAlike * std::sqrt(courses * gyros)) {
    return std::nullopt;
  }
  return std::copysign(std::sqrt(courses / gyros), both);
}

std::string WarnAboutGyroUnit(const Dataset& dataset) {
  const ImuStream& imu = dataset.imu;
  if (imu.samples.size() < 2 || imu.t_end() <= imu.t_begin()) return "";
  // Gravity turns little on the ground.
  if (const auto ratio = CourseOverGyros(dataset)) {
    return ByCourse(*ratio, imu.kind);
  }
  return imu.kind == ImuStream::Kind::kRates ? ByGravity(imu) : "";
}

}  // namespace hindsight
