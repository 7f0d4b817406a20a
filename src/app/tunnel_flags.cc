#include "app/tunnel_flags.h"

#include <algorithm>

#include "app/flags.h"

namespace hindsight {

TunnelSurveyOptions ReadTunnelFlags() {
  const std::vector<std::string> paths = TunnelPathNames();
  if (std::find(paths.begin(), paths.end(), FLAGS_path) == paths.end()) {
    throw UsageError("--path=" + FLAGS_path +
                     ": expected winding, serpentine or straight" +
                     Suggestion(FLAGS_path, paths));
  }
  TunnelSurveyOptions options;
  options.path = FLAGS_path;
  if (FLAGS_white_noise == "density") {
    options.noise = TunnelSurveyOptions::Noise::kDensity;
  } else if (FLAGS_white_noise != "sample") {
    throw UsageError("--white-noise=" + FLAGS_white_noise +
                     ": expected sample or density");
  }
  return options;
}

}  // namespace hindsight
