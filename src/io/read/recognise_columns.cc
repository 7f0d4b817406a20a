#include "io/read/recognise_columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/median.h"
#include "base/units.h"
#include "io/read/column_meaning.h"
#include "io/read/fix_guess.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

using Names = std::vector<std::string>;

class Recogniser {
 public:
  Recogniser(const FileColumns& file, const std::string& name,
             const RecogniseHints& hints)
      : file_(file),
        hints_(hints),
        meanings_(ReadMeanings(file)),
        words_(SplitWords(name)),
        named_truth_(IsNamedTruth(name)) {}

  std::vector<Found> Recognise() {
    if (named_truth_) {
      FindStamps(0.02, 1000.0);
      AddTruth(true);
      return std::move(all_);
    }
    FindImu();
    if (all_.empty()) FindStamps(0.02, 1000.0);
    if (!stamps_) return {};
    AddFixes();
    AddTitled(DvlKind(), {"v_x", "v_y", "v_z"}, {});
    AddTitled(ZeroVelocityKind(), {"zero_velocity"}, {});
    AddTitled(DepthKind(), {"depth"}, {});
    AddTitled(MagnetometerKind(), {"mag_x", "mag_y", "mag_z"}, {});
    AddOdometer();
    AddTruth(false);
    return std::move(all_);
  }

 private:
  void FindStamps(double slowest, double fastest) {
    StampHints hints;
    hints.slowest = slowest;
    hints.fastest = fastest;
    hints.span = hints_.imu_span;
    hints.count_rate = hints_.count_rate;
    for (const char* name : {"sampling_rate", "sample_rate", "fs", "rate"}) {
      const auto scalar = file_.scalars.find(name);
      if (scalar == file_.scalars.end()) continue;
      hints.count_rate = scalar->second;
      hints.rate_stated = true;
    }
    stamps_ = GuessStamps(file_, meanings_, hints);
  }

  void FindImu() {
    constexpr double kSlowest = 4.0;
    constexpr double kFastest = 4000.0;
    constexpr double kUsualGap = 0.5;  // s, the default of max_gap
    FindStamps(kSlowest, kFastest);
    const double step = stamps_ ? stamps_->step : 0.0;
    auto guess =
        GuessImu(file_, meanings_, stamps_ ? stamps_->column : -1, step);
    if (!guess) return;
    if (!stamps_) stamps_ = CountedImu(*guess);
    Found found = Stream("");
    found.imu = true;
    found.spin_axis = SpinAxis(*guess);
    if (!stamps_->rate && stamps_->gap > kUsualGap) {
      SetLine({"max_gap", fmt::format("{:.2g} s", 1.1 * stamps_->gap),
               fmt::format("drop-outs of up to {:.3g} s are bridged",
                           stamps_->gap)},
              &found.lines);
    }
    AddTriple("accel_", guess->accel, &found);
    AddTriple("gyro_", guess->gyro, &found);
    constexpr double kShown = 0.5;
    if (guess->turn.slope < 0.0 && guess->turn.correlation < -kShown) {
      found.assumptions.push_back(fmt::format(
          "gravity turns against the gyros (correlation {:.2f}): an axis is "
          "mirrored in both, or the gyros have the other sign",
          guess->turn.correlation));
    }
    found.imu_guess = std::move(guess);
    all_.push_back(std::move(found));
  }

  /// Of a rate that the motion tells the usual one, if it is as near as that is
  /// certain.
  static StampGuess CountedImu(const ImuGuess& guess) {
    constexpr std::array kUsual = {20.0,  25.0,  30.0,  50.0,  60.0,  100.0,
                                   104.0, 120.0, 125.0, 200.0, 208.0, 250.0,
                                   256.0, 300.0, 400.0, 416.0, 500.0, 1000.0};
    constexpr double kGyroScale = 0.03;  // of an uncalibrated gyro
    StampGuess stamps;
    stamps.certainty = Certainty::kGuess;
    if (!guess.rate) {
      stamps.rate = 100.0;
      stamps.reason =
          "rows are counted, not stamped, and the motion does not show their "
          "rate";
    } else {
      const double found = guess.rate->rate;
      const auto distance = [&](double rate) {
        return std::abs(std::log(rate / found));
      };
      const double nearest = *std::min_element(
          kUsual.begin(), kUsual.end(),
          [&](double a, double b) { return distance(a) < distance(b); });
      const double sigma = std::hypot(guess.rate->log_sigma, kGyroScale);
      stamps.rate = distance(nearest) < 2.0 * sigma ? nearest : found;
      stamps.certainty = Certainty::kLikely;
      stamps.reason = fmt::format(
          "rows are counted, not stamped; between {} quiet spells gravity is "
          "balanced at {:.1f} +- {:.1f} Hz",
          guess.rate->spans, found, sigma * found);
    }
    stamps.step = 1.0 / *stamps.rate;
    return stamps;
  }

