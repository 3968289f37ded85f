#pragma once
#include <openvdb/version.h>

#include <cstdint>
#include <memory>

/// OpenVDB's names for what our headers mention, without its headers: each file that includes those spends 5 s on
/// reading them and 3 s on compiling their inline virtual functions. Files that look into grids include
/// <openvdb/openvdb.h>, which declares the same types; a difference would be an error there.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

template <typename>
class Grid;

namespace math {
template <typename>
class Vec3;
class Transform;
}  // namespace math

namespace tree {
template <typename>
class Tree;
template <typename>
class RootNode;
template <typename, std::uint32_t>
class InternalNode;
template <typename, std::uint32_t>
class LeafNode;
}  // namespace tree

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb

namespace volgi::vdb {

template <typename Value>
using Leaf = openvdb::tree::LeafNode<Value, 3>;
template <typename Value>
using Tree = openvdb::tree::Tree<
    openvdb::tree::RootNode<openvdb::tree::InternalNode<openvdb::tree::InternalNode<Leaf<Value>, 4>, 5>>>;

using FloatGrid = openvdb::Grid<Tree<float>>;                       // openvdb::FloatGrid
using Vec3SGrid = openvdb::Grid<Tree<openvdb::math::Vec3<float>>>;  // openvdb::Vec3SGrid
using FloatGridPtr = std::shared_ptr<FloatGrid>;
using Vec3SGridPtr = std::shared_ptr<Vec3SGrid>;
using TransformPtr = std::shared_ptr<openvdb::math::Transform>;

/// New ones, background zero. Whoever calls OpenVDB's own create() compiles the whole class, reading and writing of
/// files included (15 to 30 s); these ask the library's.
FloatGridPtr make_float_grid();
Vec3SGridPtr make_vec3s_grid();
std::shared_ptr<Tree<std::int64_t>> make_int64_tree();
Vec3SGridPtr copy(const Vec3SGrid& grid);

}  // namespace volgi::vdb
