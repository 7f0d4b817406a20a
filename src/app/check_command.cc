#include <fmt/core.h>

#include <iostream>
#include <string>
#include <vector>

#include "alignment/mounting_search.h"
#include "alignment/start_layout.h"
#include "app/allan_report.h"
#include "app/command.h"
#include "app/flags.h"
#include "app/list_flags.h"
#include "app/noise_report.h"
#include "app/run_report.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/units.h"
#include "dataset/checks.h"
#include "dataset/clock_search.h"
#include "io/config/config.h"
#include "io/write/number_format.h"
#include "io/write/summary.h"
#include "io/write/table.h"
#include "problems/noise_estimation.h"
#include "problems/rest_by_estimate.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Loads the recording that CONFIG describes and reports rates, gaps, duplicates
and overlap of its streams, whether specific force and angular rate are
plausible, the axes of the IMU as gravity at rest shows them, and at which
offsets a truth or an aiding stream with `time_offset: unknown` fits the IMU:
with a warning where an aiding stream fits about as well at several.
Writes nothing but by --write. The last line says whether the recording is usable (exit status
0), doubtful, as each warning makes it that is not of the truth (3), or not
usable (1).

With --noise it also finds, by maximum likelihood of the forward filter's
innovations, the factor by which each sensor's sigma and the IMU's two noise
densities must be multiplied to be honest. Gates and robust losses are off
meanwhile. With --write CONFIG gets what differs from it by more than two
standard deviations; all else in it stays as it is.

With --allan it gives the overlapping Allan deviation of each axis over the
longest rest, white noise, bias instability and walk with their sigmas, and the
`noise` that they make: of the sensor alone, without a vehicle's vibration.
)";

/// Gaps listed one by one; more are counted.
constexpr std::size_t kListedGaps = 5;

std::string StreamTable(const std::vector<StreamReport>& streams) {
  ReportTable table({"stream", "rows", "from\n[s]", "to\n[s]", "rate\n[Hz]",
                     "jitter\n[ms]", "gaps", "duplicates", "overlap\n[s]"});
  for (const StreamReport& stream : streams) {
    table.AddRow(
        {stream.name, std::to_string(stream.count),
         FormatFixed(stream.t_begin, 3), FormatFixed(stream.t_end, 3),
         FormatFixed(stream.rate, 2), FormatFixed(1e3 * stream.jitter, 3),
         std::to_string(stream.gaps.size()), std::to_string(stream.duplicates),
         FormatFixed(stream.overlap, 3)});
  }
  return table.Render(StyleOfOutput());
}

std::string DescribeGaps(const std::vector<StreamReport>& streams) {
  std::string text;
  for (const StreamReport& stream : streams) {
    for (std::size_t i = 0; i < stream.gaps.size(); ++i) {
      if (i == kListedGaps) {
        text += fmt::format("gap: {}: {} more\n", stream.name,
                            stream.gaps.size() - i);
        break;
      }
      text += fmt::format("gap: {}: {:.3f} s from t = {:.3f} s\n", stream.name,
                          stream.gaps[i].length, stream.gaps[i].t);
    }
  }
  return text;
}

std::string DescribeSpans(const char* what,
                          const std::vector<TimeInterval>& spans) {
  std::string text = fmt::format("{}: {:.1f} s in {} spans", what,
                                 TotalLength(spans), spans.size());
  for (std::size_t i = 0; i < spans.size(); ++i) {
    text += fmt::format("{}{:.2f} to {:.2f}", i == 0 ? ": " : ", ",
                        spans[i].begin, spans[i].end);
  }
  return text + "\n";
}

std::string DescribeRest(const Rest& rest) {
  std::string text = DescribeSpans("at rest", rest.at_rest);
  if (!rest.moving.empty()) {
    text += DescribeSpans("not turning, but moving", rest.moving);
  }
  if (!rest.undecided.empty()) {
    text +=
        DescribeSpans("not turning, moving or not undecided", rest.undecided);
  }
  if (!rest.turning.empty()) {
    text += DescribeSpans(
        "at rest or turning steadily, as the rates contradict each other",
        rest.turning);
  }
  return text;
}

