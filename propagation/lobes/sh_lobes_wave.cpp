#include "propagation/lobes/sh_lobes_wave.h"

#include <array>
#include <bit>
#include <cstring>
#include <map>

#include "propagation/side_loops.h"

namespace volgi {

namespace {

// Rows of a leaf's faces.
constexpr std::uint64_t kLowX = 0xff, kHighX = kLowX << 56;
constexpr std::uint64_t kLowY = 0x0101010101010101, kHighY = kLowY << 7;

}  // namespace

LobeWave::LobeWave(const LeafNumbers& numbers, int coefficients, const RanksOfVolume* ranks)
    : numbers_(numbers),
      now_(numbers, coefficients),
      next_(numbers, coefficients),
      lit_(size_t(numbers.count())),
      ranks_(ranks) {
  if (ranks_ != nullptr) find_partners();
}

namespace {

/// What comes before the lobes of a leaf in a message.
struct ShownHeader {
  glm::ivec3 block;
  int face;  // of the leaf that is shown
  std::uint64_t any, low, high;
};

/// f(offset in the leaf, place among the 64) for the cells on a face across y or z.
template <class F>
void for_face_cells(int face, const F& f) {
  const bool upper = (face & 1) != 0;
  for (int i = 0; i < 64; ++i) {
    const int x = i >> 3, other = i & 7, at = upper ? 7 : 0;
    f(face < 4 ? x << 6 | at << 3 | other : x << 6 | other << 3 | at, i);
  }
}

}  // namespace

size_t LobeWave::shown_bytes() const { return sizeof(ShownHeader) + shown_floats() * sizeof(float); }

/// Ranks beside along y and z, and what each looks at.
void LobeWave::find_partners() {
  std::map<int, std::vector<Shown>> by_rank;
  for (int n = 0; n < numbers_.count(); ++n) {
    for (int face = 2; face < 6 && numbers_.own(n); ++face) {
      const int beside = numbers_.beside(n, face);
      if (beside >= 0 && !numbers_.own(beside))
        by_rank[ranks_->decomposition.owner(numbers_.block(beside))].push_back({n, face});
    }
  }
  for (auto& [rank, own] : by_rank) {
    const size_t room = own.size() * shown_bytes();  // as much comes as goes
    partners_.push_back({rank, std::move(own), Ranks::Bytes(room), Ranks::Bytes(room)});
  }
}

/// All ranks: the lit leaves beside the part, as far as it looks at them.
void LobeWave::fetch_beside() {
  if (ranks_ == nullptr) return;
  constexpr int kTag = 16;  // the sweeps' are below
  std::vector<std::unique_ptr<Ranks::Message>> messages;
  for (Partner& p : partners_) messages.push_back(ranks_->ranks.receive(p.rank, kTag, p.from));
  for (Partner& p : partners_) {
    std::byte* at = p.to.data();
    for (const Shown& s : p.own) {
      const LitRows& lit = lit_[size_t(s.number)];
      const float* leaf = now_.leaf(s.number);
      if (leaf == LobeVolume::dark()) continue;
      const ShownHeader header{numbers_.block(s.number), s.face, lit.any, lit.low, lit.high};
      std::memcpy(at, &header, sizeof header);
      auto* to = reinterpret_cast<float*>(at + sizeof header);
      for (size_t block = 0; block < now_.leaf_floats(); block += kLobeLeafCells, to += 64)
        for_face_cells(s.face, [&](int offset, int i) { to[i] = leaf[block + size_t(offset)]; });
      at += shown_bytes();
    }
    messages.push_back(ranks_->ranks.send(p.rank, kTag, std::span(p.to).first(size_t(at - p.to.data()))));
  }
  std::vector<Ranks::Message*> waiting(1);
  for (const auto& m : messages) {
    waiting[0] = m.get();
    ranks_->ranks.wait_any(waiting);
  }
  for (int n = 0; n < numbers_.count(); ++n) {
    if (!numbers_.own(n)) lit_[size_t(n)] = {};
  }
  std::vector<int> there;
  const auto for_shown = [&](const auto& f) {
    for (size_t i = 0; i < partners_.size(); ++i) {
      for (size_t at = 0; at < messages[i]->bytes(); at += shown_bytes()) {
        ShownHeader header;
        std::memcpy(&header, partners_[i].from.data() + at, sizeof header);
        f(header, reinterpret_cast<const float*>(partners_[i].from.data() + at + sizeof header));
      }
    }
  };
  for_shown([&](const ShownHeader& h, const float*) { there.push_back(numbers_.number(h.block)); });
  std::sort(there.begin(), there.end());
  now_.add(there);
  for_shown([&](const ShownHeader& h, const float* from) {
    const int n = numbers_.number(h.block);
    float* leaf = now_.leaf(n);
    for (size_t block = 0; block < now_.leaf_floats(); block += kLobeLeafCells, from += 64)
      for_face_cells(h.face, [&](int offset, int i) { leaf[block + size_t(offset)] = from[i]; });
    lit_[size_t(n)] = {h.any, h.low, h.high};
    now_.rows_written(n) = kAllRows;
  });
}

void LobeWave::find_beside(int number, const float* beside[6]) const {
  for (int face = 0; face < 6; ++face) {
    const int n = numbers_.beside(number, face);
    beside[face] = n < 0 ? LobeVolume::dark() : now_.leaf(n);
  }
}

std::uint64_t LobeWave::rows_reached(int number) const {
  if (dense_) return kAllRows;
  const std::uint64_t own = lit_[size_t(number)].any;
  const auto there = [&](int face) {
    const int n = numbers_.beside(number, face);
    return n < 0 ? LitRows{} : lit_[size_t(n)];
  };
  return own | own << 8 | own >> 8 | (own & ~kHighY) << 1 | (own & ~kLowY) >> 1 |  // within the leaf
         there(0).any >> 56 | there(1).any << 56 | (there(2).any & kHighY) >> 7 | (there(3).any & kLowY) << 7 |
         there(4).high | there(5).low;
}

void LobeWave::write_only(int number, std::uint64_t rows) {
  constexpr size_t kRowCells = 8;
  float* const leaf = next_.leaf(number);
  std::uint64_t& written = next_.rows_written(number);
  for (std::uint64_t stale = written & ~rows; stale != 0; stale &= stale - 1) {
    float* const row = leaf + kRowCells * size_t(std::countr_zero(stale));
    for (size_t block = 0; block < next_.leaf_floats(); block += kLobeLeafCells) {
      std::fill(row + block, row + block + kRowCells, 0.0f);
    }
  }
  written = rows;
}

/// Sums what `light_` says about the leaves, drops the dark ones.
void LobeWave::settle(LobeVolume& lobes) {
  std::vector<char> dark(light_.size());
  std::array<ExactSum, 3> in_flight;
  size_t kept = 0;
  for (size_t i = 0; i < light_.size(); ++i) {
    const LeafLight light = light_[i];
    for (int band = 0; band < kLobeBands; ++band) in_flight[size_t(band)].add(double(light.power[band]));
    const bool is_lit = light.power[0] > 0.0f || light.power[1] > 0.0f || light.power[2] > 0.0f;
    lit_[size_t(lobes.leaves()[i])] = {light.lit_rows, light.lit_low, light.lit_high};
    dark[i] = !is_lit && !dense_;
    if (dark[i] == 0) light_[kept++] = light;
  }
  in_flight_ = SideSums::over_ranks(in_flight, ranks_ != nullptr ? &ranks_->ranks : nullptr);
  light_.resize(kept);
  lobes.drop(dark);
}

/// Lit leaves, and those that they send light into.
std::vector<int> LobeWave::reached() const {
  std::vector<char> is_reached(size_t(numbers_.count()), dense_ ? 1 : 0);
  for (const int n : now_.leaves()) {
    if (dense_) break;
    is_reached[size_t(n)] = 1;
    const LitRows& lit = lit_[size_t(n)];
    const std::uint64_t at_face[6] = {lit.any & kLowX,  lit.any & kHighX, lit.any & kLowY,
                                      lit.any & kHighY, lit.low,          lit.high};
    for (int face = 0; face < 6; ++face) {
      const int beside = at_face[face] != 0 ? numbers_.beside(n, face) : -1;
      if (beside >= 0) is_reached[size_t(beside)] = 1;
    }
  }
  std::vector<int> leaves;
  for (int n = 0; n < numbers_.count(); ++n) {
    if (is_reached[size_t(n)] != 0 && numbers_.own(n)) leaves.push_back(n);
  }
  return leaves;
}

}  // namespace volgi
