#include "receiver_errors/held_out_prediction.h"

#include <algorithm>
#include <cmath>

namespace hindsight {
namespace {

double LogSumOf(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double one : logs) sum += std::exp(one - most);
  return most + std::log(sum);
}

}  // namespace

HeldOutPrediction::HeldOutPrediction(const SensorTape& tape,
                                     const Hypothesis& hypothesis)
    : splice_(tape, hypothesis.parameters, hypothesis.sequence),
      chain_(tape, hypothesis.parameters),
      tape_(tape) {}

HeldOutScore HeldOutPrediction::Score(const HeldOutStretch& stretch) {
  const auto fixes = static_cast<double>(stretch.end - stretch.begin);
  const std::optional<ErrorStep> change = LastChange(stretch);
  const std::vector<Prediction> before = Predict(stretch, {}, change);
  HeldOutScore score;
  double squares = 0.0;
  if (!change) {
    for (const Prediction& one : before) {
      score.log_density += one.log / fixes;
      squares += one.square / fixes;
    }
  } else {
    const std::vector<Prediction> after = Predict(stretch, change, {});
    std::vector<double> logs(1, 0.0);
    for (const Prediction& one : after) logs[0] += one.log;
    for (std::size_t c = 0; c < before.size(); ++c) {
      logs.push_back(logs.back() + before[c].log - after[c].log);
      squares += std::min(before[c].square, after[c].square) / fixes;
    }
    score.log_density = (LogSumOf(logs) - std::log(fixes + 1.0)) / fixes;
  }
  score.log_distance = 0.5 * std::log1p(squares);
  return score;
}

std::optional<ErrorStep> HeldOutPrediction::LastChange(
    const HeldOutStretch& stretch) const {
  const ModeSequence& base = splice_.base();
  std::optional<ErrorStep> change;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    const ErrorMode mode = i == 0 ? ErrorMode::kGood : base[i - 1].mode;
    if (base[i].anew || base[i].mode != mode) change = base[i];
  }
  if (!change) return change;
  change->velocity_step = false;
  change->onset = Onset::kUsual;
  const ErrorMode before =
      stretch.begin == 0 ? ErrorMode::kGood : base[stretch.begin - 1].mode;
  if (change->mode == ErrorMode::kGood && before == ErrorMode::kGood) {
    return std::nullopt;
  }
  // What it follows is taken back, so that there is nothing to follow.
  if (change->mode == ErrorMode::kBiased && before != ErrorMode::kDrifting) {
    change->anew = true;
  }
  return change;
}

std::vector<HeldOutPrediction::Prediction> HeldOutPrediction::Predict(
    const HeldOutStretch& stretch, std::optional<ErrorStep> at_begin,
    std::optional<ErrorStep> at_end) {
  SequenceSplice::Before at = splice_.BeforeFix(stretch.begin);
  const std::size_t first = at.node;
  std::vector<Gaussian> predicted;
  std::vector<ErrorStep> steps;
  std::size_t left = stretch.end - stretch.begin;
  for (std::size_t k = first; left > 0; ++k) {
    chain_.MoveTo(k);
    ErrorStep step = {at.mode};
    if (k == first && at_begin) step = *at_begin;
    at.mode = step.mode;
    chain_.PredictNavigation(&at.x);
    chain_.PredictError(step, &at.x);
    chain_.UpdateOthers(&at.x);
    predicted.push_back(at.x);
    steps.push_back(step);
    if (chain_.has_fix()) --left;
  }
  return Join(stretch, first, predicted, steps, at_end);
}

std::vector<HeldOutPrediction::Prediction> HeldOutPrediction::Join(
    const HeldOutStretch& stretch, std::size_t first,
    const std::vector<Gaussian>& predicted, const std::vector<ErrorStep>& steps,
    std::optional<ErrorStep> at_end) {
  LaterLikelihood later = splice_.After(stretch.end - 1);
  if (at_end) {
    later.BackOver(chain_.PhiAtOnce(*at_end), chain_.QAtOnce(*at_end),
                   ErrorVector::Zero(chain_.dim()));
  }
  std::vector<Prediction> fixes;
  for (std::size_t i = predicted.size(); i-- > 0;) {
    chain_.MoveTo(first + i);
    if (chain_.has_fix()) {
      fixes.push_back(PredictFix(later.Joined(predicted[i]), first + i));
    }
    for (std::size_t m = 0; m < chain_.measurements().size(); ++m) {
      if (!chain_.IsFix(m)) later.Add(chain_.measurements()[m]);
    }
    if (i > 0) {
      later.BackOver(chain_.Phi(steps[i]), chain_.Q(steps[i]), chain_.Defect());
    }
  }
  std::reverse(fixes.begin(), fixes.end());
  return fixes;
}

HeldOutPrediction::Prediction HeldOutPrediction::PredictFix(
    const Gaussian& x, std::size_t k) const {
  constexpr double kUniform = 0.01;
  constexpr double kWidth = 200.0;  // sigma
  for (const TapeMeasurement& z : tape_.linear().measurements(k)) {
    if (z.sensor != tape_.sensor() || !z.accepted || z.withheld) continue;
    const LinearizedMeasurement& fix = chain_.measurements().front();
    const RowVector off = fix.residual - fix.H.leftCols(x.mean.size()) * x.mean;
    Prediction out;
    double uniform = std::log(kUniform);
    for (Eigen::Index i = 0; i < z.R.rows(); ++i) {
      uniform -= std::log(kWidth * std::sqrt(z.R(i, i)));
      out.square += off(i) * off(i) / z.R(i, i);
    }
    out.log = LogSumOf(
        {std::log1p(-kUniform) + chain_.LikelihoodOfFix({}, x).log, uniform});
    return out;
  }
  return {};
}

}  // namespace hindsight
