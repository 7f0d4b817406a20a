#include "problems/clock_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "dataset/clock_search.h"
#include "problems/clock_rivals.h"

namespace hindsight {
namespace {

// Clocks with a smaller a priori sigma are not in question [s].
constexpr double kWidePrior = 0.1;
constexpr double kReach = 4.0;  // of the search, in a priori sigmas
// A solution that starts as near as this to an offset need not start there [s].
constexpr double kBegunThere = 0.02;

/// A stream and the offsets at which its clock may stand.
struct ClockQuestion {
  std::size_t stream = 0;
  std::vector<ClockCandidate> candidates;
  int left_out = 0;         ///< further candidates
  double resolution = 0.0;  ///< of the search [s]
};

std::vector<std::size_t> StreamsOf(
    const std::vector<ClockQuestion>& questions) {
  std::vector<std::size_t> streams;
  for (const ClockQuestion& question : questions) {
    streams.push_back(question.stream);
  }
  return streams;
}

/// An offset for each question, and the sum of the misfits there.
struct ClockCombination {
  std::vector<double> offsets;
  double misfit = 0.0;
};

ClockQuestion AskUnknown(const Dataset& dataset, std::size_t i) {
  const AidingStream& stream = dataset.streams[i];
  ClockSearch found = SearchClock(dataset.imu, dataset.initial, stream);
  if (found.candidates.empty()) {
    throw EstimationError("where the clock of " + stream.sensor.name +
                          " stands is not found: its readings and the IMU "
                          "have no motion in common that tells it");
  }
  DropImplausible(&found);
  return {i, found.candidates, found.left_out, found.resolution};
}

std::optional<ClockQuestion> AskEstimated(const Dataset& dataset,
                                          std::size_t i) {
  const AidingStream& stream = dataset.streams[i];
  const double given = stream.sensor.time_offset;
  const double reach = kReach * *stream.sensor.time_offset_sigma;
  ClockSearch found = SearchClock(dataset.imu, dataset.initial, stream,
                                  {given - reach, given + reach});
  if (found.candidates.empty()) return std::nullopt;
  DropImplausible(&found);
  const bool near_given = std::any_of(
      found.candidates.begin(), found.candidates.end(),
      [&](const ClockCandidate& candidate) {
        return std::abs(candidate.offset - given) < 0.5 * found.resolution;
      });
  const ClockCandidate& first = found.candidates.front();
  // Where motion tells the clock far better than the prior does, the solution
  // has to start from there: if the motion is fast, an offset that is off by
  // half of the search's resolution may lie at another minimum.
  const bool tells = first.sigma < 0.1 * *stream.sensor.time_offset_sigma &&
                     std::abs(first.offset - given) > kBegunThere;
  if (near_given && found.candidates.size() == 1 && !tells) return std::nullopt;
  const double misfit = found.misfit(given);
  if (!near_given && IsPlausible(found, misfit)) {
    found.candidates.push_back({given, 0.0, misfit});
  }
  return ClockQuestion{i, found.candidates, found.left_out, found.resolution};
}

bool IsInQuestion(const AidingStream& stream) {
  return stream.clock_unknown ||
         stream.sensor.time_offset_sigma.value_or(0.0) >= kWidePrior;
}

std::vector<ClockQuestion> AskClocks(const Dataset& dataset) {
  std::vector<ClockQuestion> questions;
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const AidingStream& stream = dataset.streams[i];
    if (!IsInQuestion(stream)) continue;
    if (stream.clock_unknown) {
      questions.push_back(AskUnknown(dataset, i));
    } else if (auto question = AskEstimated(dataset, i)) {
      questions.push_back(std::move(*question));
    }
  }
  return questions;
}

/// How many there would be of all candidates.
double Combinations(const std::vector<ClockQuestion>& questions) {
  double count = 1.0;
  for (const ClockQuestion& question : questions) {
    count *= static_cast<double>(question.candidates.size()) +
             static_cast<double>(question.left_out);
  }
  return count;
}

/// Every combination, those that fit best first.
std::vector<ClockCombination> Combine(
    const std::vector<ClockQuestion>& questions) {
  constexpr std::size_t kMost = 8;
  std::vector<ClockCombination> all(1);
  for (const ClockQuestion& question : questions) {
    std::vector<ClockCombination> longer;
    for (const ClockCombination& begun : all) {
      for (const ClockCandidate& candidate : question.candidates) {
        longer.push_back(begun);
        longer.back().offsets.push_back(candidate.offset);
        longer.back().misfit += candidate.misfit;
      }
    }
    std::stable_sort(longer.begin(), longer.end(),
                     [](const ClockCombination& a, const ClockCombination& b) {
                       return a.misfit < b.misfit;
                     });
    if (longer.size() > kMost) longer.resize(kMost);
    all = std::move(longer);
  }
  return all;
}

void PlaceClocks(const std::vector<ClockQuestion>& questions,
                 const std::vector<double>& offsets, Dataset* dataset) {
  for (std::size_t i = 0; i < questions.size(); ++i) {
    Sensor& sensor = dataset->streams[questions[i].stream].sensor;
    sensor.time_offset = offsets[i];
    if (!sensor.time_offset_sigma) {
      sensor.time_offset_sigma = questions[i].resolution;
    }
  }
}

std::vector<SolvedClocks> SolveAll(
    const std::vector<ClockQuestion>& questions,
    const std::vector<ClockCombination>& combinations,
    const ReconstructionOptions& options, Dataset* dataset) {
  std::vector<SolvedClocks> solved;
  for (const ClockCombination& combination : combinations) {
    PlaceClocks(questions, combination.offsets, dataset);
    try {
      solved.push_back(SolveCoarsely(combination.offsets, options, dataset));
    } catch (const EstimationError&) {
      // A combination from which the data cannot be solved is left out.
    }
  }
  return solved;
}

/// Offsets at which the chosen solution's clocks are to be placed. Of a clock
/// of which nothing was known it is the estimate: there its prior does not
/// pull.
std::vector<double> OffsetsOf(const std::vector<std::size_t>& streams,
                              const Dataset& dataset,
                              const SolvedClocks& chosen) {
  std::vector<double> offsets = chosen.offsets;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!dataset.streams[streams[i]].clock_unknown) continue;
    offsets[i] = FinalOffset(chosen, streams[i]);
  }
  return offsets;
}

