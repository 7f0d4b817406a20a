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

namespace {

/// Rows that are sampled, or made a table of, at once.
constexpr std::size_t kPiece = 10000;

/// The solution that TableAt is of; nothing where it is `solution` itself.
std::optional<Solution> SolutionAt(const Eigen::Vector3d& point_b,
                                   const Dataset& dataset,
                                   const Solution& solution) {
  const bool moved = !point_b.isZero(0.0);
  if (!moved && dataset.mounting_sigma.isZero(0.0)) return std::nullopt;
  const Solution known = WithMountingSigma(solution, dataset.mounting_sigma);
  return moved ? MoveToPoint(known, dataset.imu, point_b) : known;
}

}  // namespace

SolutionTable TableAt(const Eigen::Vector3d& point_b, const Dataset& dataset,
                      const Solution& solution) {
  const std::optional<Solution> at = SolutionAt(point_b, dataset, solution);
  return TableFromSolution(at ? *at : solution);
}

void TakeNodes(const Eigen::Vector3d& point_b, const Dataset& dataset,
               const Solution& solution,
               const std::function<void(const SolutionTable&)>& take) {
  const std::optional<Solution> at = SolutionAt(point_b, dataset, solution);
  const Solution& own = at ? *at : solution;
  const std::size_t count = own.states.size();
  const auto begin = [&own, count](std::size_t from) {
    std::future<SolutionTable> table;
    if (from < count) {
      table = InBackground([&own, from, to = std::min(from + kPiece, count)] {
        return TableFromSolution(own, from, to);
      });
    }
    return table;
  };
  // The next piece is made while this one is used.
  std::size_t next = 0;
  for (std::future<SolutionTable> piece = begin(next); piece.valid();) {
    const SolutionTable table = piece.get();
    next += kPiece;
    piece = begin(next);
    take(table);
  }
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

namespace {

/// Of a sampled solution, what each wish asks for.
std::vector<SolutionTable> TablesOf(const Dataset& dataset,
                                    const Solution& sampled,
                                    const std::vector<Wish>& wishes,
                                    const WishedRows& wished) {
  std::vector<SolutionTable> tables(wishes.size());
  std::optional<Eigen::Vector3d> point_b;
  SolutionTable table;
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    const std::vector<std::size_t>& rows = wished.of_wish[i];
    if (rows.empty()) continue;
    if (point_b != wishes[i].point_b) {
      point_b = wishes[i].point_b;
      table = TableAt(*point_b, dataset, sampled);
    }
    tables[i] = rows.size() == table.size() ? table : RowsOf(table, rows);
  }
  return tables;
}

}  // namespace

void SampleRows(
    const Dataset& dataset, const Reconstruction& reconstruction,
    const Solution& solution, std::vector<Wish> wishes,
    const std::function<void(const std::vector<SolutionTable>&)>& take) {
  const auto begin = [&] {
    std::future<std::vector<SolutionTable>> piece;
    WishedRows rows = NextRows(kPiece, &wishes);
    if (!rows.times.empty()) {
      piece = InBackground([&, rows = std::move(rows)] {
        return TablesOf(dataset, reconstruction.Sample(solution, rows.times),
                        wishes, rows);
      });
    }
    return piece;
  };
  // The next piece is sampled while this one is used.
  for (auto piece = begin(); piece.valid();) {
    const std::vector<SolutionTable> tables = piece.get();
    piece = begin();
    take(tables);
  }
}

}  // namespace hindsight
