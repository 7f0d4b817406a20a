#include "io/read/fields.h"

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
