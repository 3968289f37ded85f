// The CPU's sweeps against a plain one in double precision, and what the operator must be: conserving, positive,
// reciprocal, linear, the same for turned voxels and for any number of threads.
#include "propagation/transport_ordinates_cpu.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <cstring>
#include <glm/gtc/constants.hpp>
#include <ostream>

#include "core/error.h"
#include "tests/propagation/plain_sweep.h"
#include "tests/propagation/synthetic_voxels.h"

namespace volgi {
void PrintTo(const OrdinateChoice& c, std::ostream* out) {
  *out << (c.rule == Ordinates::step ? "step" : "characteristic") << c.directions;
}
namespace {

using test::closed_box;
using test::make_voxels;
using test::Plain;
using test::PlainSweep;
using test::Powers;
using test::random_faces;
using test::random_powers;

Powers carry(TransportCpu& transport, const Powers& sent) {
  Powers received(sent.size(), glm::vec4(0.0f));
  BounceReport report;
  transport.carry(sent, received, BounceRules{}, report);
  EXPECT_EQ(report.passes, 1);
  return received;
}

Powers carry(const VoxelGrid& voxels, OrdinateChoice choice, const Powers& sent) {
  OrdinatesTransportCpu transport(voxels, choice);
  return carry(transport, sent);
}

class OrdinatesCpu : public testing::TestWithParam<OrdinateChoice> {};
constexpr Ordinates kStep = Ordinates::step, kCharacteristic = Ordinates::characteristic;
INSTANTIATE_TEST_SUITE_P(All, OrdinatesCpu,
                         testing::Values(OrdinateChoice{8, kStep}, OrdinateChoice{24, kStep}, OrdinateChoice{48, kStep},
                                         OrdinateChoice{128, kStep}, OrdinateChoice{8, kCharacteristic},
                                         OrdinateChoice{24, kCharacteristic}, OrdinateChoice{48, kCharacteristic},
                                         OrdinateChoice{80, kCharacteristic}, OrdinateChoice{128, kCharacteristic},
                                         OrdinateChoice{512, kStep}, OrdinateChoice{512, kCharacteristic}),
                         [](const auto& p) { return testing::PrintToString(p.param); });

void expect_near(const Powers& a, const std::vector<glm::dvec3>& b, double relative) {
  ASSERT_EQ(a.size(), b.size());
  double largest = 0.0, error = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (int band = 0; band < 3; ++band) {
      largest = std::max(largest, b[i][band]);
      error = std::max(error, std::abs(double(a[i][band]) - b[i][band]));
    }
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LE(error, relative * largest);
}

// Grids whose blocks are cut on every axis, with walls that are partly missing, and partly covered faces inside; every
// variant of the kernels.
TEST_P(OrdinatesCpu, AgreesWithPlainSweep) {
  for (glm::ivec3 cells : {glm::ivec3(8, 8, 8), glm::ivec3(11, 17, 9), glm::ivec3(1, 5, 20)}) {
    const VoxelGrid voxels = make_voxels(cells, 0.25f, random_faces(cells, 0.7f, 0.1f, 5));
    const Powers sent = random_powers(voxels.side_count(), 6);
    const Plain plain = PlainSweep(voxels, GetParam(), sent).result();
    const sweep::Available available = sweep::available();
    for (int k = 0; k < available.count; ++k) {
      SCOPED_TRACE(available.kernels[k].name);
      OrdinatesTransportCpu transport(voxels, GetParam(), &available.kernels[k]);
      expect_near(carry(transport, sent), plain.received, 2e-6);
      // A second order adds, and finds nothing left over of the first.
      Powers received(sent.size(), glm::vec4(1.0f, 1.0f, 1.0f, 7.0f));
      BounceReport report;
      transport.carry(sent, received, BounceRules{}, report);
      for (glm::vec4& r : received) {
        EXPECT_EQ(r.w, 7.0f);
        r -= 1.0f;
      }
      expect_near(received, plain.received, 1e-5);
    }
    glm::dvec3 arrived = plain.left;
    for (const glm::dvec3& r : plain.received) arrived += r;
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(arrived[band] / test::sum(sent)[band], 1.0, 1e-6);
  }
}

TEST_P(OrdinatesCpu, RadianceAgreesWithPlainSweep) {
  const glm::ivec3 cells(9, 8, 5);
  const VoxelGrid voxels = make_voxels(cells, 0.5f, random_faces(cells, 0.5f, 0.1f, 15));
  const Powers sent = random_powers(voxels.side_count(), 16);
  const Plain plain = PlainSweep(voxels, GetParam(), sent).result();
  const sweep::Available available = sweep::available();
  for (int k = 0; k < available.count; ++k) {
    OrdinatesTransportCpu transport(voxels, GetParam(), &available.kernels[k]);
    const RadianceVolume volume = transport.radiance(sent);
    ASSERT_EQ(volume.sh.size(), 4u);
    for (size_t m = 0; m < 4; ++m) {
      double error = 0.0, largest = 0.0;
      auto accessor = volume.sh[m]->getConstAccessor();
      for (int i = 0; i < int(plain.sh.size()); ++i) {
        const glm::ivec3 c = shared::cell_coord(voxels.grid(), i);
        const openvdb::Vec3s value = accessor.getValue({c.x, c.y, c.z});
        for (int band = 0; band < 3; ++band) {
          largest = std::max(largest, plain.sh[size_t(i)][0][band]);
          error = std::max(error, std::abs(double(value[band]) - plain.sh[size_t(i)][m][band]));
        }
      }
      EXPECT_LE(error, 2e-6 * largest) << available.kernels[k].name << ' ' << sh_grid_name(int(m));
    }
  }
}

// Void: what a side sends arrives on the walls, to rounding, and walls that stop a part lose nothing of the rest.
TEST_P(OrdinatesCpu, PowerIsKept) {
  const glm::ivec3 cells(20, 9, 33);
  const test::Coverage inner = random_faces(cells, 1.0f, 0.03f, 9);
  for (bool furnished : {false, true}) {
    const VoxelGrid voxels = make_voxels(cells, 0.1f, [&](int axis, glm::ivec3 c) {
      if (c[axis] == 0 || c[axis] == cells[axis]) return 1.0f;
      return furnished ? inner(axis, c) : 0.0f;
    });
    Powers sent(voxels.side_count(), glm::vec4(0.0f));
    sent[sent.size() / 3] = {1.0f, 2.0f, 1e-3f, 0.0f};
    const Powers received = carry(voxels, GetParam(), sent);
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(test::sum(received)[band] / test::sum(sent)[band], 1.0, 1e-5);
    for (const glm::vec4& r : received) EXPECT_TRUE(glm::all(glm::greaterThanEqual(r, glm::vec4(0.0f))));
  }
}

double dot_over_coverage(const VoxelGrid& voxels, const Powers& a, const Powers& received) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    sum += glm::dot(glm::dvec3(a[i]), glm::dvec3(received[i])) / double(voxels.sides()[i].coverage);
  }
  return sum;
}

