#include "problems/constant_rival.h"

#include <cmath>

#include "filters/mean_shift.h"
#include "measurements/sensor_kind.h"
#include "problems/deviation_columns.h"
#include "problems/explanation_words.h"
#include "problems/robust_batch.h"

namespace hindsight {
namespace {

/// Whether a deviation throughout is a constant of the IMU or of a sensor that measures
/// in axes of the vehicle.
bool IsConstant(const MeanShift& shift, const DeviationColumns& columns,
                const Timeline& timeline) {
  if (shift.of_state || shift.grows) return false;
  if (shift.group == DeviationColumns::kImu) return true;
  if (shift.group < 0) return false;
  const auto sensor = static_cast<std::size_t>(shift.group);
  const Deviation& deviation =
      columns.Of(shift.group)[static_cast<std::size_t>(shift.column)];
  return timeline.sensors()[sensor].kind->in_vehicle_axes &&
         deviation.kind == Deviation::Kind::kBlock;
}

}  // namespace

std::optional<ConstantRival> LikeliestConstant(
    Problem problem, const std::vector<State>& nominal,
    const EpochCallback& callback) {
  const LinearTape tape = RunLinearizedFilter(nominal, &problem, callback);
  const DeviationColumns columns(problem, nominal, tape);
  const std::vector<std::size_t> first = {0};
  const Scores scores = ScoreShifts(tape, columns.Columns(), first, callback);
  const MeanShift* likeliest = nullptr;
  double most = 0.0;
  for (const MeanShift& shift : scores.shifts) {
    if (!IsConstant(shift, columns, problem.timeline)) continue;
    const double z = std::abs(columns.ZOf(shift));
    if (!(z > most)) continue;
    most = z;
    likeliest = &shift;
  }
  if (likeliest == nullptr) return std::nullopt;
  return ConstantRival{WordsOfShift(*likeliest, columns, problem).what,
                       0.5 * most * most - kSureLogOdds};
}

}  // namespace hindsight
