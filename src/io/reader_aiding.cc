#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "dataset/standing_flags.h"
#include "io/reader_rows.h"

namespace hindsight {
namespace {

/// Where a stream's quantities stand in its list of fields.
struct FieldMap {
  const std::vector<FieldName>& fields;
  std::size_t values;     ///< number of measured values, at the front
  std::size_t sigmas;     ///< number of standard deviations behind them
  std::size_t first = 0;  ///< of the measured values, where none is in front
  std::size_t quality() const { return *FieldIndex(fields, "quality"); }
};

FieldMap MapOf(const AidingReadOptions& options) {
  switch (options.type) {
    case SensorType::kVelocity:
      return {VelocityFields(), 3, 3};
    case SensorType::kHeight:
      return {options.surface ? DepthFields() : HeightFields(), 1, 1};
    case SensorType::kDvl:
      return options.dvl.form == Dvl::Form::kThreeAxis
                 ? FieldMap{DvlFields(), 3, 0}
                 : FieldMap{DvlFields(), 4, 0, 3};
    case SensorType::kAcousticFix: {
      const std::size_t first = options.acoustic.has_range ? 0 : 1;
      const std::size_t last = options.acoustic.has_bearing ? 3 : 1;
      return {AcousticFields(), last - first, 0, first};
    }
    case SensorType::kOdometer:
      if (options.odometer_form == Odometer::Form::kIncrements) {
        return {OdometerFields(), 1, 0,
                *FieldIndex(OdometerFields(), "distance")};
      }
      return {OdometerFields(), 1, 0};
    case SensorType::kSpeedCourse:
      return {SpeedCourseFields(), 1, 0};
    case SensorType::kMagnetometer:
      return {MagnetometerFields(), 3, 0};
    case SensorType::kZeroVelocity:
      return {ZeroVelocityFields(), 1, 0};
    default:
      return {PositionFields(), 3, 3};
  }
}

/// How much early a measurement may come that is still used under `every`, as
/// a part of it: stamps jitter.
constexpr double kEarly = 0.05;

class AidingReader {
 public:
  AidingReader(const StreamSource& source, const AidingReadOptions& options)
      : source_(source),
        options_(options),
        map_(MapOf(options)),
        rows_(source, map_.fields,
              !options.accept_quality.empty() ||
                  options.type == SensorType::kSpeedCourse || HasBeams()) {
    RequireFields(rows_.opened(), source.format, map_.fields, map_.first,
                  map_.first + map_.values - 1);
    if (!options.sigma) RequireSigmas();
    if (options.type == SensorType::kDvl && !HasBeams()) RefuseBeamFlags();
    if (!options.accept_quality.empty()) {
      RequireFields(rows_.opened(), source.format, map_.fields, map_.quality(),
                    map_.quality());
    }
  }

  MeasurementSeries Read() {
    MeasurementSeries measurements;
    bool last_kept = false;
    while (true) {
      const StreamRows::Step step = rows_.Next();
      if (step == StreamRows::Step::kEnd) break;
      if (step == StreamRows::Step::kReplace && last_kept) {
        measurements.pop_back();
      } else if (IsThinnedOut()) {
        last_kept = false;
        continue;
      }
      last_kept =
          !IsRejected() && !IsAbsent() && !IsAbsentVelocity() && !IsUnflagged();
      if (!last_kept) continue;
      const Measurement z{rows_.t(), options_.sensor, false, Model()};
      last_kept = Rows(z) > 0;
      if (!last_kept) {
        ++lost_;
        continue;
      }
      if (measurements.empty()) due_ = rows_.t();
      measurements.push_back(z);
      if (options_.every > 0.0) {
        const double late = rows_.t() + kEarly * options_.every - due_;
        if (late >= 0.0) {
          due_ += options_.every * (std::floor(late / options_.every) + 1.0);
        }
      }
    }
    if (options_.type == SensorType::kOdometer &&
        options_.odometer_form == Odometer::Form::kIncrements) {
      TakeDifferences(&measurements);
    }
    if (options_.type == SensorType::kZeroVelocity) {
      ShareErrorsOfStances(&measurements);
    }
    return measurements;
  }

