#ifndef HINDSIGHT_ATTITUDE_ACCELEROMETER_RULE_H_
#define HINDSIGHT_ATTITUDE_ACCELEROMETER_RULE_H_

#include <string>
#include <variant>
#include <vector>

namespace hindsight {

/// How far an accelerometer is trusted as tilt sensor. Every rule is asked once
/// a sample, in order, with s = | |f_b| - g | [m/s^2] (Kim and Leeghim 2016,
/// eq. 27) and answers the variance of a component of f_b [m^2/s^4]; infinity
/// passes the sample over. `sigma` is R0's standard deviation [m/s^2] (eq. 26
/// prints it where its square is meant).

/// R = sigma^2.
struct FixedRule {
  double sigma = 0.3;
  double Variance(double s);
};

/// R = sigma^2 while s <= limit, else the sample is passed over.
struct GateRule {
  double sigma = 0.3;
  double limit = 0.88;  ///< [m/s^2]
  double Variance(double s);
};

/// As GateRule, closed for `hold` further samples after each s > limit.
struct HeldGateRule {
  double sigma = 0.3;
  double limit = 0.88;  ///< [m/s^2]
  int hold = 4;         ///< [samples]
  int closed_for = 0;   ///< state: samples still to be passed over
  double Variance(double s);
};

/// R = sigma^2 + lambda s^2, the current sample alone.
struct AdaptiveRule {
  double sigma = 0.3;
  double lambda = 0.25;
  double Variance(double s);
};

/// Sequential measurement noise covariance, eq. (28):
///   R = sigma^2 + lambda sum_{j=0..N} beta_j s_{k-j}^2
/// (printed with s_{N-j}). N = 0 is AdaptiveRule; compare rules at equal
/// lambda (N + 1).
class SmncRule {
 public:
  /// `beta` holds N + 1 weights in [0, 1]. Throws std::invalid_argument if it
  /// is empty.
  SmncRule(double sigma, double lambda, std::vector<double> beta);
  /// Equal weights of one.
  SmncRule(double sigma, double lambda, int N);
  double Variance(double s);

 private:
  double sigma2_;
  double lambda_;
  std::vector<double> beta_;
  bool equal_;
  std::vector<double> s2_;  ///< ring of the last N + 1
  std::size_t next_ = 0;
  double sum_ = 0.0;  ///< of s2_, for equal weights
};

using AccelerometerRule =
    std::variant<FixedRule, GateRule, HeldGateRule, AdaptiveRule, SmncRule>;

/// Samples that a span of time holds, N of a rule given in seconds.
int SamplesIn(double seconds, double sample_interval);

struct AccelerometerRuleOptions {
  /// "fixed", "gate", "held_gate", "adaptive", "smnc".
  std::string name = "fixed";
  double sigma = 0.3;    ///< [m/s^2]
  double limit = 0.88;   ///< of the gates [m/s^2]
  double lambda = 0.05;  ///< of smnc; adaptive takes lambda (N + 1)
  int N = 4;             ///< [samples], of smnc and held_gate
};

/// Throws InputError for a name that is none, listing those that are.
AccelerometerRule MakeAccelerometerRule(
    const AccelerometerRuleOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ACCELEROMETER_RULE_H_
