#ifndef HINDSIGHT_FILTERS_LINEAR_TAPE_H_
#define HINDSIGHT_FILTERS_LINEAR_TAPE_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "base/scratch_memory.h"
#include "filters/covariance_policy.h"
#include "filters/kalman.h"
#include "imu/imu_link.h"
#include "state/error_definition.h"

namespace hindsight {

class SparseCongruence;

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
  /// The gain with which a filter took it; empty of one that was not accepted.
  Eigen::Map<const Eigen::MatrixXd> K{nullptr, 0, 0};
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
};

/// A symmetric matrix of n rows, of which the lower triangle is there, column by column.
struct PackedSymmetric {
  /// Elements (j, j) to (n - 1, j).
  const double* Column(Eigen::Index j) const {
    return data + j * n - j * (j - 1) / 2;
  }

  const double* data = nullptr;
  Eigen::Index n = 0;
};

/// A linear-Gaussian system about a recorded nominal trajectory:
///   d-(k+1)  = Phi d+(k) + c + w,  w ~ (0, Q),
///   residual = H d + v,            v ~ (0, R).
/// d+(k) is an error about x_plus(k), d-(k+1) one about x_minus(k+1); the
/// transport T(k) leads from the tangent at x_minus(k) to that at x_plus(k).
/// Forward filters write it; RTS, two-filter and IMM smoothing read it and know
/// no sensor. An epoch takes what its layout has and is not zero, in chunks of
/// ScratchMemory that are released as the tape is shortened.
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
  TapeEpoch epoch(std::size_t k) const;
  TapeEpoch back() const { return epoch(size() - 1); }
  double t(std::size_t k) const { return epochs_[k].t; }
  /// Defect of the interval that ends at epoch k.
  ErrorVector c(std::size_t k) const;

  std::span<const TapeMeasurement> measurements(std::size_t k) const {
    Held(k);
    return headers(k);
  }
  /// The same, of which no matrix may be read.
  std::span<const TapeMeasurement> headers(std::size_t k) const {
    const std::size_t first = epochs_[k].first_measurement;
    const std::size_t end =
        k + 1 < size() ? epochs_[k + 1].first_measurement : measurements_end_;
    return std::span<const TapeMeasurement>(measurements_)
        .subspan(first, end - first);
  }
  /// Memory of the epochs and of what was recorded of measurements [bytes].
  std::size_t bytes() const;

  /// Records a measurement of the epoch that the next Append completes; its
  /// matrices are copied. `header` has the fields that are no matrices; K is
  /// empty where it was not accepted.
  void Record(const TapeMeasurement& header, const LinearizedMeasurement& z,
              const Innovation& innovation, const GainMatrix& K = {});

  /// Appends an epoch; `transition` is of the interval before it (ignored for
  /// the first). P_minus about x_minus, P_plus about x_plus.
  void Append(const TapeEpoch& epoch, const Transition& transition,
              const ErrorMatrix& P_minus, const ErrorMatrix& P_plus);

  /// Transition and noise of the interval that ends at epoch k >= 1.
  ErrorMatrix Phi(std::size_t k) const;
  SparseCongruence OverInterval(std::size_t k) const;  ///< with Phi
  ErrorMatrix Q(std::size_t k) const;
  PackedSymmetric PackedQ(std::size_t k) const;
  ErrorMatrix P_minus(std::size_t k) const;
  ErrorMatrix P_plus(std::size_t k) const;

  /// T(k) of an epoch, from the tangent at x_minus to that at x_plus; identity but
  /// for epochs that moved their nominal.
  ErrorMatrix ResetTransport(const TapeEpoch& epoch) const;
  /// The state that the error d about x_plus of an epoch leads to.
  State StateAt(const TapeEpoch& epoch, const ErrorVector& d) const;
  /// Whether any update moved the nominal.
  bool moves_nominal() const { return moves_nominal_; }

  /// Drops the last epoch and the memory it alone used.
  void PopBack();
  void Reserve(std::size_t count) { epochs_.reserve(count); }

 private:
  /// An epoch in the pool: P_minus, P_plus and, but for the first, Q, packed as
  /// lower triangles; then x_minus, those of x_plus, c, dx_minus and dx_plus that
  /// are neither x_minus nor zero, and, but for the first epoch, Phi.
  struct PackedEpoch {
    double t = 0.0;
    const double* data = nullptr;
    std::size_t first_measurement = 0;
    /// Rows of Phi that are more than their diagonal, a bit each.
    std::uint64_t full_rows = 0;
    std::uint32_t phi = 0;    ///< where Phi lies behind data
    std::uint32_t chunk = 0;  ///< of data
    bool reset = false;
    bool has_x_plus = false;
    bool has_c = false;
    bool has_dx_minus = false;
    bool has_dx_plus = false;
  };
  static_assert(kMaxErrorDim <= 64);
  struct Chunk {
    ScratchMemory memory;
    std::size_t size = 0;  ///< [doubles]
    std::size_t used = 0;
  };
  /// A place in the pool.
  struct Mark {
    std::size_t chunk = 0;
    std::size_t used = 0;
  };
  /// Within one block of the last chunk's memory.
  double* Allocate(std::size_t count);
  /// The epoch, before its memory is read.
  const PackedEpoch& Held(std::size_t k) const;
  std::size_t TriangleSize() const;
  std::size_t StateSize() const;
  double* Pack(const ErrorMatrix& P, double* to) const;
  double* Pack(const State& x, double* to) const;
  ErrorMatrix Unpack(const double* packed) const;
  const double* Unpack(const double* packed, State* x) const;
  const double* Unpack(const double* packed, bool present,
                       ErrorVector* v) const;

  ErrorLayout layout_;
  ErrorDefinition error_;
  bool smoothable_ = true;
  bool moves_nominal_ = false;
  BoundRecord bound_;
  std::vector<PackedEpoch> epochs_;
  std::vector<TapeMeasurement> measurements_;
  std::size_t measurements_end_ = 0;  ///< of the last epoch
  std::vector<Chunk> chunks_;
  std::vector<Mark> begins_;  ///< of the epochs in the pool
  Mark end_;                  ///< of the last epoch
};

/// Throws std::logic_error for a tape that is not smoothable.
void RequireSmoothable(const LinearTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_LINEAR_TAPE_H_
