#include "io/write/residual_csv.h"

#include "dataset/injection.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

const char* Status(const ResidualRecord& record) {
  if (record.withheld) return "withheld";
  return record.accepted ? "used" : "rejected";
}

void AppendRecord(const std::string& method, const std::string& sensor,
                  const ResidualRecord& record, std::string* out) {
  for (Eigen::Index i = 0; i < record.residual.size(); ++i) {
    *out += method + ',';
    AppendFixed(record.t, 6, out);
    *out += ',' + sensor + ',' + std::to_string(i) + ',';
    AppendGeneral(record.residual(i), 8, out);
    *out += ',';
    if (i < record.sigma.size()) AppendGeneral(record.sigma(i), 8, out);
    *out += ',';
    AppendGeneral(record.nis, 8, out);
    *out += ',';
    AppendGeneral(record.weight, 8, out);
    *out += ',';
    *out += Status(record);
    *out += '\n';
  }
}

}  // namespace

void WriteResidualCsv(const std::string& path,
                      const std::vector<Solution>& solutions,
                      const Dataset& dataset) {
  AtomicFile file(path);
  for (const Injection& injection : dataset.injections) {
    file.Write("# error injected on purpose: " + Describe(injection) + "\n");
  }
  file.Write(EpochComment(dataset.epoch_gps_ns));
  file.Write(
      "# residual = measured - predicted and sigma in SI units, a line for "
      "each component\n"
      "method,t[s],sensor,component,residual,sigma,nis,weight,status\n");
  for (const Solution& solution : solutions) {
    file.WriteLines(
        solution.residuals.size(), [&](std::size_t i, std::string* lines) {
          const ResidualRecord& record = solution.residuals[i];
          const auto sensor = static_cast<std::size_t>(record.sensor);
          AppendRecord(solution.method, dataset.streams.at(sensor).sensor.name,
                       record, lines);
        });
  }
  file.Commit();
}

}  // namespace hindsight
