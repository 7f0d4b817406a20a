#ifndef HINDSIGHT_FILTERS_LINEAR_TAPE_H_
#define HINDSIGHT_FILTERS_LINEAR_TAPE_H_

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "filters/covariance_policy.h"
#include "filters/kalman.h"
#include "imu/imu_link.h"
#include "state/error_definition.h"

namespace hindsight {

/// One measurement on the tape; matrices in the tape's pool.
struct TapeMeasurement {
  int index = 0;  ///< within the node's measurements
  int sensor = 0;
  bool accepted = true;
  bool withheld = false;
  double weight = 1.0;  ///< of a robust loss; R and S are those after it
  double nis = 0.0;
  double log_likelihood = 0.0;
  Eigen::Map<const Eigen::VectorXd> residual{nullptr, 0};  ///< at x_minus
  Eigen::Map<const Eigen::MatrixXd> H{nullptr, 0, 0};
  Eigen::Map<const Eigen::MatrixXd> R{nullptr, 0, 0};
  /// Innovation about (dx_minus updated by the measurements before it) and its
  /// covariance.
  Eigen::Map<const Eigen::VectorXd> innovation{nullptr, 0};
  Eigen::Map<const Eigen::MatrixXd> S{nullptr, 0, 0};
};

/// One epoch: the interval that ends at t and the update at t. Errors about
/// x_minus, in its tangent, unless said otherwise.
struct TapeEpoch {
  /// Whether the update moved the nominal.
  bool moves_nominal() const { return reset && !dx_plus.isZero(0.0); }

  double t = 0.0;
  State x_minus;  ///< nominal before the update
  State x_plus;   ///< nominal after it; equal to x_minus if it was not reset
  bool reset = false;
  ErrorVector c;         ///< defect of the interval
  ErrorVector dx_minus;  ///< mean before the update
  ErrorVector dx_plus;   ///< mean after the update; the reset moves it into
                         ///< x_plus, where the mean is then zero
  std::size_t first_measurement = 0;  ///< range, see LinearTape::measurements
  std::size_t measurement_count = 0;
};

/// A linear-Gaussian system about a recorded nominal trajectory:
///   d-(k+1)  = Phi d+(k) + c + w,  w ~ (0, Q),
///   residual = H d + v,            v ~ (0, R).
/// d+(k) is an error about x_plus(k), d-(k+1) one about x_minus(k+1); the
/// transport T(k) leads from the tangent at x_minus(k) to that at x_plus(k).
/// Forward filters write it; RTS, two-filter and IMM smoothing read it and know
/// no sensor. Its matrices lie in chunks that are released as it is shortened.
/// All are in canonical axes, whatever the definition of the error; that
/// decides where a reset leads and how it carries errors, ResetTransport.
class LinearTape {
 public:
  explicit LinearTape(ErrorLayout layout,
                      ErrorDefinition error = ErrorDefinition::kNavigation)
      : layout_(std::move(layout)), error_(error) {}

  const ErrorLayout& layout() const { return layout_; }
  ErrorDefinition error() const { return error_; }
  /// False if P- and P+ follow another rule than the covariances of this
  /// system: then there is nothing that smoothing it could mean.
  bool smoothable() const { return smoothable_; }
  void ForbidSmoothing() { smoothable_ = false; }
  /// How the weight of an H-infinity rule fared.
  const BoundRecord& bound() const { return bound_; }
  void SetBound(const BoundRecord& bound) { bound_ = bound; }
  int dim() const { return layout_.dim(); }
  std::size_t size() const { return epochs_.size(); }
  const TapeEpoch& epoch(std::size_t k) const { return epochs_[k]; }
  const TapeEpoch& back() const { return epochs_.back(); }

  std::span<const TapeMeasurement> measurements(std::size_t k) const {
    return std::span<const TapeMeasurement>(measurements_)
        .subspan(epochs_[k].first_measurement, epochs_[k].measurement_count);
  }

  /// Records a measurement of the epoch that the next Append completes; its
  /// matrices are copied. `header` has the fields that are no matrices.
  void Record(const TapeMeasurement& header, const LinearizedMeasurement& z,
              const Innovation& innovation);

  /// Appends an epoch; `transition` is of the interval before it (ignored for
  /// the first). P_minus about x_minus, P_plus about x_plus.
  void Append(TapeEpoch epoch, const Transition& transition,
              const ErrorMatrix& P_minus, const ErrorMatrix& P_plus);

  /// Transition and noise of the interval that ends at epoch k >= 1.
  Eigen::Map<const Eigen::MatrixXd> Phi(std::size_t k) const;
  ErrorMatrix Q(std::size_t k) const;
  ErrorMatrix P_minus(std::size_t k) const;
  ErrorMatrix P_plus(std::size_t k) const;

  /// T(k), from the tangent at x_minus to that at x_plus; identity but for
  /// epochs that moved their nominal.
  ErrorMatrix ResetTransport(std::size_t k) const;
  /// The state that the error d about x_plus of epoch k leads to.
  State StateAt(std::size_t k, const ErrorVector& d) const;

  /// Drops the last epoch and the memory it alone used.
  void PopBack();
  void Reserve(std::size_t count) { epochs_.reserve(count); }

 private:
  struct Matrices {
    double* Phi = nullptr;
    double* Q = nullptr;  ///< packed, as P_minus and P_plus
    double* P_minus = nullptr;
    double* P_plus = nullptr;
    std::size_t chunk = 0;  ///< where the epoch's memory begins
    std::size_t used = 0;
  };
  struct Chunk {
    std::unique_ptr<double[]> data;
    std::size_t used = 0;
  };
  double* Allocate(std::size_t count);
  double* Pack(const ErrorMatrix& P);
  ErrorMatrix Unpack(const double* packed) const;

  ErrorLayout layout_;
  ErrorDefinition error_;
  bool smoothable_ = true;
  BoundRecord bound_;
  std::vector<TapeEpoch> epochs_;
  std::vector<TapeMeasurement> measurements_;
  std::vector<Matrices> matrices_;
  std::vector<Chunk> chunks_;
  std::size_t mark_chunk_ = 0;  ///< pool position after the last epoch
  std::size_t mark_used_ = 0;
};

/// Throws std::logic_error for a tape that is not smoothable.
void RequireSmoothable(const LinearTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_LINEAR_TAPE_H_
