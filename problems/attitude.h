#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alignment/attitude_start.h"
#include "attitude/attached_magnet.h"
#include "attitude/attitude_run.h"
#include "attitude/attitude_samples.h"
#include "attitude/attitude_smoother.h"
#include "attitude/field_survey.h"
#include "attitude/magnetometer_errors.h"
#include "dataset/dataset.h"
#include "evaluation/grade.h"
#include "evaluation/innovation_test.h"
#include "problems/disagreement.h"
#include "problems/estimation.h"
#include "state/solution.h"

namespace hindsight {

/// One recording, its attitude alone estimated from an IMU and, as far as there
/// are any, a magnetometer, sensors of directions (`heading`) and velocities over
/// the Earth (`velocity`); no position is needed. Solutions have the layout
/// {attitude, gyro bias}, one state an IMU sample, and are given at the stamps
/// of the file (ImuStream::stamp_offset); the scale factors of the gyros, which
/// both methods estimate, are constants of the smoother's.
/// The smoother knows beforehand where the body rests (FindRest). Of the field
/// it knows beforehand what surveys of the whole recording find
/// (field_survey.h): a first one by the tilt of a solution without the field, a
/// second one by the attitudes of the solution that this leads to. It takes the
/// readings with the weights of the survey, without the hard iron and at the
/// times that were found by the first solution (magnetometer_errors.h), and
/// without magnets that travel along for a part of the time
/// (attached_magnet.h). Without `AhrsSettings::survey` it takes them as the
/// filter does.
class AttitudeEstimation final : public Estimation {
 public:
  /// `dataset` must outlive the object. Throws InputError if there are no
  /// samples in the asked interval.
  AttitudeEstimation(const Dataset& dataset, ReconstructionOptions options);

  /// Throws EstimationError, Interrupted.
  Solution Run(const Method& method) override;
  const StartReport* start() const override { return nullptr; }
  std::vector<UnobservedSpan> Unobserved() override { return {}; }
  /// Of the method run last.
  std::vector<NormalisedInnovation> Innovations() override {
    return innovations_;
  }
  Solution Sample(const Solution& solution,
                  const std::vector<double>& times) const override;

  /// The methods themselves, without verdict and name.
  Solution Filter();
  Solution Smoother();

 private:
  /// A run of the filter, smoothed.
  struct Pass {
    AttitudeRun run;
    std::vector<SmoothedAttitude> smoothed;
    FieldSurvey survey;  ///< that it was made with
    MagnetometerErrors magnetometer;
    std::vector<AttachedMagnet> magnets;  ///< for a part of the time
  };
  /// `forces` in place of the IMU's, as in AttitudeReadings.
  Pass Smooth(const AttitudeState& start, std::span<const BiasedForce> forces,
              std::span<const MagneticSample> magnetic,
              const AttitudeFilterOptions& options, const std::string& stage,
              bool covariances) const;
  Pass SmoothWithoutSurvey(std::span<const BiasedForce> forces,
                           const AttitudeFilterOptions& options) const;
  /// Solves with a survey by the tilt of `level`; if that solution shows errors
  /// of the magnetometer, once more without them; and at last with a survey by
  /// the attitudes so found.
  Pass SmoothSurveyed(std::span<const BiasedForce> forces,
                      const std::vector<Eigen::Quaterniond>& level,
                      AttitudeFilterOptions options) const;
  /// Readings 0.1 s apart, less `errors`; `q_nb` at every sample.
  std::vector<SurveyedField> FieldReadings(
      const std::vector<Eigen::Quaterniond>& q_nb,
      const MagnetometerErrors& errors) const;
  Solution SolutionOf(const Pass& pass);
  /// What all headings share beside P: the magnetometer's stated a priori
  /// sigmas, which north the survey leaves open, and the place (PlaceSigma) [rad].
  double SharedSigma(const FieldSurvey& survey) const;
  /// Down over horizontal part of the field that gives the heading as if the
  /// tilt were known; 0 if none does.
  double SharedSlope(const FieldSurvey& survey) const;
  /// Adds to evidence_ what the smoother finds, of a magnetometer and of the
  /// start too: a filter sees neither while it runs, and is as wrong by them.
  /// Returns whether the smoother, if its own innovations are not what makes a
  /// solution unusable, vouches for the filter: Judged::vouched_for.
  bool JudgeFilterByAll(const std::optional<StartValues>& start,
                        std::span<const Sensor> sensors,
                        const Solution& filtered);
  /// Adds to evidence_ what the smoother's solution and innovations_, its own,
  /// show: a drop-out of the IMU that fits better as a leap of its clock
  /// (imu_leaps.h); gyro scales or accelerometer biases far from their a priori
  /// value; a bias of the accelerometers (accel_bias_fit.h) that tilts by
  /// kUnusableBias stated sigmas.
  void JudgeWhole(const Solution& whole);
  void JudgeLeaps();
  void JudgeAccelerometers(const Solution& whole);
  /// What the solutions, or the filter's, make no use of, in words.
  std::vector<std::string> Unused() const;
  std::vector<std::string> UnusedByFilter() const;
  /// What the recording shows by itself, and what speaks against the heading.
  std::vector<Evidence> ExamineRecording() const;
  ErrorLayout SolutionLayout() const;
  State StateAt(double t, const Eigen::Quaterniond& q_nb,
                const Eigen::Vector3d& b_g) const;
  void Poll(const std::string& stage, double fraction) const;

  const Dataset& dataset_;
  ReconstructionOptions options_;
  /// Of the asked interval, rates; forces of another unit over force_ratio_.
  ImuStream imu_;
  double force_ratio_ = 1.0;  ///< of the forces' median to gravity
  std::vector<MagneticSample> magnetic_;
  std::vector<HeadingSample> headings_;
  std::vector<VelocitySample> velocities_;  ///< none if no heading is told
  AttitudeFilterOptions filter_options_;
  Eigen::Quaterniond q_en_;
  AttitudeState start_;
  /// What speaks against the magnetometer, its field or the start.
  std::vector<Evidence> evidence_;
  /// Of the method run last, by AttitudeInnovation::Source.
  std::vector<NormalisedInnovation> innovations_;
  MethodComparison methods_{AttitudeTerms()};
  /// Whether the body rests from each sample to the next; smoother alone.
  std::vector<bool> rests_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_H_
