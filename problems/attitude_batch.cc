#include "problems/attitude_batch.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/so3.h"
#include "problems/attitude_samples.h"
#include "problems/reconstruction.h"

namespace hindsight {

std::vector<double> RoomNodeTimes(const RoomProblem& problem) {
  std::vector<double> times = {problem.imu.t_begin()};
  const auto fill = [&](double to) {
    const double from = times.back();
    const auto steps =
        static_cast<int>(std::lround((to - from) / kRoomNodeSpacing));
    for (int i = 1; i < steps; ++i) {
      times.push_back(from + (to - from) * i / steps);
    }
    if (to > times.back()) times.push_back(to);
  };
  for (const SurveyedField& reading : problem.readings) fill(reading.t);
  fill(problem.imu.t_end());
  return times;
}

namespace {

/// Without a place the Earth does not turn: its rate at the room's stand-in
/// place is put into the gyros' readings, to be taken out again.
void AddEarthRate(const RoomProblem& problem, ImuStream* imu) {
  const Eigen::Vector3d w_ie_e = EarthRate_e();
  for (std::size_t k = 0; k < imu->samples.size(); ++k) {
    imu->samples[k].gyro +=
        problem.smoothed.states[k].q_eb.conjugate() * w_ie_e;
  }
}

AidingStream RoomStream(const char* name, SensorType type) {
  AidingStream stream;
  stream.sensor.name = name;
  stream.sensor.type = type;
  return stream;
}

/// p = 0 +- room and v = 0 +- room_speed, once in `correlation_time`: where the
/// body is does not change from node to node, so each of n nodes in that time
/// counts as 1/n.
void AddRoom(const RoomProblem& problem, Dataset* room) {
  const AhrsSettings& ahrs = problem.dataset.ahrs;
  AidingStream position = RoomStream("room", SensorType::kPosition);
  AidingStream velocity = RoomStream("room_speed", SensorType::kVelocity);
  const double nodes = std::max(1.0, ahrs.correlation_time / kRoomNodeSpacing);
  const Eigen::Matrix3d I = nodes * Eigen::Matrix3d::Identity();
  const int first = static_cast<int>(room->streams.size());
  for (const double t : RoomNodeTimes(problem)) {
    position.measurements.push_back(
        {t, first, false,
         PositionFix{problem.place.p_e, ahrs.room * ahrs.room * I}});
    velocity.measurements.push_back(
        {t, first + 1, false,
         VelocityFix{Eigen::Vector3d::Zero(),
                     ahrs.room_speed * ahrs.room_speed * I}});
  }
  room->streams.push_back(std::move(position));
  room->streams.push_back(std::move(velocity));
}

/// The field as a vector about the survey's, each reading with the weight it
/// has there.
void AddMagnetometer(const RoomProblem& problem, Dataset* room) {
  if (problem.readings.empty()) return;
  AidingStream stream = RoomStream("field", SensorType::kMagnetometer);
  for (const AidingStream& given : problem.dataset.streams) {
    if (given.sensor.type == SensorType::kMagnetometer) {
      stream.sensor.magnetic = given.sensor.magnetic;
    }
  }
  MagneticSurroundings& magnetic = stream.sensor.magnetic;
  magnetic.horizontal = problem.survey.field_n.head<2>().norm();
  magnetic.down = problem.survey.field_n.z();
  magnetic.hard_iron_b = problem.survey.hard_iron_b;
  const int index = static_cast<int>(room->streams.size());
  for (std::size_t k = 0; k < problem.readings.size(); ++k) {
    const SurveyedField& reading = problem.readings[k];
    const double weight = reading.weight * problem.survey.trust[k];
    stream.measurements.push_back(
        {reading.t, index, false,
         MagneticField{reading.field_b, kFieldScale / std::sqrt(weight),
                       MagneticField::Form::kVector}});
  }
  room->streams.push_back(std::move(stream));
}

Dataset RoomDataset(const RoomProblem& problem) {
  // Of a calibrated MEMS sensor, where the data set says nothing.
  const Eigen::Vector3d kAccelBias = Eigen::Vector3d::Constant(0.05);
  const Eigen::Vector3d kGyroScale = Eigen::Vector3d::Constant(0.005);
  const Eigen::Vector3d kAccelScale = Eigen::Vector3d::Constant(0.003);
  Dataset room;
  room.name = problem.dataset.name;
  room.imu = problem.imu;
  if (!problem.dataset.place) AddEarthRate(problem, &room.imu);
  const State& first = problem.smoothed.states.front();
  room.initial = problem.dataset.initial;
  room.initial.t = problem.imu.t_begin();
  room.initial.position = GeodeticFromEcef(problem.place.p_e);
  room.initial.v_n = Eigen::Vector3d::Zero();
  room.initial.euler = first.euler();
  room.initial.attitude_sigma = Eigen::Vector3d(3.0, 3.0, 10.0) * kDegree;
  room.initial.position_sigma =
      Eigen::Vector3d::Constant(problem.dataset.ahrs.room);
  room.initial.velocity_sigma =
      Eigen::Vector3d::Constant(problem.dataset.ahrs.room_speed);
  room.initial.gyro_bias = first.b_g;
  room.initial.gyro_bias_sigma =
      problem.dataset.initial.gyro_bias_sigma.value_or(
          Eigen::Vector3d::Constant(0.5 * kDegree));
  room.initial.accel_bias_sigma =
      problem.dataset.initial.accel_bias_sigma.value_or(kAccelBias);
  room.gyro_scale_sigma = problem.dataset.gyro_scale_sigma.value_or(kGyroScale);
  room.accel_scale_sigma =
      problem.dataset.accel_scale_sigma.value_or(kAccelScale);
  // The nodes are where the measurements are.
  room.max_node_spacing = 2.0 * kRoomNodeSpacing;
  AddRoom(problem, &room);
  AddMagnetometer(problem, &room);
  return room;
}

}  // namespace

Solution SolveRoomBatch(const RoomProblem& problem,
                        const std::function<void(double)>& progress) {
  const Dataset room = RoomDataset(problem);
  ReconstructionOptions options;
  if (progress) {
    options.progress = [&](const std::string&, double fraction) {
      progress(fraction);
    };
  }
  Reconstruction reconstruction(room, options);
  const Solution nodes = reconstruction.Run("batch");
  Solution out = NodesAtSamples(nodes, room.imu, problem.smoothed.layout);
  for (State& x : out.states) x.p_e = problem.place.p_e;
  out.constants = nodes.constants;
  return out;
}

}  // namespace hindsight
