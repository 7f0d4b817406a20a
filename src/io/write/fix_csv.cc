#include "io/write/fix_csv.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "dataset/injection.h"
#include "earth/wgs84.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Records of one sensor in time order.
std::vector<const ResidualRecord*> RecordsOf(const Solution& solution,
                                             int sensor) {
  std::vector<const ResidualRecord*> records;
  for (const ResidualRecord& record : solution.residuals) {
    if (record.sensor == sensor) records.push_back(&record);
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const auto* a, const auto* b) { return a->t < b->t; });
  return records;
}

/// What became of the measurement at `t`; null if nothing stands there. A node
/// may lie off by what the offset has changed by since it was placed.
const ResidualRecord* RecordAt(
    const std::vector<const ResidualRecord*>& records, double t) {
  constexpr double kNear = 0.02;
  const auto after =
      std::lower_bound(records.begin(), records.end(), t,
                       [](const ResidualRecord* record, double time) {
                         return record->t < time;
                       });
  const ResidualRecord* nearest = nullptr;
  if (after != records.end()) nearest = *after;
  if (after != records.begin() &&
      (nearest == nullptr || t - after[-1]->t < nearest->t - t)) {
    nearest = after[-1];
  }
  if (nearest == nullptr || std::abs(nearest->t - t) > kNear) return nullptr;
  return nearest;
}

void AppendFix(const std::string& sensor, double t, const PositionFix& fix,
               bool withheld, const ResidualRecord* record, std::string* out) {
  const Geodetic place = GeodeticFromEcef(fix.p_e);
  AppendFixed(t, 6, out);
  *out += ',' + sensor + ',';
  AppendFixed(place.latitude / kDegree, 10, out);
  *out += ',';
  AppendFixed(place.longitude / kDegree, 10, out);
  *out += ',';
  AppendFixed(place.height, 4, out);
  for (int axis = 0; axis < 3; ++axis) {
    *out += ',';
    AppendGeneral(std::sqrt(fix.R_n(axis, axis)), 6, out);
  }
  for (const double said : {fix.quality, fix.satellites}) {
    *out += ',';
    if (std::isfinite(said)) AppendGeneral(said, 6, out);
  }
  *out += withheld            ? ",withheld,"
          : record == nullptr ? ",unused,"
          : record->accepted  ? ",used,"
                              : ",rejected,";
  const bool used = !withheld && record != nullptr && record->accepted;
  AppendGeneral(used ? record->weight : 0.0, 6, out);
  *out += '\n';
}

}  // namespace

bool HasFixes(const Dataset& dataset) {
  return std::any_of(dataset.streams.begin(), dataset.streams.end(),
                     [](const AidingStream& stream) {
                       return stream.sensor.kind->is_position &&
                              !stream.measurements.empty();
                     });
}

void WriteFixCsv(const std::string& path, const Solution& solution,
                 const Dataset& dataset) {
  AtomicFile file(path);
  for (const Injection& injection : dataset.injections) {
    file.Write("# error injected on purpose: " + Describe(injection) + "\n");
  }
  file.Write(EpochComment(dataset.epoch_gps_ns));
  file.Write("# weight and status of " + solution.method +
             "\nt[s],sensor,lat[deg],lon[deg],h[m],sd_n[m],sd_e[m],sd_d[m],"
             "quality,satellites,status,weight\n");
  std::string line;
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const AidingStream& stream = dataset.streams[i];
    if (!stream.sensor.kind->is_position) continue;
    const int sensor = static_cast<int>(i);
    const std::vector<const ResidualRecord*> records =
        RecordsOf(solution, sensor);
    const double offset =
        solution.states.empty()
            ? stream.sensor.time_offset
            : Parameter1(solution.layout, solution.states.back(),
                         BlockKind::kTimeOffset, sensor,
                         stream.sensor.time_offset);
    for (const Measurement& z : stream.measurements) {
      const auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr) continue;
      line.clear();
      AppendFix(stream.sensor.name, z.t + offset, *fix, z.withheld,
                RecordAt(records, z.t + offset), &line);
      file.Write(line);
    }
  }
  file.Commit();
}

}  // namespace hindsight
