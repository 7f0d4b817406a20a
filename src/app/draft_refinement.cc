#include "app/draft_refinement.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <system_error>
#include <variant>

#include "alignment/mounting_search.h"
#include "app/flags.h"
#include "app/interrupt.h"
#include "app/wheel_speed.h"
#include "base/error.h"
#include "base/median.h"
#include "base/units.h"
#include "dataset/checks.h"
#include "dataset/clock_search.h"
#include "dataset/reading_noise.h"
#include "geometry/so3.h"
#include "imu/known_imus.h"
#include "io/config/config.h"
#include "io/config/config_edit.h"
#include "io/config/init_config.h"
#include "io/write/atomic_file.h"
#include "io/write/output_error.h"
#include "io/write/unpublished.h"
#include "problems/noise_estimation.h"

namespace hindsight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Adds a key to a flow map: "{rate: 1 Hz}".
void AddToMap(const std::string& key, const std::string& entry,
              const std::string& comment, std::vector<KeyLine>* lines) {
  const KeyLine* line = FindLine(*lines, key);
  std::string value = "{" + entry + "}";
  std::string why = comment;
  if (line != nullptr) {
    value = line->value.substr(0, line->value.size() - 1) + ", " + entry + "}";
    why = line->comment + (line->comment.empty() ? "" : "; ") + comment;
  }
  SetLine({key, value, why}, lines);
}

/// Takes "time_offset: ..." out of the map `estimate`.
void DropClockSigma(std::vector<KeyLine>* lines) {
  const KeyLine* line = FindLine(*lines, "estimate");
  if (line == nullptr) return;
  std::string value = line->value;
  const std::size_t at = value.find("time_offset");
  if (at == value.npos) return;
  std::size_t end = value.find_first_of(",}", at);
  std::size_t begin = at;
  if (value[end] == ',') {
    end = value.find_first_not_of(' ', end + 1);
  } else {
    begin = value.rfind(',', at);
  }
  if (begin == value.npos) {
    std::erase_if(*lines, [](const KeyLine& l) { return l.key == "estimate"; });
    return;
  }
  value.erase(begin, end - begin);
  SetLine({"estimate", value, line->comment}, lines);
}

class Refiner {
 public:
  explicit Refiner(RecordingDraft* draft) : draft_(*draft) {}

  void Refine() {
    if (!Load()) return;
    SetAxes();
    SetNoise();
    ResolveMirror();
    if (IsAttitudeAlone(draft_)) {
      if (Load()) SetField();
      Load();
      return;
    }
    if (!Load()) return;
    SetClocks();
    if (!Load()) return;
    SetStretch();
    SetForward();
    SetTruthClock();
    if (Load()) SetLikelyNoise();
    Load();
  }

 private:
  bool Load() {
    try {
      dataset_ =
          LoadDataset(draft_.name + ".yaml", {.text = DraftText(draft_)});
      return true;
    } catch (const InputError& error) {
      draft_.assumptions.push_back(std::string("does not load as it stands: ") +
                                   error.what());
      return false;
    }
  }

  void Assume(const std::string& what) {
    auto& all = draft_.assumptions;
    if (std::find(all.begin(), all.end(), what) == all.end()) {
      all.push_back(what);
    }
  }

  void SetAxes() {
    const CheckReport report = CheckDataset(dataset_);
    const bool known = !report.axes.starts_with("unknown");
    const std::string axes = report.suggested_axes;
    SetLine(
        {"axes", axes.empty() ? "[x, y, z]" : axes,
         known ? "by gravity: " + report.axes.substr(0, report.axes.find(';'))
               : "which axis is down is not shown (a guess)"},
        &draft_.imu->lines);
    if (!known && !IsAttitudeAlone(draft_)) {
      Assume("imu: no axis feels gravity on average: which one is down");
    }
    for (StreamDraft& stream : draft_.aiding) {
      if (stream.kind->magnetic && !axes.empty()) {
        SetLine({"axes", axes, "as of the IMU"}, &stream.found.lines);
      }
    }
  }

