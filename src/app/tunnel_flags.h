#ifndef HINDSIGHT_APP_TUNNEL_FLAGS_H_
#define HINDSIGHT_APP_TUNNEL_FLAGS_H_

#include "simulation/tunnel_survey.h"

namespace hindsight {

/// The tunnel survey that --path and --white-noise ask for. Throws UsageError.
TunnelSurveyOptions ReadTunnelFlags();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_TUNNEL_FLAGS_H_
