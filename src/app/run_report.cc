#include "app/run_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

#include "base/text.h"
#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "earth/wgs84.h"
#include "evaluation/grade.h"
#include "io/write/method_json.h"

namespace hindsight {
namespace {

std::string Spread(const Eigen::Vector3d& sigma, double scale) {
  return fmt::format("{:.3g}, {:.3g}, {:.3g}", scale * sigma.x(),
                     scale * sigma.y(), scale * sigma.z());
}

}  // namespace

std::string DescribeStart(const StartReport& start) {
  const Geodetic place = GeodeticFromEcef(start.state.p_e);
  const Eigen::Vector3d v = start.state.v_n();
  const Eigen::Vector3d euler = start.state.euler() / kDegree;
  std::string text = fmt::format("start at t = {:.3f} s\n", start.t);
  text += fmt::format(
      "  position  {:.7f}, {:.7f} deg, {:.2f} m; sigma {} m (N, E, D): {}\n",
      place.latitude / kDegree, place.longitude / kDegree, place.height,
      Spread(start.position_sigma, 1.0), start.position);
  text += fmt::format("  velocity  {:.2f}, {:.2f}, {:.2f} m/s; sigma {} m/s\n",
                      v.x(), v.y(), v.z(), Spread(start.velocity_sigma, 1.0));
  text += fmt::format("  alignment {}: {}\n", start.alignment, start.why);
  text += fmt::format(
      "  attitude  roll {:.2f}, pitch {:.2f}, heading {:.2f} deg; sigma {} "
      "deg\n            {}; heading: {}\n",
      euler.x(), euler.y(), euler.z(),
      Spread(start.attitude_sigma, 1.0 / kDegree), start.attitude,
      start.heading);
  return text;
}

std::string CommentOnStart(const StartReport& start,
                           const InitialState& given) {
  const std::string text =
      "The start as it was found; sigmas that `initial` does not give are the "
      "program's own.\n" +
      DescribeStart(start) +
      fmt::format(
          "  biases    sigma of gyros {} deg/s, of accelerometers {} "
          "m/s^2\n",
          Spread(GyroBiasSigma(given), 1.0 / kDegree),
          Spread(AccelBiasSigma(given), 1.0));
  std::string comment;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) comment += "# " + line + "\n";
  }
  return comment;
}

namespace {

/// "withheld: gnss: 3 outages, 60 measurements: 90 to 110 s, ...".
std::string DescribeWithheld(const Dataset& dataset) {
  constexpr int kMost = 5;
  std::string text;
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const AidingStream& stream = dataset.streams[i];
    std::string spans;
    int outages = 0;
    for (const Outage& outage : dataset.outages) {
      if (outage.sensor != static_cast<int>(i) || ++outages > kMost) continue;
      spans += fmt::format("{}{:.1f} to {:.1f} s", spans.empty() ? "" : ", ",
                           outage.t_begin, outage.t_end);
    }
    if (outages == 0) continue;
    const auto withheld =
        std::count_if(stream.measurements.begin(), stream.measurements.end(),
                      [](const Measurement& z) { return z.withheld; });
    text += fmt::format("withheld: {}: {} outage{}, {} measurements: {}{}\n",
                        stream.sensor.name, outages, outages == 1 ? "" : "s",
                        withheld, spans, outages > kMost ? ", ..." : "");
  }
  return text;
}

}  // namespace

std::string DescribeNotes(const Dataset& dataset,
                          const std::vector<std::string>& notes) {
  std::string text;
  for (const PolicyCount& policy : dataset.policies) {
    text += fmt::format("note: {}: {}: {}\n", policy.stream, policy.action,
                        policy.count);
  }
  for (const std::string& note : notes) {
    text += "note: " + note + "\n";
  }
  const std::string warning = WithholdingWarning(dataset);
  if (!warning.empty()) text += "warning: " + warning + "\n";
  return text + DescribeWithheld(dataset);
}

namespace {

/// Less than a figure of the report can tell.
bool IsShort(const UnobservedSpan& span) {
  return span.t_end - span.t_begin < 0.05;
}

}  // namespace

std::string DescribeUnobserved(const std::vector<UnobservedSpan>& spans) {
  std::string text;
  for (const UnobservedSpan& span : spans) {
    if (IsShort(span)) continue;
    text += fmt::format(
        "warning: {} is not observed from {:.1f} s to {:.1f} s "
        "(sigma stays above {:.3g})\n",
        span.component, span.t_begin, span.t_end, span.sigma);
  }
  return text;
}