  /// White noise as read, walks that are usual beside it, biases that it leaves
  /// after some seconds; bounded by what MEMS and fibre-optic units have.
  void SetNoise() {
    const ReadingNoise noise = NoiseOfReadings(dataset_.imu);
    if (noise.gyro <= 0.0 || noise.accel <= 0.0) return;
    constexpr double kLeastGyro = 0.005 * kDegree / 60.0;  // deg/sqrt(h)
    constexpr double kLeastAccel = 20.0 * kMicroG;
    const double gyro = std::max(noise.gyro, kLeastGyro);
    const double accel = std::max(noise.accel, kLeastAccel);
    const double gyro_quiet = std::max(noise.gyro_quiet, kLeastGyro);
    const double accel_quiet = std::max(noise.accel_quiet, kLeastAccel);
    std::vector<KeyLine>& lines = draft_.imu->lines;
    SetLine({"noise", "",
             "white noise of the readings, vibration included; "
             "walks usual beside it (a guess)"},
            &lines);
    SetLine({"  gyro", fmt::format("{:.3g} deg/s/sqrt(Hz)", gyro / kDegree),
             fmt::format("{:.2g} where quiet", gyro_quiet / kDegree)},
            &lines);
    SetLine({"  accel", fmt::format("{:.3g} mg/sqrt(Hz)", accel / kMilliG),
             fmt::format("{:.2g} where quiet", accel_quiet / kMilliG)},
            &lines);
    SetLine({"  gyro_bias_walk",
             fmt::format("{:.2g} deg/s^2/sqrt(Hz)",
                         UsualGyroBiasWalk(gyro_quiet) / kDegree)},
            &lines);
    SetLine({"  accel_bias_walk",
             fmt::format("{:.2g} ug/s/sqrt(Hz)",
                         UsualAccelBiasWalk(accel_quiet) / kMicroG)},
            &lines);
    const double gyro_bias =
        std::clamp(40.0 * gyro_quiet, 1e-5 * kDegree, 2.0 * kDegree);
    const double accel_bias =
        std::clamp(40.0 * accel_quiet, 0.1 * kMilliG, 50.0 * kMilliG);
    constexpr double kConsumer = 0.001 * kDegree;  // density, deg/s/sqrt(Hz)
    const bool consumer = gyro_quiet > kConsumer;
    SetLine({"  gyro_bias_sigma",
             consumer ? "1 deg/s"
                      : fmt::format("{:.2g} deg/s", gyro_bias / kDegree),
             "usual beside that noise (a guess)"},
            &draft_.top);
    SetLine(
        {"  accel_bias_sigma",
         consumer ? "50 mg" : fmt::format("{:.2g} mg", accel_bias / kMilliG)},
        &draft_.top);
    if (consumer && !IsAttitudeAlone(draft_)) {
      SetLine({"estimate", "{gyro_scale: 1 %, accel_scale: 1 %}",
               "what data sheets of this class allow"},
              &lines);
    }
  }

  /// Which axis is mirrored, where gravity turns against the gyros: the one that,
  /// turned round, fits the velocities in the vehicle's axes best.
  void ResolveMirror() {
    constexpr double kShown = 0.5;
    constexpr double kClear = 0.7;  // of the next best misfit
    const auto& guess = draft_.imu->imu_guess;
    if (!guess || guess->turn.correlation > -kShown || !Load()) return;
    double best = kInfinity;
    double second = kInfinity;
    int axis = 0;
    for (int i = 0; i < 4; ++i) {
      const double misfit = MisfitOfMirrored(i);
      if (misfit < best) {
        second = best;
        best = misfit;
        axis = i;
      } else {
        second = std::min(second, misfit);
      }
    }
    if (!(best < kClear * second)) return;
    TurnRound(axis);
    std::string what =
        axis == 3 ? "the gyros have the other sign"
                  : std::string("its ") + "xyz"[axis] + " axis is mirrored";
    std::erase_if(draft_.assumptions, [](const std::string& assumption) {
      return assumption.find("an axis is mirrored in both") !=
             std::string::npos;
    });
    Assume(
        fmt::format("imu: {}: gravity turns against the gyros, and the "
                    "velocities fit so (misfit {:.2g} against {:.2g})",
                    what, best, second));
  }

