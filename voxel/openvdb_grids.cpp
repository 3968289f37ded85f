#include <openvdb/openvdb.h>

#include <type_traits>

#include "voxel/openvdb_fwd.h"

namespace volgi::vdb {

namespace {

static_assert(std::is_same_v<FloatGrid, openvdb::FloatGrid> && std::is_same_v<Vec3SGrid, openvdb::Vec3SGrid>);

/// By the library's registry, so that the class is not compiled here once more.
template <typename Grid>
std::shared_ptr<Grid> make() {
  openvdb::initialize();
  return openvdb::gridPtrCast<Grid>(openvdb::GridBase::createGrid(Grid::gridType()));
}

}  // namespace

FloatGridPtr make_float_grid() { return make<openvdb::FloatGrid>(); }
Vec3SGridPtr make_vec3s_grid() { return make<openvdb::Vec3SGrid>(); }
Vec3SGridPtr copy(const Vec3SGrid& grid) {
  return openvdb::gridPtrCast<Vec3SGrid>(static_cast<const openvdb::GridBase&>(grid).deepCopyGrid());
}

std::shared_ptr<Tree<std::int64_t>> make_int64_tree() { return make<openvdb::Int64Grid>()->treePtr(); }

}  // namespace volgi::vdb
