#ifndef HINDSIGHT_APP_RUN_FINDINGS_H_
#define HINDSIGHT_APP_RUN_FINDINGS_H_

#include <future>
#include <optional>
#include <vector>

#include "app/allan_report.h"
#include "app/progress.h"
#include "dataset/checks.h"
#include "io/write/summary.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// What the recording shows by itself.
struct Findings {
  CheckReport check;
  std::optional<ImuAllan> allan;  ///< of the longest rest
};
Findings FindingsOf(const Dataset& dataset, const RestMemo& rests);

/// What is known before anything is solved, printed and put into the summary:
/// notes, start, what the data cannot tell. Returns the latter.
std::vector<UnobservedSpan> DescribeBeforehand(const Dataset& dataset,
                                               std::future<Findings> findings,
                                               Reconstruction* reconstruction,
                                               Progress* progress,
                                               RunSummary* summary);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_FINDINGS_H_