std::string DescribeImu(const CheckReport& report) {
  const ImuReport& imu = report.imu;
  std::string text = fmt::format(
      "specific force: mean {:.3f}, largest {:.2f} m/s^2; angular rate: "
      "largest "
      "{:.2f} deg/s\n",
      imu.record.mean_force, imu.record.max_force,
      imu.record.max_rate / kDegree);
  text += DescribeRest(imu.rest);
  if (imu.rest_force) {
    text += fmt::format(
        "  mean specific force [{:.4f}, {:.4f}, {:.4f}] m/s^2\n",
        imu.rest_force->x(), imu.rest_force->y(), imu.rest_force->z());
  }
  if (imu.rest_rate) {
    const Eigen::Vector3d rate = *imu.rest_rate / kDegree;
    text += fmt::format("  mean angular rate [{:.5f}, {:.5f}, {:.5f}] deg/s\n",
                        rate.x(), rate.y(), rate.z());
  }
  return text + "axes: " + report.axes + "\n";
}

/// The last line.
std::string DescribeGrade(const CheckReport& report) {
  const std::size_t warnings = report.warnings.size() + report.evidence.size();
  std::string text = "the recording is " +
                     PaintGrade(GradeName(report.grade()), StyleOfOutput()) +
                     (warnings == 0 ? ": nothing looks wrong"
                                    : fmt::format(": {} warning{}", warnings,
                                                  warnings == 1 ? "" : "s"));
  if (!report.truth_warnings.empty()) text += "; see the warning of the truth";
  return text + "\n";
}

/// What the estimate adds to the decisions of rest, if there is one.
void DecideAsRunDoes(Dataset* dataset, Rest* rest) {
  try {
    ResolveMountings(dataset);
    *rest = DecideRest(dataset);
  } catch (const EstimationError&) {
    // `run` says what is missing.
  }
}

int Run(const std::vector<std::string>& arguments) {
  if (FLAGS_write && !FLAGS_noise) {
    throw UsageError("--write goes with --noise");
  }
  ResolvedConfig resolved;
  Dataset dataset =
      LoadDataset(arguments[0],
                  {.data_root = FLAGS_data_root,
                   .without = ReadWords("without", FLAGS_without)},
                  &resolved);
  RequireCapacity(dataset, arguments[0]);
  CheckReport report = CheckDataset(dataset);
  for (std::string& warning : FindAmbiguousClocks(dataset)) {
    report.warnings.push_back(std::move(warning));
  }
  for (const std::string& assumption : resolved.unconfirmed) {
    report.warnings.push_back("taken for granted and not confirmed: " +
                              assumption);
  }
  if (dataset.stationary.enabled) DecideAsRunDoes(&dataset, &report.imu.rest);
  std::cout << "recording '" << dataset.name << "'\n\n"
            << StreamTable(report.streams) << "\n"
            << DescribeGaps(report.streams) << DescribeImu(report)
            << DescribeNotes(dataset, NotesOf(dataset));
  for (const auto* warnings : {&report.warnings, &report.truth_warnings}) {
    for (const std::string& warning : *warnings) {
      std::cout << "warning: " << warning << "\n";
    }
  }
  for (const Evidence& evidence : report.evidence) {
    std::cout << "warning: " << Describe(evidence) << "\n";
  }
  if (FLAGS_allan) std::cout << DescribeAllan(dataset, report.imu.rest);
  if (FLAGS_noise) {
    ResolveMountings(&dataset);
    if (dataset.stationary.enabled) AddRestStreams(report.imu.rest, &dataset);
    const NoiseEstimate estimate = EstimateNoise(dataset);
    std::cout << DescribeNoise(estimate);
    if (!estimate.converged) {
      report.warnings.emplace_back(
          "the search for the noise came to no end: its factors are not to be "
          "relied on");
      std::cout << "warning: " << report.warnings.back() << "\n";
    } else if (FLAGS_write) {
      std::cout << WriteNoise(estimate, dataset, arguments[0]);
    }
  }
  std::cout << DescribeGrade(report);
  return StatusOf(report.grade());
}

}  // namespace

Command CheckCommand() {
  return {
      .name = "check",
      .summary = "examine a recording",
      .arguments = "CONFIG",
      .help = kHelp,
      .flags = {{"data_root", "DIR",
                 "where a relative folder of CONFIG is looked for, if\n"
                 "not beside it"},
                {"without", "NAMES",
                 "leave out these aiding streams of CONFIG"},
                {"allan", "",
                 "also the Allan deviations of the longest rest, and the\n"
                 "noise that follows from them"},
                {"noise", "", "also estimate by what the stated noise is off"},
                {"write", "",
                 "with --noise: put what was found into CONFIG, each with the\n"
                 "reason as a comment on the line before"}},
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
