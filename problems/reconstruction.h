#ifndef HINDSIGHT_PROBLEMS_RECONSTRUCTION_H_
#define HINDSIGHT_PROBLEMS_RECONSTRUCTION_H_

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "alignment/start.h"
#include "dataset/dataset.h"
#include "evaluation/innovation_test.h"
#include "filters/forward_filter.h"
#include "state/solution.h"

namespace hindsight {

struct ReconstructionOptions {
  std::string method = "batch";
  /// What Run will be asked for, as far as that is known: what one of them finds by
  /// itself is found beside the others.
  std::vector<std::string> methods = {};
  /// By methods for attitude alone, which need no position.
  bool attitude_alone = false;
  /// The interval to reconstruct [s]; defaults to all that the IMU covers.
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  /// Rests of the data set, for whoever asks for them besides; null: nobody does.
  std::shared_ptr<const RestMemo> rests = nullptr;
  /// Nodes are also placed at these times [s], so that their states have
  /// exact covariances (--at).
  std::vector<double> node_times;
  /// What forward filters, and the smoothers on the tape of the Kalman filter,
  /// call the error; the batch and the iterated smoother do not depend on it
  /// but through their start, multiple-model methods not at all.
  ErrorDefinition error = ErrorDefinition::kNavigation;
  /// Riccati equations of the two observers. Their tapes are not smoothed: P is
  /// no covariance there.
  CovarianceOptions h_infinity;
  CovarianceOptions modified_h_infinity;
  int max_iterations = 50;  ///< of the iterated smoother and the batch
  /// Longest time that a method may search, by the wall clock; it then ends with
  /// the best so far, which is doubtful [s].
  double max_time = std::numeric_limits<double>::infinity();
  /// Called with a stage in words and its fraction done, in [0, 1].
  std::function<void(const std::string& stage, double fraction)> progress;
  /// Polled; when it becomes true Interrupted is thrown.
  const std::atomic<bool>* stop = nullptr;
};

/// The options of methods of attitude alone.
inline ReconstructionOptions AttitudeAlone() {
  ReconstructionOptions options;
  options.attitude_alone = true;
  return options;
}

class Estimation;

/// One data set, reconstructed by any number of methods that share the start,
/// the nodes and one preintegration, or of attitude alone the samples.
class Reconstruction {
 public:
  /// Aligns, places the nodes, preintegrates. Throws EstimationError if there
  /// is nothing to work with, InputError if the data contradict themselves.
  /// `dataset` must outlive the object.
  Reconstruction(const Dataset& dataset, const ReconstructionOptions& options);
  ~Reconstruction();

  /// By a method of Methods() of the kind that the options say; throws
  /// InputError for another name.
  Solution Run(const std::string& method);

  /// How the start was found; nullptr of attitude alone.
  const StartReport* start() const;

  /// Navigation states that the data do not determine, over which time spans:
  /// known from the covariances of the forward filter and RTS pass, before
  /// anything is solved.
  std::vector<UnobservedSpan> Unobserved();

  /// Of the sensors, as the whole interval has them; none where it could not be
  /// linearised about its own solution, and of attitude alone.
  std::vector<NormalisedInnovation> Innovations();

  /// A solution of Run at other times, in order: see SampleSolution, or of
  /// attitude alone SampleAttitude.
  Solution Sample(const Solution& solution,
                  const std::vector<double>& times) const;

 private:
  bool attitude_alone_;
  std::unique_ptr<Estimation> estimation_;
};

/// The one-call form of the above.
Solution Solve(const Dataset& dataset, const ReconstructionOptions& options);

/// The trajectory of another point of the vehicle, l_b [m] from the IMU in body
/// axes: positions, velocities and covariances are moved. The body rate needed
/// for the velocity is the mean of `imu` over 20 ms.
Solution MoveToPoint(const Solution& solution, const ImuStream& imu,
                     const Eigen::Vector3d& l_b);

/// With Dataset::mounting_sigma in the covariance of the attitude:
///   P_psi + C_nb diag(sigma^2) C_nb',
/// as the axes that are spoken of are turned against the IMU's by a constant that
/// is known so well. Positions and velocities of the IMU do not depend on it. A
/// masked attitude stays as it is.
Solution WithMountingSigma(Solution solution, const Eigen::Vector3d& sigma_b);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_RECONSTRUCTION_H_
