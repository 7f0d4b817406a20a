#ifndef HINDSIGHT_SIMULATION_UUV_SCENARIOS_H_
#define HINDSIGHT_SIMULATION_UUV_SCENARIOS_H_

#include <string>

#include "simulation/scenario.h"

namespace hindsight {

/// An underwater vehicle with a tactical IMU (1 deg/h, 0.3 mg), a DVL at 1 Hz
/// (0.3 % scale error, 0.2 deg boresight, 1 cm/s) and a depth gauge, that dives
/// with its heading known to 0.5 deg.
struct UuvSurveyOptions {
  std::string path = "lawnmower";  ///< of MakeUuvPath
  Dvl::Form form = Dvl::Form::kThreeAxis;
  bool final_fix = true;  ///< one position at the end, 0.5 m an axis
  double gap = 0.0;       ///< without DVL in the middle of the dive [s]
};

inline constexpr char kUuvSurveyName[] = "uuv_survey";
inline constexpr char kUuvStraightName[] = "uuv_straight";
inline constexpr char kUuvCalibrationName[] = "uuv_calibration";

/// Streams "dvl", "depth" and "fix". Throws InputError for an unknown path.
Scenario UuvSurvey(const UuvSurveyOptions& options);

/// The same vehicle in figures of eight at the surface with GNSS at 1 Hz, to
/// calibrate the DVL: scale 1 %, boresight 2 deg and lever arm 0.3 m are told
/// wrongly.
Scenario UuvCalibration();

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_UUV_SCENARIOS_H_
