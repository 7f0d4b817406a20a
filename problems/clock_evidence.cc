#include "problems/clock_evidence.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/chi_square.h"
#include "base/median.h"

namespace hindsight {
namespace {

/// The measurements that another solution has as well.
GateDecisions InCommon(const Timeline& timeline, const Timeline& other) {
  std::set<std::pair<int, double>> there;
  for (const Measurement& z : other.all_measurements()) {
    there.insert({z.sensor, z.t});
  }
  GateDecisions used;
  for (const Measurement& z : timeline.all_measurements()) {
    used.push_back(there.contains({z.sensor, z.t}) ? 1 : 0);
  }
  return used;
}

MarginalLikelihood LikelihoodOf(const Dataset& dataset, const Explained& solved,
                                const GateDecisions& used,
                                LikelihoodParts parts) {
  Problem problem = solved.problem;
  problem.prior = PriorOfComparison(dataset, problem, solved.states.front());
  return MarginalLikelihoodOf(std::move(problem), solved.states, used, parts);
}

MarginalLikelihood LikelihoodBeside(const Dataset& dataset,
                                    const Explained& solved,
                                    const Explained& other,
                                    LikelihoodParts parts) {
  return LikelihoodOf(dataset, solved,
                      InCommon(solved.problem.timeline, other.problem.timeline),
                      parts);
}

double ClockPriorOf(const Dataset& dataset, const Explained& solved) {
  return LogClockPrior(dataset, solved.problem.layout, solved.states.back());
}

/// |w|^2, of the measurements that both accepted.
double SquaredDifference(const MarginalLikelihood& a,
                         const MarginalLikelihood& b) {
  double sum = 0.0;
  for (const auto& [measurement, innovation] : a.whitened) {
    const auto other = b.whitened.find(measurement);
    if (other == b.whitened.end()) continue;
    sum += (other->second - innovation).squaredNorm();
  }
  return sum;
}

double ExcessOf(const MarginalLikelihood& chosen) {
  return chosen.rows > 0.0 ? std::max(1.0, chosen.squares / chosen.rows) : 1.0;
}

/// The same of most measurements: those that err do not count.
double MedianExcessOf(const MarginalLikelihood& chosen) {
  std::vector<double> excess;
  for (const auto& [measurement, innovation] : chosen.whitened) {
    const auto rows = static_cast<double>(innovation.size());
    excess.push_back(innovation.squaredNorm() / ChiSquareQuantile(0.5, rows));
  }
  return std::max(1.0, Median(std::move(excess)));
}

}  // namespace

// Who holds the lock never waits for another thread: what is solved meanwhile by two
// is the same.
std::shared_ptr<const ChosenExplanation::Known> ChosenExplanation::Beside(
    const Explained& rival, LikelihoodParts parts) {
  GateDecisions used =
      InCommon(chosen_.problem.timeline, rival.problem.timeline);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (last_ && last_->parts == parts && last_->used == used) return last_;
  }
  MarginalLikelihood likelihood = LikelihoodOf(dataset_, chosen_, used, parts);
  auto known = std::make_shared<const Known>(
      Known{std::move(used), parts, std::move(likelihood)});
  const std::lock_guard<std::mutex> lock(mutex_);
  last_ = known;
  return known;
}

double ChosenExplanation::LogLikelihoodRatio(const Explained& rival) {
  const auto chosen = Beside(rival, LikelihoodParts::kAlone);
  const MarginalLikelihood& a = chosen->likelihood;
  const MarginalLikelihood b =
      LikelihoodBeside(dataset_, rival, chosen_, LikelihoodParts::kAlone);
  return (b.log - a.log) / ExcessOf(a);
}

double ChosenExplanation::LogEvidenceRatio(const Explained& rival,
                                           ExcessBy by) {
  const auto chosen = Beside(rival, LikelihoodParts::kWithNoise);
  const MarginalLikelihood& a = chosen->likelihood;
  const MarginalLikelihood b =
      LikelihoodBeside(dataset_, rival, chosen_, LikelihoodParts::kWithNoise);
  const double excess =
      by == ExcessBy::kMedian ? MedianExcessOf(a) : ExcessOf(a);
  const double between = SquaredDifference(a, b);
  const double of_noise = excess * (a.imu_noise + b.imu_noise);
  const double of_motion = between > of_noise ? 1.0 - of_noise / between : 0.0;
  return of_motion * (b.log - a.log) / excess + ClockPriorOf(dataset_, rival) -
         ClockPriorOf(dataset_, chosen_);
}

double LogEvidenceRatio(const Dataset& dataset, const Explained& rival,
                        const Explained& chosen, ExcessBy by) {
  return ChosenExplanation(dataset, chosen).LogEvidenceRatio(rival, by);
}

}  // namespace hindsight
