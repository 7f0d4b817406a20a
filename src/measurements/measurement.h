#ifndef HINDSIGHT_MEASUREMENTS_MEASUREMENT_H_
#define HINDSIGHT_MEASUREMENTS_MEASUREMENT_H_

#include <string>
#include <variant>

#include "measurements/acoustic_fix.h"
#include "measurements/dvl.h"
#include "measurements/height_fix.h"
#include "measurements/magnetic_field.h"
#include "measurements/model.h"
#include "measurements/odometer.h"
#include "measurements/position_fix.h"
#include "measurements/speed_course.h"
#include "measurements/stationary.h"
#include "measurements/vehicle_level.h"
#include "measurements/velocity_fix.h"

namespace hindsight {

/// Every measurement model. Filters evaluate it through Evaluate below, the
/// batch through one factor that wraps the same call.
using MeasurementModel =
    std::variant<PositionFix, VelocityFix, HeightFix, ZeroVelocity,
                 ZeroAngularRate, Odometer, SpeedCourse, MagneticField,
                 VehicleLevel, Dvl, AcousticFix>;

struct Measurement {
  double t = 0.0;  ///< stamp [s]; the sensor's time offset is not yet applied
  int sensor = 0;  ///< index into Dataset::streams
  bool withheld = false;  ///< predicted and reported, never used
  MeasurementModel model;
};

/// Rows of the measurement.
int Rows(const Measurement& z);

/// Multiplies the measurement's standard deviations.
void ScaleSigma(double factor, Measurement* z);

/// Residual (measured - predicted), H = d predicted / d error over the layout,
/// and R.
void Evaluate(const Measurement& z, const ModelContext& context,
              LinearizedMeasurement* out);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_MEASUREMENT_H_
