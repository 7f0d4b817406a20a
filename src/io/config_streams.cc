#include "io/config_streams.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/error.h"

namespace hindsight {
namespace {

Quantity QuantityOf(ConfigMap* columns, const std::string& name,
                    const std::vector<FieldName>& fields) {
  if (name == "t") return Quantity::kTime;
  if (name == "week") return Quantity::kRatio;
  std::vector<std::string> names = {"t", "week"};
  for (const FieldName& field : fields) {
    if (name == field.name) return field.quantity;
    names.emplace_back(field.name);
  }
  std::string expected;
  if (const std::string near = NearestWord(name, names); !near.empty()) {
    expected = "perhaps '" + near + "'";
  } else {
    for (const std::string& known : names) {
      expected += (expected.empty() ? "one of " : ", ") + known;
    }
  }
  columns->Fail(name, "is not a quantity of this stream; expected " + expected);
}

/// A column is a number from 1, or else a title.
void SetColumn(const std::string& text, ColumnMapping* mapping) {
  int number = 0;
  const auto result =
      std::from_chars(text.data(), text.data() + text.size(), number);
  if (result.ec == std::errc() && result.ptr == text.data() + text.size() &&
      number >= 1) {
    mapping->column = number - 1;
  } else {
    mapping->title = text;
  }
}

ColumnMapping ReadColumn(ConfigMap* columns, const std::string& name,
                         Quantity quantity) {
  ColumnMapping mapping;
  mapping.quantity = name;
  if (columns->IsMap(name)) {
    ConfigMap entry = columns->Map(name);
    SetColumn(entry.Text("column"), &mapping);
    mapping.unit = entry.Text("unit", "");
    const std::string scale = entry.Text("scale", "1");
    const auto number = ParseNumber(scale);
    if (!number || *number == 0.0) {
      entry.Fail("scale", "'" + scale + "' is not a number other than zero");
    }
    mapping.scale = *number;
    entry.Finish();
  } else {
    auto [title, unit] = SplitTitle(columns->Text(name));
    if (title.starts_with('-')) {
      mapping.scale = -1.0;
      title.erase(0, 1);
    }
    SetColumn(title, &mapping);
    mapping.unit = unit;
  }
  if (name == "week") return mapping;
  if (mapping.unit.empty() && mapping.column >= 0) {
    columns->Fail(name, std::string("has no unit; expected COLUMN [UNIT] with "
                                    "one of ") +
                            UnitExamples(quantity));
  } else if (!mapping.unit.empty() && !UnitFactor(mapping.unit, quantity)) {
    columns->Fail(name, "has the unit '" + mapping.unit +
                            "'; expected one of " + UnitExamples(quantity));
  }
  return mapping;
}

std::vector<ColumnMapping> ReadColumns(ConfigMap* map,
                                       const std::vector<FieldName>& fields) {
  std::vector<ColumnMapping> mappings;
  ConfigMap columns = map->Map("columns");
  for (const std::string& name : columns.Keys()) {
    const Quantity quantity = QuantityOf(&columns, name, fields);
    const ColumnMapping mapping = ReadColumn(&columns, name, quantity);
    mappings.insert(name == "week" ? mappings.begin() : mappings.end(),
                    mapping);
  }
  return mappings;
}

void ReadStart(ConfigMap* time, ClockMap* clock) {
  const auto text = time->OptionalText("start");
  if (!text) return;
  clock->start_date = ParseDateTime(*text);
  if (clock->start_date) return;
  if (text->find("GPST") != text->npos || text->find("UTC") != text->npos) {
    time->Fail("start", "'" + *text +
                            "' is not a date; expected yyyy-mm-dd hh:mm:ss.sss "
                            "GPST or UTC");
  }
  clock->start = time->Number("start", Quantity::kTime);
}

ClockMap ReadClock(ConfigMap* map) {
  ClockMap clock;
  ConfigMap time = map->Map("time");
  clock.scale = static_cast<ClockMap::Scale>(
      time.Choice("clock", {"dataset", "gps", "unix"}, 0));
  if (time.Has("week")) clock.week = time.Integer("week", 0);
  ReadStart(&time, &clock);
  clock.duration = time.OptionalNumber("duration", Quantity::kTime);
  clock.rate = time.OptionalNumber("rate", Quantity::kFrequency);
  if (clock.duration && !(*clock.duration > 0.0)) {
    time.Fail("duration", "must be greater than zero");
  }
  if (clock.rate && !(*clock.rate > 0.0)) {
    time.Fail("rate", "must be greater than zero");
  }
  if (clock.week && clock.scale != ClockMap::Scale::kDataset) {
    time.Fail("week", "does not go with clock");
  }
  time.Finish();
  return clock;
}

Eigen::RowVector3d ReadAxis(ConfigMap* imu, const std::string& text) {
  const bool negative = text.starts_with('-');
  const std::string letter =
      text.substr(negative || text.starts_with('+') ? 1 : 0);
  if (letter != "x" && letter != "y" && letter != "z") {
    imu->Fail("axes", "'" + text +
                          "' is no axis; expected x, y or z, with - "
                          "where it points the other way");
  }
  Eigen::RowVector3d row = Eigen::RowVector3d::Zero();
  row(letter[0] - 'x') = negative ? -1.0 : 1.0;
  return row;
}

void ReadBias(ConfigMap* noise, const std::string& sensor, Quantity walk_unit,
              Quantity bias_unit, double* walk, double* tau) {
  const std::string walk_key = sensor + "_bias_walk";
  const std::string sigma_key = sensor + "_bias_sigma";
  const std::string tau_key = sensor + "_bias_tau";
  if (!noise->Has(tau_key) && !noise->Has(sigma_key)) {
    *walk = noise->Number(walk_key, walk_unit, 0.0);
    if (*walk < 0.0) noise->Fail(walk_key, "must not be negative");
    return;
  }
  if (noise->Has(walk_key)) {
    noise->Fail(walk_key, "does not go with " + sigma_key + " and " + tau_key);
  }
  *tau = noise->Positive(tau_key, Quantity::kTime);
  const double sigma = noise->Positive(sigma_key, bias_unit);
  *walk = std::sqrt(2.0 / *tau) * sigma;
}

}  // namespace

StreamSource ReadStreamSource(ConfigMap* map,
                              const std::filesystem::path& folder,
                              const std::vector<FieldName>& fields) {
  StreamSource source;
  source.name = map->name();
  source.config_path = map->file();
  const std::string file = map->Text("file");
  source.path = (folder / file).lexically_normal().string();
  source.config_line = map->Line("file");
  if (!std::filesystem::exists(source.path)) {
    map->Fail("file", "there is no file " + source.path);
  }
  map->Resolve(
      "file",
      std::filesystem::absolute(source.path).lexically_normal().string());
  TextFormat& format = source.format;
  format.config_path = map->file();
  format.config_line = map->line();
  format.kind = static_cast<TextFormat::Kind>(
      map->Choice("format", {"csv", "columns", "kf_gins", "rtklib_pos"}, 0));
  if (format.kind == TextFormat::Kind::kColumns) {
    if (!map->Has("columns")) map->Fail("columns", "is missing");
    format.config_line = map->Line("columns");
    format.columns = ReadColumns(map, fields);
  }
  constexpr std::array<char, 4> kDelimiters = {'\0', ',', ';', ' '};
  format.delimiter = kDelimiters[map->Choice(
      "delimiter", {"auto", "comma", "semicolon", "blank"}, 0)];
  format.skip_lines = map->Integer("skip_lines", 0);
  source.clock = ReadClock(map);
  source.on_duplicate = static_cast<DuplicatePolicy>(
      map->Choice("on_duplicate", {"error", "drop_first", "drop_last"}, 0));
  source.allow_truncated_tail = map->Flag("allow_truncated_tail", false);
  return source;
}

Eigen::Matrix3d ReadMounting(ConfigMap* imu) {
  Eigen::Matrix3d C_bs = Eigen::Matrix3d::Identity();
  const std::vector<std::string> axes = imu->List("axes");
  if (!axes.empty()) {
    if (axes.size() != 3) imu->Fail("axes", "expected three axes");
    for (std::size_t i = 0; i < 3; ++i) {
      C_bs.row(static_cast<Eigen::Index>(i)) = ReadAxis(imu, axes[i]);
    }
    if (std::abs(C_bs.determinant() - 1.0) > 0.5) {
      imu->Fail("axes",
                "are not a rotation; expected each axis once and right-handed "
                "(a sensor with a mirrored axis needs a sign in `columns`)");
    }
  }
  const Eigen::Vector3d euler =
      imu->Vector("mounting", Quantity::kAngle, Eigen::Vector3d::Zero());
  return QuaternionFromEuler(euler.x(), euler.y(), euler.z())
             .toRotationMatrix() *
         C_bs;
}

ImuNoise ReadImuNoise(ConfigMap* imu) {
  if (!imu->Has("noise")) imu->Fail("noise", "is missing");
  ConfigMap map = imu->Map("noise");
  ImuNoise noise;
  noise.gyro_noise_density = map.Positive("gyro", Quantity::kGyroNoiseDensity);
  noise.accel_noise_density =
      map.Positive("accel", Quantity::kAccelNoiseDensity);
  ReadBias(&map, "gyro", Quantity::kGyroBiasWalk, Quantity::kAngularRate,
           &noise.gyro_bias_walk, &noise.gyro_bias_tau);
  ReadBias(&map, "accel", Quantity::kAccelBiasWalk, Quantity::kAcceleration,
           &noise.accel_bias_walk, &noise.accel_bias_tau);
  noise.gyro_noise_per_rate =
      map.Number("gyro_per_rate", Quantity::kNoisePerRate, 0.0);
  if (noise.gyro_noise_per_rate < 0.0) {
    map.Fail("gyro_per_rate", "must not be negative");
  }
  map.Finish();
  return noise;
}

}  // namespace hindsight
