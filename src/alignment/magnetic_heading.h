#ifndef HINDSIGHT_ALIGNMENT_MAGNETIC_HEADING_H_
#define HINDSIGHT_ALIGNMENT_MAGNETIC_HEADING_H_

#include "alignment/alignment.h"

namespace hindsight {

/// What the stated a priori hard iron, disturbance and declination leave open
/// of a magnetic heading [rad]; all readings share it.
double SharedHeadingSigma(const MagneticSurroundings& magnetic);

/// Method `magnetometer`: LevelAttitude, and as heading
///   D - azimuth(C_level m),
/// D the declination, m the mean of the field in the body axes of the epoch,
/// hard iron removed, over the rest or else the first second; the gyros turn
/// each reading back to the epoch. Sigma: 2 deg for what surrounds the sensor;
/// one reading's noise, a priori hard iron and disturbance over the horizontal
/// field; the declination's; and the tilt times down / horizontal. Gives no
/// answer where FieldContradiction finds something.
AlignmentOutcome AlignByMagnetometer(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_MAGNETIC_HEADING_H_
