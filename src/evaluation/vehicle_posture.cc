#include "evaluation/vehicle_posture.h"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// How a vehicle goes.
struct Posture {
  std::size_t on_its_roof = 0;  ///< epochs
  double way = 0.0;             ///< along its forward axis, either way [m]
  double backwards = 0.0;       ///< of that [m]
};

Posture PostureOf(const Solution& solution, const Sensor& sensor, int index) {
  Posture posture;
  const Block* mounting = solution.layout.Find(BlockKind::kMounting, index);
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const State& x = solution.states[k];
    Eigen::Quaterniond q_ob = sensor.q_sb;
    if (mounting != nullptr) {
      q_ob = Exp(x.parameters.segment<3>(mounting->parameter_offset)) * q_ob;
    }
    const Eigen::Quaterniond q_oe = q_ob * x.q_eb.conjugate();
    const Eigen::Vector3d down_o = q_oe * x.C_en().col(2);
    if (down_o.z() < 0.0) ++posture.on_its_roof;
    if (k == 0) continue;
    const double way = (q_oe * x.v_e).x() * (x.t - solution.states[k - 1].t);
    posture.way += std::abs(way);
    if (way < 0.0) posture.backwards -= way;
  }
  return posture;
}

/// A share of what a vehicle does, which is odd from a limit on.
struct OddShare {
  double value = 0.0;
  double limit = 1.0;
  const char* words = "";  ///< with the vehicle's name and percents
};

std::vector<OddShare> SharesOf(const Posture& posture, std::size_t epochs) {
  std::vector<OddShare> shares = {
      {static_cast<double>(posture.on_its_roof) / static_cast<double>(epochs),
       0.5, "the vehicle of {} stands on its roof at {:.0f} % of all epochs"}};
  if (posture.way >= kLeastWay) {
    shares.push_back(
        {posture.backwards / posture.way, 0.9,
         "the vehicle of {} drives backwards on {:.0f} % of its way"});
  }
  return shares;
}

Evidence Odd(const OddShare& share, const std::string& sensor) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format(fmt::runtime(share.words), sensor,
                              100.0 * share.value),
          .value = share.value,
          .limit = share.limit,
          .unit = "1",
          .causes = {"axes of the IMU that are not as they are given"},
          .remedies = {"imu.axes, or mounting: unknown"},
          .is_cause = true};
}

}  // namespace

void FindOddPosture(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  const Block* attitude = solution.layout.Find(BlockKind::kAttitude);
  if (attitude == nullptr || attitude->dim != 3) return;
  for (std::size_t i = 0; i < judged.sensors.size(); ++i) {
    const Sensor& sensor = judged.sensors[i];
    // Streams that speak of another's vehicle go with it.
    if (!sensor.kind->of_vehicle || sensor.vehicle >= 0) continue;
    const Posture posture = PostureOf(solution, sensor, static_cast<int>(i));
    for (const OddShare& share : SharesOf(posture, solution.states.size())) {
      if (share.value <= share.limit) continue;
      evidence->push_back(Odd(share, sensor.name));
      return;
    }
  }
}

}  // namespace hindsight
