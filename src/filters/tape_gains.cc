#include "filters/tape_gains.h"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

#include "base/error.h"

namespace hindsight {

void RequireFixedNominal(const LinearTape& tape) {
  if (tape.moves_nominal()) {
    throw std::logic_error("a deviation from a tape whose nominal moves");
  }
}

Eigen::MatrixXd Smoothed(const LinearTape& tape, std::size_t k,
                         const Eigen::MatrixXd& ahead) {
  const Eigen::LLT<ErrorMatrix> P(tape.P_minus(k + 1));
  if (P.info() != Eigen::Success) {
    throw EstimationError(
        "predicted covariance is not positive definite at t = " +
        std::to_string(tape.t(k + 1)) + " s");
  }
  return tape.P_plus(k) * (tape.Phi(k + 1).transpose() * P.solve(ahead));
}

}  // namespace hindsight