  /// What every stream of the file has.
  Found Stream(const std::string& comment) const {
    Found found{"", file_.format};
    if (file_.skip_lines > 0) {
      found.lines.push_back({"skip_lines", std::to_string(file_.skip_lines)});
    }
    if (file_.cut_tail) found.lines.push_back({"allow_truncated_tail", "true"});
    if (file_.text_rows > 0) found.lines.push_back({"on_text", "drop"});
    found.remarks = file_.remarks;
    found.stamps = stamps_;
    found.lines.push_back({"columns", "", comment});
    if (stamps_->column >= 0 && !stamps_->rate) {
      AddColumn("t",
                {stamps_->column, stamps_->unit, 1.0, stamps_->certainty,
                 stamps_->reason},
                &found);
    }
    if (stamps_->repeated && !stamps_->rate) {
      SetLine({"on_duplicate", "drop_last", "stamps stand twice"},
              &found.lines);
    }
    if (stamps_->unordered && !stamps_->rate) {
      SetLine({"on_unordered", "sort", "stamps run backwards"}, &found.lines);
    }
    if (stamps_->certainty == Certainty::kGuess ||
        (stamps_->rate && stamps_->certainty == Certainty::kLikely)) {
      found.assumptions.push_back(stamps_->reason);
    }
    return found;
  }

  /// Behind the other lines of `columns`.
  void AddColumn(const std::string& quantity, const ColumnGuess& guess,
                 Found* found) const {
    const FileColumn& column =
        file_.columns[static_cast<std::size_t>(guess.column)];
    std::string comment;
    if (file_.format == "columns" && !column.title.empty()) {
      comment = "'" + column.title + "'";
    }
    if (!guess.reason.empty()) {
      comment += (comment.empty() ? "" : "; ") + guess.reason;
    }
    if (guess.certainty != Certainty::kCertain) {
      comment += std::string(comment.empty() ? "(" : " (") +
                 CertaintyName(guess.certainty) + ")";
    }
    const std::string& reference = column.reference;
    const std::string unit = guess.unit.empty() ? "1" : guess.unit;
    std::string value;
    if (std::abs(guess.sign) != 1.0) {
      value = fmt::format("{{column: \"{}\", unit: \"{}\", scale: {:.9g}}}",
                          reference, unit, guess.sign);
    } else {
      value = fmt::format("\"{}{} [{}]\"", guess.sign < 0.0 ? "-" : "",
                          reference, unit);
    }
    std::size_t end = found->lines.size();
    while (!found->lines[end - 1].key.starts_with(' ') &&
           found->lines[end - 1].key != "columns") {
      --end;
    }
    found->lines.insert(found->lines.begin() + static_cast<std::ptrdiff_t>(end),
                        {"  " + quantity, value, comment});
  }

  void AddTriple(const std::string& family, const TripleGuess& triple,
                 Found* found) const {
    for (std::size_t i = 0; i < 3; ++i) {
      AddColumn(
          family + "xyz" [i],
          {
            triple.columns[i], triple.unit, triple.scale, triple.certainty,
                i == 0 ? triple.reason : ""
          },
          found);
    }
  }

