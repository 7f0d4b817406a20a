#ifndef HINDSIGHT_EVALUATION_CONSTANT_AGREEMENT_H_
#define HINDSIGHT_EVALUATION_CONSTANT_AGREEMENT_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "state/evidence.h"

namespace hindsight {

/// Probability that constants of recordings that agree are said to differ.
inline constexpr double kDisagreementByChance = 0.003;

/// How one constant agrees over recordings.
struct ConstantAgreement {
  std::string name;
  std::string unit;
  std::size_t recordings = 0;  ///< that observe it (ConstantEstimate)
  /// Sum of squared distances from their weighted mean over their variances,
  /// of recordings - 1 degrees of freedom, and its probability by chance.
  double chi_square = 0.0;
  double probability = 1.0;
  /// Standard deviation over recordings beyond their own sigmas; 0 where they
  /// agree.
  double varies_by = 0.0;
  /// Of every recording, in units of sigma from the mean of the others that
  /// observe it; none where it does not observe it, or alone does.
  std::vector<std::optional<double>> distance = {};
};

/// What one recording says of a constant.
struct ConstantFigure {
  double value = 0.0;
  double variance = 0.0;
};

/// Of the figures of every recording, none of one that does not observe it; SI or
/// `unit`. `by_chance`: below this probability it varies.
ConstantAgreement AgreementOf(
    const std::string& name, const std::string& unit,
    const std::vector<std::optional<ConstantFigure>>& figures,
    double by_chance);

/// That the constant varies.
Evidence VariationEvidence(const ConstantAgreement& agreement,
                           double by_chance);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_CONSTANT_AGREEMENT_H_
