#include "receiver_errors/hypothesis_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "receiver_errors/error_chain.h"

namespace hindsight {
namespace {

/// Hypotheses less likely than the best by this are given up [ln].
constexpr double kLeastLog = 30.0;
/// Squared distance of means, in sigmas, below which two of a mode are one.
constexpr double kNear = 0.05;

struct Track {
  Gaussian x;
  ErrorMode mode = ErrorMode::kGood;
  double log_weight = 0.0;
  int record = -1;
  int began = 0;  ///< fix at which what goes on began
  int velocity_steps = 0;
};

/// A step of a sequence and the record before it.
struct Record {
  int before = -1;
  ErrorStep step;
};

struct Candidate {
  std::size_t parent = 0;
  ErrorStep step;
  double log_weight = 0.0;
  bool outlier = false;
  int began = 0;
};

/// Counts hypotheses by mode and by how long ago what goes on began, in powers
/// of two of fixes. Every fix gives birth to hypotheses of an error that has
/// just begun; were they counted with the older ones, they would in time drive
/// out the one that is right, as nothing tells it yet from one that is not.
class Quota {
 public:
  explicit Quota(std::size_t most) : most_(most) {}

  bool Take(ErrorMode mode, int age) {
    const int width =
        static_cast<int>(std::bit_width(static_cast<unsigned>(age)));
    std::size_t& count =
        kept_[static_cast<std::size_t>(mode)][static_cast<std::size_t>(width)];
    if (count == most_) return false;
    ++count;
    return true;
  }

 private:
  std::size_t most_;
  std::array<std::array<std::size_t, 33>, 4> kept_ = {};
};

double LogSum(double a, double b) {
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

/// What a step costs beyond its transition, after so many velocity steps.
double PriceOf(ErrorStep step, int before) {
  if (!step.velocity_step) return 0.0;
  return LogOfVelocitySteps(before + 1) - LogOfVelocitySteps(before);
}

class Search {
 public:
  Search(const SensorTape& tape, const ErrorParameters& parameters,
         std::size_t width, SearchEffort* effort)
      : chain_(tape, parameters),
        navigation_dim_(tape.dim()),
        parameters_(parameters),
        width_(width),
        effort_(effort) {}

  std::vector<Hypothesis> Run() {
    Track& first = tracks_.emplace_back();
    first.x = chain_.Begin();
    for (std::size_t k = 0; k < chain_.size(); ++k) {
      chain_.MoveTo(k);
      for (Track& h : tracks_) chain_.PredictNavigation(&h.x);
      if (chain_.has_fix()) {
        Branch();
        Merge();
        ++fix_;
      } else {
        GoOn();
      }
      if (effort_ != nullptr) effort_->Spend(tracks_.size());
    }
    return Hypotheses();
  }

 private:
  void GoOn() {
    for (Track& h : tracks_) {
      chain_.PredictError({h.mode}, &h.x);
      h.log_weight += chain_.UpdateAll(false, &h.x);
    }
  }

  void Branch() {
    const std::vector<Candidate> best = Best(AllCandidates());
    std::vector<Track> next;
    next.reserve(best.size());
    for (const Candidate& c : best) {
      Track& h = next.emplace_back();
      h.x = tracks_[c.parent].x;
      h.mode = c.step.mode;
      h.began = c.began;
      h.velocity_steps =
          tracks_[c.parent].velocity_steps + c.step.velocity_step;
      h.record = static_cast<int>(records_.size());
      records_.push_back({tracks_[c.parent].record, c.step});
      chain_.PredictError(c.step, &h.x);
      h.log_weight = c.log_weight + chain_.UpdateAll(c.outlier, &h.x);
    }
    tracks_ = std::move(next);
  }

  double LogPriorOf(ErrorStep step, ErrorMode before) const {
    const double share = chain_.share();
    return fix_ == 0 ? LogFirst(step, share)
                     : LogTransition(before, step, share);
  }

  std::vector<Candidate> AllCandidates() const {
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      const Track& h = tracks_[i];
      const ErrorChain::FixView view = chain_.ViewOf(h.x);
      const auto add = [&](ErrorStep step, bool goes_on) {
        const auto likelihood = chain_.LikelihoodAfter(step, view);
        all.push_back({i, step,
                       h.log_weight + likelihood.log +
                           LogPriorOf(step, h.mode) +
                           PriceOf(step, h.velocity_steps),
                       likelihood.outlier, goes_on ? h.began : fix_});
        return !likelihood.outlier &&
               likelihood.log_odds < ErrorChain::kSureLogOdds;
      };
      for (ErrorStep step : StepsAfter(h.mode)) {
        const bool goes_on = step == ErrorStep{h.mode};
        const bool may_be_outlier = add(step, goes_on);
        if (!goes_on || !may_be_outlier) continue;
        step.outlier = true;
        add(step, goes_on);
      }
    }
    return all;
  }

  std::vector<Candidate> Best(std::vector<Candidate> all) const {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return a.log_weight > b.log_weight;
    });
    const bool spent = effort_ != nullptr && effort_->IsSpent();
    Quota quota(2 * width_);
    std::vector<Candidate> best;
    if (spent) return {all.front()};
    for (const Candidate& c : all) {
      if (c.log_weight < all.front().log_weight - kLeastLog) break;
      if (quota.Take(c.step.mode, fix_ - c.began)) best.push_back(c);
    }
    return best;
  }

