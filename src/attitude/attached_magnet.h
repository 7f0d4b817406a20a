#ifndef HINDSIGHT_ATTITUDE_ATTACHED_MAGNET_H_
#define HINDSIGHT_ATTITUDE_ATTACHED_MAGNET_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "attitude/field_survey.h"

namespace hindsight {

/// A magnet that travels along for a part of the time.
struct AttachedMagnet {
  double begin = 0.0;  ///< of the first reading with it [s]
  double end = 0.0;    ///< of the last [s]
  Eigen::Vector3d field_b = Eigen::Vector3d::Zero();  ///< [uT]
};

/// The spans over which one hard iron h_b is there, in
///   m_b = C_bn m_n + (0 or h_b) + noise,
/// m_n the reference of `survey`, about which the attitudes' headings are
/// known. Of all sequences of the two states the likeliest (Viterbi), `sigma`
/// [uT] the noise of a reading per axis, one in a second being independent, an
/// outlier of more than four sigmas as likely in both, and a change as likely
/// as one in a recording. None if h_b is below kLeastHardIron, is there for
/// less than 5 s, or if a field that does not turn with the body explains these
/// readings as well.
std::vector<AttachedMagnet> FindAttachedMagnets(
    std::span<const SurveyedField> readings, const FieldSurvey& survey,
    double sigma);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTACHED_MAGNET_H_
