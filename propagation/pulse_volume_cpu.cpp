#include "propagation/pulse_volume_cpu.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "propagation/lobes/sh_lobes_radiance.h"
#include "propagation/lobes/sh_lobes_wave.h"
#include "shaders/shared/sh_constants.shared.h"
#include "voxel/cell_volumes.h"

namespace volgi {

namespace {

constexpr int kStride = kLobeBands * kLobeLeafCells;  // from a coefficient to the next
constexpr float kConstantAlbedo = 0.5f;               // Gaitatzes 2010, section 5: after the first bounce

using Coefficients = std::array<float, 9>;
using FacePowers = float[6];  // by the face that light leaves through

glm::vec3 direction_of(int face) { return glm::vec3(shared::face_step(face)); }

/// sqrt(4 pi) Y_lm(n) times zonal coefficients: a lobe of power 1 about n (sh_constants.shared.h).
Coefficients lobe_about(glm::vec3 n, float zonal_1, float zonal_2) {
  const float one = std::sqrt(3.0f) * zonal_1;
  const float two = std::sqrt(15.0f) * zonal_2;
  return {1.0f,
          one * n.y,
          one * n.z,
          one * n.x,
          two * n.x * n.y,
          two * n.y * n.z,
          two / std::sqrt(12.0f) * (2.0f * n.z * n.z - n.x * n.x - n.y * n.y),
          two * n.x * n.z,
          0.5f * two * (n.x * n.x - n.y * n.y)};
}

/// Functionals of a neighbour's lobe and the lobes handed on, for both schemes.
struct Tables {
  Coefficients cosine[6], cone[6];  // lobes of power 1 about the faces' directions
  /// lpv2009: flux from the neighbour at face `from` through face `out`; gaitatzes2010: into the cone from `from`.
  Coefficients flux[6][6] = {};
  Coefficients into_cone[6];

  Tables() {
    for (int face = 0; face < 6; ++face) {
      cosine[face] = lobe_about(direction_of(face), shared::COSINE_ZONAL_1, shared::COSINE_ZONAL_2);
      cone[face] = lobe_about(direction_of(face), shared::CONE_ZONAL_1, shared::CONE_ZONAL_2);
    }
    for (int from = 0; from < 6; ++from) {
      into_cone[from] = scaled(cone[from ^ 1], shared::CONE_SHARE);
      for (int out = 0; out < 6; ++out) {
        if (out != from) flux[from][out] = seen(direction_of(from ^ 1), out, from);
      }
    }
  }

