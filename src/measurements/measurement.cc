#include "measurements/measurement.h"

namespace hindsight {

int Rows(const Measurement& z) {
  return std::visit([](const auto& model) { return model.rows(); }, z.model);
}

void ScaleSigma(double factor, Measurement* z) {
  std::visit([factor](auto& model) { model.ScaleSigma(factor); }, z->model);
}

void Evaluate(const Measurement& z, const ModelContext& context,
              LinearizedMeasurement* out) {
  std::visit([&](const auto& model) { model.Evaluate(context, out); }, z.model);
}

}  // namespace hindsight
