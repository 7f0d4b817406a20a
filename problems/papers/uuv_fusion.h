#ifndef HINDSIGHT_PROBLEMS_PAPERS_UUV_FUSION_H_
#define HINDSIGHT_PROBLEMS_PAPERS_UUV_FUSION_H_

#include <array>
#include <string>
#include <vector>

#include "filters/track_fusion.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// \file
/// "Improvement of Position Estimation Based on the Multisensor Fusion in
/// Underwater Unmanned Vehicles", Lee and Yoon 2011, as printed: state
/// [x vx y vy z vz] per sensor, A and H of section 3.2 with T = 1 s, Q = w^2 I
/// with w = 10 (INS) and 1 (DVL), R = v^2 I with v = 9.8 and 0.02.

/// What the paper leaves open or prints so that it can be meant two ways.
struct UuvReading {
  /// H = [1 1] adds position and velocity, as printed; or takes the position.
  bool adds_velocity = true;
  /// Q = w^2 I, as printed; or w is a white acceleration, Q = w^2 G G' with
  /// G = (T^2/2, T).
  bool diagonal_noise = true;
  /// A sensor's error is white, as eq. (6) has it; or it adds up from epoch to
  /// epoch, as sections 2.1.1 and 3.1 describe, and for the INS of the
  /// equalised architecture from what is fed back.
  bool white_errors = true;
  /// The central filter weighs each sensor by its R; or both alike, by the mean
  /// of the two.
  bool weighs_by_noise = true;

  /// "sum,diagonal,white,by_noise"; the other words are position, acceleration,
  /// accumulating, alike.
  std::string Name() const;
};
/// All 16, that which is as printed first.
std::vector<UuvReading> UuvReadings();

/// True states [x vx y vy z vz], one a second.
using UuvTruth = std::vector<ErrorVector>;

/// The sensors of the paper, INS and DVL, under a reading.
std::array<LinearSensor, 2> UuvSensors(const UuvReading& reading);

/// Every architecture on measurements of the path, under a reading.
Case UuvSearch(const UuvReading& reading, const UuvTruth& path);
/// The same, of that name, on states that move as the DVL's own A and Q say,
/// drawn anew for each run, and both filters know it; H takes the position,
/// `sigma` are the sensors' [m]. There nees judges the architecture alone.
Case MatchedSearch(const std::string& name, const std::array<double, 2>& sigma,
                   int epochs = 1000);

/// Figures, in columns reading and architecture: of the distance error over all
/// epochs and runs, spatial (3-D) and horizontal (2-D), _mean and _std; nees,
/// mean of e' P^-1 e / 6 (right is 1).
StudyTable FusionTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_UUV_FUSION_H_
