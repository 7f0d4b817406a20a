#include "dataset/recorded_constants.h"

#include <utility>

#include "geometry/so3.h"

namespace hindsight {

bool RecordedConstants::Remove(const std::string& name) {
  std::vector<int> kept;
  std::vector<std::string> kept_names;
  std::vector<std::string> kept_units;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name || names[i].starts_with(name + "[")) continue;
    kept.push_back(static_cast<int>(i));
    kept_names.push_back(names[i]);
    kept_units.push_back(units[i]);
  }
  if (kept.size() == names.size()) return false;
  names = std::move(kept_names);
  units = std::move(kept_units);
  value = Eigen::VectorXd(value(kept));
  P = Eigen::MatrixXd(P(kept, kept));
  prior_value = Eigen::VectorXd(prior_value(kept));
  prior_sigma = Eigen::VectorXd(prior_sigma(kept));
  return true;
}

int RecordedConstants::MountingOf(const std::string& sensor) const {
  const std::string name = sensor + "_mounting";
  for (std::size_t i = 0; i + 2 < names.size(); ++i) {
    if (names[i] == name + "[x]" && names[i + 1] == name + "[y]" &&
        names[i + 2] == name + "[z]") {
      return static_cast<int>(i);
    }
  }
  return -1;
}

KnownConstants KnownFrom(const RecordedConstants& recorded) {
  KnownConstants known{
      recorded.source, recorded.names, recorded.value, recorded.P, {}};
  for (const auto& [sensor, nominal] : recorded.q_sb_nominal) {
    const int i = recorded.MountingOf(sensor);
    if (i < 0) continue;
    const Eigen::Vector3d m = recorded.value.segment<3>(i);
    const Eigen::Matrix3d J = LeftJacobian(m);
    known.P.middleRows<3>(i) = (J * known.P.middleRows<3>(i)).eval();
    known.P.middleCols<3>(i) =
        (known.P.middleCols<3>(i) * J.transpose()).eval();
    known.value.segment<3>(i).setZero();
    known.q_sb[sensor] = Exp(m) * nominal;
  }
  return known;
}

RecordedConstants AboutNominal(
    const std::map<std::string, Eigen::Quaterniond>& nominal,
    RecordedConstants recorded) {
  for (auto& [sensor, own] : recorded.q_sb_nominal) {
    const auto other = nominal.find(sensor);
    const int i = recorded.MountingOf(sensor);
    if (other == nominal.end() || i < 0) continue;
    for (Eigen::VectorXd* values : {&recorded.value, &recorded.prior_value}) {
      values->segment<3>(i) = Log(Exp(Eigen::Vector3d(values->segment<3>(i))) *
                                  own * other->second.conjugate());
    }
    own = other->second;
  }
  return recorded;
}

}  // namespace hindsight