  int Titled(const std::string& quantity) const {
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      if (meanings_[i].quantity == quantity) return static_cast<int>(i);
    }
    return -1;
  }

  bool HasAll(const Names& names) const {
    return std::all_of(names.begin(), names.end(),
                       [&](const auto& name) { return Titled(name) >= 0; });
  }

  /// A titled column of a kind's quantity, in the title's unit, else in SI.
  void AddTitledColumn(const std::string& quantity, Quantity dimension,
                       Found* found) const {
    const int column = Titled(quantity);
    const ColumnMeaning& meaning = meanings_[static_cast<std::size_t>(column)];
    const bool known = UnitFactor(meaning.unit, dimension).has_value();
    const bool sure = known || dimension == Quantity::kRatio;
    ColumnGuess guess{column, known ? meaning.unit : SiUnit(dimension),
                      meaning.upwards ? -1.0 : 1.0,
                      sure ? Certainty::kCertain : Certainty::kGuess,
                      sure ? "" : "unit not stated"};
    if (!known && dimension == Quantity::kAngle) guess.unit = AngleUnit();
    if (!known && dimension == Quantity::kMagneticField) {
      guess.unit = FieldUnit();
      guess.certainty = Certainty::kLikely;
      guess.reason = "as strong as the Earth's";
    }
    AddColumn(quantity, guess, found);
  }

  /// By size: rolls, pitches and headings in radians stay below 2 pi.
  std::string AngleUnit() const {
    constexpr double kMostRadians = 6.3;
    for (const char* name : {"roll", "pitch", "heading"}) {
      const int column = Titled(name);
      if (column < 0) continue;
      const auto& v = file_.columns[static_cast<std::size_t>(column)].values;
      if (std::any_of(v.begin(), v.end(),
                      [](double x) { return std::abs(x) > kMostRadians; })) {
        return "deg";
      }
    }
    return "rad";
  }

  /// The unit in which the median field is nearest to the Earth's 48 uT.
  std::string FieldUnit() const {
    std::vector<double> lengths(file_.rows);
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      for (const char* name : {"mag_x", "mag_y", "mag_z"}) {
        const auto column = static_cast<std::size_t>(Titled(name));
        lengths[k] = std::hypot(lengths[k], file_.columns[column].values[k]);
      }
    }
    constexpr double kEarth = 48.0;  // uT
    const double length = Median(std::move(lengths));
    std::string nearest = "uT";
    double distance = std::numeric_limits<double>::infinity();
    for (const char* unit : {"uT", "nT", "mG", "G"}) {
      const double field = length * *UnitFactor(unit, Quantity::kMagneticField);
      const double here = std::abs(std::log(field / kEarth));
      if (here < distance) nearest = unit;
      distance = std::min(distance, here);
    }
    return nearest;
  }

  void AddFieldsOf(const SensorKind& kind, const Names& names,
                   Found* found) const {
    for (const FieldName& field : kind.columns) {
      const bool wanted =
          std::find(names.begin(), names.end(), field.name) != names.end();
      if (wanted) AddTitledColumn(field.name, field.quantity, found);
    }
  }

  void AddTitled(const SensorKind& kind, const Names& names,
                 const Names& sigmas) {
    if (!HasAll(names)) return;
    Found found = Stream("");
    found.kinds = {&kind};
    AddFieldsOf(kind, names, &found);
    found.sigmas = !sigmas.empty() && HasAll(sigmas);
    if (found.sigmas) AddFieldsOf(kind, sigmas, &found);
    all_.push_back(std::move(found));
  }

  void AddFixes() {
    const auto fixes = GuessFixes(file_, meanings_, *stamps_);
    // Places beside attitudes are another solution's, no sensor's.
    const bool solution = !ImuHere() && HasAll({"roll", "pitch", "heading"});
    if (fixes && fixes->h.column >= 0 && !solution) AddPosition(*fixes);
    const Names velocity = {"v_n", "v_e", "v_d"};
    if (HasAll(velocity) && !solution) {
      AddTitled(VelocityKind(), velocity,
                {"sigma_v_n", "sigma_v_e", "sigma_v_d"});
    } else if (fixes && fixes->speed && fixes->course && !solution) {
      Found found = Stream("");
      found.kinds = {&SpeedCourseKind()};
      AddColumn("speed", *fixes->speed, &found);
      AddColumn("course", *fixes->course, &found);
      all_.push_back(std::move(found));
    }
  }

  bool ImuHere() const {
    return std::any_of(all_.begin(), all_.end(),
                       [](const Found& found) { return found.imu; });
  }

  void AddPosition(const FixGuess& fixes) {
    Found found = Stream("");
    found.kinds = {&PositionKind()};
    found.top_speed = fixes.top_speed;
    AddColumn("lat", fixes.lat, &found);
    AddColumn("lon", fixes.lon, &found);
    AddColumn("h", fixes.h, &found);
    const Names sigmas = {"sigma_n", "sigma_e", "sigma_d"};
    found.sigmas = HasAll(sigmas);
    if (found.sigmas) {
      AddFieldsOf(PositionKind(), sigmas, &found);
      SetGrossNoise(&found);
    }
    constexpr double kStale = 0.5;
    if (fixes.repeated > kStale) {
      SetLine({"on_repeat", "drop",
               fmt::format("{:.0f} % of the rows repeat the one before",
                           100.0 * fixes.repeated)},
              &found.lines);
    }
    all_.push_back(std::move(found));
  }

  /// Errors of a receiver on its own last for many seconds.
  void SetGrossNoise(Found* found) const {
    constexpr double kFine = 0.3;  // m
    std::vector<double> sigmas =
        file_.columns[static_cast<std::size_t>(Titled("sigma_n"))].values;
    const double sigma = Median(std::move(sigmas));
    if (!(sigma > kFine)) return;
    SetLine({"noise",
             fmt::format("{{model: gauss_markov, sigma: {:.2g} m, tau: 60 s, "
                         "white: {:.2g} m}}",
                         sigma, 0.1 * sigma),
             "the file's median sigma; errors of a receiver on its own last "
             "(a guess)"},
            &found->lines);
  }

  void AddOdometer() {
    const bool vehicle =
        std::any_of(words_.begin(), words_.end(), [](const std::string& word) {
          return word == "can" || word == "odometer" || word == "odo" ||
                 word == "speed" || word == "wheel" || word == "vehicle";
        });
    const bool of_fixes = Titled("lat") >= 0 || Titled("course") >= 0;
    if (!vehicle || of_fixes || Titled("speed") < 0 || named_truth_) return;
    AddTitled(OdometerKind(), {"speed"}, {});
  }

  /// All that a reference may say.
  void AddTruth(bool named) {
    if (!stamps_) return;
    const bool attitude = HasAll({"roll", "pitch", "heading"}) ||
                          HasAll({"q_w", "q_x", "q_y", "q_z"});
    const bool place = HasAll({"lat", "lon", "h"});
    const bool local = HasAll({"p_x", "p_y", "p_z"});
    if (named ? !attitude && !place && !local : !attitude) return;
    Found found = Stream("");
    found.truth = named;
    found.pose = !named;
    AddTruthColumns(place, local, attitude, &found);
    all_.push_back(std::move(found));
  }

  void AddTruthColumns(bool place, bool local, bool attitude,
                       Found* found) const {
    const auto add = [&](const Names& names, Quantity dimension) {
      if (!HasAll(names)) return;
      for (const std::string& name : names) {
        AddTitledColumn(name, dimension, found);
      }
    };
    if (place) {
      add({"lat", "lon"}, Quantity::kAngle);
      add({"h"}, Quantity::kLength);
    } else if (local) {
      add({"p_x", "p_y", "p_z"}, Quantity::kLength);
      SetFrame(found);
    }
    add({"v_n", "v_e", "v_d"}, Quantity::kSpeed);
    if (!attitude) return;
    if (HasAll({"roll", "pitch", "heading"})) {
      add({"roll", "pitch", "heading"}, Quantity::kAngle);
    } else {
      add({"q_w", "q_x", "q_y", "q_z"}, Quantity::kRatio);
    }
  }

  /// Earth-centred by its size, else local axes.
  void SetFrame(Found* found) const {
    constexpr double kNearSurface = 6.2e6;
    double squares = 0.0;
    for (const char* name : {"p_x", "p_y", "p_z"}) {
      const auto column = static_cast<std::size_t>(Titled(name));
      squares += std::pow(file_.columns[column].values.front(), 2);
    }
    if (std::sqrt(squares) > kNearSurface) {
      SetLine({"frame", "ecef", "as far from the origin as the ground"},
              &found->lines);
      return;
    }
    SetLine({"frame", "ned", "x north, y east, z down (a guess)"},
            &found->lines);
    SetLine({"origin", "[0 deg, 0 deg, 0 m]",
             "the file does not say where (a guess)"},
            &found->lines);
  }

  /// Of an IMU on a wheel.
  std::optional<int> SpinAxis(const ImuGuess& guess) const {
    constexpr double kFast = 100.0 * kDegree;
    constexpr double kOften = 0.2;
    const auto factor =
        UnitFactor(guess.gyro.unit, Quantity::kAngularRate).value_or(1.0);
    std::array<double, 3> squares = {};
    std::size_t fast = 0;
    for (std::size_t k = 0; k < file_.rows; ++k) {
      double rate = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto column = static_cast<std::size_t>(guess.gyro.columns[i]);
        const double w = factor * file_.columns[column].values[k];
        squares[i] += w * w;
        rate = std::hypot(rate, w);
      }
      if (rate > kFast) ++fast;
    }
    const auto most = std::max_element(squares.begin(), squares.end());
    const double sum = squares[0] + squares[1] + squares[2];
    constexpr double kAlone = 0.9;
    if (static_cast<double>(fast) < kOften * static_cast<double>(file_.rows) ||
        *most < kAlone * sum) {
      return std::nullopt;
    }
    return static_cast<int>(most - squares.begin());
  }

  const FileColumns& file_;
  const RecogniseHints& hints_;
  std::vector<ColumnMeaning> meanings_;
  Names words_;
  bool named_truth_;
  std::optional<StampGuess> stamps_;
  std::vector<Found> all_;
};

}  // namespace

std::vector<Found> RecogniseColumns(const FileColumns& file,
                                    const std::string& name,
                                    const RecogniseHints& hints) {
  return Recogniser(file, name, hints).Recognise();
}

}  // namespace hindsight
