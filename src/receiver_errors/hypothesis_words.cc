#include "receiver_errors/hypothesis_words.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace hindsight {
namespace {

std::string SecondsText(double t) {
  return fmt::format("{:.10g}", std::round(10.0 * t) / 10.0);
}

const char* AdjectiveOf(ErrorMode mode) {
  switch (mode) {
    case ErrorMode::kGood:
      break;
    case ErrorMode::kBiased:
      return "biased";
    case ErrorMode::kDrifting:
      return "drifting";
    case ErrorMode::kSlight:
      return "slightly biased";
  }
  return "good";
}

void AddPart(const std::string& part, std::string* all) {
  if (!all->empty()) *all += ", ";
  *all += part;
}

/// The likeliest of the hypotheses whose separation is as wanted.
template <typename Wanted>
RivalHypothesis LikeliestOf(const std::vector<WeighedHypothesis>& all,
                            const WeighedHypothesis& chosen,
                            const CovarianceSeries& P, const Wanted& wanted) {
  RivalHypothesis rival;
  for (const WeighedHypothesis& one : all) {
    const Separation separation = Separate(one, chosen, P);
    if (!wanted(separation)) continue;
    rival.probability += one.weight;
    if (rival.hypothesis != nullptr && one.weight <= rival.hypothesis->weight) {
      continue;
    }
    rival.hypothesis = &one;
    rival.distance = separation.distance;
  }
  return rival;
}

}  // namespace

Separation Separate(const WeighedHypothesis& one,
                    const WeighedHypothesis& chosen,
                    const CovarianceSeries& P) {
  constexpr double kSigmas = 3.0;
  Separation out;
  for (std::size_t k = 0; k < chosen.smoothed.size(); ++k) {
    const Eigen::Vector2d d =
        (one.smoothed[k] - chosen.smoothed[k]).template head<2>();
    out.distance = std::max(out.distance, d.norm());
    const Eigen::Matrix2d P_h = P.Get(k).topLeftCorner<2, 2>();
    const double nees = d.dot(P_h.llt().solve(d));
    out.significant |= nees > kSigmas * kSigmas;
    out.nees += nees / static_cast<double>(chosen.smoothed.size());
  }
  return out;
}

std::string ErrorSizes::Over(std::size_t first, std::size_t past) const {
  double squares = 0.0;
  for (std::size_t k = first; k < past; ++k) {
    squares += by_node[k] * by_node[k];
  }
  return fmt::format("{:.2g} {}",
                     std::sqrt(squares / static_cast<double>(past - first)),
                     unit);
}

std::string ErrorSizes::Most(std::size_t first, std::size_t past) const {
  const auto begin = by_node.begin();
  return fmt::format("{:.2g} {}",
                     *std::max_element(begin + static_cast<int>(first),
                                       begin + static_cast<int>(past)),
                     unit);
}

ErrorSizes SizesOf(const WeighedHypothesis& one, int dim,
                   const std::string& unit) {
  ErrorSizes sizes;
  sizes.unit = unit;
  for (std::size_t k = 0; k < one.steps.size(); ++k) {
    sizes.by_node.push_back(one.smoothed[k].segment<3>(dim).norm());
  }
  return sizes;
}

std::string DescribeSequence(const std::vector<ErrorStep>& steps,
                             const std::vector<double>& times,
                             const ErrorSizes& sizes) {
  std::string all;
  ErrorMode before = ErrorMode::kGood;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const ErrorStep& step = steps[k];
    if (step.velocity_step) {
      AddPart("the IMU's velocity steps at " + SecondsText(times[k]) + " s",
              &all);
    }
    const bool begins = step.anew || step.mode != before;
    before = step.mode;
    if (!begins || step.mode == ErrorMode::kGood) continue;
    std::size_t end = k + 1;
    while (end < steps.size() && steps[end].mode == step.mode &&
           !steps[end].anew) {
      ++end;
    }
    AddPart(
        std::string(AdjectiveOf(step.mode)) + " from " + SecondsText(times[k]) +
            (end == steps.size() ? " s to the end"
                                 : " to " + SecondsText(times[end]) + " s") +
            (step.mode == ErrorMode::kDrifting
                 ? " by up to " + sizes.Most(k, end)
                 : " by " + sizes.Over(k, end)),
        &all);
  }
  return all.empty() ? "good throughout" : all;
}

