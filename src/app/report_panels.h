#ifndef HINDSIGHT_APP_REPORT_PANELS_H_
#define HINDSIGHT_APP_REPORT_PANELS_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/report_data.h"
#include "app/report_source.h"

namespace hindsight {

/// What a page is made from, and what its panels have put into it so far.
// Moving a JSON value asserts what holds, so that it seems to throw.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct ReportContext {
  std::vector<ReportSource> sources;
  std::vector<ReportSolution> solutions;  ///< the first is the recommended one
  std::vector<ResidualSeries> residuals;  ///< of the recommended one
  std::vector<FixRow> fixes;              ///< of the reference
  ReportData data;
  nlohmann::ordered_json map;        ///< what the map shows
  nlohmann::ordered_json time_line;  ///< what the time line shows

  const ReportSource& reference() const { return sources.front(); }
  const ReportSolution& best() const { return solutions.front(); }
  const nlohmann::ordered_json& BestSummary() const {
    return reference().Method(best().method);
  }
};

/// A text or a number of a summary, the number as `format` of fmt says; "" where
/// there is none.
std::string TextOf(const nlohmann::ordered_json& json, const std::string& key);
std::string NumberOf(const nlohmann::ordered_json& json, const std::string& key,
                     const char* format);

/// Puts the solutions' series into the page: place in metres north and east of
/// the recommended one's first position, horizontal and tilt sigma, speed.
void AddSolutionSeries(ReportContext* context);

/// \name Panels
/// The inside of a section as HTML; why there is none where data lack.
/// \{
std::string VerdictPanel(ReportContext* context);
std::string TimeLinePanel(ReportContext* context);
std::string MapPanel(ReportContext* context);
std::string AccuracyPanel(ReportContext* context);
std::string SeparationPanel(ReportContext* context);
std::string ResidualPanel(ReportContext* context);
std::string OutagePanel(ReportContext* context);
std::string ReceiverPanel(ReportContext* context);
std::string BiasPanel(ReportContext* context);
std::string AllanPanel(ReportContext* context);
std::string MotionPanel(ReportContext* context);
std::string DifferencePanel(ReportContext* context);
std::string TruthPanel(ReportContext* context);
std::string ModePanel(ReportContext* context);
std::string ConstantPanel(ReportContext* context);
std::string ConfigPanel(ReportContext* context);
/// \}

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_PANELS_H_
