#include "receiver_errors/normal_points.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/median.h"
#include "linear/sparse_product.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {
namespace {

/// Nodes first to past the last, and the one to which they are carried.
struct Interval {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t node = 0;
};

/// Neighbours of the same number together, carried to the middle one.
std::vector<Interval> IntervalsOf(const std::vector<double>& numbers) {
  std::vector<Interval> all;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (k == 0 || numbers[k] != numbers[k - 1]) all.push_back({k, k, k});
    Interval& last = all.back();
    last.end = k + 1;
    last.node = last.begin + (last.end - last.begin) / 2;
  }
  return all;
}

/// Of each node its interval of such a length from the first on.
std::vector<double> NumbersOf(const LinearTape& tape, double length) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    // A stamp that rounding leaves short of an interval's begin is in it.
    numbers.push_back(std::floor((tape.t(k) - tape.t(0)) / length + 1e-6));
  }
  return numbers;
}

/// Nodes that are nearer to a fix than to others, by half a `length` at the most, are
/// carried to it.
std::vector<Interval> IntervalsAboutFixes(const LinearTape& tape, int sensor,
                                          double length) {
  std::vector<double> numbers = NumbersOf(tape, length);
  std::vector<std::size_t> fixes;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (HasFix(tape, k, sensor)) fixes.push_back(k);
  }
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < tape.size() && !fixes.empty(); ++k) {
    const auto distance = [&](std::size_t i) {
      return std::abs(tape.t(fixes[i]) - tape.t(k));
    };
    while (nearest + 1 < fixes.size() &&
           distance(nearest + 1) <= distance(nearest)) {
      ++nearest;
    }
    if (distance(nearest) > 0.5 * length) continue;
    numbers[k] = -1.0 - static_cast<double>(nearest);
  }
  std::vector<Interval> all = IntervalsOf(numbers);
  for (Interval& one : all) {
    for (std::size_t k = one.begin; k < one.end; ++k) {
      if (HasFix(tape, k, sensor)) one.node = k;
    }
  }
  return all;
}

/// x_b = F x_a + d + w, w ~ (0, Q).
Transition Identity(int n) {
  return {ErrorMatrix::Identity(n, n), ErrorMatrix::Zero(n, n),
          ErrorVector::Zero(n)};
}

/// What leads to node k - 1, and then to k.
void Lengthen(const LinearTape& tape, std::size_t k, Transition* t) {
  const SparseCongruence over = tape.OverInterval(k);
  over.ApplyToColumns(&t->Phi);
  over.ApplyTo(&t->c);
  t->c += tape.c(k);
  over.ApplyCongruence(&t->Q);
  t->Q += tape.Q(k);
}

/// What leads from node k to the end of `t`, which begins at node k + 1.
void Precede(const LinearTape& tape, std::size_t k, Transition* t) {
  const SparseCongruence after(t->Phi);
  ErrorVector c = tape.c(k + 1);
  after.ApplyTo(&c);
  t->c += c;
  ErrorMatrix Q = tape.Q(k + 1);
  after.ApplyCongruence(&Q);
  t->Q += Q;
  t->Phi = Times(t->Phi, tape.Phi(k + 1));
}

/// A measurement carried to another node.
struct Carried {
  const TapeMeasurement* from = nullptr;
  LinearizedMeasurement z;
};

/// x at its node is F x + d + w of the middle node.
Carried CarryBack(const TapeMeasurement& z, const Transition& t) {
  Carried out{&z, {}};
  out.z.H = z.H * t.Phi;
  out.z.residual = z.residual - z.H * t.c;
  out.z.R = z.R + z.H * t.Q * z.H.transpose();
  return out;
}

/// Of a matrix of which many rows are those of the identity.
ErrorMatrix InverseOf(const ErrorMatrix& Phi) {
  const Eigen::Index n = Phi.rows();
  std::vector<Eigen::Index> moved;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool is_kept = Phi.row(i) == Eigen::RowVectorXd::Unit(n, i);
    (is_kept ? kept : moved).push_back(i);
  }
  const ErrorMatrix of_moved = ErrorMatrix(Phi(moved, moved)).inverse();
  ErrorMatrix inverse = ErrorMatrix::Identity(n, n);
  inverse(moved, moved) = of_moved;
  inverse(moved, kept) = -of_moved * Phi(moved, kept);
  return inverse;
}

/// Carries what was measured before the middle node, whose x is F x + d + w of the
/// node of the measurement. F keeps nothing of a component that is drawn anew
/// meanwhile, as an error of a sensor is.
class CarryingOn {
 public:
  explicit CarryingOn(const Transition& t) : t_(t) {
    ErrorMatrix Phi = t.Phi;
    for (Eigen::Index i = 0; i < Phi.rows(); ++i) {
      if (!Phi.row(i).isZero(0.0)) continue;
      Phi(i, i) = 1.0;  // in place of what is drawn anew, what was there
      anew_.push_back(i);
    }
    inverse_ = InverseOf(Phi);
  }

  /// Nothing of a measurement that depends on what is drawn anew.
  std::optional<Carried> Of(const TapeMeasurement& z) const {
    Carried out{&z, {}};
    out.z.H = z.H * inverse_;
    for (const Eigen::Index i : anew_) {
      if (!out.z.H.col(i).isZero(0.0)) return std::nullopt;
    }
    out.z.residual = z.residual + out.z.H * t_.c;
    out.z.R = z.R + out.z.H * t_.Q * out.z.H.transpose();
    return out;
  }

 private:
  const Transition& t_;
  ErrorMatrix inverse_;
  std::vector<Eigen::Index> anew_;
};

bool IsUsed(const TapeMeasurement& z) { return z.accepted && !z.withheld; }

