#include "receiver_errors/sensor_tape.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/gap.h"
#include "base/median.h"

namespace hindsight {
namespace {

/// Times between fixes [s].
std::vector<double> SpacingsOf(const LinearTape& tape, int sensor) {
  std::vector<double> spacings;
  std::optional<double> last;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (!HasFix(tape, k, sensor)) continue;
    if (last) spacings.push_back(tape.t(k) - *last);
    last = tape.t(k);
  }
  return spacings;
}

/// From `since` to t [s], fixes coming every `spacing`.
UnseenTime UnseenBetween(double since, double t, double spacing) {
  constexpr double kMissing = 1.5;
  const double length = t - since;
  return {length, length > kMissing * spacing, since};
}

}  // namespace

SensorTape::SensorTape(const LinearTape& tape, int sensor)
    : tape_(tape), sensor_(sensor), nodes_(tape.size()) {
  const std::vector<UnseenTime> drifts = UnseenSinceFix(tape, sensor);
  const std::vector<UnseenTime> steps = UnseenSincePosition(tape, sensor);
  for (std::size_t k = 0; k < size(); ++k) {
    nodes_[k].has_fix = hindsight::HasFix(tape, k, sensor);
    nodes_[k].unseen_drift = drifts[k];
    nodes_[k].unseen_step = steps[k];
    fix_count_ += nodes_[k].has_fix ? 1 : 0;
    if (k == 0) continue;
    // A copy takes no more memory than it needs.
    const SparseCongruence over_interval = tape.OverInterval(k);
    nodes_[k].over_interval = over_interval;
  }
  SetShares();
  SetNoisy();
}

void SensorTape::SetShares() {
  constexpr std::size_t kLeast = 20;
  std::vector<std::size_t> fixes;
  for (std::size_t k = 0; k < size(); ++k) {
    if (HasFix(k)) fixes.push_back(k);
  }
  if (fixes.empty()) return;
  const double once = 1.0 / static_cast<double>(std::max(fixes.size(), kLeast));
  nodes_[fixes.front()].share = once;
  const double whole = t(fixes.back()) - t(fixes.front());
  const double mean = whole / static_cast<double>(fixes.size() - 1);
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    nodes_[fixes[i]].share = once * (t(fixes[i]) - t(fixes[i - 1])) / mean;
  }
}

void SensorTape::SetNoisy() {
  std::vector<char> has_noise(static_cast<std::size_t>(dim()), 0);
  for (std::size_t k = 1; k < size(); ++k) {
    const PackedSymmetric Q = tape_.PackedQ(k);
    for (Eigen::Index i = 0; i < Q.n; ++i) {
      if (*Q.Column(i) != 0.0) has_noise[static_cast<std::size_t>(i)] = 1;
    }
  }
  for (std::size_t i = 0; i < has_noise.size(); ++i) {
    if (has_noise[i] != 0) noisy_.push_back(static_cast<Eigen::Index>(i));
  }
}

std::vector<UnseenTime> UnseenSinceFix(const LinearTape& tape, int sensor) {
  const double spacing = Median(SpacingsOf(tape, sensor));
  std::vector<UnseenTime> unseen;
  double last = tape.size() == 0 ? 0.0 : tape.t(0);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    unseen.push_back(UnseenBetween(last, tape.t(k), spacing));
    if (HasFix(tape, k, sensor)) last = tape.t(k);
  }
  return unseen;
}

std::vector<UnseenTime> UnseenSincePosition(const LinearTape& tape,
                                            int sensor) {
  std::vector<UnseenTime> unseen(tape.size());
  const Block* position = tape.layout().Find(BlockKind::kPosition);
  if (position == nullptr || position->dim != 3) return unseen;
  // Directions and velocities over the ground see it too, by the curvature of the Earth.
  constexpr double kSeen = 1e3;  // [m]
  const auto sees_position = [&](const TapeMeasurement& z) {
    const auto H = z.H.middleCols(position->offset, 3);
    return z.accepted && !z.withheld &&
           (H.rowwise().squaredNorm().array() * kSeen * kSeen >
            z.R.diagonal().array())
               .any();
  };
  const double spacing = Median(SpacingsOf(tape, sensor));
  double last = tape.size() == 0 ? 0.0 : tape.t(0);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const bool has_fix = HasFix(tape, k, sensor);
    if (has_fix) unseen[k] = UnseenBetween(last, tape.t(k), spacing);
    if (has_fix || std::ranges::any_of(tape.measurements(k), sees_position)) {
      last = tape.t(k);
    }
  }
  return unseen;
}

bool HasFix(const LinearTape& tape, std::size_t k, int sensor) {
  return std::ranges::any_of(
      tape.measurements(k), [sensor](const TapeMeasurement& z) {
        return z.sensor == sensor && z.accepted && !z.withheld;
      });
}

std::vector<std::size_t> FixesBehindGaps(const SensorTape& tape) {
  const std::vector<double> spacings = SpacingsOf(tape.linear(), tape.sensor());
  const double longest = LongestSpacingWithoutGap(spacings);
  std::vector<std::size_t> behind;
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    if (spacings[i] > longest) behind.push_back(i + 1);
  }
  return behind;
}

int RowsOf(const LinearTape& tape, int sensor) {
  int rows = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (z.sensor != sensor) continue;
      rows = std::max(rows, static_cast<int>(z.residual.size()));
    }
  }
  return rows;
}

}  // namespace hindsight
