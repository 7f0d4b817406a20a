#ifndef HINDSIGHT_STATE_ERROR_LAYOUT_H_
#define HINDSIGHT_STATE_ERROR_LAYOUT_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace hindsight {

/// Largest dimension of an error state. Matrices over a layout have this
/// capacity inside the object, so that no product of a filter step allocates.
inline constexpr int kMaxErrorDim = 48;
/// Largest number of values beyond the five navigation blocks.
inline constexpr int kMaxParameters = 33;
/// Most rows of one measurement.
inline constexpr int kMaxRows = 6;

using ErrorVector =
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxErrorDim, 1>;
using ErrorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                  kMaxErrorDim, kMaxErrorDim>;
/// Values of the blocks beyond the navigation state, of which most layouts have few
/// or none: a state is kept for every node, and takes what its layout has.
using ParameterVector = Eigen::VectorXd;
using RowVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                kMaxRows, kMaxRows>;
using RowJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                  kMaxRows, kMaxErrorDim>;

/// What a block of the error state is. The first five are the navigation
/// state; the others belong to one sensor each (`BlockKey::sensor`) unless
/// said otherwise, are additive, and live in State::parameters.
enum class BlockKind {
  kPosition,       ///< dr, NED [m]
  kVelocity,       ///< dv, NED [m/s]
  kAttitude,       ///< psi, NED [rad]
  kGyroBias,       ///< [rad/s], body axes
  kAccelBias,      ///< [m/s^2], body axes
  kGyroScale,      ///< [1], per body axis: measured = (1 + s) true; IMU
  kAccelScale,     ///< [1], per body axis; IMU
  kScale,          ///< [1]: measured = (1 + k) true; odometer, DVL, airspeed
  kMounting,       ///< rotation vector [rad] of C_ob = Exp(m) C_ob(nominal),
                   ///< sensor axes from body axes
  kLeverArm,       ///< body axes, from the IMU to the sensor [m]
  kTimeOffset,     ///< [s]: true time = stamp + offset
  kColouredNoise,  ///< additive error of the measurement, NED [m or m/s]
  kOffset,         ///< scalar additive error (height, depth, barometer) [m]
  kCurrent,        ///< water current or wind, NED [m/s]
  kHardIron,       ///< additive field in body axes [uT]
  kDeclination,    ///< of the magnetic field from true north [rad]
  kDisturbance,    ///< additive magnetic field, NED [uT]
  kDistance,       ///< travelled since the last count of an odometer [m]
  kSensorError,    ///< error of a measurement beyond its noise, along its rows,
                   ///< NED where these are
  kErrorRate,      ///< at which kSensorError drifts
  kBias,           ///< lasting error of a velocity, sensor axes [m/s]
  kGroundBias,     ///< lasting error of a velocity over the ground, NED [m/s]
};

/// Number of components of a block before any axis is masked.
int FullDimension(BlockKind kind);
/// Position, velocity, attitude or a bias of the IMU: what integrating the IMU adds its
/// noise to.
bool IsNavigation(BlockKind kind);

/// Identifies a block: `sensor` is the index of the sensor in the rig, and is
/// kNoSensor for blocks of the navigation state and the IMU.
struct BlockKey {
  static constexpr int kNoSensor = -1;
  BlockKind kind = BlockKind::kPosition;
  int sensor = kNoSensor;
  bool operator==(const BlockKey&) const = default;
};

struct Process;
extern const Process kConstantProcess;

/// How a block changes with time, db = -b/tau dt + density dw, or with the
/// distance travelled, correlated as exp(-distance/length), or as another
/// process says.
struct Evolution {
  const Process* process = &kConstantProcess;
  double density = 0.0;  ///< [unit/sqrt(s)]; for Gauss-Markov sqrt(2/tau) sigma
  double tau = std::numeric_limits<double>::infinity();     ///< [s]
  double length = std::numeric_limits<double>::infinity();  ///< [m]

  /// Of the navigation state, whose time update knows it.
  static Evolution Navigation();
  static Evolution Constant() { return {}; }
  static Evolution RandomWalk(double density);
  /// A walk that falls back with the correlation time `tau`; a plain one if
  /// that is infinite.
  static Evolution RandomWalk(double density, double tau);
  /// Stationary standard deviation `sigma` and correlation time `tau`.
  static Evolution GaussMarkov(double sigma, double tau);
  /// Stationary standard deviation `sigma`, which is then the `density`, and
  /// correlation length [m].
  static Evolution SpatialGaussMarkov(double sigma, double length);

