#include "evaluation/series_fold.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace hindsight {
namespace {

constexpr double kSameTime = 1e-6;  // [s]

using Moments = SeriesFold::Moments;

void Keep(const std::vector<std::size_t>& index, std::vector<double>* values) {
  if (index.size() == values->size()) return;
  std::vector<double> kept;
  kept.reserve(index.size());
  for (const std::size_t i : index) kept.push_back((*values)[i]);
  *values = std::move(kept);
}

/// The series at those of its times alone.
void Keep(const std::vector<std::size_t>& index, SeriesFold* fold) {
  for (auto& [name, moments] : fold->series) {
    Keep(index, &moments.mean);
    Keep(index, &moments.squares);
  }
}

void Combine(const Moments& b, Moments* a) {
  const auto n_a = static_cast<double>(a->runs);
  const auto n_b = static_cast<double>(b.runs);
  const double n = n_a + n_b;
  for (std::size_t k = 0; k < a->mean.size(); ++k) {
    const double d = b.mean[k] - a->mean[k];
    a->mean[k] += d * (n_b / n);
    a->squares[k] += b.squares[k] + d * d * (n_a * n_b / n);
  }
  a->runs += b.runs;
}

void Combine(CellFolds&& from, CellFolds* to) {
  for (auto& [cell, fold] : from) {
    const auto [at, is_new] = to->try_emplace(cell);
    at->second = is_new ? std::move(fold) : Combine(at->second, fold);
  }
}

}  // namespace

std::vector<double> SeriesFold::Deviation(const Moments& moments) {
  std::vector<double> deviation(moments.mean.size(), 0.0);
  if (moments.runs < 2) return deviation;
  const auto freedom = static_cast<double>(moments.runs - 1);
  for (std::size_t k = 0; k < deviation.size(); ++k) {
    deviation[k] = std::sqrt(moments.squares[k] / freedom);
  }
  return deviation;
}

std::vector<double> SeriesFold::Rms(const Moments& moments) {
  std::vector<double> rms = moments.mean;
  const auto n = static_cast<double>(moments.runs);
  for (std::size_t k = 0; k < rms.size(); ++k) {
    rms[k] = std::sqrt(rms[k] * rms[k] + moments.squares[k] / n);
  }
  return rms;
}

std::vector<std::size_t> MatchTimes(const std::vector<double>& one,
                                    std::vector<double>* common) {
  std::vector<std::size_t> index;
  std::vector<double> found;
  std::size_t i = 0;
  for (const double t : *common) {
    while (i < one.size() && one[i] < t - kSameTime) ++i;
    if (i == one.size() || one[i] > t + kSameTime) continue;
    index.push_back(i);
    found.push_back(t);
  }
  *common = std::move(found);
  return index;
}

SeriesFold FoldOfRun(std::vector<double> t,
                     std::map<std::string, std::vector<double>>&& series) {
  SeriesFold fold;
  fold.t = std::move(t);
  for (auto& [name, values] : series) {
    Moments& moments = fold.series[name];
    moments.runs = 1;
    moments.squares.assign(values.size(), 0.0);
    moments.mean = std::move(values);
  }
  return fold;
}

SeriesFold Combine(const SeriesFold& a, const SeriesFold& b) {
  SeriesFold sum = a;
  SeriesFold other = b;
  Keep(MatchTimes(b.t, &sum.t), &other);
  std::vector<double> all = sum.t;
  Keep(MatchTimes(a.t, &all), &sum);
  for (auto& [name, moments] : other.series) {
    const auto [at, is_new] = sum.series.try_emplace(name);
    if (is_new) {
      at->second = std::move(moments);
    } else {
      Combine(moments, &at->second);
    }
  }
  return sum;
}

void FoldTree::Add(Node node) {
  const auto after = nodes_.lower_bound(node.begin());
  const bool overlaps = (after != nodes_.end() && after->first < node.end()) ||
                        (after != nodes_.begin() &&
                         std::prev(after)->second.end() > node.begin());
  if (overlaps) {
    throw std::invalid_argument("run " + std::to_string(node.begin()) +
                                " is there twice");
  }
  while (true) {
    const auto sibling = nodes_.find((node.index ^ 1) << node.level);
    if (sibling == nodes_.end() || sibling->second.level != node.level) break;
    Node both = std::move(sibling->second);
    nodes_.erase(sibling);
    if (both.index > node.index) std::swap(both, node);
    Combine(std::move(node.cells), &both.cells);
    ++both.level;
    both.index /= 2;
    node = std::move(both);
  }
  const std::int64_t begin = node.begin();
  nodes_.emplace(begin, std::move(node));
}

CellFolds FoldTree::First(std::int64_t runs) const {
  CellFolds sum;
  std::int64_t at = 0;
  for (auto node = nodes_.begin(); at < runs; ++node) {
    if (node == nodes_.end() || node->first != at ||
        node->second.end() > runs) {
      throw std::invalid_argument("run " + std::to_string(at) + " is missing");
    }
    Combine(CellFolds(node->second.cells), &sum);
    at = node->second.end();
  }
  return sum;
}

}  // namespace hindsight