TEST_P(OrdinatesCpu, IsReciprocalAndLinear) {
  const glm::ivec3 cells(12, 7, 19);
  const VoxelGrid voxels = make_voxels(cells, 0.3f, random_faces(cells, 0.8f, 0.1f, 21));
  const Powers a = random_powers(voxels.side_count(), 22), b = random_powers(voxels.side_count(), 23);
  OrdinatesTransportCpu transport(voxels, GetParam());
  const Powers ka = carry(transport, a), kb = carry(transport, b);
  EXPECT_NEAR(dot_over_coverage(voxels, b, ka) / dot_over_coverage(voxels, a, kb), 1.0, 1e-6);
  Powers both(a.size());
  std::vector<glm::dvec3> sum(a.size());
  for (size_t i = 0; i < a.size(); ++i) {
    both[i] = a[i] + 3.0f * b[i];
    sum[i] = glm::dvec3(ka[i]) + 3.0 * glm::dvec3(kb[i]);
  }
  expect_near(carry(transport, both), sum, 2e-6);
}

// A closed emitting box, order by order: L_e / (1 - rho) everywhere.
TEST_P(OrdinatesCpu, Furnace) {
  const glm::ivec3 cells(10, 8, 13);
  const float rho = 0.8f, h = 0.2f;
  const VoxelGrid voxels = closed_box(cells, h, rho);
  OrdinatesTransportCpu transport(voxels, GetParam());
  Powers total(voxels.side_count(), glm::vec4(0.0f)), sent(voxels.side_count());
  const glm::vec3 radiosity(glm::pi<float>());
  for (size_t i = 0; i < sent.size(); ++i) {
    const shared::Side& s = voxels.sides()[i];
    sent[i] = glm::vec4(shared::side_sent_power(s.area_m2 * radiosity, s.albedo, s.area_m2, s.face_m2), 0.0f);
  }
  for (int order = 0; order < 60; ++order) {
    const Powers received = carry(transport, sent);
    for (size_t i = 0; i < sent.size(); ++i) {
      const shared::Side& s = voxels.sides()[i];
      total[i] += received[i];
      sent[i] = glm::vec4(shared::side_returned_fraction(s.albedo, s.area_m2, s.face_m2), 0.0f) * received[i];
    }
  }
  for (size_t i = 0; i < total.size(); ++i) {
    const shared::Side& s = voxels.sides()[i];
    const glm::vec3 irradiance = shared::side_irradiance(glm::vec3(total[i]), s.area_m2 * radiosity, s.albedo, s.normal,
                                                         shared::face_axis(s.face), s.area_m2, s.face_m2);
    for (int band = 0; band < 3; ++band) {
      const float radiance = (radiosity[band] + s.albedo[band] * irradiance[band]) / glm::pi<float>();
      EXPECT_NEAR(radiance * (1.0f - s.albedo[band]), 1.0f, 1e-4f);
    }
  }
}