  /// Lets the likelier of two near tracks of a mode stand for both.
  void Merge() {
    std::vector<Track*> sorted;
    for (Track& h : tracks_) sorted.push_back(&h);
    std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) {
      return a->log_weight > b->log_weight;
    });
    std::vector<Track> merged;
    merged.reserve(sorted.size());
    Quota quota(width_);
    for (Track* h : sorted) {
      const auto near =
          std::find_if(merged.begin(), merged.end(), [&](const auto& other) {
            return other.mode == h->mode && IsNear(*h, other);
          });
      if (near != merged.end()) {
        near->log_weight = LogSum(near->log_weight, h->log_weight);
      } else if (quota.Take(h->mode, fix_ - h->began)) {
        merged.push_back(std::move(*h));
      }
    }
    tracks_ = std::move(merged);
  }

  /// Whether the mean of h is within the covariance of `other`.
  bool IsNear(const Track& h, const Track& other) const {
    const ErrorVector d = (h.x.mean - other.x.mean).head(navigation_dim_);
    const auto P = other.x.P.topLeftCorner(navigation_dim_, navigation_dim_);
    // No component can be farther off than all together.
    if ((d.array().square() > kNear * P.diagonal().array()).any()) return false;
    const Eigen::LLT<ErrorMatrix> llt(ErrorMatrix{P});
    return llt.matrixL().solve(d).squaredNorm() <= kNear;
  }

  std::vector<Hypothesis> Hypotheses() const {
    std::vector<Hypothesis> out;
    for (const Track& h : tracks_) {
      Hypothesis& one = out.emplace_back();
      one.log_posterior = h.log_weight;
      one.parameters = parameters_;
      for (int i = h.record; i >= 0;
           i = records_[static_cast<std::size_t>(i)].before) {
        one.sequence.push_back(records_[static_cast<std::size_t>(i)].step);
      }
      std::reverse(one.sequence.begin(), one.sequence.end());
    }
    return out;
  }

  ErrorChain chain_;
  int navigation_dim_;
  ErrorParameters parameters_;
  std::size_t width_;
  SearchEffort* effort_;
  int fix_ = 0;
  std::vector<Track> tracks_;
  std::vector<Record> records_;
};

}  // namespace

std::vector<Hypothesis> SearchHypotheses(const SensorTape& tape,
                                         const ErrorParameters& parameters,
                                         std::size_t width,
                                         SearchEffort* effort) {
  return Search(tape, parameters, width, effort).Run();
}

}  // namespace hindsight
