#ifndef HINDSIGHT_EVALUATION_SERIES_FOLD_H_
#define HINDSIGHT_EVALUATION_SERIES_FOLD_H_

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hindsight {

/// Mean and scatter of series over some runs, at the times that all of them
/// have. Of any number of runs it is as large as of one.
struct SeriesFold {
  struct Moments {
    std::int64_t runs = 0;
    std::vector<double> mean;     ///< at every t
    std::vector<double> squares;  ///< sum of squared deviations from it
  };
  std::vector<double> t;  ///< [s]
  std::map<std::string, Moments> series;

  /// A statistic over the runs at every t.
  using OverRuns = std::vector<double> (*)(const Moments&);
  static std::vector<double> Mean(const Moments& moments) {
    return moments.mean;
  }
  /// Divisor runs - 1; zero of a single one.
  static std::vector<double> Deviation(const Moments& moments);
  static std::vector<double> Rms(const Moments& moments);
};

/// Indices of the times of `one` that are among `common`, to a microsecond;
/// `common` is cut down to those found. Both ascend.
std::vector<std::size_t> MatchTimes(const std::vector<double>& one,
                                    std::vector<double>* common);

/// A series of one run.
SeriesFold FoldOfRun(std::vector<double> t,
                     std::map<std::string, std::vector<double>>&& series);

/// Of both sets of runs, by the pairwise formula of Chan, Golub and LeVeque
/// (1979): with d = mean_b - mean_a and n = n_a + n_b
///   mean = mean_a + d n_b / n     squares = s_a + s_b + d^2 n_a n_b / n
SeriesFold Combine(const SeriesFold& a, const SeriesFold& b);

/// Folds of a study's cells, by table and labels.
using CellFolds =
    std::map<std::pair<std::size_t, std::vector<std::string>>, SeriesFold>;

/// Folds runs by a tree that depends on their numbers alone: two neighbours
/// that begin at an even number become one of the next level, so that the
/// result has the same bits in whatever order, and in however many parts, the
/// runs arrive.
class FoldTree {
 public:
  /// Runs index 2^level to (index + 1) 2^level - 1.
  struct Node {
    int level = 0;
    std::int64_t index = 0;
    CellFolds cells;
    std::int64_t begin() const { return index << level; }
    std::int64_t end() const { return (index + 1) << level; }
  };

  /// Runs that are not in it yet. Throws std::invalid_argument if they are.
  void Add(Node node);

  /// Of the runs 0 to runs - 1, all of which are in it and may not be in one
  /// node with others.
  CellFolds First(std::int64_t runs) const;

  /// What there is, by its first run; no two of it can be combined.
  const std::map<std::int64_t, Node>& nodes() const { return nodes_; }

 private:
  std::map<std::int64_t, Node> nodes_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_SERIES_FOLD_H_
