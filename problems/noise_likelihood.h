#ifndef HINDSIGHT_PROBLEMS_NOISE_LIKELIHOOD_H_
#define HINDSIGHT_PROBLEMS_NOISE_LIKELIHOOD_H_

#include <functional>
#include <string>
#include <vector>

#include "alignment/start.h"
#include "dataset/dataset.h"
#include "measurements/sensor_block.h"

namespace hindsight {

/// ln of the likelihood of the forward filter's innovations as a function of
/// the logarithms of the factors on a data set's noise values, which are named
/// as in NoiseFactor. Gates and robust losses are off. The start is found once,
/// with the noise as stated. Constants are estimated as the configuration asks;
/// nodes stand where the estimated time offsets place them
/// (ForwardStage::Settle), with the noise as stated or as last given to
/// PlaceNodes. Errors as of FindStart and Settle.
class NoiseLikelihood {
 public:
  explicit NoiseLikelihood(const Dataset& dataset);
  NoiseLikelihood(const NoiseLikelihood&) = delete;
  NoiseLikelihood& operator=(const NoiseLikelihood&) = delete;

  std::size_t size() const { return values_.size(); }
  const std::string& name(std::size_t i) const { return values_[i].name; }

  /// -infinity where the filter diverges.
  double operator()(const std::vector<double>& logs);

  /// Places the nodes by the time offsets that are estimated with these
  /// factors. Returns whether any moved by a tenth of its sigma or more.
  bool PlaceNodes(const std::vector<double>& logs);

 private:
  /// A noise value of the data set.
  struct Value {
    std::string name;
    std::function<void(double factor)> multiply;
  };
  /// An error of a sensor that is correlated in time: a block of the layout.
  struct CorrelatedError {
    int sensor;
    const SensorBlock* block;
  };

  void Apply(const std::vector<double>& logs);
  void Add(const std::string& name, double* value);
  void AddStream(int index, AidingStream* stream);
  /// The layout with the correlated errors as they are now, and the prior to
  /// it.
  ErrorLayout PresentLayout(Prior* prior) const;

  Dataset dataset_;
  Start start_;
  std::vector<Value> values_;
  std::vector<CorrelatedError> errors_;
  std::vector<double> applied_;
  std::vector<double> offsets_;  // of the nodes, by sensor
  TimeOffsetRates rates_;        // empty: no time offset is estimated
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NOISE_LIKELIHOOD_H_
