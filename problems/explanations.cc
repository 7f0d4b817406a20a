#include "problems/explanations.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "base/chi_square.h"
#include "base/parallel.h"
#include "filters/shift_response.h"
#include "measurements/sensor_kind.h"
#include "problems/deviation_columns.h"
#include "problems/explanation_words.h"
#include "problems/likely_deviations.h"

namespace hindsight {

namespace {

/// Whether more than one sensor tells where the vehicle is.
bool ManyTellPlaces(const Timeline& timeline, const LinearTape& tape) {
  std::set<int> sensors;
  for (std::size_t k = 0; k < tape.size() && sensors.size() < 2; ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      const auto sensor = static_cast<std::size_t>(z.sensor);
      if (z.accepted && timeline.sensors()[sensor].kind->places) {
        sensors.insert(z.sensor);
      }
    }
  }
  return sensors.size() > 1;
}

/// Whether a deviation is one of those tried, from that onset on; a jump of the position
/// only where it is `in_common`, by what several sensors tell.
bool IsMeant(const MeanShift& shift, const DeviationColumns& columns,
             std::size_t first, const ErrorLayout& layout, bool in_common) {
  if (shift.of_state) {
    // Nothing makes a vehicle jump: of one sensor it is that sensor's own error.
    const Block* position = layout.Find(BlockKind::kPosition);
    return in_common || shift.column < position->offset ||
           shift.column >= position->offset + position->dim;
  }
  const bool throughout = shift.onset == first;
  if (shift.group == DeviationColumns::kAllClocks) {
    return throughout && shift.grows;
  }
  if (shift.group == DeviationColumns::kImu) return throughout && !shift.grows;
  const Deviation& deviation =
      columns.Of(shift.group)[static_cast<std::size_t>(shift.column)];
  return deviation.may_begin_late || (throughout && !shift.grows);
}

/// The sensor that a deviation is of; below 0: the IMU, or the vehicle.
int SensorOf(const MeanShift& shift, const ErrorLayout& layout) {
  if (!shift.of_state) return shift.group;
  for (const Block& block : layout.blocks()) {
    if (shift.column >= block.offset &&
        shift.column < block.offset + block.dim) {
      return block.key.sensor;
    }
  }
  return BlockKey::kNoSensor;
}

double LimitOf(double false_alarms, std::size_t tests) {
  return std::sqrt(ChiSquareQuantile(
      1.0 - false_alarms / static_cast<double>(std::max<std::size_t>(tests, 1)),
      1.0));
}

/// By sensor, of a deviation by which the root mean square of its innovations is a
/// hundredth of their sigma: no sensor is known better, and of days of fixes what is
/// quadratic in the errors of the trajectory adds up to half of that.
std::vector<double> LeastZ(const LinearTape& tape, std::size_t sensors) {
  constexpr double kKnown = 0.01;  // sigma
  std::vector<double> rows(sensors, 0.0);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!z.accepted) continue;
      rows[static_cast<std::size_t>(z.sensor)] +=
          static_cast<double>(z.innovation.size());
    }
  }
  for (double& one : rows) one = kKnown * std::sqrt(one);
  return rows;
}

/// Additive errors that come and go.
class Varying {
 public:
  Varying(const Problem& problem, const DeviationColumns& own) {
    for (std::size_t i = 0; i < problem.timeline.sensors().size(); ++i) {
      const auto& deviations = own.Of(static_cast<int>(i));
      for (std::size_t c = 0; c < deviations.size(); ++c) {
        if (deviations[c].kind != Deviation::Kind::kAdditive) continue;
        columns_[static_cast<int>(i)].push_back(static_cast<int>(c));
        ++count_;
      }
    }
  }

  /// Of each sensor that has any.
  using Energies = std::map<int, GroupEnergy>;

  /// `additive` as of DeviationColumns.
  Energies EnergiesOn(const LinearTape& tape, const ShiftColumns& additive,
                      std::span<const std::size_t> onsets) const {
    Energies energies;
    for (const auto& [group, columns] : columns_) {
      std::vector<int> all(columns.size());
      std::iota(all.begin(), all.end(), 0);
      energies.emplace(group, EnergiesOf(group, all, onsets, tape, additive));
    }
    return energies;
  }

  void Offer(const Energies& energies, const std::vector<MeanShift>& tried,
             double false_alarms, LikelyDeviations* candidates) const {
    const double by_column = 0.5 * false_alarms / static_cast<double>(count_);
    const double together =
        0.5 * false_alarms / static_cast<double>(columns_.size());
    for (const auto& [group, wanted] : columns_) {
      const GroupEnergy& energy = energies.at(group);
      // In place of a normal variable and its limit.
      LikelyDeviation likeliest;
      for (std::size_t w = 0; w < wanted.size(); ++w) {
        const ShiftEnergy& own = energy.columns[w];
        if (own.weights.empty()) continue;
        const LikelyDeviation one = {
            Largest(group, wanted[w], tried), std::sqrt(own.sum),
            std::sqrt(WeightedChiSquareQuantile(own.weights, by_column)),
            wanted, energy.steps};
        candidates->Offer(one);
        if (likeliest.limit == 0.0 || one.Excess() > likeliest.Excess()) {
          likeliest = one;
        }
      }
      if (likeliest.limit == 0.0) continue;
      likeliest.z = std::sqrt(energy.whitened);
      likeliest.limit =
          std::sqrt(ChiSquareQuantile(1.0 - together, energy.dof));
      candidates->Offer(std::move(likeliest));
    }
  }

