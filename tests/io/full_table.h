#ifndef HINDSIGHT_TESTS_IO_FULL_TABLE_H_
#define HINDSIGHT_TESTS_IO_FULL_TABLE_H_

#include "base/random.h"
#include "base/units.h"
#include "evaluation/solution_table.h"

namespace hindsight {

inline Eigen::Matrix3d RandomCovariance(double scale, Random* random) {
  Eigen::Matrix3d A;
  for (int i = 0; i < 3; ++i) A.col(i) = random->NormalVector3();
  return scale * scale * (A * A.transpose() + Eigen::Matrix3d::Identity());
}

/// Epochs that start west of the date line and end east of it.
inline SolutionTable FullTable() {
  Random random(3);
  SolutionTable table;
  table.method = "batch";
  for (int k = 0; k < 20; ++k) {
    const State x = MakeState(
        456300.125 + k / 3.0,
        {-0.7 + 1e-3 * k, WrapAngle(kPi - 0.01 + 1e-3 * k), 10.0 * k - 30.0},
        10.0 * random.NormalVector3(), random.NormalVector3());
    table.t.push_back(x.t);
    table.p_e.push_back(x.p_e);
    table.v_e.push_back(x.v_e);
    table.q_eb.push_back(x.q_eb);
    table.P_position.push_back(RandomCovariance(0.02, &random));
    table.P_velocity.push_back(RandomCovariance(1e-3, &random));
    table.P_attitude.push_back(RandomCovariance(1e-4, &random));
    table.sigma_euler.emplace_back(1e-4 * random.NormalVector3().cwiseAbs());
    table.b_g.emplace_back(1e-5 * random.NormalVector3());
    table.b_a.emplace_back(1e-2 * random.NormalVector3());
    table.sigma_b_g.emplace_back(1e-6 * random.NormalVector3().cwiseAbs());
    table.sigma_b_a.emplace_back(1e-3 * random.NormalVector3().cwiseAbs());
  }
  return table;
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_FULL_TABLE_H_
