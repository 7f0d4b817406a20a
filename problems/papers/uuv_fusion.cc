#include "problems/papers/uuv_fusion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

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

/// One run under one architecture.
RunRecord Follow(FusionArchitecture architecture,
                 const std::array<LinearSensor, 2>& sensors,
                 const UuvTruth& truth, const Errors& errors,
                 std::uint64_t seed) {
  std::array<Random, 2> noise = {Random(seed, 1), Random(seed, 2)};
  std::array<Eigen::Vector3d, 2> error = {Eigen::Vector3d::Zero(),
                                          Eigen::Vector3d::Zero()};
  const Track prior = {truth.front(), ErrorMatrix::Identity(kStates, kStates)};
  const auto fusion = MakeFusion(architecture, sensors, prior);
  RunRecord record;
  record.seed = seed;
  auto& series = record.series;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    std::array<RowVector, 2> z;
    for (std::size_t i = 0; i < 2; ++i) {
      if (errors.white) error[i].setZero();
      error[i] += errors.sigma[i] * noise[i].NormalVector3();
      z[i] = sensors[i].H * truth[k] + error[i];
    }
    const Track fused = fusion->Step(z[0], z[1]);
    const ErrorVector e = truth[k] - fused.x;
    record.t.push_back(kStep * static_cast<double>(k));
    series["horizontal"].push_back(std::hypot(e(0), e(2)));
    series["spatial"].push_back(std::hypot(e(0), e(2), e(4)));
    series["nees"].push_back(e.dot(fused.P.llt().solve(e)) / kStates);
    if (architecture == FusionArchitecture::kEqualised) {
      error[0] = sensors[0].H * (fused.x - truth[k]);
    }
  }
  return record;
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

/// About the mean, divisor the number of values.
double Scatter(const std::vector<double>& values) {
  return ComputeStatistics(values).std;
}

double BinOf(const std::vector<double>& values) {
  return CountValues(values).bin;
}

StudyTable FusionTable() {
  const auto distance = [](const std::string& name, const std::string& title) {
    return Figure{name,
                  kMetres,
                  title + "\nmean  std [m]",
                  "{:.3f}",
                  {{"mean", name, OfAll<Mean>}, {"std", name, OfAll<Scatter>}}};
  };
  StudyTable table = {
      "cells",
      {"reading", "architecture"},
      {distance("spatial", "3-D"),
       distance("horizontal", "2-D"),
       Single("nees", kPlain, "NEES\n/ 6", "{:.3g}", OfAll<Mean>),
       Single("spatial_bin", kMetres, "", "", "spatial", OfAll<BinOf>),
       Single("horizontal_bin", kMetres, "", "", "horizontal", OfAll<BinOf>),
       {"spatial_histogram", kPlain, "", "", {}},
       {"horizontal_histogram", kPlain, "", "", {}}},
      {}};
  table.figures[5].list = [](const RunCell& cell) {
    return CountValues(cell.Pooled("spatial")).counts;
  };
  table.figures[6].list = [](const RunCell& cell) {
    return CountValues(cell.Pooled("horizontal")).counts;
  };
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
  Study study = {"", {}, {FusionTable()}, {}};
  for (const UuvReading& reading : readings) {
    const SeedRun run = [truth, reading](std::uint64_t seed) {
      const Errors errors = {{kInsSigma, kDvlSigma}, reading.white_errors};
      std::vector<RunRecord> out;
      for (const FusionArchitecture architecture : kFusionArchitectures) {
        std::array<LinearSensor, 2> sensors = UuvSensors(reading);
        if (architecture == FusionArchitecture::kCentral &&
            !reading.weighs_by_noise) {
          sensors[0].R = sensors[1].R = 0.5 * (sensors[0].R + sensors[1].R);
        }
        out.push_back(Follow(architecture, sensors, truth, errors, seed));
        out.back().labels = {reading.Name(), FusionName(architecture)};
      }
      return out;
    };
    study.jobs.emplace_back([run] { return run; });
  }
  return study;
}

void AddMatchedFusion(const std::string& name, int epochs,
                      const std::array<double, 2>& sigma, Study* study) {
  UuvReading reading;
  reading.adds_velocity = false;
  const std::array<LinearSensor, 2> sensors = {
      MakeSensor(reading, kDvlProcess, sigma[0]),
      MakeSensor(reading, kDvlProcess, sigma[1])};
  const SeedRun run = [=](std::uint64_t seed) {
    std::vector<RunRecord> out;
    const UuvTruth truth = DrawTruth(sensors[1], epochs, seed);
    for (const FusionArchitecture architecture : kFusionArchitectures) {
      out.push_back(Follow(architecture, sensors, truth, {sigma, true}, seed));
      out.back().labels = {name, FusionName(architecture)};
    }
    return out;
  };
  study->jobs.emplace_back([run] { return run; });
}

}  // namespace hindsight
