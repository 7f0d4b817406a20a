#ifndef HINDSIGHT_APP_CAMPAIGN_SLURM_H_
#define HINDSIGHT_APP_CAMPAIGN_SLURM_H_

#include <filesystem>
#include <functional>
#include <string>

#include "app/child_process.h"

namespace hindsight {

/// A campaign's workers as an array of jobs of Slurm.
struct SlurmJob {
  std::filesystem::path folder;  ///< of the campaign, absolute
  int tasks = 1;                 ///< one worker each
  ChildLimits limits;            ///< of each item
  double stale_after = 60.0;     ///< [s]
  std::string options;           ///< further ones of sbatch
};

/// The script that sbatch takes. Each task works on items one after the other
/// until none is left, by this program at its present path. It asks for the
/// memory limit and 100 MB.
std::string SlurmScript(const SlurmJob& job);

/// Hands the script to sbatch, unless the job that this folder's last call
/// handed over is still waiting or running; the job's number. Throws UsageError
/// where there is no sbatch, EstimationError if it refuses, OutputError.
std::string SubmitSlurm(const SlurmJob& job);

/// Waits until `is_done`, called every few seconds, or the job has left Slurm's
/// queue.
void WatchSlurm(const std::string& job, const std::function<bool()>& is_done);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_SLURM_H_
