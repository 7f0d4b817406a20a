#ifndef HINDSIGHT_STATE_ERROR_DEFINITION_H_
#define HINDSIGHT_STATE_ERROR_DEFINITION_H_

#include <string>

#include "state/state.h"

namespace hindsight {

/// What a forward filter calls the error of its estimate: a chart about the
/// estimate x^. To first order all are the canonical tangent of Retract(layout,
/// x, d), in other axes: eps = J d. As P, Phi, H enter a filter only as J P J',
/// J Phi J^-1 and H J^-1, the Jacobian J cancels everywhere but at a reset, and
/// a filter in any of these errors may keep canonical matrices. What remains is
/// how far a correction of finite size leads (Retract) and how the covariance
/// is carried there (Transport).
enum class ErrorDefinition {
  /// psi in NED axes, C_eb = Exp(C_en psi) C^_eb, everything else additive:
  /// the canonical tangent itself, J = I.
  kNavigation,
  /// Additive quaternion: q = q^ + dq, normalised after every update. Dimension
  /// n + 1; dq = 1/2 (0, C_en psi) q^, so that J is 1/2 [q^ x] (4 x 3). The
  /// covariance of dq goes through the Jacobian of the normalisation,
  ///   N = (I - q+ q+') / |q^ + dq|,
  /// and so keeps rank 3 in the tangent at q+.
  kQuaternion,
  /// Left-invariant error of SE_2(3), X = X^ Exp(eps), in body axes (Barrau and
  /// Bonnabel 2017): C_eb = C^_eb Exp(phi), v = v^ + C^_eb Jl(phi) nu, position
  /// as velocity, biases and parameters additive. J turns NED into body axes;
  /// at a reset the covariance of eps stays as it is.
  kLeftInvariant,
};

/// "navigation", "quaternion", "left_invariant".
const char* ErrorName(ErrorDefinition error);
/// Throws InputError for a name that is none, listing those that are.
ErrorDefinition ErrorFromName(const std::string& name);

/// The state that the error d, in canonical axes at x, leads to.
///   kQuaternion     q = normalised((1, C_en psi / 2) q^)
///   kLeftInvariant  v = v^ + C_en Jl(psi) dv, position alike
State Retract(ErrorDefinition error, const ErrorLayout& layout, const State& x,
              const ErrorVector& d);

/// The error of `reference` if x is true, in canonical axes at `reference`:
/// inverse of Retract, but for kQuaternion q - q^ in the tangent at q^, of
/// length 2 sin(angle / 2), where Retract takes 2 tan(angle / 2).
ErrorVector Local(ErrorDefinition error, const ErrorLayout& layout,
                  const State& reference, const State& x);

/// Carries an error about `from` to the one about `to` = Retract(error, layout,
/// from, d), in canonical axes at each: P_to = T P_from T'. Attitude blocks:
///   kNavigation     Jl(psi), hindsight::Transport
///   kQuaternion     (I + [psi x]/2) / (1 + |psi|^2/4), which is N above
///   kLeftInvariant  Exp(psi), of velocity and position as well
ErrorMatrix Transport(ErrorDefinition error, const ErrorLayout& layout,
                      const State& from, const ErrorVector& d, const State& to);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_ERROR_DEFINITION_H_
