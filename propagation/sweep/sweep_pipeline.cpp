#include "propagation/sweep/sweep_pipeline.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "propagation/sweep/sweep_order.h"

namespace volgi {

namespace {

constexpr int kMostChunkBlocks = 2;  // of several ranks: more would keep those downwind waiting

bool flows_up(int octant, int axis) { return ((octant >> axis) & 1) != 0; }

constexpr std::array<int, 8> kInOrder{0, 1, 2, 3, 4, 5, 6, 7};

}  // namespace

/// As wide as a chunk may be without its planes, two through y and two through z, being more to keep than what waits
/// for the next chunk, a face for each row. The same for all ranks: by the largest part.
int SweepPipeline::chunk_blocks_of(const RanksOfVolume* ranks, const BlockBox& part) {
  if (ranks == nullptr) return std::max(1, part.size().x);
  const glm::ivec2 widest = ranks->decomposition.widest();
  return std::clamp(widest.x * widest.y / (2 * (widest.x + widest.y)), 1,
                    std::min(kMostChunkBlocks, ranks->decomposition.blocks().x));
}

int SweepPipeline::slots_of(const RanksOfVolume* ranks, size_t bytes_of_octant, AtOnce at_once) {
  if (ranks == nullptr && at_once.of_one > 0) return at_once.of_one;
  if (ranks == nullptr) return 8 * bytes_of_octant > at_once.many_flows ? 1 : 8;
  if (at_once.of_ranks > 0) return at_once.of_ranks;
  if (ranks->lean) return 2;
  return 8 * bytes_of_octant > kManyFlowsOfRank ? 4 : 8;
}

SweepPipeline::SweepPipeline(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats, AtOnce at_once)
    : ranks_(ranks),
      size_(part.size()),
      face_floats_(face_floats),
      chunk_blocks_(chunk_blocks_of(ranks, part)),
      slots_(size_t(slots_of(ranks, octant_bytes(ranks, part, face_floats), at_once))) {
  chunks_ = (size_.x + chunk_blocks_ - 1) / chunk_blocks_;
  make_flows(part);
  const size_t rows = size_t(size_.y) * size_t(size_.z);
  for (Slot& slot : slots_) {
    for (size_t a = 0; a < 2; ++a) {
      const Flow& flow = flows_[0][a];  // ranks are beside for all octants or for none
      for (size_t i = 0; i < (flow.beside() ? 2u : 1u); ++i)
        slot.planes[a][i].resize(header_bytes(flow.faces) + flow.faces * face_floats_ * sizeof(float));
    }
    if (chunks_ > 1) slot.carried.resize(rows * face_floats_);
    if (chunks_ > 1) slot.carried_lit.resize(rows);
  }
}

void SweepPipeline::make_flows(const BlockBox& part) {
  for (int octant = 0; octant < 8; ++octant) {
    for (int axis = 1; axis <= 2; ++axis) {
      Flow& flow = flows_[size_t(octant)][size_t(axis - 1)];
      flow.faces = faces_of(part, chunk_blocks_, axis);
      if (ranks_ == nullptr) continue;
      const int up = flows_up(octant, axis) ? 1 : -1;
      flow.from = ranks_->decomposition.beside(ranks_->ranks.rank(), axis, -up);
      flow.to = ranks_->decomposition.beside(ranks_->ranks.rank(), axis, up);
    }
  }
}

void SweepPipeline::start(bool in_order) {
  in_order_ = in_order;
  order_ = in_order || alone() ? kInOrder : kOppositeCorners;
  done_ = {};
  slot_.fill(-1);
  next_ = 0;
  for (auto& octant : flows_) {
    for (Flow& flow : octant) flow.come = 0;
  }
  begin_octants();
}

/// As many as there is room for.
void SweepPipeline::begin_octants() {
  for (int slot = 0; slot < int(slots_.size()) && next_ < 8; ++slot) {
    if (std::find(slot_.begin(), slot_.end(), slot) == slot_.end()) slot_[size_t(order_[size_t(next_++)])] = slot;
  }
}

SweepPipeline::Plane SweepPipeline::plane(Task task, int axis) {
  const Flow& flow = flows_[size_t(task.octant)][size_t(axis - 1)];
  std::byte* bytes = buffer(task.octant, axis - 1, flow.place(task.chunk)).data();
  return {reinterpret_cast<unsigned char*>(bytes), reinterpret_cast<float*>(bytes + header_bytes(flow.faces)),
          flow.faces};
}

float* SweepPipeline::carried(int octant, size_t row) {
  return chunks_ > 1 ? slot_of(octant).carried.data() + row * face_floats_ : nullptr;
}

/// Lit faces to the front. @return  bytes of the message.
size_t SweepPipeline::pack(Buffer& plane, size_t faces) const {
  const auto* lit = reinterpret_cast<const unsigned char*>(plane.data());
  std::byte* const values = plane.data() + header_bytes(faces);
  const size_t face_bytes = face_floats_ * sizeof(float);
  size_t count = 0;
  for (size_t i = 0; i < faces; ++i) {
    if (lit[i] == 0) continue;
    if (count != i) std::memcpy(values + count * face_bytes, values + i * face_bytes, face_bytes);
    ++count;
  }
  return header_bytes(faces) + count * face_bytes;
}

/// And back.
void SweepPipeline::unpack(Buffer& plane, size_t faces) const {
  const auto* lit = reinterpret_cast<const unsigned char*>(plane.data());
  std::byte* const values = plane.data() + header_bytes(faces);
  const size_t face_bytes = face_floats_ * sizeof(float);
  auto count = size_t(std::count_if(lit, lit + faces, [](unsigned char l) { return l != 0; }));
  for (size_t i = faces; i-- > 0 && count > 0;) {
    if (lit[i] == 0) continue;
    if (--count != i) std::memcpy(values + i * face_bytes, values + count * face_bytes, face_bytes);
  }
}

/// @return  whether anything has. An octant that is through makes room.
bool SweepPipeline::take_what_left(int octant) {
  bool any = false;
  auto& flows = flows_[size_t(octant)];
  for (Flow& flow : flows) {
    for (MessagePtr& leaving : flow.leaving) {
      if (leaving == nullptr || !leaving->done()) continue;
      leaving.reset();
      any = true;
    }
  }
  if (done_[size_t(octant)] == chunks_ && !flows[0].leaves() && !flows[1].leaves()) {
    slot_[size_t(octant)] = -1;
    begin_octants();
  }
  return any;
}

/// Takes what has come and asks for the next, where there is room for it. @return  whether anything has.
bool SweepPipeline::progress() {
  bool any = false;
  for (const int octant : order_) any |= begun(octant) && take_what_left(octant);
  for (const int octant : order_) {
    if (!begun(octant)) continue;
    for (int a = 0; a < 2; ++a) {
      Flow& flow = flows_[size_t(octant)][size_t(a)];
      if (flow.from < 0 || flow.faces == 0) continue;
      if (flow.coming != nullptr && flow.coming->done()) {
        unpack(buffer(octant, a, flow.place(flow.come)), flow.faces);
        flow.coming.reset();
        ++flow.come;
        any = true;
      }
      const size_t place = flow.place(flow.come);
      const bool room = flow.come < done_[size_t(octant)] + 2 && flow.leaving[place] == nullptr;
      if (flow.coming == nullptr && flow.come < chunks_ && room)
        flow.coming = ranks_->ranks.receive(flow.from, 2 * octant + a, buffer(octant, a, place));
    }
  }
  return any;
}

bool SweepPipeline::is_ready(int octant) {
  const int chunk = done_[size_t(octant)];
  if (chunk == chunks_ || !begun(octant)) return false;
  for (const Flow& flow : flows_[size_t(octant)]) {
    if (flow.faces == 0) continue;
    const bool here = flow.from >= 0 ? flow.come > chunk : flow.leaving[flow.place(chunk)] == nullptr;
    if (!here) return false;
  }
  return true;
}

int SweepPipeline::stages_behind(int octant) const {
  int stages = chunks_ - done_[size_t(octant)];
  if (ranks_ == nullptr) return stages;
  const glm::ivec2 along = ranks_->decomposition.along_yz(), at = ranks_->decomposition.place(ranks_->ranks.rank());
  for (int a = 0; a < 2; ++a) stages += flows_up(octant, a + 1) ? along[a] - 1 - at[a] : at[a];
  return stages;
}

void SweepPipeline::wait_for_messages() {
  std::vector<Ranks::Message*> pending;
  for (auto& octant : flows_) {
    for (Flow& flow : octant) {
      for (Ranks::Message* m : {flow.coming.get(), flow.leaving[0].get(), flow.leaving[1].get()}) {
        if (m != nullptr) pending.push_back(m);
      }
    }
  }
  ranks_->ranks.wait_any(pending);
}

std::vector<SweepPipeline::Task> SweepPipeline::next(size_t most) {
  for (;;) {
    if (ranks_ != nullptr) progress();
    std::vector<Task> ready;
    bool all_done = true;
    for (const int octant : order_) {
      if (done_[size_t(octant)] == chunks_) continue;
      if (is_ready(octant)) ready.push_back({octant, done_[size_t(octant)]});
      all_done = false;
      if (in_order_) break;
    }
    if (all_done) return {};
    if (!ready.empty()) {
      std::stable_sort(ready.begin(), ready.end(),
                       [&](Task a, Task b) { return stages_behind(a.octant) > stages_behind(b.octant); });
      ready.resize(std::min(ready.size(), most));
      return ready;
    }
    wait_for_messages();
  }
}

void SweepPipeline::finished(Task task) {
  ++done_[size_t(task.octant)];
  for (int a = 0; a < 2; ++a) {
    Flow& flow = flows_[size_t(task.octant)][size_t(a)];
    if (flow.to < 0 || flow.faces == 0) continue;
    const size_t place = flow.place(task.chunk);
    Buffer& plane = buffer(task.octant, a, place);
    const size_t bytes = pack(plane, flow.faces);
    flow.leaving[place] = ranks_->ranks.send(flow.to, 2 * task.octant + a, std::span(plane).first(bytes));
    traffic_.messages += 1;
    traffic_.bytes += bytes;
  }
  take_what_left(task.octant);
}

void SweepPipeline::end() {
  if (ranks_ == nullptr) return;
  const auto under_way = [](const auto& octant) { return octant[0].leaves() || octant[1].leaves(); };
  for (;;) {
    progress();
    if (std::none_of(flows_.begin(), flows_.end(), under_way)) return;
    wait_for_messages();
  }
}

size_t SweepPipeline::octant_bytes(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats) {
  const int chunk_blocks = chunk_blocks_of(ranks, part);
  const bool several_chunks = part.size().x > chunk_blocks;
  size_t bytes = 0;
  for (int axis = 1; axis <= 2; ++axis) {
    const bool beside = ranks != nullptr && ranks->decomposition.along_yz()[axis - 1] > 1;
    const size_t faces = faces_of(part, chunk_blocks, axis);
    bytes += (beside ? 2 : 1) * (header_bytes(faces) + faces * face_floats * sizeof(float));
  }
  if (several_chunks) bytes += size_t(part.size().y) * size_t(part.size().z) * (face_floats * sizeof(float) + 1);
  return bytes;
}

size_t SweepPipeline::bytes_for(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats, AtOnce at_once) {
  const size_t bytes = octant_bytes(ranks, part, face_floats);
  return size_t(slots_of(ranks, bytes, at_once)) * bytes;
}

int SweepPipeline::octants_at_once(const BlockBox& part, size_t face_floats, AtOnce at_once) {
  return slots_of(nullptr, octant_bytes(nullptr, part, face_floats), at_once);
}

size_t SweepPipeline::bytes() const {
  size_t bytes = 0;
  for (const Slot& slot : slots_) {
    for (const Planes& planes : slot.planes) bytes += planes[0].size() + planes[1].size();
    bytes += slot.carried.size() * sizeof(float) + slot.carried_lit.size();
  }
  return bytes;
}

}  // namespace volgi