 private:
  static Coefficients scaled(Coefficients c, float factor) {
    for (float& x : c) x *= factor;
    return c;
  }
  /// Intensity towards the centre of face `out` times the solid angle that it shows to the neighbour.
  static Coefficients seen(glm::vec3 travel, int out, int from) {
    const bool far = out == (from ^ 1);
    const glm::vec3 towards =
        far ? travel : shared::LPV_SIDE_ALONG * travel + shared::LPV_SIDE_ACROSS * direction_of(out);
    const float solid_angle = far ? shared::LPV_FAR_SOLID_ANGLE : shared::LPV_SIDE_SOLID_ANGLE;
    return scaled(lobe_about(towards, 1.0f, 1.0f), solid_angle / (4.0f * float(M_PI)));
  }
};

const Tables& tables() {
  static const Tables all;
  return all;
}

/// What gaitatzes2010 knows of the surfaces in a leaf's cells.
struct LeafSurfaces {
  std::array<float, kLobeLeafCells> occupancy{};
  std::array<glm::vec3, kLobeLeafCells> albedo{};
  /// A bit for each face: light that heads for it is turned back.
  std::array<std::uint8_t, kLobeLeafCells> turns{};
};

/// The mirror of T_r: on the axis nearest to the mean normal, if light heads into the surface. Where normals cancel,
/// light meets the surface from any side.
std::uint8_t turned_ways(glm::vec3 normal) {
  if (normal == glm::vec3(0.0f)) return 63;
  const glm::vec3 a = glm::abs(normal);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return std::uint8_t(1u << (2 * axis + (normal[axis] > 0.0f ? 0 : 1)));
}

std::vector<std::unique_ptr<LeafSurfaces>> collect_surfaces(const CellVolumes& cells, const LeafNumbers& numbers,
                                                            bool constant_albedo) {
  std::vector<std::unique_ptr<LeafSurfaces>> all(size_t(numbers.count()));
  auto albedos = cells.albedo->getConstAccessor();
  auto normals = cells.normal->getConstAccessor();
  for (auto leaf = cells.occupancy->tree().cbeginLeaf(); leaf; ++leaf) {
    const openvdb::Coord lowest = leaf->origin();
    const glm::ivec3 block = glm::ivec3(lowest.x(), lowest.y(), lowest.z()) / kLeafCells;
    auto surfaces = std::make_unique<LeafSurfaces>();
    for (auto value = leaf->cbeginValueOn(); value; ++value) {
      const openvdb::Coord cell = value.getCoord();
      const auto i = size_t(value.pos());
      const openvdb::Vec3s rho = albedos.getValue(cell), n = normals.getValue(cell);
      surfaces->occupancy[i] = std::clamp(*value, 0.0f, 1.0f);
      surfaces->albedo[i] = constant_albedo ? glm::vec3(kConstantAlbedo) : glm::vec3(rho[0], rho[1], rho[2]);
      surfaces->turns[i] = turned_ways(glm::vec3(n[0], n[1], n[2]));
    }
    all[size_t(numbers.number(block))] = std::move(surfaces);
  }
  return all;
}

}  // namespace

struct PulseVolumeCpu::Data {
  Data(const VoxelGrid& voxels, const CellVolumes& cells, const SchemeOptions& options);

  void inject(std::span<const glm::vec4> side_flux);
  void inject_max(std::span<const glm::vec4> side_flux);
  glm::vec3 radiosity_of_side(std::span<const glm::vec4> side_flux, glm::ivec3 cell, int face) const;
  glm::vec3 reflected(std::span<const glm::vec4> side_flux, glm::ivec3 cell) const;
  bool occupied(glm::ivec3 cell) const;
  void pass();
  void pass_leaf(int number, float* out, LeafLight& light);
  /// One cell: gathers from its six neighbours. @param lobes  the neighbours' first coefficients, by face.
  void spread(const float* const lobes[6], float* out, float* total) const;
  void bounce(const float* const lobes[6], const LeafSurfaces* in_leaf, int cell, int band, float* out,
              float* total) const;
  float dot(const Coefficients& a, const float* lobe) const;
  void add_lobes(const Coefficients* shapes, const FacePowers& powers, float* cell) const;

