#include "io/read/column_meaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "io/read/file_formats.h"
#include "io/read/title_words.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

using Words = std::vector<std::string>;

bool HasAny(const Words& words, std::initializer_list<std::string_view> names) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(names.begin(), names.end(), word) != names.end();
  });
}

/// The last letter of a word that is one of `names` without it: 'x' of "gyrox".
char AxisWithin(const Words& words, std::string_view axes,
                std::initializer_list<std::string_view> names) {
  for (const std::string& word : words) {
    if (word.size() < 2 || axes.find(word.back()) == axes.npos) continue;
    const std::string_view head(word.data(), word.size() - 1);
    if (std::find(names.begin(), names.end(), head) != names.end()) {
      return word.back();
    }
  }
  return '\0';
}

/// x, y or z as a word of its own, or as the end of one of `names`.
char AxisOf(const Words& words, std::initializer_list<std::string_view> full,
            std::initializer_list<std::string_view> letters) {
  if (const char axis = AxisWithin(words, "xyz", full)) return axis;
  if (const char axis = AxisWithin(words, "xyz", letters)) return axis;
  const bool named = HasAny(words, full) || HasAny(words, letters);
  if (!named) return '\0';
  for (const std::string& word : words) {
    if (word.size() == 1 && word >= "x" && word <= "z") return word[0];
  }
  return '\0';
}

/// North, east, down or up.
char DirectionOf(const Words& words) {
  if (HasAny(words, {"n", "north"})) return 'n';
  if (HasAny(words, {"e", "east"})) return 'e';
  if (HasAny(words, {"d", "down"})) return 'd';
  if (HasAny(words, {"u", "up"})) return 'u';
  return '\0';
}

ColumnMeaning Component(const std::string& family, char direction) {
  const bool up = direction == 'u';
  return {family + (up ? 'd' : direction), "", up};
}

bool IsOfHeight(const Words& words) {
  return HasAny(words, {"h", "height", "alt", "altitude", "elevation"});
}

ColumnMeaning Sigma(const Words& words) {
  char direction = DirectionOf(words);
  if (direction == '\0') direction = AxisWithin(words, "nedu", {"sd", "std"});
  if (direction == '\0' && HasAny(words, {"lat", "latitude"})) direction = 'n';
  if (direction == '\0' && HasAny(words, {"lon", "longitude"})) direction = 'e';
  if (direction == '\0' && IsOfHeight(words)) direction = 'd';
  if (direction == '\0') {
    const bool of_place =
        words.size() == 1 || HasAny(words, {"pos", "position", "gps", "gnss"});
    return of_place ? ColumnMeaning{"sigma", ""} : ColumnMeaning{};
  }
  if (direction == 'u') direction = 'd';
  const bool speed = HasAny(words, {"v", "vel", "velocity"});
  return {std::string(speed ? "sigma_v_" : "sigma_") + direction, ""};
}

/// What a receiver thinks of its own fix: "hAcc", "vertical accuracy", "eph".
ColumnMeaning Accuracy(const Words& words) {
  const bool named = HasAny(words, {"accuracy", "uncertainty"});
  const bool of = named || HasAny(words, {"acc"});
  const auto is = [&](std::initializer_list<std::string_view> fused,
                      std::initializer_list<std::string_view> beside) {
    return HasAny(words, fused) || (of && HasAny(words, beside));
  };
  if (is({"hacc", "eph"}, {"h", "hor", "horizontal"})) {
    return {"accuracy_h", ""};
  }
  if (is({"vacc", "epv"}, {"v", "vert", "vertical"})) {
    return {"accuracy_v", ""};
  }
  if (is({"sacc"}, {"s", "speed", "velocity"})) return {"accuracy_speed", ""};
  const bool plain =
      words.size() == 1 ||
      HasAny(words, {"gps", "gnss", "pos", "position", "location"});
  return named && plain ? ColumnMeaning{"accuracy_h", ""} : ColumnMeaning{};
}

ColumnMeaning Inertial(const Words& words) {
  if (const char axis = AxisOf(words,
                               {"acc", "accel", "accelerometer", "acceleration",
                                "accelerations", "gforce"},
                               {"a", "f"})) {
    return {std::string("accel_") + axis, ""};
  }
  if (const char axis = AxisOf(
          words, {"gyr", "gyro", "gyroscope", "omega", "angvel", "angular"},
          {"g", "w"})) {
    return {std::string("gyro_") + axis, ""};
  }
  if (const char axis =
          AxisOf(words, {"mag", "magn", "magnetometer", "magnetic"}, {"m"})) {
    return {std::string("mag_") + axis, ""};
  }
  return {};
}

