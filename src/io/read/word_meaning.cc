#include "io/read/word_meaning.h"

#include <algorithm>
#include <string_view>

#include "io/read/title_words.h"

namespace hindsight {
namespace {

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
  const bool named = HasAnyWord(words, full) || HasAnyWord(words, letters);
  if (!named) return '\0';
  for (const std::string& word : words) {
    if (word.size() == 1 && word >= "x" && word <= "z") return word[0];
  }
  return '\0';
}

/// North, east, down or up.
char DirectionOf(const Words& words) {
  if (HasAnyWord(words, {"n", "north"})) return 'n';
  if (HasAnyWord(words, {"e", "east"})) return 'e';
  if (HasAnyWord(words, {"d", "down"})) return 'd';
  if (HasAnyWord(words, {"u", "up"})) return 'u';
  return '\0';
}

ColumnMeaning Component(const std::string& family, char direction) {
  const bool up = direction == 'u';
  return {family + (up ? 'd' : direction), "", up};
}

bool IsOfHeight(const Words& words) {
  return HasAnyWord(words, {"h", "height", "alt", "altitude", "elevation"});
}

ColumnMeaning Sigma(const Words& words) {
  char direction = DirectionOf(words);
  if (direction == '\0') direction = AxisWithin(words, "nedu", {"sd", "std"});
  if (direction == '\0' && HasAnyWord(words, {"lat", "latitude"}))
    direction = 'n';
  if (direction == '\0' && HasAnyWord(words, {"lon", "longitude"}))
    direction = 'e';
  if (direction == '\0' && IsOfHeight(words)) direction = 'd';
  if (direction == '\0') {
    const bool of_place = words.size() == 1 ||
                          HasAnyWord(words, {"pos", "position", "gps", "gnss"});
    return of_place ? ColumnMeaning{"sigma", ""} : ColumnMeaning{};
  }
  if (direction == 'u') direction = 'd';
  const bool speed = HasAnyWord(words, {"v", "vel", "velocity"});
  return {std::string(speed ? "sigma_v_" : "sigma_") + direction, ""};
}

/// What a receiver thinks of its own fix: "hAcc", "vertical accuracy", "eph".
ColumnMeaning Accuracy(const Words& words) {
  const bool named = HasAnyWord(words, {"accuracy", "uncertainty"});
  const bool of = named || HasAnyWord(words, {"acc"});
  const auto is = [&](std::initializer_list<std::string_view> fused,
                      std::initializer_list<std::string_view> beside) {
    return HasAnyWord(words, fused) || (of && HasAnyWord(words, beside));
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
      HasAnyWord(words, {"gps", "gnss", "pos", "position", "location"});
  return named && plain ? ColumnMeaning{"accuracy_h", ""} : ColumnMeaning{};
}

/// How fast a wheel turns: "rpm", "wheel_rate", "wheel speed [rad/s]" (by its unit).
bool IsWheelRate(const Words& words) {
  return HasAnyWord(words, {"rpm"}) ||
         (HasAnyWord(words, {"wheel"}) &&
          HasAnyWord(words, {"rate", "omega", "rot", "rotation"}));
}

/// "Roll rate" about x, "yaw rate" about z; '\0' of another.
char AxisOfRate(const Words& words) {
  if (!HasAnyWord(words, {"rate", "rates", "speed", "vel", "velocity"}))
    return '\0';
  if (HasAnyWord(words, {"roll"})) return 'x';
  if (HasAnyWord(words, {"pitch"})) return 'y';
  return HasAnyWord(words, {"yaw"}) ? 'z' : '\0';
}

ColumnMeaning Attitude(const Words& words) {
  if (const char axis = AxisOfRate(words)) {
    return {std::string("gyro_") + axis, ""};
  }
  for (const char part : {'w', 'x', 'y', 'z'}) {
    const std::string fused = std::string("q") + part;
    const std::string alone(1, part);
    const bool quaternion =
        HasAnyWord(words, {"q", "quat", "quaternion", "orientation"});
    if (HasAnyWord(words, {fused}) ||
        (quaternion && HasAnyWord(words, {alone}))) {
      return {std::string("q_") + part, ""};
    }
  }
  const bool euler = HasAnyWord(words, {"euler"});
  if (HasAnyWord(words, {"roll"}) || (euler && HasAnyWord(words, {"x"}))) {
    return {"roll", ""};
  }
  if (HasAnyWord(words, {"pitch"}) || (euler && HasAnyWord(words, {"y"}))) {
    return {"pitch", ""};
  }
  if (HasAnyWord(words, {"yaw", "heading"}) ||
      (euler && HasAnyWord(words, {"z"}))) {
    return {"heading", ""};
  }
  return {};
}

ColumnMeaning Velocity(const Words& words) {
  if (const char direction = AxisWithin(words, "nedu", {"v", "vel"})) {
    return Component("v_", direction);
  }
  const bool named = HasAnyWord(words, {"v", "vel", "velocity"});
  if (named && DirectionOf(words) != '\0') {
    return Component("v_", DirectionOf(words));
  }
  if (HasAnyWord(words, {"dvl"})) {
    if (HasAnyWord(words, {"forward", "fwd", "surge"})) return {"v_x", ""};
    if (HasAnyWord(words, {"starboard", "stbd", "sway"})) return {"v_y", ""};
    if (HasAnyWord(words, {"heave"})) return {"v_z", ""};
    if (const char axis = AxisOf(words, {"dvl", "v", "vel"}, {})) {
      return {std::string("v_") + axis, ""};
    }
  }
  if (HasAnyWord(words, {"speed", "spd", "sog", "velocity"}))
    return {"speed", ""};
  if (HasAnyWord(words, {"course", "cog", "track", "bearing"})) {
    return {"course", ""};
  }
  return {};
}

ColumnMeaning Place(const Words& words) {
  if (HasAnyWord(words, {"easting", "eastings"})) return {"easting", ""};
  if (HasAnyWord(words, {"northing", "northings"})) return {"northing", ""};
  if (HasAnyWord(words, {"utm"})) {
    if (HasAnyWord(words, {"e", "east", "x"})) return {"easting", ""};
    if (HasAnyWord(words, {"n", "north", "y"})) return {"northing", ""};
    if (HasAnyWord(words, {"zone"})) return {"zone", ""};
  }
  // Above the ground, which is no height.
  if (IsOfHeight(words) &&
      HasAnyWord(words, {"agl", "terrain", "ground", "laser", "lidar", "sonar",
                         "radar", "rangefinder"})) {
    return {};
  }
  if (HasAnyWord(words, {"lat", "latit", "latitude"})) return {"lat", ""};
  if (HasAnyWord(words, {"lon", "long", "longit", "lng", "longitude"}))
    return {"lon", ""};
  if (HasAnyWord(words, {"depth"})) return {"depth", ""};
  if (IsOfHeight(words)) {
    return {"h", ""};
  }
  if (const char axis =
          AxisOf(words, {"p", "pos", "position", "positions", "ecef"}, {})) {
    return {std::string("p_") + axis, ""};
  }
  const char direction = DirectionOf(words);
  const bool alone = words.size() == 1 || HasAnyWord(words, {"p", "pos"});
  if (direction != '\0' && alone) {
    const bool up = direction == 'u';
    const char axis = direction == 'n' ? 'x' : direction == 'e' ? 'y' : 'z';
    return {std::string("p_") + axis, "", up};
  }
  return {};
}

ColumnMeaning Other(const Words& words) {
  if (HasAnyWord(words, {"zupt", "stance"}) ||
      (HasAnyWord(words, {"zero"}) && HasAnyWord(words, {"vel", "velocity"}))) {
    return {"zero_velocity", ""};
  }
  if (HasAnyWord(words, {"week", "weeks", "wk", "gwk", "wn"}) &&
      !HasAnyWord(words, {"t", "time", "seconds", "sec", "s", "sow", "tow"})) {
    return {"week", ""};
  }
  if (HasAnyWord(words, {"index", "counter", "packet", "row", "id"})) {
    return {"index", ""};
  }
  if (HasAnyWord(words, {"fix", "quality", "mode"})) return {"quality", ""};
  if (HasAnyWord(words, {"movement", "moving"})) return {"moving", ""};
  if (HasAnyWord(words,
                 {"t", "time", "times", "timestamp", "stamp", "seconds", "sec",
                  "tow", "sow", "utc", "sample", "when", "realtime"})) {
    return {"t", ""};
  }
  return {};
}

}  // namespace

ColumnMeaning MeaningOfWords(const Words& words) {
  if (ColumnMeaning meaning = Accuracy(words); !meaning.quantity.empty()) {
    return meaning;
  }
  if (HasAnyWord(words, {"bias", "drift", "accuracy", "temp", "temperature",
                         "distance", "gdop", "pdop", "hdop", "covariance",
                         "variance"})) {
    return {};
  }
  if (HasAnyWord(words, {"std", "sd", "sigma", "stdev", "stddev", "sdn", "sde",
                         "sdu", "sdd"})) {
    return Sigma(words);
  }
  // Counters of time are told before times.
  if (HasAnyWord(words, {"index", "counter", "zero"})) return Other(words);
  if (IsWheelRate(words)) return {"wheel_rate", ""};
  for (const auto reading :
       {Attitude, InertialMeaning, Velocity, Place, Other}) {
    if (ColumnMeaning meaning = reading(words); !meaning.quantity.empty()) {
      return meaning;
    }
  }
  return {};
}

ColumnMeaning InertialMeaning(const Words& words) {
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

bool IsOfTime(const Words& words) { return Other(words).quantity == "t"; }

}  // namespace hindsight