  /// The least misfit of a velocity in the vehicle's axes with an axis of both
  /// triads turned round, or (3) with all gyros.
  double MisfitOfMirrored(int axis) const {
    ImuStream imu = dataset_.imu;
    for (ImuSample& sample : imu.samples) {
      if (axis == 3) {
        sample.gyro = -sample.gyro;
      } else {
        sample.gyro(axis) = -sample.gyro(axis);
        sample.accel(axis) = -sample.accel(axis);
      }
    }
    double misfit = kInfinity;
    for (const AidingStream& stream : dataset_.streams) {
      const SensorKind* kind = stream.sensor.kind;
      if (kind != &DvlKind() && kind != &OdometerKind()) continue;
      const ClockSearch found = SearchClock(imu, dataset_.initial, stream);
      if (!found.candidates.empty()) {
        misfit = std::min(misfit, found.candidates.front().misfit);
      }
    }
    return misfit;
  }

  /// In the file's columns, which body axis `axis` comes from.
  void TurnRound(int axis) {
    std::vector<KeyLine>& lines = draft_.imu->lines;
    std::string letter;
    if (axis < 3) {
      const std::string axes = FindLine(lines, "axes")->value;
      int seen = -1;
      for (const char c : axes) {
        if (c >= 'x' && c <= 'z' && ++seen == axis) letter = std::string(1, c);
      }
    }
    for (KeyLine& line : lines) {
      const bool gyro =
          line.key.starts_with("  gyro_") && line.value.starts_with('"');
      const bool accel =
          line.key.starts_with("  accel_") && line.value.starts_with('"');
      const bool hit =
          axis == 3 ? gyro : (gyro || accel) && line.key.ends_with(letter);
      if (!hit) continue;
      line.value.insert(1, "-");
      line.comment +=
          (line.comment.empty() ? "" : "; ") + std::string("mirrored (likely)");
    }
  }

  /// A truth with attitudes shows where its clock stands.
  void SetTruthClock() {
    constexpr double kShown = 0.02;  // s
    if (!draft_.truth || dataset_.truth.empty() || !dataset_.truth[0].q_nb) {
      return;
    }
    const ClockSearch found = SearchClock(dataset_.imu, dataset_.truth);
    if (found.candidates.empty() ||
        std::abs(found.candidates.front().offset) < kShown) {
      return;
    }
    SetLine({"time_offset", "unknown", "its turns show it: " + Describe(found)},
            &draft_.truth->lines);
  }

  /// What the likelihood of the innovations says of the noise (EstimateNoise),
  /// where it says something: of the IMU, of stated sigmas and of constraints.
  /// Errors of a receiver on its own last too long for innovations to show.
  void SetLikelyNoise() {
    constexpr double kKnown = 0.35;  // standard deviation of ln(factor)
    NoiseEstimate estimate;
    try {
      estimate = EstimateNoise(dataset_);
    } catch (const EstimationError&) {
      return;
    }
    if (!estimate.converged) return;
    for (const NoiseFactor& noise : estimate.factors) {
      if (!(noise.log_sigma < kKnown)) continue;
      if (noise.name == "imu.gyro" || noise.name == "imu.accel") {
        const std::string key = "  " + noise.name.substr(4);
        KeyLine line = *FindLine(draft_.imu->lines, key);
        line.value = ScaledNumbers(line.value, noise.factor);
        line.comment = fmt::format(
            "by the likelihood of the innovations, {:.2g} "
            "of what the readings show",
            noise.factor);
        SetLine(std::move(line), &draft_.imu->lines);
        continue;
      }
      for (StreamDraft& stream : draft_.aiding) {
        if (stream.name == noise.name) ScaleSigma(noise.factor, &stream);
      }
    }
  }

  static void ScaleSigma(double factor, StreamDraft* stream) {
    std::vector<KeyLine>& lines = stream->found.lines;
    if (FindLine(lines, "noise") != nullptr) return;
    const std::string why = "by the likelihood of the innovations";
    if (const KeyLine* sigma = FindLine(lines, "sigma")) {
      SetLine({"sigma", ScaledNumbers(sigma->value, factor), why}, &lines);
    } else if (stream->kind->states_sigma) {
      SetLine({"sigma_scale", fmt::format("{:.2g}", factor), why}, &lines);
    }
  }

