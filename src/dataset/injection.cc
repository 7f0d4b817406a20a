#include "dataset/injection.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Random streams of injections, clear of those of the simulation.
constexpr std::uint64_t kFirstStream = 1000;

/// Between those of two streams that one injection fits.
constexpr std::uint64_t kNextStream = 1000000;

constexpr std::array<bool, 3> kHorizontal = {true, true, false};

/// Takes injections: a vector in NED axes or a height.
bool TakesErrors(const SensorKind& kind) {
  return kind.is_position || kind.is_velocity || kind.is_height;
}

/// Its kind as a word of --inject.
std::string_view WordOf(const SensorKind& kind) {
  return kind.family.empty() ? kind.name : kind.family;
}

std::string Time(const char* word, double t) {
  if (!std::isfinite(t)) return "";
  return fmt::format(" {} {:.10g} s", word, t);
}

/// The errors of one injection, asked for in time order.
class ErrorSource {
 public:
  ErrorSource(const Injection& injection, std::uint64_t seed,
              std::uint64_t stream)
      : injection_(injection), random_(seed, stream) {}

  Eigen::Vector3d At(double t) {
    Eigen::Vector3d error = Shape(t);
    const std::array<bool, 3> axes = injection_.axes.value_or(kHorizontal);
    for (int axis = 0; axis < 3; ++axis) {
      if (!axes[static_cast<std::size_t>(axis)]) error(axis) = 0.0;
    }
    return error;
  }

 private:
  Eigen::Vector3d Shape(double t) {
    const double size = injection_.size;
    switch (injection_.kind) {
      case Injection::Kind::kStep:
      case Injection::Kind::kPulse:
        return Eigen::Vector3d::Constant(size);
      case Injection::Kind::kRamp:
        return Eigen::Vector3d::Constant(size * (t - injection_.from) /
                                         (injection_.to - injection_.from));
      case Injection::Kind::kSpikes: {
        const bool hit = random_.Uniform() < injection_.share;
        Eigen::Vector3d error;
        for (double& e : error) e = random_.Uniform() < 0.5 ? -size : size;
        return hit ? error : Eigen::Vector3d::Zero();
      }
      case Injection::Kind::kMultipath: {
        const double phi = std::exp(-(t - last_) / injection_.tau);
        coloured_ = phi * coloured_ +
                    size * std::sqrt(1.0 - phi * phi) * random_.NormalVector3();
        last_ = t;
        return coloured_;
      }
    }
    return Eigen::Vector3d::Zero();
  }

  const Injection& injection_;
  Random random_;
  double last_ = -std::numeric_limits<double>::infinity();
  Eigen::Vector3d coloured_ = Eigen::Vector3d::Zero();
};

void AddError(const Eigen::Vector3d& error_n, Measurement* z) {
  if (auto* position = std::get_if<PositionFix>(&z->model)) {
    position->p_e += NedAxes(position->p_e) * error_n;
  } else if (auto* velocity = std::get_if<VelocityFix>(&z->model)) {
    velocity->v_n += error_n;
  } else if (auto* height = std::get_if<HeightFix>(&z->model)) {
    height->height += error_n.x();
  }
}

[[noreturn]] void Fail(const Injection& injection, const std::string& what) {
  throw InputError("error '" + Describe(injection) + "': " + what);
}

std::vector<AidingStream*> FittingStreams(const Injection& injection,
                                          Dataset* dataset) {
  std::vector<AidingStream*> streams;
  std::string known;
  for (AidingStream& stream : dataset->streams) {
    const SensorKind& kind = *stream.sensor.kind;
    const bool named = injection.sensor == stream.sensor.name;
    if (!TakesErrors(kind)) {
      if (!named) continue;
      Fail(injection, "'" + injection.sensor +
                          "' is of another type; expected a sensor of type "
                          "position, velocity or height");
    }
    known += (known.empty() ? "" : ", ") + stream.sensor.name;
    if (named || injection.sensor == WordOf(kind)) streams.push_back(&stream);
  }
  if (streams.empty()) {
    if (known.empty()) known = "none at all";
    Fail(injection,
         "no stream has that name or type; expected position, velocity or "
         "height, or the name of such a stream: " +
             known);
  }
  return streams;
}

void CheckFitsSensor(const Injection& injection, const Sensor& sensor) {
  const bool velocity = sensor.kind->is_velocity;
  if (injection.speed != velocity) {
    Fail(injection, "'" + sensor.name + "' is of type " +
                        std::string(WordOf(*sensor.kind)) +
                        "; expected a size in " + (velocity ? "m/s" : "m"));
  }
  const bool height = sensor.kind->is_height;
  if (height && injection.axes) {
    Fail(injection, "'" + sensor.name + "' is a height; expected no axes");
  }
  if (injection.up != height) {
    Fail(injection,
         "streams of several types have that name; expected one type");
  }
}

