#include "voxel/vdb_parts.h"

#include <fmt/format.h>

#include <vector>

#include "core/error.h"
#include "voxel/vdb_summary.h"

namespace volgi {

namespace {

constexpr const char* kPartKey = "part";
constexpr const char* kPartsKey = "parts";

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", file.string(), what));
}

/// The number of a part, and of how many; neither is in the metadata afterwards.
std::pair<int, int> take_mark(const std::filesystem::path& file, openvdb::MetaMap& metadata) {
  const auto part = metadata.getMetadata<openvdb::Int32Metadata>(kPartKey);
  const auto parts = metadata.getMetadata<openvdb::Int32Metadata>(kPartsKey);
  if (!part || !parts) fail(file, "not one rank's part of an export");
  const std::pair<int, int> mark(part->value(), parts->value());
  metadata.removeMeta(kPartKey);
  metadata.removeMeta(kPartsKey);
  return mark;
}

void move_leaves(openvdb::GridBase& from, openvdb::GridBase& to, const std::filesystem::path& file) {
  const bool known = from.apply<NumberGrids>([&](auto& grid) {
    using Tree = typename std::decay_t<decltype(grid)>::TreeType;
    auto* into = dynamic_cast<std::decay_t<decltype(grid)>*>(&to);
    if (into == nullptr) fail(file, "a grid in it is of another type than in the other parts");
    std::vector<typename Tree::LeafNodeType*> leaves;
    grid.tree().stealNodes(leaves);
    for (auto* leaf : leaves) into->tree().addLeaf(leaf);
  });
  if (!known) fail(file, "a grid in it is of a type that volgi does not write");
}

}  // namespace

std::filesystem::path part_path(const std::filesystem::path& path, int rank) {
  std::filesystem::path name = path;
  return name.replace_extension(fmt::format(".{}.vdb", rank));
}

void mark_as_part(openvdb::MetaMap& file_metadata, int rank, int ranks) {
  file_metadata.insertMeta(kPartKey, openvdb::Int32Metadata(rank));
  file_metadata.insertMeta(kPartsKey, openvdb::Int32Metadata(ranks));
}

VdbFile merge_parts(std::span<const std::filesystem::path> parts) {
  if (parts.empty()) throw Error(ExitCode::bad_input, "no parts of an export to merge");
  VdbFile merged;
  std::vector<bool> there;
  for (const std::filesystem::path& file : parts) {
    VdbFile part = read_vdb(file);
    const auto [number, count] = take_mark(file, part.metadata);
    if (there.empty()) there.assign(size_t(std::max(count, 1)), false);
    if (number < 0 || size_t(count) != there.size() || size_t(number) >= there.size())
      fail(file, fmt::format("part {} of {}, not of {}", number, count, there.size()));
    if (there[size_t(number)]) fail(file, fmt::format("part {} is there twice", number));
    there[size_t(number)] = true;
    if (merged.grids.empty()) {
      merged = std::move(part);
      continue;
    }
    if (part.metadata != merged.metadata || part.grids.size() != merged.grids.size())
      fail(file, "of another export than the parts before it");
    for (size_t i = 0; i < part.grids.size(); ++i) move_leaves(*part.grids[i], *merged.grids[i], file);
  }
  for (size_t i = 0; i < there.size(); ++i) {
    if (!there[i]) throw Error(ExitCode::bad_input, fmt::format("part {} of {} is missing", i, there.size()));
  }
  return merged;
}

}  // namespace volgi