  void Finish(StreamClock* clock, std::vector<PolicyCount>* policies) const {
    *clock = rows_.clock();
    rows_.CountPolicies(policies);
    AddPolicy(source_.name, "quality not accepted", rejected_, policies);
    AddPolicy(source_.name, "velocity absent", zero_velocities_, policies);
    AddPolicy(source_.name, "row with absent values", absent_, policies);
    AddPolicy(source_.name, "thinned out", thinned_, policies);
    AddPolicy(source_.name, "row without a valid beam", lost_, policies);
    AddPolicy(source_.name, "row without the flag", unflagged_, policies);
  }

 private:
  double Value(std::size_t i) const { return rows_.table().value(i); }

  bool HasBeams() const {
    return options_.type == SensorType::kDvl &&
           options_.dvl.form == Dvl::Form::kBeams;
  }

  void RequireSigmas() const {
    for (std::size_t i = map_.values; i < map_.values + map_.sigmas; ++i) {
      if (rows_.table().Has(i)) continue;
      throw InputError(source_.config_path, source_.config_line,
                       source_.name + ": " + source_.path + " has no column " +
                           map_.fields[i].name + "; expected it, or `sigma`");
    }
  }

  void RefuseBeamFlags() const {
    for (std::size_t i = kValid; i < kWater; ++i) {
      if (!rows_.table().Has(i)) continue;
      throw InputError(source_.config_path, source_.config_line,
                       source_.name + ": the column " + map_.fields[i].name +
                           " goes with `form: beams`; of three axes, expected "
                           "`quality` with accept_quality");
    }
  }

  /// A column of 1 and 0.
  bool Flag(std::size_t i) const {
    const double value = Value(i);
    if (value == 1.0 || value == 0.0) return value == 1.0;
    if (source_.absent_values && std::isnan(value)) return false;
    rows_.table().Fail(std::string(map_.fields[i].name) + " is " +
                       FormatNumber(value) + "; expected 1 or 0");
  }

  bool IsRejected() {
    if (options_.accept_quality.empty()) return false;
    const double quality = Value(map_.quality());
    for (const int accepted : options_.accept_quality) {
      if (quality == accepted) return false;
    }
    ++rejected_;
    return true;
  }

  bool IsThinnedOut() {
    if (rows_.t() >= due_ - kEarly * options_.every) return false;
    ++thinned_;
    return true;
  }

  bool IsAbsent() {
    if (HasBeams()) return false;
    for (std::size_t i = map_.first; i < map_.first + map_.values; ++i) {
      if (std::isfinite(Value(i))) continue;
      if (!source_.absent_values) {
        rows_.table().Fail(std::string("the value of ") + map_.fields[i].name +
                           " is absent; expected a finite number "
                           "(absent_values: true passes over such rows)");
      }
      ++absent_;
      return true;
    }
    return false;
  }

  bool IsAbsentVelocity() {
    if (options_.type != SensorType::kVelocity ||
        source_.format.kind != TextFormat::Kind::kRtklibPos) {
      return false;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      if (rows_.table().Has(i) && Value(i) != 0.0) return false;
    }
    ++zero_velocities_;
    return true;
  }

  /// A row that does not say that the vehicle stands.
  bool IsUnflagged() {
    if (options_.type != SensorType::kZeroVelocity || Flag(0)) return false;
    ++unflagged_;
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
        return options_.surface
                   ? HeightFix{*options_.surface - Value(0), Sigma(0)}
                   : HeightFix{Value(0), Sigma(0)};
      case SensorType::kDvl:
        return DvlModel();
      case SensorType::kAcousticFix:
        return AcousticModel();
      case SensorType::kOdometer:
        return OdometerModel();
      case SensorType::kSpeedCourse:
        return SpeedCourseModel();
      case SensorType::kZeroVelocity:
        return ZeroVelocity{options_.sigma->x()};
      case SensorType::kMagnetometer:
        return MagneticField{
            options_.C_bs * Eigen::Vector3d(Value(0), Value(1), Value(2)),
            options_.sigma->x(), options_.magnetic_form};
      default:
        break;
    }
    if (std::abs(Value(0)) > kPi / 2.0) {
      rows_.table().Fail("the latitude is " + FormatNumber(Value(0) / kDegree) +
                         " deg; expected -90 to 90 deg");
    }
    if (Value(1) < -kPi || Value(1) > 2.0 * kPi) {
      rows_.table().Fail("the longitude is " +
                         FormatNumber(Value(1) / kDegree) +
                         " deg; expected -180 to 360 deg");
    }
    return PositionFix{EcefFromGeodetic({Value(0), Value(1), Value(2)}),
                       Covariance()};
  }