RivalHypothesis FindRival(const std::vector<WeighedHypothesis>& all,
                          const WeighedHypothesis& chosen,
                          const CovarianceSeries& P) {
  return LikeliestOf(all, chosen, P,
                     [](const Separation& s) { return s.significant; });
}

RivalHypothesis FindRivalBeyond(const std::vector<WeighedHypothesis>& all,
                                const WeighedHypothesis& chosen,
                                const CovarianceSeries& P) {
  constexpr double kWrong = 25.0;
  return LikeliestOf(all, chosen, P,
                     [](const Separation& s) { return s.nees > kWrong; });
}

std::string DescribeNoise(ErrorRegimes::Kind kind, const ErrorParameters& p) {
  constexpr double kWorse = 1.05;
  constexpr double kBetter = 0.5;  // 1.3 may be chance: it is found to that
  std::string all = fmt::format(
      "{} errors, sigma {:.3g} times as stated, outliers {:.3g} % of {:.3g} "
      "times that",
      RegimeName(kind), p.scale, 100.0 * p.outlier_share, p.outlier_ratio);
  if (p.imu_scale > kWorse || p.imu_scale < kBetter) {
    all += fmt::format(", beside noise of the IMU {:.3g} times as stated",
                       p.imu_scale);
  }
  return all;
}

std::string DescribeSigma(const ErrorParameters& p, const std::string& unit) {
  constexpr double kAlike = 1.5;
  const bool alike = p.down < kAlike && p.down > 1.0 / kAlike;
  return fmt::format("sigma {:.3g} {}", p.sigma, unit) +
         (alike ? "" : fmt::format(" ({:.2g} down)", p.down * p.sigma));
}

std::vector<std::string> DescribeErrors(const ModeSequence& steps,
                                        const ErrorParameters& p,
                                        const std::string& unit,
                                        double duration) {
  const auto has = [&steps](ErrorMode mode) {
    return std::ranges::count(steps, mode, &ErrorStep::mode) > 0;
  };
  std::vector<std::string> all;
  if (has(ErrorMode::kBiased)) {
    const std::string sigma = DescribeSigma(p, unit);
    all.push_back(
        p.tau <= duration
            ? fmt::format("Gauss-Markov errors, {}, correlation time {:.3g} s",
                          sigma, p.tau)
            : fmt::format("biases, {}, that walk by {:.3g} {}/sqrt(s)", sigma,
                          p.sigma * std::sqrt(2.0 / p.tau), unit));
  }
  if (has(ErrorMode::kSlight)) {
    all.push_back(
        fmt::format("slight biases, sigma {:.3g} {}", p.slight_sigma, unit));
  }
  if (has(ErrorMode::kDrifting)) {
    all.push_back(fmt::format("drifts, sigma {:.3g} {}/s", p.rate_sigma, unit));
  }
  return all;
}

std::string DescribeRival(const RivalHypothesis& rival,
                          const std::vector<double>& times, int dim,
                          const std::string& unit) {
  constexpr double kWorthTelling = 1e-3;
  if (rival.probability < kWorthTelling) return "";
  const WeighedHypothesis& one = *rival.hypothesis;
  return fmt::format(
      "{}, with a probability of {}, up to {:.3g} m away: {}",
      rival.IsLikelier() ? "likelier than that" : "or",
      FormatProbability(rival.probability), rival.distance,
      DescribeSequence(one.steps, times, SizesOf(one, dim, unit)));
}

}  // namespace hindsight
