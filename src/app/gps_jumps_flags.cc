#include "app/gps_jumps_flags.h"

#include <algorithm>

#include "app/flags.h"
#include "app/list_flags.h"

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

}  // namespace

std::vector<GpsJumpsOptions> ReadGpsJumpsFlags() {
  std::vector<GpsJumpsOptions> all;
  for (const double rate : ReadPositiveNumbers("gps-rate", FLAGS_gps_rate)) {
    for (const double sigma :
         ReadPositiveNumbers("gps-sigma", FLAGS_gps_sigma)) {
      for (const std::string& profile : Profiles()) {
        all.push_back({profile, sigma, rate});
      }
    }
  }
  if (all.empty()) throw UsageError("--errors: expected a profile");
  return all;
}

}  // namespace hindsight
