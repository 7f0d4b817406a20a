#include "filters/history_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace hindsight {
namespace {

/// Histories less likely than the best by this are given up [ln].
constexpr double kLeastLog = 30.0;
/// Squared distance of means, in sigmas, below which two of a mode are one.
constexpr double kNear = 0.05;

struct Hypothesis {
  Gaussian x;
  ErrorMode mode = ErrorMode::kGood;
  double log_weight = 0.0;
  int record = -1;
};

/// A step of a history and the record before it.
struct Record {
  int before = -1;
  ErrorStep step;
};

struct Candidate {
  std::size_t parent = 0;
  ErrorStep step;
  double log_weight = 0.0;
  bool outlier = false;
};

double LogSum(double a, double b) {
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

class Search {
 public:
  Search(const LinearTape& tape, int receiver,
         const ErrorParameters& parameters, std::size_t width)
      : chain_(tape, receiver, parameters),
        navigation_dim_(tape.dim()),
        width_(width) {}

  std::vector<ScoredHistory> Run() {
    Hypothesis& first = hypotheses_.emplace_back();
    first.x = chain_.Begin();
    for (std::size_t k = 0; k < chain_.size(); ++k) {
      chain_.MoveTo(k);
      for (Hypothesis& h : hypotheses_) h.x = chain_.PredictNavigation(h.x);
      if (chain_.has_fix()) {
        Branch();
        Merge();
      } else {
        GoOn();
      }
    }
    return Histories();
  }

 private:
  void GoOn() {
    for (Hypothesis& h : hypotheses_) {
      chain_.PredictError({h.mode}, &h.x);
      h.log_weight += chain_.UpdateAll(false, &h.x);
    }
  }

  void Branch() {
    std::vector<Hypothesis> next;
    for (const Candidate& c : Best(AllCandidates())) {
      Hypothesis& h = next.emplace_back();
      h.x = hypotheses_[c.parent].x;
      h.mode = c.step.mode;
      h.record = static_cast<int>(records_.size());
      records_.push_back({hypotheses_[c.parent].record, c.step});
      chain_.PredictError(c.step, &h.x);
      h.log_weight = c.log_weight + chain_.UpdateAll(c.outlier, &h.x);
    }
    hypotheses_ = std::move(next);
  }

  std::vector<Candidate> AllCandidates() const {
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
      const Hypothesis& h = hypotheses_[i];
      for (const ErrorStep step : StepsAfter(h.mode)) {
        const auto likelihood = chain_.LikelihoodAfter(step, h.x);
        all.push_back({i, step,
                       h.log_weight + likelihood.log +
                           LogTransition(h.mode, step, chain_.fix_count()),
                       likelihood.outlier});
      }
    }
    return all;
  }

  std::vector<Candidate> Best(std::vector<Candidate> all) const {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return a.log_weight > b.log_weight;
    });
    std::array<std::size_t, 3> kept = {};
    std::vector<Candidate> best;
    for (const Candidate& c : all) {
      if (c.log_weight < all.front().log_weight - kLeastLog) break;
      if (++kept[static_cast<std::size_t>(c.step.mode)] > 2 * width_) {
        continue;
      }
      best.push_back(c);
    }
    return best;
  }

  /// Lets the likelier of two near hypotheses of a mode stand for both.
  void Merge() {
    std::sort(hypotheses_.begin(), hypotheses_.end(),
              [](const auto& a, const auto& b) {
                return a.log_weight > b.log_weight;
              });
    std::vector<Hypothesis> merged;
    std::array<std::size_t, 3> kept = {};
    std::vector<Eigen::LLT<ErrorMatrix>> factors;
    for (Hypothesis& h : hypotheses_) {
      bool is_new = true;
      for (std::size_t i = 0; i < merged.size() && is_new; ++i) {
        if (merged[i].mode != h.mode) continue;
        const ErrorVector d =
            (h.x.mean - merged[i].x.mean).head(navigation_dim_);
        if (factors[i].matrixL().solve(d).squaredNorm() > kNear) continue;
        merged[i].log_weight = LogSum(merged[i].log_weight, h.log_weight);
        is_new = false;
      }
      if (!is_new) continue;
      if (++kept[static_cast<std::size_t>(h.mode)] > width_) continue;
      factors.emplace_back(
          ErrorMatrix(h.x.P.topLeftCorner(navigation_dim_, navigation_dim_)));
      merged.push_back(std::move(h));
    }
    hypotheses_ = std::move(merged);
  }

  std::vector<ScoredHistory> Histories() const {
    std::vector<ScoredHistory> out;
    for (const Hypothesis& h : hypotheses_) {
      ScoredHistory& one = out.emplace_back();
      one.log_posterior = h.log_weight;
      for (int i = h.record; i >= 0;
           i = records_[static_cast<std::size_t>(i)].before) {
        one.history.push_back(records_[static_cast<std::size_t>(i)].step);
      }
      std::reverse(one.history.begin(), one.history.end());
    }
    return out;
  }

  ErrorChain chain_;
  int navigation_dim_;
  std::size_t width_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<Record> records_;
};

}  // namespace

std::vector<ScoredHistory> SearchHistories(const LinearTape& tape, int receiver,
                                           const ErrorParameters& parameters,
                                           std::size_t width) {
  return Search(tape, receiver, parameters, width).Run();
}

}  // namespace hindsight