  Odometer OdometerModel() const {
    Odometer odometer;
    odometer.form = options_.odometer_form;
    odometer.sigma = *options_.sigma;
    if (odometer.form == Odometer::Form::kIncrements) {
      odometer.distance = Value(map_.first);
      return odometer;
    }
    odometer.speed = Value(0);
    if (rows_.table().Has(1)) odometer.side_down.x() = Value(1);
    if (rows_.table().Has(2)) odometer.side_down.y() = Value(2);
    return odometer;
  }

  Dvl DvlModel() const {
    Dvl dvl = options_.dvl;
    for (int i = 0; i < dvl.components(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      dvl.speed(i) = Value(map_.first + k);
      dvl.valid[k] = std::isfinite(dvl.speed(i)) &&
                     (!rows_.table().Has(kValid + k) || Flag(kValid + k));
    }
    if (rows_.table().Has(kWater)) dvl.water = Flag(kWater);
    if (dvl.water && !options_.has_current) {
      rows_.table().Fail(source_.name +
                         ": water track needs `current` in the configuration");
    }
    return dvl;
  }

  AcousticFix AcousticModel() const {
    AcousticFix fix = options_.acoustic;
    if (fix.has_range) fix.range = Value(0);
    if (fix.has_bearing) {
      fix.azimuth = Value(1);
      fix.depression = Value(2);
    }
    return fix;
  }

  /// From counts to what has come since the count before; the first has none.
  static void TakeDifferences(MeasurementSeries* measurements) {
    Measurement before;
    for (Measurement& z : measurements->Edited()) {
      const Measurement count = z;
      auto& here = std::get<Odometer>(z.model);
      if (const auto* from = std::get_if<Odometer>(&before.model)) {
        here.distance -= from->distance;
        here.t_from = before.t;
      }
      before = count;
    }
    bool first = true;
    measurements->EraseIf(
        [&](const Measurement&) { return std::exchange(first, false); });
  }

  SpeedCourse SpeedCourseModel() const {
    SpeedCourse measured;
    measured.speed = Value(0);
    measured.sigma_speed = options_.sigma->x();
    measured.sigma_course = options_.course_sigma;
    measured.has_course = rows_.table().Has(1) && std::isfinite(Value(1)) &&
                          Value(0) >= options_.course_above;
    if (measured.has_course) measured.course = Value(1);
    return measured;
  }

  /// Of DvlFields.
  static constexpr std::size_t kValid = 7;
  static constexpr std::size_t kWater = 11;

  const StreamSource& source_;
  const AidingReadOptions& options_;
  FieldMap map_;
  StreamRows rows_;
  long rejected_ = 0;
  long zero_velocities_ = 0;
  long absent_ = 0;
  long thinned_ = 0;
  long lost_ = 0;
  long unflagged_ = 0;
  double due_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

MeasurementSeries ReadAiding(const StreamSource& source,
                             const AidingReadOptions& options,
                             StreamClock* clock,
                             std::vector<PolicyCount>* policies) {
  AidingReader reader(source, options);
  MeasurementSeries measurements = reader.Read();
  if (measurements.empty()) {
    throw InputError(source.path, 0,
                     "holds no measurement that " + source.name + " accepts");
  }
  reader.Finish(clock, policies);
  return measurements;
}

}  // namespace hindsight
