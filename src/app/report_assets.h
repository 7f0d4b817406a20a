#ifndef HINDSIGHT_APP_REPORT_ASSETS_H_
#define HINDSIGHT_APP_REPORT_ASSETS_H_

#include <string_view>
#include <vector>

namespace hindsight {

/// A script or style of the page, built into the program by
/// cmake/EmbedAssets.cmake.
struct ReportAsset {
  std::string_view name;  ///< "page.js"
  std::string_view text;
};

const std::vector<ReportAsset>& ReportAssets();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_ASSETS_H_
