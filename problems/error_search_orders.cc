#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "base/chi_square.h"
#include "evaluation/innovation_test.h"
#include "filters/mean_shift.h"
#include "measurements/sensor_kind.h"
#include "problems/error_search.h"
#include "problems/explanations.h"
#include "problems/judged_innovations.h"

namespace hindsight {
namespace {

/// Sensors of positions, that which tells most of the position first.
std::vector<int> ReceiversByInformation(const Timeline& timeline,
                                        const LinearTape& tape) {
  std::map<int, double> information;  // [1/m^2]
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      const auto sensor = static_cast<std::size_t>(z.sensor);
      if (!z.accepted || z.withheld ||
          !timeline.sensors()[sensor].kind->is_position) {
        continue;
      }
      information[z.sensor] += z.R.diagonal().cwiseInverse().sum();
    }
  }
  std::vector<int> receivers;
  for (const auto& [sensor, sum] : information) receivers.push_back(sensor);
  std::ranges::stable_sort(receivers, std::ranges::greater(),
                           [&](int sensor) { return information[sensor]; });
  return receivers;
}

/// Whether innovations say that position or velocity are others from some time on, as
/// errors make believe that all sensors have in common: by a test that a right model
/// fails once in twenty, as another search decides.
bool TellsAJumpInCommon(const LinearTape& tape) {
  constexpr double kFalseAlarms = 0.05;
  const ErrorLayout& layout = tape.layout();
  const Block* blocks[] = {layout.Find(BlockKind::kPosition),
                           layout.Find(BlockKind::kVelocity)};
  const auto is_meant = [&blocks](const MeanShift& shift) {
    return shift.of_state && std::ranges::any_of(blocks, [&](const Block* one) {
             return one != nullptr && shift.column >= one->offset &&
                    shift.column < one->offset + one->dim;
           });
  };
  const ShiftColumns none = {[](std::size_t, const TapeMeasurement&) {
    return std::vector<ShiftColumns::Columns>();
  }};
  const std::vector<std::size_t> onsets = SpreadOnsets(tape, kOnsets);
  int count = 0;
  double most = 0.0;  // z
  for (const MeanShift& shift : ScoreShifts(tape, none, onsets).shifts) {
    if (!is_meant(shift)) continue;
    ++count;
    most = std::max(most, std::abs(shift.z()));
  }
  return count > 0 &&
         most * most > ChiSquareQuantile(1.0 - kFalseAlarms / count, 1.0);
}

}  // namespace

bool IsOfVelocity(const SensorKind& kind) {
  return kind.moves && !kind.of_vehicle && !kind.is_position;
}

bool ErrorSearch::RunFrom(const std::function<bool(int sensor)>& is_asked,
                          std::vector<int> without,
                          const std::vector<State>& initial) {
  Problem others = problem_;
  LeaveOut(without, others.timeline, &others.decisions);
  Round round = Search(&others, initial, is_asked);
  if (round.errors.empty() || !round.best().Stands()) return false;
  round.without = std::move(without);
  Take(std::move(round));
  Run(initial);
  return true;
}

bool ErrorSearch::RunFromVelocities(const std::vector<State>& initial) {
  const auto& sensors = problem_.timeline.sensors();
  std::vector<int> positions;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].kind->is_position) positions.push_back(static_cast<int>(i));
  }
  return RunFrom(
      [&sensors](int sensor) {
        return IsOfVelocity(*sensors[static_cast<std::size_t>(sensor)].kind);
      },
      std::move(positions), initial);
}

bool ErrorSearch::RunFromOne(int sensor, const std::vector<int>& without,
                             const std::vector<State>& initial) {
  return RunFrom([sensor](int one) { return one == sensor; }, without, initial);
}

bool ErrorSearch::RunFromVehicle(const std::vector<int>& suspects,
                                 const std::vector<State>& initial) {
  if (!HasRoom()) return false;
  question_.in_vehicle_axes = true;
  Round round = Search(&problem_, initial, [&suspects](int sensor) {
    return std::ranges::count(suspects, sensor) > 0;
  });
  question_.in_vehicle_axes = false;
  if (round.errors.empty() || !round.best().Stands()) return false;
  Take(std::move(round));
  Run(initial);
  return true;
}