  const VoxelGrid& voxels;
  const CellVolumes& cells;
  Scheme scheme;
  SchemeOptions::Injection injection;
  int coefficients;
  LobeWave wave;
  LobeSum sum;
  std::vector<std::unique_ptr<LeafSurfaces>> surfaces;  // by number of leaf, gaitatzes2010 only
};

PulseVolumeCpu::Data::Data(const VoxelGrid& v, const CellVolumes& c, const SchemeOptions& options)
    : voxels(v),
      cells(c),
      scheme(options.scheme),
      injection(options.injection),
      coefficients(options.sh_order == 1 ? 4 : 9),
      wave(LeafNumbers(v.grid().cells), coefficients),
      sum(wave.numbers(), coefficients),
      surfaces(size_t(wave.numbers().count())) {
  assert(!carries_sides(scheme) && (options.sh_order == 1 || options.sh_order == 2));
  if (scheme == Scheme::gaitatzes2010) surfaces = collect_surfaces(cells, wave.numbers(), options.constant_albedo);
}

namespace {

/// Power and lit rows of a leaf that a pass has written.
void look_at(const float* lobes, LeafLight& light) {
  light = {};
  for (int band = 0; band < kLobeBands; ++band) {
    const float* power = lobes + lobe_block(0, band);
    double total = 0.0;
    for (int cell = 0; cell < kLobeLeafCells; ++cell) {
      if (power[cell] <= 0.0f) continue;
      total += double(power[cell]);
      const std::uint64_t row = std::uint64_t(1) << (cell >> 3);
      light.lit_rows |= row;
      if ((cell & 7) == 0) light.lit_low |= row;
      if ((cell & 7) == 7) light.lit_high |= row;
    }
    light.power[band] = float(total);
  }
}

}  // namespace

void PulseVolumeCpu::Data::inject(std::span<const glm::vec4> side_flux) {
  assert(side_flux.size() == voxels.side_count());
  std::vector<std::vector<std::uint32_t>> sides_of(size_t(wave.numbers().count()));
  for (std::uint32_t i = 0; i < side_flux.size(); ++i) {
    if (glm::vec3(side_flux[i]) == glm::vec3(0.0f)) continue;
    const glm::ivec3 cell = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell);
    sides_of[size_t(wave.numbers().number(cell / kLeafCells))].push_back(i);
  }
  std::vector<int> leaves;
  for (int n = 0; n < wave.numbers().count(); ++n) {
    if (!sides_of[size_t(n)].empty()) leaves.push_back(n);
  }
  wave.start(std::move(leaves), [&](int number, float* out, LeafLight& light) {
    std::fill(out, out + wave.now().leaf_floats(), 0.0f);
    for (const std::uint32_t i : sides_of[size_t(number)]) {
      const shared::Side& side = voxels.sides()[i];
      const Coefficients lobe = lobe_about(side.normal, shared::COSINE_ZONAL_1, shared::COSINE_ZONAL_2);
      float* cell = out + leaf_offset(shared::cell_coord(voxels.grid(), side.cell));
      for (int k = 0; k < coefficients; ++k) {
        for (int band = 0; band < kLobeBands; ++band) cell[lobe_block(k, band)] += side_flux[i][band] * lobe[size_t(k)];
      }
    }
    look_at(out, light);
  });
}

bool PulseVolumeCpu::Data::occupied(glm::ivec3 c) const {
  return shared::cell_inside(voxels.grid(), c) &&
         cells.occupancy->tree().getValue(openvdb::Coord(c.x, c.y, c.z)) > 0.0f;
}

glm::vec3 PulseVolumeCpu::Data::radiosity_of_side(std::span<const glm::vec4> side_flux, glm::ivec3 cell,
                                                  int face) const {
  if (!shared::cell_inside(voxels.grid(), cell)) return glm::vec3(0.0f);
  const glm::uvec2 own = voxels.cell_sides(cell);
  if (!shared::has_side(own, face)) return glm::vec3(0.0f);
  const std::uint32_t s = shared::side_index(own, face);
  const float h = voxels.grid().cell_size_m;
  return glm::vec3(side_flux[s]) / std::max(voxels.sides()[s].area_m2, LEAST_SIDE_AREA * h * h);
}

/// Largest radiosity of what sides show of the surfaces in an occupied cell: its own sides, and those of empty cells
/// beside it.
glm::vec3 PulseVolumeCpu::Data::reflected(std::span<const glm::vec4> side_flux, glm::ivec3 cell) const {
  glm::vec3 most(0.0f);
  for (int face = 0; face < 6; ++face) {
    most = glm::max(most, radiosity_of_side(side_flux, cell, face));
    const glm::ivec3 beside = cell + shared::face_step(face);
    if (!occupied(beside)) most = glm::max(most, radiosity_of_side(side_flux, beside, face ^ 1));
  }
  return most;
}

