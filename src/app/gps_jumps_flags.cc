#include "app/gps_jumps_flags.h"

#include <algorithm>
#include <cmath>

#include "app/flags.h"
#include "app/list_flags.h"
#include "io/units.h"

namespace hindsight {
namespace {

std::vector<std::string> Profiles() {
  std::vector<std::string> known;
  for (const GpsErrorProfile& profile : GpsErrorProfiles()) {
    known.push_back(profile.name);
  }
  if (!IsGiven("errors")) {
    std::rotate(known.begin(), known.begin() + 1, known.end());
    return known;
  }
  const std::vector<std::string> asked = ReadWords("errors", FLAGS_errors);
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string all;
    for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
    throw UsageError("--errors=" + FLAGS_errors + ": '" + name +
                     "' is none of " + all + Suggestion(name, known));
  }
  return asked;
}

bool IsWhole(double x) { return std::abs(x - std::round(x)) < 1e-9 * x; }

/// The filters have nodes at the positions and no more than 1 s apart; the
/// truth is known at samples of the IMU.
void CheckGpsRate(double rate) {
  const double samples = kGpsJumpsImuRate / rate;
  const double seconds = 1.0 / rate;
  const bool fast = rate >= 1.0 && IsWhole(samples) && samples > 0.5;
  const bool slow = rate < 1.0 && IsWhole(seconds) && seconds < 250.5;
  if (fast || slow) return;
  throw UsageError("--gps-rate=" + FLAGS_gps_rate + ": " + FormatNumber(rate) +
                   " Hz; expected 100 Hz over a whole number, down to 1 Hz, or "
                   "1 Hz over a whole number, down to 1/250 Hz, so that nodes "
                   "fall on the IMU's samples");
}

void CheckGpsSigma(double sigma) {
  if (sigma >= 1e-3 && sigma <= 1e3) return;
  throw UsageError("--gps-sigma=" + FLAGS_gps_sigma + ": " +
                   FormatNumber(sigma) + " m; expected 0.001 to 1000 m");
}

}  // namespace

std::vector<GpsJumpsOptions> ReadGpsJumpsFlags() {
  const std::vector<double> rates =
      ReadPositiveNumbers("gps-rate", FLAGS_gps_rate);
  const std::vector<double> sigmas =
      ReadPositiveNumbers("gps-sigma", FLAGS_gps_sigma);
  std::for_each(rates.begin(), rates.end(), CheckGpsRate);
  std::for_each(sigmas.begin(), sigmas.end(), CheckGpsSigma);
  std::vector<GpsJumpsOptions> all;
  for (const double rate : rates) {
    for (const double sigma : sigmas) {
      for (const std::string& profile : Profiles()) {
        all.push_back({profile, sigma, rate});
      }
    }
  }
  if (all.empty()) throw UsageError("--errors: expected a profile");
  return all;
}

}  // namespace hindsight
