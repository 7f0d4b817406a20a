#include "filters/imm.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "filters/vertical.h"
#include "measurements/distance_link.h"

namespace hindsight {
namespace {

/// A model while it runs.
struct Filter {
  const ImmModel* model;
  State x;         ///< nominal
  Gaussian error;  ///< about it
  Transition transition;
  std::vector<ComponentMap> shared;  ///< with each model, itself included
};

bool IsNavigation(const Block& block) { return block.parameter_offset < 0; }

/// `to` with the navigation state of `from`.
State WithNavigationOf(const State& from, State to) {
  to.t = from.t;
  to.p_e = from.p_e;
  to.v_e = from.v_e;
  to.q_eb = from.q_eb;
  to.b_g = from.b_g;
  to.b_a = from.b_a;
  return to;
}

class ImmPass {
 public:
  ImmPass(const std::vector<ImmModel>& models, const ImmOptions& options,
          Timeline* timeline)
      : options_(options),
        timeline_(*timeline),
        rule_(*timeline, options.decisions),
        mu_(options.start) {
    if (models.empty()) throw std::logic_error("an IMM needs a model");
    for (const ImmModel& model : models) {
      Filter& filter = filters_.emplace_back();
      filter.model = &model;
      filter.x = WithNavigationOf(models.front().prior.x, model.prior.x);
      filter.error = {ErrorVector::Zero(model.layout.dim()), model.prior.P};
      filter.transition.c = filter.error.mean;
      for (const ImmModel& other : models) {
        filter.shared.push_back(SharedComponents(model.layout, other.layout));
      }
      CheckNavigation(model.layout, filter.shared.front());
      result_.tape.tapes.emplace_back(model.layout);
    }
    result_.tape.transition = options.transition;
    masks_vertical_ = MasksVertical(models.front().layout);
    if (!options.nominal.empty()) {
      StartAbout(options.nominal.front());
      rule_.AboutFixedNominal();
    }
    result_.trajectory.P =
        CovarianceSeries(models.front().layout.dim(), timeline->size());
  }

  /// Mixes, eqs. (6) and (7), if the mode may switch at node k, and predicts,
  /// eq. (8).
  void PredictTo(std::size_t k) {
    epoch_ = {};
    epoch_.switched = MaySwitch(k);
    if (epoch_.switched) Mix();
    State nominal;
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      Filter& f = filters_[j];
      const ErrorLayout& layout = f.model->layout;
      const ImuSummary& summary =
          timeline_.Summary(k - 1, CalibrationOf(layout, f.x));
      State predicted;
      if (!options_.nominal.empty()) {
        predicted = options_.nominal[k];
      } else {
        predicted = Predict(layout, f.x, summary);
        if (j == 0) nominal = predicted;
        predicted = WithNavigationOf(nominal, predicted);
        PredictDistances(layout, timeline_, k - 1, f.x, &predicted);
      }
      LinearizeTransition(layout, summary, f.x, predicted, &f.transition);
      // Of the first model, whose prediction is the nominal, what is left of
      // the defect is rounding.
      if (options_.nominal.empty() && j == 0) f.transition.c.setZero();
      LinearizeDistances(layout, timeline_, k - 1, f.x, predicted,
                         &f.transition);
      f.error.mean = (f.transition.Phi * f.error.mean + f.transition.c).eval();
      PredictCovariance(f.transition.Phi, f.transition.Q, &f.error.P);
      f.x = predicted;
    }
  }

