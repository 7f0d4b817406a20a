#ifndef HINDSIGHT_ALIGNMENT_MEASURED_HEADING_H_
#define HINDSIGHT_ALIGNMENT_MEASURED_HEADING_H_

#include "alignment/alignment.h"

namespace hindsight {

/// Method `heading`: LevelAttitude, and as heading the circular mean of
///   z_i - azimuth(C_level dR_i b)
/// over the readings z_i of a sensor of kind `heading` inside the rest, or else
/// inside the second that begins with the first of them; b is the baseline in
/// body axes, and dR_i turns the body axes of the reading into those of the
/// epoch by the gyros. Sigma: 1 deg for the baseline's direction in the body;
/// one reading's, since all are used again, or their scatter if that is larger;
/// the tilt times the tangent of the baseline's elevation; and what the gyros
/// drift from the epoch to the first reading. Gives no answer where the baseline
/// stands within 6 deg of the vertical.
AlignmentOutcome AlignByHeading(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_MEASURED_HEADING_H_