/// Axis a of the turned voxels is axis (a+1) % 3 of the others, turned round on two axes: a rotation by 90 degrees.
struct Turn {
  int quarter_axis;  // axis of the rotation
  glm::ivec3 cells;  // before
  glm::ivec3 turned_cells() const {
    glm::ivec3 t = cells;
    std::swap(t[(quarter_axis + 1) % 3], t[(quarter_axis + 2) % 3]);
    return t;
  }
  /// b' = -c, c' = b
  glm::ivec3 turn(glm::ivec3 c) const {
    glm::ivec3 t = c;
    const int b = (quarter_axis + 1) % 3, d = (quarter_axis + 2) % 3;
    t[b] = cells[d] - 1 - c[d];
    t[d] = c[b];
    return t;
  }
  int turn_face(int face) const {
    const glm::ivec3 step = turn(shared::face_step(face)) - turn(glm::ivec3(0));
    for (int f = 0; f < 6; ++f) {
      if (shared::face_step(f) == step) return f;
    }
    return -1;
  }
};

TEST_P(OrdinatesCpu, TurnedVoxelsGiveTheSame) {
  const glm::ivec3 cells(9, 12, 7);
  const VoxelGrid voxels = make_voxels(cells, 0.3f, random_faces(cells, 0.8f, 0.1f, 31));
  const Powers sent = random_powers(voxels.side_count(), 32);
  const Powers received = carry(voxels, GetParam(), sent);
  for (int axis = 0; axis < 3; ++axis) {
    const Turn turn{axis, cells};
    Grid turned_grid = voxels.grid();
    turned_grid.cells = turn.turned_cells();
    std::vector<std::pair<shared::Side, size_t>> turned;
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      shared::Side s = voxels.sides()[i];
      s.cell = shared::cell_index(turned_grid, turn.turn(shared::cell_coord(voxels.grid(), s.cell)));
      s.face = turn.turn_face(s.face);
      turned.emplace_back(s, i);
    }
    std::sort(turned.begin(), turned.end(), [](const auto& a, const auto& b) {
      return std::pair(a.first.cell, a.first.face) < std::pair(b.first.cell, b.first.face);
    });
    std::vector<shared::Side> sides;
    Powers turned_sent;
    std::vector<glm::dvec3> expected;
    for (const auto& [side, i] : turned) {
      sides.push_back(side);
      turned_sent.push_back(sent[i]);
      expected.emplace_back(received[i]);
    }
    const VoxelGrid turned_voxels(turned_grid, sides);
    expect_near(carry(turned_voxels, GetParam(), turned_sent), expected, 1e-5);
  }
}

TEST_P(OrdinatesCpu, SameBytesForAnyNumberOfThreads) {
  const glm::ivec3 cells(30, 41, 25);
  const VoxelGrid voxels = make_voxels(cells, 0.3f, random_faces(cells, 0.8f, 0.05f, 41));
  const Powers sent = random_powers(voxels.side_count(), 42);
  std::vector<Powers> received;
  std::vector<RadianceVolume> radiance;
  for (size_t threads : {1, 2, 3}) {  // three do not share octants evenly: rows of blocks are shared out too
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    OrdinatesTransportCpu transport(voxels, GetParam());
    received.push_back(carry(transport, sent));
    radiance.push_back(transport.radiance(sent));
  }
  for (size_t i = 1; i < received.size(); ++i) {
    EXPECT_EQ(std::memcmp(received[0].data(), received[i].data(), sizeof(glm::vec4) * sent.size()), 0);
    for (size_t m = 0; m < 4; ++m) {
      EXPECT_TRUE(radiance[0].sh[m]->tree().hasSameTopology(radiance[i].sh[m]->tree()));
      for (auto a = radiance[0].sh[m]->cbeginValueOn(); a; ++a) {
        ASSERT_EQ(*a, radiance[i].sh[m]->tree().getValue(a.getCoord()));
      }
    }
  }
}

