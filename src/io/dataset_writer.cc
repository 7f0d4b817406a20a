#include "io/dataset_writer.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <system_error>

#include "base/error.h"
#include "base/units.h"
#include "io/atomic_file.h"
#include "io/dataset_config.h"
#include "io/number_format.h"
#include "io/output_error.h"
#include "io/solution_columns.h"

namespace hindsight {
namespace {

constexpr int kImuDigits = 12;
constexpr int kSigmaDigits = 12;

/// Fills the next sample and returns true, or returns false after the last.
using SampleSource = std::function<bool(ImuSample*)>;

std::string PathIn(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

void MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw OutputError(folder + ": the folder cannot be made (" +
                      error.message() + ")");
  }
}

/// One line of a CSV file, built value by value.
class Row {
 public:
  void Add(const SolutionColumn& column, double value) {
    Separate();
    if (column.digits < 0) {
      AppendGeneral(value / column.si, -column.digits, &text_);
    } else {
      AppendFixed(value / column.si, column.digits, &text_);
    }
  }
  void AddGeneral(double value, int digits) {
    Separate();
    AppendGeneral(value, digits, &text_);
  }
  void AddShortest(double value) {
    Separate();
    AppendShortest(value, &text_);
  }
  void AddGroup(ColumnGroup group, const Eigen::Vector3d& values) {
    for (std::size_t i = 0; i < 3; ++i) {
      Add(Columns(group)[i], values(static_cast<Eigen::Index>(i)));
    }
  }
  void EndTo(AtomicFile* file) {
    text_ += '\n';
    file->Write(text_);
    text_.clear();
  }

