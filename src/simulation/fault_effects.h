#ifndef HINDSIGHT_SIMULATION_FAULT_EFFECTS_H_
#define HINDSIGHT_SIMULATION_FAULT_EFFECTS_H_

#include <cstdint>

#include "dataset/dataset.h"

namespace hindsight {

/// What the kinds of faults do (simulation/fault.h), as FaultKind::apply.

/// To a sensor.
void DelayStamps(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void LeapStamps(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void StretchStamps(double size, int sensor, std::uint64_t seed,
                   Dataset* dataset);
void AddBias(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void AddStep(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void AddRamp(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void AddLasting(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void AddOutliers(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void ScaleReading(double size, int sensor, std::uint64_t seed,
                  Dataset* dataset);
void MultiplyReading(double size, int sensor, std::uint64_t seed,
                     Dataset* dataset);
void NegateReading(double size, int sensor, std::uint64_t seed,
                   Dataset* dataset);
void SwapReadings(double size, int sensor, std::uint64_t seed,
                  Dataset* dataset);
void TurnReading(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void RepeatReading(double size, int sensor, std::uint64_t seed,
                   Dataset* dataset);
void FreezeReading(double size, int sensor, std::uint64_t seed,
                   Dataset* dataset);
void MoveLeverArm(double size, int sensor, std::uint64_t seed,
                  Dataset* dataset);
void MultiplySigma(double size, int sensor, std::uint64_t seed,
                   Dataset* dataset);

/// To the IMU and the start.
void TurnImu(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void MultiplyGyro(double size, int sensor, std::uint64_t seed,
                  Dataset* dataset);
void MultiplyAccel(double size, int sensor, std::uint64_t seed,
                   Dataset* dataset);
void NegateGyro(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void NegateAccel(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void SwapImuAxes(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void SwapAccel(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void StepGyro(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void StepAccel(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void WarmGyros(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void MultiplyImuNoise(double size, int sensor, std::uint64_t seed,
                      Dataset* dataset);
void StretchImu(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void FreezeImu(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void LeapImu(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void LoseSamples(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void TurnStart(double size, int sensor, std::uint64_t seed, Dataset* dataset);
void MoveStart(double size, int sensor, std::uint64_t seed, Dataset* dataset);

/// Puts the errors that `healthy` has beside `perfect` onto `perfect_faulty`, and
/// that into `faulty`: of the IMU, or of a sensor. Whether anything changes; not
/// where rows were lost.
bool KeepImuErrors(const Dataset& healthy, const Dataset& perfect,
                   const Dataset& perfect_faulty, Dataset* faulty);
bool KeepReadingErrors(int sensor, const Dataset& healthy,
                       const Dataset& perfect, const Dataset& perfect_faulty,
                       Dataset* faulty);

/// Where faults that do not last for the whole recording begin [s].
double MiddleOf(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_FAULT_EFFECTS_H_
