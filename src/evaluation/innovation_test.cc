#include "evaluation/innovation_test.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/chi_square.h"
#include "base/median.h"

namespace hindsight {
namespace {

struct Series {
  std::vector<double> t;
  std::vector<double> x;
};

using SeriesByComponent = std::map<std::pair<int, int>, Series>;

SeriesByComponent Sorted(std::span<const NormalisedInnovation> innovations) {
  SeriesByComponent all;
  for (const NormalisedInnovation& innovation : innovations) {
    for (int row = 0; row < innovation.rows.size(); ++row) {
      const int component =
          innovation.components.empty()
              ? row
              : innovation.components[static_cast<std::size_t>(row)];
      Series& series = all[{innovation.sensor, component}];
      series.t.push_back(innovation.t);
      series.x.push_back(innovation.rows(row));
    }
  }
  std::erase_if(all, [](const auto& entry) {
    return entry.second.x.size() < kFewestInnovations;
  });
  return all;
}

/// Squares of the normalised sums over blocks of m.
std::vector<double> BlockSquares(const std::vector<double>& x, std::size_t m) {
  std::vector<double> squares;
  for (std::size_t begin = 0; begin + m <= x.size(); begin += m) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + m; ++i) sum += x[i];
    squares.push_back(sum * sum / static_cast<double>(m));
  }
  return squares;
}

std::size_t CountOfLengths(std::size_t count) {
  std::size_t lengths = 0;
  for (std::size_t m = 1; m <= count; m *= 2) ++lengths;
  return lengths;
}

/// The shortest stretch of blocks that has nine tenths of the sum.
std::pair<std::size_t, std::size_t> MostOf(const std::vector<double>& squares) {
  constexpr double kMost = 0.9;
  double total = 0.0;
  for (const double square : squares) total += square;
  std::pair<std::size_t, std::size_t> best{0, squares.size()};
  double sum = 0.0;
  std::size_t begin = 0;
  for (std::size_t end = 1; end <= squares.size(); ++end) {
    sum += squares[end - 1];
    while (sum - squares[begin] >= kMost * total) sum -= squares[begin++];
    if (sum >= kMost * total && end - begin < best.second - best.first) {
      best = {begin, end};
    }
  }
  return best;
}

/// The usual time between two: over a gap nothing is measured.
double StepOf(const std::vector<double>& t) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  return Median(std::move(steps));
}

InnovationFigure FigureOf(const Series& series, double tail) {
  InnovationFigure figure;
  figure.count = series.x.size();
  const auto n = static_cast<double>(figure.count);
  double sum = 0.0, squares = 0.0, beyond = 0.0;
  for (const double x : series.x) {
    sum += x;
    squares += x * x;
    if (std::abs(x) > 3.0) beyond += 1.0;
  }
  figure.mean = sum / n;
  figure.rms = std::sqrt(squares / n);
  figure.beyond = beyond / n;
  const double step = StepOf(series.t);
  for (std::size_t m = 1; m <= figure.count; m *= 2) {
    const std::vector<double> blocks = BlockSquares(series.x, m);
    const auto count = static_cast<double>(blocks.size());
    double total = 0.0;
    for (const double block : blocks) total += block;
    const double excess =
        std::sqrt(total / ChiSquareQuantile(1.0 - tail, count));
    if (!(excess > figure.excess)) continue;
    figure.excess = excess;
    figure.length = m;
    figure.duration = static_cast<double>(m) * step;
    const auto [begin, end] = MostOf(blocks);
    figure.t_begin = series.t[begin * m];
    figure.t_end = series.t[end * m - 1];
  }
  return figure;
}

}  // namespace

std::vector<InnovationFigure> TestInnovations(
    std::span<const NormalisedInnovation> innovations, double false_alarms) {
  const SeriesByComponent all = Sorted(innovations);
  std::size_t tests = 0;
  for (const auto& [key, series] : all)
    tests += CountOfLengths(series.x.size());
  std::vector<InnovationFigure> figures;
  for (const auto& [key, series] : all) {
    InnovationFigure figure =
        FigureOf(series, false_alarms / static_cast<double>(tests));
    figure.sensor = key.first;
    figure.component = key.second;
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace hindsight
