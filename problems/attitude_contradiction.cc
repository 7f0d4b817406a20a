#include "problems/attitude_contradiction.h"

namespace hindsight {

bool AttitudesContradict(const ErrorLayout& layout,
                         const std::vector<State>& one,
                         const std::vector<State>& other,
                         const CovarianceSeries& P) {
  constexpr double kMost = 25.0;
  const Block* attitude = layout.Find(BlockKind::kAttitude);
  if (attitude == nullptr) return false;
  double sum = 0.0;
  for (std::size_t k = 0; k < other.size(); ++k) {
    const double theta = one[k].q_eb.angularDistance(other[k].q_eb);
    sum +=
        theta * theta /
        P.Get(k).diagonal().segment(attitude->offset, attitude->dim).maxCoeff();
  }
  return sum > kMost * static_cast<double>(other.size());
}

}  // namespace hindsight
