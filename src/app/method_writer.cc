#include "app/method_writer.h"

#include <memory>
#include <utility>
#include <vector>

#include "app/method_output.h"
#include "base/parallel.h"

namespace hindsight {
namespace {

/// Frees all of a written solution's series but its last state: of a day, 120
/// MB a method.
void ForgetTrajectory(Solution* solution) {
  if (!solution->states.empty()) {
    solution->states = std::vector<State>(1, solution->states.back());
  }
  solution->covariances = {};
  solution->two_filter.reset();
  solution->modes.reset();
  solution->attitude.reset();
}

}  // namespace

MethodWriter::MethodWriter(const RunRequest& request, const Dataset& dataset,
                           const Reconstruction& reconstruction,
                           RunSummary* summary, ResultFolder* folder)
    : request_(request),
      dataset_(dataset),
      reconstruction_(reconstruction),
      readings_(dataset.imu),
      summary_(summary),
      folder_(folder) {}

MethodWriter::~MethodWriter() {
  if (writing_.valid()) writing_.wait();
}

void MethodWriter::Add(Solution* solution) {
  CheckTimesCovered(request_, *solution);
  const double peak_rss_mb = PeakRssMb();
  auto output = std::make_unique<MethodOutput>(request_, dataset_, *solution,
                                               &readings_, folder_);
  MethodTables tables = SampleMethod(request_, dataset_, reconstruction_,
                                     *solution, output.get());
  output->EndRows();
  // Files get their names when those of the one before are all there: of a method
  // that is not done yet none stay if the run ends early.
  if (writing_.valid()) writing_.get();
  writing_ =
      InBackground([this, solution, peak_rss_mb, output = std::move(output),
                    tables = std::move(tables)]() mutable {
        std::exchange(output, nullptr)->Commit();
        Write(peak_rss_mb, std::exchange(tables, {}), solution);
      }).share();
  if (ThreadCount() == 1) writing_.get();
  folder_->WaitFor(writing_);
}

void MethodWriter::Finish() const { writing_.get(); }

void MethodWriter::Write(double peak_rss_mb, MethodTables tables,
                         Solution* solution) {
  CompareTables(dataset_, &tables);
  summary_->methods.push_back(Summarize(dataset_, *solution, tables));
  summary_->methods.back().peak_rss_mb = peak_rss_mb;
  WriteMethodFiles(dataset_, *solution, tables, folder_);
  const bool has_trajectory = !solution->states.empty();
  ForgetTrajectory(solution);
  if (has_trajectory) folder_->Keep(kSummaryName, SummaryText(*summary_));
}

}  // namespace hindsight
