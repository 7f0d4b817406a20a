#include <Eigen/Cholesky>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "io/reader_rows.h"

namespace hindsight {
namespace {

/// Where a stream's quantities stand in its list of fields.
struct FieldMap {
  const std::vector<FieldName>& fields;
  std::size_t values;        ///< number of measured values, at the front
  std::size_t sigmas;        ///< number of standard deviations behind them
  std::size_t correlations;  ///< number of signed square roots behind those
  std::size_t quality() const { return values + sigmas + correlations; }
};

FieldMap MapOf(SensorType type) {
  switch (type) {
    case SensorType::kVelocity:
      return {VelocityFields(), 3, 3, 3};
    case SensorType::kHeight:
      return {HeightFields(), 1, 1, 0};
    default:
      return {PositionFields(), 3, 3, 3};
  }
}

class AidingReader {
 public:
  AidingReader(const StreamSource& source, const AidingReadOptions& options)
      : source_(source),
        options_(options),
        map_(MapOf(options.type)),
        rows_(source, map_.fields, false) {
    RequireFields(rows_.opened(), source.format, map_.fields, 0,
                  map_.values - 1);
    if (!options.sigma) RequireSigmas();
    if (!options.accept_quality.empty()) {
      RequireFields(rows_.opened(), source.format, map_.fields, map_.quality(),
                    map_.quality());
    }
  }

  std::vector<Measurement> Read() {
    std::vector<Measurement> measurements;
    bool last_kept = false;
    while (true) {
      const StreamRows::Step step = rows_.Next();
      if (step == StreamRows::Step::kEnd) break;
      if (step == StreamRows::Step::kReplace && last_kept) {
        measurements.pop_back();
      }
      last_kept = !IsRejected() && !IsAbsentVelocity();
      if (!last_kept) continue;
      measurements.push_back({rows_.t(), options_.sensor, false, Model()});
    }
    return measurements;
  }

  void Finish(StreamClock* clock, std::vector<PolicyCount>* policies) const {
    *clock = rows_.clock();
    rows_.CountPolicies(policies);
    AddPolicy(source_.name, "quality not accepted", rejected_, policies);
    AddPolicy(source_.name, "velocity absent", absent_, policies);
  }

 private:
  double Value(std::size_t i) const { return rows_.table().value(i); }

  void RequireSigmas() const {
    for (std::size_t i = map_.values; i < map_.values + map_.sigmas; ++i) {
      if (rows_.table().Has(i)) continue;
      throw InputError(source_.config_path, source_.config_line,
                       source_.name + ": " + source_.path + " has no column " +
                           map_.fields[i].name + "; expected it, or `sigma`");
    }
  }

  bool IsRejected() {
    if (options_.accept_quality.empty()) return false;
    const double quality = Value(map_.quality());
    if (options_.accept_quality.contains(static_cast<int>(quality))) {
      return false;
    }
    ++rejected_;
    return true;
  }

  bool IsAbsentVelocity() {
    if (options_.type != SensorType::kVelocity ||
        source_.format.kind != TextFormat::Kind::kRtklibPos) {
      return false;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      if (rows_.table().Has(i) && Value(i) != 0.0) return false;
    }
    ++absent_;
    return true;
  }

  double Sigma(std::size_t axis) const {
    if (options_.sigma) {
      // A height's only standard deviation is the vertical one.
      const std::size_t component = map_.values == 1 ? 2 : axis;
      return (*options_.sigma)(static_cast<Eigen::Index>(component));
    }
    const double sigma = Value(map_.values + axis);
    if (!(sigma > 0.0)) {
      rows_.table().Fail(std::string("the standard deviation ") +
                         map_.fields[map_.values + axis].name + " is " +
                         FormatNumber(sigma) + "; expected a positive one");
    }
    return sigma * options_.sigma_scale;
  }

  Eigen::Matrix3d Covariance() const {
    const Eigen::Vector3d sigma(Sigma(0), Sigma(1), Sigma(2));
    Eigen::Matrix3d R = sigma.cwiseAbs2().asDiagonal();
    if (options_.sigma || !options_.use_correlations) return R;
    const std::size_t first = map_.values + map_.sigmas;
    const auto covariance = [&](std::size_t i) {
      if (!rows_.table().Has(first + i)) return 0.0;
      const double root = Value(first + i) * options_.sigma_scale;
      return root * std::abs(root);
    };
    R(0, 1) = R(1, 0) = covariance(0);
    R(1, 2) = R(2, 1) = covariance(1);
    R(0, 2) = R(2, 0) = covariance(2);
    if (R.llt().info() != Eigen::Success) {
      rows_.table().Fail(
          "the covariance is not positive definite; expected correlations "
          "below one (correlations: false leaves them out)");
    }
    return R;
  }

  MeasurementModel Model() const {
    switch (options_.type) {
      case SensorType::kVelocity:
        return VelocityFix{{Value(0), Value(1), Value(2)}, Covariance()};
      case SensorType::kHeight:
        return HeightFix{Value(0), Sigma(0)};
      default:
        break;
    }
    if (std::abs(Value(0)) > kPi / 2.0) {
      rows_.table().Fail("the latitude is " + FormatNumber(Value(0) / kDegree) +
                         " deg; expected -90 to 90 deg");
    }
    return PositionFix{EcefFromGeodetic({Value(0), Value(1), Value(2)}),
                       Covariance()};
  }

  const StreamSource& source_;
  const AidingReadOptions& options_;
  FieldMap map_;
  StreamRows rows_;
  long rejected_ = 0;
  long absent_ = 0;
};

}  // namespace

std::vector<Measurement> ReadAiding(const StreamSource& source,
                                    const AidingReadOptions& options,
                                    StreamClock* clock,
                                    std::vector<PolicyCount>* policies) {
  AidingReader reader(source, options);
  std::vector<Measurement> measurements = reader.Read();
  if (measurements.empty()) {
    throw InputError(source.path, 0,
                     "holds no measurement that " + source.name + " accepts");
  }
  reader.Finish(clock, policies);
  return measurements;
}

}  // namespace hindsight