  /// Updates every model, eqs. (9)-(11), combines them, eq. (12), and writes
  /// the tapes.
  void UpdateAt(std::size_t k) {
    epoch_.predicted = mu_;
    if (masks_vertical_) OverwriteVertical(k);
    const std::size_t count = filters_.size();
    std::vector<TapeEpoch> epochs(count);
    std::vector<ErrorMatrix> P_minus(count);
    for (std::size_t j = 0; j < count; ++j) {
      Filter& f = filters_[j];
      epochs[j].t = timeline_.node(k).t;
      epochs[j].x_minus = f.x;
      epochs[j].c = f.transition.c;
      epochs[j].dx_minus = f.error.mean;
      P_minus[j] = f.error.P;
    }
    const auto used = static_cast<int>(timeline_.measurements(k).size());
    log_mu_ = mu_.array().log();
    for (int i = 0; i < used; ++i) Use(k, i);
    epoch_.log_likelihood = Normalize(k);
    for (std::size_t j = 0; j < count; ++j) {
      epochs[j].dx_plus = filters_[j].error.mean;
    }
    epoch_.probability = mu_;
    const Gaussian combined = CombineFilters();
    WriteCombined(filters_[0].model->layout, filters_[0].x, combined, mu_, k,
                  &result_.trajectory);
    if (options_.feedback && options_.nominal.empty()) {
      Reset(combined, &epochs);
    }
    for (std::size_t j = 0; j < count; ++j) {
      epoch_.mean_plus.push_back(filters_[j].error.mean);
      epochs[j].x_plus = filters_[j].x;
      result_.tape.tapes[j].Append(std::move(epochs[j]), filters_[j].transition,
                                   P_minus[j], filters_[j].error.P);
    }
    result_.tape.epochs.push_back(std::move(epoch_));
    epoch_ = {};
  }

  ImmResult TakeResult() { return std::move(result_); }

 private:
  static void CheckNavigation(const ErrorLayout& layout,
                              const ComponentMap& in_first) {
    for (const Block& block : layout.blocks()) {
      if (!IsNavigation(block)) continue;
      for (int i = block.offset; i < block.offset + block.dim; ++i) {
        if (in_first[static_cast<std::size_t>(i)] < 0) {
          throw std::logic_error("the first model of an IMM lacks " +
                                 layout.ComponentName(i));
        }
      }
    }
  }

  void StartAbout(const State& nominal) {
    for (Filter& f : filters_) {
      const ErrorLayout& layout = f.model->layout;
      if (nominal.parameters.size() != layout.parameter_count()) {
        throw std::logic_error("parameters of the nominal are not the models'");
      }
      f.error.mean = Local(layout, nominal, f.x);
      const ErrorMatrix T = Transport(layout, f.x, nominal);
      f.error.P = ErrorMatrix(T * f.error.P * T.transpose());
      f.x = nominal;
    }
  }

  bool MaySwitch(std::size_t k) const {
    for (const Measurement& z : timeline_.measurements(k)) {
      const bool named =
          options_.sensors.empty() ||
          std::find(options_.sensors.begin(), options_.sensors.end(),
                    z.sensor) != options_.sensors.end();
      if (named && !z.withheld) return true;
    }
    return false;
  }

  std::vector<Gaussian> SeenBy(std::size_t j) const {
    std::vector<Gaussian> parts;
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      parts.push_back(i == j ? filters_[j].error
                             : Transfer(filters_[i].error, filters_[j].error,
                                        filters_[j].shared[i]));
    }
    return parts;
  }

