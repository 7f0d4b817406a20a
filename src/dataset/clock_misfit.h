#ifndef HINDSIGHT_DATASET_CLOCK_MISFIT_H_
#define HINDSIGHT_DATASET_CLOCK_MISFIT_H_

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "dataset/clock_rows.h"
#include "dataset/clock_windows.h"
#include "dataset/held_motion.h"

namespace hindsight {

/// The misfit where too little overlaps.
inline constexpr double kNoMisfit = std::numeric_limits<double>::infinity();

/// What the misfit of a stream is made of: motion, rows and windows.
struct ClockSeries {
  HeldMotion motion;
  TimedRows rows;
  ClockWindows windows;
};

/// The second derivative of x from the three rows of a window, whose intervals
/// are dt_1 and dt_2:
///   ((x_end - x_middle) / dt_2 - (x_middle - x_begin) / dt_1)
///   / ((dt_1 + dt_2) / 2).
template <typename Get>
Eigen::Vector3d SecondDifference(const ClockWindows::Window& w,
                                 const std::vector<double>& t, const Get& get) {
  const double dt_1 = t[w.middle] - t[w.begin];
  const double dt_2 = t[w.end] - t[w.middle];
  const Eigen::Vector3d x = get(w.middle);
  const Eigen::Vector3d before = (x - get(w.begin)) / dt_1;
  const Eigen::Vector3d after = (get(w.end) - x) / dt_2;
  return (after - before) / (0.5 * (dt_1 + dt_2));
}

/// The accelerations less gravity, in axes n, that the rows of each window
/// show: rows are positions in e or velocities in n.
std::vector<Eigen::Vector3d> Accelerations(const ClockSeries& c,
                                           bool of_positions);
/// The vertical accelerations that the heights of each window show.
std::vector<double> VerticalAccelerations(const ClockSeries& c);

/// The misfit that ClockCandidate defines, with the stamps moved by `offset`;
/// kNoMisfit if fewer than five independent windows lie inside the IMU's
/// record. This one compares the accelerations `a` with the specific force; in
/// each piece the rotation between the axes of the two is the one that fits
/// best.
double ForceMisfit(const ClockSeries& c, const std::vector<Eigen::Vector3d>& a,
                   bool of_positions, double offset);
/// Compares changes of a velocity in the body with the integral of the specific
/// force. What is constant over a piece is taken for gravity.
double BodyVelocityMisfit(const ClockSeries& c, double offset);
/// Compares magnetic fields in the body with the turns of the gyros. With R the
/// turn from the begin to the end of a window, R m_end - m_begin = (R - 1) h,
/// where h is the hard iron.
double FieldMisfit(const ClockSeries& c, double offset);
/// Compares the vertical accelerations `up` with the specific force b. The
/// vertical u of each piece is found by least squares from up + g = u . b.
double HeightMisfit(const ClockSeries& c, const std::vector<double>& up,
                    double offset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_MISFIT_H_
