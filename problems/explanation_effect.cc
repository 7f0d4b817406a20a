#include "problems/explanation_effect.h"

#include <cmath>
#include <string>

namespace hindsight {
namespace {

void RaiseEffect(double effect, const std::string& component,
                 Explanation* out) {
  if (!(effect > out->effect)) return;
  out->effect = effect;
  out->component = component;
}

}  // namespace

void AddEffect(const Eigen::MatrixXd& correction, double size,
               const Relinearised& anew, const LinearTape& tape, EffectOn on,
               Explanation* out) {
  const ErrorLayout& layout = tape.layout();
  const ErrorMatrix P_end = tape.P_plus(tape.size() - 1);
  for (int c = 0; c < layout.dim(); ++c) {
    double effect = 0.0;
    if (layout.has_canonical_head() && c < anew.variances.front().size()) {
      for (Eigen::Index k = 0; k < correction.cols(); ++k) {
        const double variance = anew.variances[static_cast<std::size_t>(k)](c);
        if (variance > 0.0) {
          effect += correction(c, k) * correction(c, k) / variance;
        }
      }
      effect /= static_cast<double>(correction.cols());
    } else if (on == EffectOn::kAll && P_end(c, c) > 0.0) {
      const double last = correction(c, correction.cols() - 1);
      effect = last * last / P_end(c, c);
    }
    RaiseEffect(std::abs(size) * std::sqrt(effect), layout.ComponentName(c),
                out);
  }
}

void AddEffectOfClock(double size, const Relinearised& anew,
                      const ErrorLayout& layout, Explanation* out) {
  const std::size_t count = anew.states.size();
  if (!layout.has_canonical_head() || count < 2) return;
  NavigationVariances sum = NavigationVariances::Zero();
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const State& x = anew.states[k];
    const State& next = anew.states[k + 1];
    const double late = size * (x.t - anew.states.front().t) / (next.t - x.t);
    sum += (late * Local(layout, x, next).head<9>())
               .cwiseAbs2()
               .cwiseQuotient(anew.variances[k]);
  }
  for (int c = 0; c < sum.size(); ++c) {
    RaiseEffect(std::sqrt(sum(c) / static_cast<double>(count - 1)),
                layout.ComponentName(c), out);
  }
}

}  // namespace hindsight
