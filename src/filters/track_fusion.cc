#include "filters/track_fusion.h"

#include <Eigen/Cholesky>
#include <boost/math/tools/minima.hpp>
#include <stdexcept>
#include <utility>

namespace hindsight {
namespace {

ErrorMatrix Inverse(const ErrorMatrix& P) {
  return P.llt().solve(ErrorMatrix::Identity(P.rows(), P.cols()));
}

/// With the weights a and b of the two informations.
Track FuseWeighted(const Track& first, double a, const Track& second,
                   double b) {
  const ErrorMatrix Y_a = a * Inverse(first.P);
  const ErrorMatrix Y_b = b * Inverse(second.P);
  Track fused;
  fused.P = Inverse(Y_a + Y_b);
  Symmetrize(&fused.P);
  fused.x = fused.P * (Y_a * first.x + Y_b * second.x);
  return fused;
}

class CentralFusion : public SensorFusion {
 public:
  CentralFusion(std::array<LinearSensor, 2> sensors, Track prior)
      : sensors_(std::move(sensors)), track_(std::move(prior)) {}
  Track Step(const RowVector& z_first, const RowVector& z_second) override {
    Predict(sensors_[1], &track_);
    Correct(sensors_[0], z_first, &track_);
    Correct(sensors_[1], z_second, &track_);
    return track_;
  }

 private:
  std::array<LinearSensor, 2> sensors_;
  Track track_;
};

/// Two filters side by side. Architectures differ in what the two exchange
/// before and after a step.
class PairFusion : public SensorFusion {
 public:
  PairFusion(std::array<LinearSensor, 2> sensors, const Track& prior)
      : sensors_(std::move(sensors)), tracks_{prior, prior} {}
  Track Step(const RowVector& z_first, const RowVector& z_second) override {
    Before();
    const std::array<const RowVector*, 2> z = {&z_first, &z_second};
    for (std::size_t i = 0; i < 2; ++i) {
      Predict(sensors_[i], &tracks_[i]);
      Correct(sensors_[i], *z[i], &tracks_[i]);
    }
    const Track fused = Fuse();
    After(fused);
    return fused;
  }

 protected:
  virtual void Before() {}
  virtual Track Fuse() const {
    return FuseByInformation(tracks_[0], tracks_[1]);
  }
  virtual void After(const Track&) {}

  std::array<LinearSensor, 2> sensors_;
  std::array<Track, 2> tracks_;
};

class EqualisedFusion : public PairFusion {
 public:
  using PairFusion::PairFusion;

 private:
  /// Lee and Yoon 2011, eq. (9), weighs the states by R^-1, although R is of
  /// the measurements and has another dimension: here the mean variance of each
  /// sensor takes the place of its R.
  void Before() override {
    const double y_first = 1.0 / sensors_[0].R.diagonal().mean();
    const double y_second = 1.0 / sensors_[1].R.diagonal().mean();
    const ErrorVector equalised =
        (y_first * tracks_[0].x + y_second * tracks_[1].x) /
        (y_first + y_second);
    tracks_[0].x = tracks_[1].x = equalised;
  }
  /// Feeds state and covariance back to the first filter. That the two tracks
  /// are correlated from then on is not accounted for.
  void After(const Track& fused) override { tracks_[0] = fused; }
};

class FederatedFusion : public PairFusion {
 public:
  FederatedFusion(std::array<LinearSensor, 2> sensors, const Track& prior)
      : PairFusion(std::move(sensors), prior) {
    for (LinearSensor& sensor : sensors_) sensor.Q /= kShare;
    Share(prior);
  }

 private:
  static constexpr double kShare = 0.5;
  void Share(const Track& fused) {
    for (Track& track : tracks_) track = {fused.x, fused.P / kShare};
  }
  void After(const Track& fused) override { Share(fused); }
};

class IntersectionFusion : public PairFusion {
 public:
  using PairFusion::PairFusion;

 private:
  Track Fuse() const override {
    return FuseByCovarianceIntersection(tracks_[0], tracks_[1]);
  }
};

}  // namespace

Track FuseByInformation(const Track& a, const Track& b) {
  return FuseWeighted(a, 1.0, b, 1.0);
}

Track FuseByCovarianceIntersection(const Track& a, const Track& b) {
  constexpr int kBits = 20;
  const ErrorMatrix Y_a = Inverse(a.P);
  const ErrorMatrix Y_b = Inverse(b.P);
  const auto trace = [&](double w) {
    return Inverse(w * Y_a + (1.0 - w) * Y_b).trace();
  };
  const double w =
      boost::math::tools::brent_find_minima(trace, 0.0, 1.0, kBits).first;
  return FuseWeighted(a, w, b, 1.0 - w);
}

const char* FusionName(FusionArchitecture architecture) {
  switch (architecture) {
    case FusionArchitecture::kCentral:
      return "central";
    case FusionArchitecture::kTrackToTrack:
      return "track_to_track";
    case FusionArchitecture::kEqualised:
      return "equalised";
    case FusionArchitecture::kFederated:
      return "federated";
    case FusionArchitecture::kCovarianceIntersection:
      return "covariance_intersection";
  }
  return "";
}

std::unique_ptr<SensorFusion> MakeFusion(
    FusionArchitecture architecture, const std::array<LinearSensor, 2>& sensors,
    const Track& prior) {
  switch (architecture) {
    case FusionArchitecture::kCentral:
      return std::make_unique<CentralFusion>(sensors, prior);
    case FusionArchitecture::kTrackToTrack:
      return std::make_unique<PairFusion>(sensors, prior);
    case FusionArchitecture::kEqualised:
      return std::make_unique<EqualisedFusion>(sensors, prior);
    case FusionArchitecture::kFederated:
      return std::make_unique<FederatedFusion>(sensors, prior);
    case FusionArchitecture::kCovarianceIntersection:
      return std::make_unique<IntersectionFusion>(sensors, prior);
  }
  throw std::logic_error("unknown fusion architecture");
}

}  // namespace hindsight
