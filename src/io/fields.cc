#include "io/fields.h"

namespace hindsight {

const std::vector<FieldName>& ImuFields() {
  static const std::vector<FieldName> kFields = {
      {"gyro_x", Quantity::kAngularRate},
      {"gyro_y", Quantity::kAngularRate},
      {"gyro_z", Quantity::kAngularRate},
      {"accel_x", Quantity::kAcceleration},
      {"accel_y", Quantity::kAcceleration},
      {"accel_z", Quantity::kAcceleration},
      {"dtheta_x", Quantity::kAngle},
      {"dtheta_y", Quantity::kAngle},
      {"dtheta_z", Quantity::kAngle},
      {"dvel_x", Quantity::kSpeed},
      {"dvel_y", Quantity::kSpeed},
      {"dvel_z", Quantity::kSpeed},
  };
  return kFields;
}

const std::vector<FieldName>& PositionFields() {
  static const std::vector<FieldName> kFields = {
      {"lat", Quantity::kAngle},      {"lon", Quantity::kAngle},
      {"h", Quantity::kLength},       {"sigma_n", Quantity::kLength},
      {"sigma_e", Quantity::kLength}, {"sigma_d", Quantity::kLength},
      {"sd_ne", Quantity::kLength},   {"sd_ed", Quantity::kLength},
      {"sd_dn", Quantity::kLength},   {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& VelocityFields() {
  static const std::vector<FieldName> kFields = {
      {"v_n", Quantity::kSpeed},       {"v_e", Quantity::kSpeed},
      {"v_d", Quantity::kSpeed},       {"sigma_v_n", Quantity::kSpeed},
      {"sigma_v_e", Quantity::kSpeed}, {"sigma_v_d", Quantity::kSpeed},
      {"sd_v_ne", Quantity::kSpeed},   {"sd_v_ed", Quantity::kSpeed},
      {"sd_v_dn", Quantity::kSpeed},   {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& HeightFields() {
  static const std::vector<FieldName> kFields = {
      {"h", Quantity::kLength},
      {"sigma_h", Quantity::kLength},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& OdometerFields() {
  static const std::vector<FieldName> kFields = {
      {"speed", Quantity::kSpeed},     {"side", Quantity::kSpeed},
      {"down", Quantity::kSpeed},      {"quality", Quantity::kRatio},
      {"distance", Quantity::kLength},
  };
  return kFields;
}

const std::vector<FieldName>& DepthFields() {
  static const std::vector<FieldName> kFields = {
      {"depth", Quantity::kLength},
      {"sigma_depth", Quantity::kLength},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& DvlFields() {
  static const std::vector<FieldName> kFields = {
      {"v_x", Quantity::kSpeed},     {"v_y", Quantity::kSpeed},
      {"v_z", Quantity::kSpeed},     {"beam_1", Quantity::kSpeed},
      {"beam_2", Quantity::kSpeed},  {"beam_3", Quantity::kSpeed},
      {"beam_4", Quantity::kSpeed},  {"valid_1", Quantity::kRatio},
      {"valid_2", Quantity::kRatio}, {"valid_3", Quantity::kRatio},
      {"valid_4", Quantity::kRatio}, {"water", Quantity::kRatio},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& AcousticFields() {
  static const std::vector<FieldName> kFields = {
      {"range", Quantity::kLength},
      {"azimuth", Quantity::kAngle},
      {"depression", Quantity::kAngle},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& SpeedCourseFields() {
  static const std::vector<FieldName> kFields = {
      {"speed", Quantity::kSpeed},
      {"course", Quantity::kAngle},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& MagnetometerFields() {
  static const std::vector<FieldName> kFields = {
      {"mag_x", Quantity::kMagneticField},
      {"mag_y", Quantity::kMagneticField},
      {"mag_z", Quantity::kMagneticField},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& ZeroVelocityFields() {
  static const std::vector<FieldName> kFields = {
      {"zero_velocity", Quantity::kRatio},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& TruthFields() {
  static const std::vector<FieldName> kFields = {
      {"lat", Quantity::kAngle},     {"lon", Quantity::kAngle},
      {"h", Quantity::kLength},      {"v_n", Quantity::kSpeed},
      {"v_e", Quantity::kSpeed},     {"v_d", Quantity::kSpeed},
      {"roll", Quantity::kAngle},    {"pitch", Quantity::kAngle},
      {"heading", Quantity::kAngle}, {"p_x", Quantity::kLength},
      {"p_y", Quantity::kLength},    {"p_z", Quantity::kLength},
      {"v_x", Quantity::kSpeed},     {"v_y", Quantity::kSpeed},
      {"v_z", Quantity::kSpeed},     {"q_w", Quantity::kRatio},
      {"q_x", Quantity::kRatio},     {"q_y", Quantity::kRatio},
      {"q_z", Quantity::kRatio},     {"moving", Quantity::kRatio},
  };
  return kFields;
}

std::optional<std::size_t> FieldIndex(const std::vector<FieldName>& fields,
                                      std::string_view name) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (name == fields[i].name) return i;
  }
  return std::nullopt;
}

}  // namespace hindsight
