#include "io/config/config_files.h"

#include "base/error.h"
#include "io/read/paths.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

namespace fs = std::filesystem;

fs::path FindFolder(ConfigMap* top, const LoadOptions& options) {
  const fs::path folder = top->Text("folder", ".");
  const fs::path beside = fs::path(top->file()).parent_path() / folder;
  std::vector<fs::path> candidates = {beside};
  if (!options.data_root.empty()) {
    candidates.push_back(fs::path(options.data_root) / folder);
  }
  std::string looked_for;
  for (const fs::path& candidate : candidates) {
    if (IsFolder(candidate)) {
      top->Resolve("folder",
                   fs::absolute(candidate).lexically_normal().string());
      return candidate;
    }
    looked_for += (looked_for.empty() ? "there is no folder " : " and no ") +
                  candidate.lexically_normal().string();
  }
  top->Fail("folder",
            looked_for + (options.data_root.empty()
                              ? "; --data-root=DIR looks for it in DIR too"
                              : " (the data root is set by --data-root)"));
}

void RequireFiles(const DeclaredRecording& declared) {
  std::string missing;
  const StreamSource* first = nullptr;
  const auto look = [&](const StreamSource& source) {
    for (const std::string& path : source.Paths()) {
      if (PathExists(path)) continue;
      if (first == nullptr) {
        first = &source;
        missing = source.name + ".file: there is no file " + path;
      } else {
        missing += "; nor " + path + " (" + source.name + ".file, line " +
                   std::to_string(source.config_line) + ")";
      }
    }
  };
  look(declared.imu);
  if (declared.imu_options.accelerometer) {
    look(*declared.imu_options.accelerometer);
  }
  for (const AidingConfig& config : declared.aiding) {
    if (!config.settings.sensor.kind->generated) look(config.source);
  }
  if (declared.truth) look(*declared.truth);
  if (first == nullptr) return;
  throw InputError(first->config_path, first->config_line, missing);
}

}  // namespace hindsight
