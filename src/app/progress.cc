#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/command.h"

namespace hindsight {
namespace {

constexpr double kSecondsBetweenLines = 0.1;
/// An estimate of the time left from less than this is noise.
constexpr double kLeastFraction = 0.02;

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
  if (mode_ == Mode::kJson) Update("done", 1.0);
}

void Progress::Update(const std::string& stage, double fraction) {
  if (mode_ == Mode::kNone) return;
  const Clock::time_point now = Clock::now();
  const bool new_stage = stage != stage_;
  if (new_stage) {
    stage_ = stage;
    stage_begin_ = now;
  }
  const std::chrono::duration<double> since_print = now - last_print_;
  if (!new_stage && fraction < 1.0 &&
      since_print.count() < kSecondsBetweenLines) {
    return;
  }
  last_print_ = now;
  const std::chrono::duration<double> elapsed = now - stage_begin_;
  Print(std::clamp(fraction, 0.0, 1.0), elapsed.count());
}

void Progress::Print(double fraction, double seconds) {
  const bool predictable = fraction >= kLeastFraction;
  const double left = predictable ? seconds * (1.0 - fraction) / fraction : 0.0;
  if (mode_ == Mode::kJson) {
    nlohmann::ordered_json line = {{"stage", stage_}, {"fraction", fraction}};
    if (predictable) line["seconds_left"] = std::round(left * 1e3) / 1e3;
    std::fprintf(stderr, "%s\n", line.dump().c_str());
    return;
  }
  std::fprintf(stderr, "\r\033[K%s: %3.0f %%", stage_.c_str(),
               100.0 * fraction);
  if (predictable) std::fprintf(stderr, ", %.0f s left", left);
  std::fflush(stderr);
  line_open_ = true;
}

}  // namespace hindsight
