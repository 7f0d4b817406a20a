#include "filters/imm.h"

#include "filters/forward_pass.h"

namespace hindsight {

double ImmTape::log_likelihood() const {
  double sum = 0.0;
  for (const ImmEpoch& epoch : epochs) sum += epoch.log_likelihood;
  return sum;
}

ImmResult RunImm(const std::vector<ImmModel>& models, const ImmOptions& options,
                 Timeline* timeline, const EpochCallback& callback) {
  std::vector<PassModel> views;
  for (const ImmModel& model : models) {
    views.push_back({model.layout, model.prior, model.sigma_factors});
  }
  ForwardPass pass(views, {}, options, options.decisions, timeline);
  ImmResult result;
  pass.Record(&result);
  pass.Run(callback);
  result.tape.tapes = pass.TakeTapes();
  return result;
}

Eigen::MatrixXd StayingTransition(int count, double stay) {
  if (count == 1) return Eigen::MatrixXd::Ones(1, 1);
  const double leave = (1.0 - stay) / (count - 1);
  Eigen::MatrixXd transition = Eigen::MatrixXd::Constant(count, count, leave);
  transition.diagonal().setConstant(stay);
  return transition;
}

Gaussian Combine(const std::vector<LinearTape>& tapes,
                 const std::vector<Gaussian>& models,
                 const Eigen::VectorXd& probability) {
  std::vector<Gaussian> parts = {models.front()};
  for (std::size_t i = 1; i < models.size(); ++i) {
    parts.push_back(
        Transfer(models[i], models.front(),
                 SharedComponents(tapes[0].layout(), tapes[i].layout())));
  }
  return Merge(parts, probability);
}

void WriteCombined(const ErrorLayout& layout, const State& nominal,
                   const Gaussian& g, const Eigen::VectorXd& probability,
                   std::size_t k, ImmTrajectory* out) {
  if (out->states.size() <= k) {
    out->states.resize(k + 1);
    out->probabilities.resize(k + 1);
  }
  out->states[k] = Retract(layout, nominal, g.mean);
  out->states[k].t = nominal.t;
  const ErrorMatrix T = Transport(layout, nominal, out->states[k]);
  out->P.Set(k, ErrorMatrix(T * g.P * T.transpose()));
  out->probabilities[k] = probability;
}

}  // namespace hindsight
