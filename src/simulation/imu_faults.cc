#include <cmath>
#include <optional>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "simulation/fault_effects.h"

namespace hindsight {
namespace {

template <typename Function>
void EditSamples(Dataset* dataset, Function edit) {
  for (ImuSample& sample : dataset->imu.samples) edit(&sample);
}

/// What one increment of the stream is, of a rate.
double RateUnit(const Dataset& dataset) {
  return dataset.imu.kind == ImuStream::Kind::kRates
             ? 1.0
             : MedianInterval(dataset.imu);
}

}  // namespace

void TurnImu(double size, int, std::uint64_t, Dataset* dataset) {
  const Eigen::Matrix3d C =
      Exp(Eigen::Vector3d(0.0, size, 0.0)).toRotationMatrix();
  EditSamples(dataset, [&](ImuSample* sample) {
    sample->gyro = C * sample->gyro;
    sample->accel = C * sample->accel;
  });
}

void MultiplyGyro(double size, int, std::uint64_t, Dataset* dataset) {
  EditSamples(dataset, [&](ImuSample* sample) { sample->gyro *= size; });
}

void MultiplyAccel(double size, int, std::uint64_t, Dataset* dataset) {
  EditSamples(dataset, [&](ImuSample* sample) { sample->accel *= size; });
}

void NegateGyro(double size, int, std::uint64_t, Dataset* dataset) {
  const auto axis = static_cast<Eigen::Index>(size);
  EditSamples(dataset, [&](ImuSample* sample) {
    sample->gyro(axis) = -sample->gyro(axis);
  });
}

void NegateAccel(double size, int, std::uint64_t, Dataset* dataset) {
  const auto axis = static_cast<Eigen::Index>(size);
  EditSamples(dataset, [&](ImuSample* sample) {
    sample->accel(axis) = -sample->accel(axis);
  });
}

void SwapImuAxes(double size, int, std::uint64_t, Dataset* dataset) {
  const auto kept = static_cast<Eigen::Index>(size);
  EditSamples(dataset, [&](ImuSample* sample) {
    for (Eigen::Vector3d* v : {&sample->gyro, &sample->accel}) {
      std::swap((*v)((kept + 1) % 3), (*v)((kept + 2) % 3));
    }
  });
}

void SwapAccel(double size, int, std::uint64_t, Dataset* dataset) {
  const auto kept = static_cast<Eigen::Index>(size);
  EditSamples(dataset, [&](ImuSample* sample) {
    std::swap(sample->accel((kept + 1) % 3), sample->accel((kept + 2) % 3));
  });
}

void StepGyro(double size, int, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  const double unit = RateUnit(*dataset);
  EditSamples(dataset, [&](ImuSample* sample) {
    if (sample->t >= from) sample->gyro.z() += size * unit;
  });
}

void StepAccel(double size, int, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  const double unit = RateUnit(*dataset);
  EditSamples(dataset, [&](ImuSample* sample) {
    if (sample->t >= from) sample->accel.x() += size * unit;
  });
}

void WarmGyros(double size, int, std::uint64_t, Dataset* dataset) {
  constexpr double kTau = 60.0;
  const double from = dataset->imu.t_begin();
  const double unit = RateUnit(*dataset);
  EditSamples(dataset, [&](ImuSample* sample) {
    sample->gyro.array() += size * unit * std::exp((from - sample->t) / kTau);
  });
}

void MultiplyImuNoise(double size, int, std::uint64_t, Dataset* dataset) {
  ImuNoise& noise = dataset->imu.noise;
  noise.gyro_noise_density *= size;
  noise.accel_noise_density *= size;
  noise.gyro_bias_walk *= size;
  noise.accel_bias_walk *= size;
}

void StretchImu(double size, int, std::uint64_t, Dataset* dataset) {
  const double from = dataset->imu.t_begin();
  EditSamples(dataset, [&](ImuSample* sample) {
    sample->t = from + (1.0 + size) * (sample->t - from);
  });
}

void FreezeImu(double size, int, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  std::optional<ImuSample> kept;
  EditSamples(dataset, [&](ImuSample* sample) {
    if (sample->t < from || sample->t > from + size) return;
    if (!kept) kept = *sample;
    sample->gyro = kept->gyro;
    sample->accel = kept->accel;
  });
}

// Of a recording the reader knows the usual interval: drop-outs are seen by it.

void LeapImu(double size, int, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  dataset->imu.nominal_dt = MedianInterval(dataset->imu);
  EditSamples(dataset, [&](ImuSample* sample) {
    if (sample->t >= from) sample->t += size;
  });
}

void LoseSamples(double size, int, std::uint64_t, Dataset* dataset) {
  const double from = MiddleOf(*dataset);
  dataset->imu.nominal_dt = MedianInterval(dataset->imu);
  EraseIf(
      [&](const ImuSample& sample) {
        return sample.t >= from && sample.t < from + size;
      },
      &dataset->imu.samples);
}

void TurnStart(double size, int, std::uint64_t, Dataset* dataset) {
  if (dataset->initial.euler) dataset->initial.euler->z() += size;
}

void MoveStart(double size, int, std::uint64_t, Dataset* dataset) {
  if (!dataset->initial.position) return;
  Geodetic& position = *dataset->initial.position;
  position.latitude += size / MeridianRadius(position.latitude);
}

bool KeepImuErrors(const Dataset& healthy, const Dataset& perfect,
                   const Dataset& perfect_faulty, Dataset* faulty) {
  constexpr double kRounding = 1e-12;
  const auto& well = healthy.imu.samples;
  auto& samples = faulty->imu.samples;
  if (samples.size() != well.size() ||
      perfect.imu.samples.size() != well.size()) {
    return false;
  }
  bool moved = false;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const ImuSample& truth = perfect.imu.samples[k];
    const ImuSample& wrong = perfect_faulty.imu.samples[k];
    for (Eigen::Vector3d ImuSample::*triad :
         {&ImuSample::gyro, &ImuSample::accel}) {
      const Eigen::Vector3d kept =
          wrong.*triad + (well[k].*triad - truth.*triad);
      moved |= !kept.isApprox(samples[k].*triad, kRounding);
      samples[k].*triad = kept;
    }
  }
  return moved;
}

}  // namespace hindsight
