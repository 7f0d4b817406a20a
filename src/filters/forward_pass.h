#ifndef HINDSIGHT_FILTERS_FORWARD_PASS_H_
#define HINDSIGHT_FILTERS_FORWARD_PASS_H_

#include <optional>
#include <span>
#include <vector>

#include "filters/fixed_transitions.h"
#include "filters/imm.h"
#include "filters/mode_mixture.h"
#include "filters/vertical.h"
#include "timeline/time_update.h"

namespace hindsight {

/// One model of a forward pass; what it refers to must outlive the pass.
struct PassModel {
  const ErrorLayout& layout;
  const Prior& prior;
  /// Factors on the standard deviations of each sensor; empty: all 1.
  std::span<const double> sigma_factors = {};
};

/// The one walk forward over a timeline, of one filter or of several that
/// interact: RunForwardFilter, RunLinearizedFilter and RunImm, whose header
/// says what several do. One model alone is a Kalman filter.
class ForwardPass {
 public:
  /// Errors as of RunImm. All but the models is kept by reference.
  ForwardPass(const std::vector<PassModel>& models, const ForwardModel& model,
              const ImmOptions& options, const GateDecisions& decisions,
              Timeline* timeline);

  /// Writes what the filters know of each node together into `result` from here
  /// on, but for the tapes.
  void Record(ImmResult* result);

  void Run(const EpochCallback& callback);

  /// A tape a model.
  std::vector<LinearTape> TakeTapes();

 private:
  /// A model while it runs; its error about x is errors_[j].
  struct Filter {
    PassModel model;
    State x;  ///< nominal
    Transition transition;
    CovariancePolicy policy;
    LinearTape tape;
    TapeEpoch epoch;
    ErrorMatrix P_minus;
  };

  bool IsAboutFixed(std::size_t k) const { return k < options_.nominal.size(); }
  bool MaySwitch(std::size_t k) const;
  double StepTo(std::size_t k) const;
  void StartAbout(const State& nominal);
  void PredictTo(std::size_t k);
  void PredictAlong(std::size_t k);
  State Nominal(std::size_t k, std::size_t j, const NodeInterval& interval);
  void UpdateAt(std::size_t k);
  void BeginEpochs(std::size_t k);
  void OverwriteVertical(std::size_t k);
  void Use(std::size_t k, int i);
  void Linearize(std::size_t k, const Measurement& z, const Filter& f,
                 double factor);
  MeasurementVerdict JudgeTogether(std::size_t k, int i);
  void Take(std::size_t j, const TapeMeasurement& header,
            const Innovation& innovation);
  void RecordUpdate(std::size_t k, const Gaussian& combined);
  void Reset(std::size_t k, const Gaussian& combined);

  const ImmOptions& options_;
  Timeline& timeline_;
  MeasurementRule rule_;
  ErrorDefinition error_;
  std::vector<Filter> filters_;
  std::vector<Gaussian> errors_;
  ModeMixture modes_;
  VerticalChannel vertical_;
  bool masks_vertical_;
  /// Of a filter alone about a nominal that nothing overwrites.
  std::optional<FixedTransitions> fixed_;
  LinearizedMeasurement linearized_;
  ImmResult* result_ = nullptr;
  ImmEpoch epoch_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_FORWARD_PASS_H_
