#include "problems/exchanged_axes.h"

#include <fmt/core.h>

#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "evaluation/grade.h"
#include "problems/coarse_start.h"
#include "problems/exchanged_places.h"
#include "problems/rival_data.h"
#include "problems/shown_noise.h"

namespace hindsight {
namespace {

constexpr const char* kImuAxes[] = {"x", "y", "z"};

/// Axes as they may be.
struct OtherAxes {
  bool of_gyros;
  Eigen::Matrix3d in_body;  ///< of what is read
  std::string words;
};

std::vector<OtherAxes> AllOtherAxes() {
  std::vector<OtherAxes> all;
  for (const bool of_gyros : {true, false}) {
    const char* triad = of_gyros ? "gyro" : "accelerometer";
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3, last = (i + 2) % 3;
      Eigen::Vector3d signs = Eigen::Vector3d::Ones();
      signs(i) = -1.0;
      all.push_back(
          {of_gyros, signs.asDiagonal(),
           fmt::format("{} {} has the other sign", triad, kImuAxes[i])});
      Eigen::Vector3i order(0, 1, 2);
      std::swap(order(next), order(last));
      const Eigen::Matrix3d exchanged(Eigen::PermutationMatrix<3>{order});
      const std::string words =
          fmt::format("{} {} and {} stand for each other", triad,
                      kImuAxes[next], kImuAxes[last]);
      all.push_back({of_gyros, exchanged, words});
      Eigen::Vector3d others = -Eigen::Vector3d::Ones();
      others(i) = 1.0;
      all.push_back({of_gyros, others.asDiagonal() * exchanged,
                     words + ", with the other sign"});
    }
  }
  all.push_back(
      {true, -Eigen::Matrix3d::Identity(), "all gyros have the other sign"});
  return all;
}

bool MayHideOtherAxes(ForwardStage* chosen) {
  const Timeline& timeline = chosen->timeline();
  return chosen->start().layout.has_canonical_head() &&
         timeline.node(timeline.size() - 1).t - timeline.node(0).t <=
             kLongestOfExchanged &&
         StateTooMuch(chosen->fit().innovations, kFalseAlarms);
}

std::optional<RivalSolution> RivalBy(const OtherAxes& axes, double log_odds,
                                     const ForwardStage& chosen,
                                     RivalComparison* comparison) {
  Dataset dataset = chosen.dataset();
  for (ImuSample& sample : dataset.imu.samples) {
    Eigen::Vector3d& reading = axes.of_gyros ? sample.gyro : sample.accel;
    reading = (axes.in_body * reading).eval();
  }
  ReconstructionOptions options = chosen.options();
  options.progress = nullptr;
  RivalSolution words;
  words.description = axes.words;
  words.remedy = "if so, order and signs of the IMU's columns";
  const auto solve = [&](ForwardStage stage) {
    return comparison->Solve(log_odds, RivalReadings::kTheSame, words, &stage);
  };
  // An alignment in full takes several times as long as all the rest.
  if (std::optional<Start> start = CoarseStart(options, &dataset)) {
    try {
      return solve(ForwardStage(dataset, options, std::move(*start)));
    } catch (const EstimationError&) {
      // It is tried in full.
    }
  }
  return solve(ForwardStage(dataset, options));
}

}  // namespace

std::vector<RivalSolution> ExchangedAxes(ForwardStage* chosen) {
  if (!MayHideOtherAxes(chosen)) return {};
  RivalComparison comparison(chosen);
  const std::vector<OtherAxes> all = AllOtherAxes();
  return RareRivals(all.size(), [&](std::size_t i, double log_odds) {
    return RivalBy(all[i], log_odds, *chosen, &comparison);
  });
}

}  // namespace hindsight
