#include "evaluation/combined_constants.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/chi_square.h"
#include "base/error.h"
#include "evaluation/observability.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// What the data of one recording say, in units of the first a priori sigmas:
/// along each eigenvector v of its information, v' x = value +- 1/sqrt(weight).
struct DataInformation {
  Eigen::MatrixXd I;
  Eigen::VectorXd eta;
};

/// One recording, its constants in the order of all.
struct Member {
  const RecordedConstants* recorded = nullptr;
  std::vector<int> index;  ///< of each of its constants, into all
  DataInformation data;    ///< over all constants
};

class Combiner {
 public:
  explicit Combiner(std::span<const RecordedConstants> all) {
    for (const RecordedConstants& one : all) {
      recorded_.push_back(recorded_.empty() ? one
                                            : AboutNominal(nominal_, one));
      for (const auto& nominal : recorded_.back().q_sb_nominal) {
        nominal_.insert(nominal);
      }
    }
    for (const RecordedConstants& one : recorded_) List(one);
    for (const RecordedConstants& one : recorded_) {
      members_.push_back(MemberOf(one));
    }
  }

  CombinedConstants Combine() {
    for (int i = 0; i < n(); ++i) AddAgreement(i);
    RequireShared();
    Eigen::VectorXd T = Eigen::VectorXd::Zero(n());
    for (int i = 0; i < n(); ++i) {
      const double tau = out_.agreement[At(i)].varies_by / scale_[At(i)];
      T(i) = tau * tau;
    }
    Solve(T);
    TestTogether(T);
    Finish(T);
    return std::move(out_);
  }

 private:
  static std::size_t At(int i) { return static_cast<std::size_t>(i); }
  int n() const { return static_cast<int>(names_.size()); }

  /// Adds the constants that none before has.
  void List(const RecordedConstants& one) {
    if (!one.from.empty()) {
      throw InputError(one.source + ": its constants started from " + one.from +
                       ", which would count again; expected results of runs "
                       "without `constants`");
    }
    for (std::size_t i = 0; i < one.names.size(); ++i) {
      const auto at = std::find(names_.begin(), names_.end(), one.names[i]);
      const auto k = static_cast<Eigen::Index>(i);
      if (at == names_.end()) {
        names_.push_back(one.names[i]);
        units_.push_back(one.units[i]);
        start_.push_back(one.prior_value(k));
        scale_.push_back(one.prior_sigma(k));
      } else if (units_[static_cast<std::size_t>(at - names_.begin())] !=
                 one.units[i]) {
        throw InputError(one.source + ": " + one.names[i] + " is in " +
                         one.units[i] + "; expected " +
                         units_[static_cast<std::size_t>(at - names_.begin())] +
                         ", as in " + recorded_.front().source);
      }
    }
  }

