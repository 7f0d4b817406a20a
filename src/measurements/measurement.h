#ifndef HINDSIGHT_MEASUREMENTS_MEASUREMENT_H_
#define HINDSIGHT_MEASUREMENTS_MEASUREMENT_H_

#include <string>
#include <tuple>
#include <variant>

#include "base/packed_series.h"
#include "measurements/acoustic_fix.h"
#include "measurements/dvl.h"
#include "measurements/generic_reading.h"
#include "measurements/height_fix.h"
#include "measurements/magnetic_field.h"
#include "measurements/model.h"
#include "measurements/odometer.h"
#include "measurements/position_fix.h"
#include "measurements/speed_course.h"
#include "measurements/stationary.h"
#include "measurements/tilt.h"
#include "measurements/vehicle_level.h"
#include "measurements/velocity_fix.h"

namespace hindsight {

/// Every measurement model. Filters evaluate it through Evaluate below, the
/// batch through one factor that wraps the same call.
using MeasurementModel =
    std::variant<PositionFix, VelocityFix, HeightFix, ZeroVelocity,
                 ZeroAngularRate, Odometer, SpeedCourse, MagneticField,
                 VehicleLevel, Dvl, AcousticFix, GenericReading, Tilt>;

struct Measurement {
  double t = 0.0;  ///< stamp [s]; the sensor's time offset is not yet applied
  int sensor = 0;  ///< index into Dataset::streams
  bool withheld = false;  ///< predicted and reported, never used
  MeasurementModel model;

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.t, z.sensor, z.withheld, z.model);
  }
};

/// The measurements of one sensor.
using MeasurementSeries = PackedSeries<Measurement>;

/// Rows of the measurement.
int Rows(const Measurement& z);

/// Which component a row is of those that measurements of the sensor have when
/// they have all: others than the row where components before it are missing.
int ComponentOf(const Measurement& z, int row);

/// Multiplies the measurement's standard deviations.
void ScaleSigma(double factor, Measurement* z);

/// Residual (measured - predicted), H = d predicted / d error over the layout,
/// and R. An estimated time offset tau enters linearly about the node: with
/// dt = stamp + tau - state time and the rate s of context.offset_rate,
///   residual = measured - predicted(state) - s dt,   H_tau = s;
/// s is held fixed, so that no product of dt and a state stands in any cost.
/// While no rate is known an offset is not estimated: it is white noise of its
/// a priori sigma, R + s s' sigma^2 with s of the state, H_tau = 0.
void Evaluate(const Measurement& z, const ModelContext& context,
              LinearizedMeasurement* out);

/// d predicted / d(time offset) at a state that stands at the measurement's
/// time: how fast the prediction changes along the motion. Zero if the layout
/// does not estimate the offset.
RowVector TimeOffsetRate(const Measurement& z, const ModelContext& context);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_MEASUREMENT_H_
