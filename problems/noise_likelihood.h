#ifndef HINDSIGHT_PROBLEMS_NOISE_LIKELIHOOD_H_
#define HINDSIGHT_PROBLEMS_NOISE_LIKELIHOOD_H_

#include <functional>
#include <string>
#include <vector>

#include "alignment/start.h"
#include "dataset/dataset.h"

namespace hindsight {

/// ln of the likelihood of the forward filter's innovations as a function of
/// the logarithms of the factors on a data set's noise values, which are named
/// as in NoiseFactor. Gates and robust losses are off. Aligned once, with the
/// noise as stated. Errors as of FindStart.
class NoiseLikelihood {
 public:
  explicit NoiseLikelihood(const Dataset& dataset);
  NoiseLikelihood(const NoiseLikelihood&) = delete;
  NoiseLikelihood& operator=(const NoiseLikelihood&) = delete;

  std::size_t size() const { return values_.size(); }
  const std::string& name(std::size_t i) const { return values_[i].name; }

  /// -infinity where the filter diverges.
  double operator()(const std::vector<double>& logs);

 private:
  /// A noise value of the data set.
  struct Value {
    std::string name;
    std::function<void(double factor)> multiply;
  };
  /// A Gauss-Markov error of a sensor: a block of the layout.
  struct Process {
    int sensor;
    const double* sigma;
    const double* tau;
  };

  void Add(const std::string& name, double* value);
  void AddProcess(const std::string& name, int sensor, double* sigma,
                  double* tau);
  void AddStream(int index, AidingStream* stream);
  /// The layout with the processes as they are now, and the prior to it.
  ErrorLayout PresentLayout(Prior* prior) const;

  Dataset dataset_;
  Start start_;
  std::vector<Value> values_;
  std::vector<Process> processes_;
  std::vector<double> applied_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NOISE_LIKELIHOOD_H_
