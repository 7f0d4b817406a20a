#include "evaluation/constant_agreement.h"

#include <fmt/core.h>

#include <cmath>

#include "base/chi_square.h"
#include "base/units.h"

namespace hindsight {
namespace {

/// Weighted mean of all figures but one.
std::optional<ConstantFigure> MeanOf(
    const std::vector<std::optional<ConstantFigure>>& figures,
    const std::optional<ConstantFigure>* but = nullptr) {
  double weight = 0.0;
  double sum = 0.0;
  for (const std::optional<ConstantFigure>& figure : figures) {
    if (!figure || &figure == but) continue;
    weight += 1.0 / figure->variance;
    sum += figure->value / figure->variance;
  }
  if (weight == 0.0) return std::nullopt;
  return ConstantFigure{sum / weight, 1.0 / weight};
}

}  // namespace

ConstantAgreement AgreementOf(
    const std::string& name, const std::string& unit,
    const std::vector<std::optional<ConstantFigure>>& figures,
    double by_chance) {
  ConstantAgreement a{name, unit};
  const auto mean = MeanOf(figures);
  double w1 = 0.0;
  double w2 = 0.0;
  for (const std::optional<ConstantFigure>& figure : figures) {
    std::optional<double>& distance = a.distance.emplace_back();
    if (!figure) continue;
    ++a.recordings;
    const double d = figure->value - mean->value;
    a.chi_square += d * d / figure->variance;
    w1 += 1.0 / figure->variance;
    w2 += 1.0 / (figure->variance * figure->variance);
    if (const auto others = MeanOf(figures, &figure)) {
      distance = (figure->value - others->value) /
                 std::sqrt(figure->variance + others->variance);
    }
  }
  if (a.recordings < 2) return a;
  const auto dof = static_cast<double>(a.recordings - 1);
  a.probability = 1.0 - ChiSquareCdf(a.chi_square, dof);
  if (a.probability < by_chance) {
    a.varies_by = std::sqrt((a.chi_square - dof) / (w1 - w2 / w1));
  }
  return a;
}

Evidence VariationEvidence(const ConstantAgreement& agreement,
                           double by_chance) {
  const bool angle = agreement.unit == "rad";
  const auto dof = static_cast<double>(agreement.recordings - 1);
  Evidence e{
      .rule = "constants_differ",
      .grade = Grade::kDoubtful,
      .what = fmt::format(
          "{} differs between recordings by more than their sigmas say; it "
          "varies by {:.3g} {}",
          agreement.name,
          angle ? agreement.varies_by / kDegree : agreement.varies_by,
          angle ? "deg" : agreement.unit),
      .value = agreement.chi_square / dof,
      .limit = ChiSquareQuantile(1.0 - by_chance, dof) / dof,
      .unit = "chi-square a degree of freedom"};
  e.causes = {
      "sigmas that are too small: noise that is larger than stated, or lasts",
      "a clock or a mounting that is not the same in every recording"};
  e.remedies = {"constants.without: [" + agreement.name + "] where it is used"};
  return e;
}

}  // namespace hindsight
