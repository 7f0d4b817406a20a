#include "dataset/speed_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "dataset/ground_motion.h"
#include "measurements/noise_kind.h"

namespace hindsight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Reading = SpeedRecord::Reading;
using Readings = SpeedRecord::Readings;

/// Of the difference of two errors that lie T and so much way apart.
double LastingSigma(const NoiseModel& noise, double T, double distance) {
  if (!noise.correlated()) return 0.0;
  return std::sqrt(noise.kind->evolution(noise).ChangeVariance(T, distance));
}

/// The slope of places by least squares.
SpeedEvidence SlopeOf(std::span<const Reading> places,
                      const NoiseModel& noise) {
  const auto n = static_cast<double>(places.size());
  double mean_t = 0.0;
  for (const Reading& r : places) mean_t += (r.begin - places[0].begin) / n;
  double squares = 0.0;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  SpeedEvidence out;
  out.begin = places.front().begin;
  out.end = places.back().end;
  for (const Reading& r : places) {
    const double t = r.begin - places[0].begin - mean_t;
    squares += t * t;
    out.v += t * (r.value - places[0].value);
    variance += r.sigma.cwiseAbs2() / n;
  }
  out.v /= squares;
  const double T = out.end - out.begin;
  const double lasting = LastingSigma(noise, T, T * out.v.norm()) / T;
  out.sigma = (variance.array() / squares + lasting * lasting).sqrt().matrix();
  return out;
}

/// The mean of speeds. The errors of those within a second are taken as one.
SpeedEvidence MeanOf(std::span<const Reading> speeds, const NoiseModel& noise) {
  constexpr double kAlike = 1.0;
  const auto n = static_cast<double>(speeds.size());
  SpeedEvidence out;
  out.begin = speeds.front().begin;
  out.end = speeds.back().end;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  for (const Reading& r : speeds) {
    out.v += r.value / n;
    variance += r.sigma.cwiseAbs2() / n;
  }
  const double independent =
      std::clamp(std::floor((out.end - out.begin) / kAlike) + 1.0, 1.0, n);
  const double lasting = noise.correlated() ? noise.sigma : 0.0;
  out.sigma =
      (variance.array() / independent + lasting * lasting).sqrt().matrix();
  return out;
}

/// Cuts the readings of one span into stretches.
class Stretches {
 public:
  Stretches(const Readings& stream, std::span<const Reading> readings,
            int number, std::vector<SpeedEvidence>* out)
      : stream_(stream), readings_(readings), number_(number), out_(out) {}

  void Append() {
    const std::size_t fewest = stream_.are_places ? 2 : 1;
    if (readings_.size() < fewest) return;
    std::size_t first = 0;
    std::size_t done = 0;  // readings of whole stretches
    for (std::size_t last = fewest - 1; last < readings_.size();) {
      const SpeedEvidence speed = Over(first, last);
      if (!IsKnown(speed)) {
        last += Step(last - first);
        continue;
      }
      out_->push_back(speed);
      done = last + 1;
      first = stream_.are_places ? last : last + 1;
      last = first + fewest - 1;
    }
    if (done < readings_.size()) AppendRest(readings_.size() - 1);
  }

 private:
  SpeedEvidence Over(std::size_t first, std::size_t last) const {
    const auto part = readings_.subspan(first, last - first + 1);
    SpeedEvidence speed = stream_.are_places ? SlopeOf(part, stream_.noise)
                                             : MeanOf(part, stream_.noise);
    speed.span = number_;
    return speed;
  }

  /// So that long stretches cost little.
  static std::size_t Step(std::size_t length) {
    return std::max<std::size_t>(1, length / 4);
  }

  bool IsKnown(const SpeedEvidence& speed) const {
    constexpr double kLong = 1.0;
    const bool height = !std::isfinite(speed.horizontal_sigma());
    const double sigma = height ? speed.sigma.z() : speed.horizontal_sigma();
    const double shortest = stream_.are_places ? kLong : 0.0;
    return sigma <= kKnownSpeed && speed.end - speed.begin >= shortest;
  }

  /// The last readings, reaching back until they tell the speed.
  void AppendRest(std::size_t last) {
    const std::size_t fewest = stream_.are_places ? 2 : 1;
    std::size_t step = fewest - 1;
    SpeedEvidence speed = Over(last - step, last);
    while (!IsKnown(speed) && step < last) {
      step = std::min(last, step + Step(step));
      speed = Over(last - step, last);
    }
    out_->push_back(speed);
  }

  const Readings& stream_;
  std::span<const Reading> readings_;
  int number_;
  std::vector<SpeedEvidence>* out_;
};

/// Turns the measurements of a stream into readings.
class Reader {
 public:
  explicit Reader(const AidingStream& stream) : sensor_(stream.sensor) {
    readings_.noise = sensor_.noise;
    for (const Measurement& z : stream.measurements) {
      if (z.withheld) continue;
      t_ = z.t + sensor_.time_offset;
      std::visit([this](const auto& model) { Take(model); }, z.model);
    }
  }

  const Readings& readings() const { return readings_; }