 private:
  /// The likeliest of a column that stay; of none the column.
  static MeanShift Largest(int group, int column,
                           const std::vector<MeanShift>& tried) {
    MeanShift largest;
    largest.group = group;
    largest.column = column;
    for (const MeanShift& shift : tried) {
      if (shift.of_state || shift.grows || shift.group != group ||
          shift.column != column) {
        continue;
      }
      if (largest.information == 0.0 ||
          std::abs(shift.z()) > std::abs(largest.z())) {
        largest = shift;
      }
    }
    return largest;
  }

  std::map<int, std::vector<int>> columns_;
  std::size_t count_ = 0;
};

}  // namespace

struct ExplanationSearch::Found {
  DeviationColumns own;
  std::vector<std::size_t> onsets;
  Scores scores;
  std::map<int, std::vector<LikelyDeviation>> best;  ///< by source

  Found(const Problem& problem, const std::vector<State>& states,
        const LinearTape& tape)
      : own(problem, states, tape), onsets(SpreadOnsets(tape, kOnsets)) {}
};

ExplanationSearch::ExplanationSearch(const Problem& problem,
                                     const std::vector<State>& states,
                                     const LinearTape& tape,
                                     double false_alarms,
                                     const EpochCallback& callback)
    : problem_(problem),
      tape_(tape),
      found_(std::make_unique<Found>(problem, states, tape)) {
  const DeviationColumns& own = found_->own;
  const ShiftColumns columns = own.Columns();
  const std::size_t first = found_->onsets.front();
  const Varying varying(problem, own);
  auto energies = InBackground(
      [&] { return varying.EnergiesOn(tape, own.Additive(), found_->onsets); });
  found_->scores = ScoreShifts(tape, columns, found_->onsets, callback);
  std::vector<MeanShift>& tried = found_->scores.shifts;
  const bool in_common = ManyTellPlaces(problem.timeline, tape);
  std::erase_if(tried, [&](const MeanShift& shift) {
    return !IsMeant(shift, own, first, problem.layout, in_common);
  });
  const auto throughout = static_cast<std::size_t>(std::count_if(
      tried.begin(), tried.end(),
      [first](const MeanShift& shift) { return shift.onset == first; }));
  // A third of the false alarms for each: there are far more that begin late.
  const double limits[] = {
      LimitOf(false_alarms / 3.0, throughout),
      LimitOf(false_alarms / 3.0, tried.size() - throughout)};
  LikelyDeviations candidates(LeastZ(tape, problem.timeline.sensors().size()));
  for (const MeanShift& shift : tried) {
    candidates.Offer(
        {shift, own.ZOf(shift), limits[shift.onset == first ? 0 : 1]});
  }
  varying.Offer(energies.get(), tried, false_alarms / 3.0, &candidates);
  found_->best = candidates.Sorted();
}

ExplanationSearch::~ExplanationSearch() = default;

std::span<const StateScore> ExplanationSearch::state_scores() const {
  return found_->scores.states;
}

bool ExplanationSearch::found_any() const { return !found_->best.empty(); }

std::vector<Explanation> ExplanationSearch::Tell(const Relinearised& anew,
                                                 EffectOn on) const {
  const ShiftColumns columns = found_->own.Columns();
  const auto explain = [&](const LikelyDeviation& one) {
    const bool varies = !one.columns.empty();
    const Words words = varies
                            ? WordsOfVarying(one.shift, found_->own, problem_)
                            : WordsOfShift(one.shift, found_->own, problem_);
    Explanation out;
    out.what = words.what;
    out.remedy = words.remedy;
    out.z = std::abs(one.z);
    out.limit = one.limit;
    const int sensor = SensorOf(one.shift, problem_.layout);
    if (sensor >= 0) {
      out.sensor =
          problem_.timeline.sensors()[static_cast<std::size_t>(sensor)].name;
    }
    if (one.shift.onset != found_->onsets.front() && !varies) {
      out.onset = tape_.t(one.shift.onset);
      out.what += fmt::format(" from {:.1f} s on", *out.onset);
    }
    if (varies) {
      AddEffect(CorrectionForSteps(one.shift.group, one.columns, found_->onsets,
                                   one.steps, tape_, columns),
                1.0, anew, tape_, on, &out);
    } else {
      AddEffect(CorrectionFor(one.shift, tape_, columns), one.shift.size(),
                anew, tape_, on, &out);
    }
    if (!one.shift.of_state &&
        one.shift.group == DeviationColumns::kAllClocks) {
      AddEffectOfClock(one.shift.size(), anew, problem_.layout, &out);
    }
    return out;
  };
  std::vector<const std::vector<LikelyDeviation>*> sources;
  for (const auto& [source, candidates] : found_->best) {
    sources.push_back(&candidates);
  }
  std::vector<Explanation> all(sources.size());
  ForRanges(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const std::vector<LikelyDeviation>& candidates = *sources[s];
      all[s] = explain(candidates.front());
      for (std::size_t i = 1;
           i < candidates.size() && all[s].effect < kDoubtfulShift; ++i) {
        Explanation next = explain(candidates[i]);
        if (next.effect >= kDoubtfulShift) all[s] = std::move(next);
      }
    }
  });
  return all;
}

}  // namespace hindsight
