#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/text.h"
#include "io/read/file_format.h"
#include "io/read/reader_rows.h"

namespace hindsight {
namespace {

/// How much early a measurement may come that is still used under `every`, as
/// a part of it: stamps jitter.
constexpr double kEarly = 0.05;

bool JudgesAbsence(const SensorSettings& settings) {
  const auto judges = settings.sensor.kind->judges_absence;
  return judges != nullptr && judges(settings);
}

/// Whether a row with an empty value is a row.
bool MayBeAbsent(const SensorSettings& settings) {
  return !settings.accept_quality.empty() || JudgesAbsence(settings) ||
         settings.sensor.kind->has_optional_columns;
}

class AidingReader : public MeasuredRow {
 public:
  AidingReader(const StreamSource& source, const SensorSettings& settings,
               int sensor)
      : source_(source),
        settings_(settings),
        kind_(*settings.sensor.kind),
        sensor_(sensor),
        measured_(kind_.measured(settings)),
        rows_(source, kind_.columns, MayBeAbsent(settings)) {
    const std::size_t first = measured_.first;
    RequireFields(rows_.opened(), source.format, kind_.columns, first,
                  first + measured_.count - 1);
    if (!settings.sigma) RequireSigmas();
    RefuseColumns();
    if (!settings.accept_quality.empty()) {
      RequireFields(rows_.opened(), source.format, kind_.columns, Quality(),
                    Quality());
    }
  }

  MeasurementSeries Read() {
    MeasurementSeries measurements;
    bool last_kept = false;
    while (true) {
      const StreamRows::Step step = rows_.Next();
      if (step == StreamRows::Step::kEnd) break;
      if (IsRepeat()) {
        last_kept = false;
        continue;
      }
      if (step == StreamRows::Step::kReplace && last_kept) {
        measurements.pop_back();
      } else if (IsThinnedOut()) {
        last_kept = false;
        continue;
      }
      last_kept = !IsRejected() && !IsAbsent() && !IsAbsentVelocity();
      if (!last_kept) continue;
      const auto model = kind_.read(*this, settings_);
      last_kept = model.has_value();
      if (!last_kept) {
        ++unread_;
        continue;
      }
      if (measurements.empty()) due_ = rows_.t();
      measurements.push_back({rows_.t(), sensor_, false, *model});
      SetDue();
    }
    if (kind_.join != nullptr) kind_.join(settings_, &measurements);
    return measurements;
  }

  void Finish(StreamClock* clock, std::vector<PolicyCount>* policies) const {
    *clock = rows_.clock();
    rows_.CountPolicies(policies);
    AddPolicy(source_.name, "quality not accepted", rejected_, policies);
    AddPolicy(source_.name, "velocity absent", zero_velocities_, policies);
    AddPolicy(source_.name, "row with absent values", absent_, policies);
    AddPolicy(source_.name, "thinned out", thinned_, policies);
    AddPolicy(source_.name, "repeats the row before", repeats_, policies);
    AddPolicy(source_.name, std::string(kind_.unread), unread_, policies);
  }

  double Value(std::size_t column) const override {
    return rows_.table().value(column);
  }

  bool Has(std::size_t column) const override {
    return rows_.table().Has(column);
  }

  bool Flag(std::size_t column) const override {
    const double value = Value(column);
    if (value == 1.0 || value == 0.0) return value == 1.0;
    if (source_.absent_values && std::isnan(value)) return false;
    rows_.table().Fail(std::string(kind_.columns[column].name) + " is " +
                       FormatNumber(value) + "; expected 1 or 0");
  }

  double Sigma(std::size_t axis) const override {
    if (settings_.sigma) {
      return (*settings_.sigma)(static_cast<Eigen::Index>(axis));
    }
    const std::size_t column = FirstSigma() + axis;
    const double sigma = Value(column);
    if (!(sigma > 0.0)) {
      Fail(std::string("the standard deviation ") + kind_.columns[column].name +
           " is " + FormatNumber(sigma) + "; expected a positive one");
    }
    return sigma * settings_.sigma_scale;
  }

