#include "problems/clock_rivals.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/units.h"
#include "problems/clock_evidence.h"

namespace hindsight {
namespace {

/// Mean of the heading of `rival` less that of `chosen` at the same times
/// [rad].
double HeadingBetween(const std::vector<State>& rival,
                      const std::vector<State>& chosen) {
  constexpr double kSameTime = 0.5;
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

/// What one solution differs in from another: clocks of the streams that were
/// in question, and the heading, each 0 if it is the same.
struct Differences {
  std::vector<double> clocks;  ///< [s]
  double heading = 0.0;        ///< [rad]
  bool none() const {
    return heading == 0.0 && std::all_of(clocks.begin(), clocks.end(),
                                         [](double d) { return d == 0.0; });
  }
};

Differences DifferencesOf(const std::vector<std::size_t>& streams,
                          const SolvedClocks& one, const SolvedClocks& other) {
  constexpr double kSameClock = 0.02;  // [s]
  constexpr double kSameHeading = 5.0 * kDegree;
  Differences out;
  for (const std::size_t stream : streams) {
    const double later = FinalOffset(one, stream) - FinalOffset(other, stream);
    out.clocks.push_back(std::abs(later) < kSameClock ? 0.0 : later);
  }
  const double turn = HeadingBetween(one.states, other.states);
  out.heading = std::abs(turn) > kSameHeading ? turn : 0.0;
  return out;
}

/// A rival without its evidence.
RivalSolution Tell(const Dataset& dataset,
                   const std::vector<std::size_t>& streams,
                   const SolvedClocks& rival, const SolvedClocks& chosen) {
  const Differences differences = DifferencesOf(streams, rival, chosen);
  RivalSolution out;
  const auto add = [&out](const std::string& words) {
    out.description += (out.description.empty() ? "" : " and ") + words;
  };
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const double later = differences.clocks[i];
    if (later == 0.0) continue;
    const std::string& name = dataset.streams[streams[i]].sensor.name;
    out.differences.push_back({name + "_time_offset", later, "s"});
    add(fmt::format("clock of {} {:.2f} s {}", name, std::abs(later),
                    later > 0.0 ? "later" : "earlier"));
  }
  if (differences.heading != 0.0) {
    out.differences.push_back({"heading", differences.heading, "rad"});
    add(fmt::format("heading turned by {:.0f} deg",
                    differences.heading / kDegree));
  }
  out.final_state = rival.states.back();
  return out;
}

/// LogEvidenceRatio of pairs, each computed once.
class EvidenceTable {
 public:
  EvidenceTable(const Dataset& dataset, const std::vector<SolvedClocks>& solved)
      : dataset_(dataset), solved_(solved) {}

  double Ratio(std::size_t rival, std::size_t chosen) {
    const auto [at, is_new] = known_.try_emplace({rival, chosen}, 0.0);
    if (is_new) {
      at->second =
          LogEvidenceRatio(dataset_, Of(rival), Of(chosen), ExcessBy::kMedian);
    }
    return at->second;
  }
  void Forget() { known_.clear(); }

 private:
  Explained Of(std::size_t i) const {
    return {solved_[i].stage->problem(), solved_[i].states};
  }

  const Dataset& dataset_;
  const std::vector<SolvedClocks>& solved_;
  std::map<std::pair<std::size_t, std::size_t>, double> known_;
};

ClockRanking RankAsTheyAre(std::size_t count, EvidenceTable* table) {
  ClockRanking ranking;
  for (std::size_t i = 1; i < count; ++i) {
    if (table->Ratio(i, ranking.best) > 0.0) ranking.best = i;
  }
  for (std::size_t i = 0; i < count; ++i) {
    ranking.log_evidence.push_back(
        i == ranking.best ? 0.0 : std::min(0.0, table->Ratio(i, ranking.best)));
  }
  return ranking;
}

}  // namespace

double FinalOffset(const SolvedClocks& solved, std::size_t stream) {
  const ErrorLayout& layout = solved.stage->start().layout;
  const Block* block =
      layout.Find(BlockKind::kTimeOffset, static_cast<int>(stream));
  return solved.states.back().parameters(block->parameter_offset);
}

bool SameEnd(const std::vector<std::size_t>& streams, const SolvedClocks& one,
             const SolvedClocks& other) {
  return DifferencesOf(streams, one, other).none();
}

void RemoveSame(const std::vector<std::size_t>& streams,
                std::vector<SolvedClocks>* solved) {
  std::vector<SolvedClocks> kept;
  for (SolvedClocks& one : *solved) {
    const bool same =
        std::any_of(kept.begin(), kept.end(), [&](const SolvedClocks& other) {
          return SameEnd(streams, one, other);
        });
    if (!same) kept.push_back(std::move(one));
  }
  *solved = std::move(kept);
}

ClockRanking Rank(const Dataset& dataset, std::vector<SolvedClocks>* solved) {
  constexpr double kNear = 200.0;
  EvidenceTable table(dataset, *solved);
  for (;;) {
    ClockRanking ranking = RankAsTheyAre(solved->size(), &table);
    bool moved = false;
    const auto carry = [&moved](SolvedClocks* one) {
      if (one->converged) return;
      Converge(one);
      moved = true;
    };
    for (std::size_t i = 0; i < solved->size(); ++i) {
      if (i == ranking.best || ranking.log_evidence[i] < -kNear) continue;
      carry(&(*solved)[i]);
      carry(&(*solved)[ranking.best]);
    }
    if (!moved) return ranking;
    table.Forget();
  }
}

std::vector<RivalSolution> Rivals(const Dataset& dataset,
                                  const std::vector<std::size_t>& streams,
                                  const std::vector<SolvedClocks>& solved,
                                  const ClockRanking& ranking) {
  std::vector<RivalSolution> rivals;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    if (i == ranking.best) continue;
    RivalSolution rival =
        Tell(dataset, streams, solved[i], solved[ranking.best]);
    // It converged to the chosen solution itself and is no other explanation.
    if (rival.differences.empty()) continue;
    rival.log_evidence = ranking.log_evidence[i];
    rivals.push_back(std::move(rival));
  }
  SetProbabilities(&rivals);
  return rivals;
}

void AddUnsolved(double count, std::vector<RivalSolution>* rivals) {
  if (count < 1.0 || rivals->empty()) return;
  RivalSolution further;
  further.description =
      fmt::format("one of {:.0f} further clock settings, not solved", count);
  further.log_evidence =
      std::min(0.0, rivals->back().log_evidence + std::log(count));
  rivals->push_back(std::move(further));
  SetProbabilities(rivals);
}

}  // namespace hindsight
