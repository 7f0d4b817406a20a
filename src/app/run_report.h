#ifndef HINDSIGHT_APP_RUN_REPORT_H_
#define HINDSIGHT_APP_RUN_REPORT_H_

#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "io/summary.h"
#include "problems/reconstruction.h"
#include "state/solution.h"

namespace hindsight {

/// How the initial state was found, with its standard deviations.
std::string DescribeStart(const StartReport& start);

/// What readers did under declared policies, and withholding rules that no
/// outage came of, a line each.
std::string DescribeNotes(const Dataset& dataset);

/// Warnings of states that the data do not determine, a line each.
std::string DescribeUnobserved(const std::vector<UnobservedSpan>& spans);

/// Estimated constants of the last usable method: value, sigma (angles in
/// degrees), verdict and, where it helps, the motion that would; and the whole
/// mounting that a mounting's correction belongs to. Nothing if there is none.
std::string DescribeConstants(const Dataset& dataset,
                              const std::vector<Solution>& solutions);

/// The spans that a method's own covariances call unobserved and that `known`
/// lacks, a line each.
std::string DescribeOwnUnobserved(const std::vector<UnobservedSpan>& known,
                                  const std::vector<Solution>& solutions);

/// A line for each method whose position is far from the truth by its own
/// covariances: a mean normalised squared error above 100, where 3 is right.
std::string DescribeIncredible(const RunSummary& summary);

/// The last line: whether the result is usable, and why, by the last usable
/// method, and which methods failed.
std::string DescribeVerdict(const std::vector<Solution>& solutions);

/// What self-tuning methods found out, a line each; "" if there is nothing.
std::string DescribeMethodNotes(const std::vector<Solution>& solutions);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_REPORT_H_
