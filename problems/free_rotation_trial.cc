#include "problems/free_rotation_trial.h"

#include <Eigen/Cholesky>

#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/statistics.h"
#include "geometry/so3.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

void JudgeRotation(const Dataset& dataset, const Solution& solution,
                   RunRecord* record) {
  constexpr std::size_t kEvery = 10;
  constexpr double kThreeSigmas = 0.9973;
  static const double kLimit = ChiSquareQuantile(kThreeSigmas, 3.0);
  auto& series = record->series;
  for (std::size_t k = 0; k < solution.states.size(); k += kEvery) {
    const State& x = solution.states[k];
    const Eigen::Vector3d psi = RotationError(dataset.truth[k], x);
    const Eigen::Matrix3d P = solution.covariances.Get(k).topLeftCorner<3, 3>();
    const double nees = psi.dot(P.llt().solve(psi));
    record->t.push_back(x.t);
    series["heading"].push_back(psi.z());
    series["tilt"].push_back(psi.head<2>().norm());
    series["nees"].push_back(nees);
    series["inside"].push_back(nees <= kLimit ? 1.0 : 0.0);
  }
}

}  // namespace

Eigen::Vector3d RotationError(const TruthPoint& truth, const State& x) {
  const Eigen::Quaterniond q_ne(Eigen::Matrix3d(x.C_en().transpose()));
  return Log(*truth.q_nb * (q_ne * x.q_eb).conjugate());
}

StudyTable FreeRotationTable(double begin, double end) {
  const double middle = 0.5 * (begin + end);
  constexpr double kHalfStep = 0.05;
  StudyTable table = {"cells", {"field", "method"}, {}, {}};
  table.figures = {Single("heading_rms", kDegrees, "heading\nrms [deg]",
                          "{:.3f}", "heading", OfAll<Rms>),
                   Single("tilt_rms", kDegrees, "tilt\nrms [deg]", "{:.3f}",
                          "tilt", OfAll<Rms>),
                   Single("nees", kPlain, "NEES (3)\nattitude", "{:.2f}",
                          "nees", OfAll<Mean>),
                   Share("inside", "inside\n[%]", "inside", OfAll<Mean>)};
  for (Figure& figure : table.figures) {
    figure.range = {begin, end};
  }
  table.figures[2].range = {middle - kHalfStep, middle + kHalfStep};
  return table;
}

Trial FreeRotationTrial() {
  return [](const Dataset& dataset, CaseRun* run) {
    Reconstruction estimation(dataset, AttitudeAlone());
    for (const char* method : {"ahrs", "ahrs_smoother"}) {
      run->Try({method}, [&](RunRecord* record) {
        JudgeRotation(dataset, estimation.Run(method), record);
      });
    }
  };
}

}  // namespace hindsight
