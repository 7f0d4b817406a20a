#include "alignment/attitude_rest.h"

#include <algorithm>

#include "dataset/rest.h"
#include "imu/mean_reading.h"
#include "imu/sample_search.h"

namespace hindsight {

std::vector<bool> RestsBetweenSamples(const Dataset& dataset,
                                      const ImuStream& imu,
                                      const AttitudeState& start) {
  std::vector<bool> rests(imu.samples.size(), false);
  Dataset still;
  still.imu = imu;
  for (ImuSample& sample : still.imu.samples) sample.accel -= start.b_a;
  still.stationary = dataset.stationary;
  still.initial = dataset.initial;
  const Rest rest = FindRest(still);
  const Eigen::Vector3d sigma = start.P.diagonal().segment<3>(3).cwiseSqrt();
  constexpr double kSigmas = 3.0;
  // A motion that begins or ends slowly is quiet at first, too: the rest is
  // taken to be shorter by a window on either side.
  const double margin = dataset.stationary.window;
  const auto at = [&imu](double t) { return FirstSampleAt(imu, t); };
  for (const auto* spans : {&rest.at_rest, &rest.moving, &rest.undecided}) {
    for (const TimeInterval& span : *spans) {
      const Eigen::Vector3d rate =
          MeanReading(imu, span.begin, span.end).w_ib_b - start.b_g;
      if ((rate.cwiseAbs().array() > kSigmas * sigma.array()).any()) continue;
      const double begin =
          span.begin <= imu.t_begin() ? span.begin : span.begin + margin;
      const double end = span.end >= imu.t_end() ? span.end : span.end - margin;
      for (std::size_t k = at(begin);
           k + 1 < rests.size() && imu.samples[k + 1].t <= end; ++k) {
        rests[k] = true;
      }
    }
  }
  return rests;
}

}  // namespace hindsight
