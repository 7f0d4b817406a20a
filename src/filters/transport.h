#ifndef HINDSIGHT_FILTERS_TRANSPORT_H_
#define HINDSIGHT_FILTERS_TRANSPORT_H_

#include "state/error_layout.h"

namespace hindsight {

/// P <- T P T' of a transport T between tangents, symmetric to the last bit. T
/// turns the first components, those of the navigation state, and leaves the
/// rest as they are: only the rows and columns that it changes are computed.
void MoveCovariance(const ErrorMatrix& T, ErrorMatrix* P);

/// The way back over a transport T.
class WayBack {
 public:
  explicit WayBack(const ErrorMatrix& T);

  /// d <- T^-1 d and P <- T^-1 P T^-T.
  void Move(ErrorVector* d, ErrorMatrix* P) const;

 private:
  ErrorMatrix inverse_;  ///< of the part that T changes
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_TRANSPORT_H_