 private:
  void Separate() {
    if (!text_.empty()) text_ += ',';
  }
  std::string text_;
};

std::string GroupHeading(ColumnGroup group) {
  std::string text;
  for (const SolutionColumn& column : Columns(group)) {
    text += "," + column.Heading();
  }
  return text;
}

void WriteImu(const std::string& path, ImuStream::Kind kind,
              const SampleSource& next) {
  AtomicFile file(path);
  file.Write(kind == ImuStream::Kind::kRates
                 ? "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],"
                   "accel_x[m/s^2],accel_y[m/s^2],accel_z[m/s^2]\n"
                 : "t[s],dtheta_x[rad],dtheta_y[rad],dtheta_z[rad],"
                   "dvel_x[m/s],dvel_y[m/s],dvel_z[m/s]\n");
  Row row;
  for (ImuSample sample; next(&sample);) {
    row.AddShortest(sample.t);
    for (const double value : sample.gyro) row.AddGeneral(value, kImuDigits);
    for (const double value : sample.accel) row.AddGeneral(value, kImuDigits);
    row.EndTo(&file);
  }
  file.Commit();
}

Eigen::Vector3d PositionValues(const Eigen::Vector3d& p_e) {
  const Geodetic g = GeodeticFromEcef(p_e);
  return {g.latitude, g.longitude, g.height};
}

Eigen::Vector3d SigmaOf(const Eigen::Matrix3d& R_n, const std::string& name) {
  if (!R_n.isDiagonal(0.0)) {
    throw InputError("aiding stream '" + name +
                     "': correlated errors cannot be written as CSV");
  }
  return R_n.diagonal().cwiseSqrt();
}

bool CountsDistance(const AidingStream& stream) {
  const Measurement first = stream.measurements.front();
  const auto* odometer = std::get_if<Odometer>(&first.model);
  return odometer != nullptr && odometer->form == Odometer::Form::kIncrements;
}

/// Increments as a count that stands still where one is missing.
void WriteCounts(const AidingStream& stream, AtomicFile* file) {
  file->Write("t[s],distance[m]\n");
  Row row;
  double count = 0.0;
  double t = -std::numeric_limits<double>::infinity();
  for (const Measurement& z : stream.measurements) {
    const auto& odometer = std::get<Odometer>(z.model);
    if (odometer.t_from > t) {
      row.AddShortest(odometer.t_from);
      row.AddShortest(count);
      row.EndTo(file);
    }
    count += odometer.distance;
    t = z.t;
    row.AddShortest(t);
    row.AddShortest(count);
    row.EndTo(file);
  }
}

std::string AidingHeading(const AidingStream& stream) {
  switch (stream.sensor.type) {
    case SensorType::kDvl:
      return std::get<Dvl>(stream.measurements.front().model).form ==
                     Dvl::Form::kBeams
                 ? ",beam_1[m/s],beam_2[m/s],beam_3[m/s],beam_4[m/s],"
                   "valid_1[1],valid_2[1],valid_3[1],valid_4[1]\n"
                 : ",v_x[m/s],v_y[m/s],v_z[m/s]\n";
    case SensorType::kAcousticFix:
      return ",range[m],azimuth[rad],depression[rad]\n";
    case SensorType::kPosition:
      return ",sigma_n[m],sigma_e[m],sigma_d[m]\n";
    case SensorType::kVelocity:
      return ",sigma_v_n[m/s],sigma_v_e[m/s],sigma_v_d[m/s]\n";
    case SensorType::kOdometer:
      return ",speed[m/s],side[m/s],down[m/s]\n";
    case SensorType::kMagnetometer:
      return ",mag_x[uT],mag_y[uT],mag_z[uT]\n";
    default:
      return ",h[m],sigma_h[m]\n";
  }
}

void AddDvlValues(const Dvl& dvl, Row* row) {
  for (int i = 0; i < dvl.components(); ++i) row->AddShortest(dvl.speed(i));
  if (dvl.form == Dvl::Form::kThreeAxis) return;
  for (const bool valid : dvl.valid) row->AddGeneral(valid ? 1.0 : 0.0, 1);
}

void AddAidingValues(const AidingStream& stream, const Measurement& z,
                     Row* row) {
  const std::string& name = stream.sensor.name;
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  if (const auto* fix = std::get_if<PositionFix>(&z.model)) {
    row->AddGroup(ColumnGroup::kPosition, PositionValues(fix->p_e));
    sigma = SigmaOf(fix->R_n, name);
  } else if (const auto* velocity = std::get_if<VelocityFix>(&z.model)) {
    row->AddGroup(ColumnGroup::kVelocity, velocity->v_n);
    sigma = SigmaOf(velocity->R_n, name);
  } else if (const auto* height = std::get_if<HeightFix>(&z.model)) {
    row->Add(Columns(ColumnGroup::kPosition)[2], height->height);
    row->AddGeneral(height->sigma, kSigmaDigits);
    return;
  } else if (const auto* odometer = std::get_if<Odometer>(&z.model)) {
    for (const double speed :
         {odometer->speed, odometer->side_down.x(), odometer->side_down.y()}) {
      row->AddShortest(speed);
    }
    return;
  } else if (const auto* magnetic = std::get_if<MagneticField>(&z.model)) {
    for (const double value : magnetic->field_b) row->AddShortest(value);
  } else if (const auto* dvl = std::get_if<Dvl>(&z.model)) {
    AddDvlValues(*dvl, row);
    return;
  } else if (const auto* acoustic = std::get_if<AcousticFix>(&z.model)) {
    for (const double value :
         {acoustic->range, acoustic->azimuth, acoustic->depression}) {
      row->AddShortest(value);
    }
    return;
  } else {
    throw InputError("aiding stream '" + name + "' cannot be written as CSV");
  }
  for (const double value : sigma) row->AddGeneral(value, kSigmaDigits);
}

void WriteAiding(const std::string& path, const AidingStream& stream) {
  AtomicFile file(path);
  if (CountsDistance(stream)) {
    WriteCounts(stream, &file);
    file.Commit();
    return;
  }
  std::string heading = "t[s]";
  if (stream.sensor.type == SensorType::kPosition) {
    heading += GroupHeading(ColumnGroup::kPosition);
  } else if (stream.sensor.type == SensorType::kVelocity) {
    heading += GroupHeading(ColumnGroup::kVelocity);
  }
  file.Write(heading + AidingHeading(stream));
  Row row;
  for (const Measurement& z : stream.measurements) {
    row.AddShortest(z.t);
    AddAidingValues(stream, z, &row);
    row.EndTo(&file);
  }
  file.Commit();
}

/// Quantities that every point of a truth has.
struct TruthColumns {
  bool position = true;
  bool velocity = true;
  bool attitude = true;
  bool biases = true;
};

TruthColumns CommonColumns(const TruthSeries& truth) {
  TruthColumns has;
  for (const TruthPoint& point : truth) {
    has.position = has.position && point.p_e;
    has.velocity = has.velocity && point.v_n;
    has.attitude = has.attitude && point.q_nb;
    has.biases = has.biases && point.b_g && point.b_a;
  }
  return has;
}

void WriteTruth(const std::string& path, const TruthSeries& truth) {
  const TruthColumns has = CommonColumns(truth);
  AtomicFile file(path);
  std::string heading = "t[s]";
  if (has.position) heading += GroupHeading(ColumnGroup::kPosition);
  if (has.velocity) heading += GroupHeading(ColumnGroup::kVelocity);
  if (has.attitude) heading += GroupHeading(ColumnGroup::kAttitude);
  if (has.biases) {
    heading += GroupHeading(ColumnGroup::kGyroBias);
    heading += GroupHeading(ColumnGroup::kAccelBias);
  }
  file.Write(heading + "\n");
  Row row;
  for (const TruthPoint& p : truth) {
    row.AddShortest(p.t);
    if (has.position) {
      row.AddGroup(ColumnGroup::kPosition, PositionValues(*p.p_e));
    }
    if (has.velocity) row.AddGroup(ColumnGroup::kVelocity, *p.v_n);
    if (has.attitude) {
      row.AddGroup(ColumnGroup::kAttitude, EulerFromQuaternion(*p.q_nb));
    }
    if (has.biases) {
      row.AddGroup(ColumnGroup::kGyroBias, *p.b_g);
      row.AddGroup(ColumnGroup::kAccelBias, *p.b_a);
    }
    row.EndTo(&file);
  }
  file.Commit();
}

using PathOf = std::function<std::string(const std::string& name)>;

/// All files but the IMU's.
void WriteBesidesImu(const Dataset& dataset, const PathOf& path_of) {
  for (const AidingStream& stream : dataset.streams) {
    if (stream.measurements.empty()) continue;
    WriteAiding(path_of(stream.sensor.name + ".csv"), stream);
  }
  if (!dataset.truth.empty()) {
    WriteTruth(path_of("truth.csv"), dataset.truth);
  }
  WriteFileAtomically(path_of(kDatasetConfigName), DatasetConfigYaml(dataset));
}

}  // namespace

void WriteDataset(const Dataset& dataset, const std::string& folder) {
  MakeFolder(folder);
  const PathOf path_of = [&](const std::string& name) {
    return PathIn(folder, name);
  };
  // The first increments are those before the recording.
  std::size_t k = dataset.imu.kind == ImuStream::Kind::kIncrements ? 1 : 0;
  WriteImu(path_of("imu.csv"), dataset.imu.kind, [&](ImuSample* sample) {
    if (k == dataset.imu.samples.size()) return false;
    *sample = dataset.imu.samples[k++];
    return true;
  });
  WriteBesidesImu(dataset, path_of);
}

void WriteDataset(Simulation* simulation, const PathOf& path_of) {
  ImuSample before;
  if (simulation->imu_kind() == ImuStream::Kind::kIncrements) {
    simulation->Next(&before);
  }
  WriteImu(path_of("imu.csv"), simulation->imu_kind(),
           [&](ImuSample* sample) { return simulation->Next(sample); });
  WriteBesidesImu(simulation->Finish(), path_of);
}

}  // namespace hindsight
