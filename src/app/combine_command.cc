#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iostream>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "app/command.h"
#include "app/flags.h"
#include "app/result_folder.h"
#include "app/run_output.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/units.h"
#include "evaluation/combined_constants.h"
#include "geometry/so3.h"
#include "io/config/constants_reader.h"
#include "io/write/summary.h"
#include "io/write/table.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Averages the constants (scales, mountings, lever arms, time offsets, offsets)
of several results of 'run', weighted by their covariances, for another
recording of the same sensors: 'run --constants=DIR' or constants.from in its
configuration.

Each result counts with what its data add to its configuration's a priori
values, which count once. The table shows, of every constant, the mean, its
sigma in the next recording, how the recordings agree (chi-square over degrees
of freedom, of those that observe it, and its probability by chance), and how
many sigmas each is from the mean of the others. A constant that differs by
more than chance (0.3 %) varies from recording to recording: its sigma holds
that, and the result is doubtful (exit status 3). Not combined are the biases of
the IMU, errors over the ground, and time offsets of streams whose clock is the
recording's own (time_offset: unknown, rows that are counted, a given start).

DIR gets summary.json, whose constants 'constants.from' reads.
)";

std::string Shown(double value, const std::string& unit) {
  return fmt::format("{:.5g}", unit == "rad" ? value / kDegree : value);
}

std::string AgreementTable(const CombinedConstants& combined,
                           const std::vector<std::string>& results) {
  std::vector<std::string> heading = {
      "constant",   "mean",         "sigma",       "unit",
      "varies\nby", "observed\nby", "chi^2/\ndof", "by\nchance"};
  for (const std::string& result : results) {
    heading.push_back(result + "\n[sigma]");
  }
  ReportTable table(std::move(heading));
  for (std::size_t i = 0; i < combined.constants.size(); ++i) {
    const ConstantEstimate& c = combined.constants[i];
    const ConstantAgreement& a = combined.agreement[i];
    const bool compared = a.recordings > 1;
    std::vector<std::string> row = {
        c.name,
        Shown(c.value, c.unit),
        Shown(c.sigma, c.unit),
        c.unit == "rad" ? "deg" : c.unit,
        a.varies_by > 0.0 ? Shown(a.varies_by, c.unit) : "",
        std::to_string(a.recordings),
        compared ? fmt::format("{:.2f}", a.chi_square / static_cast<double>(
                                                            a.recordings - 1))
                 : "",
        compared ? fmt::format("{:.2g}", a.probability) : ""};
    for (const auto& distance : a.distance) {
      row.push_back(distance ? fmt::format("{:.1f}", *distance) : "");
    }
    table.AddRow(std::move(row));
  }
  return table.Render(StyleOfOutput());
}

std::string Together(const CombinedConstants& combined) {
  return fmt::format(
      "together: chi-square {:.1f} of {:.0f} degrees of freedom, by chance "
      "{:.2g}\n",
      combined.chi_square, combined.dof, combined.probability);
}

MethodSummary Summarize(const CombinedConstants& combined) {
  MethodSummary m;
  m.method = "combined";
  m.evidence = combined.evidence;
  m.grade = GradeOf(combined.evidence);
  m.verdict = m.grade == Grade::kUsable
                  ? "usable: the recordings agree on their constants"
                  : std::string(GradeName(m.grade)) + ": " +
                        combined.evidence.front().what;
  m.constants = combined.constants;
  m.constant_covariance = combined.P;
  for (const auto& [sensor, q_sb] : combined.q_sb) {
    m.mountings.push_back({sensor, EulerFromQuaternion(q_sb)});
  }
  return m;
}

/// The line that names what every recording has of its own, or "".
std::string NotCombined(const std::vector<RecordedConstants>& all) {
  std::set<std::string> names;
  for (const RecordedConstants& one : all) {
    names.insert(one.of_recording.begin(), one.of_recording.end());
  }
  if (names.empty()) return "";
  return fmt::format("not combined, as every recording has its own: {}\n",
                     fmt::join(names, ", "));
}

/// The files of all results. A recording counts once, as its errors are the same
/// in every result of it. Throws InputError.
std::vector<FileDigest> FilesOfDifferentRecordings(
    const std::vector<std::string>& results) {
  std::vector<FileDigest> all;
  std::map<std::string, std::string> seen;  // results by SHA-256
  for (const std::string& result : results) {
    for (FileDigest& file : RecordedFiles(result)) {
      const auto [at, is_new] = seen.emplace(file.sha256, result);
      if (!is_new && at->second != result) {
        throw InputError(
            SummaryOf(result).string(), 0,
            fmt::format("is of the same recording as {}: both read {}; "
                        "expected results of different recordings",
                        at->second, file.path));
      }
      all.push_back(std::move(file));
    }
  }
  return all;
}

int Combine(const std::vector<std::string>& results, ResultFolder* folder) {
  std::vector<RecordedConstants> all;
  for (const std::string& result : results) {
    all.push_back(ReadConstants(result, ""));
  }
  std::vector<FileDigest> files = FilesOfDifferentRecordings(results);
  const CombinedConstants combined = CombineConstants(all);
  const MethodSummary method = Summarize(combined);
  RunSummary summary;
  summary.program = kProgram;
  summary.dataset = fmt::format("constants of {} results", results.size());
  summary.complete = true;
  summary.inputs = std::move(files);
  for (const RecordedConstants& one : all) {
    if (one.grade == Grade::kUsable) continue;
    summary.warnings.push_back(one.source + " is " + GradeName(one.grade));
  }
  summary.best = method.method;
  summary.methods = {method};
  folder->Commit(kSummaryName, SummaryText(summary));
  std::cout << AgreementTable(combined, results) << Together(combined)
            << NotCombined(all);
  for (const std::string& warning : summary.warnings) {
    std::cout << "warning: " << warning << "\n";
  }
  for (const Evidence& evidence : combined.evidence) {
    std::cout << Describe(evidence) << "\n";
  }
  std::cout << method.verdict << "\n";
  return StatusOf(method.grade);
}

int Run(const std::vector<std::string>& arguments) {
  if (FLAGS_out.empty()) {
    throw UsageError("'combine' needs --out=DIR, the folder for the result");
  }
  const auto inputs = [&] {
    ResultFolder::Paths files;
    for (const std::string& result : arguments) {
      files.push_back(SummaryOf(result));
    }
    return files;
  };
  return WithResultFolder(
      {FLAGS_out, FLAGS_force, FLAGS_clean}, inputs,
      [&](ResultFolder* folder) { return Combine(arguments, folder); });
}

}  // namespace

Command CombineCommand() {
  return {
      .name = "combine",
      .summary = "average the constants of several results",
      .arguments = "RESULT RESULT2 ...",
      .help = kHelp,
      .flags = {{"out", "DIR", "folder for the result (required)"},
                {"force", "",
                 "replace DIR if it holds nothing but an earlier\n"
                 "result, by its manifest.json"},
                {"clean", "", "remove what killed calls left beside DIR"}},
      .min_arguments = 2,
      .max_arguments = 256,
      .run = Run,
  };
}

}  // namespace hindsight