/// Whether the clocks of two solutions are within half the search's resolution
/// of each other.
bool Stayed(const std::vector<ClockQuestion>& questions,
            const SolvedClocks& one, const SolvedClocks& other) {
  return std::all_of(questions.begin(), questions.end(),
                     [&](const ClockQuestion& question) {
                       return std::abs(FinalOffset(one, question.stream) -
                                       FinalOffset(other, question.stream)) <
                              0.5 * question.resolution;
                     });
}

/// The forward stage of the chosen solution. It is solved once more from the
/// start that FindStart finds with the chosen clocks, since that start is what
/// is reported; if this leads to other clocks or nowhere, the stage is the one
/// that was compared.
std::unique_ptr<ForwardStage> StageOf(
    const std::vector<ClockQuestion>& questions,
    const ReconstructionOptions& options, SolvedClocks* chosen,
    Dataset* dataset) {
  constexpr int kMost = 3;
  const std::vector<std::size_t> streams = StreamsOf(questions);
  SolvedClocks last;
  const SolvedClocks* before = chosen;
  try {
    for (int i = 0; i < kMost; ++i) {
      PlaceClocks(questions, OffsetsOf(streams, *dataset, *before), dataset);
      SolvedClocks told = SolveWithClocks(chosen->offsets, options, *dataset);
      if (!Stayed(questions, told, *chosen)) break;
      const bool same = SameEnd(streams, told, *before);
      last = std::move(told);
      before = &last;
      if (same) break;
    }
  } catch (const EstimationError&) {
    // The stage that was compared has been solved and is taken instead.
  }
  if (last.stage) return std::move(last.stage);
  PlaceClocks(questions, chosen->offsets, dataset);
  return std::move(chosen->stage);
}

}  // namespace

bool HasClocksInQuestion(const Dataset& dataset) {
  return std::ranges::any_of(dataset.streams, IsInQuestion);
}

ClockChoice ChooseClocks(const Dataset& dataset,
                         const ReconstructionOptions& options) {
  ClockChoice choice;
  choice.given = &dataset;
  const std::vector<ClockQuestion> questions = AskClocks(dataset);
  if (questions.empty()) {
    choice.stage = std::make_unique<ForwardStage>(dataset, options);
    return choice;
  }
  choice.dataset = std::make_unique<Dataset>(dataset);
  const std::vector<ClockCombination> combinations = Combine(questions);
  std::vector<SolvedClocks> solved;
  if (combinations.size() > 1) {
    solved = SolveAll(questions, combinations, options, choice.dataset.get());
  }
  if (solved.empty()) {
    PlaceClocks(questions, combinations.front().offsets, choice.dataset.get());
    choice.stage = std::make_unique<ForwardStage>(*choice.dataset, options);
    return choice;
  }
  const std::vector<std::size_t> streams = StreamsOf(questions);
  RemoveSame(streams, &solved);
  const ClockRanking ranking = Rank(dataset, &solved);
  choice.rivals = Rivals(dataset, streams, solved, ranking);
  AddUnsolved(
      Combinations(questions) - static_cast<double>(combinations.size()),
      &choice.rivals);
  SolvedClocks& best = solved[ranking.best];
  choice.stage = StageOf(questions, options, &best, choice.dataset.get());
  return choice;
}

}  // namespace hindsight
