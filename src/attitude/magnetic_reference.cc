#include "attitude/magnetic_reference.h"

#include <algorithm>
#include <cmath>

namespace hindsight {

bool MagneticReference::Agrees(const Field& a, const Field& b) const {
  return std::abs(a.norm - b.norm) < options_.norm_limit * b.norm &&
         std::abs(a.dip - b.dip) < options_.dip_limit;
}

void MagneticReference::Adopt(double dt, double rate) {
  if (!Agrees(smoothed_, candidate_)) {
    candidate_ = smoothed_;
    candidate_for_ = 0.0;
    candidate_age_ = 0.0;
    return;
  }
  candidate_age_ += dt;
  candidate_.Follow(smoothed_,
                    dt / std::clamp(candidate_age_, dt, options_.memory));
  if (!is_known() || rate > options_.moving_rate) candidate_for_ += dt;
  const double needed =
      is_known() ? options_.adoption : options_.first_adoption;
  if (candidate_for_ >= needed) {
    reference_ = candidate_;
    ++adoptions_;
    agreed_for_ = options_.settle;
    candidate_for_ = 0.0;
  }
}

bool MagneticReference::Accept(double dt, double norm, double dip,
                               double rate) {
  if (!options_.enabled) return true;
  const Field reading{norm, dip};
  if (!started_) smoothed_ = candidate_ = reading;
  started_ = true;
  smoothed_.Follow(reading, std::min(dt / options_.smoothing, 1.0));
  if (!is_known()) {
    Adopt(dt, rate);
    return true;
  }
  if (Agrees(smoothed_, reference_)) {
    agreed_for_ += dt;
    if (agreed_for_ >= options_.settle) {
      reference_.Follow(smoothed_, dt / options_.memory);
      candidate_for_ = 0.0;
      candidate_ = smoothed_;
      return true;
    }
  } else {
    agreed_for_ = 0.0;
    Adopt(dt, rate);
  }
  return false;
}

}  // namespace hindsight
