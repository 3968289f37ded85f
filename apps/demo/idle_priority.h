#pragma once

namespace volgi::demo {

/// Lets the calling thread run only where no other wants to: SCHED_IDLE, or nice 19 where the system refuses that, or
/// as it is where it refuses both. For good: an ordinary user cannot take it back.
void take_idle_priority();

}  // namespace volgi::demo
