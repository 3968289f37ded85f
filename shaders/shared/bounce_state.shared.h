// What the solver of all bounces keeps on the GPU beside the powers of sides (propagation/bounces_gl.cpp).
#ifndef VOLGI_BOUNCE_STATE_SHARED_H
#define VOLGI_BOUNCE_STATE_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// std430, 128 bytes; rgb each.
struct BounceState {
  vec4 source_power;  // sum of what sides send before bounces [W], now and in the run before
  vec4 last_source_power;
  vec4 share;       // of the last answer that is the start
  vec4 product;     // <q,q>
  vec4 step_size;   // alpha
  vec4 turn;        // beta
  vec4 next_sent;   // what one more bounce changes of what sides send, summed up without signs [W]
  vec4 total_sent;  // what they send in all [W]
};
#ifdef __cplusplus
static_assert(sizeof(BounceState) == 128 && offsetof(BounceState, next_sent) == 96);
#endif

// What the 64 partial sums are for (solver_scalars).
#define BOUNCE_SUMS_SOURCE 0     // source power
#define BOUNCE_SUMS_RESIDUAL 1   // <q,q>, next, total
#define BOUNCE_SUMS_CURVATURE 2  // <d,(I-fK)d>, <d,d>
#define BOUNCE_SUMS_CHANGE 3     // -, next, total

#define BOUNCE_PARTIALS 64
// No bounce is taken to lose less: a closed white room has no answer (BounceRules::kMinLoss).
#define BOUNCE_MIN_LOSS 1e-4f

SHARED_END
#endif
