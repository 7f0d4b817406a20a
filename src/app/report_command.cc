#include <algorithm>
#include <filesystem>
#include <iostream>

#include "app/command.h"
#include "app/file_place.h"
#include "app/flags.h"
#include "app/report_page.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/write/atomic_file.h"
#include "io/write/output_error.h"
#include "io/write/result_manifest.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp =
    R"(Writes one page, report.html, that shows the results in DIR: verdict and
evidence, streams, map, accuracy, separation, residuals, outages, receiver,
biases, motion, methods against each other, errors against a truth, modes,
constants and configuration. It is one file that opens without a network.

One cursor and one zoom hold for all charts and the map: drag over a chart to
zoom, click to place the cursor, double click to see all; keys are told at the
top of the page. Names of methods switch them on and off.

With several folders, the solutions of the first and the best of each other
stand side by side. Without --out the page goes into the first folder and its
manifest.json, so that 'run --force' may replace it; an older page is replaced.
)";

/// Where the page goes. A file in the first folder is listed before it is
/// there, as its others are.
std::string PreparePlace(const fs::path& folder) {
  if (!FLAGS_out.empty()) {
    CheckFilePlace(FLAGS_out, {"'report' or 'evaluate'", IsReportPage});
    return FLAGS_out;
  }
  std::optional<ResultManifest> manifest = ReadManifest(folder);
  const bool listed = std::find(manifest->files.begin(), manifest->files.end(),
                                kReportName) != manifest->files.end();
  const fs::path path = folder / kReportName;
  if (listed) return path.string();
  if (PathExists(path)) {
    throw InputError(path.string() + " is not listed in " + kManifestName +
                     ": it is not replaced; name another --out");
  }
  manifest->files.emplace_back(kReportName);
  std::sort(manifest->files.begin(), manifest->files.end());
  WriteManifest(*manifest, folder);
  return path.string();
}

int Run(const std::vector<std::string>& arguments) {
  std::vector<ReportPlace> places;
  for (const std::string& folder : arguments) {
    places.push_back({.folder = folder});
  }
  const std::string page = ReportPage(places);
  const std::string path = PreparePlace(places.front().folder);
  WriteFileAtomically(path, page);
  std::cout << "report in " << path << "\n";
  return kUsable;
}

}  // namespace

Command ReportCommand() {
  return {
      .name = "report",
      .summary = "show results as one page, report.html",
      .arguments = "DIR [DIR2 ...]",
      .help = kHelp,
      .flags = {{"out", "FILE", "write the page there (DIR/report.html)"},
                {"force", "", "replace FILE if it is such a page"}},
      .min_arguments = 1,
      .max_arguments = 16,
      .run = Run,
  };
}

}  // namespace hindsight
