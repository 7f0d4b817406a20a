#include "simulation/fault.h"

#include <utility>

#include "measurements/sensor_kind.h"
#include "simulation/fault_effects.h"

namespace hindsight {
namespace {

constexpr auto kOfSensor = FaultKind::Of::kSensor;
constexpr auto kOfImu = FaultKind::Of::kImu;
constexpr auto kOfStart = FaultKind::Of::kStart;
constexpr auto kOwn = FaultKind::Size::kQuantity;
constexpr auto kFactor = FaultKind::Size::kFactor;
constexpr auto kAxis = FaultKind::Size::kAxis;
constexpr auto kCount = FaultKind::Size::kCount;
constexpr auto kValues = FaultKind::Size::kOfSensor;

}  // namespace

const std::vector<FaultKind>& FaultKinds() {
  using Q = Quantity;
  static const std::vector<FaultKind> kinds = {
      {"delay", kOfSensor, kOwn, Q::kTime, "stamps late by", DelayStamps},
      {"clock_leap", kOfSensor, kOwn, Q::kTime,
       "from the middle on stamps late by", LeapStamps},
      {"clock_drift", kOfSensor, kOwn, Q::kRatio, "the clock fast by",
       StretchStamps},
      {"bias", kOfSensor, kValues, Q::kRatio, "first value too large by",
       AddBias},
      {"step", kOfSensor, kValues, Q::kRatio,
       "first value too large by, from the middle on", AddStep},
      {"ramp", kOfSensor, kValues, Q::kRatio,
       "first value too large, from 0 in the middle to this at the end",
       AddRamp},
      {"lasting", kOfSensor, kValues, Q::kRatio,
       "Gauss-Markov error of this sigma over 60 s, each axis", AddLasting},
      {"outliers", kOfSensor, kValues, Q::kRatio,
       "10 % of the readings off by, in any direction", AddOutliers},
      {"scale", kOfSensor, kOwn, Q::kRatio, "values too large by",
       ScaleReading},
      {"unit", kOfSensor, kFactor, Q::kRatio, "values times", MultiplyReading},
      {"negated", kOfSensor, kAxis, Q::kRatio, "sign of the value of number",
       NegateReading},
      {"swapped", kOfSensor, kAxis, Q::kRatio,
       "the two values exchanged besides that of number", SwapReadings},
      {"turned", kOfSensor, kOwn, Q::kAngle, "values turned about the third by",
       TurnReading},
      {"stale", kOfSensor, kCount, Q::kRatio, "each reading said so many times",
       RepeatReading},
      {"frozen", kOfSensor, kOwn, Q::kTime,
       "from the middle on the same reading for", FreezeReading},
      {"lever_arm", kOfSensor, kOwn, Q::kLength,
       "stated lever arm too far forward by", MoveLeverArm},
      {"sigma", kOfSensor, kFactor, Q::kRatio, "stated sigma times",
       MultiplySigma},
      {"imu_turned", kOfImu, kOwn, Q::kAngle, "IMU pitched by", TurnImu},
      {"gyro_unit", kOfImu, kFactor, Q::kRatio, "rates times", MultiplyGyro},
      {"accel_unit", kOfImu, kFactor, Q::kRatio, "specific forces times",
       MultiplyAccel},
      {"gyro_negated", kOfImu, kAxis, Q::kRatio, "sign of the axis of number",
       NegateGyro},
      {"accel_negated", kOfImu, kAxis, Q::kRatio, "sign of the axis of number",
       NegateAccel},
      {"imu_swapped", kOfImu, kAxis, Q::kRatio,
       "the two axes exchanged besides that of number", SwapImuAxes},
      {"accel_swapped", kOfImu, kAxis, Q::kRatio,
       "the two accelerometers exchanged besides that of number", SwapAccel},
      {"gyro_step", kOfImu, kOwn, Q::kAngularRate,
       "from the middle on the z gyro too large by", StepGyro},
      {"accel_step", kOfImu, kOwn, Q::kAcceleration,
       "from the middle on the x accelerometer too large by", StepAccel},
      {"warm_up", kOfImu, kOwn, Q::kAngularRate,
       "gyro biases that decay with 60 s from", WarmGyros},
      {"imu_noise", kOfImu, kFactor, Q::kRatio, "stated noise times",
       MultiplyImuNoise},
      {"imu_rate", kOfImu, kOwn, Q::kRatio, "intervals of stamps too long by",
       StretchImu},
      {"imu_frozen", kOfImu, kOwn, Q::kTime,
       "from the middle on the same sample for", FreezeImu},
      {"imu_leap", kOfImu, kOwn, Q::kTime,
       "from the middle on stamps late by, with no sample lost", LeapImu},
      {"imu_gap", kOfImu, kOwn, Q::kTime, "from the middle on samples lost for",
       LoseSamples},
      {"start_heading", kOfStart, kOwn, Q::kAngle, "given heading too large by",
       TurnStart},
      {"start_position", kOfStart, kOwn, Q::kLength,
       "given position too far north by", MoveStart},
  };
  return kinds;
}

const FaultKind* FindFaultKind(std::string_view name) {
  for (const FaultKind& kind : FaultKinds()) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

Quantity ReadingQuantity(const SensorKind& kind) {
  if (kind.magnetic) return Quantity::kMagneticField;
  if (kind.is_position || kind.is_height || kind.places) {
    return Quantity::kLength;
  }
  return Quantity::kSpeed;
}

namespace {

/// The first sensor of that kind, or -1.
int FirstOf(const std::string& kind, const Dataset& dataset) {
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    if (dataset.streams[i].sensor.kind->name == kind) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace

bool HasPlaceFor(const Fault& fault, const Dataset& dataset) {
  switch (fault.kind->of) {
    case FaultKind::Of::kSensor:
      return FirstOf(fault.sensor, dataset) >= 0;
    case FaultKind::Of::kImu:
      return true;
    case FaultKind::Of::kStart:
      return dataset.initial.euler.has_value();
  }
  return false;
}

void ApplyFault(const Fault& fault, std::uint64_t seed, Dataset* dataset) {
  fault.kind->apply(fault.size, FirstOf(fault.sensor, *dataset), seed, dataset);
}

std::optional<Dataset> WithErrorsAsTheyWere(const Fault& fault,
                                            std::uint64_t seed,
                                            const Dataset& healthy,
                                            Dataset perfect) {
  Dataset faulty = healthy;
  ApplyFault(fault, seed, &faulty);
  const Dataset before = perfect;
  ApplyFault(fault, seed, &perfect);
  bool moved = KeepImuErrors(healthy, before, perfect, &faulty);
  for (std::size_t i = 0; i < faulty.streams.size(); ++i) {
    moved |= KeepReadingErrors(static_cast<int>(i), healthy, before, perfect,
                               &faulty);
  }
  return moved ? std::optional(std::move(faulty)) : std::nullopt;
}

}  // namespace hindsight
