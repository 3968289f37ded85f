#include "voxel/volume_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "shaders/shared/sh.shared.h"

namespace volgi {

namespace {

using Kind = VolumeField::Kind;
using Held = VolumeField::Held;

glm::ivec3 ivec(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

/// Cells that `step` leaves of a box.
glm::ivec3 edges(const openvdb::Coord& box, int step) { return (ivec(box) + step - 1) / step; }

std::uint64_t product(glm::ivec3 n) { return std::uint64_t(n.x) * std::uint64_t(n.y) * std::uint64_t(n.z); }

template <typename Value>
glm::dvec3 as_vector(const Value& value) {
  constexpr int last = channel_count<Value>() - 1;
  return {channel(value, 0), channel(value, std::min(1, last)), channel(value, last)};
}

bool is_finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Sums active values into the blocks of a field.
class Blocks {
 public:
  explicit Blocks(VolumeField& field) : field_(field), sums_(field.held.size()), counts_(field.held.size()) {}

  /// Of cells that all have one value.
  void add(const openvdb::CoordBBox& cells, glm::dvec3 value) {
    const glm::ivec3 low = block(cells.min()), high = block(cells.max());
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) add_to({x, y, z}, cells, value);
  }
  void finish() {
    for (size_t i = 0; i < sums_.size(); ++i) {
      if (counts_[i] > 0.0) field_.held[i] = Held::number;
      if (counts_[i] > 0.0) field_.values[i] = glm::vec3(sums_[i] / counts_[i]);
    }
  }

 private:
  glm::ivec3 block(const openvdb::Coord& cell) const { return (ivec(cell) - ivec(field_.first)) / field_.step; }
  void add_to(glm::ivec3 block, const openvdb::CoordBBox& cells, glm::dvec3 value) {
    const glm::ivec3 low = glm::max(ivec(field_.first) + field_.step * block, ivec(cells.min()));
    const glm::ivec3 high = glm::min(ivec(field_.first) + field_.step * (block + 1), ivec(cells.max()) + glm::ivec3(1));
    const size_t i = field_.index(block);
    if (is_finite(value)) {
      const double count = double(product(high - low));
      sums_[i] += count * value;
      counts_[i] += count;
    } else if (counts_[i] == 0.0) {
      field_.held[i] = Held::no_number;
    }
  }

  VolumeField& field_;
  std::vector<glm::dvec3> sums_;
  std::vector<double> counts_;
};

}  // namespace

glm::dvec3 VolumeField::centre(glm::ivec3 cell) const {
  const double middle = 0.5 * (step - 1);
  const openvdb::Vec3d world = place->indexToWorld(openvdb::Vec3d(
      first.x() + step * cell.x + middle, first.y() + step * cell.y + middle, first.z() + step * cell.z + middle));
  return {world.x(), world.y(), world.z()};
}

VolumeField volume_field(const openvdb::GridBase& grid, const GridSummary& s, std::uint64_t most_cells) {
  assert(!s.channels.empty() && most_cells > 0);
  VolumeField field;
  field.name = s.name;
  field.unit = s.unit;
  field.description = s.description;
  const bool normal = grid.getVectorType() == openvdb::VEC_COVARIANT_NORMALIZE;
  field.kind = s.channels.size() == 1 ? Kind::number : normal ? Kind::normal : Kind::colour;
  field.place = grid.transformPtr();
  field.first = s.index_box.min();
  field.active_cells = s.active_cells;
  const openvdb::Coord box = s.index_box.dim();
  const auto too_many = [&](glm::dvec3 n) { return n.x * n.y * n.z > double(most_cells); };  // 2^96 at most
  while (too_many(edges(box, field.step))) ++field.step;
  field.cells = edges(box, field.step);
  field.values.assign(product(field.cells), glm::vec3(0.0f));
  field.held.assign(product(field.cells), Held::none);
  Blocks blocks(field);
  grid.apply<NumberGrids>([&](const auto& typed) {
    for (auto at = typed.cbeginValueOn(); at; ++at) {
      openvdb::CoordBBox cells;
      at.getBoundingBox(cells);
      blocks.add(cells, as_vector(at.getValue()));
    }
  });
  blocks.finish();
  return field;
}

VolumeField radiance_field(std::span<const VolumeField> bands, glm::vec3 d) {
  assert(bands.size() == 4 || bands.size() == 9);
  const glm::vec4 low = shared::sh_basis_1(d), high = shared::sh_basis_2(d);
  // Band 2 as files have it: xy, yz, 20, xz, 22.
  const std::array<float, 9> basis{low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w, shared::sh_basis_22(d)};
  constexpr float INVERSE_SQRT_4PI = 0.28209479177f;  // sh_basis_* are sqrt(4 pi) Y_lm
  VolumeField field = bands[0];
  field.name = "radiance";
  field.description = "of light that travels towards a direction";
  field.kind = Kind::colour;
  tbb::parallel_for(size_t(0), field.values.size(), [&](size_t i) {
    glm::vec3 sum(0.0f);
    for (size_t k = 0; k < bands.size(); ++k) {
      sum += basis[k] * bands[k].values[i];
      if (bands[k].held[i] == Held::no_number) field.held[i] = Held::no_number;
    }
    field.values[i] = glm::max(sum * INVERSE_SQRT_4PI, 0.0f);
  });
  return field;
}

std::span<const char* const> channels_of(Kind kind) {
  static constexpr std::array NUMBER{"value"};
  static constexpr std::array COLOUR{"all", "luminance", "red", "green", "blue"};
  static constexpr std::array NORMAL{"all", "x", "y", "z"};
  if (kind == Kind::number) return NUMBER;
  return kind == Kind::colour ? std::span<const char* const>(COLOUR) : NORMAL;
}

VolumeScalars scalars_of(const VolumeField& field, const std::string& name) {
  const auto names = channels_of(field.kind);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw Error(ExitCode::usage, fmt::format("channel {}: {} has {}", name, field.name, fmt::join(names, ", ")));
  const int place = int(found - names.begin());
  const bool luminance = field.kind == Kind::colour && place < 2;
  const int component = field.kind == Kind::colour ? place - 2 : std::max(place - 1, 0);
  VolumeScalars out;
  out.values.resize(field.values.size());
  std::vector<float> numbers;
  for (size_t i = 0; i < field.values.size(); ++i) {
    const glm::vec3 v = field.values[i];
    out.values[i] = luminance ? glm::dot(v, glm::vec3(kLuminance[0], kLuminance[1], kLuminance[2])) : v[component];
    if (field.held[i] == Held::number) numbers.push_back(out.values[i]);
  }
  out.count = numbers.size();
  if (numbers.empty()) return out;
  double sum = 0.0;
  for (const float v : numbers) sum += double(v);
  out.mean = sum / double(numbers.size());
  const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
  out.low = double(*low);
  out.high = double(*high);
  const auto most = numbers.begin() + std::ptrdiff_t(0.995 * double(numbers.size() - 1));
  std::nth_element(numbers.begin(), most, numbers.end());
  out.most = double(*most);
  return out;
}

}  // namespace volgi
