#include "problems/clock_rivals.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "problems/marginal_likelihood.h"

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

MarginalLikelihood LikelihoodBeside(const Dataset& dataset,
                                    const SolvedClocks& solved,
                                    const SolvedClocks& other) {
  ForwardStage& stage = *solved.stage;
  const Prior prior =
      PriorOfComparison(dataset, stage.start(), solved.batch.states.front());
  return MarginalLikelihoodOf(
      stage.start().layout, prior, solved.batch.states, stage.decisions(),
      InCommon(stage.timeline(), other.stage->timeline()), &stage.timeline());
}

/// ln of the evidence of `rival` over that of `chosen`. Innovations of `chosen`
/// whose mean square is above one say by how much the noise is larger than
/// stated.
double LogRatio(const Dataset& dataset, const SolvedClocks& rival,
                const SolvedClocks& chosen) {
  const MarginalLikelihood a = LikelihoodBeside(dataset, chosen, rival);
  const MarginalLikelihood b = LikelihoodBeside(dataset, rival, chosen);
  const double excess = a.rows > 0.0 ? std::max(1.0, a.squares / a.rows) : 1.0;
  return (b.log - a.log) / excess;
}

double FinalOffset(const SolvedClocks& solved, std::size_t stream) {
  const ErrorLayout& layout = solved.stage->start().layout;
  const Block* block =
      layout.Find(BlockKind::kTimeOffset, static_cast<int>(stream));
  return solved.batch.states.back().parameters(block->parameter_offset);
}

/// Mean of the heading of `rival` less that of `chosen` at the same times
/// [rad].
double HeadingBetween(const std::vector<State>& rival,
                      const std::vector<State>& chosen) {
  constexpr double kSameTime = 0.2;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::size_t k = 0;
  for (const State& x : chosen) {
    while (k + 1 < rival.size() &&
           std::abs(rival[k + 1].t - x.t) <= std::abs(rival[k].t - x.t)) {
      ++k;
    }
    if (std::abs(rival[k].t - x.t) > kSameTime) continue;
    const double turn = rival[k].euler().z() - x.euler().z();
    sum += Eigen::Vector2d(std::cos(turn), std::sin(turn));
  }
  return std::atan2(sum.y(), sum.x());
}

/// What a rival differs in; nothing if it came to the same end.
std::optional<RivalSolution> Differ(const Dataset& dataset,
                                    const std::vector<std::size_t>& streams,
                                    const SolvedClocks& rival,
                                    const SolvedClocks& chosen) {
  constexpr double kSameClock = 0.02;  // [s]
  constexpr double kSameHeading = 5.0 * kDegree;
  RivalSolution out;
  const auto add = [&out](const std::string& words) {
    out.description += (out.description.empty() ? "" : " and ") + words;
  };
  char words[120];
  for (const std::size_t stream : streams) {
    const std::string& name = dataset.streams[stream].sensor.name;
    const double later =
        FinalOffset(rival, stream) - FinalOffset(chosen, stream);
    if (std::abs(later) < kSameClock) continue;
    out.differences.push_back({name + "_time_offset", later, "s"});
    std::snprintf(words, sizeof(words), "clock of %s %.2f s %s", name.c_str(),
                  std::abs(later), later > 0.0 ? "later" : "earlier");
    add(words);
  }
  const double turn = HeadingBetween(rival.batch.states, chosen.batch.states);
  if (std::abs(turn) > kSameHeading) {
    out.differences.push_back({"heading", turn, "rad"});
    std::snprintf(words, sizeof(words), "heading turned by %.0f deg",
                  turn / kDegree);
    add(words);
  }
  if (out.differences.empty()) return std::nullopt;
  out.final_state = rival.batch.states.back();
  return out;
}

/// Probabilities from the evidence, the likeliest first.
void SetProbabilities(std::vector<RivalSolution>* rivals) {
  double sum = 1.0;
  for (const RivalSolution& rival : *rivals) {
    sum += std::exp(rival.log_evidence);
  }
  for (RivalSolution& rival : *rivals) {
    rival.probability = std::exp(rival.log_evidence) / sum;
  }
  std::stable_sort(rivals->begin(), rivals->end(),
                   [](const RivalSolution& a, const RivalSolution& b) {
                     return a.log_evidence > b.log_evidence;
                   });
}

}  // namespace

SolvedClocks SolveWithClocks(const std::vector<double>& offsets,
                             const Dataset& dataset,
                             const ReconstructionOptions& options) {
  SolvedClocks solved;
  solved.offsets = offsets;
  solved.stage = std::make_unique<ForwardStage>(dataset, options);
  ForwardStage& stage = *solved.stage;
  stage.Run();
  BatchOptions batch;
  batch.max_iterations = options.max_iterations;
  const EpochCallback progress = stage.Progress("clocks");
  batch.callback = [&progress](int) { progress(0); };
  solved.batch = SolveBatch(stage.start().layout, stage.start().prior,
                            stage.smoothed().states, &stage.timeline(),
                            stage.decisions(), batch);
  if (!solved.batch.converged || !stage.unsettled().empty()) {
    throw EstimationError("the clocks do not settle");
  }
  return solved;
}

std::size_t Likeliest(const Dataset& dataset,
                      const std::vector<SolvedClocks>& solved) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < solved.size(); ++i) {
    if (LogRatio(dataset, solved[i], solved[best]) > 0.0) best = i;
  }
  return best;
}

std::vector<RivalSolution> Rivals(const Dataset& dataset,
                                  const std::vector<std::size_t>& streams,
                                  const std::vector<SolvedClocks>& solved,
                                  std::size_t chosen) {
  std::vector<RivalSolution> rivals;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    if (i == chosen) continue;
    auto rival = Differ(dataset, streams, solved[i], solved[chosen]);
    const bool told =
        rival && std::any_of(rivals.begin(), rivals.end(),
                             [&](const RivalSolution& other) {
                               return other.description == rival->description;
                             });
    if (!rival || told) continue;
    rival->log_evidence =
        std::min(0.0, LogRatio(dataset, solved[i], solved[chosen]));
    rivals.push_back(std::move(*rival));
  }
  SetProbabilities(&rivals);
  return rivals;
}

void AddUnsolved(double count, std::vector<RivalSolution>* rivals) {
  if (count < 1.0 || rivals->empty()) return;
  RivalSolution further;
  char words[80];
  std::snprintf(words, sizeof(words),
                "one of %.0f further clock settings, not solved", count);
  further.description = words;
  further.log_evidence =
      std::min(0.0, rivals->back().log_evidence + std::log(count));
  rivals->push_back(std::move(further));
  SetProbabilities(rivals);
}

}  // namespace hindsight
