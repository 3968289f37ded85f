#include "voxel/vdb_file.h"

#include <gtest/gtest.h>
#include <nanovdb/util/GridHandle.h>
#include <nanovdb/util/IO.h>
#include <openvdb/io/Stream.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "core/error.h"
#include "voxel/nvdb_file.h"
#include "voxel/vdb_summary.h"
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace volgi {
namespace {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

class VdbFileTest : public testing::Test {
 protected:
  void SetUp() override {
    openvdb::initialize();
    folder_ = fs::path(testing::TempDir()) /
              (std::string("vdb_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path path(const char* name = "grids.vdb") const { return folder_ / name; }
  size_t files() const { return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator())); }

  fs::path folder_;
};

/// A number that no decimal or half holds, of either sign and any size.
float odd_number(std::uint32_t seed) {
  std::mt19937 random(seed);
  const float mantissa = float(random()) * 0x1p-32f - 0.5f;
  return std::ldexp(mantissa, int(random() % 60) - 30);
}

openvdb::FloatGrid::Ptr scalars(int edge) {
  auto grid = openvdb::FloatGrid::create(0.0f);
  auto values = grid->getAccessor();
  std::uint32_t seed = 1;
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i)
        if ((i + 2 * j + 3 * k) % 4 != 0) values.setValue({i - 3, j, k + 5}, odd_number(seed++));
  auto transform = openvdb::math::Transform::createLinearTransform(0.1);
  transform->postTranslate({1.0 / 3.0, -7.5, 1e6});
  grid->setTransform(transform);
  return grid;
}

openvdb::Vec3SGrid::Ptr vectors(int edge) {
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  auto values = grid->getAccessor();
  for (int k = 0; k < edge; ++k)
    for (int i = 0; i < edge; ++i) {
      const auto seed = std::uint32_t(3 * (i + edge * k));
      values.setValue({i, k, k}, {odd_number(seed), odd_number(seed + 1), odd_number(seed + 2)});
    }
  return grid;
}

openvdb::GridCPtrVec small_grids(int edge) {
  auto occupancy = scalars(edge);
  auto albedo = vectors(edge), normal = vectors(edge / 2);
  label_grid(*occupancy, {"occupancy", "1", "share of light that is stopped", openvdb::GRID_FOG_VOLUME});
  label_grid(*albedo, {"albedo", "1", "mean albedo"});
  label_grid(*normal, {"normal", "1", "mean normal", openvdb::GRID_UNKNOWN, openvdb::VEC_COVARIANT_NORMALIZE});
  return {occupancy, albedo, normal};
}

openvdb::MetaMap small_metadata() {
  openvdb::MetaMap metadata;
  metadata.insertMeta("scene", openvdb::StringMetadata("cornell"));
  metadata.insertMeta("iterations", openvdb::Int32Metadata(17));
  metadata.insertMeta("cell_size_m", openvdb::DoubleMetadata(1.0 / 3.0));
  return metadata;
}

template <typename GridType>
void expect_same_cells(const openvdb::GridBase& a, const openvdb::GridBase& b) {
  const auto& left = static_cast<const GridType&>(a);
  const auto& right = static_cast<const GridType&>(b);
  ASSERT_TRUE(left.tree().hasSameTopology(right.tree()));
  auto r = right.cbeginValueAll();
  for (auto l = left.cbeginValueAll(); l; ++l, ++r) {
    ASSERT_TRUE(r);
    ASSERT_EQ(l.isValueOn(), r.isValueOn());
    ASSERT_EQ(l.getCoord(), r.getCoord());
    ASSERT_EQ(*l, *r) << l.getCoord();
  }
  EXPECT_FALSE(r);
}

TEST_F(VdbFileTest, ReadsBackBitExact) {
  const openvdb::GridCPtrVec grids = small_grids(19);
  write_vdb(path(), grids, small_metadata());
  const VdbFile file = read_vdb(path());
  ASSERT_EQ(file.grids.size(), grids.size());
  for (size_t i = 0; i < grids.size(); ++i) {
    EXPECT_EQ(file.grids[i]->getName(), grids[i]->getName());
    EXPECT_EQ(file.grids[i]->transform(), grids[i]->transform());
    EXPECT_FALSE(file.grids[i]->saveFloatAsHalf());
    for (auto it = grids[i]->beginMeta(); it != grids[i]->endMeta(); ++it) {
      const auto read = (*file.grids[i])[it->first];
      ASSERT_TRUE(read) << it->first;
      EXPECT_EQ(*read, *it->second) << it->first;
    }
  }
  expect_same_cells<openvdb::FloatGrid>(*grids[0], *file.grids[0]);
  expect_same_cells<openvdb::Vec3SGrid>(*grids[1], *file.grids[1]);
  expect_same_cells<openvdb::Vec3SGrid>(*grids[2], *file.grids[2]);
  EXPECT_EQ(file.metadata.metaValue<std::string>("scene"), "cornell");
  EXPECT_EQ(file.metadata.metaValue<std::int32_t>("iterations"), 17);
  EXPECT_EQ(file.metadata.metaValue<double>("cell_size_m"), 1.0 / 3.0);
  EXPECT_FALSE(file.grids[0]->metaValue<bool>("is_saved_as_half_float"));
}

TEST_F(VdbFileTest, SameGridsGiveSameBytes) {
  write_vdb(path("a.vdb"), small_grids(9), small_metadata());
  write_vdb(path("b.vdb"), small_grids(9), small_metadata());
  const std::string a = read_bytes(path("a.vdb"));
  EXPECT_EQ(a, read_bytes(path("b.vdb")));
  const VdbFile file = read_vdb(path("a.vdb"));
  write_vdb(path("again.vdb"), {file.grids.begin(), file.grids.end()}, file.metadata);
  EXPECT_EQ(a, read_bytes(path("again.vdb")));
}

TEST_F(VdbFileTest, UuidFollowsFromContent) {
  openvdb::MetaMap other = small_metadata();
  other.insertMeta("scene", openvdb::StringMetadata("cornelL"));
  write_vdb(path("a.vdb"), small_grids(9), small_metadata());
  write_vdb(path("b.vdb"), small_grids(9), other);
  const std::string a = read_bytes(path("a.vdb")).substr(21, 36), b = read_bytes(path("b.vdb")).substr(21, 36);
  EXPECT_NE(a, b);
  EXPECT_EQ(a.substr(0, 9), "766f6c67-");
  EXPECT_EQ(a[14], '8');  // version: custom
  EXPECT_NE(std::string("89ab").find(a[19]), std::string::npos) << a;
  std::ifstream stream(path("a.vdb"), std::ios::binary);
  openvdb::io::Stream archive(stream, false);
  EXPECT_EQ(archive.getUniqueTag(), a);
}

TEST_F(VdbFileTest, GridsThatShareATreeStillDo) {
  const openvdb::FloatGrid::Ptr one = scalars(9);
  const openvdb::GridBase::Ptr other = one->copyGrid();
  label_grid(*one, {"one", "1", ""});
  label_grid(*other, {"other", "W", ""});
  write_vdb(path(), {one, other}, {});
  const VdbFile file = read_vdb(path());
  ASSERT_EQ(file.grids.size(), 2u);
  expect_same_cells<openvdb::FloatGrid>(*one, *file.grids[1]);
  EXPECT_EQ(file.grids[1]->constBaseTreePtr(), file.grids[0]->constBaseTreePtr());
}

TEST_F(VdbFileTest, NoGridsIsAFile) {
  write_vdb(path(), {}, small_metadata());
  EXPECT_TRUE(read_vdb(path()).grids.empty());
}

void expect_refused(const fs::path& path, const std::string& what) {
  try {
    read_vdb(path);
    ADD_FAILURE() << "read " << what;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::bad_input) << what;
    EXPECT_EQ(std::string(e.what()).find(path.string()), 0u) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
  }
}

/// One small grid, whose file is short enough to damage anywhere.
std::string few_bytes(const fs::path& path) {
  auto occupancy = scalars(1);
  occupancy->tree().setValue({4, 0, 0}, 0.3f);
  label_grid(*occupancy, {"occupancy", "1", "share of light that is stopped", openvdb::GRID_FOG_VOLUME});
  write_vdb(path, {occupancy}, small_metadata());
  return read_bytes(path);
}

/// Every byte of the header, the metadata and the end, and some of the long masks of mostly nothing between.
template <typename Look>
void at_many_places(const std::string& bytes, Look look) {
  constexpr size_t dense = 1000;
  for (size_t at = 0; at < bytes.size(); at += at < dense || at + dense > bytes.size() ? 1 : 61) look(at);
}

TEST_F(VdbFileTest, RefusesFilesCutAnywhere) {
  const std::string bytes = few_bytes(path());
  at_many_places(bytes, [&](size_t length) {
    write_bytes(path("cut.vdb"), bytes.substr(0, length));
    expect_refused(path("cut.vdb"), "a file cut at " + std::to_string(length));
  });
}

TEST_F(VdbFileTest, RefusesWhatIsNoVdb) {
  expect_refused(path("missing.vdb"), "a missing file");
  expect_refused(folder_, "a folder");
  write_bytes(path("text.vdb"), std::string(200, 'x'));
  expect_refused(path("text.vdb"), "text");
}

TEST_F(VdbFileTest, RefusesFilesDamagedAnywhere) {
  const std::string bytes = few_bytes(path());
  at_many_places(bytes, [&](size_t at) {
    if (at >= 21 && at < 30) return;  // the mark that the UUID is ours: without it, it is not looked at
    std::string damaged = bytes;
    damaged[at] = char(damaged[at] ^ (at % 2 == 0 ? 0x80 : 0x01));
    write_bytes(path("damaged.vdb"), damaged);
    expect_refused(path("damaged.vdb"), "a file damaged at " + std::to_string(at));
  });
}

/// What another program would have written: a UUID that says nothing.
std::string foreign(std::string bytes) { return bytes.replace(21, 36, "00000000-0000-4000-8000-000000000000"); }

TEST_F(VdbFileTest, ReadsFilesOfOtherPrograms) {
  few_bytes(path("ours.vdb"));
  write_bytes(path(), foreign(read_bytes(path("ours.vdb"))));
  EXPECT_EQ(read_vdb(path()).grids.size(), 1u);
}

TEST_F(VdbFileTest, RefusesFilesOfOtherProgramsCutAnywhere) {
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler nodes_that_openvdb_drops_when_reading_one_throws;
#endif
  const std::string bytes = foreign(few_bytes(path()));
  at_many_places(bytes, [&](size_t length) {
    write_bytes(path("cut.vdb"), bytes.substr(0, length));
    expect_refused(path("cut.vdb"), "a foreign file cut at " + std::to_string(length));
  });
}

TEST_F(VdbFileTest, TextsLongerThanTheFileAreNotMade) {
  std::string bytes = foreign(few_bytes(path()));
  const std::uint32_t length = 0xfffffff0u;
  const size_t name = bytes.find("cell_size_m");
  std::memcpy(&bytes[name - sizeof length], &length, sizeof length);
  write_bytes(path(), bytes);
  expect_refused(path(), "a text of 4 GiB");
}

// OpenVDB would read 16 bytes of a value of 12, and take what follows for lengths.
TEST_F(VdbFileTest, ValuesAreAsLongAsTheirTypes) {
  std::string bytes = foreign(few_bytes(path()));
  const size_t type = bytes.find("vec3i");
  ASSERT_NE(type, std::string::npos);
  bytes.replace(type, 5, "vec4i");
  write_bytes(path(), bytes);
  try {
    read_vdb(path());
    ADD_FAILURE() << "it is read";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(e.what()).find("not as long as its type"), std::string::npos) << e.what();
  }
}

