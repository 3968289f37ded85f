#include "propagation/lobes/sh_lobes_radiance.h"

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include "propagation/lobes/sh_lobes_kernels.h"
#include "shaders/shared/sh.shared.h"
#include "voxel/cell_volumes.h"

namespace volgi {

namespace {

using Tree = openvdb::Vec3SGrid::TreeType;
using Leaf = Tree::LeafNodeType;

bool is_lit(const float* lobes, int offset) {
  return lobes[offset] != 0.0f || lobes[offset + kLobeLeafCells] != 0.0f || lobes[offset + 2 * kLobeLeafCells] != 0.0f;
}

/// One coefficient of a leaf; cells that no light went through stay inactive.
std::unique_ptr<Leaf> make_leaf(const float* lobes, int coefficient, float factor, glm::ivec3 lowest) {
  auto leaf = std::make_unique<Leaf>(openvdb::Coord(lowest.x, lowest.y, lowest.z), openvdb::Vec3s(0.0f), false);
  for (int i = 0; i < kLobeLeafCells; ++i) {
    if (!is_lit(lobes, i)) continue;
    openvdb::Vec3s value;
    for (int band = 0; band < kLobeBands; ++band) value[band] = factor * lobes[lobe_block(coefficient, band) + i];
    leaf->setValueOn(openvdb::Index(i), value);
  }
  return leaf;
}

}  // namespace

LobeSum::LobeSum(const LeafNumbers& numbers, int coefficients)
    : numbers_(numbers), coefficients_(coefficients), leaves_(size_t(numbers.count())) {}

float* LobeSum::leaf(int number) {
  std::vector<float>& sums = leaves_[size_t(number)];
  if (sums.empty()) sums.assign(size_t(coefficients_) * kLobeBands * kLobeLeafCells, 0.0f);
  return sums.data();
}

void LobeSum::add(const LobeVolume& lobes, const LobeKernels& kernels) {
  tbb::parallel_for(size_t(0), lobes.leaves().size(), [&](size_t i) {
    const int number = lobes.leaves()[i];
    if (!numbers_.own(number)) return;
    const float* from = lobes.leaf(number);
    float* to = leaf(number);
    alignas(64) float carried[9 * kLobeBands * kLobeLeafCells];
    kernels.carried(from, carried);
    for (size_t j = 0; j < lobes.leaf_floats(); ++j) to[j] += carried[j];
  });
}

RadianceVolume LobeSum::radiance(const Grid& grid, float odd_sign) const {
  RadianceVolume volume;
  for (int k = 0; k < coefficients_; ++k) {
    const float factor = shared::radiance_from_lobe(grid.cell_size_m) * (k >= 1 && k <= 3 ? odd_sign : 1.0f);
    std::vector<std::unique_ptr<Leaf>> leaves(leaves_.size());
    tbb::parallel_for(size_t(0), leaves_.size(), [&](size_t n) {
      if (!leaves_[n].empty()) leaves[n] = make_leaf(leaves_[n].data(), k, factor, kLeafCells * numbers_.block(int(n)));
    });
    auto sh = vdb::make_vec3s_grid();
    sh->setName(sh_grid_name(k));
    sh->setTransform(world_from_index(grid, glm::dvec3(0.0)));
    for (auto& leaf : leaves) {
      if (leaf && !leaf->isEmpty()) sh->tree().addLeaf(leaf.release());
    }
    volume.sh.push_back(sh);
  }
  return volume;
}

void LobeSum::clear() {
  for (std::vector<float>& sums : leaves_) sums = {};
}

size_t LobeSum::bytes_for(const LeafNumbers& numbers, int coefficients, size_t leaves) {
  return leaves * size_t(coefficients * kLobeBands * kLobeLeafCells) * sizeof(float) +
         size_t(numbers.count()) * sizeof(std::vector<float>);
}

size_t LobeSum::bytes() const {
  size_t floats = 0;
  for (const std::vector<float>& sums : leaves_) floats += sums.size();
  return floats * sizeof(float) + leaves_.size() * sizeof(std::vector<float>);
}

}  // namespace volgi
