#include "apps/demo/idle_priority.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace volgi::demo {

void take_idle_priority() {
#ifdef SCHED_IDLE
  const sched_param none{};
  if (pthread_setschedparam(pthread_self(), SCHED_IDLE, &none) == 0) return;
#endif
#ifdef __linux__
  constexpr int lowest = 19;
  // On Linux a thread has a nice value of its own.
  if (setpriority(PRIO_PROCESS, id_t(gettid()), lowest) == 0) return;
#endif
}

}  // namespace volgi::demo
