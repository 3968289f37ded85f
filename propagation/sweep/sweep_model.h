#pragma once
#include <glm/glm.hpp>

namespace volgi {

/// What a pipelined sweep (sweep_pipeline.h) of one order is taken to consist of.
struct SweepModel {
  glm::ivec2 along_yz{1};  // ranks
  int chunks = 1;          // along x
  double task_s = 0.0;     // a rank's sweep of one chunk for one octant
  double y_bytes = 0.0;    // that it hands on, across y and across z
  double z_bytes = 0.0;
  double latency_s = 0.0;     // of a message
  double bytes_per_s = 1e10;  // of one; sender and receiver are busy with it
  int octants_at_once = 8;    // that a rank has room for (SweepPipeline)
};

struct SweepPrediction {
  double sweep_s = 0.0;
  double efficiency = 0.0;  // what ranks do of what they could, 8 chunks task_s / sweep_s
  int least_stages = 0;     // of tasks one after another, if messages took no time (Adams et al. 2013)
};

/// Goes through the sweep task by task, as the pipeline does, with times of the model: a rank begins octants in the
/// same order, has room for so many, and sends no more chunks ahead than the next one has planes for. Cost: some 10^7
/// tasks in ten seconds.
SweepPrediction predict(const SweepModel& model);

/// The least number of stages of all eight octants: 8 chunks, and along each axis with P ranks P - 2 while the middle
/// ranks wait for light from both ends, one more where P is odd (Adams et al. 2013, equation 12, of whole columns).
int least_stages(glm::ivec2 along_yz, int chunks);

}  // namespace volgi
