#ifndef HINDSIGHT_PROBLEMS_EXPLANATIONS_H_
#define HINDSIGHT_PROBLEMS_EXPLANATIONS_H_

#include <memory>
#include <span>
#include <vector>

#include "evaluation/explanation.h"
#include "filters/linear_tape.h"
#include "filters/mean_shift.h"
#include "problems/explanation_effect.h"
#include "problems/linearisation.h"
#include "timeline/problem.h"

namespace hindsight {

/// Deviations that explain the innovations of a tape better than chance, which
/// is `problem` linearised about `states`. Tried are, of every sensor,
///   throughout           what its kind may estimate and the problem does not:
///                        scale, mounting, lever arm, time offset, hard iron,
///                        declination; axes turned by an angle of what is
///                        measured in navigation axes;
///   throughout and from each of kOnsets times on, and growing from there on
///                        an additive error of a component, and of what the
///                        problem does not estimate scale, lever arm and clock;
/// of the IMU, throughout  what ImuDeviations lists, and its clock;
/// and from these times on another value of every component of the state, of the
/// position where more than one sensor tells places.
class ExplanationSearch {
 public:
  /// `false_alarms` is the probability that a right model has any (Bonferroni).
  /// The arguments must outlive the object, but `callback`, which hears of each
  /// epoch of each pass.
  ExplanationSearch(const Problem& problem, const std::vector<State>& states,
                    const LinearTape& tape, double false_alarms,
                    const EpochCallback& callback = nullptr);
  ~ExplanationSearch();
  ExplanationSearch(const ExplanationSearch&) = delete;
  ExplanationSearch& operator=(const ExplanationSearch&) = delete;

  bool found_any() const;
  /// One of each sensor, of the IMU and of the state (Explanation), with what
  /// allowing for it does to the solution, whose variances are `anew`'s.
  std::vector<Explanation> Tell(const Relinearised& anew,
                                EffectOn on = EffectOn::kAll) const;
  std::span<const StateScore> state_scores() const;

 private:
  struct Found;

  const Problem& problem_;
  const LinearTape& tape_;
  std::unique_ptr<Found> found_;
};

/// Equally far apart, the first being the beginning.
inline constexpr int kOnsets = 32;

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_EXPLANATIONS_H_