std::string DescribeOwnUnobserved(const std::vector<UnobservedSpan>& known,
                                  const std::vector<Solution>& solutions) {
  constexpr int kMost = 10;
  std::string text;
  for (const Solution& solution : solutions) {
    int count = 0;
    for (const UnobservedSpan& span : solution.unobserved) {
      const bool told = std::any_of(
          known.begin(), known.end(), [&span](const UnobservedSpan& other) {
            return other.component == span.component &&
                   other.t_begin == span.t_begin && other.t_end == span.t_end;
          });
      if (told || IsShort(span) || ++count > kMost) continue;
      text += fmt::format(
          "{}: {} is not observed from {:.1f} s to {:.1f} s (sigma stays above "
          "{:.3g})\n",
          solution.method, span.component, span.t_begin, span.t_end,
          span.sigma);
    }
    if (count > kMost) {
      text += fmt::format("{}: {} more such spans are in summary.json\n",
                          solution.method, count - kMost);
    }
  }
  return text;
}

std::string DescribeEvidence(const std::vector<Solution>& solutions,
                             const TableStyle& style) {
  std::string text;
  for (const Solution& solution : solutions) {
    for (const Evidence& evidence : solution.evidence) {
      if (evidence.grade == Grade::kUsable) continue;
      text += solution.method + " is " +
              PaintGrade(GradeName(evidence.grade), style) + ": " +
              Describe(evidence) + "\n";
    }
  }
  return text;
}

std::string DescribeContradictions(const RunSummary& summary) {
  std::string text;
  for (const MethodSummary& method : summary.methods) {
    if (method.contradiction.empty()) continue;
    text += method.method + ": " + method.contradiction + "\n";
  }
  return text;
}

std::string DescribeConstants(const Dataset& dataset,
                              const Solution& solution) {
  if (solution.constants.empty()) return "";
  std::string text = "\nconstants of " + solution.method + ":\n";
  for (const ConstantEstimate& c : solution.constants) {
    const bool angle = c.unit.starts_with("rad");
    const double unit = angle ? kDegree : 1.0;
    const std::string name = angle ? "deg" + c.unit.substr(3) : c.unit;
    const bool kept = c.verdict == ConstantEstimate::Verdict::kUnobserved;
    text +=
        fmt::format("  {:<24} {:>10.5g}  sigma {:>9.3g} {:<6} {}{}{}{}\n",
                    c.name, c.value / unit, c.sigma / unit, name,
                    VerdictName(c.verdict), kept ? ", kept at its prior" : "",
                    c.advice.empty() ? "" : "; helps: ", c.advice);
  }
  for (const MountingSummary& mounting : MountingsOf(dataset, solution)) {
    const Eigen::Vector3d euler = mounting.euler / kDegree;
    text += fmt::format(
        "  {}: roll {:.2f}, pitch {:.2f}, yaw {:.2f} deg, vehicle from body\n",
        mounting.sensor, euler.x(), euler.y(), euler.z());
  }
  return text;
}

std::string DescribeMethodNotes(const std::vector<Solution>& solutions) {
  std::string text;
  for (const Solution& solution : solutions) {
    for (const std::string& note : solution.notes) {
      text += solution.method + " found " + note + "\n";
    }
  }
  return text;
}

std::string DescribeRivals(const std::vector<Solution>& solutions) {
  constexpr double kWorthTelling = 1e-3;
  std::string text;
  for (const Solution& solution : solutions) {
    for (const RivalSolution& rival : solution.rivals) {
      if (rival.probability < kWorthTelling) continue;
      const std::string line =
          fmt::format("another solution is {} likely: {}\n",
                      FormatProbability(rival.probability), rival.description);
      if (text.find(line) == std::string::npos) text += line;
    }
  }
  return text;
}

void NameBest(const Solution& best, const std::vector<Solution>& solutions,
              RunSummary* summary) {
  summary->best = best.method;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    summary->methods[i].grade = solutions[i].grade;
    summary->methods[i].evidence = solutions[i].evidence;
    summary->methods[i].verdict = solutions[i].verdict;
  }
}

std::string DescribeVerdict(const Solution& best, const TableStyle& style) {
  const std::string grade = GradeName(best.grade);
  std::string verdict = best.verdict;
  if (verdict.starts_with(grade)) {
    verdict.replace(0, grade.size(), PaintGrade(grade, style));
  }
  return best.method + " is " + verdict + "\n";
}

}  // namespace hindsight
