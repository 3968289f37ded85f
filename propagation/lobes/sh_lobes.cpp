#include "propagation/lobes/sh_lobes.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <iterator>
#include <new>

#include "propagation/lobes/sh_lobes_kernels.h"
#include "shaders/shared/grid.shared.h"

namespace volgi {

namespace {

constexpr size_t kChunkLeaves = 256;
constexpr size_t kHugePage = 2 << 20;  // a pass walks seven leaves at a time: small pages would miss the TLB

/// What dark leaves read as. Never written: leaves() does not name it.
float* zero_leaf() {
  alignas(64) static std::array<float, 9 * kLobeBands * kLobeLeafCells> zeros{};
  return zeros.data();
}

}  // namespace

int LeafNumbers::beside(int number_of, int face) const {
  const glm::ivec3 b = block(number_of) + shared::face_step(face);
  const bool inside = glm::all(glm::greaterThanEqual(b, first_)) && glm::all(glm::lessThan(b, first_ + blocks_));
  return inside ? number(b) : -1;
}

LobeVolume::LobeVolume(const LeafNumbers& numbers, int coefficients)
    : leaf_floats_(size_t(coefficients * kLobeBands * kLobeLeafCells)),
      chunk_leaves_(std::clamp(size_t(numbers.count()), size_t(1), kChunkLeaves)),
      table_(size_t(numbers.count()), zero_leaf()),
      slot_of_(size_t(numbers.count()), -1) {
  assert(coefficients <= 9);
}

size_t LobeVolume::cache_bytes() {
  static const long bytes = sysconf(_SC_LEVEL3_CACHE_SIZE);
  return bytes > 0 ? size_t(bytes) : size_t(32) << 20;
}

const float* LobeVolume::dark() { return zero_leaf(); }

/// A chunk more.
void LobeVolume::add_slots() {
  const size_t bytes = chunk_bytes(chunk_leaves_, leaf_floats_);
  void* p = std::aligned_alloc(bytes % kHugePage == 0 ? kHugePage : 4096, bytes);
  if (p == nullptr) throw std::bad_alloc();
  if (bytes % kHugePage == 0) madvise(p, bytes, MADV_HUGEPAGE);  // a hint: nothing depends on it
  const size_t first = chunks_.size() * chunk_leaves_;
  chunks_.emplace_back(static_cast<float*>(p));
  rows_written_.resize(first + chunk_leaves_);
  for (size_t i = chunk_leaves_; i > 0; --i) free_.push_back(int(first + i - 1));  // the first comes first
}

float* LobeVolume::slot(int index) const {
  const size_t i = size_t(index);
  return chunks_[i / chunk_leaves_].get() + (i % chunk_leaves_) * leaf_floats_;
}

/// Whole huge pages, but for grids that do not fill one.
size_t LobeVolume::chunk_bytes(size_t chunk_leaves, size_t leaf_floats) {
  const size_t bytes = chunk_leaves * leaf_floats * sizeof(float);
  return bytes < kHugePage ? bytes : (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

void LobeVolume::release(int number) {
  free_.push_back(slot_of_[size_t(number)]);
  slot_of_[size_t(number)] = -1;
  table_[size_t(number)] = zero_leaf();
}

void LobeVolume::assign(std::vector<int> numbers) {
  for (const int n : leaves_) {
    if (!std::binary_search(numbers.begin(), numbers.end(), n)) release(n);
  }
  leaves_ = std::move(numbers);
  for (const int n : leaves_) {
    int& of_leaf = slot_of_[size_t(n)];
    if (of_leaf >= 0) continue;
    if (free_.empty()) add_slots();
    of_leaf = free_.back();
    free_.pop_back();
    rows_written_[size_t(of_leaf)] = kAllRows;
    table_[size_t(n)] = slot(of_leaf);
  }
}

void LobeVolume::add(const std::vector<int>& numbers) {
  std::vector<int> all;
  std::merge(leaves_.begin(), leaves_.end(), numbers.begin(), numbers.end(), std::back_inserter(all));
  assign(std::move(all));
}

void LobeVolume::drop(std::span<const char> dropped) {
  size_t kept = 0;
  for (size_t i = 0; i < leaves_.size(); ++i) {
    if (dropped[i] != 0) {
      release(leaves_[i]);
    } else {
      leaves_[kept++] = leaves_[i];
    }
  }
  leaves_.resize(kept);
}

void LobeVolume::swap(LobeVolume& other) noexcept {
  std::swap(leaf_floats_, other.leaf_floats_);
  std::swap(chunk_leaves_, other.chunk_leaves_);
  chunks_.swap(other.chunks_);
  leaves_.swap(other.leaves_);
  table_.swap(other.table_);
  slot_of_.swap(other.slot_of_);
  free_.swap(other.free_);
  rows_written_.swap(other.rows_written_);
}

size_t LobeVolume::bytes_for(const LeafNumbers& numbers, int coefficients, size_t leaves) {
  const LobeVolume one(numbers, coefficients);
  const size_t chunks = (leaves + one.chunk_leaves_ - 1) / one.chunk_leaves_;
  return one.bytes() + chunks * (chunk_bytes(one.chunk_leaves_, one.leaf_floats_) +
                                 one.chunk_leaves_ * (sizeof(std::uint64_t) + sizeof(int)));
}

size_t LobeVolume::bytes() const {
  return chunks_.size() * chunk_bytes(chunk_leaves_, leaf_floats_) + table_.size() * (sizeof(float*) + sizeof(int)) +
         rows_written_.size() * (sizeof(std::uint64_t) + sizeof(int));
}

}  // namespace volgi