  Eigen::Matrix3d Covariance() const override {
    const Eigen::Vector3d sigma(Sigma(0), Sigma(1), Sigma(2));
    Eigen::Matrix3d R = sigma.cwiseAbs2().asDiagonal();
    if (settings_.sigma || !settings_.use_correlations) return R;
    const std::size_t first = FirstSigma() + measured_.sigmas;
    const auto covariance = [&](std::size_t i) {
      if (!Has(first + i)) return 0.0;
      const double root = Value(first + i) * settings_.sigma_scale;
      return root * std::abs(root);
    };
    R(0, 1) = R(1, 0) = covariance(0);
    R(1, 2) = R(2, 1) = covariance(1);
    R(0, 2) = R(2, 0) = covariance(2);
    if (R.llt().info() != Eigen::Success) {
      Fail(
          "the covariance is not positive definite; expected correlations "
          "below one (correlations: false leaves them out)");
    }
    return R;
  }

  [[noreturn]] void Fail(const std::string& message) const override {
    rows_.table().Fail(message);
  }

 private:
  std::size_t Quality() const { return *FieldIndex(kind_.columns, "quality"); }

  std::size_t FirstSigma() const { return measured_.first + measured_.count; }

  void RequireSigmas() const {
    const std::size_t first = FirstSigma();
    for (std::size_t i = first; i < first + measured_.sigmas; ++i) {
      if (rows_.table().Has(i)) continue;
      throw InputError(source_.config_path, source_.config_line,
                       source_.name + ": " + source_.path + " has no column " +
                           kind_.columns[i].name + "; expected it, or `sigma`");
    }
  }

  void RefuseColumns() const {
    if (kind_.forbidden == nullptr) return;
    const SensorKind::Forbidden forbidden = kind_.forbidden(settings_);
    for (std::size_t i = 0; i < forbidden.count; ++i) {
      const std::size_t column = forbidden.first + i;
      if (!rows_.table().Has(column)) continue;
      throw InputError(source_.config_path, source_.config_line,
                       source_.name + ": the column " +
                           kind_.columns[column].name +
                           std::string(forbidden.reason));
    }
  }

  bool IsRejected() {
    if (settings_.accept_quality.empty()) return false;
    const double quality = Value(Quality());
    for (const int accepted : settings_.accept_quality) {
      if (quality == accepted) return false;
    }
    ++rejected_;
    return true;
  }

  bool IsThinnedOut() {
    if (rows_.t() >= due_ - kEarly * settings_.every) return false;
    ++thinned_;
    return true;
  }

  void SetDue() {
    if (settings_.every <= 0.0) return;
    const double late = rows_.t() + kEarly * settings_.every - due_;
    if (late < 0.0) return;
    due_ += settings_.every * (std::floor(late / settings_.every) + 1.0);
  }

  bool IsRepeat() {
    if (!source_.drop_repeats) return false;
    bool repeats = last_values_.size() == measured_.count;
    last_values_.resize(measured_.count);
    for (std::size_t i = 0; i < measured_.count; ++i) {
      const double value = Value(measured_.first + i);
      repeats = repeats && value == last_values_[i];
      last_values_[i] = value;
    }
    if (repeats) ++repeats_;
    return repeats;
  }

  bool IsAbsent() {
    if (JudgesAbsence(settings_)) return false;
    const std::size_t end = measured_.first + measured_.count;
    for (std::size_t i = measured_.first; i < end; ++i) {
      if (std::isfinite(Value(i))) continue;
      if (!source_.absent_values) {
        Fail(std::string("the value of ") + kind_.columns[i].name +
             " is absent; expected a finite number "
             "(absent_values: true passes over such rows)");
      }
      ++absent_;
      return true;
    }
    return false;
  }

  bool IsAbsentVelocity() {
    if (!kind_.is_velocity || !source_.format.kind->zeros_are_absent) {
      return false;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      if (Has(i) && Value(i) != 0.0) return false;
    }
    ++zero_velocities_;
    return true;
  }

  const StreamSource& source_;
  const SensorSettings& settings_;
  const SensorKind& kind_;
  const int sensor_;
  const MeasuredColumns measured_;
  StreamRows rows_;
  long rejected_ = 0;
  long zero_velocities_ = 0;
  long absent_ = 0;
  long thinned_ = 0;
  long repeats_ = 0;
  std::vector<double> last_values_;
  long unread_ = 0;
  double due_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

MeasurementSeries ReadAiding(const StreamSource& source,
                             const SensorSettings& settings, int sensor,
                             StreamClock* clock,
                             std::vector<PolicyCount>* policies) {
  AidingReader reader(source, settings, sensor);
  MeasurementSeries measurements = reader.Read();
  if (measurements.empty()) {
    throw InputError(source.path, 0,
                     "holds no measurement that " + source.name + " accepts");
  }
  reader.Finish(clock, policies);
  return measurements;
}

}  // namespace hindsight
