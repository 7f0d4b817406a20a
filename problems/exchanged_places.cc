#include "problems/exchanged_places.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"
#include "problems/rival_data.h"

namespace hindsight {
namespace {

/// Nothing where a longitude is none of a latitude.
std::optional<Eigen::Vector3d> Exchanged(const Eigen::Vector3d& p_e) {
  Geodetic place = GeodeticFromEcef(p_e);
  std::swap(place.latitude, place.longitude);
  if (!(std::abs(place.latitude) < 0.5 * kPi)) return std::nullopt;
  return EcefFromGeodetic(place);
}

/// A recording as it may be.
struct Exchange {
  int sensor;
  Dataset dataset;
  Start start;
  /// ln of what the measured places grow by, in area.
  double log_area = 0.0;
};

/// The start with north for east.
std::optional<Start> Mirrored(Start start) {
  State& x = start.prior.x;
  const auto p_e = Exchanged(x.p_e);
  if (!p_e) return std::nullopt;
  const Eigen::Matrix3d C_ne = NedAxes(x.p_e).transpose();
  const Eigen::Matrix3d C_en_there = NedAxes(*p_e);
  Eigen::Vector3d v_n = C_ne * x.v_e;
  std::swap(v_n.x(), v_n.y());
  Eigen::Vector3d euler =
      EulerFromQuaternion(Eigen::Quaterniond(C_ne) * x.q_eb);
  euler.z() = 0.5 * kPi - euler.z();
  x.p_e = *p_e;
  x.v_e = C_en_there * v_n;
  x.q_eb = Eigen::Quaterniond(C_en_there) *
           QuaternionFromEuler(euler.x(), euler.y(), euler.z());
  return start;
}

std::optional<Exchange> ExchangeOf(int sensor, const ForwardStage& chosen) {
  auto start = Mirrored(chosen.start());
  if (!start) return std::nullopt;
  Exchange one{sensor, chosen.dataset(), *std::move(start)};
  const Timeline& timeline = chosen.timeline();
  const double from = timeline.node(0).t;
  const double to = timeline.node(timeline.size() - 1).t;
  AidingStream& stream = one.dataset.streams[static_cast<std::size_t>(sensor)];
  for (Measurement& z : stream.measurements.Edited()) {
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr) return std::nullopt;
    const auto p_e = Exchanged(fix->p_e);
    if (!p_e) return std::nullopt;
    if (!z.withheld && z.t >= from && z.t <= to) {
      one.log_area += std::log(std::cos(GeodeticFromEcef(*p_e).latitude) /
                               std::cos(GeodeticFromEcef(fix->p_e).latitude));
    }
    fix->p_e = *p_e;
    Eigen::PermutationMatrix<3> swap(Eigen::Vector3i(1, 0, 2));
    fix->R_n = (swap * fix->R_n * swap).eval();
  }
  return one;
}

/// Between the headings farthest apart, turns counted [rad].
double TurnOf(const std::vector<State>& states) {
  double heading = 0.0, least = 0.0, most = 0.0;
  std::optional<double> before;
  for (const State& x : states) {
    const double yaw =
        EulerFromQuaternion(Eigen::Quaterniond(NedAxes(x.p_e).transpose()) *
                            x.q_eb)
            .z();
    if (before) heading += std::remainder(yaw - *before, 2.0 * kPi);
    before = yaw;
    least = std::min(least, heading);
    most = std::max(most, heading);
  }
  return most - least;
}

/// Whether a mirror image may be as good: gyros tell which way it turns.
bool IsAsked(ForwardStage* chosen) {
  constexpr double kPlainTurn = 0.5 * kPi;
  const Timeline& timeline = chosen->timeline();
  return chosen->start().layout.has_canonical_head() &&
         timeline.node(timeline.size() - 1).t - timeline.node(0).t <=
             kLongestOfExchanged &&
         TurnOf(chosen->relinearised().states) < kPlainTurn;
}

std::vector<Exchange> ExchangesOf(const ForwardStage& chosen) {
  std::vector<Exchange> all;
  const auto& streams = chosen.dataset().streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!streams[i].sensor.kind->places) continue;
    if (auto one = ExchangeOf(static_cast<int>(i), chosen)) {
      all.push_back(*std::move(one));
    }
  }
  return all;
}

std::optional<RivalSolution> RivalBy(const Exchange& one, double log_odds,
                                     const ForwardStage& chosen,
                                     RivalComparison* comparison) {
  const std::string& name =
      one.dataset.streams[static_cast<std::size_t>(one.sensor)].sensor.name;
  RivalSolution words;
  words.description =
      "latitude and longitude of " + name + " stand for each other";
  words.remedy = "if so, lat and lon in the columns of " + name + " exchanged";
  ReconstructionOptions options = chosen.options();
  options.progress = nullptr;
  ForwardStage stage(one.dataset, options, one.start);
  return comparison->Solve(log_odds + one.log_area,
                           RivalReadings::kAtOtherTimes, std::move(words),
                           &stage);
}

}  // namespace

std::vector<RivalSolution> ExchangedPlaces(ForwardStage* chosen) {
  if (!IsAsked(chosen)) return {};
  const std::vector<Exchange> all = ExchangesOf(*chosen);
  RivalComparison comparison(chosen);
  return RareRivals(all.size(), [&](std::size_t i, double log_odds) {
    return RivalBy(all[i], log_odds, *chosen, &comparison);
  });
}

}  // namespace hindsight
