#ifndef HINDSIGHT_DATASET_ALIGNMENT_CHOICE_H_
#define HINDSIGHT_DATASET_ALIGNMENT_CHOICE_H_

#include <string>
#include <vector>

namespace hindsight {

/// How the initial attitude is found.
enum class AlignmentKind {
  kAuto,          ///< the method with the smallest sigma
  kGiven,         ///< from the configuration
  kStatic,        ///< levelled at rest, heading left open
  kGyrocompass,   ///< levelled at rest, heading from the Earth's rotation
  kCourse,        ///< heading from the course of the first motion
  kVelocity,      ///< from specific force against velocity or position
  kMagnetometer,  ///< heading from the magnetic field
  kHeading,       ///< heading of a baseline, of two antennas
  kAhrs,          ///< an attitude filter over the first seconds
};

/// "auto", "given", "static"... in the order of AlignmentKind, as in a
/// configuration.
inline std::vector<std::string> AlignmentNames() {
  return {"auto",     "given",        "static",  "gyrocompass", "course",
          "velocity", "magnetometer", "heading", "ahrs"};
}

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_ALIGNMENT_CHOICE_H_
