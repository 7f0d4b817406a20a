#include "filters/tape_gains.h"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

#include "base/error.h"

namespace hindsight {

std::vector<Eigen::MatrixXd> GainsAt(const LinearTape& tape, std::size_t k) {
  std::vector<Eigen::MatrixXd> gains;
  ErrorMatrix P = tape.P_minus(k);
  for (const TapeMeasurement& z : tape.measurements(k)) {
    gains.emplace_back();
    if (!z.accepted) continue;
    const Eigen::MatrixXd HP = z.H * P;
    gains.back() = Eigen::LLT<Eigen::MatrixXd>(z.S).solve(HP).transpose();
    P -= gains.back() * HP;
  }
  return gains;
}

void RequireFixedNominal(const LinearTape& tape) {
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (!tape.epoch(k).moves_nominal()) continue;
    throw std::logic_error("a deviation from a tape whose nominal moves");
  }
}

Eigen::MatrixXd Smoothed(const LinearTape& tape, std::size_t k,
                         const Eigen::MatrixXd& ahead) {
  const Eigen::LLT<ErrorMatrix> P(tape.P_minus(k + 1));
  if (P.info() != Eigen::Success) {
    throw EstimationError(
        "predicted covariance is not positive definite at t = " +
        std::to_string(tape.epoch(k + 1).t) + " s");
  }
  return tape.P_plus(k) * (tape.Phi(k + 1).transpose() * P.solve(ahead));
}

}  // namespace hindsight
