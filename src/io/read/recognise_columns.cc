#include "io/read/recognise_columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "base/units.h"
#include "io/read/column_choice.h"
#include "io/read/column_lines.h"
#include "io/read/fix_guess.h"
#include "io/read/fix_lines.h"
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
        fix_lines_(file, lines_),
        words_(SplitWords(name)),
        named_truth_(IsNamedTruth(name)) {
    if (IsNamed({"v", "vel", "velocity", "velocities"}) && !named_truth_) {
      lines_.TakeForVelocities();
    }
    if (IsNamed({"dvl", "adcp"}) && !named_truth_) lines_.TakeForDvl();
    const std::string half = HalfOfName(name);
    if (!half.empty()) lines_.TakeAxesFor(half);
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
    if (guess->field) {
      const bool earth = lines_.IsOfEarth(*guess->field);
      TripleGuess field;
      field.columns = *guess->field;
      lines_.Take(earth ? "mag_" : "field_", field);
    }
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
    if (lines_.HasAll({"lat", "lon"})) placed = fix_lines_.RowsWithPlaces();
    const auto fixes =
        GuessFixes(placed ? *placed : file_, lines_.meanings(), *stamps());
    // Places beside attitudes are another solution's, no sensor's.
    const bool solution =
        !ImuHere() && lines_.HasAll({"roll", "pitch", "heading"});
    const bool told =
        fixes && (fixes->h.column >= 0 || fixes->place_order_told);
    if (told && !solution) all_.push_back(fix_lines_.Position(*fixes));
    auto utm = fixes ? std::nullopt : fix_lines_.Utm();
    if (utm && !solution) {
      all_.push_back(std::move(*utm));
    } else if (!fixes && !solution) {
      ColumnLines axes = lines_;
      if (!lines_.HasAll({"p_x", "p_y", "p_z"})) axes.TakeAxesFor("p_");
      if (auto found = FixLines(file_, axes).EarthCentred()) {
        all_.push_back(std::move(*found));
      }
    }
    const Names velocity = {"v_n", "v_e", "v_d"};
    if (lines_.HasAll(velocity) && !solution) {
      AddTitled(VelocityKind(), velocity,
                {"sigma_v_n", "sigma_v_e", "sigma_v_d"});
      fix_lines_.AddSpeedAccuracy(&all_.back());
    } else if (fixes && fixes->speed && fixes->course && !solution) {
      FoundStream found = lines_.Stream();
      found.kinds = {&SpeedCourseKind()};
      lines_.AddColumn("speed", *fixes->speed, &found);
      lines_.AddColumn("course", *fixes->course, &found);
      all_.push_back(std::move(found));
    }
  }

  bool ImuHere() const {
    return std::any_of(all_.begin(), all_.end(),
                       [](const FoundStream& found) { return found.imu; });
  }

  /// A barometer's: heights that no place stands beside, in no file of a DVL or
  /// sonar, whose altitude is above the ground.
  void AddHeights() {
    const bool placed = IsNamed({"dvl", "sonar", "altimeter", "adcp"}) ||
                        lines_.HasAll({"v_x", "v_y", "v_z"}) ||
                        lines_.Titled("lat") >= 0 ||
                        lines_.HasAll({"easting", "northing"}) ||
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
      fix_lines_.SetFrame(found);
    }
    add({"v_n", "v_e", "v_d"}, Quantity::kSpeed);
    if (!attitude) return;
    if (lines_.HasAll({"roll", "pitch", "heading"})) {
      add({"roll", "pitch", "heading"}, Quantity::kAngle);
    } else {
      add({"q_w", "q_x", "q_y", "q_z"}, Quantity::kRatio);
    }
  }

  const FileColumns& file_;
  const RecogniseHints& hints_;
  ColumnLines lines_;
  FixLines fix_lines_;
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