  /// Medians of the field's parts along and across the specific force.
  void SetField() {
    const std::vector<ImuSample>& samples = dataset_.imu.samples;
    for (const AidingStream& stream : dataset_.streams) {
      StreamDraft* draft = DraftOf(stream);
      if (draft == nullptr || !stream.sensor.kind->magnetic) continue;
      std::vector<double> down;
      std::vector<double> horizontal;
      std::size_t next = 0;
      for (const Measurement& z : stream.measurements) {
        const auto* field = std::get_if<MagneticField>(&z.model);
        while (next + 1 < samples.size() && samples[next].t < z.t) ++next;
        if (field == nullptr) continue;
        const Eigen::Vector3d& m = field->field_b;
        const double up = m.dot(samples[next].accel.normalized());
        down.push_back(-up);
        horizontal.push_back(
            std::sqrt(std::max(0.0, m.squaredNorm() - up * up)));
      }
      if (down.empty()) continue;
      std::vector<KeyLine>& lines = draft->found.lines;
      const std::string why = "median of what it reads against gravity";
      SetLine({"horizontal", fmt::format("{:.3g} uT", Median(horizontal)), why},
              &lines);
      SetLine({"down", fmt::format("{:.3g} uT", Median(down)), why}, &lines);
    }
  }

  StreamDraft* DraftOf(const AidingStream& stream) {
    for (StreamDraft& draft : draft_.aiding) {
      if (draft.name == stream.sensor.name) return &draft;
    }
    return nullptr;
  }

  void SetClocks() {
    for (const AidingStream& stream : dataset_.streams) {
      StreamDraft* draft = DraftOf(stream);
      if (draft == nullptr || !stream.sensor.kind->has_clock ||
          stream.sensor.kind->magnetic || stream.sensor.kind->standing) {
        continue;
      }
      if (draft->found.spin_axis) {
        SetWheel(stream, draft);
        continue;
      }
      const ClockSearch found =
          SearchClock(dataset_.imu, dataset_.initial, stream);
      TakeClockInto(found, draft);
    }
  }

  void TakeClockInto(const ClockSearch& found, StreamDraft* draft) {
    std::vector<KeyLine>& lines = draft->found.lines;
    if (found.candidates.empty()) {
      Assume(draft->name +
             ": the motion does not show where its clock stands against the "
             "IMU's");
      return;
    }
    if (found.candidates.size() > 1) {
      DropClockSigma(&lines);
      SetLine({"time_offset", "unknown",
               "several fit, each is tried: " + Describe(found)},
              &lines);
      return;
    }
    const ClockCandidate& best = found.candidates.front();
    SetLine({"time_offset", fmt::format("{:.3f} s", best.offset),
             fmt::format("by {}, +- {:.2g} s; refined (likely)", found.compared,
                         best.sigma)},
            &lines);
  }

  /// Radius, direction and clock of a wheel by the speed of the positions.
  void SetWheel(const AidingStream& stream, StreamDraft* draft) {
    const auto found = FindWheel(stream, dataset_);
    if (!found) {
      Assume(draft->name + ": no position shows the radius of the wheel");
      return;
    }
    std::vector<KeyLine>& lines = draft->found.lines;
    const KeyLine* speed = FindLine(lines, "  speed");
    const std::size_t at = speed->value.find("scale: ") + 7;
    const double scale = std::stod(speed->value.substr(at)) * found->factor;
    SetLine(
        {"  speed", speed->value.substr(0, at) + fmt::format("{:.6g}}}", scale),
         fmt::format("a wheel of {:.3f} m radius, by the speed of the "
                     "positions, correlation {:.3f} (likely)",
                     std::abs(0.3 * found->factor), found->correlation)},
        &lines);
    SetLine({"time_offset", fmt::format("{:.2f} s", found->offset),
             "by the speed of the positions (likely)"},
            &lines);
  }

  /// A part of a stream.
  static AidingStream Part(const AidingStream& stream, double from, double to) {
    AidingStream part;
    part.sensor = stream.sensor;
    part.sensor.time_offset = 0.0;
    for (const Measurement& z : stream.measurements) {
      if (z.t >= from && z.t < to) part.measurements.push_back(z);
    }
    return part;
  }