// All walls send as isotropic radiance L does: sh_00 is sqrt(4 pi) L and nothing else is there, in every cell.
TEST_P(OrdinatesCpu, IsotropicRadiance) {
  const glm::ivec3 cells(11, 8, 9);
  const float h = 0.125f, radiance = 3.0f;
  const VoxelGrid voxels = closed_box(cells, h);
  const Powers sent(voxels.side_count(), glm::vec4(glm::vec3(glm::pi<float>() * radiance * h * h), 0.0f));
  OrdinatesTransportCpu transport(voxels, GetParam());
  const RadianceVolume volume = transport.radiance(sent);
  const float expected = std::sqrt(4.0f * glm::pi<float>()) * radiance;
  EXPECT_EQ(volume.sh[0]->activeVoxelCount(), cell_count(voxels.grid()));
  for (size_t m = 0; m < 4; ++m) {
    EXPECT_EQ(volume.sh[m]->getName(), sh_grid_name(int(m)));
    for (auto v = volume.sh[m]->cbeginValueOn(); v; ++v) {
      for (int band = 0; band < 3; ++band) EXPECT_NEAR((*v)[band], m == 0 ? expected : 0.0f, 1e-5f * expected);
    }
  }
  const openvdb::Vec3s f = fluence(volume)->tree().getValue({3, 3, 3});
  EXPECT_NEAR(f[0], 4.0f * glm::pi<float>() * radiance, 1e-3f);
  const openvdb::Vec3d centre = volume.sh[0]->indexToWorld(openvdb::Coord(0, 1, 2));
  EXPECT_NEAR(centre[2], 2.5 * double(h), 1e-6);
}

// A wall across the grid: nothing gets through, and what is dark is left out of the volume.
TEST(OrdinatesTransportCpu, SourcesHaveDirectionsOfTheirOwn) {
  const glm::ivec3 cells(11, 17, 9);
  const VoxelGrid voxels = make_voxels(cells, 0.25f, random_faces(cells, 0.7f, 0.1f, 5));
  const Powers sent = random_powers(voxels.side_count(), 8);
  const OrdinateChoice all{128, kStep}, sources{512, kCharacteristic};
  OrdinatesTransportCpu transport(voxels, all, nullptr, nullptr, {}, sources);
  for (const bool of_sources : {true, false, true}) {
    transport.carry_sources(of_sources);
    EXPECT_EQ(carry(transport, sent), carry(voxels, of_sources ? sources : all, sent));
  }
}

TEST(OrdinatesTransportCpu, DarkRoomStaysDark) {
  const glm::ivec3 cells(40, 16, 16);
  const VoxelGrid voxels = make_voxels(cells, 0.1f, [cells](int axis, glm::ivec3 c) {
    return c[axis] == 0 || c[axis] == cells[axis] || (axis == 0 && c.x == 19) ? 1.0f : 0.0f;
  });
  Powers sent(voxels.side_count(), glm::vec4(0.0f));
  for (size_t i = 0; i < sent.size(); ++i) {
    if (shared::cell_coord(voxels.grid(), voxels.sides()[i].cell).x < 19) sent[i] = glm::vec4(1.0f);
  }
  for (OrdinateChoice choice : {OrdinateChoice{24, kStep}, OrdinateChoice{48, kCharacteristic}}) {
    OrdinatesTransportCpu transport(voxels, choice);
    const Powers received = carry(transport, sent);
    for (size_t i = 0; i < sent.size(); ++i) {
      const bool lit = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell).x < 19;
      EXPECT_EQ(received[i].x > 0.0f, lit);
    }
    // Then the other room: nothing of the orders before is left in this one.
    Powers other(sent.size());
    for (size_t i = 0; i < sent.size(); ++i) other[i] = glm::vec4(1.0f) - sent[i];
    const Powers later = carry(transport, other);
    for (size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(later[i].x > 0.0f, sent[i].x == 0.0f);
    const RadianceVolume volume = transport.radiance(sent);
    EXPECT_EQ(volume.sh[0]->activeVoxelCount(), 19u * 16u * 16u);
    EXPECT_EQ(volume.sh[3]->activeVoxelCount(), 19u * 16u * 16u);
  }
}

TEST(OrdinatesTransportCpu, EmptyAndTinyGrids) {
  for (glm::ivec3 cells : {glm::ivec3(1), glm::ivec3(1, 1, 30), glm::ivec3(9, 1, 1)}) {
    const VoxelGrid voxels = closed_box(cells, 1.0f);
    const Powers sent = random_powers(voxels.side_count(), 3);
    const Powers received = carry(voxels, OrdinateChoice{}, sent);
    EXPECT_NEAR(test::sum(received).x / test::sum(sent).x, 1.0, 1e-5);
    const VoxelGrid nothing(voxels.grid(), {});
    EXPECT_TRUE(carry(nothing, OrdinateChoice{}, {}).empty());
  }
}

TEST(MakeTransport, RefusesWhatThereIsNot) {
  const VoxelGrid voxels = closed_box(glm::ivec3(4), 1.0f);
  SchemeOptions options;
  EXPECT_TRUE(make_transport(voxels, options)->linear());
  options.directions = 26;
  EXPECT_THROW(make_transport(voxels, options), Error);
  options = {};
  options.scheme = Scheme::lpv2009;
  EXPECT_THROW(make_transport(voxels, options), Error);
}

}  // namespace
}  // namespace volgi