/// As printed: pulse_inject_max.comp.glsl.
void PulseVolumeCpu::Data::inject_max(std::span<const glm::vec4> side_flux) {
  const float h = voxels.grid().cell_size_m;
  std::vector<int> leaves;
  for (auto leaf = cells.occupancy->tree().cbeginLeaf(); leaf; ++leaf) {
    const openvdb::Coord at = leaf->origin();
    leaves.push_back(wave.numbers().number(glm::ivec3(at.x(), at.y(), at.z()) / kLeafCells));
  }
  std::sort(leaves.begin(), leaves.end());
  wave.start(std::move(leaves), [&](int number, float* out, LeafLight& light) {
    std::fill(out, out + wave.now().leaf_floats(), 0.0f);
    const glm::ivec3 first = kLeafCells * wave.numbers().block(number);
    const auto* leaf = cells.occupancy->tree().probeConstLeaf(openvdb::Coord(first.x, first.y, first.z));
    for (auto value = leaf->cbeginValueOn(); value; ++value) {
      const openvdb::Coord at = value.getCoord();
      if (*value <= 0.0f) continue;
      const openvdb::Vec3s n = cells.normal->tree().getValue(at), e = cells.emission->tree().getValue(at);
      const glm::vec3 normal(n[0], n[1], n[2]);
      const bool turned = normal != glm::vec3(0.0f);  // where normals cancel, light leaves to all sides
      const Coefficients lobe = turned ? lobe_about(normal, shared::COSINE_ZONAL_1, shared::COSINE_ZONAL_2)
                                       : lobe_about({0.0f, 0.0f, 1.0f}, 0.0f, 0.0f);
      const glm::vec3 power = h * h * (glm::vec3(e[0], e[1], e[2]) + reflected(side_flux, {at.x(), at.y(), at.z()}));
      float* cell = out + value.pos();
      for (int k = 0; k < coefficients; ++k) {
        for (int band = 0; band < kLobeBands; ++band) cell[lobe_block(k, band)] += power[band] * lobe[size_t(k)];
      }
    }
    look_at(out, light);
  });
}

void PulseVolumeCpu::Data::pass() {
  wave.step([&](int number, float* out, LeafLight& light) { pass_leaf(number, out, light); });
}

void PulseVolumeCpu::Data::pass_leaf(int number, float* out, LeafLight& light) {
  const float* beside[6];
  wave.find_beside(number, beside);
  const float* own = wave.now().leaf(number);
  const LeafSurfaces* in_leaf = surfaces[size_t(number)].get();
  const glm::ivec3 inside = voxels.grid().cells - kLeafCells * wave.numbers().block(number);
  std::fill(out, out + wave.now().leaf_floats(), 0.0f);
  float* sums = scheme == Scheme::lpv2009 || in_leaf != nullptr ? sum.leaf(number) : nullptr;
  for (int cell = 0; cell < kLobeLeafCells; ++cell) {
    const int c[3] = {cell >> 6, (cell >> 3) & 7, cell & 7};
    if (c[0] >= inside.x || c[1] >= inside.y || c[2] >= inside.z) continue;
    static constexpr int kStep[3] = {64, 8, 1};
    const float* lobes[6];
    for (int axis = 0; axis < 3; ++axis) {
      const int step = kStep[axis], across = 7 * step;
      lobes[2 * axis] = c[axis] > 0 ? own + cell - step : beside[2 * axis] + cell + across;
      lobes[2 * axis + 1] = c[axis] < 7 ? own + cell + step : beside[2 * axis + 1] + cell - across;
    }
    for (int band = 0; band < kLobeBands; ++band) {
      const float* around[6];
      for (int face = 0; face < 6; ++face) around[face] = lobes[face] + lobe_block(0, band);
      float* to = out + lobe_block(0, band) + cell;
      float* total = sums != nullptr ? sums + lobe_block(0, band) + cell : nullptr;
      if (scheme == Scheme::lpv2009) {
        spread(around, to, total);
      } else {
        bounce(around, in_leaf, cell, band, to, total);
      }
    }
  }
  look_at(out, light);
}

float PulseVolumeCpu::Data::dot(const Coefficients& a, const float* lobe) const {
  float s = 0.0f;
  for (int k = 0; k < coefficients; ++k) s += a[size_t(k)] * lobe[k * kStride];
  return s;
}

