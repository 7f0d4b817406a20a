#include "problems/papers/uuv_fusion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
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

struct Word {
  const char* printed;
  const char* other;
  bool UuvReading::*bit;
};
constexpr Word kWords[] = {
    {"sum", "position", &UuvReading::adds_velocity},
    {"diagonal", "acceleration", &UuvReading::diagonal_noise},
    {"white", "accumulating", &UuvReading::white_errors},
    {"by_noise", "alike", &UuvReading::weighs_by_noise},
};

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

/// The sensors' true standard deviations and how their errors go on.
struct Errors {
  std::array<double, 2> sigma;
  bool white = true;
};

using Sensors = std::array<LinearSensor, 2>;

/// One run under one architecture.
void Follow(FusionArchitecture architecture, const Sensors& sensors,
            const UuvTruth& truth, const Errors& errors, std::uint64_t seed,
            RunRecord* record) {
  std::array<Random, 2> noise = {Random(seed, 1), Random(seed, 2)};
  std::array<Eigen::Vector3d, 2> error = {Eigen::Vector3d::Zero(),
                                          Eigen::Vector3d::Zero()};
  const Track prior = {truth.front(), ErrorMatrix::Identity(kStates, kStates)};
  const auto fusion = MakeFusion(architecture, sensors, prior);
  std::vector<double> horizontal, spatial, nees;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    std::array<RowVector, 2> z;
    for (std::size_t i = 0; i < 2; ++i) {
      if (errors.white) error[i].setZero();
      error[i] += errors.sigma[i] * noise[i].NormalVector3();
      z[i] = sensors[i].H * truth[k] + error[i];
    }
    const Track fused = fusion->Step(z[0], z[1]);
    const ErrorVector e = truth[k] - fused.x;
    horizontal.push_back(std::hypot(e(0), e(2)));
    spatial.push_back(std::hypot(e(0), e(2), e(4)));
    nees.push_back(e.dot(fused.P.llt().solve(e)) / kStates);
    if (architecture == FusionArchitecture::kEqualised) {
      error[0] = sensors[0].H * (fused.x - truth[k]);
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

/// Every architecture on one truth, the central one with sensors of its own.
Case FusionCase(const std::string& name, const Sensors& sensors,
                const Sensors& central, const Errors& errors,
                const std::function<UuvTruth(std::uint64_t)>& truth_of) {
  const auto run = [=](const Dataset&, CaseRun* of_case) {
    const UuvTruth truth = truth_of(of_case->seed);
    for (const FusionArchitecture architecture : kFusionArchitectures) {
      const bool is_central = architecture == FusionArchitecture::kCentral;
      Follow(architecture, is_central ? central : sensors, truth, errors,
             of_case->seed, of_case->Add(0, {FusionName(architecture)}));
    }
  };
  return {{name}, {}, {{}, run}};
}

/// Standard deviation about the mean over all runs and epochs.
double Scatter(const RunCell& cell, const std::string& distance) {
  const double rms = Rms(cell.Values(distance + "_rms"));
  const double mean = Mean(cell.Values(distance + "_mean"));
  return std::sqrt(std::max(0.0, rms * rms - mean * mean));
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

}  // namespace

std::string UuvReading::Name() const {
  std::string name;
  for (const Word& word : kWords) {
    name += (name.empty() ? "" : ",") +
            std::string(this->*word.bit ? word.printed : word.other);
  }
  return name;
}

std::vector<UuvReading> UuvReadings(const std::string& words) {
  std::vector<UuvReading> readings;
  for (unsigned bits = 0; bits < 1U << std::size(kWords); ++bits) {
    UuvReading& reading = readings.emplace_back();
    for (std::size_t i = 0; i < std::size(kWords); ++i) {
      reading.*kWords[i].bit = (bits >> i & 1U) == 0;
    }
  }
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(',', begin), words.size());
    const std::string asked = words.substr(begin, end - begin);
    begin = end + 1;
    const auto* word = std::find_if(
        std::begin(kWords), std::end(kWords),
        [&](const Word& w) { return asked == w.printed || asked == w.other; });
    if (word == std::end(kWords)) {
      throw InputError("unknown reading '" + asked +
                       "'; known are sum or position, diagonal or "
                       "acceleration, white or accumulating, by_noise or "
                       "alike");
    }
    std::erase_if(readings, [&](const UuvReading& reading) {
      return reading.*word->bit != (asked == word->printed);
    });
  }
  if (readings.empty()) {
    throw InputError("the reading '" + words + "' contradicts itself");
  }
  return readings;
}

std::array<LinearSensor, 2> UuvSensors(const UuvReading& reading) {
  return {MakeSensor(reading, kInsProcess, kInsSigma),
          MakeSensor(reading, kDvlProcess, kDvlSigma)};
}

Study UuvFusionStudy(const UuvTruth& truth,
                     const std::vector<UuvReading>& readings) {
  Study study = {.tables = {FusionTable()}};
  for (const UuvReading& reading : readings) {
    const Sensors sensors = UuvSensors(reading);
    Sensors central = sensors;
    if (!reading.weighs_by_noise) {
      central[0].R = central[1].R = 0.5 * (sensors[0].R + sensors[1].R);
    }
    study.cases.push_back(
        FusionCase(reading.Name(), sensors, central,
                   {{kInsSigma, kDvlSigma}, reading.white_errors},
                   [truth](std::uint64_t) { return truth; }));
  }
  return study;
}

void AddMatchedFusion(const std::string& name, int epochs,
                      const std::array<double, 2>& sigma, Study* study) {
  UuvReading reading;
  reading.adds_velocity = false;
  const Sensors sensors = {MakeSensor(reading, kDvlProcess, sigma[0]),
                           MakeSensor(reading, kDvlProcess, sigma[1])};
  study->cases.push_back(
      FusionCase(name, sensors, sensors, {sigma, true},
                 [sensor = sensors[1], epochs](std::uint64_t seed) {
                   return DrawTruth(sensor, epochs, seed);
                 }));
}

}  // namespace hindsight
