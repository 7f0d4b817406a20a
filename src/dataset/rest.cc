#include "dataset/rest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "dataset/excluded_motion.h"
#include "dataset/imu_cells.h"
#include "dataset/rest_departure.h"
#include "dataset/speed_evidence.h"
#include "dataset/turned_rest.h"

namespace hindsight {
namespace {

constexpr double kMotion = 0.3;        // certainly moving above this [m/s]
constexpr double kMargin = 1.0;        // of certain motion [s]
constexpr double kTogether = 2.5;      // between two that say the same [s]
constexpr double kShortestRest = 3.0;  // of what is shaken [s]
constexpr double kTrim = 0.5;          // of what is in doubt, either end [s]
constexpr double kSigmas = 4.0;

enum class Verdict { kNone, kContradicted, kMoving, kAtRest };

/// In the order of their numbers.
std::vector<TimeInterval> SpansOf(const std::vector<ImuCell>& cells) {
  std::vector<TimeInterval> spans;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].span < 0) continue;
    if (i == 0 || cells[i].span != cells[i - 1].span) {
      spans.push_back({cells[i].begin, cells[i].end});
    }
    spans.back().end = cells[i].end;
  }
  return spans;
}

class Decision {
 public:
  explicit Decision(const Dataset& dataset)
      : noise_(dataset.imu.noise),
        options_(dataset.stationary),
        aiding_(dataset),
        cells_(ExamineImu(dataset)),
        verdicts_(cells_.size(), Verdict::kNone),
        information_(cells_.size(), 0.0) {
    speeds_ = MeasureSpeeds(dataset, SpansOf(cells_));
  }

