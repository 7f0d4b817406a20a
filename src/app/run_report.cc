#include "app/run_report.h"

#include <algorithm>

#include "base/text.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "evaluation/grade.h"
#include "geometry/so3.h"
#include "problems/method.h"

namespace hindsight {
namespace {

std::string Spread(const Eigen::Vector3d& sigma, double scale) {
  return Format("%.3g, %.3g, %.3g", scale * sigma.x(), scale * sigma.y(),
                scale * sigma.z());
}

/// The bridged drop-outs, the first of many.
std::string DescribeDropOuts(const ImuStream& imu) {
  constexpr std::size_t kMost = 10;
  const std::vector<std::size_t> ends = DropOuts(imu);
  std::string text;
  for (std::size_t i = 0; i < std::min(ends.size(), kMost); ++i) {
    const double begin = imu.samples[ends[i] - 1].t;
    text +=
        Format("note: imu: no samples for %.3f s from t = %.3f s, bridged\n",
               imu.samples[ends[i]].t - begin, begin);
  }
  if (ends.size() > kMost) {
    text +=
        Format("note: imu: %zu more drop-outs bridged\n", ends.size() - kMost);
  }
  return text;
}

}  // namespace

std::string DescribeStart(const StartReport& start) {
  const Geodetic place = GeodeticFromEcef(start.state.p_e);
  const Eigen::Vector3d v = start.state.v_n();
  const Eigen::Vector3d euler = start.state.euler() / kDegree;
  std::string text = Format("start at t = %.3f s\n", start.t);
  text +=
      Format("  position  %.7f, %.7f deg, %.2f m; sigma %s m (N, E, D): %s\n",
             place.latitude / kDegree, place.longitude / kDegree, place.height,
             Spread(start.position_sigma, 1.0).c_str(), start.position.c_str());
  text += Format("  velocity  %.2f, %.2f, %.2f m/s; sigma %s m/s\n", v.x(),
                 v.y(), v.z(), Spread(start.velocity_sigma, 1.0).c_str());
  text += Format("  alignment %s: %s\n", start.alignment.c_str(),
                 start.why.c_str());
  text += Format(
      "  attitude  roll %.2f, pitch %.2f, heading %.2f deg; sigma %s "
      "deg\n            %s; heading: %s\n",
      euler.x(), euler.y(), euler.z(),
      Spread(start.attitude_sigma, 1.0 / kDegree).c_str(),
      start.attitude.c_str(), start.heading.c_str());
  return text;
}

std::string DescribeNotes(const Dataset& dataset) {
  std::string text;
  for (const PolicyCount& policy : dataset.policies) {
    text += Format("note: %s: %s: %ld\n", policy.stream.c_str(),
                   policy.action.c_str(), policy.count);
  }
  text += DescribeDropOuts(dataset.imu);
  for (const std::string& note : dataset.notes) {
    text += "note: " + note + "\n";
  }
  if (!dataset.withholdings.empty() && dataset.outages.empty()) {
    text += "warning: no whole outage of the withholding rules fits in\n";
  }
  return text;
}

std::string DescribeUnobserved(const std::vector<UnobservedSpan>& spans) {
  std::string text;
  for (const UnobservedSpan& span : spans) {
    text += Format(
        "warning: %s is not observed from %.1f s to %.1f s "
        "(sigma stays above %.3g)\n",
        span.component.c_str(), span.t_begin, span.t_end, span.sigma);
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
      if (told || ++count > kMost) continue;
      text += Format(
          "%s: %s is not observed from %.1f s to %.1f s (sigma stays above "
          "%.3g)\n",
          solution.method.c_str(), span.component.c_str(), span.t_begin,
          span.t_end, span.sigma);
    }
    if (count > kMost) {
      text += Format("%s: %d more such spans are in summary.json\n",
                     solution.method.c_str(), count - kMost);
    }
  }
  return text;
}

std::string DescribeEvidence(const std::vector<Solution>& solutions) {
  std::string text;
  for (const Solution& solution : solutions) {
    for (const Evidence& evidence : solution.evidence) {
      if (evidence.grade == Grade::kUsable) continue;
      text += solution.method + " is " + GradeName(evidence.grade) + ": " +
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

namespace {

const char* VerdictName(ConstantEstimate::Verdict verdict) {
  switch (verdict) {
    case ConstantEstimate::Verdict::kObserved:
      return "observed";
    case ConstantEstimate::Verdict::kWeak:
      return "weak";
    case ConstantEstimate::Verdict::kUnobserved:
      return "unobserved, kept at its prior";
  }
  return "";
}

}  // namespace

std::string DescribeConstants(const Dataset& dataset,
                              const Solution& solution) {
  if (solution.constants.empty()) return "";
  std::string text = "\nconstants of " + solution.method + ":\n";
  for (const ConstantEstimate& c : solution.constants) {
    const bool angle = c.unit.starts_with("rad");
    const double unit = angle ? kDegree : 1.0;
    const std::string name = angle ? "deg" + c.unit.substr(3) : c.unit;
    text += Format("  %-24s %10.5g  sigma %9.3g %-6s %s%s%s\n", c.name.c_str(),
                   c.value / unit, c.sigma / unit, name.c_str(),
                   VerdictName(c.verdict),
                   c.advice.empty() ? "" : "; helps: ", c.advice.c_str());
  }
  for (const Block& block : solution.layout.blocks()) {
    if (block.key.kind != BlockKind::kMounting) continue;
    const Eigen::Vector3d m =
        solution.states.back().parameters.segment<3>(block.parameter_offset);
    const Sensor& sensor =
        dataset.streams[static_cast<std::size_t>(block.key.sensor)].sensor;
    const Eigen::Vector3d euler =
        EulerFromQuaternion(Exp(m) * sensor.q_sb) / kDegree;
    text +=
        Format("  %s: roll %.2f, pitch %.2f, yaw %.2f deg, vehicle from body\n",
               sensor.name.c_str(), euler.x(), euler.y(), euler.z());
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
          Format("another solution is %.2g %% likely: %s\n",
                 100.0 * rival.probability, rival.description.c_str());
      if (text.find(line) == std::string::npos) text += line;
    }
  }
  return text;
}

const Solution& Best(const std::vector<Solution>& solutions) {
  std::vector<const char*> preference;
  for (const Method* method : Methods()) preference.push_back(method->name);
  return solutions.at(static_cast<std::size_t>(BestOf(solutions, preference)));
}

void NameBest(const Solution& best, const std::vector<Solution>& solutions,
              RunSummary* summary) {
  summary->best = best.method;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    summary->methods[i].evidence = solutions[i].evidence;
    summary->methods[i].verdict = solutions[i].verdict;
  }
}

std::string DescribeVerdict(const Solution& best) {
  return best.method + " is " + best.verdict + "\n";
}

}  // namespace hindsight
