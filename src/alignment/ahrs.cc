#include "alignment/ahrs.h"

#include <fmt/core.h>

#include <algorithm>

#include "alignment/attitude_start.h"
#include "alignment/magnetic_heading.h"
#include "attitude/attitude_smoother.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

AlignmentOutcome AlignByAhrs(const AlignmentInput& input) {
  constexpr double kSpan = 30.0;     // [s]
  constexpr double kShortest = 5.0;  // [s]
  const double end = std::min(input.t + kSpan, input.to);
  if (end - input.t < kShortest) {
    return {std::nullopt, "less than 5 s of IMU data"};
  }
  const ImuStream& all = input.dataset.imu;
  if (all.kind != ImuStream::Kind::kRates) {
    return {std::nullopt, "the IMU gives increments, no rates"};
  }
  ImuStream imu = all;
  EraseIf(
      [&](const ImuSample& sample) {
        return sample.t < input.t || sample.t > end;
      },
      &imu.samples);
  std::vector<MagneticSample> magnetic = MagneticSamples(input.dataset);
  std::erase_if(magnetic, [&](const MagneticSample& sample) {
    return sample.t < imu.t_begin() || sample.t > end;
  });
  AttitudeFilterOptions options = FilterOptionsOf(input.dataset);
  options.place = PlaceOnEarth(input.p_e);
  AttitudeState start = StartOfAttitude(input.dataset, imu, magnetic);
  start.b_g = input.b_g;
  const AttitudeRun run = RunAttitudeFilter(imu, {magnetic}, options, start,
                                            /*to_be_smoothed=*/true);
  const AttitudeState x = StateOf(run, SmoothAttitude(run), 0);
  AlignedAttitude out;
  out.q_nb = x.q_nb;
  out.P = x.P.topLeftCorner<3, 3>();
  out.b_g = x.b_g;
  out.b_g_sigma = x.P.diagonal().segment<3>(3).cwiseSqrt();
  constexpr double kReuse = 10.0;
  out.reuse = kReuse;
  out.attitude = fmt::format("attitude filter over {:.1f} s", end - input.t);
  out.heading = "magnetic field, by the attitude filter";
  for (const AidingStream& stream : input.dataset.streams) {
    if (!stream.sensor.kind->magnetic) continue;
    const double shared = SharedHeadingSigma(stream.sensor.magnetic);
    out.P(2, 2) = std::min(out.P(2, 2) + shared * shared,
                           kUnknownHeadingSigma * kUnknownHeadingSigma);
  }
  if (magnetic.empty()) {
    out.P(2, 2) = kUnknownHeadingSigma * kUnknownHeadingSigma;
    out.P.row(2).head<2>().setZero();
    out.P.col(2).head<2>().setZero();
    out.heading = "unknown: no magnetometer";
  }
  return {out, ""};
}

}  // namespace hindsight
