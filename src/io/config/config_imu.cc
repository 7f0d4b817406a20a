#include <cmath>
#include <string>
#include <utility>

#include "base/units.h"
#include "imu/imu_noise.h"
#include "imu/known_imus.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"

namespace hindsight {
namespace {

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

/// A walk, or a Gauss-Markov bias in its place.
void ReadBias(ConfigMap* noise, const std::string& sensor, Quantity walk_unit,
              Quantity bias_unit, double* walk, double* tau) {
  const std::string walk_key = sensor + "_bias_walk";
  const std::string sigma_key = sensor + "_bias_sigma";
  const std::string tau_key = sensor + "_bias_tau";
  if (!noise->Has(tau_key) && !noise->Has(sigma_key)) {
    *walk = noise->Number(walk_key, walk_unit, *walk);
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

std::string NamesOfKnownImus() {
  std::string names;
  for (const KnownImu& imu : KnownImus()) {
    names += (names.empty() ? "" : ", ") + std::string(imu.name);
  }
  return names;
}

/// Of a known device, which the other keys change.
void ReadLike(ConfigMap* map, ImuNoise* noise) {
  const auto name = map->OptionalText("like");
  if (!name) return;
  const KnownImu* imu = FindKnownImu(*name);
  if (imu == nullptr) {
    map->Fail("like",
              "'" + *name + "' is not known; expected " + NamesOfKnownImus());
  }
  *noise = NoiseOf(*imu);
}

std::vector<ConfigKey<ImuNoise>> BiasNoiseKeys() {
  using Key = ConfigKey<ImuNoise>;
  return {
      {.name = "gyro_bias_walk",
       .value = Key::Special{[](ConfigMap* map, ImuNoise* noise) {
         ReadBias(map, "gyro", Quantity::kGyroBiasWalk, Quantity::kAngularRate,
                  &noise->gyro_bias_walk, &noise->gyro_bias_tau);
       }},
       .help = "density",
       .fallback = "0"},
      {.name = "gyro_bias_sigma",
       .value = Key::Special{},
       .help = "with gyro_bias_tau: a Gauss-Markov bias in place of a walk"},
      {.name = "gyro_bias_tau",
       .value = Key::Special{},
       .help = "correlation time"},
      {.name = "accel_bias_walk",
       .value = Key::Special{[](ConfigMap* map, ImuNoise* noise) {
         ReadBias(map, "accel", Quantity::kAccelBiasWalk,
                  Quantity::kAcceleration, &noise->accel_bias_walk,
                  &noise->accel_bias_tau);
       }},
       .help = "density",
       .fallback = "0"},
      {.name = "accel_bias_sigma", .value = Key::Special{}, .help = "likewise"},
      {.name = "accel_bias_tau", .value = Key::Special{}, .help = "likewise"}};
}

const ConfigTable<ImuNoise>& NoiseTable() {
  using Key = ConfigKey<ImuNoise>;
  static const std::string kLike =
      "white noise of its data sheet and usual walks; one of " +
      NamesOfKnownImus();
  static const ConfigTable<ImuNoise> kTable = [] {
    ConfigTable<ImuNoise> table = {
        "imu_noise",
        "The map noise of the imu. It needs gyro and accel, or like.",
        BiasNoiseKeys()};
    auto place = table.keys.insert(
        table.keys.begin(),
        {.name = "like", .value = Key::Special{ReadLike}, .help = kLike});
    ++place;
    for (const ImuNoiseValue& value : ImuNoiseValues()) {
      ConfigKey<ImuNoise> key;
      key.name = value.name;
      key.quantity = value.quantity;
      key.value = ConfigKey<ImuNoise>::Number{
          value.at,
          value.needed ? KeyRange::kPositive : KeyRange::kNotNegative};
      key.help = value.help;
      key.fallback = value.needed ? "of like" : "0";
      place = table.keys.insert(place, std::move(key)) + 1;
    }
    return table;
  }();
  return kTable;
}

/// The sensor's own axes first.
void ReadImuKind(ConfigMap* map, ImuConfig* imu) {
  if (map->Has("kind")) {
    imu->kind = map->Choice("kind", {"rates", "increments"}, 0) == 0
                    ? ImuStream::Kind::kRates
                    : ImuStream::Kind::kIncrements;
  } else {
    // Keeps the key's place until the file has said which it is.
    map->Resolve("kind", "rates");
  }
}

void ReadImuEstimate(ConfigMap* map, ImuConfig* imu) {
  ConfigMap estimate = map->Map("estimate");
  imu->gyro_scale_sigma =
      estimate.OptionalSigma("gyro_scale", Quantity::kRatio);
  imu->accel_scale_sigma =
      estimate.OptionalSigma("accel_scale", Quantity::kRatio);
  estimate.Finish();
}

const ConfigTable<ImuConfig>& ImuTable() {
  using Key = ConfigKey<ImuConfig>;
  static const ConfigTable<ImuConfig> kTable = {
      "imu",
      "Besides the keys of a stream; columns gyro_x ... accel_z, or dtheta_x "
      "... dvel_z.",
      {{.name = "kind",
        .value = Key::Special{ReadImuKind},
        .help = "rates, increments",
        .fallback = "as the columns say"},
       {.name = "accelerometer",
        .value = Key::Special{},
        .help = "a map of the keys of a stream, where the accelerometers have "
                "a file and stamps of their own: interpolated at the gyros'"},
       {.name = "axes",
        .value = Key::Special{[](ConfigMap* map, ImuConfig* imu) {
          ReadAxes(map, &imu->C_bs);
        }},
        .help = "body x, y, z in sensor axes, \"[-x, y, -z]\"",
        .fallback = "[x, y, z]"},
       {.name = "mounting",
        .value = Key::Special{[](ConfigMap* map, ImuConfig* imu) {
          ReadTurn(map, &imu->C_bs);
        }},
        .help = "roll, pitch, yaw of a rotation after axes: body = Rz(yaw) "
                "Ry(pitch) Rx(roll) axes(sensor)",
        .fallback = "[0, 0, 0 deg]"},
       {.name = "mounting_sigma",
        .quantity = Quantity::kAngle,
        .value = Key::Special{[](ConfigMap* map, ImuConfig* imu) {
          imu->mounting_sigma =
              map->OptionalSigma("mounting_sigma", Quantity::kAngle);
        }},
        .help = "how well the vehicle's axes are known against the IMU's: of "
                "roll, pitch, yaw, or one; not estimated, but the attitudes' "
                "uncertainty counts it"},
       {.name = "stamp",
        .value = Key::Word{{"end", "start"},
                           [](const ImuConfig& imu) {
                             return std::size_t{imu.stamp_at_start ? 1U : 0U};
                           },
                           [](ImuConfig& imu, std::size_t word) {
                             imu.stamp_at_start = word == 1;
                           }},
        .help = "of an increment's interval; the first row's is taken as long "
                "as the median one, with start the last row's too"},
       {.name = "time_offset",
        .quantity = Quantity::kTime,
        .value = Key::Number{&ImuConfig::time_offset},
        .help = "added to the stamps"},
       {.name = "max_gap",
        .quantity = Quantity::kTime,
        .value = Key::Number{&ImuConfig::max_gap, KeyRange::kPositive},
        .help = "longer intervals are errors; shorter drop-outs are bridged "
                "with noise to match"},
       {.name = "noise",
        .value = Key::Special{[](ConfigMap* map, ImuConfig* imu) {
          imu->noise = ReadImuNoise(map);
        }},
        .help = "densities",
        .needed = true},
       {.name = "estimate",
        .value = Key::Special{ReadImuEstimate},
        .help = "gyro_scale, accel_scale: a priori sigma of estimated scale "
                "factors"}}};
  return kTable;
}

}  // namespace

void ReadAxes(ConfigMap* map, Eigen::Matrix3d* C_bs) {
  const std::vector<std::string> axes = map->List("axes");
  if (axes.empty()) return;
  if (axes.size() != 3) map->Fail("axes", "expected three axes");
  for (std::size_t i = 0; i < axes.size(); ++i) {
    C_bs->row(static_cast<Eigen::Index>(i)) = ReadAxis(map, axes[i]);
  }
  if (std::abs(C_bs->determinant() - 1.0) > 0.5) {
    map->Fail("axes",
              "are not a rotation; expected each axis once and right-handed "
              "(a sensor with a mirrored axis needs a sign in `columns`)");
  }
}

void ReadTurn(ConfigMap* map, Eigen::Matrix3d* C_bs) {
  *C_bs = ReadSensorMounting(map).toRotationMatrix() * *C_bs;
}

/// Which the file says unless the key does.
Eigen::Matrix3d ReadMounting(ConfigMap* map) {
  Eigen::Matrix3d C_bs = Eigen::Matrix3d::Identity();
  ReadAxes(map, &C_bs);
  ReadTurn(map, &C_bs);
  return C_bs;
}

ImuNoise ReadImuNoise(ConfigMap* imu) {
  if (!imu->Has("noise")) imu->Fail("noise", "is missing");
  ConfigMap map = imu->Map("noise");
  ImuNoise noise;
  ReadTable(NoiseTable(), &map, &noise);
  for (const auto& [key, density] :
       {std::pair("gyro", noise.gyro_noise_density),
        std::pair("accel", noise.accel_noise_density)}) {
    if (density > 0.0) continue;
    map.Fail(key,
             "is missing; expected it, or `like` one of " + NamesOfKnownImus());
  }
  map.Finish();
  return noise;
}

ImuConfig ReadImuKeys(ConfigMap* map) {
  ImuConfig imu;
  ReadTable(ImuTable(), map, &imu);
  return imu;
}

std::vector<KeySection> ImuSections() {
  return {Documented(ImuTable()), Documented(NoiseTable()), TruthSection()};
}

}  // namespace hindsight
