#ifndef HINDSIGHT_RECEIVER_ERRORS_SEARCH_TAPES_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEARCH_TAPES_H_

#include <optional>

#include "receiver_errors/normal_points.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {

/// The tapes on which a sensor is searched, prepared when they are asked for.
class SearchTapes {
 public:
  /// Normal points are `interval` apart [s]; the tape must outlive this.
  SearchTapes(const LinearTape& tape, int sensor, double interval)
      : tape_(tape),
        sensor_(sensor),
        points_(FormNormalPoints(tape, sensor, interval)),
        thinned_(ThinBetweenFixes(tape, sensor)) {}
  SearchTapes(const SearchTapes&) = delete;
  SearchTapes& operator=(const SearchTapes&) = delete;

  const std::optional<NormalPoints>& points() const { return points_; }
  /// Of normal points, or of fixes where these are not close.
  const SensorTape& Searched() {
    return points_ ? Made(points_->tape, &of_points_) : OfFixes();
  }
  /// Of all fixes, with fewer nodes between them where there are many.
  const SensorTape& OfFixes() {
    return thinned_ ? Made(*thinned_, &of_fixes_) : Whole();
  }
  const SensorTape& Whole() { return Made(tape_, &whole_); }

 private:
  const SensorTape& Made(const LinearTape& tape,
                         std::optional<SensorTape>* made) {
    if (!*made) made->emplace(tape, sensor_);
    return **made;
  }

  const LinearTape& tape_;
  int sensor_;
  std::optional<NormalPoints> points_;
  std::optional<LinearTape> thinned_;
  std::optional<SensorTape> of_points_;
  std::optional<SensorTape> of_fixes_;
  std::optional<SensorTape> whole_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEARCH_TAPES_H_
