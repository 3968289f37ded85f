#include "propagation/sweep/sweep_model.h"

#include <algorithm>
#include <array>
#include <queue>
#include <utility>
#include <vector>

#include "propagation/sweep/sweep_order.h"

namespace volgi {

namespace {

struct Octant {
  int done = 0;                                // chunks
  std::array<std::vector<double>, 2> arrives;  // of the chunks that have been sent here, through y, through z
};
struct Rank {
  double free_s = 0.0;
  int through = 0;  // octants
  std::array<Octant, 8> octants;
};

class Simulation {
 public:
  explicit Simulation(const SweepModel& m) : m_(m), ranks_(size_t(m.along_yz.x) * size_t(m.along_yz.y)) {
    for (int rank = 0; rank < int(ranks_.size()); ++rank) events_.push({0.0, rank});
  }
  double run() {
    while (!events_.empty()) {
      const auto [now, rank] = events_.top();
      events_.pop();
      Rank& r = ranks_[size_t(rank)];
      if (r.free_s > now) continue;  // it asks again when it is done
      const int octant = best(rank, now);
      if (octant >= 0) work(rank, octant, now);
    }
    return last_;
  }

 private:
  using Event = std::pair<double, int>;  // time, rank

  int beside(int rank, int axis, int step) const {
    glm::ivec2 at(rank % m_.along_yz.x, rank / m_.along_yz.x);
    at[axis] += step;
    if (at[axis] < 0 || at[axis] >= m_.along_yz[axis]) return -1;
    return at.x + m_.along_yz.x * at.y;
  }
  static int up(int octant, int axis) { return ((octant >> (axis + 1)) & 1) != 0 ? 1 : -1; }

  /// Whether a rank takes a chunk of an octant from the one before it: it has begun it, and has planes for the one that
  /// it works on and the next.
  bool takes(int rank, int place, int octant, int chunk) const {
    const Rank& r = ranks_[size_t(rank)];
    return place < r.through + m_.octants_at_once && chunk < r.octants[size_t(octant)].done + 2;
  }

  /// The ready task with the most stages behind it; -1: none.
  int best(int rank, double now) const {
    int best = -1, most = -1;
    const int begun = std::min(8, ranks_[size_t(rank)].through + m_.octants_at_once);
    for (int place = 0; place < begun; ++place) {
      const int octant = kOppositeCorners[size_t(place)];
      const Octant& o = ranks_[size_t(rank)].octants[size_t(octant)];
      if (o.done == m_.chunks) continue;
      int stages = m_.chunks - o.done;
      bool ready = true;
      for (int axis = 0; axis < 2; ++axis) {
        const auto& arrives = o.arrives[size_t(axis)];
        const bool here = int(arrives.size()) > o.done && arrives[size_t(o.done)] <= now;
        ready = ready && (beside(rank, axis, -up(octant, axis)) < 0 || here);
        const int to = beside(rank, axis, up(octant, axis));  // its plane of two chunks before must have gone
        ready = ready && (to < 0 || o.done < 2 || takes(to, place, octant, o.done - 2));
        const int at = axis == 0 ? rank % m_.along_yz.x : rank / m_.along_yz.x;
        stages += up(octant, axis) > 0 ? m_.along_yz[axis] - 1 - at : at;
      }
      if (ready && stages > most) best = octant, most = stages;
    }
    return best;
  }

  void work(int rank, int octant, double now) {
    Rank& r = ranks_[size_t(rank)];
    double end = now + m_.task_s;
    std::array<int, 2> to{};
    for (int axis = 0; axis < 2; ++axis) {
      const double copy_s = (axis == 0 ? m_.y_bytes : m_.z_bytes) / m_.bytes_per_s;
      to[size_t(axis)] = beside(rank, axis, up(octant, axis));
      if (beside(rank, axis, -up(octant, axis)) >= 0) end += copy_s;
      if (to[size_t(axis)] >= 0) end += copy_s;
    }
    if (++r.octants[size_t(octant)].done == m_.chunks) ++r.through;
    r.free_s = end;
    last_ = std::max(last_, end);
    events_.push({end, rank});
    for (int axis = 0; axis < 2; ++axis) {
      for (const int step : {-1, 1}) {  // they may have waited for room here
        if (const int other = beside(rank, axis, step); other >= 0) events_.push({end, other});
      }
      if (to[size_t(axis)] < 0) continue;
      const double arrives = end + m_.latency_s;
      ranks_[size_t(to[size_t(axis)])].octants[size_t(octant)].arrives[size_t(axis)].push_back(arrives);
      events_.push({arrives, to[size_t(axis)]});
    }
  }

  const SweepModel& m_;
  std::vector<Rank> ranks_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  double last_ = 0.0;
};

}  // namespace

int least_stages(glm::ivec2 along_yz, int chunks) {
  int stages = 8 * chunks;
  for (int axis = 0; axis < 2; ++axis) stages += std::max(along_yz[axis] + along_yz[axis] % 2 - 2, 0);
  return stages;
}

SweepPrediction predict(const SweepModel& m) {
  SweepPrediction p;
  p.sweep_s = Simulation(m).run();
  p.efficiency = 8.0 * m.chunks * m.task_s / p.sweep_s;
  p.least_stages = least_stages(m.along_yz, m.chunks);
  return p;
}

}  // namespace volgi