void PulseVolumeCpu::Data::add_lobes(const Coefficients* shapes, const FacePowers& powers, float* cell) const {
  for (int face = 0; face < 6; ++face) {
    if (powers[face] <= 0.0f) continue;
    for (int k = 0; k < coefficients; ++k) cell[k * kStride] += powers[face] * shapes[face][size_t(k)];
  }
}

/// lpv2009: through the five faces that do not touch the neighbour, each handed on as a clamped cosine about the way
/// out.
void PulseVolumeCpu::Data::spread(const float* const lobes[6], float* out, float* total) const {
  FacePowers sent = {};
  for (int from = 0; from < 6; ++from) {
    if (lobes[from][0] <= 0.0f) continue;
    for (int face = 0; face < 6; ++face) {
      if (face != from) sent[face] += std::max(dot(tables().flux[from][face], lobes[from]), 0.0f);
    }
  }
  add_lobes(tables().cosine, sent, out);
  add_lobes(tables().cosine, sent, total);
}

/// gaitatzes2010: into the cone from each neighbour; the occupied share is mirrored, accumulated, and sent on times the
/// albedo.
void PulseVolumeCpu::Data::bounce(const float* const lobes[6], const LeafSurfaces* in_leaf, int cell, int band,
                                  float* out, float* total) const {
  const auto i = size_t(cell);
  const float occupied = in_leaf != nullptr ? in_leaf->occupancy[i] : 0.0f;
  FacePowers sent = {}, bounced = {};
  for (int from = 0; from < 6; ++from) {
    if (lobes[from][0] <= 0.0f) continue;
    const float power = std::max(dot(tables().into_cone[from], lobes[from]), 0.0f);
    const int ahead = from ^ 1;
    sent[ahead] += (1.0f - occupied) * power;
    if (occupied > 0.0f) bounced[((in_leaf->turns[i] >> ahead) & 1) != 0 ? from : ahead] += occupied * power;
  }
  if (occupied > 0.0f) {
    add_lobes(tables().cone, bounced, total);
    for (int face = 0; face < 6; ++face) sent[face] += in_leaf->albedo[i][band] * bounced[face];
  }
  add_lobes(tables().cone, sent, out);
}

PulseVolumeCpu::PulseVolumeCpu(const VoxelGrid& voxels, const CellVolumes& cells, const SchemeOptions& options)
    : data_(std::make_unique<Data>(voxels, cells, options)) {}
PulseVolumeCpu::~PulseVolumeCpu() = default;

BounceReport PulseVolumeCpu::run(std::span<const glm::vec4> side_flux, int iterations) {
  BounceReport report;
  data_->sum.clear();
  data_->injection == SchemeOptions::Injection::max ? data_->inject_max(side_flux) : data_->inject(side_flux);
  report.sent = glm::vec3(data_->wave.in_flight());
  for (; report.passes < iterations; ++report.passes) data_->pass();
  report.left = glm::vec3(data_->wave.in_flight());
  return report;
}

RadianceVolume PulseVolumeCpu::radiance() const {
  // gaitatzes2010 keeps light mirrored, to be read with the surface's own normal: the other way round for -n.
  return data_->sum.radiance(data_->voxels.grid(), data_->scheme == Scheme::gaitatzes2010 ? -1.0f : 1.0f);
}

size_t PulseVolumeCpu::bytes_for(const Grid& grid, const SchemeOptions& options, size_t blocks) {
  const LeafNumbers numbers(grid.cells);
  const int coefficients = options.sh_order == 1 ? 4 : 9;
  const bool bounces = options.scheme == Scheme::gaitatzes2010;  // light is added up where surfaces are
  return LobeWave::bytes_for(numbers, coefficients) +
         LobeSum::bytes_for(numbers, coefficients, bounces ? blocks : size_t(numbers.count())) +
         (bounces ? blocks * sizeof(LeafSurfaces) : 0);
}

size_t PulseVolumeCpu::bytes() const {
  size_t surfaces = 0;
  for (const auto& s : data_->surfaces) surfaces += s ? sizeof(LeafSurfaces) : 0;
  return data_->wave.bytes() + data_->sum.bytes() + surfaces;
}

}  // namespace volgi
