#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "base/random.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "simulation/fault_effects.h"

namespace hindsight {
namespace {

/// Random streams of faults, clear of those of the simulation and of
/// injections.
constexpr std::uint64_t kFaultStream = 2000;

/// Up to three values of a measurement, positions NED from an origin.
Eigen::Vector3d ReadingOf(const MeasurementModel& model,
                          const Eigen::Vector3d& origin_e) {
  if (const auto* z = std::get_if<PositionFix>(&model)) {
    return NedAxes(origin_e).transpose() * (z->p_e - origin_e);
  }
  if (const auto* z = std::get_if<VelocityFix>(&model)) return z->v_n;
  if (const auto* z = std::get_if<HeightFix>(&model)) {
    return {z->height, 0.0, 0.0};
  }
  if (const auto* z = std::get_if<Odometer>(&model)) {
    return {z->form == Odometer::Form::kIncrements ? z->distance : z->speed,
            0.0, 0.0};
  }
  if (const auto* z = std::get_if<Dvl>(&model)) return z->speed.head<3>();
  if (const auto* z = std::get_if<SpeedCourse>(&model)) {
    return {z->speed, z->course, 0.0};
  }
  if (const auto* z = std::get_if<MagneticField>(&model)) return z->field_b;
  if (const auto* z = std::get_if<AcousticFix>(&model)) {
    return {z->range, z->azimuth, z->depression};
  }
  if (const auto* z = std::get_if<GenericReading>(&model)) {
    return z->value.head<3>();
  }
  return Eigen::Vector3d::Zero();
}

void SetReading(const Eigen::Vector3d& reading, const Eigen::Vector3d& origin_e,
                MeasurementModel* model) {
  if (auto* z = std::get_if<PositionFix>(model)) {
    z->p_e = origin_e + NedAxes(origin_e) * reading;
  } else if (auto* z = std::get_if<VelocityFix>(model)) {
    z->v_n = reading;
  } else if (auto* z = std::get_if<HeightFix>(model)) {
    z->height = reading.x();
  } else if (auto* z = std::get_if<Odometer>(model)) {
    (z->form == Odometer::Form::kIncrements ? z->distance : z->speed) =
        reading.x();
  } else if (auto* z = std::get_if<Dvl>(model)) {
    z->speed.head<3>() = reading;
  } else if (auto* z = std::get_if<SpeedCourse>(model)) {
    z->speed = reading.x();
    z->course = reading.y();
  } else if (auto* z = std::get_if<MagneticField>(model)) {
    z->field_b = reading;
  } else if (auto* z = std::get_if<AcousticFix>(model)) {
    z->range = reading.x();
    z->azimuth = reading.y();
    z->depression = reading.z();
  } else if (auto* z = std::get_if<GenericReading>(model)) {
    z->value.head<3>() = reading;
  }
}

AidingStream& StreamOf(int sensor, Dataset* dataset) {
  return dataset->streams[static_cast<std::size_t>(sensor)];
}

/// The first position [m].
Eigen::Vector3d OriginOf(const MeasurementSeries& series) {
  const Measurement first = series.front();
  const auto* position = std::get_if<PositionFix>(&first.model);
  return position == nullptr ? Eigen::Vector3d::Zero() : position->p_e;
}

/// Calls with every measurement of the stream and its reading.
template <typename Function>
void EditReadings(int sensor, Dataset* dataset, Function edit) {
  MeasurementSeries& series = StreamOf(sensor, dataset).measurements;
  if (series.empty()) return;
  const Eigen::Vector3d origin_e = OriginOf(series);
  for (Measurement& z : series.Edited()) {
    Eigen::Vector3d reading = ReadingOf(z.model, origin_e);
    edit(z.t, &reading);
    SetReading(reading, origin_e, &z.model);
  }
}

template <typename Function>
void EditStamps(int sensor, Dataset* dataset, Function moved) {
  for (Measurement& z : StreamOf(sensor, dataset).measurements.Edited()) {
    z.t = moved(z.t);
    if (auto* odometer = std::get_if<Odometer>(&z.model)) {
      odometer->t_from = moved(odometer->t_from);
    }
  }
}

double Duration(const Dataset& dataset) {
  return dataset.imu.t_end() - dataset.imu.t_begin();
}

}  // namespace

double MiddleOf(const Dataset& dataset) {
  return 0.5 * (dataset.imu.t_begin() + dataset.imu.t_end());
}

void DelayStamps(double size, int sensor, std::uint64_t, Dataset* dataset) {
  EditStamps(sensor, dataset, [&](double t) { return t + size; });
}

void LeapStamps(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  EditStamps(sensor, dataset,
             [&](double t) { return t < from ? t : t + size; });
}

void StretchStamps(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const double from = dataset->imu.t_begin();
  EditStamps(sensor, dataset, [&](double t) { return t + size * (t - from); });
}

void AddBias(double size, int sensor, std::uint64_t, Dataset* dataset) {
  EditReadings(sensor, dataset,
               [&](double, Eigen::Vector3d* r) { r->x() += size; });
}

void AddStep(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  EditReadings(sensor, dataset, [&](double t, Eigen::Vector3d* r) {
    if (t >= from) r->x() += size;
  });
}

void AddRamp(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  const double length = 0.5 * Duration(*dataset);
  EditReadings(sensor, dataset, [&](double t, Eigen::Vector3d* r) {
    if (t >= from) r->x() += size * (t - from) / length;
  });
}

void AddLasting(double size, int sensor, std::uint64_t seed, Dataset* dataset) {
  constexpr double kTau = 60.0;
  Random random(seed, kFaultStream);
  Eigen::Vector3d error = size * random.NormalVector3();
  double last = dataset->imu.t_begin();
  EditReadings(sensor, dataset, [&](double t, Eigen::Vector3d* r) {
    const double phi = std::exp(-std::abs(t - last) / kTau);
    error = phi * error +
            size * std::sqrt(1.0 - phi * phi) * random.NormalVector3();
    last = t;
    *r += error;
  });
}

void AddOutliers(double size, int sensor, std::uint64_t seed,
                 Dataset* dataset) {
  constexpr double kShare = 0.1;
  Random random(seed, kFaultStream);
  EditReadings(sensor, dataset, [&](double, Eigen::Vector3d* r) {
    const bool hit = random.Uniform() < kShare;
    const Eigen::Vector3d direction = random.NormalVector3().normalized();
    if (hit) *r += size * direction;
  });
}

void ScaleReading(double size, int sensor, std::uint64_t, Dataset* dataset) {
  EditReadings(sensor, dataset,
               [&](double, Eigen::Vector3d* r) { *r *= 1.0 + size; });
}

void MultiplyReading(double size, int sensor, std::uint64_t, Dataset* dataset) {
  EditReadings(sensor, dataset,
               [&](double, Eigen::Vector3d* r) { *r *= size; });
}

void NegateReading(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const auto axis = static_cast<Eigen::Index>(size);
  EditReadings(sensor, dataset,
               [&](double, Eigen::Vector3d* r) { (*r)(axis) = -(*r)(axis); });
}

void SwapReadings(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const auto kept = static_cast<Eigen::Index>(size);
  EditReadings(sensor, dataset, [&](double, Eigen::Vector3d* r) {
    std::swap((*r)((kept + 1) % 3), (*r)((kept + 2) % 3));
  });
}

void TurnReading(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const Eigen::Matrix3d C =
      Exp(Eigen::Vector3d(0.0, 0.0, size)).toRotationMatrix();
  EditReadings(sensor, dataset,
               [&](double, Eigen::Vector3d* r) { *r = C * *r; });
}

void RepeatReading(double size, int sensor, std::uint64_t, Dataset* dataset) {
  int row = 0;
  const int every = static_cast<int>(size);
  Eigen::Vector3d kept = Eigen::Vector3d::Zero();
  EditReadings(sensor, dataset, [&](double, Eigen::Vector3d* r) {
    if (row++ % every == 0) kept = *r;
    *r = kept;
  });
}

void FreezeReading(double size, int sensor, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  std::optional<Eigen::Vector3d> kept;
  EditReadings(sensor, dataset, [&](double t, Eigen::Vector3d* r) {
    if (t < from || t > from + size) return;
    if (!kept) kept = *r;
    *r = *kept;
  });
}

void MoveLeverArm(double size, int sensor, std::uint64_t, Dataset* dataset) {
  StreamOf(sensor, dataset).sensor.lever_arm_b.x() += size;
}

void MultiplySigma(double size, int sensor, std::uint64_t, Dataset* dataset) {
  for (Measurement& z : StreamOf(sensor, dataset).measurements.Edited()) {
    ScaleSigma(size, &z);
  }
}

bool KeepReadingErrors(int sensor, const Dataset& healthy,
                       const Dataset& perfect, const Dataset& perfect_faulty,
                       Dataset* faulty) {
  constexpr double kRounding = 1e-6;  // of positions [m]
  const auto series = [sensor](const Dataset& dataset) -> const auto& {
    return dataset.streams[static_cast<std::size_t>(sensor)].measurements;
  };
  const MeasurementSeries& well = series(healthy);
  if (well.empty() || series(*faulty).size() != well.size() ||
      series(perfect).size() != well.size()) {
    return false;
  }
  const Eigen::Vector3d origin_e = OriginOf(well);
  const auto reading = [&](const MeasurementSeries& of, std::size_t k) {
    const Measurement z = of[k];
    return ReadingOf(z.model, origin_e);
  };
  bool moved = false;
  std::size_t k = 0;
  for (Measurement& z : StreamOf(sensor, faulty).measurements.Edited()) {
    const Eigen::Vector3d kept =
        reading(series(perfect_faulty), k) +
        (reading(well, k) - reading(series(perfect), k));
    moved |= !((kept - ReadingOf(z.model, origin_e)).norm() < kRounding);
    SetReading(kept, origin_e, &z.model);
    ++k;
  }
  return moved;
}

}  // namespace hindsight
