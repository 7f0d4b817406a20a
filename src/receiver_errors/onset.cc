#include "receiver_errors/onset.h"

namespace hindsight {
namespace {

constexpr int kQuarters = 4;
constexpr double kLogQuarters = 1.3862943611198906;  // ln 4

}  // namespace

double LogPriorOf(Onset onset) {
  return onset == Onset::kUsual ? 0.0 : -kLogQuarters;
}

GrowthMoments UnseenTime::Grown(Onset onset) const {
  if (onset == Onset::kUsual) {
    return GrowthMoments::Between(lacks_fix ? 0.0 : length, length);
  }
  const int left = kQuarters - static_cast<int>(onset);
  return GrowthMoments::Between(left * length / kQuarters,
                                (left + 1) * length / kQuarters);
}

}  // namespace hindsight