/// What an injection meets, of the part of the recording that is used.
struct Reach {
  long hit = 0;
  long withheld = 0;
  double first = std::numeric_limits<double>::infinity();  ///< stamp, any [s]
  double last = -std::numeric_limits<double>::infinity();
};

void CheckReach(const Injection& injection, const Reach& reach) {
  if (reach.hit > 0) return;
  if (reach.withheld > 0) {
    Fail(injection, "all measurements in its span are withheld, " +
                        std::to_string(reach.withheld) +
                        ", and those stay as they are");
  }
  const bool any = reach.first <= reach.last;
  Fail(injection,
       "no measurement in its span" +
           (any ? "; expected one that meets those used," +
                      Time("from", reach.first) + Time("to", reach.last)
                : ", and none is used at all"));
}

void AddErrors(ErrorSource source, const Injection& injection,
               const TimeInterval& used, AidingStream* stream, Reach* reach) {
  for (Measurement& z : stream->measurements.Edited()) {
    const double t = z.t + stream->sensor.time_offset;
    const bool is_used = t >= used.begin && t <= used.end;
    if (is_used) {
      reach->first = std::min(reach->first, z.t);
      reach->last = std::max(reach->last, z.t);
    }
    if (z.t < injection.from || z.t >= injection.to) continue;
    // Asked for every measurement, so that the others' errors do not depend on
    // what is withheld.
    const Eigen::Vector3d error = source.At(z.t);
    if (!z.withheld) AddError(error, &z);
    if (is_used) ++(z.withheld ? reach->withheld : reach->hit);
  }
}

void Apply(Injection injection, std::uint64_t seed, std::uint64_t number,
           const TimeInterval& used, Dataset* dataset) {
  const std::string objection = SpanObjection(injection);
  if (!objection.empty()) Fail(injection, objection);
  const std::vector<AidingStream*> streams = FittingStreams(injection, dataset);
  injection.up = streams.front()->sensor.kind->is_height;
  for (const AidingStream* stream : streams) {
    CheckFitsSensor(injection, stream->sensor);
  }
  if (!injection.up && !injection.axes) injection.axes = kHorizontal;
  Reach reach;
  for (AidingStream* stream : streams) {
    AddErrors(ErrorSource(injection, seed, number), injection, used, stream,
              &reach);
    number += kNextStream;
  }
  CheckReach(injection, reach);
  dataset->injections.push_back(injection);
  std::string action = "error injected on purpose: " + Describe(injection);
  if (reach.withheld > 0) {
    action += " (" + std::to_string(reach.withheld) +
              " withheld ones left as they are)";
  }
  dataset->policies.push_back({injection.sensor, action, reach.hit});
}

}  // namespace

std::string SpanObjection(const Injection& injection) {
  const bool begins = std::isfinite(injection.from);
  const bool ends = std::isfinite(injection.to);
  if (injection.kind == Injection::Kind::kPulse && !ends) {
    return "a pulse needs to";
  }
  if (injection.kind == Injection::Kind::kRamp && !(begins && ends)) {
    return "a ramp needs from and to";
  }
  return injection.from < injection.to ? "" : "from must be before to";
}

void ApplyInjections(const std::vector<Injection>& injections,
                     std::uint64_t seed, const TimeInterval& used,
                     Dataset* dataset) {
  TimeInterval both = used;
  if (!dataset->imu.empty()) {
    both.begin = std::max(both.begin, dataset->imu.t_begin());
    both.end = std::min(both.end, dataset->imu.t_end());
  }
  std::uint64_t number = kFirstStream;
  for (const Injection& injection : injections) {
    Apply(injection, seed, number++, both, dataset);
  }
}

void ApplyInjections(const std::vector<Injection>& injections,
                     std::uint64_t seed, Dataset* dataset) {
  constexpr double kEnd = std::numeric_limits<double>::infinity();
  ApplyInjections(injections, seed, {-kEnd, kEnd}, dataset);
}

std::string Describe(const Injection& injection) {
  static const char* const kNames[] = {"step", "pulse", "ramp", "spikes",
                                       "multipath"};
  static const char* const kAxes[] = {"north", "east", "down"};
  std::string out =
      injection.sensor +
      fmt::format(": {} of {:g} {}",
                  kNames[static_cast<std::size_t>(injection.kind)],
                  injection.size, injection.speed ? "m/s" : "m");
  if (injection.kind == Injection::Kind::kSpikes) {
    out += fmt::format(" on {:g} %", 100.0 * injection.share);
  } else if (injection.kind == Injection::Kind::kMultipath) {
    out += fmt::format(", tau {:g} s,", injection.tau);
  }
  if (injection.up) out += " up";
  const char* separator = " ";
  for (std::size_t axis = 0; injection.axes && axis < 3; ++axis) {
    if (!(*injection.axes)[axis]) continue;
    out += separator + std::string(kAxes[axis]);
    separator = ", ";
  }
  return out + Time("from", injection.from) + Time("to", injection.to);
}

}  // namespace hindsight
