#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/line_picture.h"
#include "app/report_html.h"
#include "app/report_lines.h"
#include "app/report_panels.h"
#include "base/units.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

/// In the units of the page: deg/s and mg.
struct AllanAxis {
  std::string name;
  std::string unit;
  std::vector<double> tau;  ///< [s]
  std::vector<double> deviation;
  std::vector<double> log_sigma;
  double white = 0.0;
  double instability = 0.0;
  double walk = 0.0;
};

AllanAxis AxisOf(const Json& allan, const Json& json) {
  AllanAxis axis;
  axis.name = json.at("axis").get<std::string>();
  const bool gyro = axis.name.starts_with("gyro");
  const double unit = gyro ? kDegree : kMilliG;
  axis.unit = gyro ? "deg/s" : "mg";
  axis.tau = allan.at("tau_s").get<std::vector<double>>();
  axis.log_sigma = allan.at("log_sigma").get<std::vector<double>>();
  axis.deviation = json.at("deviation").get<std::vector<double>>();
  for (double& deviation : axis.deviation) deviation /= unit;
  axis.white = json.at("white").at("value").get<double>() / unit;
  axis.instability = json.at("instability").at("value").get<double>() / unit;
  axis.walk = json.at("walk").at("value").get<double>() / unit;
  return axis;
}

/// One term of the fit where it lies in the range of the deviations.
template <class Deviation>
LinePicture::Line TermOf(const AllanAxis& axis, const std::string& label,
                         Deviation deviation) {
  constexpr double kBelow = 0.5;
  const double least =
      kBelow * *std::min_element(axis.deviation.begin(), axis.deviation.end());
  LinePicture::Line line = {label, axis.tau, {}};
  line.dashed = true;
  for (const double tau : axis.tau) {
    const double y = deviation(tau);
    line.y.push_back(y < least ? std::numeric_limits<double>::quiet_NaN() : y);
  }
  return line;
}

std::string PictureOf(const AllanAxis& axis) {
  const double flat = std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);
  LinePicture picture = {.title = axis.name + " [" + axis.unit + "]",
                         .axis = "cluster time [s]",
                         .lines = {}};
  picture.logarithmic = picture.logarithmic_x = true;
  LinePicture::Line measured = {"deviation", axis.tau, axis.deviation};
  for (std::size_t k = 0; k < axis.tau.size(); ++k) {
    measured.low.push_back(axis.deviation[k] * std::exp(-axis.log_sigma[k]));
    measured.high.push_back(axis.deviation[k] * std::exp(axis.log_sigma[k]));
  }
  picture.lines.push_back(std::move(measured));
  const auto add = [&](const char* label, auto deviation) {
    picture.lines.push_back(TermOf(axis, label, deviation));
  };
  add("white noise", [&](double tau) { return axis.white / std::sqrt(tau); });
  add("bias instability", [&](double) { return flat * axis.instability; });
  add("walk", [&](double tau) { return axis.walk * std::sqrt(tau / 3.0); });
  return Render(picture);
}

std::string CoefficientCell(const Json& coefficient, double unit) {
  return fmt::format("{:.3g} \xC2\xB1 {:.1g}",
                     coefficient.at("value").get<double>() / unit,
                     coefficient.at("sigma").get<double>() / unit);
}

}  // namespace

std::string AllanPanel(ReportContext* context) {
  const Json& summary = context->reference().summary;
  if (!summary.contains("allan")) {
    return Absent("No rest of 1000 samples was found.");
  }
  const Json& allan = summary["allan"];
  std::string pictures;
  HtmlTable table({"axis", "white noise [/sqrt(Hz)]", "bias instability",
                   "walk [/s/sqrt(Hz)]", "unit"});
  for (const Json& json : allan.at("axes")) {
    const AllanAxis axis = AxisOf(allan, json);
    const double unit = axis.unit == "mg" ? kMilliG : kDegree;
    pictures += PictureOf(axis);
    table.AddRow({axis.name, CoefficientCell(json.at("white"), unit),
                  CoefficientCell(json.at("instability"), unit),
                  CoefficientCell(json.at("walk"), unit), axis.unit});
  }
  return Element("p", fmt::format(
                          "Overlapping Allan deviation over the longest rest, "
                          "{:.1f} to {:.1f} s, with its standard deviation as "
                          "bars, and what was fitted to it. Vibration on "
                          "the way is not in it, that of an idling engine "
                          "is.",
                          allan.at("span_s").at(0).get<double>(),
                          allan.at("span_s").at(1).get<double>())) +
         Grid(pictures, "") + table.Render();
}

}  // namespace hindsight