  Member MemberOf(const RecordedConstants& one) const {
    Member member;
    member.recorded = &one;
    const auto count = static_cast<Eigen::Index>(one.names.size());
    Eigen::VectorXd own(count);
    Eigen::VectorXd x(count);
    Eigen::VectorXd x0(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto at = std::find(names_.begin(), names_.end(),
                                one.names[static_cast<std::size_t>(k)]);
      const auto i = static_cast<std::size_t>(at - names_.begin());
      member.index.push_back(static_cast<int>(i));
      own(k) = scale_[i];
      x(k) = (one.value(k) - start_[i]) / scale_[i];
      x0(k) = (one.prior_value(k) - start_[i]) / scale_[i];
    }
    const Eigen::MatrixXd P = own.cwiseInverse().asDiagonal() * one.P *
                              own.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd W = P.inverse();
    const Eigen::VectorXd w0 = own.cwiseQuotient(one.prior_sigma).cwiseAbs2();
    Eigen::MatrixXd I = W;
    I.diagonal() -= w0;
    const Eigen::VectorXd eta = W * x - w0.cwiseProduct(x0);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        0.5 * (I + I.transpose()));
    const Eigen::MatrixXd& V = eigen.eigenvectors();
    const Eigen::VectorXd told =
        (eigen.eigenvalues().array() > kTold).cast<double>();
    const Eigen::MatrixXd kept =
        V * eigen.eigenvalues().cwiseProduct(told).asDiagonal() * V.transpose();
    const Eigen::VectorXd eta_kept =
        V * told.asDiagonal() * (V.transpose() * eta);
    member.data.I = Eigen::MatrixXd::Zero(n(), n());
    member.data.eta = Eigen::VectorXd::Zero(n());
    member.data.I(member.index, member.index) = kept;
    member.data.eta(member.index) = eta_kept;
    return member;
  }

  /// Information, in that of the a priori sigma, below which data say nothing.
  static constexpr double kTold = 1e-6;

  /// Of every recording that observes the constant.
  std::vector<std::optional<ConstantFigure>> FiguresOf(int i) const {
    std::vector<std::optional<ConstantFigure>> figures;
    for (const Member& member : members_) {
      const auto at = std::find(member.index.begin(), member.index.end(), i);
      std::optional<ConstantFigure>& figure = figures.emplace_back();
      if (at == member.index.end()) continue;
      const auto k = static_cast<Eigen::Index>(at - member.index.begin());
      const RecordedConstants& one = *member.recorded;
      if (VerdictOfSigma(std::sqrt(one.P(k, k)), one.prior_sigma(k)) !=
          ConstantEstimate::Verdict::kObserved) {
        continue;
      }
      figure = {one.value(k), one.P(k, k)};
    }
    return figures;
  }

  void AddAgreement(int i) {
    const double by_chance = kDisagreementByChance / n();
    ConstantAgreement a =
        AgreementOf(names_[At(i)], units_[At(i)], FiguresOf(i), by_chance);
    if (a.varies_by > 0.0) {
      out_.evidence.push_back(VariationEvidence(a, by_chance));
    }
    out_.agreement.push_back(std::move(a));
  }

  void RequireShared() const {
    for (const ConstantAgreement& a : out_.agreement) {
      std::size_t have = 0;
      for (const RecordedConstants& one : recorded_) {
        have += static_cast<std::size_t>(
            std::count(one.names.begin(), one.names.end(), a.name));
      }
      if (have > 1) return;
    }
    throw InputError(
        "no constant is in two of the results; expected results "
        "of the same sensors, by their names");
  }

  /// In scaled units: x_ and P_.
  void Solve(const Eigen::VectorXd& T) {
    Eigen::MatrixXd W = Eigen::MatrixXd::Identity(n(), n());
    Eigen::VectorXd eta = Eigen::VectorXd::Zero(n());
    for (const Member& member : members_) {
      const Eigen::MatrixXd A =
          Eigen::MatrixXd::Identity(n(), n()) + member.data.I * T.asDiagonal();
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(A);
      W += lu.solve(member.data.I);
      eta += lu.solve(member.data.eta);
    }
    W = (0.5 * (W + W.transpose())).eval();
    P_ = W.inverse();
    x_ = P_ * eta;
  }

  /// chi^2 of the whitened data of all recordings about the mean. What one
  /// recording alone tells has no distance.
  void TestTogether(const Eigen::VectorXd& T) {
    double chi_square = x_.squaredNorm();
    double dof = 0.0;
    for (const Member& member : members_) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(member.data.I);
      for (Eigen::Index k = 0; k < n(); ++k) {
        const double weight = eigen.eigenvalues()(k);
        if (weight <= kTold) continue;
        const Eigen::VectorXd v = eigen.eigenvectors().col(k);
        const double d = v.dot(member.data.eta) / weight - v.dot(x_);
        const double variance = 1.0 / weight + v.dot(T.cwiseProduct(v));
        chi_square += d * d / variance;
        dof += 1.0;
      }
    }
    out_.chi_square = chi_square;
    out_.dof = dof;
    if (dof < 1.0) return;
    out_.probability = 1.0 - ChiSquareCdf(chi_square, dof);
    if (out_.probability >= kDisagreementByChance) return;
    P_ *= chi_square / dof;
    Evidence e{
        .rule = "constants_differ",
        .grade = Grade::kDoubtful,
        .what =
            "the constants of the recordings together differ by more "
            "than their sigmas and correlations say; sigmas are "
            "widened",
        .value = chi_square / dof,
        .limit = ChiSquareQuantile(1.0 - kDisagreementByChance, dof) / dof,
        .unit = "chi-square a degree of freedom"};
    e.causes = {
        "sigmas that are too small: noise that is larger than stated, "
        "or lasts"};
    out_.evidence.push_back(std::move(e));
  }

  void Finish(const Eigen::VectorXd& T) {
    const Eigen::Map<const Eigen::VectorXd> scale(scale_.data(), n());
    Eigen::MatrixXd P = P_;
    P.diagonal() += T;
    out_.P = scale.asDiagonal() * P * scale.asDiagonal();
    for (int i = 0; i < n(); ++i) {
      ConstantEstimate c;
      c.name = names_[At(i)];
      c.unit = units_[At(i)];
      c.value = start_[At(i)] + scale_[At(i)] * x_(i);
      c.sigma = std::sqrt(out_.P(i, i));
      c.prior_value = start_[At(i)];
      c.prior_sigma = scale_[At(i)];
      c.verdict = VerdictOfSigma(c.sigma, c.prior_sigma);
      out_.constants.push_back(std::move(c));
    }
    for (const auto& [sensor, nominal] : nominal_) {
      Eigen::Vector3d m;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string name =
            sensor + "_mounting[" + std::string(1, "xyz"[axis]) + "]";
        const auto at = std::find(names_.begin(), names_.end(), name);
        m(axis) =
            out_.constants[static_cast<std::size_t>(at - names_.begin())].value;
      }
      out_.q_sb[sensor] = Exp(m) * nominal;
    }
  }

  std::vector<RecordedConstants> recorded_;
  std::map<std::string, Eigen::Quaterniond> nominal_;
  std::vector<std::string> names_;
  std::vector<std::string> units_;
  std::vector<double> start_;  ///< a priori value of the first that has it
  std::vector<double> scale_;  ///< and its sigma
  std::vector<Member> members_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
  CombinedConstants out_;
};

}  // namespace

CombinedConstants CombineConstants(std::span<const RecordedConstants> all) {
  return Combiner(all).Combine();
}

}  // namespace hindsight
