#include "problems/uuv_fusion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"

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

/// What a sensor reads: the truth and an error that is white or adds up.
class Reader {
 public:
  Reader(double sigma, bool white) : sigma_(sigma), white_(white) {}
  /// `noise` is a standard normal vector.
  RowVector Read(const RowVector& truth, const Eigen::Vector3d& noise) {
    if (white_) {
      error_ = sigma_ * noise;
    } else {
      error_ += sigma_ * noise;
    }
    return truth + error_;
  }
  /// From here on errors that add up start from this one.
  void StartFrom(const Eigen::Vector3d& error) { error_ = error; }

 private:
  double sigma_;
  bool white_;
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();
};

/// The largest of 1, 2 and 5 times a power of ten that is not above `width`.
double RoundDown(double width) {
  const double power = std::pow(10.0, std::floor(std::log10(width)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= width) return digit * power;
  }
  return power;
}

/// Moments and histogram of distances.
DistanceError Describe(const std::vector<double>& distances) {
  const auto count = static_cast<double>(distances.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double d : distances) {
    sum += d;
    squares += d * d;
  }
  DistanceError error;
  error.mean = sum / count;
  error.deviation =
      std::sqrt(std::max(0.0, squares / count - error.mean * error.mean));
  if (error.deviation == 0.0) return error;
  constexpr double kBinsPerDeviation = 4.0;
  error.bin = RoundDown(error.deviation / kBinsPerDeviation);
  for (const double d : distances) {
    const auto i = static_cast<std::size_t>(d / error.bin);
    if (error.histogram.size() <= i) error.histogram.resize(i + 1, 0);
    ++error.histogram[i];
  }
  return error;
}

struct Judge {
  void Add(const Track& estimate, const ErrorVector& truth) {
    const ErrorVector e = truth - estimate.x;
    horizontal.push_back(std::hypot(e(0), e(2)));
    spatial.push_back(std::hypot(e(0), e(2), e(4)));
    nees += e.dot(estimate.P.llt().solve(e)) / kStates;
  }
  UuvFusionResult Result(FusionArchitecture architecture) const {
    return {architecture, Describe(horizontal), Describe(spatial),
            nees / static_cast<double>(spatial.size())};
  }
  std::vector<double> horizontal;
  std::vector<double> spatial;
  double nees = 0.0;
};

/// The sensors' true standard deviations and how their errors go on.
struct Errors {
  std::array<double, 2> sigma;
  bool white = true;
};

/// One run under one architecture.
void Follow(FusionArchitecture architecture,
            const std::array<LinearSensor, 2>& sensors, const UuvTruth& truth,
            const Errors& errors, std::uint64_t seed, Judge* judge) {
  Random first_noise(seed, 1);
  Random second_noise(seed, 2);
  Reader first(errors.sigma[0], errors.white);
  Reader second(errors.sigma[1], errors.white);
  const Track prior = {truth.front(), ErrorMatrix::Identity(kStates, kStates)};
  const auto fusion = MakeFusion(architecture, sensors, prior);
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const RowVector z_first =
        first.Read(sensors[0].H * truth[k], first_noise.NormalVector3());
    const RowVector z_second =
        second.Read(sensors[1].H * truth[k], second_noise.NormalVector3());
    const Track fused = fusion->Step(z_first, z_second);
    judge->Add(fused, truth[k]);
    if (architecture == FusionArchitecture::kEqualised) {
      first.StartFrom(sensors[0].H * (fused.x - truth[k]));
    }
  }
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

std::vector<UuvFusionResult> SolveUuvFusion(const UuvTruth& truth,
                                            const UuvReading& reading,
                                            const UuvFusionOptions& options) {
  const Errors errors = {{kInsSigma, kDvlSigma}, reading.white_errors};
  std::vector<UuvFusionResult> results;
  for (const FusionArchitecture architecture : kFusionArchitectures) {
    std::array<LinearSensor, 2> sensors = UuvSensors(reading);
    if (architecture == FusionArchitecture::kCentral &&
        !reading.weighs_by_noise) {
      sensors[0].R = sensors[1].R = 0.5 * (sensors[0].R + sensors[1].R);
    }
    Judge judge;
    for (int run = 0; run < options.runs; ++run) {
      Follow(architecture, sensors, truth, errors,
             options.first_seed + static_cast<std::uint64_t>(run), &judge);
    }
    results.push_back(judge.Result(architecture));
  }
  return results;
}

std::vector<UuvFusionResult> SolveMatchedFusion(
    int epochs, const std::array<double, 2>& sigma,
    const UuvFusionOptions& options) {
  UuvReading reading;
  reading.adds_velocity = false;
  const std::array<LinearSensor, 2> sensors = {
      MakeSensor(reading, kDvlProcess, sigma[0]),
      MakeSensor(reading, kDvlProcess, sigma[1])};
  std::vector<UuvFusionResult> results;
  for (const FusionArchitecture architecture : kFusionArchitectures) {
    Judge judge;
    for (int run = 0; run < options.runs; ++run) {
      const std::uint64_t seed =
          options.first_seed + static_cast<std::uint64_t>(run);
      Follow(architecture, sensors, DrawTruth(sensors[1], epochs, seed),
             {sigma, true}, seed, &judge);
    }
    results.push_back(judge.Result(architecture));
  }
  return results;
}

}  // namespace hindsight
