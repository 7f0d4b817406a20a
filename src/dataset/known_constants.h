#ifndef HINDSIGHT_DATASET_KNOWN_CONSTANTS_H_
#define HINDSIGHT_DATASET_KNOWN_CONSTANTS_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

namespace hindsight {

struct Dataset;

/// What earlier recordings say of constants, by the names that estimates give
/// them: "dvl_scale", "dvl_lever_arm[x]", "gyro_scale[z]". SI units.
struct KnownConstants {
  std::string source;  ///< whose result, for messages
  std::vector<std::string> names;
  Eigen::VectorXd value;
  Eigen::MatrixXd P;  ///< covariance of the errors of all of them
  /// Sensor axes from body axes of every sensor with an estimated mounting. Its
  /// values are in there, and zero above; its errors are rotation vectors that
  /// act after it.
  std::map<std::string, Eigen::Quaterniond> q_sb;

  /// Index of a name, or -1.
  int Find(const std::string& name) const;
};

/// Names, without axes, of what is estimated that says nothing of another recording:
/// errors in NED axes, and the time offset of a stream whose clock is the
/// recording's own (AidingStream::clock_unknown, clock_placed).
std::vector<std::string> ConstantsOfOneRecording(const Dataset& dataset);

/// Makes them a priori values and sigmas of the sensors, and keeps them as
/// Dataset::constants for the covariances of one with another
/// (InitialCovariance in alignment/start_layout.h). Not used are
/// ConstantsOfOneRecording; a note says which time offset is not. Names of streams
/// in `without` are passed over. Throws InputError for one that no sensor here has,
/// or does not estimate.
void UseConstants(const KnownConstants& known,
                  const std::vector<std::string>& without, Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_KNOWN_CONSTANTS_H_
