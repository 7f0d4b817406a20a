#include "app/noise_report.h"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "app/terminal.h"
#include "imu/imu_noise.h"
#include "io/config/config_edit.h"
#include "io/read/text_file.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"
#include "io/write/table.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Where a configuration says what a factor scales: the first that it says, or
/// the last, of value one, that it leaves out. Empty: nowhere.
std::vector<ConfigEdit::Path> PathsOf(const std::string& name,
                                      const Dataset& dataset) {
  if (name == "imu.gyro" || name == "imu.accel") {
    return {{"imu", "noise", name.substr(4)}};
  }
  for (const AidingStream& stream : dataset.streams) {
    const ConfigEdit::Path path = {"aiding", stream.sensor.name};
    const auto below = [&](const ConfigEdit::Path& more) {
      ConfigEdit::Path whole = path;
      whole.insert(whole.end(), more.begin(), more.end());
      return whole;
    };
    if (name == stream.sensor.name) {
      std::vector<ConfigEdit::Path> paths = {below({"sigma"})};
      if (stream.sensor.kind->states_sigma) {
        paths.push_back(below({"sigma_scale"}));
      }
      return paths;
    }
    for (const auto& [end, key] :
         {std::pair(".white", "white"), std::pair(".gauss_markov", "sigma"),
          std::pair(".gauss_markov_tau", "tau")}) {
      if (name == stream.sensor.name + end) return {below({"noise", key})};
    }
  }
  return {};
}

/// White noise of the IMU that is a device's, by `like`; nothing of another.
std::optional<std::string> OfDevice(const std::string& name,
                                    const Dataset& dataset,
                                    const ConfigEdit& edit) {
  if (!edit.Value({"imu", "noise", "like"})) return std::nullopt;
  for (const ImuNoiseValue& value : ImuNoiseValues()) {
    if (name != "imu." + std::string(value.name)) continue;
    return fmt::format("{:.3g} {}", dataset.imu.noise.*value.at / value.unit_si,
                       value.unit);
  }
  return std::nullopt;
}

/// Whether the factor was written where the configuration says what it scales.
bool WriteFactor(const NoiseFactor& noise, const Dataset& dataset,
                 ConfigEdit* edit) {
  const double spread = 2.0 * noise.log_sigma;
  for (const ConfigEdit::Path& path : PathsOf(noise.name, dataset)) {
    auto stated = edit->Value(path);
    if (!stated) stated = OfDevice(noise.name, dataset, *edit);
    const bool is_scale = path.back() == "sigma_scale";
    if (!stated && !is_scale) continue;
    const std::string before = stated.value_or("1");
    const std::string after = ScaledNumbers(before, noise.factor);
    const std::string why = fmt::format(
        "was {}, {:.3g} times that by the likelihood of the innovations (2 sd "
        "{:.3g} to {:.3g})",
        before, noise.factor, noise.factor * std::exp(-spread),
        noise.factor * std::exp(spread));
    return edit->Set(path, after, "check --noise", why);
  }
  return false;
}

}  // namespace

std::string DescribeNoise(const NoiseEstimate& estimate) {
  // Within a factor of a hundred: of what is not seen the figures are none.
  constexpr double kSeen = 2.3;
  ReportTable table({"noise of", "factor", "from\n(2 sd)", "to\n(2 sd)"});
  std::string unseen;
  for (const NoiseFactor& noise : estimate.factors) {
    const double spread = 2.0 * noise.log_sigma;
    if (!(spread < 2.0 * kSeen)) {
      unseen += (unseen.empty() ? "" : ", ") + noise.name;
      continue;
    }
    table.AddRow({noise.name, FormatFixed(noise.factor, 3),
                  FormatFixed(noise.factor * std::exp(-spread), 3),
                  FormatFixed(noise.factor * std::exp(spread), 3)});
  }
  if (!unseen.empty()) {
    unseen = "not seen by the data, leave as stated: " + unseen + "\n";
  }
  return "\n" + table.Render(StyleOfOutput()) + unseen +
         fmt::format("log-likelihood {:.1f} -> {:.1f}{}\n",
                     estimate.log_likelihood_before,
                     estimate.log_likelihood_after,
                     estimate.converged ? "" : " (not settled)");
}

std::string WriteNoise(const NoiseEstimate& estimate, const Dataset& dataset,
                       const std::string& config) {
  ConfigEdit edit(ReadTextFile(config), config);
  std::string written;
  std::string left;
  for (const NoiseFactor& noise : estimate.factors) {
    if (!(std::abs(std::log(noise.factor)) > 2.0 * noise.log_sigma)) continue;
    const std::string stream = noise.name.substr(0, noise.name.find('.'));
    // The program's own rests are in no configuration.
    if (stream != "imu" && !edit.Value({"aiding", stream, "type"})) continue;
    std::string& names = WriteFactor(noise, dataset, &edit) ? written : left;
    names += (names.empty() ? "" : ", ") + noise.name;
  }
  if (!written.empty()) WriteFileAtomically(config, edit.text());
  return (written.empty() ? "nothing to write: all is as stated, or not seen\n"
                          : "wrote to " + config + ": " + written + "\n") +
         (left.empty() ? ""
                       : "to be written by hand, as the configuration has no "
                         "key of it that can be exchanged: " +
                             left + "\n");
}

}  // namespace hindsight