/// "Roll rate" about x, "yaw rate" about z; '\0' of another.
char AxisOfRate(const Words& words) {
  if (!HasAny(words, {"rate", "rates", "speed", "velocity"})) return '\0';
  if (HasAny(words, {"roll"})) return 'x';
  if (HasAny(words, {"pitch"})) return 'y';
  return HasAny(words, {"yaw"}) ? 'z' : '\0';
}

ColumnMeaning Attitude(const Words& words) {
  if (const char axis = AxisOfRate(words)) {
    return {std::string("gyro_") + axis, ""};
  }
  for (const char part : {'w', 'x', 'y', 'z'}) {
    const std::string fused = std::string("q") + part;
    const std::string alone(1, part);
    const bool quaternion =
        HasAny(words, {"q", "quat", "quaternion", "orientation"});
    if (HasAny(words, {fused}) || (quaternion && HasAny(words, {alone}))) {
      return {std::string("q_") + part, ""};
    }
  }
  const bool euler = HasAny(words, {"euler"});
  if (HasAny(words, {"roll"}) || (euler && HasAny(words, {"x"}))) {
    return {"roll", ""};
  }
  if (HasAny(words, {"pitch"}) || (euler && HasAny(words, {"y"}))) {
    return {"pitch", ""};
  }
  if (HasAny(words, {"yaw", "heading"}) || (euler && HasAny(words, {"z"}))) {
    return {"heading", ""};
  }
  return {};
}

ColumnMeaning Velocity(const Words& words) {
  if (const char direction = AxisWithin(words, "nedu", {"v", "vel"})) {
    return Component("v_", direction);
  }
  const bool named = HasAny(words, {"v", "vel", "velocity"});
  if (named && DirectionOf(words) != '\0') {
    return Component("v_", DirectionOf(words));
  }
  if (HasAny(words, {"dvl"})) {
    if (const char axis = AxisOf(words, {"dvl", "v", "vel"}, {})) {
      return {std::string("v_") + axis, ""};
    }
  }
  if (HasAny(words, {"speed", "spd", "sog", "velocity"})) return {"speed", ""};
  if (HasAny(words, {"course", "cog", "track", "bearing"})) {
    return {"course", ""};
  }
  return {};
}

ColumnMeaning Place(const Words& words) {
  if (HasAny(words, {"lat", "latitude"})) return {"lat", ""};
  if (HasAny(words, {"lon", "long", "lng", "longitude"})) return {"lon", ""};
  if (HasAny(words, {"depth"})) return {"depth", ""};
  if (IsOfHeight(words)) {
    return {"h", ""};
  }
  if (const char axis =
          AxisOf(words, {"p", "pos", "position", "positions"}, {})) {
    return {std::string("p_") + axis, ""};
  }
  const char direction = DirectionOf(words);
  const bool alone = words.size() == 1 || HasAny(words, {"p", "pos"});
  if (direction != '\0' && alone) {
    const bool up = direction == 'u';
    const char axis = direction == 'n' ? 'x' : direction == 'e' ? 'y' : 'z';
    return {std::string("p_") + axis, "", up};
  }
  return {};
}

ColumnMeaning Other(const Words& words) {
  if (HasAny(words, {"zupt", "stance"}) ||
      (HasAny(words, {"zero"}) && HasAny(words, {"vel", "velocity"}))) {
    return {"zero_velocity", ""};
  }
  if (HasAny(words, {"index", "counter", "packet", "row", "id"})) {
    return {"index", ""};
  }
  if (HasAny(words, {"fix", "quality", "mode"})) return {"quality", ""};
  if (HasAny(words, {"movement", "moving"})) return {"moving", ""};
  if (HasAny(words, {"t", "time", "times", "timestamp", "stamp", "seconds",
                     "sec", "tow", "utc", "sample", "when"})) {
    return {"t", ""};
  }
  return {};
}

