#include "filters/vertical.h"

namespace hindsight {

bool MasksVertical(const ErrorLayout& layout) {
  const Block* position = layout.Find(BlockKind::kPosition);
  return position != nullptr && !position->active[2];
}

void VerticalChannel::Overwrite(const Timeline& timeline, std::size_t k,
                                const ErrorLayout& layout, State* x) {
  LinearizedMeasurement linearized;
  for (const Measurement& z : timeline.measurements(k)) {
    if (z.withheld || !std::holds_alternative<HeightFix>(z.model)) continue;
    Evaluate(z, timeline.Context(k, z, layout, *x), &linearized);
    const Geodetic g = GeodeticFromEcef(x->p_e);
    const Eigen::Vector3d up_e = -NedAxes(g.latitude, g.longitude).col(2);
    const double height = g.height + linearized.residual(0);
    x->p_e += linearized.residual(0) * up_e;
    const double rate = last_ && x->t > last_->t
                            ? (height - last_->value) / (x->t - last_->t)
                            : 0.0;
    x->v_e += (rate - up_e.dot(x->v_e)) * up_e;
    last_ = Height{x->t, height};
    return;
  }
}

}  // namespace hindsight
