#include "state/error_layout.h"

#include <cmath>
#include <stdexcept>

namespace hindsight {
namespace {

constexpr BlockKind kCanonicalHead[] = {
    BlockKind::kPosition, BlockKind::kVelocity, BlockKind::kAttitude,
    BlockKind::kGyroBias, BlockKind::kAccelBias};

bool IsResolvedInNed(BlockKind kind) {
  return kind <= BlockKind::kAttitude || kind == BlockKind::kColouredNoise ||
         kind == BlockKind::kCurrent || kind == BlockKind::kDisturbance ||
         kind == BlockKind::kSensorError || kind == BlockKind::kErrorRate ||
         kind == BlockKind::kGroundBias;
}

double One(const Evolution&, double, double) { return 1.0; }
double Zero(const Evolution&, double, double) { return 0.0; }

/// The time update of the navigation state does not ask it.
constexpr Process kNavigationProcess = {One, Zero};

constexpr Process kRandomWalkProcess = {
    One, [](const Evolution& e, double dt, double) {
      return e.density * e.density * dt;
    }};

constexpr Process kGaussMarkovProcess = {
    [](const Evolution& e, double dt, double) { return std::exp(-dt / e.tau); },
    [](const Evolution& e, double dt, double) {
      return -0.5 * e.density * e.density * e.tau *
             std::expm1(-2.0 * dt / e.tau);
    },
    [](const Evolution& e) { return 0.5 * e.density * e.density * e.tau; }};

constexpr Process kSpatialGaussMarkovProcess = {
    [](const Evolution& e, double, double distance) {
      return std::exp(-distance / e.length);
    },
    [](const Evolution& e, double, double distance) {
      return -e.density * e.density * std::expm1(-2.0 * distance / e.length);
    },
    [](const Evolution& e) { return e.density * e.density; }};

}  // namespace

constinit const Process kConstantProcess = {One, Zero};

bool IsNavigation(BlockKind kind) { return kind <= BlockKind::kAccelBias; }

int FullDimension(BlockKind kind) {
  switch (kind) {
    case BlockKind::kScale:
    case BlockKind::kTimeOffset:
    case BlockKind::kOffset:
    case BlockKind::kDeclination:
    case BlockKind::kDistance:
      return 1;
    default:
      return 3;
  }
}

Evolution Evolution::Navigation() { return {&kNavigationProcess}; }

Evolution Evolution::RandomWalk(double density) {
  if (density == 0.0) return Constant();
  return {&kRandomWalkProcess, density};
}

Evolution Evolution::RandomWalk(double density, double tau) {
  Evolution evolution = RandomWalk(density);
  if (evolution.is_constant() || std::isinf(tau)) return evolution;
  return {&kGaussMarkovProcess, density, tau};
}

Evolution Evolution::GaussMarkov(double sigma, double tau) {
  return {&kGaussMarkovProcess, sigma * std::sqrt(2.0 / tau), tau};
}

Evolution Evolution::SpatialGaussMarkov(double sigma, double length) {
  Evolution evolution{&kSpatialGaussMarkovProcess, sigma};
  evolution.length = length;
  return evolution;
}

double Evolution::Phi(double dt, double distance) const {
  return process->Phi(*this, dt, distance);
}

double Evolution::Q(double dt, double distance) const {
  return process->Q(*this, dt, distance);
}

double Evolution::StationaryVariance() const {
  return process->stationary_variance == nullptr
             ? 0.0
             : process->stationary_variance(*this);
}

double Evolution::ChangeVariance(double dt, double distance) const {
  // Q = (1 - Phi^2) of the stationary variance, without its cancellation.
  const double Q = this->Q(dt, distance);
  return process->stationary_variance == nullptr
             ? Q
             : 2.0 * Q / (1.0 + Phi(dt, distance));
}

void ErrorLayout::Add(Block block) {
  if (Find(block.key.kind, block.key.sensor) != nullptr) {
    throw std::logic_error("error layout has block '" + block.name +
                           "' already");
  }
  const int full = FullDimension(block.key.kind);
  block.offset = dim_;
  block.dim = 0;
  for (int axis = 0; axis < full; ++axis) {
    if (block.active[static_cast<std::size_t>(axis)]) ++block.dim;
  }
  const bool navigation = IsNavigation(block.key.kind);
  block.parameter_offset = navigation ? -1 : parameter_count_;
  const int parameter_count = parameter_count_ + (navigation ? 0 : full);
  if (dim_ + block.dim > kMaxErrorDim || parameter_count > kMaxParameters) {
    throw std::logic_error("error layout exceeds its capacity at block '" +
                           block.name + "'");
  }
  dim_ += block.dim;
  parameter_count_ = parameter_count;
  blocks_.push_back(std::move(block));
  canonical_head_ = blocks_.size() >= 5;
  for (std::size_t i = 0; i < 5 && canonical_head_; ++i) {
    canonical_head_ =
        blocks_[i].key.kind == kCanonicalHead[i] && blocks_[i].dim == 3;
  }
}

const Block* ErrorLayout::Find(BlockKind kind, int sensor) const {
  for (const Block& block : blocks_) {
    if (block.key.kind == kind && block.key.sensor == sensor) return &block;
  }
  return nullptr;
}

ErrorMatrix ErrorLayout::InitialCovariance() const {
  ErrorMatrix P = ErrorMatrix::Zero(dim_, dim_);
  for (const Block& block : blocks_) {
    int component = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      P(component, component) = block.sigma0(axis) * block.sigma0(axis);
      ++component;
    }
  }
  return P;
}

std::string ErrorLayout::ComponentName(int component) const {
  for (const Block& block : blocks_) {
    if (component < block.offset || component >= block.offset + block.dim) {
      continue;
    }
    const int full = FullDimension(block.key.kind);
    if (full == 1) return block.name;
    int remaining = component - block.offset;
    int axis = 0;
    for (; axis < full; ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      if (remaining-- == 0) break;
    }
    static const char* const kNed[] = {"north", "east", "down"};
    static const char* const kXyz[] = {"x", "y", "z"};
    return block.name + "[" +
           (IsResolvedInNed(block.key.kind) ? kNed : kXyz)[axis] + "]";
  }
  throw std::out_of_range("no error component " + std::to_string(component));
}

ErrorLayout NavigationLayout(const NavigationPrior& prior) {
  ErrorLayout layout;
  const auto add = [&layout](BlockKind kind, const char* name, const char* unit,
                             const Evolution& evolution,
                             const Eigen::Vector3d& sigma0,
                             std::string_view advice = {}) {
    Block block;
    block.key.kind = kind;
    block.name = name;
    block.unit = unit;
    block.evolution = evolution;
    block.sigma0 = sigma0;
    block.advice = advice;
    layout.Add(block);
  };
  add(BlockKind::kPosition, "position", "m", Evolution::Navigation(),
      prior.position_sigma);
  add(BlockKind::kVelocity, "velocity", "m/s", Evolution::Navigation(),
      prior.velocity_sigma);
  add(BlockKind::kAttitude, "attitude", "rad", Evolution::Navigation(),
      prior.attitude_sigma);
  add(BlockKind::kGyroBias, "gyro_bias", "rad/s", prior.gyro_bias,
      prior.gyro_bias_sigma,
      "rest, or position or velocity aiding over a longer time");
  add(BlockKind::kAccelBias, "accel_bias", "m/s^2", prior.accel_bias,
      prior.accel_bias_sigma,
      "rest in several attitudes, or turns and accelerations");
  return layout;
}

}  // namespace hindsight
