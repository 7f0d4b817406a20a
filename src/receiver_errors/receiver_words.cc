#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "receiver_errors/hypothesis_words.h"
#include "receiver_errors/receiver_errors.h"
#include "receiver_errors/sensor_findings.h"

namespace hindsight {

std::vector<std::string> ReceiverErrors::Notes(
    const CovarianceSeries& P) const {
  std::vector<std::string> notes;
  if (found_->stands()) {
    const WeighedHypothesis& chosen = found_->chosen();
    notes = DescribeErrors(chosen.steps, chosen.parameters, found_->unit,
                           found_->Duration());
    notes.insert(notes.begin(),
                 DescribeNoise(found_->regimes.kind, chosen.parameters));
    if (const auto& expected = found_->regimes.expected) {
      notes.push_back(fmt::format(
          "covariances by what is expected of it, sigma {:.3g} {}, correlation "
          "time {:.3g} s",
          expected->sigma, found_->unit, expected->tau));
    }
    notes.push_back(fmt::format(
        "against the noise as stated the evidence is exp({:.3g}) to 1",
        found_->gain));
  } else if (found_->stopped) {
    notes.emplace_back("no errors found before the search was ended");
  } else {
    notes.emplace_back("errors as stated");
  }
  for (const std::string& refused : found_->choice.refused) {
    notes.push_back(refused);
  }
  if (found_->stands() && found_->switching()) {
    const std::vector<double> times = found_->Times();
    notes.push_back(DescribeSequence(found_->chosen().steps, times,
                                     {sizes_, found_->unit}));
    const RivalHypothesis rival =
        FindRival(found_->alternatives, found_->chosen(), P);
    std::string other =
        DescribeRival(rival, times, found_->tape.dim(), found_->unit);
    if (!other.empty()) notes.push_back(std::move(other));
  }
  for (const Hypothesis& one : found_->undecided) {
    const std::vector<std::string> errors = DescribeErrors(
        one.sequence, one.parameters, found_->unit, found_->Duration());
    const double odds = std::exp(std::abs(one.log_posterior));
    notes.push_back(fmt::format(
        "not ruled out, {:.{}f} times {} likely than noise: {}", odds,
        odds < 10.0 ? 1 : 0, one.log_posterior > 0.0 ? "more" : "less",
        errors.empty() ? "outliers, or steps of the IMU's velocity"
                       : fmt::format("{}", fmt::join(errors, ", "))));
  }
  for (std::string& note : notes) note.insert(0, found_->name + ": ");
  return notes;
}

std::string OpenBiasInWords(const ErrorDecisions& decisions) {
  const OpenBias& open = decisions.open.value();
  return fmt::format(
      "{}: covariances hold it to {} that beside noise there are Gauss-Markov "
      "errors of about the stated sigma, as expected {}, correlation time "
      "{:.3g} s",
      decisions.name, FormatProbability(open.Probability()),
      DescribeSigma(open.expected, decisions.unit), open.expected.tau);
}

std::string ReceiverErrors::InWords() const {
  const WeighedHypothesis& chosen = found_->chosen();
  const ErrorSizes sizes = {sizes_, found_->unit};
  if (found_->switching()) {
    return found_->name + ": " +
           DescribeSequence(chosen.steps, found_->Times(), sizes);
  }
  const std::string kind = RegimeName(found_->regimes.kind);
  return fmt::format("{}: {} errors, {}", found_->name, kind,
                     found_->regimes.kind == ErrorRegimes::Kind::kGaussMarkov
                         ? sizes.Over(0, found_->tape.size()) + " throughout"
                         : fmt::format("sigma {:.3g} times as stated",
                                       chosen.parameters.scale));
}

}  // namespace hindsight
