#ifndef HINDSIGHT_IO_WRITE_SUMMARY_H_
#define HINDSIGHT_IO_WRITE_SUMMARY_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dataset/allan.h"
#include "dataset/dataset.h"
#include "evaluation/broad_metric.h"
#include "evaluation/outages.h"
#include "evaluation/residual_statistics.h"
#include "evaluation/solution_table.h"
#include "evaluation/trajectory_error.h"
#include "io/read/file_digest.h"
#include "state/solution.h"

namespace hindsight {

/// How the initial state came about, in words, and how well it is known.
struct StartSummary {
  double t = 0.0;         ///< [s]
  std::string alignment;  ///< the method: "velocity", "course", ...
  std::string why;        ///< it was chosen, and what others would give
  std::string position;   ///< "given", "first position fix", ...
  std::string attitude;   ///< "given", "levelled at rest for 12.3 s", ...
  std::string heading;    ///< "given", "course at t = 31.2 s", ...
  Eigen::Vector3d position_sigma = Eigen::Vector3d::Zero();  ///< NED [m]
  Eigen::Vector3d velocity_sigma = Eigen::Vector3d::Zero();  ///< NED [m/s]
  /// Roll, pitch, heading [rad].
  Eigen::Vector3d attitude_sigma = Eigen::Vector3d::Zero();
};

/// A span of the recording, of one stream or of none.
struct StreamSpan {
  std::string stream;
  double t_begin = 0.0;  ///< [s]
  double t_end = 0.0;    ///< [s]
};

/// What the receiver of one stream of positions said of itself.
struct FixSummary {
  std::string stream;
  long count = 0;
  std::map<int, long> by_quality;    ///< fixes of each; empty: not said
  std::optional<double> satellites;  ///< mean, of the fixes that tell them
};

/// The whole mounting of a sensor that a correction was estimated of.
struct MountingSummary {
  std::string sensor;
  Eigen::Vector3d euler;  ///< roll, pitch, yaw, vehicle from body [rad]
};

/// The figures of one method.
struct MethodSummary {
  std::string method;
  double seconds = 0.0;  ///< processor time of the method alone
  std::optional<double> peak_rss_mb;
  bool converged = true;
  int iterations = 0;
  Grade grade = Grade::kUsable;
  std::vector<Evidence> evidence;
  std::string verdict;
  /// What the truth says against the covariances, in words; empty: nothing.
  std::string contradiction;
  std::optional<TrajectoryStatistics> error;  ///< absent without truth
  std::optional<BroadMetric> broad;           ///< of attitude alone
  /// Share of the readings of the magnetic field that were taken for disturbed.
  std::optional<double> field_disturbed;
  std::vector<OutageError> outages;
  std::vector<std::string> outage_sensors;  ///< stream of each outage
  std::vector<ResidualStatistics> residuals;
  std::vector<ConstantEstimate> constants;
  Eigen::MatrixXd constant_covariance;  ///< of their errors; may be empty
  std::vector<MountingSummary> mountings;
  std::vector<UnobservedSpan> unobserved;
  std::vector<RivalSolution> rivals;
  std::optional<ObserverFigures> observer;
  std::vector<std::string> found;  ///< Solution::notes
  std::optional<double> duration;  ///< from the first to the last state [s]
  std::optional<double>
      distance;  ///< over the Earth, integral of the speed [m]
};

/// The figures of a run.
struct RunSummary {
  std::string program;  ///< "hindsight 0.1.0"
  std::string dataset;
  /// All methods asked for have ended and all files are written.
  bool complete = false;
  std::optional<std::int64_t> epoch_gps_ns;  ///< see Dataset
  std::string constants_from = {};  ///< KnownConstants::source; empty: none
  /// See ConstantsOfOneRecording.
  std::vector<std::string> constants_of_recording = {};
  std::vector<FileDigest> inputs = {};
  std::vector<FixSummary> fixes = {};
  std::optional<StartSummary> start;
  std::vector<PolicyCount> policies;
  std::vector<std::string> warnings = {};  ///< of the recording, CheckReport
  std::vector<std::string> notes = {};     ///< NotesOf
  /// What the data do not determine, of the filter that starts every method.
  std::vector<UnobservedSpan> unobserved = {};
  std::vector<StreamSpan> gaps = {};   ///< without rows, longer than usual
  std::vector<StreamSpan> rests = {};  ///< in which the vehicle stands
  std::optional<ImuAllan> allan = {};  ///< of the longest rest
  /// The best method, whose grade is that of the run; empty: none.
  std::string best;
  std::vector<MethodSummary> methods;
};

/// What is told of the recording beside warnings: drop-outs of the IMU that are
/// bridged, ten at most, and Dataset::notes.
std::vector<std::string> NotesOf(const Dataset& dataset);

/// That no outage came of the withholding rules, or "".
std::string WithholdingWarning(const Dataset& dataset);

/// A summary of each stream that measures positions.
std::vector<FixSummary> SummarizeFixes(const Dataset& dataset);

/// The mounting of each sensor for which the solution corrects it.
std::vector<MountingSummary> MountingsOf(const Dataset& dataset,
                                         const Solution& solution);

/// Compares `solution` with withheld measurements. `error` is what a comparison with
/// the data set's truth says (CompareWithTruth), at the point that the truth speaks
/// of and, where the solution can be sampled through the IMU, at TruthTimes.
MethodSummary SummarizeMethod(const Dataset& dataset, const Solution& solution,
                              const std::optional<TrajectoryStatistics>& error);

/// Times of the truth points within [from, to] [s].
std::vector<double> TruthTimes(const TruthSeries& truth, double from,
                               double to);

/// Puts what a comparison with a truth says, `contradicts_truth`, `error` and
/// `nees`, into the figures of a method, in place of what they say of it.
void PutTruthFigures(const TrajectoryStatistics& statistics,
                     const std::string& contradiction,
                     nlohmann::ordered_json* method);

/// The keys of summary.json. A figure that does not exist is absent. Vectors
/// are [north, east, down] or [roll, pitch, heading]; errors are truth minus
/// estimate.
///
///   program, dataset
///   complete                    false: the run was interrupted, these are
///                               the methods that were done, and no best is
///   epoch                       t = 0; absent if the clock has no date
///     gps_week, gps_second, utc       "yyyy-mm-ddThh:mm:ss.sssZ"
///   constants_from              the result that `constants` took them from
///   constants_of_recording[]    names, without axes, of what is estimated that
///                               says nothing of another recording
///   datum                       of positions and heights, in words; absent
///                               of attitude alone
///   inputs[]                    path, bytes, sha256; files, of a folder: how
///                               many (io/read/file_digest.h)
///   fixes.<stream>              count, satellites_mean, quality_percent: of
///                               each quality the receiver's share of its fixes
///   start                       how the initial state came about
///     t_s, position, attitude, heading, alignment, why        words
///     position_sigma_m, velocity_sigma_mps, attitude_sigma_deg
///   policies[]                  what readers did as the configuration allows
///     stream, action, count
///   warnings[], notes[]         of the recording, in words
///   unobserved[]                before any method ran, as of a method below
///   allan                       of the longest rest: io/write/allan_json.h
///   gaps[], rests[]             stream, t_begin_s, t_end_s: spans without
///                               rows, and at rest (no stream)
///   best, grade                 the best method, and its grade
///   methods.<name>
///     seconds                   processor time of the method alone
///     peak_rss_mb               of the process when the method had ended
///     duration_s, distance_m    of the solution, the way over the Earth
///     found[]                   by a self-tuning method, in words
///     converged, iterations     iterations only of a method that iterates
///     grade                     "usable", "doubtful" or "not usable"
///     verdict                   the grade and why, in words
///     evidence[]                what the grade is concluded from, no truth
///       rule                    that found it
///       grade                   the best that a result with it can have
///       what                    in words
///       value, limit, unit      the figure, and where it lowers the grade
///       span_s                  [from, to] that it speaks of
///       likely_causes[], what_to_try[]          words
///     contradicts_truth         what the truth says against the covariances,
///                               in words; has no part in the grade
///     error                     against the truth
///       position_rms_m, position_max_m, horizontal_rms_m, horizontal_max_m,
///       end_horizontal_m (at the last truth point), distance_m (way of truth),
///       total_rms_m, total_max_m
///       velocity_rms_mps, velocity_max_mps
///       attitude_rms_deg, attitude_max_deg, tilt_rms_deg
///       matched_percent         truth points that could be compared
///     broad                     of attitude alone, the BROAD benchmark's
///                               errors
///     field_disturbed_percent   of attitude alone, of the magnetometer's
///                               readings
///       total_rmse_deg, heading_rmse_deg, inclination_rmse_deg
///       count                   reference points in motion
///     withheld                  against withheld position measurements, all
///                               measurements of all outages together
///       horizontal_rms_m, horizontal_max_m, total_rms_m, total_max_m
///       velocity_horizontal_rms_mps, velocity_horizontal_max_mps
///       outages[]: sensor, t_begin_s, t_end_s, count,
///         horizontal_rms_m, horizontal_max_m, total_rms_m, total_max_m (_mps
///         in place of _m for a velocity sensor), distance_m, drift_percent
///     nees                      mean normalised squared errors, each of 3
///       position, velocity, attitude            degrees of freedom;
///       attitude_inside_3_sigma_percent  points within the ellipsoid that holds
///                               99.73 %
///     residuals.<sensor>        count, rejected, withheld, normalized_rms;
///                               unit and components[] where all have the same;
///                               supposed: true of constraints and rests
///     constants.<name>          value, sigma, unit, prior_value, prior_sigma,
///                               verdict ("observed", "weak", "unobserved"),
///                               advice
///     constant_correlations[]   of their errors, a row each in their order
///     mountings.<sensor>        roll_deg, pitch_deg, yaw_deg: whole mounting,
///                               vehicle from body
///     unobserved[]              component, t_begin_s, t_end_s, sigma (SI)
///     rivals[]                  other explanations, the likeliest first
///       description, probability
///       log_evidence            less that of the chosen one
///       differences[]           quantity, value, unit (SI): rival minus chosen
///     observer                  of hinf and modified_hinf alone
///       gamma_sqrt_s, or alpha_per_s and delta_per_s; steps;
///       back_offs               steps at which gamma or delta was dropped
///       least_information       smallest share of the information on what is
///                               bounded that the weight left at the other
///                               steps, 0 being the escape
nlohmann::ordered_json SummaryJson(const RunSummary& summary);

/// SummaryJson, indented: the text of summary.json.
std::string SummaryText(const RunSummary& summary);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_SUMMARY_H_