 private:
  void Add(const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
           double extension = 0.0) {
    readings_.all.push_back({t_ - extension, t_, value, sigma});
  }

  void Take(const PositionFix& fix) {
    if (readings_.all.empty()) {
      origin_e_ = fix.p_e;
      C_ne_ = NedAxes(fix.p_e).transpose();
    }
    readings_.are_places = true;
    Add(C_ne_ * (fix.p_e - origin_e_), fix.R_n.diagonal().cwiseSqrt());
  }
  void Take(const HeightFix& fix) {
    readings_.are_places = true;
    Add({0.0, 0.0, -fix.height}, {kInfinity, kInfinity, fix.sigma});
  }
  void Take(const VelocityFix& fix) {
    Add(fix.v_n, fix.R_n.diagonal().cwiseSqrt());
  }
  void Take(const ZeroVelocity& zero) {
    Add(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(zero.sigma));
  }
  void Take(const SpeedCourse& measured) {
    Add({measured.speed, 0.0, 0.0},
        {measured.sigma_speed, measured.sigma_speed, kInfinity});
  }
  void Take(const Dvl& dvl) {
    const std::optional<BottomVelocity> bottom =
        BottomVelocityOf(dvl, sensor_, t_);
    if (bottom) Add(bottom->v_b, Eigen::Vector3d::Constant(bottom->sigma));
  }
  void Take(const Odometer& odometer) {
    if (odometer.form == Odometer::Form::kNonHolonomic) return;
    double speed = odometer.speed;
    double sigma = odometer.sigma.x();
    double dt = 0.0;
    if (odometer.form == Odometer::Form::kIncrements) {
      dt = t_ - sensor_.time_offset - odometer.t_from;
      speed = odometer.distance / dt;
      sigma = std::hypot(sigma, std::sqrt(2.0) * sensor_.count_sigma) / dt;
    }
    // Wheels do not go sideways.
    Add({speed, 0.0, 0.0}, {sigma, sigma, kInfinity}, dt);
  }
  template <typename Other>
  void Take(const Other&) {}

  const Sensor& sensor_;
  double t_ = 0.0;
  Eigen::Vector3d origin_e_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d C_ne_ = Eigen::Matrix3d::Identity();
  Readings readings_;
};

void AppendGiven(const Dataset& dataset, const std::vector<TimeInterval>& spans,
                 std::vector<SpeedEvidence>* out) {
  const InitialState& given = dataset.initial;
  if (!given.v_n || dataset.imu.empty()) return;
  constexpr double kUsual = 0.1;
  const double t = given.t.value_or(dataset.imu.t_begin());
  const auto holds =
      std::find_if(spans.begin(), spans.end(), [t](const TimeInterval& span) {
        return t >= span.begin && t <= span.end;
      });
  SpeedEvidence speed;
  if (holds != spans.end())
    speed.span = static_cast<int>(holds - spans.begin());
  speed.begin = speed.end = t;
  speed.v = *given.v_n;
  speed.sigma =
      given.velocity_sigma.value_or(Eigen::Vector3d::Constant(kUsual));
  out->push_back(speed);
}

}  // namespace

SpeedRecord::SpeedRecord(const Dataset& dataset) {
  for (const AidingStream& stream : dataset.streams) {
    streams_.push_back(Reader(stream).readings());
  }
}

std::vector<SpeedEvidence> SpeedRecord::Over(const TimeInterval& span) const {
  constexpr std::size_t kFewestPlaces = 2;
  constexpr double kShortest = 1.0;
  std::vector<SpeedEvidence> out;
  for (const Readings& stream : streams_) {
    const auto first = std::lower_bound(
        stream.all.begin(), stream.all.end(), span.begin,
        [](const Reading& r, double t) { return r.begin < t; });
    auto last = first;
    while (last != stream.all.end() && last->end <= span.end) ++last;
    if (first == last) continue;
    const std::span<const Reading> part(first, last);
    if (!stream.are_places) {
      out.push_back(MeanOf(part, stream.noise));
    } else if (part.size() >= kFewestPlaces &&
               part.back().end - part.front().begin >= kShortest) {
      out.push_back(SlopeOf(part, stream.noise));
    }
  }
  return out;
}

std::vector<SpeedEvidence> MeasureSpeeds(
    const Dataset& dataset, const std::vector<TimeInterval>& spans) {
  std::vector<SpeedEvidence> out;
  AppendGiven(dataset, spans, &out);
  const SpeedRecord record(dataset);
  for (const Readings& stream : record.streams()) {
    const std::span<const Reading> all(stream.all);
    std::size_t first = 0;
    int number = 0;
    for (const TimeInterval& span : spans) {
      while (first < all.size() && all[first].begin < span.begin) ++first;
      std::size_t last = first;
      while (last < all.size() && all[last].end <= span.end) ++last;
      Stretches(stream, all.subspan(first, last - first), number++, &out)
          .Append();
      first = last;
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const SpeedEvidence& a, const SpeedEvidence& b) {
                     return a.begin < b.begin;
                   });
  return out;
}

}  // namespace hindsight
