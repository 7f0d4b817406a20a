#include "attitude/attached_magnet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "attitude/magnetometer_errors.h"

namespace hindsight {
namespace {

constexpr double kLeastTime = 5.0;  // [s]

Eigen::Vector3d MedianOf(std::vector<Eigen::Vector3d> values) {
  Eigen::Vector3d median;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::nth_element(
        values.begin(), middle, values.end(),
        [axis](const auto& a, const auto& b) { return a(axis) < b(axis); });
    median(axis) = (*middle)(axis);
  }
  return median;
}

/// What the readings differ in from the reference, and its cost.
class Differences {
 public:
  Differences(std::span<const SurveyedField> readings,
              const FieldSurvey& survey, double sigma)
      : readings_(readings), sigma_(sigma) {
    const Eigen::Vector3d field_n(survey.horizontal * std::cos(survey.azimuth),
                                  survey.horizontal * std::sin(survey.azimuth),
                                  survey.down);
    for (const SurveyedField& reading : readings) {
      in_b.emplace_back(reading.field_b - reading.q_nb.conjugate() * field_n);
      in_n.emplace_back(reading.q_nb * reading.field_b - field_n);
    }
  }
  /// Of an error of reading k [1].
  double Cost(std::size_t k, const Eigen::Vector3d& error) const {
    constexpr double kOutlier = 4.0;      // [sigma]
    constexpr double kIndependent = 1.0;  // [s]
    const double d2 = error.squaredNorm() / (sigma_ * sigma_);
    return 0.5 * std::min(d2, kOutlier * kOutlier) *
           std::min(1.0, readings_[k].dt / kIndependent);
  }
  double CostOfChange() const {
    return std::log(static_cast<double>(readings_.size()));
  }
  double TimeOf(const std::vector<char>& with) const {
    double time = 0.0;
    for (std::size_t k = 0; k < with.size(); ++k) {
      if (with[k] != 0) time += readings_[k].dt;
    }
    return time;
  }
  static Eigen::Vector3d MedianWith(const std::vector<Eigen::Vector3d>& values,
                                    const std::vector<char>& with) {
    std::vector<Eigen::Vector3d> chosen;
    for (std::size_t k = 0; k < with.size(); ++k) {
      if (with[k] != 0) chosen.push_back(values[k]);
    }
    return MedianOf(std::move(chosen));
  }

  std::vector<Eigen::Vector3d> in_b, in_n;  ///< [uT]

 private:
  std::span<const SurveyedField> readings_;
  double sigma_;
};

/// The likeliest sequence: whether the hard iron is there.
std::vector<char> MostLikelySequence(const Differences& d,
                                     const Eigen::Vector3d& iron_b) {
  const std::size_t count = d.in_b.size();
  std::vector<std::array<char, 2>> from(count);
  std::array<double, 2> cost = {0.0, 0.0};
  for (std::size_t k = 0; k < count; ++k) {
    std::array<double, 2> next;
    for (const int state : {0, 1}) {
      const auto s = static_cast<std::size_t>(state);
      const double changed = cost[1 - s] + d.CostOfChange();
      const bool stays = k == 0 || cost[s] <= changed;
      from[k][s] = static_cast<char>(stays ? state : 1 - state);
      const Eigen::Vector3d error = d.in_b[k] - state * iron_b;
      next[s] = (stays ? cost[s] : changed) + d.Cost(k, error);
    }
    cost = next;
  }
  std::vector<char> with(count);
  char state = cost[1] < cost[0] ? 1 : 0;
  for (std::size_t k = count; k-- > 0;) {
    with[k] = state;
    state = from[k][static_cast<std::size_t>(state)];
  }
  return with;
}

/// Whether the readings with the hard iron are likelier with it than with a
/// field that does not turn with the body.
bool TurnsWithTheBody(const Differences& d, const std::vector<char>& with,
                      const Eigen::Vector3d& iron_b) {
  const Eigen::Vector3d still_n = Differences::MedianWith(d.in_n, with);
  double gain = -d.CostOfChange();
  for (std::size_t k = 0; k < with.size(); ++k) {
    if (with[k] == 0) continue;
    gain += d.Cost(k, d.in_n[k] - still_n) - d.Cost(k, d.in_b[k] - iron_b);
  }
  return gain > 0.0;
}

}  // namespace

std::vector<AttachedMagnet> FindAttachedMagnets(
    std::span<const SurveyedField> readings, const FieldSurvey& survey,
    double sigma) {
  constexpr double kSigmas = 3.0;  // of a first guess
  constexpr int kSteps = 8;
  const Differences d(readings, survey, sigma);
  std::vector<char> with;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const bool differs = d.in_b[k].norm() > kSigmas * sigma;
    with.push_back(differs && !readings[k].at_rest ? 1 : 0);
  }
  Eigen::Vector3d iron_b = Eigen::Vector3d::Zero();
  for (int step = 0; step < kSteps; ++step) {
    if (d.TimeOf(with) < kLeastTime) return {};
    iron_b = Differences::MedianWith(d.in_b, with);
    with = MostLikelySequence(d, iron_b);
  }
  if (d.TimeOf(with) < kLeastTime || iron_b.norm() < kLeastHardIron ||
      !TurnsWithTheBody(d, with, iron_b)) {
    return {};
  }
  std::vector<AttachedMagnet> magnets;
  for (std::size_t k = 0; k < with.size(); ++k) {
    if (with[k] == 0) continue;
    if (k == 0 || with[k - 1] == 0) {
      magnets.push_back({readings[k].t, readings[k].t, iron_b});
    }
    magnets.back().end = readings[k].t;
  }
  return magnets;
}

}  // namespace hindsight
