#ifndef HINDSIGHT_APP_METHOD_WRITER_H_
#define HINDSIGHT_APP_METHOD_WRITER_H_

#include <future>

#include "app/result_folder.h"
#include "app/row_readings.h"
#include "app/run_output.h"
#include "app/run_request.h"
#include "io/write/summary.h"
#include "problems/reconstruction.h"

namespace hindsight {

/// Writes the files of methods: of each first its rows, sampled through the IMU; what
/// it has besides while the next one is solved and sampled. Nobody else touches the
/// summary's methods and the solutions meanwhile.
class MethodWriter {
 public:
  /// References stay valid as long as the object.
  MethodWriter(const RunRequest& request, const Dataset& dataset,
               const Reconstruction& reconstruction, RunSummary* summary,
               ResultFolder* folder);
  /// Lets what goes on beside come to its end.
  ~MethodWriter();
  MethodWriter(const MethodWriter&) = delete;
  MethodWriter& operator=(const MethodWriter&) = delete;

  /// Writes the rows of a solution and begins with the rest, of which its last state
  /// remains; with one thread all is done then. Throws InputError if a time of --at is
  /// outside its span, and what went wrong with those before.
  void Add(Solution* solution);
  /// Waits for the last; throws what went wrong.
  void Finish() const;

 private:
  void Write(double peak_rss_mb, MethodTables tables, Solution* solution);

  const RunRequest& request_;
  const Dataset& dataset_;
  const Reconstruction& reconstruction_;
  RowReadings readings_;
  RunSummary* summary_;
  ResultFolder* folder_;
  std::shared_future<void> writing_;  ///< of the method added last
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_METHOD_WRITER_H_