std::vector<Carried> CarryTogether(const LinearTape& tape,
                                   const Interval& interval) {
  std::vector<Carried> all;
  const std::size_t middle = interval.node;
  Transition back = Identity(tape.dim());
  for (std::size_t k = middle; k < interval.end; ++k) {
    if (k > middle) Lengthen(tape, k, &back);
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (IsUsed(z)) all.push_back(CarryBack(z, back));
    }
  }
  Transition on = Identity(tape.dim());
  for (std::size_t k = middle; k-- > interval.begin;) {
    Precede(tape, k, &on);
    const CarryingOn carrying(on);
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!IsUsed(z)) continue;
      if (auto carried = carrying.Of(z)) all.push_back(*std::move(carried));
    }
  }
  return all;
}

/// Without those far from the median of all on any axis, unless half are.
std::vector<const Carried*> WithoutOutliers(
    const std::vector<const Carried*>& all) {
  constexpr double kFar = 5.0;  // sigma
  const Eigen::Index rows = all.front()->z.residual.size();
  RowVector median(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    std::vector<double> values;
    for (const Carried* one : all) values.push_back(one->z.residual(i));
    median(i) = Median(std::move(values));
  }
  std::vector<const Carried*> near;
  for (const Carried* one : all) {
    const RowVector off = one->z.residual - median;
    if ((off.array().square() <= kFar * kFar * one->z.R.diagonal().array())
            .all()) {
      near.push_back(one);
    }
  }
  return 2 * near.size() > all.size() ? near : all;
}

LinearizedMeasurement Average(const std::vector<const Carried*>& all) {
  double sum = 0.0;
  for (const Carried* one : all) sum += 1.0 / one->z.R.trace();
  LinearizedMeasurement mean = all.front()->z;
  mean.residual.setZero();
  mean.H.setZero();
  mean.R.setZero();
  for (const Carried* one : all) {
    const double weight = 1.0 / (one->z.R.trace() * sum);
    mean.residual += weight * one->z.residual;
    mean.H += weight * one->z.H;
    mean.R += weight * weight * one->z.R;
  }
  return mean;
}

void RecordAverages(const std::vector<Carried>& all, int sensor,
                    LinearTape* tape) {
  std::map<std::pair<int, Eigen::Index>, std::vector<const Carried*>> groups;
  for (const Carried& one : all) {
    groups[{one.from->sensor, one.z.residual.size()}].push_back(&one);
  }
  for (const auto& [key, group] : groups) {
    const LinearizedMeasurement z =
        Average(key.first == sensor ? WithoutOutliers(group) : group);
    TapeMeasurement header;
    header.sensor = key.first;
    tape->Record(header, z, {z.residual, z.R, 0.0, 0.0});
  }
}

/// The tape of one node an interval.
LinearTape Thin(const LinearTape& tape, int sensor,
                const std::vector<Interval>& intervals) {
  LinearTape out(tape.layout(), tape.error());
  std::size_t last = 0;
  ErrorVector mean = tape.epoch(0).dx_minus;
  ErrorMatrix P = tape.P_minus(0);
  for (const Interval& one : intervals) {
    Transition t = Identity(tape.dim());
    for (std::size_t k = last + 1; k <= one.node; ++k) {
      Lengthen(tape, k, &t);
    }
    last = one.node;
    TapeEpoch epoch = tape.epoch(last);
    epoch.c = t.c;
    if (out.size() == 0) {
      mean = (t.Phi * mean + t.c).eval();
      P = (t.Phi * P * t.Phi.transpose() + t.Q).eval();
      epoch.dx_minus = mean;
    } else {
      P = tape.P_minus(last);
    }
    RecordAverages(CarryTogether(tape, one), sensor, &out);
    out.Append(epoch, t, P, P);
  }
  return out;
}

}  // namespace

std::optional<LinearTape> ThinBetweenFixes(const LinearTape& tape, int sensor,
                                           double interval) {
  const std::vector<Interval> intervals =
      IntervalsAboutFixes(tape, sensor, interval);
  if (3 * intervals.size() > 2 * tape.size()) return std::nullopt;
  return Thin(tape, sensor, intervals);
}

double NormalPointInterval(const LinearTape& tape) {
  constexpr double kIntervals = 1200.0;
  constexpr double kShortest = 0.5;
  return std::clamp((tape.t(tape.size() - 1) - tape.t(0)) / kIntervals,
                    kShortest, kNormalPointInterval);
}

std::optional<NormalPoints> FormNormalPoints(const LinearTape& tape, int sensor,
                                             double interval) {
  const std::vector<Interval> intervals =
      IntervalsOf(NumbersOf(tape, interval));
  std::vector<std::size_t> point_of_fix;
  std::size_t points = 0;
  for (const Interval& one : intervals) {
    std::size_t fixes = 0;
    for (std::size_t k = one.begin; k < one.end; ++k) {
      fixes += HasFix(tape, k, sensor);
    }
    point_of_fix.insert(point_of_fix.end(), fixes, points);
    points += fixes > 0;
  }
  if (3 * points > 2 * point_of_fix.size()) return std::nullopt;
  return NormalPoints{Thin(tape, sensor, intervals), std::move(point_of_fix)};
}

ModeSequence AtFixes(const NormalPoints& points, const ModeSequence& sequence) {
  ModeSequence out;
  for (std::size_t i = 0; i < points.point_of_fix.size(); ++i) {
    const std::size_t point = points.point_of_fix[i];
    const bool first = i == 0 || points.point_of_fix[i - 1] != point;
    out.push_back(first ? sequence[point]
                        : ErrorStep{.mode = sequence[point].mode,
                                    .outlier = sequence[point].outlier});
    // The time before a fix is another than that before its point.
    out.back().onset = Onset::kUsual;
  }
  return out;
}

}  // namespace hindsight
