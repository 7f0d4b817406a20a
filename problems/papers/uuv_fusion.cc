#include "problems/papers/uuv_fusion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "evaluation/statistics.h"

namespace hindsight {
namespace {

constexpr int kStates = 6;
constexpr int kAxes = 3;
constexpr double kStep = 1.0;
constexpr double kInsProcess = 10.0;
constexpr double kDvlProcess = 1.0;
constexpr double kInsSigma = 9.8;
constexpr double kDvlSigma = 0.02;

LinearSensor MakeSensor(const UuvReading& reading, double w, double v) {
  LinearSensor sensor;
  sensor.A.setIdentity(kStates, kStates);
  sensor.Q.setZero(kStates, kStates);
  sensor.H.setZero(kAxes, kStates);
  sensor.R = v * v * RowMatrix::Identity(kAxes, kAxes);
  Eigen::Matrix2d Q = Eigen::Matrix2d::Identity();
  if (!reading.diagonal_noise) {
    const Eigen::Vector2d G(0.5 * kStep * kStep, kStep);
    Q = G * G.transpose();
    // A white acceleration leaves one combination of the two without noise,
    // which an information filter cannot invert.
    Q.diagonal().array() += 1e-6;
  }
  for (int axis = 0; axis < kAxes; ++axis) {
    sensor.A(2 * axis, 2 * axis + 1) = kStep;
    sensor.Q.block<2, 2>(2 * axis, 2 * axis) = w * w * Q;
    sensor.H(axis, 2 * axis) = 1.0;
    sensor.H(axis, 2 * axis + 1) = reading.adds_velocity ? 1.0 : 0.0;
  }
  return sensor;
}

using Sensors = std::array<LinearSensor, 2>;

/// What is fused: the sensors, how the central filter sees them, and how their
/// errors are drawn.
struct Fused {
  Sensors sensors;
  Sensors central;
  std::array<double, 2> sigma;
  bool white_errors = true;
};

void Follow(FusionArchitecture architecture, const Fused& fused,
            const UuvTruth& truth, RunRecord* record) {
  const Sensors& sensors = architecture == FusionArchitecture::kCentral
                               ? fused.central
                               : fused.sensors;
  std::array<Random, 2> noise = {Random(record->seed, 1),
                                 Random(record->seed, 2)};
  std::array<Eigen::Vector3d, 2> error = {Eigen::Vector3d::Zero(),
                                          Eigen::Vector3d::Zero()};
  const auto fusion =
      MakeFusion(architecture, sensors,
                 {truth.front(), ErrorMatrix::Identity(kStates, kStates)});
  std::vector<double> horizontal, spatial, nees;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    std::array<RowVector, 2> z;
    for (std::size_t i = 0; i < 2; ++i) {
      if (fused.white_errors) error[i].setZero();
      error[i] += fused.sigma[i] * noise[i].NormalVector3();
      z[i] = sensors[i].H * truth[k] + error[i];
    }
    const Track track = fusion->Step(z[0], z[1]);
    const ErrorVector e = truth[k] - track.x;
    horizontal.push_back(std::hypot(e(0), e(2)));
    spatial.push_back(std::hypot(e(0), e(2), e(4)));
    nees.push_back(e.dot(track.P.llt().solve(e)) / kStates);
    if (architecture == FusionArchitecture::kEqualised) {
      error[0] = sensors[0].H * (track.x - truth[k]);
    }
  }
  record->values = {{"spatial_mean", Mean(spatial)},
                    {"spatial_rms", Rms(spatial)},
                    {"horizontal_mean", Mean(horizontal)},
                    {"horizontal_rms", Rms(horizontal)},
                    {"nees", Mean(nees)}};
}

/// Truth that moves as the sensor's A and Q say.
UuvTruth DrawTruth(const LinearSensor& sensor, int epochs, std::uint64_t seed) {
  Random random(seed, 3);
  const ErrorMatrix L = sensor.Q.llt().matrixL();
  UuvTruth truth = {ErrorVector::Zero(kStates)};
  for (int k = 1; k <= epochs; ++k) {
    ErrorVector u(kStates);
    for (double& value : u) value = random.Normal();
    truth.push_back(sensor.A * truth.back() + L * u);
  }
  return truth;
}

Case FusionCase(const std::string& name, const Fused& fused,
                const std::function<UuvTruth(std::uint64_t)>& truth_of) {
  return {{name},
          {},
          {{}, [=](const Dataset&, CaseRun* run) {
             const UuvTruth truth = truth_of(run->seed);
             for (const FusionArchitecture one : kFusionArchitectures) {
               Follow(one, fused, truth, run->Add(0, {FusionName(one)}));
             }
           }}};
}

/// Standard deviation about the mean over all runs and epochs.
double Scatter(const RunCell& cell, const std::string& distance) {
  const double rms = Rms(cell.Values(distance + "_rms"));
  const double mean = Mean(cell.Values(distance + "_mean"));
  return std::sqrt(std::max(0.0, rms * rms - mean * mean));
}

}  // namespace

std::string UuvReading::Name() const {
  return std::string(adds_velocity ? "sum" : "position") +
         (diagonal_noise ? ",diagonal" : ",acceleration") +
         (white_errors ? ",white" : ",accumulating") +
         (weighs_by_noise ? ",by_noise" : ",alike");
}

std::vector<UuvReading> UuvReadings() {
  std::vector<UuvReading> readings;
  for (unsigned other = 0; other < 16; ++other) {
    readings.push_back({.adds_velocity = (other & 1U) == 0,
                        .diagonal_noise = (other & 2U) == 0,
                        .white_errors = (other & 4U) == 0,
                        .weighs_by_noise = (other & 8U) == 0});
  }
  return readings;
}

std::array<LinearSensor, 2> UuvSensors(const UuvReading& reading) {
  return {MakeSensor(reading, kInsProcess, kInsSigma),
          MakeSensor(reading, kDvlProcess, kDvlSigma)};
}

Case UuvSearch(const UuvReading& reading, const UuvTruth& path) {
  const Sensors sensors = UuvSensors(reading);
  Sensors central = sensors;
  if (!reading.weighs_by_noise) {
    central[0].R = central[1].R = 0.5 * (sensors[0].R + sensors[1].R);
  }
  return FusionCase(
      reading.Name(),
      {sensors, central, {kInsSigma, kDvlSigma}, reading.white_errors},
      [path](std::uint64_t) { return path; });
}

Case MatchedSearch(const std::string& name, const std::array<double, 2>& sigma,
                   int epochs) {
  const UuvReading reading = {.adds_velocity = false};
  const Sensors sensors = {MakeSensor(reading, kDvlProcess, sigma[0]),
                           MakeSensor(reading, kDvlProcess, sigma[1])};
  return FusionCase(name, {sensors, sensors, sigma},
                    [sensor = sensors[1], epochs](std::uint64_t seed) {
                      return DrawTruth(sensor, epochs, seed);
                    });
}

StudyTable FusionTable() {
  StudyTable table = {"cells", {"reading", "architecture"}};
  for (const std::string distance : {"spatial", "horizontal"}) {
    table.Add({{distance + "_mean", kMetres, OfRuns(Mean)},
               {distance + "_std", kMetres, Scatter, distance}});
  }
  table.Add({{"nees", kPlain, OfRuns(Mean)}});
  return table;
}

}  // namespace hindsight
