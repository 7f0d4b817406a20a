#include "io/config/constants_reader.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "io/read/paths.h"
#include "io/read/text_file.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

/// One method's figures, which errors name.
class Figures {
 public:
  Figures(std::string file, std::string method, Json json)
      : file_(std::move(file)),
        method_(std::move(method)),
        json_(std::move(json)) {}

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(file_, 0, method_ + ": " + what);
  }

  RecordedConstants Read(const std::string& from) const {
    RecordedConstants out;
    out.from = from;
    out.grade = ReadGrade();
    ReadValues(&out);
    ReadCovariance(&out);
    ReadMountings(&out);
    return out;
  }

 private:
  Grade ReadGrade() const {
    const std::string name = json_.value("grade", std::string());
    for (const Grade grade :
         {Grade::kUsable, Grade::kDoubtful, Grade::kUnusable}) {
      if (name != GradeName(grade)) continue;
      if (grade == Grade::kUnusable) {
        Fail(
            "is not usable, and its constants are not; expected a result that "
            "is usable or doubtful");
      }
      return grade;
    }
    Fail("has no grade; expected the summary.json of 'run' or 'combine'");
  }

  double Number(const Json& json, const std::string& name,
                const char* key) const {
    if (json.is_object() && json.contains(key) && json[key].is_number()) {
      const double value = json[key].get<double>();
      if (std::isfinite(value)) return value;
    }
    Fail("constant " + name + " has no number " + key);
  }

  void ReadValues(RecordedConstants* out) const {
    if (!json_.contains("constants") || !json_["constants"].is_object() ||
        json_["constants"].empty()) {
      Fail("has no constants");
    }
    const Json& constants = json_["constants"];
    const auto n = static_cast<Eigen::Index>(constants.size());
    out->value.resize(n);
    out->prior_value.resize(n);
    out->prior_sigma.resize(n);
    out->P = Eigen::MatrixXd::Zero(n, n);
    Eigen::Index i = 0;
    for (const auto& [name, entry] : constants.items()) {
      out->names.push_back(name);
      out->value(i) = Number(entry, name, "value");
      out->prior_value(i) = Number(entry, name, "prior_value");
      out->prior_sigma(i) = Number(entry, name, "prior_sigma");
      const double sigma = Number(entry, name, "sigma");
      if (!(sigma > 0.0 && out->prior_sigma(i) > 0.0)) {
        Fail("constant " + name + ": expected sigmas greater than zero");
      }
      out->units.push_back(entry.value("unit", std::string("1")));
      out->P(i, i) = sigma * sigma;
      ++i;
    }
  }

  /// Without correlations the constants count as independent.
  void ReadCovariance(RecordedConstants* out) const {
    if (!json_.contains("constant_correlations")) return;
    const Json& rows = json_["constant_correlations"];
    const auto n = out->value.size();
    const auto wrong = [this] {
      Fail(
          "constant_correlations: expected a row of numbers for each constant, "
          "positive definite");
    };
    if (!rows.is_array() || static_cast<Eigen::Index>(rows.size()) != n)
      wrong();
    for (Eigen::Index i = 0; i < n; ++i) {
      const Json& row = rows[static_cast<std::size_t>(i)];
      if (!row.is_array() || static_cast<Eigen::Index>(row.size()) != n)
        wrong();
      for (Eigen::Index j = 0; j < n; ++j) {
        const Json& rho = row[static_cast<std::size_t>(j)];
        if (!rho.is_number()) wrong();
        if (j == i) continue;
        out->P(i, j) =
            rho.get<double>() * std::sqrt(out->P(i, i) * out->P(j, j));
      }
    }
    out->P = (0.5 * (out->P + out->P.transpose())).eval();
    const Eigen::VectorXd scale = out->P.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> llt(scale.asDiagonal() * out->P *
                                          scale.asDiagonal());
    if (llt.info() != Eigen::Success) wrong();
  }

  void ReadMountings(RecordedConstants* out) const {
    if (!json_.contains("mountings")) return;
    for (const auto& [sensor, angles] : json_["mountings"].items()) {
      const int i = out->MountingOf(sensor);
      if (i < 0) continue;
      const std::string name = sensor + "_mounting";
      const Eigen::Quaterniond whole =
          QuaternionFromEuler(Number(angles, name, "roll_deg") * kDegree,
                              Number(angles, name, "pitch_deg") * kDegree,
                              Number(angles, name, "yaw_deg") * kDegree);
      const Eigen::Vector3d m = out->value.segment<3>(i);
      out->q_sb_nominal[sensor] = Exp(-m) * whole;
    }
  }

  std::string file_;
  std::string method_;
  Json json_;
};

std::vector<std::string> NamesIn(const Json& summary, const char* key) {
  std::vector<std::string> names;
  if (!summary.contains(key)) return names;
  for (const Json& name : summary[key]) {
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

}  // namespace

std::filesystem::path SummaryOf(const std::filesystem::path& path) {
  return IsFolder(path) ? path / "summary.json" : path;
}

RecordedConstants ReadConstants(const std::filesystem::path& path,
                                const std::string& method) {
  const std::string file = SummaryOf(path).string();
  const Json summary = Json::parse(ReadTextFile(file), nullptr, false);
  if (!summary.is_object() || !summary.contains("methods") ||
      !summary["methods"].is_object()) {
    throw InputError(file, 0,
                     "no figures of a result; expected the folder or the "
                     "summary.json of 'run' or 'combine'");
  }
  const std::string name =
      method.empty() ? summary.value("best", std::string()) : method;
  if (name.empty()) {
    throw InputError(file, 0,
                     "the result is not complete: it has no best "
                     "method; expected a method to be named");
  }
  const Json& methods = summary["methods"];
  if (!methods.contains(name) || !methods[name].is_object()) {
    throw InputError(file, 0, "has no method '" + name + "'");
  }
  RecordedConstants constants =
      Figures(file, name, methods[name])
          .Read(summary.value("constants_from", std::string()));
  constants.source = path.string();
  for (const char* bias : {"gyro_bias", "accel_bias"}) constants.Remove(bias);
  for (const std::string& own : NamesIn(summary, "constants_of_recording")) {
    if (constants.Remove(own)) constants.of_recording.push_back(own);
  }
  if (constants.names.empty()) {
    throw InputError(file, 0, name + ": has no constants of sensors");
  }
  return constants;
}

std::vector<FileDigest> RecordedFiles(const std::filesystem::path& path) {
  const Json summary =
      Json::parse(ReadTextFile(SummaryOf(path).string()), nullptr, false);
  std::vector<FileDigest> files;
  if (!summary.is_object() || !summary.contains("inputs")) return files;
  for (const Json& input : summary["inputs"]) {
    if (!input.is_object()) continue;
    FileDigest file = {input.value("path", std::string()),
                       input.value("bytes", std::uint64_t{0}),
                       input.value("sha256", std::string())};
    if (file.path.ends_with(".yaml") || file.sha256.empty()) continue;
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace hindsight
