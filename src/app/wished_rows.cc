#include "app/wished_rows.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"

namespace hindsight {

Times::Times(std::vector<double> list)
    : count_(list.size()), list_(std::move(list)) {}

Times::Times(const Solution& solution, double rate)
    : first_(std::ceil(solution.states.front().t * rate)), rate_(rate) {
  const double last = std::floor(solution.states.back().t * rate);
  count_ = static_cast<std::size_t>(std::max(last - first_ + 1.0, 0.0));
}

double Times::Next() const {
  return rate_ > 0.0 ? (first_ + static_cast<double>(at_)) / rate_ : list_[at_];
}

bool Times::Take(double t) {
  const std::size_t before = at_;
  while (!IsAtEnd() && Next() == t) ++at_;
  return at_ > before;
}

/// Collects what a wish is given.
std::function<void(const SolutionTable&)> Into(SolutionTable* table) {
  return [table](const SolutionTable& piece) { AppendTable(piece, table); };
}

SolutionTable TableAt(const Eigen::Vector3d& point_b, const Dataset& dataset,
                      const Solution& solution) {
  const bool moved = !point_b.isZero(0.0);
  if (!moved && dataset.mounting_sigma.isZero(0.0)) {
    return TableFromSolution(solution);
  }
  const Solution known = WithMountingSigma(solution, dataset.mounting_sigma);
  return TableFromSolution(moved ? MoveToPoint(known, dataset.imu, point_b)
                                 : known);
}

namespace {

/// Times of the next rows that anyone wishes, and who wishes which of them.
struct WishedRows {
  std::vector<double> times;
  std::vector<std::vector<std::size_t>> of_wish;
};

WishedRows NextRows(std::size_t most, std::vector<Wish>* wishes) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  WishedRows next;
  next.of_wish.resize(wishes->size());
  while (next.times.size() < most) {
    double t = kNever;
    for (const Wish& wish : *wishes) {
      if (!wish.times.IsAtEnd()) t = std::min(t, wish.times.Next());
    }
    if (t == kNever) break;
    for (std::size_t i = 0; i < wishes->size(); ++i) {
      if ((*wishes)[i].times.Take(t)) {
        next.of_wish[i].push_back(next.times.size());
      }
    }
    next.times.push_back(t);
  }
  return next;
}

}  // namespace

void SampleRows(const Dataset& dataset, const Reconstruction& reconstruction,
                const Solution& solution, std::vector<Wish> wishes) {
  constexpr std::size_t kPiece = 10000;
  struct Piece {
    WishedRows rows;
    std::future<Solution> solution;  ///< none behind the last
  };
  const auto begin = [&] {
    Piece piece{NextRows(kPiece, &wishes), {}};
    if (!piece.rows.times.empty()) {
      piece.solution = InBackground([&, times = piece.rows.times] {
        return reconstruction.Sample(solution, times);
      });
    }
    return piece;
  };
  // The next piece is sampled while this one is used.
  for (Piece piece = begin(); piece.solution.valid();) {
    const Solution sampled = piece.solution.get();
    const WishedRows here = std::exchange(piece, begin()).rows;
    std::optional<Eigen::Vector3d> point_b;
    SolutionTable table;
    for (std::size_t i = 0; i < wishes.size(); ++i) {
      const Wish& wish = wishes[i];
      const std::vector<std::size_t>& rows = here.of_wish[i];
      if (rows.empty()) continue;
      if (point_b != wish.point_b) {
        point_b = wish.point_b;
        table = TableAt(wish.point_b, dataset, sampled);
      }
      wish.take(rows.size() == table.size() ? table : RowsOf(table, rows));
    }
  }
}

}  // namespace hindsight
