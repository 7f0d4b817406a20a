#include "io/write/allan_json.h"

#include <utility>

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

Json CoefficientJson(const AllanCoefficient& coefficient) {
  return {{"value", coefficient.value}, {"sigma", coefficient.sigma}};
}

}  // namespace

nlohmann::ordered_json AllanJson(const ImuAllan& allan) {
  Json json = {{"span_s", {allan.span.begin, allan.span.end}}};
  for (const AllanPoint& point : allan.points[0]) {
    json["tau_s"].push_back(point.tau);
    json["log_sigma"].push_back(point.log_sigma);
  }
  for (std::size_t i = 0; i < kAllanAxes.size(); ++i) {
    Json axis = {{"axis", kAllanAxes[i]}, {"unit", i < 3 ? "rad/s" : "m/s^2"}};
    for (const AllanPoint& point : allan.points[i]) {
      axis["deviation"].push_back(point.deviation);
    }
    axis["white"] = CoefficientJson(allan.fits[i].white);
    axis["instability"] = CoefficientJson(allan.fits[i].instability);
    axis["walk"] = CoefficientJson(allan.fits[i].walk);
    json["axes"].push_back(std::move(axis));
  }
  return json;
}

}  // namespace hindsight