  Rest Decide() {
    MarkRests();
    MarkContradictions();
    CarryRests();
    CutDepartures();
    LeaveOutShortShaken();
    Rest rest;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (verdicts_[i] == Verdict::kAtRest) {
        Append(i, &rest.at_rest);
      } else if (!cells_[i].quiet) {
        continue;
      } else if (verdicts_[i] == Verdict::kMoving) {
        Append(i, &rest.moving);
      } else {
        Append(i, &rest.undecided);
      }
    }
    return rest;
  }

 private:
  Verdict Judge(const SpeedEvidence& speed) const {
    const double v_h = speed.v.head<2>().norm();
    const double s_h = speed.horizontal_sigma();
    if (v_h > std::max(kMotion, 5.0 * s_h) ||
        std::abs(speed.v.z()) > std::max(kMotion, 5.0 * speed.sigma.z())) {
      return Verdict::kMoving;
    }
    const double slack = 2.0 * options_.velocity_sigma;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(speed.v(axis)) > kSigmas * speed.sigma(axis) + slack) {
        return Verdict::kContradicted;
      }
    }
    return s_h <= kKnownSpeed ? Verdict::kAtRest : Verdict::kNone;
  }

  /// First cell that ends at or after t.
  std::size_t CellAt(double t) const {
    return static_cast<std::size_t>(
        std::lower_bound(
            cells_.begin(), cells_.end(), t,
            [](const ImuCell& cell, double time) { return cell.end < time; }) -
        cells_.begin());
  }

  /// Neighbouring measurements that say the same speak of the time between
  /// them, too.
  void MarkRests() {
    const SpeedEvidence* before = nullptr;
    for (const SpeedEvidence& speed : speeds_) {
      if (speed.span < 0 || Judge(speed) != Verdict::kAtRest) continue;
      const bool together = before != nullptr && before->span == speed.span &&
                            speed.begin - before->end <= kTogether;
      const double information = std::pow(speed.horizontal_sigma(), -2);
      const double length = speed.end - speed.begin;
      for (std::size_t i = CellAt(together ? std::min(before->end, speed.begin)
                                           : speed.begin);
           i < cells_.size() && cells_[i].begin <= speed.end; ++i) {
        if (cells_[i].span != speed.span) continue;
        verdicts_[i] = Verdict::kAtRest;
        const double cell = cells_[i].length();
        information_[i] = information * cell / std::max(length, cell);
      }
      if (before == nullptr || speed.end > before->end) before = &speed;
    }
  }

  void MarkContradictions() {
    for (const SpeedEvidence& speed : speeds_) {
      const Verdict verdict = Judge(speed);
      if (verdict == Verdict::kAtRest || verdict == Verdict::kNone) continue;
      // From the middle of what was measured, but all of that.
      const double margin =
          std::max(0.0, (verdict == Verdict::kMoving ? kMargin : kTrim) -
                            0.5 * (speed.end - speed.begin));
      for (std::size_t i = CellAt(speed.begin - margin);
           i < cells_.size() && cells_[i].begin <= speed.end + margin; ++i) {
        if (verdicts_[i] != Verdict::kMoving) verdicts_[i] = verdict;
      }
    }
  }

  using Run = std::pair<std::size_t, std::size_t>;

  /// First and last cell of each rest.
  std::vector<Run> Runs() const {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (verdicts_[i] != Verdict::kAtRest) continue;
      if (i > 0 && verdicts_[i - 1] == Verdict::kAtRest &&
          cells_[i].span == cells_[i - 1].span) {
        runs.back().second = i;
      } else {
        runs.emplace_back(i, i);
      }
    }
    return runs;
  }

  void CarryRests() {
    for (const auto& [first, last] : Runs()) {
      Carry(first, last, +1);
      Carry(first, last, -1);
    }
  }

  /// From a run of cells at rest while the speed gathered since stays small.
  void Carry(std::size_t first, std::size_t last, int step) {
    Eigen::Vector3d f = Eigen::Vector3d::Zero();
    double T = 0.0;
    double information = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      if (!cells_[i].quiet) continue;
      f += cells_[i].length() * cells_[i].f;
      T += cells_[i].length();
      information += information_[i];
    }
    if (T == 0.0) return;
    f /= T;
    const double wide = std::max(T, options_.window);
    const double slope = std::sqrt(12.0 / information) / wide;
    Eigen::Vector3d gathered = Eigen::Vector3d::Zero();
    double tau = 0.0;
    std::size_t i = step > 0 ? last : first;
    while (true) {
      if (step < 0 && i == 0) return;
      i = step > 0 ? i + 1 : i - 1;
      if (i == cells_.size() || !cells_[i].quiet ||
          cells_[i].span != cells_[first].span ||
          verdicts_[i] != Verdict::kNone) {
        return;
      }
      gathered += cells_[i].length() * (cells_[i].f - f);
      tau += cells_[i].length();
      const double felt = GatheredSigma(noise_, tau, wide);
      if (std::hypot(slope * tau, felt) > kKnownSpeed ||
          gathered.norm() > kSigmas * felt + 2.0 * options_.velocity_sigma) {
        return;
      }
      verdicts_[i] = Verdict::kAtRest;
    }
  }

  void CutDepartures() {
    for (Run run : Runs()) {
      while (CutEnd(&run, +1) || CutEnd(&run, -1)) {
      }
    }
  }

  /// Whether there was something to cut at the end of a rest, or its begin.
  bool CutEnd(Run* run, int step) {
    const auto [first, last] = *run;
    const std::size_t cut =
        DepartedCells(std::span(cells_).subspan(first, last + 1 - first), step,
                      noise_, aiding_);
    if (cut == 0) return false;
    for (std::size_t n = 1; n <= cut; ++n) {
      verdicts_[step > 0 ? last + 1 - n : first + n - 1] =
          Verdict::kContradicted;
    }
    (step > 0 ? run->second : run->first) = step > 0 ? last - cut : first + cut;
    return true;
  }

  /// What idles may have begun to move where its speed is not yet seen.
  void LeaveOutShortShaken() {
    for (std::size_t i = 0; i < cells_.size();) {
      std::size_t end = i;
      bool quiet = false;
      while (end < cells_.size() && verdicts_[end] == Verdict::kAtRest &&
             cells_[end].span == cells_[i].span) {
        quiet = quiet || cells_[end].quiet;
        ++end;
      }
      if (end == i) {
        ++i;
        continue;
      }
      const double from = cells_[i].begin + kTrim;
      const double to = cells_[end - 1].end - kTrim;
      for (std::size_t k = i; k < end; ++k) {
        if (cells_[k].quiet) continue;
        const bool inside = cells_[k].begin >= from && cells_[k].end <= to;
        if (!inside || (!quiet && to - from < kShortestRest)) {
          verdicts_[k] = Verdict::kNone;
        }
      }
      i = end;
    }
  }

  void Append(std::size_t i, std::vector<TimeInterval>* spans) const {
    const ImuCell& cell = cells_[i];
    const bool joined =
        i > 0 && !spans->empty() && spans->back().end == cells_[i - 1].end &&
        cells_[i - 1].end == cell.begin && cells_[i - 1].span == cell.span;
    if (joined) {
      spans->back().end = cell.end;
    } else {
      spans->push_back({cell.begin, cell.end});
    }
  }

  const ImuNoise& noise_;
  const StationaryOptions& options_;
  ExcludedMotion aiding_;
  std::vector<ImuCell> cells_;
  std::vector<Verdict> verdicts_;
  /// A cell's part of that of the speed which shows its rest [s^2/m^2].
  std::vector<double> information_;
  std::vector<SpeedEvidence> speeds_;
};

}  // namespace

Rest FindRest(const Dataset& dataset) {
  Rest rest = Decision(dataset).Decide();
  LeaveOutContradicted(dataset, &rest);
  LeaveOutTurned(dataset, &rest);
  return rest;
}

Rest RestMemo::Of(const Dataset& dataset) const {
  if (&dataset != &dataset_) return FindRest(dataset);
  const std::lock_guard<std::mutex> guard(mutex_);
  if (!found_) found_ = FindRest(dataset_);
  return *found_;
}

void LeaveOutContradicted(const Dataset& dataset, Rest* rest) {
  const ExcludedMotion aiding(dataset);
  std::vector<TimeInterval> remaining;
  for (const TimeInterval& span : rest->at_rest) {
    aiding.Cut(span, &remaining, &rest->undecided);
  }
  rest->at_rest = std::move(remaining);
  std::sort(rest->undecided.begin(), rest->undecided.end(),
            [](const TimeInterval& a, const TimeInterval& b) {
              return a.begin < b.begin;
            });
}

}  // namespace hindsight
