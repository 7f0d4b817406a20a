#include "base/processor_time.h"

#include <ctime>

namespace hindsight {
namespace {

thread_local double seconds_of_others = 0.0;

}  // namespace

double ProcessorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec) + seconds_of_others;
}

void AddProcessorSeconds(double seconds) { seconds_of_others += seconds; }

}  // namespace hindsight