  /// exp(-dt/tau), or exp(-distance/length); only a spatial one looks at the
  /// distance travelled in dt [m].
  double Phi(double dt, double distance = 0.0) const;
  /// Variance added over dt and distance.
  double Q(double dt, double distance = 0.0) const;
  /// Whether the block has one value for the whole interval.
  bool is_constant() const { return process == &kConstantProcess; }
  /// Variance at any time before anything is measured, of a block that forgets
  /// what it was; 0: it does not forget.
  double StationaryVariance() const;
  /// Variance of the change over dt and distance, of a block that forgets:
  /// 2 (1 - Phi) StationaryVariance; of others Q.
  double ChangeVariance(double dt, double distance = 0.0) const;
};

/// A Markov process: two steps must be one, Phi(a + b) = Phi(a) Phi(b) and
/// Q(a + b) = Phi(b)^2 Q(a) + Q(b). A program may bring its own.
struct Process {
  double (*Phi)(const Evolution&, double dt, double distance);
  double (*Q)(const Evolution&, double dt, double distance);
  /// nullptr: the process does not forget.
  double (*stationary_variance)(const Evolution&) = nullptr;
};

/// One block of the error state.
struct Block {
  BlockKey key;
  std::string name;  ///< "position", "odometer_scale", ... as printed
  std::string unit;  ///< SI unit of a component, "1" for a ratio
  Evolution evolution;
  Eigen::Vector3d sigma0 = Eigen::Vector3d::Zero();  ///< a priori, per axis
  /// The motion that makes a weak constant visible, for people; may be empty.
  std::string_view advice = {};
  /// Axes that are estimated; a masked axis has no error component.
  std::array<bool, 3> active = {true, true, true};
  int offset = 0;            ///< first component in the error vector
  int dim = 0;               ///< active components
  int parameter_offset = 0;  ///< first value in State::parameters (full block)
};

/// Which blocks are estimated and in which order. Offsets are filled in by
/// Add. A value, cheap to read, built once per problem.
class ErrorLayout {
 public:
  /// Appends a block. Throws std::logic_error if the key is there already or
  /// the capacity is exceeded.
  void Add(Block block);

  int dim() const { return dim_; }
  int parameter_count() const { return parameter_count_; }
  const std::vector<Block>& blocks() const { return blocks_; }

  /// The block, or nullptr if the layout does not have it.
  const Block* Find(BlockKind kind, int sensor = BlockKey::kNoSensor) const;
  bool Has(BlockKind kind, int sensor = BlockKey::kNoSensor) const {
    return Find(kind, sensor) != nullptr;
  }

  /// True if position, velocity, attitude, gyro and accelerometer bias stand
  /// first, complete, in this order: offsets 0, 3, 6, 9, 12.
  bool has_canonical_head() const { return canonical_head_; }

  /// Adds the active columns of `block_jacobian` (rows x FullDimension) to the
  /// columns of the block in H; does nothing if the block is not estimated.
  template <typename Derived, typename BlockDerived>
  void AddColumns(BlockKind kind, int sensor,
                  const Eigen::MatrixBase<BlockDerived>& block_jacobian,
                  Eigen::MatrixBase<Derived>* H) const {
    const Block* block = Find(kind, sensor);
    if (block == nullptr) return;
    int column = block->offset;
    for (int axis = 0; axis < block_jacobian.cols(); ++axis) {
      if (!block->active[static_cast<std::size_t>(axis)]) continue;
      H->col(column++) += block_jacobian.col(axis);
    }
  }

  /// Diagonal a priori covariance from the blocks' sigma0.
  ErrorMatrix InitialCovariance() const;

  /// "position[north]", "odometer_scale", ... of an error component.
  std::string ComponentName(int component) const;

 private:
  std::vector<Block> blocks_;
  int dim_ = 0;
  int parameter_count_ = 0;
  bool canonical_head_ = false;
};

/// The five navigation blocks with the given initial standard deviations and
/// bias evolutions, in canonical order.
struct NavigationPrior {
  Eigen::Vector3d position_sigma = Eigen::Vector3d::Zero();    ///< NED [m]
  Eigen::Vector3d velocity_sigma = Eigen::Vector3d::Zero();    ///< NED [m/s]
  Eigen::Vector3d attitude_sigma = Eigen::Vector3d::Zero();    ///< NED [rad]
  Eigen::Vector3d gyro_bias_sigma = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel_bias_sigma = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Evolution gyro_bias = Evolution::Constant();
  Evolution accel_bias = Evolution::Constant();
};
ErrorLayout NavigationLayout(const NavigationPrior& prior);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_ERROR_LAYOUT_H_