  /// How fast the IMU's clock runs against that of the first stream whose
  /// offset is known in its first and last third.
  void SetStretch() {
    constexpr double kLong = 200.0;  // s
    constexpr double kMostDrift = 1e-3;
    constexpr double kSure = 5.0;    // sigmas
    constexpr double kShown = 0.03;  // s
    const KeyLine* time = FindLine(draft_.imu->lines, "time");
    const bool fixed =
        time != nullptr && time->value.find("duration") != std::string::npos;
    for (const AidingStream& stream : dataset_.streams) {
      const StreamDraft* draft = DraftOf(stream);
      if (fixed || draft == nullptr || stream.measurements.size() < 100 ||
          !(stream.sensor.kind->is_position ||
            stream.sensor.kind->is_velocity)) {
        continue;
      }
      const double begin = stream.measurements.front().t;
      const double span = stream.measurements.back().t - begin;
      const double offset = stream.sensor.time_offset;
      if (span < kLong) continue;
      const auto search = [&](double from, double to) {
        return SearchClock(dataset_.imu, dataset_.initial,
                           Part(stream, begin + from * span, begin + to * span),
                           {offset - 1.0, offset + 1.0});
      };
      const ClockSearch early = search(0.0, 1.0 / 3.0);
      const ClockSearch late = search(2.0 / 3.0, 1.1);
      if (early.candidates.size() != 1 || late.candidates.size() != 1) continue;
      const double change =
          late.candidates[0].offset - early.candidates[0].offset;
      const double sigma =
          std::hypot(late.candidates[0].sigma, early.candidates[0].sigma);
      const double drift = change / (2.0 / 3.0 * span);
      if (std::abs(change) < kSure * sigma + kShown ||
          std::abs(drift) > kMostDrift) {
        return;
      }
      AddToMap("time", fmt::format("stretch: {:.7f}", 1.0 / (1.0 + drift)),
               fmt::format("its offset to {} changes by {:.3f} +- {:.3f} s "
                           "(likely)",
                           draft->name, change, sigma),
               &draft_.imu->lines);
      return;
    }
  }

  /// The axis along which it is accelerated as it runs.
  void SetForward() {
    const auto found = FindMounting(dataset_, -kInfinity, kInfinity);
    const bool odometer = std::any_of(
        draft_.aiding.begin(), draft_.aiding.end(),
        [](const StreamDraft& s) { return s.kind == &OdometerKind(); });
    if (!found) {
      if (odometer) {
        Assume("imu: the motion does not show which axis is forward");
      }
      return;
    }
    const Eigen::Vector3d euler = EulerFromQuaternion(found->q_ob) / kDegree;
    SetLine(
        {"mounting",
         fmt::format("[{:.1f}, {:.1f}, {:.1f} deg]", euler.x(), euler.y(),
                     euler.z()),
         fmt::format("forward is where starts, stops and turns say, +- {:.1f}"
                     " deg (likely)",
                     found->yaw_sigma / kDegree)},
        &draft_.imu->lines);
    if (odometer) return;
    StreamDraft wheels{"wheels", &NonHolonomicKind(), {}};
    wheels.found.lines = {
        {"rate", "1 Hz"},
        {"sigma", "[0.05, 0.1 m/s]", "to the side and down (a guess)"},
        {"level_on_average", "1 deg", "of the road's camber"},
        {"estimate", "{mounting: 10 deg, lever_arm: 1 m}"}};
    draft_.aiding.push_back(std::move(wheels));
    Assume(
        "wheels: taken for a vehicle on wheels, as it is accelerated along its "
        "course");
  }

  RecordingDraft& draft_;
  Dataset dataset_;
};

}  // namespace

bool IsAttitudeAlone(const RecordingDraft& draft) {
  return std::all_of(
      draft.aiding.begin(), draft.aiding.end(),
      [](const StreamDraft& stream) { return stream.kind->magnetic; });
}

void RefineDraft(RecordingDraft* draft) { Refiner(draft).Refine(); }

std::vector<RecordingDraft> DraftFolder(const std::string& folder) {
  std::vector<RecordingDraft> drafts = DraftRecordings(folder);
  for (RecordingDraft& draft : drafts) RefineDraft(&draft);
  return drafts;
}

void WriteDraft(const std::string& path, const std::string& text) {
  std::mutex writing;
  // A signal ends the process when all is done, so that no half is left.
  bool written = false;
  const StopWatch watch([&] {
    // For good: who waits for it from now on waits for the end of the process.
    writing.lock();
    return "interrupted; " +
           (written ? path + " is in place" : "nothing is left");
  });
  const std::lock_guard lock(writing);
  AtomicFile file(path);
  file.Write(text);
  file.Commit(FLAGS_force);
  written = true;
  if (const std::error_code error =
          SyncFolder(std::filesystem::absolute(path).parent_path())) {
    throw OutputError(
        "output file " + path +
        " is in place, but may be lost with the power: " + error.message());
  }
}

}  // namespace hindsight
