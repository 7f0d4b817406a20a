#include "app/load_recording.h"

#include <fmt/core.h>

#include "alignment/mounting_search.h"
#include "alignment/start_layout.h"
#include "app/run_output.h"
#include "base/error.h"
#include "dataset/injection.h"
#include "evaluation/truth_comparison.h"
#include "measurements/sensor_kind.h"
#include "problems/rest_by_estimate.h"

namespace hindsight {
namespace {

/// The rules of the command line in place of the configuration's.
void ReplaceWithholdings(const std::vector<Withholding>& withholdings,
                         Dataset* dataset) {
  for (AidingStream& stream : dataset->streams) {
    for (Measurement& z : stream.measurements.Edited()) z.withheld = false;
  }
  dataset->outages.clear();
  dataset->withholdings = withholdings;
  ApplyWithholding(dataset);
}

/// What the clean positions say, to judge by when errors are injected into data
/// without a truth of their own.
void KeepCleanPositions(Dataset* dataset) {
  if (!dataset->truth.empty()) return;
  for (std::size_t i = 0; i < dataset->streams.size(); ++i) {
    const AidingStream& stream = dataset->streams[i];
    if (!stream.sensor.kind->is_position || stream.measurements.empty()) {
      continue;
    }
    dataset->truth_stream = i;
    dataset->truth_lever_arm_b = stream.sensor.lever_arm_b;
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();
    for (const Measurement& z : stream.measurements) {
      const auto& fix = std::get<PositionFix>(z.model);
      TruthPoint point;
      point.t = z.t + stream.sensor.time_offset;
      point.p_e = fix.p_e;
      dataset->truth.push_back(point);
      variance += fix.R_n.diagonal();
    }
    const auto count = static_cast<double>(dataset->truth.size());
    dataset->truth_sigma.position = (variance / count).cwiseSqrt();
    std::string action = "positions before injection taken as truth";
    if (stream.sensor.time_offset_sigma || stream.sensor.lever_arm_sigma) {
      action += ", at the time offset and lever arm that each method estimates";
    }
    dataset->policies.push_back(
        {stream.sensor.name, action, static_cast<long>(dataset->truth.size())});
    return;
  }
}

/// Adds the errors asked for, and says so in the data set's name and in the
/// resolved configuration.
void Inject(const RunRequest& request, Dataset* dataset,
            ResolvedConfig* resolved) {
  if (request.injections.empty()) return;
  KeepCleanPositions(dataset);
  try {
    ApplyInjections(request.injections, request.seed,
                    {request.from, request.to}, dataset);
  } catch (const InputError& error) {
    throw InputError(std::string("--inject: ") + error.what());
  }
  std::string lines;
  for (const Injection& injection : dataset->injections) {
    lines += "# Error injected on purpose: " + Describe(injection) + "\n";
  }
  resolved->yaml = lines + resolved->yaml;
  dataset->name += " (with injected errors)";
}

/// Samples closer than the IMU's own say nothing new and fill the disk.
void CheckRate(const RunRequest& request, const ImuStream& imu) {
  const double imu_rate = static_cast<double>(imu.samples.size() - 1) /
                          (imu.t_end() - imu.t_begin());
  if (request.rate.value_or(0.0) > 2.0 * imu_rate) {
    throw InputError(
        fmt::format("--rate={:g} Hz is more than twice the IMU's {:g} Hz",
                    *request.rate, imu_rate));
  }
}

/// What a trajectory needs beyond what attitude alone does.
void PrepareTrajectory(const RunRequest& request, Dataset* dataset) {
  ResolveMountings(dataset);
  AddDecidedRest(request.from, request.to, dataset);
  ThinTruth(&dataset->truth);
}

}  // namespace

Dataset LoadRecording(const RunRequest& request, ReadDigests* digests,
                      ResolvedConfig* resolved) {
  LoadOptions options = LoadOptionsOf(request);
  options.digests = digests;
  Dataset dataset = LoadDataset(request.config, options, resolved);
  if (!request.ahrs_rule.empty()) dataset.ahrs.rule = request.ahrs_rule;
  if (!request.attitude_alone) RequireCapacity(dataset, request.config);
  if (!request.withholdings.empty()) {
    ReplaceWithholdings(request.withholdings, &dataset);
    SetWithholdings(request.withholdings, resolved);
  }
  Inject(request, &dataset, resolved);
  CheckRate(request, dataset.imu);
  if (!request.attitude_alone) PrepareTrajectory(request, &dataset);
  return dataset;
}

}  // namespace hindsight
