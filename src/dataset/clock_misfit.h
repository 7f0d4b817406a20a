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

/// (x_end - x_middle) / dt_2 - (x_middle - x_begin) / dt_1, over the time
/// between.
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

/// Accelerations less gravity in n, one a window, of positions in e or
/// velocities in n.
std::vector<Eigen::Vector3d> Accelerations(const ClockSeries& c,
                                           bool of_positions);
/// Vertical accelerations of heights, one a window.
std::vector<double> VerticalAccelerations(const ClockSeries& c);

/// Misfits as of ClockCandidate, the stamps moved by `offset`; kNoMisfit with
/// fewer than five independent windows inside the IMU's record. Of the
/// accelerations `a` against the specific force, turned to fit piece by piece:
double ForceMisfit(const ClockSeries& c, const std::vector<Eigen::Vector3d>& a,
                   bool of_positions, double offset);
/// Of velocities in the body, what is constant over a piece being gravity.
double BodyVelocityMisfit(const ClockSeries& c, double offset);
/// Of fields in the body. With R the turn from begin to end,
/// R m_end - m_begin = (R - 1) h, h the hard iron.
double FieldMisfit(const ClockSeries& c, double offset);
/// Of vertical accelerations. The vertical u of each piece by least squares:
/// acceleration + g = u . b.
double HeightMisfit(const ClockSeries& c, const std::vector<double>& up,
                    double offset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_MISFIT_H_
