#include "app/run_findings.h"

#include <iostream>
#include <string>
#include <utility>

#include "app/run_report.h"
#include "base/error.h"

namespace hindsight {
namespace {

/// What the summary says of the recording.
void NoteRecording(const Dataset& dataset, Findings findings,
                   RunSummary* summary) {
  const CheckReport& check = findings.check;
  summary->warnings = check.warnings;
  summary->warnings.insert(summary->warnings.end(),
                           check.truth_warnings.begin(),
                           check.truth_warnings.end());
  const std::string withholding = WithholdingWarning(dataset);
  if (!withholding.empty()) summary->warnings.push_back(withholding);
  summary->notes = NotesOf(dataset);
  summary->fixes = SummarizeFixes(dataset);
  for (const StreamReport& stream : check.streams) {
    for (const StreamGap& gap : stream.gaps) {
      summary->gaps.push_back({stream.name, gap.t, gap.t + gap.length});
    }
  }
  for (const TimeInterval& rest : check.imu.rest.at_rest) {
    summary->rests.push_back({"", rest.begin, rest.end});
  }
  summary->allan = std::move(findings.allan);
}

}  // namespace

Findings FindingsOf(const Dataset& dataset, const RestMemo& rests) {
  CheckReport check = DescribeDataset(dataset, rests);
  auto allan = AllanOfLongestRest(dataset, check.imu.rest);
  return {std::move(check), std::move(allan)};
}

std::vector<UnobservedSpan> DescribeBeforehand(const Dataset& dataset,
                                               std::future<Findings> findings,
                                               Reconstruction* reconstruction,
                                               Progress* progress,
                                               RunSummary* summary) {
  std::vector<UnobservedSpan> unobserved;
  try {
    unobserved = reconstruction->Unobserved();
  } catch (const EstimationError&) {
    // The filter diverged: every method says so of itself.
  }
  summary->unobserved = unobserved;
  progress->Clear();
  Findings found = findings.get();
  for (const auto* warnings :
       {&found.check.warnings, &found.check.truth_warnings}) {
    for (const std::string& warning : *warnings) {
      std::cout << "warning: " << warning << "\n";
    }
  }
  NoteRecording(dataset, std::move(found), summary);
  std::cout << DescribeNotes(dataset, summary->notes);
  if (const StartReport* start = reconstruction->start()) {
    std::cout << DescribeStart(*start);
  }
  std::cout << DescribeUnobserved(unobserved) << std::flush;
  return unobserved;
}

}  // namespace hindsight