ColumnMeaning MeaningOfWords(const Words& words) {
  if (ColumnMeaning meaning = Accuracy(words); !meaning.quantity.empty()) {
    return meaning;
  }
  if (HasAny(words, {"bias", "accuracy", "temp", "temperature", "distance",
                     "gdop", "pdop", "hdop", "covariance", "variance"})) {
    return {};
  }
  if (HasAny(words, {"std", "sd", "sigma", "stdev", "stddev", "sdn", "sde",
                     "sdu", "sdd"})) {
    return Sigma(words);
  }
  // Counters of time are told before times.
  if (HasAny(words, {"index", "counter", "zero"})) return Other(words);
  for (const auto reading : {Attitude, Inertial, Velocity, Place, Other}) {
    if (ColumnMeaning meaning = reading(words); !meaning.quantity.empty()) {
      return meaning;
    }
  }
  return {};
}

/// The column of an array in its reference: 2 of "imu_gyr:2"; 0 of one alone.
int ArrayColumn(const std::string& reference) {
  const std::size_t colon = reference.rfind(':');
  return colon == reference.npos ? 0 : std::stoi(reference.substr(colon + 1));
}

ColumnMeaning MeaningInArray(const FileColumn& column) {
  const int number = ArrayColumn(column.reference);
  const std::string array = column.title.substr(column.title.rfind('/') + 1);
  if (Other(SplitWords(array)).quantity == "t") {
    return number == 0 ? ColumnMeaning{"t", ""} : ColumnMeaning{};
  }
  Words words = SplitWords(column.title);
  if (number >= 1 && number <= 4) {
    static constexpr std::array kAxes = {"x", "y", "z"};
    static constexpr std::array kParts = {"w", "x", "y", "z"};
    const bool quaternion =
        HasAny(words, {"quat", "quaternion", "orientation", "orientations"});
    if (quaternion) {
      return {std::string("q_") + kParts[static_cast<std::size_t>(number - 1)],
              ""};
    }
    if (number <= 3) {
      words.emplace_back(kAxes[static_cast<std::size_t>(number - 1)]);
    }
  }
  return MeaningOfWords(words);
}

/// Rows with a value other than that of the row before.
std::size_t ChangesOf(const std::vector<double>& values) {
  std::size_t changes = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::isfinite(values[k]) && values[k] != values[k - 1]) ++changes;
  }
  return changes;
}

/// Of columns that are titled as times the one that is the rows' own: it changes
/// from row to row most often; of equal ones a message's own stamp, before that of
/// its arrival; then the first; and what counts samples only if there is no other.
void KeepOneTime(const FileColumns& file,
                 std::vector<ColumnMeaning>* meanings) {
  ColumnMeaning* kept = nullptr;
  std::pair<std::size_t, int> best;
  for (std::size_t i = 0; i < meanings->size(); ++i) {
    ColumnMeaning& meaning = (*meanings)[i];
    if (meaning.quantity != "t") continue;
    const FileColumn& column = file.columns[i];
    const Words words = SplitWords(column.title);
    const bool own = HasAny(words, {"header"}) && HasAny(words, {"stamp"});
    const bool counts =
        HasAny(words, {"sample"}) && !HasAny(words, {"time", "times"});
    const bool of_day = column.holds == FileColumn::Holds::kTimesOfDay;
    const std::pair<std::size_t, int> here(
        counts || of_day ? 0 : ChangesOf(column.values), own ? 1 : 0);
    if (kept != nullptr && here <= best) {
      meaning = {};
      continue;
    }
    if (kept != nullptr) *kept = {};
    kept = &meaning;
    best = here;
  }
}

bool SaysEllipsoid(const Words& words) {
  return HasAny(words, {"ellipsoid", "ellipsoidal", "ell", "hae", "wgs"});
}
bool SaysSea(const Words& words) {
  return HasAny(words, {"msl", "amsl", "sea"});
}

/// How likely a place or height is a receiver's own, by the words of its title:
/// neither another estimate nor a place to go to, and above the ellipsoid rather
/// than above the sea or the ground.
int RankOfPlace(const FileColumn& column) {
  const Words words = SplitWords(column.title);
  int rank = 0;
  if (HasAny(words, {"gps", "gnss", "fix", "receiver"})) rank += 2;
  if (HasAny(words, {"ekf", "kf", "fused", "filter", "filtered", "estimate",
                     "estimated", "est", "home", "ref", "reference", "target",
                     "wp", "waypoint", "setpoint", "network", "origin"})) {
    rank -= 8;
  }
  if (HasAny(words, {"baro", "barometer", "barometric", "press", "pressure",
                     "rel", "relative", "agl", "terrain", "ground"})) {
    rank -= 8;
  }
  if (SaysEllipsoid(words)) rank += 4;
  if (SaysSea(words)) rank -= 1;
  if (ChangesOf(column.values) == 0) rank -= 16;
  return rank;
}

