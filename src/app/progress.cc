#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/command.h"

namespace hindsight {
namespace {

constexpr double kSecondsBetweenLines = 0.1;
/// An estimate of the time left from less than this is noise.
constexpr double kLeastFraction = 0.02;

double SecondsLeft(double seconds, double done) {
  return seconds * (1.0 - done) / done;
}

}  // namespace

Progress::Mode Progress::ModeFromName(const std::string& name) {
  if (name == "none") return Mode::kNone;
  if (name == "json") return Mode::kJson;
  if (name == "auto") {
    return isatty(STDERR_FILENO) != 0 ? Mode::kTerminal : Mode::kNone;
  }
  throw UsageError("--progress=" + name + ": expected auto, json or none");
}

Progress::Progress(Mode mode) : mode_(mode) {}

Progress::~Progress() { Clear(); }

void Progress::Clear() {
  if (line_open_) std::fputs("\r\033[K", stderr);
  line_open_ = false;
}

void Progress::Finish() {
  Clear();
  if (mode_ != Mode::kJson) return;
  step_ = steps_.size();
  Update("done", 1.0);
}

void Progress::Plan(std::vector<Step> steps) {
  steps_ = std::move(steps);
  step_ = 0;
  step_fraction_ = StepFraction();
  step_begin_ = Clock::now();
}

void Progress::Begin(const std::string& step) {
  const auto found =
      std::find_if(steps_.begin(), steps_.end(),
                   [&step](const Step& one) { return one.name == step; });
  if (found == steps_.end()) return;
  step_ = static_cast<std::size_t>(found - steps_.begin());
  step_fraction_ = StepFraction();
  step_begin_ = Clock::now();
}

double Progress::RunFraction(double step_fraction) const {
  if (steps_.empty()) return stage_fraction_;
  double done = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    all += steps_[i].work;
    done += i < step_    ? steps_[i].work
            : i == step_ ? step_fraction * steps_[i].work
                         : 0.0;
  }
  return all > 0.0 ? done / all : 0.0;
}

double Progress::SecondsSince(Clock::time_point begin) const {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void Progress::Update(const std::string& stage, double fraction) {
  if (mode_ == Mode::kNone) return;
  const Clock::time_point now = Clock::now();
  fraction = std::clamp(fraction, 0.0, 1.0);
  const bool new_stage = stage != stage_;
  if (new_stage) {
    stage_ = stage;
    stage_begin_ = now;
    if (steps_.empty()) run_begin_ = now;
  }
  stage_fraction_ = fraction;
  step_fraction_.Take(SecondsSince(step_begin_), fraction);
  const std::chrono::duration<double> since_print = now - last_print_;
  if (!new_stage && fraction < 1.0 &&
      since_print.count() < kSecondsBetweenLines) {
    return;
  }
  last_print_ = now;
  Print(fraction);
}

void Progress::Print(double fraction) {
  if (mode_ == Mode::kTerminal) {
    PrintBar();
    line_open_ = true;
    return;
  }
  nlohmann::ordered_json line = {{"stage", stage_}, {"fraction", fraction}};
  const auto put = [&line](const char* key, double seconds, double done) {
    if (done < kLeastFraction) return;
    line[key] = std::round(SecondsLeft(seconds, done) * 1e3) / 1e3;
  };
  put("seconds_left", SecondsSince(stage_begin_), fraction);
  if (!steps_.empty()) {
    line["run_fraction"] =
        std::round(RunFraction(step_fraction_.most()) * 1e4) / 1e4;
    put("run_seconds_left", SecondsSince(run_begin_),
        RunFraction(step_fraction_.now()));
  }
  std::fprintf(stderr, "%s\n", line.dump().c_str());
}

void Progress::PrintBar() const {
  constexpr int kLetters = 24;
  const double done = RunFraction(step_fraction_.most());
  std::string bar(kLetters, '.');
  std::fill_n(bar.begin(), std::lround(done * kLetters), '#');
  std::fprintf(stderr, "\r\033[K[%s] %3.0f %%", bar.c_str(), 100.0 * done);
  const double now = RunFraction(step_fraction_.now());
  if (now >= kLeastFraction) {
    std::fprintf(stderr, ", %.0f s left",
                 SecondsLeft(SecondsSince(run_begin_), now));
  }
  std::fprintf(stderr, ": %s", stage_.c_str());
  std::fflush(stderr);
}

}  // namespace hindsight
