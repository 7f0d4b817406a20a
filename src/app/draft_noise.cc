#include "app/draft_noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/draft_refinement.h"
#include "base/error.h"
#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "dataset/fix_noise.h"
#include "dataset/usual_noise.h"
#include "io/config/config_edit.h"
#include "io/read/column_lines.h"
#include "problems/noise_estimation.h"

namespace hindsight {
namespace {

constexpr double kMostFactor = 30.0;
constexpr double kUsualWhite = 0.1;  // m
/// Gravity moves the bias of gyros by up to 0.1 deg/s/g, as data sheets say of
/// consumer ones: in a hand, which turns it about, that is a walk, of the size that
/// the configurations of BROAD's trials have.
constexpr double kTiltedBiasWalk = 0.005 * kDegree;  // rad/s^2/sqrt(Hz)
constexpr char kWhy[] = "by the likelihood of the innovations";

/// With slow errors, which are a guess; nullptr if the sigmas are the file's.
const KeyLine* SlowNoiseOf(const StreamDraft* stream) {
  return stream != nullptr && stream->kind->is_position
             ? FindLine(stream->found.lines, "noise")
             : nullptr;
}

/// Slow errors of no less than the white noise.
void SetSlowNoise(double slow, double white, const std::string& comment,
                  StreamDraft* stream) {
  SetLine(SlowFixNoise(std::max(slow, white), white, comment),
          &stream->found.lines);
}

/// What of an estimate says something of a sigma.
std::vector<NoiseFactor> Known(const NoiseEstimate& estimate) {
  constexpr double kKnown = 0.35;  // standard deviation of ln(factor)
  std::vector<NoiseFactor> known;
  for (const NoiseFactor& noise : estimate.factors) {
    if (noise.log_sigma < kKnown) known.push_back(noise);
  }
  return known;
}

/// Of no device: whatever asks for it is no noise. What lasts was a guess, and
/// may be off by more.
bool IsAbsurd(const NoiseFactor& noise) {
  const bool lasts = noise.name.find(".gauss_markov") != std::string::npos ||
                     noise.name.find(".disturbance") != std::string::npos;
  return !lasts &&
         (noise.factor > kMostFactor || noise.factor < 1.0 / kMostFactor);
}

void ScaleImu(const NoiseFactor& noise, RecordingDraft* draft) {
  const KeyLine* drafted =
      FindLine(draft->imu->lines, "  " + noise.name.substr(4));
  if (drafted == nullptr) return;
  KeyLine line = *drafted;
  line.value = ScaledNumbers(line.value, noise.factor);
  line.comment =
      fmt::format("{}, {:.2g} of what the readings show", kWhy, noise.factor);
  SetLine(std::move(line), &draft->imu->lines);
}

/// The sigma of a constraint is physics: no motion makes it less.
/// A vehicle may keep a constraint better than any sigma says.
bool IsConstraint(const StreamDraft& stream) {
  return stream.kind->generated || stream.kind->standing;
}

void ScaleSigma(double factor, StreamDraft* stream) {
  std::vector<KeyLine>& lines = stream->found.lines;
  if (FindLine(lines, "noise") != nullptr) return;
  if (IsConstraint(*stream) && factor < 1.0) return;
  if (const KeyLine* sigma = FindLine(lines, "sigma")) {
    SetLine({"sigma", ScaledNumbers(sigma->value, factor), kWhy}, &lines);
  } else if (stream->kind->states_sigma) {
    SetLine({"sigma_scale", fmt::format("{:.2g}", factor), kWhy}, &lines);
  }
}

/// Innovations show white noise, and slow errors where these are larger than
/// usual; that they are smaller shows nowhere.
void ScaleFixNoise(const std::vector<NoiseFactor>& known,
                   const AidingStream& stream, StreamDraft* draft) {
  const auto more = [&](const std::string& part) {
    for (const NoiseFactor& noise : known) {
      if (noise.name == draft->name + part) return std::max(1.0, noise.factor);
    }
    return 1.0;
  };
  const double white = more(".white");
  const double slow = more(".gauss_markov");
  if (white == 1.0 && slow == 1.0) return;
  const NoiseModel& noise = stream.sensor.noise;
  SetSlowNoise(slow * noise.sigma, white * noise.white_sigma, kWhy, draft);
}

/// A reading is the mean of the time since the one before, or later still: it belongs
/// to half a sample before its stamp. Beside positions their clock takes it up.
void TellLateReadings(const ImuStream& imu, std::vector<KeyLine>* lines) {
  if (imu.kind != ImuStream::Kind::kRates || imu.samples.size() < 2) return;
  const double step = (imu.t_end() - imu.t_begin()) /
                      static_cast<double>(imu.samples.size() - 1);
  SetLine({"time_offset", fmt::format("{:.3g} ms", -0.5e3 * step),
           "readings are taken for means since the one before (a guess)"},
          lines);
}

}  // namespace

void TellReadingNoise(const Dataset& dataset, RecordingDraft* draft) {
  const ReadingNoise read = NoiseOfReadings(dataset.imu);
  if (read.gyro <= 0.0 || read.accel <= 0.0) return;
  const UsualNoise noise = UsualNoiseBeside(read);
  std::vector<KeyLine>& lines = draft->imu->lines;
  SetLine({"noise", "",
           "white noise of the readings, vibration included; "
           "walks usual beside it (a guess)"},
          &lines);
  SetLine({"  gyro", fmt::format("{:.3g} deg/s/sqrt(Hz)", noise.gyro / kDegree),
           fmt::format("{:.2g} where quiet", noise.gyro_quiet / kDegree)},
          &lines);
  SetLine({"  accel", fmt::format("{:.3g} mg/sqrt(Hz)", noise.accel / kMilliG),
           fmt::format("{:.2g} where quiet", noise.accel_quiet / kMilliG)},
          &lines);
  const bool held = IsAttitudeAlone(*draft);
  const bool tilts = held && noise.gyro_bias_walk < kTiltedBiasWalk;
  SetLine(
      {"  gyro_bias_walk",
       fmt::format("{:.2g} deg/s^2/sqrt(Hz)",
                   (tilts ? kTiltedBiasWalk : noise.gyro_bias_walk) / kDegree),
       tilts ? "usual where gravity turns about (a guess)" : ""},
      &lines);
  if (held) {
    SetLine({"  gyro_per_rate", "0.001 sqrt(s)",
             "what a constant scale factor leaves (a guess)"},
            &lines);
  }
  SetLine({"  accel_bias_walk", fmt::format("{:.2g} ug/s/sqrt(Hz)",
                                            noise.accel_bias_walk / kMicroG)},
          &lines);
  SetLine({"  gyro_bias_sigma",
           fmt::format("{:.2g} deg/s", noise.gyro_bias_sigma / kDegree),
           "usual beside that noise (a guess)"},
          &draft->top);
  // Attitude alone tells a bias from the motions of a hand less well.
  const double accel_bias_sigma =
      held ? std::min(noise.accel_bias_sigma, AccelBiasSigma({}).maxCoeff())
           : noise.accel_bias_sigma;
  SetLine({"  accel_bias_sigma",
           fmt::format("{:.2g} mg", accel_bias_sigma / kMilliG)},
          &draft->top);
  if (held) TellLateReadings(dataset.imu, &lines);
  if (noise.consumer && !held) {
    SetLine({"estimate", "{gyro_scale: 1 %, accel_scale: 1 %}",
             "what data sheets of this class allow"},
            &lines);
  }
}

void TellFixNoise(const Dataset& dataset, RecordingDraft* draft) {
  constexpr char kShown[] = "; white noise as the fixes show it";
  for (const AidingStream& stream : dataset.streams) {
    StreamDraft* drafted = draft->Find(stream.sensor.name);
    const KeyLine* line = SlowNoiseOf(drafted);
    if (line == nullptr) continue;
    const bool again = line->comment.ends_with(kShown);
    const NoiseModel& noise = stream.sensor.noise;
    const auto white = NoiseOfFixes(dataset.imu, dataset.initial, stream);
    // What was said before the clock was known is said anew.
    if (!white || (!again && *white <= noise.white_sigma)) continue;
    SetSlowNoise(noise.sigma, std::max(*white, kUsualWhite),
                 again ? line->comment : line->comment + kShown, drafted);
  }
}

void TellLikelyNoise(const Dataset& dataset,
                     const std::function<void(double)>& progress,
                     RecordingDraft* draft) {
  NoiseEstimate estimate;
  try {
    estimate = EstimateNoise(dataset, progress);
  } catch (const EstimationError&) {
    return;
  }
  if (!estimate.converged) return;
  const std::vector<NoiseFactor> known = Known(estimate);
  const auto absurd =
      std::find_if(known.begin(), known.end(), [&](const NoiseFactor& noise) {
        const StreamDraft* stream = draft->Find(noise.name);
        const bool kept =
            stream != nullptr && IsConstraint(*stream) && noise.factor < 1.0;
        return !kept && IsAbsurd(noise);
      });
  if (absurd != known.end()) {
    draft->Assume(fmt::format(
        "{}: the innovations ask for {:.2g} times its noise, which no device "
        "has: an axis, a unit, a clock or another guess is likely to be wrong",
        absurd->name, absurd->factor));
    return;
  }
  for (const NoiseFactor& noise : known) {
    if (noise.name == "imu.gyro" || noise.name == "imu.accel") {
      ScaleImu(noise, draft);
      continue;
    }
    StreamDraft* stream = draft->Find(noise.name);
    if (stream != nullptr) ScaleSigma(noise.factor, stream);
  }
  for (const AidingStream& stream : dataset.streams) {
    StreamDraft* drafted = draft->Find(stream.sensor.name);
    if (SlowNoiseOf(drafted) != nullptr) ScaleFixNoise(known, stream, drafted);
  }
}

}  // namespace hindsight