  void Mix() {
    const Eigen::MatrixXd joint =
        mu_.asDiagonal() * options_.transition;  // of modes i, then j
    std::vector<Gaussian> mixed;
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      const Eigen::VectorXd column = joint.col(static_cast<Eigen::Index>(j));
      mixed.push_back(Merge(SeenBy(j), column / column.sum()));
    }
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      filters_[j].error = std::move(mixed[j]);
    }
    mu_ = joint.colwise().sum().transpose();
  }

  void OverwriteVertical(std::size_t k) {
    State& first = filters_[0].x;
    vertical_.Overwrite(timeline_, k, filters_[0].model->layout, &first);
    for (Filter& f : filters_) f.x = WithNavigationOf(first, f.x);
  }

  double FactorOf(std::size_t j, int sensor) const {
    const std::vector<double>& factors = filters_[j].model->sigma_factors;
    return factors.empty() ? 1.0 : factors[static_cast<std::size_t>(sensor)];
  }

  /// What the models' mixture makes of measurement i of node k.
  MeasurementVerdict JudgeTogether(std::size_t k, int i) {
    const Measurement& z =
        timeline_.measurements(k)[static_cast<std::size_t>(i)];
    const Filter& first = filters_.front();
    Evaluate(z, timeline_.Context(k, z, first.model->layout, first.x),
             &linearized_);
    double mean_square = 0.0;
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      const double factor = FactorOf(j, z.sensor);
      mean_square += mu_(static_cast<Eigen::Index>(j)) * factor * factor;
    }
    linearized_.R *= mean_square;
    const Gaussian combined = CombineFilters();
    Innovation innovation;
    return rule_.Judge(k, i, combined.mean, combined.P, &linearized_,
                       &innovation);
  }

  MeasurementVerdict Judge(std::size_t k, int i) {
    const Measurement& z =
        timeline_.measurements(k)[static_cast<std::size_t>(i)];
    if (rule_.AsksTheInnovation(z.sensor)) return JudgeTogether(k, i);
    return {.weight = 1.0, .accepted = rule_.MayUse(k, i)};
  }

  /// Sets the modes' probabilities from their unscaled logarithms; returns the
  /// logarithm of the sum.
  double Normalize(std::size_t k) {
    const double largest = log_mu_.maxCoeff();
    if (!std::isfinite(largest)) {
      throw EstimationError(
          "no model of the IMM explains the measurements at "
          "t = " +
          std::to_string(timeline_.node(k).t) + " s");
    }
    mu_ = (log_mu_.array() - largest).exp();
    const double sum = mu_.sum();
    mu_ /= sum;
    return largest + std::log(sum);
  }

  /// Updates every model and its likelihood with measurement i of node k.
  void Use(std::size_t k, int i) {
    const Measurement& z =
        timeline_.measurements(k)[static_cast<std::size_t>(i)];
    Normalize(k);
    const MeasurementVerdict verdict = Judge(k, i);
    TapeMeasurement header;
    header.index = i;
    header.sensor = z.sensor;
    header.withheld = z.withheld;
    header.accepted = verdict.accepted;
    header.weight = verdict.weight;
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      Filter& f = filters_[j];
      Evaluate(z, timeline_.Context(k, z, f.model->layout, f.x), &linearized_);
      const double factor = FactorOf(j, z.sensor);
      linearized_.R *= factor * factor / verdict.weight;
      const Innovation innovation =
          Innovate(linearized_, f.error.mean, f.error.P);
      result_.tape.tapes[j].Record(header, linearized_, innovation);
      if (!header.accepted) continue;
      log_mu_(static_cast<Eigen::Index>(j)) += innovation.log_likelihood;
      Update(linearized_, innovation, &f.error.mean, &f.error.P);
    }
  }

  Gaussian CombineFilters() const { return Merge(SeenBy(0), mu_); }

  /// Moves every nominal by the combined mean and the models' errors into the
  /// tangent there.
  void Reset(const Gaussian& combined, std::vector<TapeEpoch>* epochs) {
    std::vector<ErrorVector> steps;
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      steps.push_back(j == 0 ? combined.mean : Merge(SeenBy(j), mu_).mean);
      for (std::size_t i = 0; i < filters_[j].shared[0].size(); ++i) {
        const int first = filters_[j].shared[0][i];
        if (first >= 0) {
          steps[j](static_cast<Eigen::Index>(i)) = combined.mean(first);
        }
      }
    }
    for (std::size_t j = 0; j < filters_.size(); ++j) {
      Filter& f = filters_[j];
      const ErrorLayout& layout = f.model->layout;
      const State from = f.x;
      f.x = Retract(layout, from, steps[j]);
      (*epochs)[j].reset = true;
      const ErrorMatrix T = Transport(layout, from, f.x);
      f.error.mean = (T * (f.error.mean - steps[j])).eval();
      const ErrorMatrix TP = T * f.error.P;
      f.error.P.noalias() = TP * T.transpose();
      Symmetrize(&f.error.P);
    }
  }

  const ImmOptions& options_;
  Timeline& timeline_;
  MeasurementRule rule_;
  std::vector<Filter> filters_;
  Eigen::VectorXd mu_;
  Eigen::VectorXd log_mu_;  ///< of the node's update so far, unscaled
  ImmEpoch epoch_;
  ImmResult result_;
  LinearizedMeasurement linearized_;
  bool masks_vertical_ = false;
  VerticalChannel vertical_;
};

}  // namespace

double ImmTape::log_likelihood() const {
  double sum = 0.0;
  for (const ImmEpoch& epoch : epochs) sum += epoch.log_likelihood;
  return sum;
}

ImmResult RunImm(const std::vector<ImmModel>& models, const ImmOptions& options,
                 Timeline* timeline, const EpochCallback& callback) {
  ImmPass pass(models, options, timeline);
  for (std::size_t k = 0; k < timeline->size(); ++k) {
    if (k > 0) pass.PredictTo(k);
    pass.UpdateAt(k);
    if (callback) callback(k + 1);
  }
  return pass.TakeResult();
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
