#include "io/write/dataset_writer.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "io/read/solution_columns.h"
#include "io/write/atomic_file.h"
#include "io/write/column_file.h"
#include "io/write/dataset_config.h"
#include "io/write/number_format.h"
#include "io/write/output_error.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr int kImuDigits = 12;

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
    AppendValue(column, value / column.si, &text_);
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

/// The kind of a stream that is to be written.
const SensorKind& WrittenKind(const AidingStream& stream) {
  const SensorKind& kind = *stream.sensor.kind;
  if (kind.write == nullptr) {
    throw InputError("aiding stream '" + stream.sensor.name +
                     "' cannot be written as CSV");
  }
  return kind;
}

std::vector<double> WrittenValues(const AidingStream& stream,
                                  const MeasurementModel& model) {
  try {
    return stream.sensor.kind->write(model, stream.sensor);
  } catch (const InputError& error) {
    throw InputError("aiding stream '" + stream.sensor.name +
                     "': " + error.what());
  }
}

void WriteAiding(const std::string& path, const AidingStream& stream) {
  const SensorKind& kind = WrittenKind(stream);
  const MeasurementSeries rows = kind.split == nullptr
                                     ? stream.measurements
                                     : kind.split(stream.measurements);
  std::vector<SolutionColumn> columns;
  std::string heading = "t[s]";
  for (const WrittenColumn& c :
       kind.written(rows.front().model, stream.sensor)) {
    columns.push_back({c.name, c.unit, c.si, c.digits, {}});
    heading += "," + columns.back().Heading();
  }
  AtomicFile file(path);
  file.Write(heading + "\n");
  Row row;
  for (const Measurement& z : rows) {
    row.AddShortest(z.t);
    const std::vector<double> values = WrittenValues(stream, z.model);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      row.Add(columns[i], values[i]);
    }
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
