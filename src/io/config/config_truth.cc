#include <cstddef>

#include "io/config/config_key.h"
#include "io/config/config_streams.h"

namespace hindsight {
namespace {

const ConfigTable<TruthConfig>& TruthTable() {
  using Key = ConfigKey<TruthConfig>;
  static const ConfigTable<TruthConfig> kTable = {
      "truth",
      "Besides the keys of a stream; columns of position, velocity, attitude.",
      {{.name = "time_offset",
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          truth->clock_unknown = map->Is("time_offset", "unknown");
          if (truth->clock_unknown) return;
          truth->time_offset = map->Number("time_offset", Quantity::kTime, 0.0);
        }},
        .help = "added to the stamps, or `unknown`: found from the gyros",
        .fallback = "0 s"},
       {.name = "lever_arm",
        .quantity = Quantity::kLength,
        .value = Key::Vector{&TruthConfig::lever_arm_b},
        .help = "of the point it speaks of"},
       {.name = "position_sigma",
        .quantity = Quantity::kLength,
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          truth->sigma.position =
              map->OptionalSigma("position_sigma", Quantity::kLength);
        }},
        .help = "of its own error: north, east, down, or one; normalised "
                "errors count it beside the solution's"},
       {.name = "velocity_sigma",
        .quantity = Quantity::kSpeed,
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          truth->sigma.velocity =
              map->OptionalSigma("velocity_sigma", Quantity::kSpeed);
        }},
        .help = "likewise"},
       {.name = "attitude_sigma",
        .quantity = Quantity::kAngle,
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          truth->sigma.attitude =
              map->OptionalSigma("attitude_sigma", Quantity::kAngle);
        }},
        .help = "likewise of roll, pitch, heading"},
       {.name = "frame",
        .value = Key::Word{{kFrameNames.begin(), kFrameNames.end()},
                           [](const TruthConfig& truth) {
                             return static_cast<std::size_t>(truth.frame.axes);
                           },
                           [](TruthConfig& truth, std::size_t word) {
                             truth.frame.axes = static_cast<FrameAxes>(word);
                           }},
        .help = "of columns p_x, v_x, q_w ..."},
       {.name = "origin",
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          truth->frame.origin = ReadGeodetic(map, "origin");
          if (truth->frame.origin && truth->frame.axes == FrameAxes::kEcef) {
            map->Fail("origin", "does not go with the frame ecef");
          }
        }},
        .help = "[lat, lon, h] of local frames"},
       {.name = "quaternion",
        .value = Key::Word{{"body_to_frame", "frame_to_body"},
                           [](const TruthConfig& truth) {
                             return std::size_t{truth.frame.frame_to_body ? 1U
                                                                          : 0U};
                           },
                           [](TruthConfig& truth, std::size_t word) {
                             truth.frame.frame_to_body = word == 1;
                           }}},
       {.name = "axes",
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          ReadAxes(map, &truth->C_bs);
        }},
        .help = "as of the imu, of the axes that its attitude speaks of",
        .fallback = "[x, y, z]"},
       {.name = "mounting",
        .value = Key::Special{[](ConfigMap* map, TruthConfig* truth) {
          ReadTurn(map, &truth->C_bs);
        }},
        .help = "as of the imu",
        .fallback = "[0, 0, 0 deg]"}}};
  return kTable;
}

}  // namespace

TruthConfig ReadTruthKeys(ConfigMap* map) {
  TruthConfig truth;
  ReadTable(TruthTable(), map, &truth);
  return truth;
}

KeySection TruthSection() { return Documented(TruthTable()); }

}  // namespace hindsight