/// Of columns of one quantity of a place the likeliest, of equal ones the first.
void KeepOnePlace(const FileColumns& file, std::string_view quantity,
                  std::vector<ColumnMeaning>* meanings) {
  ColumnMeaning* kept = nullptr;
  int best = 0;
  for (std::size_t i = 0; i < meanings->size(); ++i) {
    ColumnMeaning& meaning = (*meanings)[i];
    if (meaning.quantity != quantity) continue;
    const int rank = RankOfPlace(file.columns[i]);
    if (kept != nullptr && rank <= best) {
      meaning = {};
      continue;
    }
    if (kept != nullptr) *kept = {};
    kept = &meaning;
    best = rank;
  }
}

}  // namespace

ColumnMeaning MeaningOfTitle(const std::string& title) {
  std::string text = title;
  std::string unit = TakeBracketedUnit(&text);
  Words words = SplitWords(text);
  constexpr std::string_view kIndices = "012";
  if (unit.size() == 1 && kIndices.find(unit[0]) != kIndices.npos) {
    words.emplace_back(1, static_cast<char>('x' + (unit[0] - '0')));
    return Inertial(words);
  }
  if (unit.empty()) unit = TakeUnitWord(&words);
  ColumnMeaning meaning = MeaningOfWords(words);
  meaning.unit = unit;
  // "Gx [g]" is a force.
  if (meaning.quantity.starts_with("gyro_") &&
      UnitFactor(unit, Quantity::kAcceleration)) {
    meaning.quantity.replace(0, 4, "accel");
  }
  return UnitFactor(unit, Quantity::kSpeed) ? AsVelocity(std::move(meaning))
                                            : meaning;
}

ColumnMeaning AsVelocity(ColumnMeaning meaning) {
  for (const auto& [place, velocity] :
       {std::pair("p_x", "v_n"), {"p_y", "v_e"}, {"p_z", "v_d"}}) {
    if (meaning.quantity == place) {
      meaning.quantity = velocity;
      break;
    }
  }
  return meaning;
}

ColumnMeaning AxisMeaning(const std::string& title, const std::string& family) {
  std::string text = title;
  const std::string unit = TakeBracketedUnit(&text);
  const Words words = SplitWords(text);
  const bool alone =
      words.size() == 1 || (words.size() == 2 && words[1] == "axis");
  const bool axis =
      alone && words[0].size() == 1 && words[0] >= "x" && words[0] <= "z";
  return axis ? ColumnMeaning{family + words[0], unit} : ColumnMeaning{};
}

bool CountsFromSea(const FileColumns& file, int h) {
  const Words words =
      SplitWords(file.columns[static_cast<std::size_t>(h)].title);
  if (SaysEllipsoid(words)) return false;
  return SaysSea(words) ||
         std::any_of(
             file.columns.begin(), file.columns.end(),
             [](const FileColumn& column) {
               return HasAny(SplitWords(column.title), {"undulation", "geoid"});
             });
}

std::vector<ColumnMeaning> ReadMeanings(const FileColumns& file) {
  std::vector<ColumnMeaning> meanings;
  std::set<std::string> taken;
  for (const FileColumn& column : file.columns) {
    ColumnMeaning meaning;
    if (column.holds != FileColumn::Holds::kText) {
      meaning = file.format == &ColumnsFormat() ? MeaningOfTitle(column.title)
                                                : MeaningInArray(column);
    }
    constexpr std::array<std::string_view, 4> kRanked = {"t", "lat", "lon",
                                                         "h"};
    const bool ranked = std::find(kRanked.begin(), kRanked.end(),
                                  meaning.quantity) != kRanked.end();
    if (!meaning.quantity.empty() && !ranked &&
        !taken.insert(meaning.quantity).second) {
      meaning = {};
    }
    meanings.push_back(std::move(meaning));
  }
  KeepOneTime(file, &meanings);
  for (const char* quantity : {"lat", "lon", "h"}) {
    KeepOnePlace(file, quantity, &meanings);
  }
  return meanings;
}

}  // namespace hindsight