TEST_F(VdbFileTest, ListsOfLeavesAreNoLongerThanTheFile) {
  auto grid = openvdb::FloatGrid::create(0.0f);
  grid->getAccessor().setValue({1, 2, 3}, 4.0f);
  write_vdb(path(), {grid}, {});
  const std::string good = foreign(read_bytes(path()));
  const size_t count = good.find("__delayedload") + 13 + 4;  // behind the value's length
  ASSERT_LT(count, good.size());
  for (const size_t at : {count, count + 4}) {  // of leaves, and of bytes
    std::string bytes = good;
    bytes.replace(at, 4, std::string("\0\0\0\4", 4));  // 2^26
    write_bytes(path(), bytes);
    try {
      read_vdb(path());
      ADD_FAILURE() << "it is read";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(e.what()).find("a list in it is"), std::string::npos) << e.what();
    }
  }
  write_bytes(path(), good);
  EXPECT_EQ(read_vdb(path()).grids.size(), 1u);
}

TEST_F(VdbFileTest, SaysWhenItCannotWrite) {
  const fs::path targets[] = {folder_ / "none" / "grids.vdb", folder_};
  for (const fs::path& target : targets) {
    try {
      write_vdb(target, small_grids(6), small_metadata());
      ADD_FAILURE() << target;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::cannot_write);
      EXPECT_NE(std::string(e.what()).find(target.string()), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(files(), 0u);
}

/// NanoVDB: names, transforms and values as in OpenVDB, the same bytes every time.
TEST_F(VdbFileTest, NanoVdbReadsBack) {
  auto scalar = openvdb::FloatGrid::create(0.0f);
  scalar->setName("fluence");
  scalar->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  auto color = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  color->setName("albedo");
  for (int i = 0; i < 500; ++i) {
    const openvdb::Coord at(i % 17, (i * 7) % 23, (i * 3) % 11);
    scalar->getAccessor().setValue(at, float(i));
    color->getAccessor().setValue(at, openvdb::Vec3s(float(i), 0.5f, -1.0f));
  }
  write_nvdb(folder_ / "a.nvdb", {scalar, color});
  write_nvdb(folder_ / "b.nvdb", {scalar, color});
  const auto bytes = [&](const char* name) {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_EQ(bytes("a.nvdb"), bytes("b.nvdb"));
  const auto grids = nanovdb::io::readGrids<nanovdb::HostBuffer, std::vector>((folder_ / "a.nvdb").string());
  ASSERT_EQ(grids.size(), 2u);
  const auto* read = grids[0].grid<float>();
  const auto* colors = grids[1].grid<nanovdb::Vec3f>();
  ASSERT_TRUE(read != nullptr && colors != nullptr);
  EXPECT_STREQ(read->gridName(), "fluence");
  EXPECT_STREQ(colors->gridName(), "albedo");
  EXPECT_EQ(read->activeVoxelCount(), scalar->activeVoxelCount());
  EXPECT_NEAR(read->voxelSize()[0], 0.25, 1e-12);
  auto values = read->getAccessor();
  for (auto it = scalar->cbeginValueOn(); it; ++it) {
    const openvdb::Coord c = it.getCoord();
    EXPECT_EQ(values.getValue({c.x(), c.y(), c.z()}), *it);
  }
  EXPECT_THROW(write_nvdb(folder_ / "none/a.nvdb", {scalar}), Error);
}

TEST(VdbSummaryTest, CountsAndMeasuresActiveCells) {
  openvdb::initialize();
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(-9.0f));
  auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  transform->postTranslate({10.25, 0.25, 0.25});  // cell (0,0,0) is 10 ... 10.5, 0 ... 0.5, 0 ... 0.5
  grid->setTransform(transform);
  label_grid(*grid, {"emission", "W m^-2", "radiosity"});
  auto values = grid->getAccessor();
  values.setValue({0, 0, 0}, {1, 2, 3});
  values.setValue({3, 1, -1}, {-1, 4, 0});
  values.setValue({1, 1, 0}, {6, 0, std::numeric_limits<float>::quiet_NaN()});
  const GridSummary s = summarise(*grid);
  EXPECT_EQ(s.name, "emission");
  EXPECT_EQ(s.type, "vec3s");
  EXPECT_EQ(s.unit, "W m^-2");
  EXPECT_EQ(s.vector_type, "invariant");
  EXPECT_EQ(s.index_box, openvdb::CoordBBox({0, 0, -1}, {3, 1, 0}));
  EXPECT_EQ(s.world_box.min(), openvdb::Vec3d(10.0, 0.0, -0.5));
  EXPECT_EQ(s.world_box.max(), openvdb::Vec3d(12.0, 1.0, 0.5));
  EXPECT_EQ(s.active_cells, 3u);
  EXPECT_EQ(s.active_share, 3.0 / 16.0);
  EXPECT_EQ(s.not_finite, 1u);
  ASSERT_EQ(s.channels.size(), 3u);
  EXPECT_EQ(s.channels[0].minimum, -1.0);
  EXPECT_EQ(s.channels[1].maximum, 4.0);
  EXPECT_EQ(s.channels[1].mean, 3.0);
  EXPECT_EQ(s.channels[2].mean, 1.5);
  EXPECT_NEAR(s.lit_luminance, ((0.2126 + 2 * 0.7152 + 3 * 0.0722) + (-0.2126 + 4 * 0.7152)) / 2, 1e-12);
  EXPECT_GT(s.memory_bytes, 0u);
}

TEST(VdbSummaryTest, ATileCountsAsItsCells) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.0f);
  grid->fill(openvdb::CoordBBox({0, 0, 0}, {7, 7, 7}), 1.0f);
  grid->tree().setValue({8, 0, 0}, 513.0f);
  const GridSummary s = summarise(*grid);
  EXPECT_EQ(s.active_cells, 513u);
  EXPECT_EQ(s.channels.at(0).mean, 1025.0 / 513.0);
}

