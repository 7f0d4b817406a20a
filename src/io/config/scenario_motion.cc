#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "io/config/scenario_config.h"
#include "io/config/scenario_keys.h"
#include "simulation/wandering_drive.h"

namespace hindsight {
namespace {

constexpr std::size_t kMostSegments = 100000;

/// The rate itself, or that which makes the change in `duration`, blends
/// included.
double ReadRate(ConfigMap* map, double change, double blend,
                Quantity quantity) {
  if (map->Has("rate") || !map->Has("duration")) {
    return map->Positive("rate", quantity);
  }
  const double plateau = map->Positive("duration", Quantity::kTime) - blend;
  if (plateau <= 0.0) map->Fail("duration", "expected longer than blend");
  return std::abs(change) / plateau;
}

/// At the bank that goes with the speed, for `duration`.
Segment ReadBankedTurn(ConfigMap* map, double speed, double blend) {
  const double bank = map->Number("bank", Quantity::kAngle);
  const double plateau = map->Positive("duration", Quantity::kTime) - blend;
  if (plateau <= 0.0) map->Fail("duration", "expected longer than blend");
  if (!(std::abs(bank) < 0.5 * kPi) || bank == 0.0 || speed <= 0.0) {
    map->Fail("bank", "expected less than 90 deg to either side, in motion");
  }
  const double rate = kStandardGravity * std::tan(std::abs(bank)) / speed;
  return Segment::BankedTurn(std::copysign(rate * plateau, bank), rate);
}

Segment ReadSegment(std::size_t type, double speed, ConfigMap* map) {
  constexpr double kUsualDeceleration = 2.0;
  const double blend = map->Number("blend", Quantity::kTime, Segment{}.blend);
  Segment s;
  if (type == 0) {
    s = Segment::Straight(map->Positive("duration", Quantity::kTime));
  } else if (type == 1) {
    s = Segment::Stop(map->Positive("duration", Quantity::kTime),
                      map->Positive("deceleration", Quantity::kAcceleration,
                                    kUsualDeceleration));
  } else if (type == 2) {
    const double to = map->Number("speed", Quantity::kSpeed);
    s = Segment::Accelerate(
        to, ReadRate(map, to - speed, blend, Quantity::kAcceleration));
  } else if (map->Has("bank") && type == 3) {
    s = ReadBankedTurn(map, speed, blend);
  } else {
    const double angle = map->Number("angle", Quantity::kAngle);
    const double rate = ReadRate(map, angle, blend, Quantity::kAngularRate);
    s = type == 3 ? Segment::Turn(angle, rate) : Segment::Pitch(angle, rate);
    if (type == 3) s.banked = map->Flag("banked", false);
  }
  s.blend = blend;
  return s;
}

/// Appends the list under `segments`; `speed` is that at its begin and then at
/// its end.
void AppendSegments(ConfigMap* parent, double* speed,
                    std::vector<Segment>* segments) {
  for (ConfigMap& map : parent->Maps("segments")) {
    const std::size_t type = map.Choice(
        "type", {"straight", "stop", "accelerate", "turn", "pitch", "repeat"},
        std::nullopt);
    if (segments->size() >= kMostSegments) {
      map.Fail("type", "expected at most 100000 segments");
    }
    if (type == 5) {
      const int times = map.Integer("times", 1);
      for (int i = 0; i < times; ++i) {
        const std::size_t before = segments->size();
        AppendSegments(&map, speed, segments);
        if (segments->size() == before) map.Fail("segments", "is missing");
      }
    } else {
      segments->push_back(ReadSegment(type, *speed, &map));
      const Segment& s = segments->back();
      if (s.kind == Segment::Kind::kAccelerate) *speed = s.speed;
      if (s.kind == Segment::Kind::kStop) *speed = 0.0;
    }
    map.Finish();
  }
}

void ReadSegments(ConfigMap* top, Scenario* scenario) {
  if (!top->Has("segments")) {
    top->Fail(
        "segments",
        "is missing; expected segments, wander, way_points, hand or profile");
  }
  double speed = scenario->start_speed;
  AppendSegments(top, &speed, &scenario->segments);
  try {
    MotionProfile(scenario->segments, scenario->start_speed,
                  scenario->start_heading);
  } catch (const InputError& error) {
    top->Fail("segments", error.what());
  }
}

double ReadDuration(ConfigMap* map) {
  const double duration = map->Positive("duration", Quantity::kTime);
  if (duration > kLongestScenario) {
    map->Fail("duration", "expected at most 31 days");
  }
  return duration;
}

/// A motion that is drawn: how long it lasts, and from what.
struct DrawnMotion {
  double duration = 0.0;  ///< [s]
  std::uint64_t seed = 1;
};

DrawnMotion ReadDrawnMotion(ConfigMap* map) {
  const int seed = map->Integer("seed", 1);
  if (seed < 0) map->Fail("seed", "must not be negative");
  const double duration = ReadDuration(map);
  map->Finish();
  return {duration, static_cast<std::uint64_t>(seed)};
}

void ReadWander(ConfigMap* top, Scenario* scenario) {
  ConfigMap map = top->Map("wander");
  const DrawnMotion drawn = ReadDrawnMotion(&map);
  scenario->segments = WanderingDrive(drawn.duration, drawn.seed);
  scenario->duration = drawn.duration;
}

void ReadHand(ConfigMap* top, Scenario* scenario) {
  ConfigMap map = top->Map("hand");
  const DrawnMotion drawn = ReadDrawnMotion(&map);
  if (drawn.duration < kShortestHandMotion) {
    map.Fail("duration",
             "expected at least 30 s, of which the first and the "
             "last 10 s are at rest");
  }
  scenario->hand = {drawn.duration, drawn.seed};
}

void ReadWayPoints(ConfigMap* top, Scenario* scenario) {
  ConfigMap map = top->Map("way_points");
  WayPoints& way = scenario->way_points;
  way.duration = ReadDuration(&map);
  const std::vector<double> north = map.Numbers("north", Quantity::kLength);
  const std::vector<double> east = map.Numbers("east", Quantity::kLength);
  const std::vector<double> down = map.Numbers("down", Quantity::kLength);
  if (north.size() < 5 || east.size() != north.size() ||
      down.size() != north.size()) {
    map.Fail("north", "expected five or more, and as many of east and down");
  }
  for (std::size_t i = 0; i < north.size(); ++i) {
    way.points.emplace_back(north[i], east[i], down[i]);
  }
  map.Finish();
}

const ConfigTable<Scenario>& StartTable() {
  using Key = ConfigKey<Scenario>;
  static const ConfigTable<Scenario> kTable = {
      "scenario: start",
      "Needed without a profile.",
      {{.name = "position",
        .value = Key::Special{[](ConfigMap* map, Scenario* scenario) {
          const auto position = ReadGeodetic(map, "position");
          if (!position) map->Fail("position", "is missing");
          scenario->start = *position;
        }},
        .help = "[lat, lon, h]",
        .needed = true},
       {.name = "heading",
        .quantity = Quantity::kAngle,
        .value = Key::Number{&Scenario::start_heading},
        .help = "of the vehicle and of its motion"},
       {.name = "speed",
        .quantity = Quantity::kSpeed,
        .value = Key::Number{&Scenario::start_speed}}}};
  return kTable;
}

}  // namespace

void ReadMotion(ConfigMap* top, Scenario* scenario) {
  std::string given;
  for (const char* key :
       {"profile", "wander", "way_points", "hand", "segments"}) {
    if (!top->Has(key)) continue;
    if (!given.empty())
      top->Fail(given, "does not go with " + std::string(key));
    given = key;
  }
  if (given == "profile") {
    if (top->Has("start")) top->Fail("start", "does not go with profile");
    const auto folder = std::filesystem::path(top->file()).parent_path();
    scenario->profile =
        ReadMotionProfile((folder / top->Text("profile")).string());
    return;
  }
  ConfigMap start = top->Map("start");
  if (given == "hand" && start.Has("speed")) {
    start.Fail("speed", "does not go with hand, which begins at rest");
  }
  ReadTable(StartTable(), &start, scenario);
  start.Finish();
  if (given == "wander") {
    ReadWander(top, scenario);
  } else if (given == "way_points") {
    ReadWayPoints(top, scenario);
  } else if (given == "hand") {
    ReadHand(top, scenario);
  } else {
    ReadSegments(top, scenario);
  }
}

std::vector<KeySection> MotionSections() {
  return {
      Documented(StartTable()),
      {"scenario: segment",
       "A manoeuvre, or a list of them that is repeated.",
       {{"type", "straight, stop, accelerate, turn, pitch, repeat", "needed"},
        {"duration",
         "of what is held (standing, of stop); of other types in place of "
         "rate, blends included",
         "needed", "type straight, stop, or bank"},
        {"deceleration", "of the braking before", "2 m/s^2", "type stop"},
        {"speed", "to reach", "needed", "type accelerate"},
        {"angle", "right or up is positive", "needed", "type turn, pitch"},
        {"rate", "of speed, heading or pitch", "needed",
         "type accelerate, turn, pitch"},
        {"banked", "tan(roll) = speed rate / g", "false", "type turn"},
        {"bank",
         "roll of a banked turn, right is positive, instead of angle "
         "and rate",
         "-", "type turn"},
        {"blend", "time in which its rate rises and falls", "1 s"},
        {"times", "how often", "1", "type repeat"},
        {"segments", "of one time", "needed", "type repeat"}}},
      {"scenario: wander",
       "A drawn route of a car.",
       {{"duration", "of the drive", "needed"}, {"seed", "of the route", "1"}}},
      {"scenario: way_points",
       "The cubic spline through five points or more, equally spaced in time, "
       "at rest vertically at both ends. The vehicle looks along its velocity "
       "and does not roll.",
       {{"duration", "from the first to the last", "needed"},
        {"north", "list, from the start", "needed"},
        {"east", "list, from the start", "needed"},
        {"down", "list, from the start", "needed"}}},
      {"scenario: hand",
       "A drawn motion of a sensor held in a hand, from rest to rest: turning "
       "and moved to and fro, as the hands of the BROAD recordings.",
       {{"duration", "at least 30 s; the first and the last 10 s are at rest",
         "needed"},
        {"seed", "of the motion", "1"}}}};
}

}  // namespace hindsight
