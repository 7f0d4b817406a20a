#include "io/read/recognise_columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "base/median.h"
#include "base/units.h"
#include "io/read/column_choice.h"
#include "io/read/column_lines.h"
#include "io/read/fix_guess.h"
#include "io/read/imu_columns.h"
#include "io/read/title_words.h"
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
        lines_(file),
        words_(SplitWords(name)),
        named_truth_(IsNamedTruth(name)) {
    if (IsNamed({"v", "vel", "velocity", "velocities"}) && !named_truth_) {
      lines_.TakeForVelocities();
    }
  }

  std::vector<FoundStream> Recognise() {
    if (named_truth_) {
      FindStamps(0.02, 1000.0);
      AddTruth(true);
      return std::move(all_);
    }
    FindImu();
    if (all_.empty()) FindStamps(0.02, 1000.0);
    if (!stamps()) return {};
    AddFixes();
    AddTitled(DvlKind(), {"v_x", "v_y", "v_z"}, {});
    AddTitled(ZeroVelocityKind(), {"zero_velocity"}, {});
    AddTitled(DepthKind(), {"depth"}, {});
    AddHeights();
    AddTitled(MagnetometerKind(), {"mag_x", "mag_y", "mag_z"}, {});
    AddOdometer();
    AddTruth(false);
    return std::move(all_);
  }

 private:
  bool IsNamed(std::initializer_list<std::string_view> names) const {
    return std::any_of(words_.begin(), words_.end(), [&](const auto& word) {
      return std::find(names.begin(), names.end(), word) != names.end();
    });
  }

  const std::optional<StampGuess>& stamps() const { return lines_.stamps(); }

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
    lines_.set_stamps(GuessStamps(file_, lines_.meanings(), hints));
  }

  void FindImu() {
    constexpr double kSlowest = 4.0;
    constexpr double kFastest = 4000.0;
    FindStamps(kSlowest, kFastest);
    const double step = stamps() ? stamps()->step : 0.0;
    auto guess = GuessImu(file_, lines_.meanings(),
                          stamps() ? stamps()->column : -1, step);
    if (!guess) return;
    if (!stamps()) {
      StampGuess counted = CountedImu(*guess);
      counted.step = 1.0 / counted.rate.value();
      counted.span = static_cast<double>(file_.rows - 1) * counted.step;
      lines_.set_stamps(std::move(counted));
    }
    FoundStream found = lines_.ImuStreamOf(*guess);
    found.spin_axis = SpinAxis(file_, *guess);
    lines_.AddTriple("accel_", guess->accel, &found);
    lines_.AddTriple("gyro_", guess->gyro, &found);
    lines_.Take("accel_", guess->accel);
    lines_.Take("gyro_", guess->gyro);
    found.imu_guess = std::move(guess);
    all_.push_back(std::move(found));
  }

  void AddTitled(const SensorKind& kind, const Names& names,
                 const Names& sigmas) {
    if (!lines_.HasAll(names)) return;
    FoundStream found = lines_.Stream();
    found.kinds = {&kind};
    lines_.AddFieldsOf(kind, names, &found);
    found.sigmas = !sigmas.empty() && lines_.HasAll(sigmas);
    if (found.sigmas) lines_.AddFieldsOf(kind, sigmas, &found);
    all_.push_back(std::move(found));
  }

  void AddFixes() {
    std::optional<FileColumns> placed;
    if (lines_.HasAll({"lat", "lon"})) placed = RowsWithPlaces();
    const auto fixes =
        GuessFixes(placed ? *placed : file_, lines_.meanings(), *stamps());
    // Places beside attitudes are another solution's, no sensor's.
    const bool solution =
        !ImuHere() && lines_.HasAll({"roll", "pitch", "heading"});
    const bool told =
        fixes && (fixes->h.column >= 0 || fixes->place_order_told);
    if (told && !solution) AddPosition(*fixes);
    if (!fixes && !solution) AddEarthCentred();
    const Names velocity = {"v_n", "v_e", "v_d"};
    if (lines_.HasAll(velocity) && !solution) {
      AddTitled(VelocityKind(), velocity,
                {"sigma_v_n", "sigma_v_e", "sigma_v_d"});
      AddSpeedAccuracy(&all_.back());
    } else if (fixes && fixes->speed && fixes->course && !solution) {
      FoundStream found = lines_.Stream();
      found.kinds = {&SpeedCourseKind()};
      lines_.AddColumn("speed", *fixes->speed, &found);
      lines_.AddColumn("course", *fixes->course, &found);
      all_.push_back(std::move(found));
    }
  }

  /// The rows that hold a place: neither nothing nor zeros, as receivers write
  /// before their first fix. Titles say which columns are latitude and longitude.
  FileColumns RowsWithPlaces() const {
    FileColumns rows = file_;
    const std::vector<double>& lat = Values(lines_.Titled("lat"));
    const std::vector<double>& lon = Values(lines_.Titled("lon"));
    std::vector<bool> absent(file_.rows);
    for (std::size_t k = 0; k < absent.size(); ++k) {
      absent[k] = std::isnan(lat[k]) || std::isnan(lon[k]) ||
                  (lat[k] == 0.0 && lon[k] == 0.0);
    }
    for (FileColumn& column : rows.columns) {
      std::size_t k = 0;
      std::erase_if(column.values, [&](double) { return absent[k++]; });
    }
    rows.rows -= static_cast<std::size_t>(
        std::count(absent.begin(), absent.end(), true));
    return rows;
  }

  bool ImuHere() const {
    return std::any_of(all_.begin(), all_.end(),
                       [](const FoundStream& found) { return found.imu; });
  }

  void AddPosition(const FixGuess& fixes) {
    FoundStream found = lines_.Stream();
    found.kinds = {&PositionKind()};
    found.top_speed = fixes.top_speed;
    found.place_unit_told = fixes.place_unit_told;
    found.place_order_told = fixes.place_order_told;
    lines_.AddColumn("lat", fixes.lat, &found);
    lines_.AddColumn("lon", fixes.lon, &found);
    if (fixes.h.column < 0) {
      AddWithoutHeight(fixes, &found);
      all_.push_back(std::move(found));
      return;
    }
    lines_.AddColumn("h", fixes.h, &found);
    if (CountsFromSea(file_, fixes.h.column)) {
      found.assumptions.emplace_back(
          "its heights seem to count from the sea; they are taken for heights "
          "above the ellipsoid, which differ by the geoid's, -105 to 85 m");
    }
    const Names sigmas = {"sigma_n", "sigma_e", "sigma_d"};
    found.sigmas = lines_.HasAll(sigmas);
    if (found.sigmas) {
      lines_.AddFieldsOf(PositionKind(), sigmas, &found);
      SetGrossNoise(MedianOf(lines_.Titled("sigma_n")), &found);
    } else {
      AddAccuracies(&found);
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

  /// Fixes as x, y and z from the Earth's centre.
  void AddEarthCentred() {
    const Names axes = {"p_x", "p_y", "p_z"};
    if (!lines_.HasAll(axes) || !AreEarthCentred()) return;
    FoundStream found = lines_.Stream();
    found.kinds = {&PositionKind()};
    for (const std::string& axis : axes) {
      lines_.AddTitledColumn(axis, Quantity::kLength, &found);
    }
    SetFrame(&found);
    const int sigma = StatedSigma("sigma");
    found.sigmas = sigma >= 0;
    for (const char* name : {"sigma_x", "sigma_y", "sigma_z"}) {
      if (sigma < 0) break;
      lines_.AddColumn(name, SigmaGuess(sigma, Quantity::kLength, 1.0, ""),
                       &found);
    }
    if (sigma >= 0) SetGrossNoise(MedianOf(sigma), &found);
    all_.push_back(std::move(found));
  }

  /// Places with a height that is known to a kilometre by all fixes together: it
  /// is the same error in each.
  void AddWithoutHeight(const FixGuess& fixes, FoundStream* found) const {
    constexpr double kKilometre = 1000.0;
    const double rows =
        static_cast<double>(file_.rows) * (1.0 - fixes.repeated);
    const double used = std::clamp(rows, 1.0, 1.0 + stamps()->span);
    ColumnLines::AddLine({"  h", "{constant: 0 m}", "the file states none"},
                         found);
    SetLine(
        {"sigma", fmt::format("[3, 3, {:.0f} m]", kKilometre * std::sqrt(used)),
         "usual of a single receiver (a guess); a height that is not "
         "known, to a kilometre by all fixes together"},
        &found->lines);
    found->sigmas = true;
  }

  const std::vector<double>& Values(int column) const {
    return file_.columns[static_cast<std::size_t>(column)].values;
  }
  double MedianOf(int column) const {
    std::vector<double> present = Values(column);
    std::erase_if(present, [](double x) { return std::isnan(x); });
    return Median(std::move(present));
  }

  /// A column of standard deviations, or -1 where it is none: receivers write
  /// zero or less for what they do not know.
  int StatedSigma(const std::string& quantity) const {
    const int column = lines_.Titled(quantity);
    if (column < 0) return -1;
    const std::vector<double>& v = Values(column);
    return std::none_of(v.begin(), v.end(), [](double x) { return x <= 0.0; })
               ? column
               : -1;
  }

  ColumnGuess SigmaGuess(int column, Quantity dimension, double factor,
                         const std::string& reason) const {
    const std::string& unit =
        lines_.meanings()[static_cast<std::size_t>(column)].unit;
    const bool known = UnitFactor(unit, dimension).has_value();
    return {column, known ? unit : SiUnit(dimension), factor,
            Certainty::kLikely, reason};
  }

  /// One sigma of all axes, or the accuracies that receivers and phones state.
  void AddAccuracies(FoundStream* found) const {
    constexpr double kAxis = 0.66;  // of a radius of 68 %, circular normal
    const int sigma = StatedSigma("sigma");
    const int radius = sigma >= 0 ? sigma : StatedSigma("accuracy_h");
    if (radius < 0) return;
    const bool is_radius = sigma < 0;
    const double factor = is_radius ? kAxis : 1.0;
    const std::string why =
        is_radius ? "of an axis, where 68 % are within the radius" : "";
    for (const char* name : {"sigma_n", "sigma_e"}) {
      lines_.AddColumn(name, SigmaGuess(radius, Quantity::kLength, factor, why),
                       found);
    }
    const int up = is_radius ? StatedSigma("accuracy_v") : sigma;
    lines_.AddColumn("sigma_d",
                     SigmaGuess(up >= 0 ? up : radius, Quantity::kLength, 1.0,
                                up >= 0 ? "" : "half as much again upwards"),
                     found);
    found->sigmas = true;
    const auto unit = UnitFactor(
        SigmaGuess(radius, Quantity::kLength, 1.0, "").unit, Quantity::kLength);
    SetGrossNoise(*unit * factor * MedianOf(radius), found);
  }

  void AddSpeedAccuracy(FoundStream* found) const {
    const int column = StatedSigma("accuracy_speed");
    if (found->sigmas || column < 0) return;
    for (const char* name : {"sigma_v_n", "sigma_v_e", "sigma_v_d"}) {
      lines_.AddColumn(name, SigmaGuess(column, Quantity::kSpeed, 1.0, ""),
                       found);
    }
    found->sigmas = true;
  }

  /// Errors of a receiver on its own last for many seconds.
  static void SetGrossNoise(double sigma, FoundStream* found) {
    constexpr double kFine = 0.3;  // m
    if (!(sigma > kFine)) return;
    SetLine(SlowFixNoise(sigma, 0.1 * sigma,
                         "the file's median sigma; errors of a receiver on "
                         "its own last (a guess)"),
            &found->lines);
  }

  /// A barometer's: heights that no place stands beside, in no file of a DVL or
  /// sonar, whose altitude is above the ground.
  void AddHeights() {
    const bool placed = IsNamed({"dvl", "sonar", "altimeter", "adcp"}) ||
                        lines_.HasAll({"v_x", "v_y", "v_z"}) ||
                        lines_.Titled("lat") >= 0 ||
                        lines_.HasAll({"p_x", "p_y"}) ||
                        lines_.HasAll({"roll", "pitch", "heading"});
    if (!placed && !ImuHere()) AddTitled(HeightKind(), {"h"}, {});
  }

  void AddOdometer() {
    const bool vehicle =
        IsNamed({"can", "odometer", "odo", "speed", "wheel", "vehicle"});
    const bool of_fixes =
        lines_.Titled("lat") >= 0 || lines_.Titled("course") >= 0;
    if (of_fixes || named_truth_) return;
    if (lines_.Titled("wheel_rate") >= 0 && !ImuHere()) {
      AddWheelRate();
    } else if (vehicle && lines_.Titled("speed") >= 0) {
      AddTitled(OdometerKind(), {"speed"}, {});
      const int column = lines_.Titled("speed");
      const auto& meaning = lines_.meanings()[static_cast<std::size_t>(column)];
      all_.back().speed_unit_told =
          UnitFactor(meaning.unit, Quantity::kSpeed).has_value();
    }
  }

  /// The rate of a wheel times a usual radius.
  void AddWheelRate() {
    const int column = lines_.Titled("wheel_rate");
    const std::string& unit =
        lines_.meanings()[static_cast<std::size_t>(column)].unit;
    constexpr double kRpm = 2.0 * kPi / 60.0;  // rad/s
    const auto stated = UnitFactor(unit, Quantity::kAngularRate);
    FoundStream found = lines_.Stream();
    found.kinds = {&OdometerKind()};
    found.wheel_rate = true;
    ColumnLines::AddLine(
        {"  speed",
         fmt::format("{{column: {}, unit: m/s, scale: {:.6g}}}", column + 1,
                     kUsualWheelRadius * stated.value_or(kRpm)),
         fmt::format("{} times a radius of {:g} m (a guess)",
                     stated ? "its rate" : "turns a minute",
                     kUsualWheelRadius)},
        &found);
    all_.push_back(std::move(found));
  }

  /// All that a reference may say.
  void AddTruth(bool named) {
    if (!stamps()) return;
    const bool attitude = lines_.HasAll({"roll", "pitch", "heading"}) ||
                          lines_.HasAll({"q_w", "q_x", "q_y", "q_z"});
    const bool place = lines_.HasAll({"lat", "lon", "h"});
    const bool local = lines_.HasAll({"p_x", "p_y", "p_z"});
    if (named ? !attitude && !place && !local : !attitude) return;
    FoundStream found = lines_.Stream();
    found.truth = named;
    found.pose = !named;
    AddTruthColumns(place, local, attitude, &found);
    all_.push_back(std::move(found));
  }

  void AddTruthColumns(bool place, bool local, bool attitude,
                       FoundStream* found) const {
    const auto add = [&](const Names& names, Quantity dimension) {
      if (!lines_.HasAll(names)) return;
      for (const std::string& name : names) {
        lines_.AddTitledColumn(name, dimension, found);
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
    if (lines_.HasAll({"roll", "pitch", "heading"})) {
      add({"roll", "pitch", "heading"}, Quantity::kAngle);
    } else {
      add({"q_w", "q_x", "q_y", "q_z"}, Quantity::kRatio);
    }
  }

  /// Whether places along axes are as far from their origin as the ground is from
  /// the Earth's centre.
  bool AreEarthCentred() const {
    constexpr double kNearSurface = 6.2e6;
    constexpr double kFarthest = 7e6;
    double squares = 0.0;
    for (const char* name : {"p_x", "p_y", "p_z"}) {
      squares += std::pow(Values(lines_.Titled(name)).front(), 2);
    }
    return std::sqrt(squares) > kNearSurface && std::sqrt(squares) < kFarthest;
  }

  /// Earth-centred by its size, else local axes.
  void SetFrame(FoundStream* found) const {
    if (AreEarthCentred()) {
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

  const FileColumns& file_;
  const RecogniseHints& hints_;
  ColumnLines lines_;
  Names words_;
  bool named_truth_;
  std::vector<FoundStream> all_;
};

}  // namespace

std::vector<FoundStream> RecogniseColumns(const FileColumns& file,
                                          const std::string& name,
                                          const RecogniseHints& hints) {
  return Recogniser(file, name, hints).Recognise();
}

}  // namespace hindsight
