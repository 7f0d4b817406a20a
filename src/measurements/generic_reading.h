#ifndef HINDSIGHT_MEASUREMENTS_GENERIC_READING_H_
#define HINDSIGHT_MEASUREMENTS_GENERIC_READING_H_

#include <Eigen/Core>
#include <tuple>

#include "measurements/model.h"

namespace hindsight {

struct GenericReading;

/// How a GenericReading follows from the state.
struct GenericModel {
  int (*rows)(const GenericReading&) = nullptr;
  /// Residual, H and R, as every model's Evaluate.
  void (*evaluate)(const GenericReading&, const ModelContext&,
                   LinearizedMeasurement*) = nullptr;
};

/// A measurement of up to four values that is told from others by its model
/// alone: what a sensor needs that brings no type of its own. Units, frame and
/// meaning of the values are those of the kind of sensor.
struct GenericReading {
  /// One object for all measurements of a kind.
  const GenericModel* model = nullptr;
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Vector4d sigma = Eigen::Vector4d::Ones();

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.model, z.value, z.sigma);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }

  int rows() const { return model->rows(*this); }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const {
    model->evaluate(*this, context, out);
  }
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_GENERIC_READING_H_
