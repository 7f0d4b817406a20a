#include "app/allan_report.h"

#include <fmt/core.h>

#include <cmath>

#include "app/terminal.h"
#include "base/error.h"
#include "base/units.h"
#include "dataset/allan.h"
#include "io/write/table.h"

namespace hindsight {
namespace {

/// Densities are told in deg/s/sqrt(Hz) and mg/sqrt(Hz).
double UnitOf(std::size_t axis) { return axis < 3 ? kDegree : kMilliG; }

TimeInterval LongestRest(const Rest& rest) {
  TimeInterval longest;
  for (const auto* spans : {&rest.at_rest, &rest.undecided}) {
    for (const TimeInterval& span : *spans) {
      if (span.length() > longest.length()) longest = span;
    }
  }
  return longest;
}

std::string PointTable(const ImuAllan& allan) {
  ReportTable table({"tau\n[s]", "gyro x\n[deg/s]", "gyro y\n[deg/s]",
                     "gyro z\n[deg/s]", "accel x\n[mg]", "accel y\n[mg]",
                     "accel z\n[mg]", "sigma\n[%]"});
  for (std::size_t k = 0; k < allan.points[0].size(); ++k) {
    std::vector<std::string> row = {
        fmt::format("{:.4g}", allan.points[0][k].tau)};
    for (std::size_t i = 0; i < kAllanAxes.size(); ++i) {
      row.push_back(
          fmt::format("{:.3g}", allan.points[i][k].deviation / UnitOf(i)));
    }
    row.push_back(fmt::format("{:.1f}", 100.0 * allan.points[0][k].log_sigma));
    table.AddRow(row);
  }
  return table.Render(StyleOfOutput());
}

std::string FitTable(const ImuAllan& allan) {
  ReportTable table({"axis", "white noise\n[/sqrt(Hz)]", "bias\ninstability",
                     "walk\n[/s/sqrt(Hz)]", "unit"});
  for (std::size_t i = 0; i < kAllanAxes.size(); ++i) {
    const auto cell = [&](const AllanCoefficient& c) {
      return fmt::format("{:.3g} +- {:.1g}", c.value / UnitOf(i),
                         c.sigma / UnitOf(i));
    };
    const AllanFit& fit = allan.fits[i];
    table.AddRow({kAllanAxes[i], cell(fit.white), cell(fit.instability),
                  cell(fit.walk), i < 3 ? "deg/s" : "mg"});
  }
  return table.Render(StyleOfOutput());
}

/// The root mean square of three axes.
template <class Pick>
AllanCoefficient OfAxes(const ImuAllan& allan, std::size_t first, Pick pick) {
  AllanCoefficient all;
  for (std::size_t i = first; i < first + 3; ++i) {
    const AllanCoefficient& c = pick(allan.fits[i]);
    all.value += c.value * c.value / 3.0;
    all.sigma += c.sigma * c.sigma / 3.0;
  }
  return {std::sqrt(all.value), std::sqrt(all.sigma)};
}

std::string WalkLine(const char* key, const char* unit, double si,
                     const AllanCoefficient& walk) {
  constexpr double kSeen = 3.0;
  const bool seen = walk.value > kSeen * walk.sigma;
  return fmt::format("    {}: {:.3g} {}{}\n", key,
                     (seen ? walk.value : walk.sigma) / si, unit,
                     seen ? "" : "   # not seen: its sigma");
}

std::string NoiseBlock(const ImuAllan& allan) {
  const auto white = [](const AllanFit& fit) { return fit.white; };
  const auto walk = [](const AllanFit& fit) { return fit.walk; };
  return fmt::format(
             "    gyro: {:.3g} deg/s/sqrt(Hz)\n    accel: {:.3g} mg/sqrt(Hz)\n",
             OfAxes(allan, 0, white).value / kDegree,
             OfAxes(allan, 3, white).value / kMilliG) +
         WalkLine("gyro_bias_walk", "deg/s^2/sqrt(Hz)", kDegree,
                  OfAxes(allan, 0, walk)) +
         WalkLine("accel_bias_walk", "mg/s/sqrt(Hz)", kMilliG,
                  OfAxes(allan, 3, walk));
}

}  // namespace

std::optional<ImuAllan> AllanOfLongestRest(const Dataset& dataset,
                                           const Rest& rest) {
  return AllanOf(dataset.imu, LongestRest(rest));
}

std::string DescribeAllan(const Dataset& dataset, const Rest& rest) {
  const TimeInterval span = LongestRest(rest);
  const auto allan = AllanOf(dataset.imu, span);
  if (!allan) {
    throw EstimationError(
        fmt::format("--allan needs a rest of 1000 samples; the longest found "
                    "lasts {:.1f} s "
                    "(`stationary` says what is quiet)",
                    span.length()));
  }
  return fmt::format("\nAllan deviation over {:.1f} to {:.1f} s\n", span.begin,
                     span.end) +
         PointTable(*allan) + "\n" + FitTable(*allan) +
         "\nof this rest, without the vibration of a vehicle that moves:\n"
         "  noise:\n" +
         NoiseBlock(*allan);
}

}  // namespace hindsight
