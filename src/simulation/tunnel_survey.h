#ifndef HINDSIGHT_SIMULATION_TUNNEL_SURVEY_H_
#define HINDSIGHT_SIMULATION_TUNNEL_SURVEY_H_

#include <string>
#include <vector>

#include "simulation/scenario.h"

namespace hindsight {

/// The off-line survey of Yu, Lee, Park and Han (2002), section IV: 8 km in
/// 2005 s at 4 m/s, a strapdown IMU, an odometer at 1 Hz and surveyed reference
/// points. Corners are taken at 45 deg/s, ramps at 30 deg/s of pitch rate.
struct TunnelSurveyOptions {
  /// The paper's figure of its path is lost; these three stand for it.
  ///   winding     corners of 45 and 90 deg every 250 m, now left, now right
  ///   serpentine  lanes of 450 m back and forth, U-turns between them
  ///   straight    one direction, corners of 15 deg, back after 100 m
  /// All have ramps up and down of 6 deg.
  std::string path = "winding";
  /// How the paper's white noise, 0.35 deg/h and 50 ug, is meant.
  enum class Noise {
    kSample,   ///< standard deviation of each 100 Hz sample
    kDensity,  ///< density per sqrt(Hz)
  };
  Noise noise = Noise::kSample;
  double reference_spacing = 2000.0;  ///< along the path [m]
  double odometer_sigma = 0.02;       ///< each axis [m/s]
  Odometer::Form odometer_form = Odometer::Form::kThreeAxis;
};

inline constexpr char kTunnelSurveyName[] = "tunnel_survey";

/// Length of the path [m].
inline constexpr double kTunnelLength = 8000.0;

std::vector<std::string> TunnelPathNames();

/// The scenario "tunnel_survey", streams "odometer" and "reference". Throws
/// InputError for an unknown path, or a spacing or sigma that is not positive.
Scenario TunnelSurvey(const TunnelSurveyOptions& options);

/// Times at which the vehicle passes s = spacing, 2 spacing, ... up to the end
/// of the path [s].
std::vector<double> ReferenceTimes(double spacing);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_TUNNEL_SURVEY_H_