void ErrorSearch::RunAsDecided(const std::vector<State>& initial) {
  const auto& sensors = problem_.timeline.sensors();
  const DecidedRound first = options_->decisions->empty()
                                 ? DecidedRound{}
                                 : options_->decisions->front();
  const auto is_in_its_axes = [&sensors](const auto& one) {
    return sensors[SensorOf(*one)].kind->in_vehicle_axes;
  };
  const auto is_asked = [&first](int sensor) {
    return std::ranges::any_of(first.errors, [sensor](const auto& one) {
      return SensorOf(*one) == static_cast<std::size_t>(sensor);
    });
  };
  const bool begins_otherwise =
      !first.errors.empty() &&
      (std::ranges::all_of(first.errors, is_in_its_axes)
           ? RunFromVehicle({}, initial)
           : !first.without.empty() &&
                 RunFrom(is_asked, first.without, initial));
  if (!begins_otherwise) Run(initial);
  RunLast(initial);
}

bool ErrorSearch::MayBeOfAReceiver() const {
  const auto& sensors = problem_.timeline.sensors();
  const bool has_velocities = std::ranges::any_of(
      sensors, [](const Sensor& one) { return IsOfVelocity(*one.kind); });
  if (!has_velocities || question_.known.empty()) return false;
  const ReceiverErrors& first = rounds_.front().best();
  const bool changes = std::ranges::any_of(rounds_, [](const Round& one) {
    return one.best().Stands() && !one.best().ChangeTimes().empty();
  });
  return (changes && question_.known.size() > 1) || first.HasVelocitySteps() ||
         !first.Doubts().empty();
}

std::vector<int> ErrorSearch::SuspectsOfVehicle() const {
  constexpr double kFar = 5.0;            // sigma
  constexpr double kFalseAlarms = 0.001;  // of all sums
  if (rounds_.empty()) return {};
  std::set<int> contradicted;
  const std::vector<NormalisedInnovation> innovations =
      InnovationsOf(*rounds_.front().tape, problem_.timeline, {});
  for (const NormalisedInnovation& one : innovations) {
    if (one.rows.cwiseAbs().maxCoeff() > kFar) contradicted.insert(one.sensor);
  }
  for (const InnovationFigure& one :
       TestInnovations(innovations, kFalseAlarms)) {
    if (one.excess > 1.0) contradicted.insert(one.sensor);
  }
  const bool any_stands = rounds_.front().best().Stands();
  std::vector<int> suspects;
  const auto count = static_cast<int>(problem_.timeline.sensors().size());
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (problem_.timeline.sensors()[at].kind->in_vehicle_axes &&
        (any_stands || contradicted.contains(i))) {
      suspects.push_back(i);
    }
  }
  return suspects;
}

std::vector<int> ErrorSearch::SuspectsBeside() const {
  std::vector<int> others;
  if (question_.known.size() < 2) return others;
  const ReceiverErrors& first = rounds_.front().best();
  if (!KindOf(first).is_position ||
      (!first.HasVelocitySteps() && first.Doubts().empty())) {
    return others;
  }
  for (const Round& round : rounds_) {
    for (const ReceiverErrors& one : round.errors) {
      const bool is_suspect = one.Stands() && !KindOf(one).moves &&
                              std::ranges::count(others, one.sensor()) == 0;
      if (is_suspect) others.push_back(one.sensor());
    }
  }
  return others;
}

std::vector<int> ErrorSearch::ReceiversThatMayErrAlike() const {
  if (rounds_.empty()) return {};
  const Round& first = rounds_.front();
  std::vector<int> receivers;
  for (const ReceiverErrors& one : first.errors) {
    if (one.Stands() && one.HasVelocitySteps() && KindOf(one).is_position) {
      receivers.push_back(one.sensor());
    }
  }
  if (receivers.size() > 1) return receivers;
  receivers = ReceiversByInformation(problem_.timeline, *first.tape);
  if (receivers.size() < 2 || !TellsAJumpInCommon(*first.tape)) return {};
  return receivers;
}

}  // namespace hindsight
