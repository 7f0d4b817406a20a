#ifndef HINDSIGHT_DATASET_RECORDED_CONSTANTS_H_
#define HINDSIGHT_DATASET_RECORDED_CONSTANTS_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "dataset/known_constants.h"
#include "state/evidence.h"

namespace hindsight {

/// The constants of one result, as an estimator gave them, and what it started
/// from. SI units; the components of a mounting are the rotation vector m of
/// C_sb = Exp(m) C_sb(nominal).
struct RecordedConstants {
  std::string source;  ///< whose result, for messages
  Grade grade = Grade::kUsable;
  /// The result whose constants these started from, which they hold already;
  /// empty: none.
  std::string from;
  std::vector<std::string> names;
  std::vector<std::string> units;
  Eigen::VectorXd value;
  Eigen::MatrixXd P;
  Eigen::VectorXd prior_value;
  Eigen::VectorXd prior_sigma;
  /// Those of its recording alone (ConstantsOfOneRecording), which are not
  /// among the names.
  std::vector<std::string> of_recording;
  /// Nominal mounting of every sensor whose mounting was estimated.
  std::map<std::string, Eigen::Quaterniond> q_sb_nominal;

  /// Leaves out one of them, or all components of one. Returns false if there
  /// is none of the name.
  bool Remove(const std::string& name);
  /// Index of "SENSOR_mounting[x]", behind which y and z come, or -1.
  int MountingOf(const std::string& sensor) const;
};

/// What they say to another recording: mountings as a whole, and the covariance
/// of the rotation that acts after it, J P J' with J = LeftJacobian(m).
KnownConstants KnownFrom(const RecordedConstants& recorded);

/// The same constants with the mounting of every sensor that `nominal` names
/// about that nominal one.
RecordedConstants AboutNominal(
    const std::map<std::string, Eigen::Quaterniond>& nominal,
    RecordedConstants recorded);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_RECORDED_CONSTANTS_H_
