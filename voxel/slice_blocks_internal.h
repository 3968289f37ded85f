#pragma once
// Work on all blocks that hold triangles.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <memory>

#include "voxel/slice_internal.h"

namespace volgi::slicing {

/// What a Block(scene, number of the block, Block::Scratch&) collects of its triangles: add(triangle) for each of them,
/// then collect(), which may be null. Scratch is kept from block to block, one a thread.
template <class Block>
BlockTable for_all_blocks(const SlicedScene& s) {
  using Scratch = typename Block::Scratch;
  BlockTable table(s.first.empty() ? 0 : s.first.size() - 1);
  tbb::enumerable_thread_specific<std::unique_ptr<Scratch>> scratch([] { return std::make_unique<Scratch>(); });
  tbb::parallel_for(size_t(0), s.occupied.size(), [&](size_t i) {
    const std::uint32_t number = s.occupied[i];
    Block block(s, number, *scratch.local());
    for (std::uint32_t k = s.first[number]; k < s.first[number + 1]; ++k) block.add(s.binned[k]);
    table[number] = block.collect();
  });
  return table;
}

}  // namespace volgi::slicing
