#include "app/allan_report.h"

#include <fmt/core.h>

#include <algorithm>
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

bool IsSeen(const AllanCoefficient& c) {
  constexpr double kSeen = 3.0;
  return c.value > kSeen * c.sigma;
}

/// A line of `noise` for three axes, of which it takes one value: their root mean
/// square, or the largest where they differ by more than twofold, since too little
/// noise misleads more than too much. What no axis shows is a comment.
template <class Pick>
std::string NoiseLine(const ImuAllan& allan, std::size_t first, const char* key,
                      const char* unit, double si, Pick pick) {
  constexpr double kAlike = 2.0;
  double squares = 0.0;
  double bound = 0.0;
  std::size_t largest = first;
  std::size_t least = first;
  int seen = 0;
  for (std::size_t i = first; i < first + 3; ++i) {
    const AllanCoefficient& c = pick(allan.fits[i]);
    bound = std::max(bound, c.value + c.sigma);
    if (!IsSeen(c)) continue;
    if (seen == 0 || c.value > pick(allan.fits[largest]).value) largest = i;
    if (seen == 0 || c.value < pick(allan.fits[least]).value) least = i;
    squares += c.value * c.value;
    ++seen;
  }
  if (seen == 0) {
    return fmt::format("    # {}: not seen in this rest, below {:.2g} {}\n",
                       key, bound / si, unit);
  }
  const double most = pick(allan.fits[largest]).value;
  const double ratio = most / pick(allan.fits[least]).value;
  const bool alike = seen == 3 && ratio < kAlike;
  std::string line =
      fmt::format("    {}: {:.3g} {}", key,
                  (alike ? std::sqrt(squares / 3.0) : most) / si, unit);
  if (seen < 3) {
    line += fmt::format("   # {}; {} not seen", kAllanAxes[largest],
                        seen == 1 ? "the other two are" : "another is");
  } else if (!alike) {
    line += fmt::format("   # {}, the largest: {:.2g} times {}",
                        kAllanAxes[largest], ratio, kAllanAxes[least]);
  }
  return line + "\n";
}

std::string NoiseBlock(const ImuAllan& allan) {
  const auto white = [](const AllanFit& fit) -> const AllanCoefficient& {
    return fit.white;
  };
  const auto walk = [](const AllanFit& fit) -> const AllanCoefficient& {
    return fit.walk;
  };
  return NoiseLine(allan, 0, "gyro", "deg/s/sqrt(Hz)", kDegree, white) +
         NoiseLine(allan, 3, "accel", "mg/sqrt(Hz)", kMilliG, white) +
         NoiseLine(allan, 0, "gyro_bias_walk", "deg/s^2/sqrt(Hz)", kDegree,
                   walk) +
         NoiseLine(allan, 3, "accel_bias_walk", "mg/s/sqrt(Hz)", kMilliG, walk);
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
