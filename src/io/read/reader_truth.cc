#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "io/read/reader_rows.h"

namespace hindsight {
namespace {

/// Where the groups start in TruthFields().
constexpr std::size_t kGeodetic = 0;
constexpr std::size_t kVelocityNed = 3;
constexpr std::size_t kEuler = 6;
constexpr std::size_t kPosition = 9;
constexpr std::size_t kVelocity = 12;
constexpr std::size_t kQuaternion = 15;
constexpr std::size_t kMoving = 19;

/// A unit quaternion in a file is one to about this.
constexpr double kNormTolerance = 0.01;

class TruthReader {
 public:
  TruthReader(const StreamSource& source, const TruthReadOptions& options)
      : options_(options), rows_(source, TruthFields(), source.absent_values) {
    RequireWholeGroups(source.format);
    if (options.frame.axes == FrameAxes::kEcef) return;
    if (options.frame.origin) {
      frame_ =
          FrameAt(options.frame.axes, EcefFromGeodetic(*options.frame.origin));
    } else if (Has(kPosition)) {
      throw InputError(source.config_path, source.config_line,
                       source.name +
                           " has positions in local axes; expected `origin`, "
                           "the latitude, longitude and height of their zero");
    }
  }

  TruthSeries Read(long* absent) {
    TruthSeries truth;
    while (true) {
      const StreamRows::Step step = rows_.Next();
      if (step == StreamRows::Step::kEnd) break;
      if (step == StreamRows::Step::kReplace) truth.pop_back();
      const TruthPoint point = Point();
      truth.push_back(point);
      if (IsIncomplete(point)) ++*absent;
    }
    return truth;
  }

  const StreamRows& rows() const { return rows_; }

 private:
  bool Has(std::size_t first) const { return rows_.table().Has(first); }

  void RequireWholeGroups(const TextFormat& format) const {
    bool any = false;
    for (const std::size_t first :
         {kGeodetic, kVelocityNed, kEuler, kPosition, kVelocity, kQuaternion}) {
      const std::size_t last = first + (first == kQuaternion ? 3 : 2);
      for (std::size_t i = first; i <= last; ++i) {
        if (!Has(i)) continue;
        RequireFields(rows_.opened(), format, TruthFields(), first, last);
        any = true;
        break;
      }
    }
    if (!any) RequireFields(rows_.opened(), format, TruthFields(), 0, 2);
  }

  /// The three values from `first` on, or nothing if one is absent.
  std::optional<Eigen::Vector3d> Group(std::size_t first) const {
    const RowSource& table = rows_.table();
    if (!table.Has(first)) return std::nullopt;
    const Eigen::Vector3d value(table.value(first), table.value(first + 1),
                                table.value(first + 2));
    if (!value.allFinite()) return std::nullopt;
    return value;
  }

  TruthPoint Point() const {
    TruthPoint point;
    point.t = rows_.t();
    point.p_e = Position();
    point.v_n = Group(kVelocityNed);
    if (const auto v = Group(kVelocity)) point.v_n = Turn(*v, point);
    if (const auto euler = Group(kEuler)) {
      point.q_nb = QuaternionFromEuler(euler->x(), euler->y(), euler->z()) *
                   Eigen::Quaterniond(options_.C_bs.transpose());
    }
    if (const auto q = Attitude(point)) point.q_nb = q;
    const RowSource& table = rows_.table();
    if (table.Has(kMoving) && std::isfinite(table.value(kMoving))) {
      point.moving = table.value(kMoving) != 0.0;
    }
    return point;
  }

  std::optional<Eigen::Vector3d> Position() const {
    if (const auto geodetic = Group(kGeodetic)) {
      const Geodetic place{geodetic->x(), geodetic->y(), geodetic->z()};
      if (const auto why = WhyNotNearEarth(place)) rows_.table().Fail(*why);
      return EcefFromGeodetic(place);
    }
    const auto p = Group(kPosition);
    if (!p) return std::nullopt;
    return Eigen::Vector3d(frame_.origin_e + frame_.C_el * *p);
  }

  /// From the frame's axes to NED at the point; nothing if that needs a
  /// position which is not there.
  std::optional<Eigen::Matrix3d> NedFromFrame(const TruthPoint& point) const {
    const FrameAxes axes = options_.frame.axes;
    if (axes != FrameAxes::kEcef && !options_.frame.origin) {
      return NedFromLevel(axes);
    }
    if (!point.p_e) return std::nullopt;
    return Eigen::Matrix3d(NedAxes(*point.p_e).transpose() * frame_.C_el);
  }

  std::optional<Eigen::Vector3d> Turn(const Eigen::Vector3d& v,
                                      const TruthPoint& point) const {
    const auto C = NedFromFrame(point);
    if (!C) return std::nullopt;
    return Eigen::Vector3d(*C * v);
  }

  std::optional<Eigen::Quaterniond> Attitude(const TruthPoint& point) const {
    const RowSource& table = rows_.table();
    const auto vector = Group(kQuaternion + 1);
    const auto C = NedFromFrame(point);
    if (!vector || !C || !std::isfinite(table.value(kQuaternion))) {
      return std::nullopt;
    }
    Eigen::Quaterniond q(table.value(kQuaternion), vector->x(), vector->y(),
                         vector->z());
    if (std::abs(q.norm() - 1.0) > kNormTolerance) {
      table.Fail("the quaternion has the norm " + FormatNumber(q.norm()) +
                 "; expected 1");
    }
    q.normalize();
    if (options_.frame.frame_to_body) q = q.conjugate();
    const Eigen::Quaterniond q_nb =
        Eigen::Quaterniond(*C) * q *
        Eigen::Quaterniond(options_.C_bs.transpose());
    return q_nb.normalized();
  }

  bool IsIncomplete(const TruthPoint& point) const {
    return (!point.p_e && (Has(kGeodetic) || Has(kPosition))) ||
           (!point.v_n && (Has(kVelocityNed) || Has(kVelocity))) ||
           (!point.q_nb && (Has(kEuler) || Has(kQuaternion)));
  }

  const TruthReadOptions& options_;
  StreamRows rows_;
  LocalFrame frame_;
};

}  // namespace

TruthSeries ReadTruth(const StreamSource& source,
                      const TruthReadOptions& options, StreamClock* clock,
                      std::vector<PolicyCount>* policies) {
  TruthReader reader(source, options);
  long absent = 0;
  TruthSeries truth = reader.Read(&absent);
  *clock = reader.rows().clock();
  reader.rows().CountPolicies(policies);
  AddPolicy(source.name, "row with absent values", absent, policies);
  return truth;
}

}  // namespace hindsight
