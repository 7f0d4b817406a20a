#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "io/reader_rows.h"

namespace hindsight {
namespace {

/// The three values from `first` on, or nothing if one is absent.
std::optional<Eigen::Vector3d> Group(const TextTable& table,
                                     std::size_t first) {
  const Eigen::Vector3d value(table.value(first), table.value(first + 1),
                              table.value(first + 2));
  if (!value.allFinite()) return std::nullopt;
  return value;
}

void RequireWholeGroups(const StreamRows& rows, const TextFormat& format) {
  bool any = false;
  for (const std::size_t first :
       {std::size_t{0}, std::size_t{3}, std::size_t{6}}) {
    const TextTable& table = rows.table();
    if (table.Has(first) || table.Has(first + 1) || table.Has(first + 2)) {
      RequireFields(rows.opened(), format, TruthFields(), first, first + 2);
      any = true;
    }
  }
  if (!any) RequireFields(rows.opened(), format, TruthFields(), 0, 2);
}

}  // namespace

std::vector<TruthPoint> ReadTruth(const StreamSource& source,
                                  const TruthReadOptions& options,
                                  StreamClock* clock,
                                  std::vector<PolicyCount>* policies) {
  StreamRows rows(source, TruthFields(), options.absent_values);
  RequireWholeGroups(rows, source.format);
  const TextTable& table = rows.table();
  std::vector<TruthPoint> truth;
  long absent = 0;
  while (true) {
    const StreamRows::Step step = rows.Next();
    if (step == StreamRows::Step::kEnd) break;
    if (truth.empty()) truth.reserve(table.RowsHint());
    if (step == StreamRows::Step::kReplace) truth.pop_back();
    TruthPoint point;
    point.t = rows.t();
    const auto geodetic = Group(table, 0);
    const auto euler = Group(table, 6);
    point.v_n = Group(table, 3);
    if (geodetic) {
      if (std::abs(geodetic->x()) > kPi / 2.0) {
        table.Fail("the latitude is " + FormatNumber(geodetic->x() / kDegree) +
                   " deg; expected -90 to 90 deg");
      }
      point.p_e =
          EcefFromGeodetic({geodetic->x(), geodetic->y(), geodetic->z()});
    }
    if (euler) {
      point.q_nb = QuaternionFromEuler(euler->x(), euler->y(), euler->z());
    }
    if ((!geodetic && table.Has(0)) || (!point.v_n && table.Has(3)) ||
        (!euler && table.Has(6))) {
      ++absent;
    }
    truth.push_back(point);
  }
  *clock = rows.clock();
  rows.CountPolicies(policies);
  AddPolicy(source.name, "row with absent values", absent, policies);
  return truth;
}

}  // namespace hindsight
