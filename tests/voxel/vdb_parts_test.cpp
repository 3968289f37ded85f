// Files of several ranks as one: the same bytes as a file made at once.
#include "voxel/vdb_parts.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/error.h"

namespace volgi::test {
namespace {

namespace fs = std::filesystem;

class VdbParts : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / "volgi_vdb_parts";
    fs::create_directories(folder_);
    openvdb::initialize();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Leaves along y with 8 <= ... of which rank `rank` of `ranks` has those with y = rank modulo ranks.
  fs::path write(const std::string& name, int rank, int ranks, double metadata = 1.0) const {
    auto density = openvdb::FloatGrid::create(0.0f);
    auto colour = openvdb::Vec3SGrid::create();
    for (int y = 0; y < 60; ++y) {
      if (ranks > 0 && y % ranks != rank) continue;
      for (int x = 0; x < 20; x += 3) {
        density->tree().setValueOn({8 * x, 8 * y, y}, float(x + y));
        colour->tree().setValueOn({8 * x + 1, 8 * y, y}, openvdb::Vec3s(float(x), float(y), 1.0f));
      }
    }
    density->setName("density");
    colour->setName("colour");
    openvdb::MetaMap of_file;
    of_file.insertMeta("cell_size_m", openvdb::DoubleMetadata(metadata));
    if (ranks > 0) mark_as_part(of_file, rank, ranks);
    write_vdb(folder_ / name, {density, colour}, of_file);
    return folder_ / name;
  }
  static std::string bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder_;
};

TEST_F(VdbParts, SameBytesAsOneFile) {
  const fs::path whole = write("whole.vdb", 0, 0);
  const std::vector<fs::path> parts{write("b.vdb", 1, 3), write("a.vdb", 0, 3), write("c.vdb", 2, 3)};
  const VdbFile merged = merge_parts(parts);
  write_vdb(folder_ / "merged.vdb", {merged.grids.begin(), merged.grids.end()}, merged.metadata);
  EXPECT_EQ(bytes(folder_ / "merged.vdb"), bytes(whole));
  EXPECT_GT(bytes(whole).size(), 1000u);
}

TEST_F(VdbParts, RefusesWhatDoesNotGoTogether) {
  const auto refuses = [&](const std::vector<fs::path>& parts, const std::string& words) {
    try {
      merge_parts(parts);
      FAIL() << words;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
  };
  const fs::path first = write("0.vdb", 0, 2), second = write("1.vdb", 1, 2);
  refuses({}, "no parts");
  refuses({first}, "part 1 of 2 is missing");
  refuses({first, first}, "twice");
  refuses({first, write("other.vdb", 1, 3)}, "not of 2");
  refuses({first, write("else.vdb", 1, 2, 2.0)}, "another export");
  refuses({write("whole.vdb", 0, 0)}, "not one rank's part");
}

}  // namespace
}  // namespace volgi::test
