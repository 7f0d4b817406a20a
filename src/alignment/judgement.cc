#include "alignment/judgement.h"

#include <algorithm>
#include <cmath>

#include "alignment/velocity_alignment.h"
#include "alignment/window_smoother.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kShortestWindow = 10.0;  // [s]
constexpr double kLongestTrial = 160.0;

std::optional<WindowSolution> Explain(const AlignmentInput& input, double t_end,
                                      const AlignedAttitude& attitude,
                                      const AlignedAttitude& other) {
  const Eigen::Quaterniond C_en(NedAxes(input.p_e));
  WindowStart start;
  // An open heading begins where the rival has it.
  start.q_eb = C_en * (TellsHeading(attitude)
                           ? attitude.q_nb
                           : Exp(-Difference(other, attitude)) * other.q_nb);
  start.b_g = input.b_g;
  start.b_a = input.b_a;
  start.P = attitude.P;
  return WindowSmoother(input, t_end, AttitudePrior{start.q_eb, attitude.P})
      .Smooth(start, input.least_gyro_walk);
}

}  // namespace

std::optional<double> Judge(const AlignmentInput& input,
                            const AlignedAttitude& a,
                            const AlignedAttitude& b) {
  const double first = FirstMotion(input);
  std::optional<double> ratio;
  for (double window = kShortestWindow; window <= kLongestTrial;
       window *= 2.0) {
    const double t_end = std::min(first + window, input.to);
    if (!(t_end > first)) break;
    const auto by_a = Explain(input, t_end, a, b);
    const auto by_b = Explain(input, t_end, b, a);
    if (by_a && by_b) {
      const double nis = std::max(1.0, std::min(by_a->nis, by_b->nis));
      ratio = (by_a->log_likelihood - by_b->log_likelihood) / nis;
      if (std::abs(*ratio) > kDecided) break;
    }
    if (t_end >= input.to) break;
  }
  return ratio;
}

}  // namespace hindsight
