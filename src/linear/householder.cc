#include "linear/householder.h"

#include <cmath>
#include <limits>

namespace hindsight {

double ColumnNorm(const double* top, const RowRange& below, Eigen::Index c) {
  double sum = top[c] * top[c];
  for (Eigen::Index i = 0; i < below.count; ++i) {
    sum += below.row(i)[c] * below.row(i)[c];
  }
  return std::sqrt(sum);
}

// A fixed number of columns, whose sums the compiler keeps in registers.
template <int Columns>
void Householder::ReflectColumns(double* top, double tau, Eigen::Index first) {
  using Strip = Eigen::Array<double, Columns, 1>;
  using Map = Eigen::Map<Strip>;
  Strip w = Map(top + first);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    w += v_[i] * Map(rows_[i] + first);
  }
  w *= tau;
  Map(top + first) -= w;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Map(rows_[i] + first) -= v_[i] * w;
  }
}

void Householder::Reflect(double* top, const RowRange& below, Eigen::Index c,
                          Eigen::Index end, double norm) {
  rows_.clear();
  v_.clear();
  for (Eigen::Index i = 0; i < below.count; ++i) {
    if (below.row(i)[c] == 0.0) continue;
    rows_.push_back(below.row(i));
    v_.push_back(below.row(i)[c]);
  }
  if (rows_.empty()) return;
  double square = 0.0;
  for (const double v : v_) square += v * v;
  if (square <= std::numeric_limits<double>::min()) {
    for (double* row : rows_) row[c] = 0.0;
    return;
  }
  const double beta = top[c] < 0.0 ? norm : -norm;
  const double scale = 1.0 / (top[c] - beta);
  const double tau = (beta - top[c]) / beta;
  for (double& v : v_) v *= scale;
  for (double* row : rows_) row[c] = 0.0;
  top[c] = beta;
  Eigen::Index first = c + 1;
  for (; end - first >= 8; first += 8) ReflectColumns<8>(top, tau, first);
  if (end - first >= 4) {
    ReflectColumns<4>(top, tau, first);
    first += 4;
  }
  for (; first < end; ++first) ReflectColumns<1>(top, tau, first);
}

}  // namespace hindsight