TEST(VdbSummaryTest, DeviationHistogramAndWhatIsNoNumber) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create();
  auto values = grid->getAccessor();
  for (int i = 0; i < 8; ++i) values.setValue({i, 0, 0}, float(i));  // 0 ... 7
  values.setValue({8, 0, 0}, std::numeric_limits<float>::quiet_NaN());
  values.setValue({9, 0, 0}, -std::numeric_limits<float>::infinity());
  const GridSummary s = summarise(*grid);
  EXPECT_EQ(s.not_finite, 2u);
  EXPECT_EQ(s.not_a_number, 1u);
  EXPECT_DOUBLE_EQ(s.channels.at(0).mean, 3.5);
  EXPECT_NEAR(s.channels[0].deviation, std::sqrt(21.0 / 4.0), 1e-12);
  EXPECT_EQ(histogram(*grid, s, 0, 4), (std::vector<std::uint64_t>{2, 2, 2, 2}));
  EXPECT_EQ(histogram(*grid, s, 0, 7), (std::vector<std::uint64_t>{1, 1, 1, 1, 1, 1, 2}));
}

TEST(VdbSummaryTest, AnEmptyGridHasNoRange) {
  openvdb::initialize();
  const GridSummary s = summarise(*openvdb::FloatGrid::create(1.0f));
  EXPECT_EQ(s.active_cells, 0u);
  EXPECT_EQ(s.active_share, 0.0);
  EXPECT_TRUE(s.channels.empty());
}

}  // namespace
}  // namespace volgi
