#ifndef HINDSIGHT_APP_RUN_REPORT_H_
#define HINDSIGHT_APP_RUN_REPORT_H_

#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "io/write/summary.h"
#include "io/write/table.h"
#include "problems/reconstruction.h"
#include "state/solution.h"

namespace hindsight {

/// How the initial state was found, with its standard deviations.
std::string DescribeStart(const StartReport& start);

/// The same and the a priori sigmas of the biases, each line a comment of a
/// configuration.
std::string CommentOnStart(const StartReport& start, const InitialState& given);

/// What readers did under declared policies, `notes` (NotesOf), what is withheld
/// when, and rules of withholding that no outage came of, a line each.
std::string DescribeNotes(const Dataset& dataset,
                          const std::vector<std::string>& notes);

/// Warnings of states that the data do not determine, a line each.
std::string DescribeUnobserved(const std::vector<UnobservedSpan>& spans);

/// Estimated constants of a solution: value, sigma (angles in degrees), verdict
/// and, where it helps, the motion that would; and the whole mounting that a
/// mounting's correction belongs to. Nothing if there is none.
std::string DescribeConstants(const Dataset& dataset, const Solution& solution);

/// The spans that a method's own covariances call unobserved and that `known`
/// lacks, a line each.
std::string DescribeOwnUnobserved(const std::vector<UnobservedSpan>& known,
                                  const std::vector<Solution>& solutions);

/// What speaks against each solution, a line each.
std::string DescribeEvidence(const std::vector<Solution>& solutions,
                             const TableStyle& style);

/// What the truth says against each method, a line each. The grades know
/// nothing of it.
std::string DescribeContradictions(const RunSummary& summary);

/// Notes the best solution in the summary, and the evidence as it stands after
/// all methods have run.
void NameBest(const Solution& best, const std::vector<Solution>& solutions,
              RunSummary* summary);

/// The last line: the grade of the best solution, and the weightiest reason.
std::string DescribeVerdict(const Solution& best, const TableStyle& style);

/// The other explanations of the data that are more than 0.1 % likely, a line
/// each; "" if there is none.
std::string DescribeRivals(const std::vector<Solution>& solutions);

/// What self-tuning methods found out, a line each; "" if there is nothing.
std::string DescribeMethodNotes(const std::vector<Solution>& solutions);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_REPORT_H_
