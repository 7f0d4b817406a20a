#include "app/interrupt.h"

#include <csignal>

namespace hindsight {

void CatchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { RequestStop(); };
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace hindsight
