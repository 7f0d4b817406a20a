#include "dataset/injection.h"

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/random.h"

namespace hindsight {
namespace {

/// Random streams of injections, clear of those of the simulation.
constexpr std::uint64_t kFirstStream = 1000;

bool Fits(const std::string& name, const Sensor& sensor) {
  if (name == sensor.name) return true;
  switch (sensor.type) {
    case SensorType::kPosition:
      return name == "position";
    case SensorType::kVelocity:
      return name == "velocity";
    case SensorType::kHeight:
      return name == "height";
    default:
      return false;
  }
}

/// The errors of one injection, asked for in time order.
class ErrorSource {
 public:
  ErrorSource(const Injection& injection, std::uint64_t seed,
              std::uint64_t stream)
      : injection_(injection), random_(seed, stream) {}

  Eigen::Vector3d At(double t) {
    Eigen::Vector3d error = Shape(t);
    for (int axis = 0; axis < 3; ++axis) {
      if (!injection_.axes[static_cast<std::size_t>(axis)]) error(axis) = 0.0;
    }
    return error;
  }

 private:
  Eigen::Vector3d Shape(double t) {
    const double size = injection_.size;
    switch (injection_.kind) {
      case Injection::Kind::kStep:
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
  throw InputError("injection '" + Describe(injection) + "': " + what);
}

void Apply(const Injection& injection, std::uint64_t seed,
           std::uint64_t stream_number, Dataset* dataset) {
  if (injection.kind == Injection::Kind::kRamp &&
      !(std::isfinite(injection.from) && std::isfinite(injection.to))) {
    Fail(injection, "a ramp needs from and to");
  }
  if (!(injection.from < injection.to)) Fail(injection, "it ends at its start");
  bool found = false;
  long hit = 0;
  for (AidingStream& stream : dataset->streams) {
    if (!Fits(injection.sensor, stream.sensor)) continue;
    if (stream.sensor.type != SensorType::kPosition &&
        stream.sensor.type != SensorType::kVelocity &&
        stream.sensor.type != SensorType::kHeight) {
      Fail(injection, "only position, velocity and height take injections");
    }
    found = true;
    Injection own = injection;
    if (stream.sensor.type == SensorType::kHeight) own.axes[0] = true;
    ErrorSource source(own, seed, stream_number);
    for (Measurement& z : stream.measurements) {
      if (z.t < injection.from || z.t >= injection.to) continue;
      AddError(source.At(z.t), &z);
      ++hit;
    }
  }
  if (!found) {
    Fail(injection, "no position, velocity or height stream of that name");
  }
  if (hit == 0) Fail(injection, "no measurement in its span");
  dataset->injections.push_back(injection);
  dataset->policies.push_back(
      {injection.sensor, "error injected on purpose: " + Describe(injection),
       hit});
}

std::string Time(const char* word, double t) {
  if (!std::isfinite(t)) return "";
  char text[64];
  std::snprintf(text, sizeof(text), " %s %g s", word, t);
  return text;
}

}  // namespace

void ApplyInjections(const std::vector<Injection>& injections,
                     std::uint64_t seed, Dataset* dataset) {
  std::uint64_t stream = kFirstStream;
  for (const Injection& injection : injections) {
    Apply(injection, seed, stream++, dataset);
  }
}

std::string Describe(const Injection& injection) {
  static const char* const kNames[] = {"step", "ramp", "spikes", "multipath"};
  static const char* const kAxes[] = {"north", "east", "down"};
  char text[96];
  std::snprintf(text, sizeof(text), ": %s of %g",
                kNames[static_cast<std::size_t>(injection.kind)],
                injection.size);
  std::string out = injection.sensor + text;
  if (injection.kind == Injection::Kind::kSpikes) {
    std::snprintf(text, sizeof(text), " on %g %%", 100.0 * injection.share);
    out += text;
  } else if (injection.kind == Injection::Kind::kMultipath) {
    std::snprintf(text, sizeof(text), ", tau %g s,", injection.tau);
    out += text;
  }
  const char* separator = " ";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!injection.axes[axis]) continue;
    out += separator + std::string(kAxes[axis]);
    separator = ", ";
  }
  return out + Time("from", injection.from) + Time("to", injection.to);
}

}  // namespace hindsight
