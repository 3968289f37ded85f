#include "propagation/bounce_checkpoint.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>

#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi {

namespace fs = std::filesystem;

namespace {

constexpr std::array<char, 8> kMagic{'v', 'o', 'l', 'g', 'i', 'b', 'c', '1'};

/// Plain data, so that it can be written as it is.
struct Header {
  std::array<char, 8> magic;
  std::int64_t records;
  std::int32_t pass, orders, passes, converged, conjugate_gradients, solver;
  std::int64_t sides;
  std::array<float, 6> sent_left;
  std::array<double, 12> numbers;  // before, residual, emission, punctual
  std::array<std::int32_t, 3> cells;
};

struct Record {
  std::int32_t cell, face;
  std::array<glm::vec4, BounceCheckpoint::kPowers> powers;
};

Header header_of(const BounceState& s, size_t records) {
  Header h{};
  h.magic = kMagic;
  h.records = std::int64_t(records);
  h.pass = s.pass;
  h.orders = s.report.orders;
  h.passes = s.report.passes;
  h.converged = s.report.converged;
  h.conjugate_gradients = s.report.conjugate_gradients;
  h.solver = s.of.conjugate_gradients;
  h.sides = s.of.sides;
  const glm::dvec3 values[4] = {s.before, s.residual, s.of.emission, s.of.punctual};
  for (int band = 0; band < 3; ++band) {
    h.sent_left[size_t(band)] = s.report.sent[band];
    h.sent_left[3 + size_t(band)] = s.report.left[band];
    for (int i = 0; i < 4; ++i) h.numbers[3 * size_t(i) + size_t(band)] = values[i][band];
    h.cells[size_t(band)] = s.of.cells[band];
  }
  return h;
}

BounceState state_of(const Header& h) {
  BounceState s;
  s.pass = h.pass;
  s.report.orders = h.orders;
  s.report.passes = h.passes;
  s.report.converged = h.converged != 0;
  s.report.conjugate_gradients = h.conjugate_gradients != 0;
  s.of.conjugate_gradients = h.solver;
  s.of.sides = h.sides;
  glm::dvec3* const values[4] = {&s.before, &s.residual, &s.of.emission, &s.of.punctual};
  for (int band = 0; band < 3; ++band) {
    s.report.sent[band] = h.sent_left[size_t(band)];
    s.report.left[band] = h.sent_left[3 + size_t(band)];
    for (int i = 0; i < 4; ++i) (*values[i])[band] = h.numbers[3 * size_t(i) + size_t(band)];
    s.of.cells[band] = h.cells[size_t(band)];
  }
  return s;
}

[[noreturn]] void fail(const fs::path& file, const char* what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", file.string(), what));
}

/// The pass and the number of files of the last whole state.
std::optional<std::pair<int, int>> current(const fs::path& folder) {
  std::ifstream in(folder / "current");
  std::pair<int, int> found;
  if (!(in >> found.first >> found.second)) return {};
  return found;
}

}  // namespace

BounceCheckpoint::BounceCheckpoint(fs::path folder, int every, const Ranks* ranks)
    : folder_(std::move(folder)), every_(every), ranks_(ranks) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_))
    throw Error(ExitCode::cannot_write, folder_.string() + ": cannot make this folder for checkpoints");
}

fs::path BounceCheckpoint::file(int pass, int rank) const { return folder_ / fmt::format("{}.{}.part", pass, rank); }

bool BounceCheckpoint::load(const VoxelGrid& voxels, BounceState& state,
                            const std::array<Powers*, kPowers>& powers) const {
  const auto last = current(folder_);
  if (!last) return false;
  const BounceState::Of wanted = state.of;
  for (Powers* p : powers) p->assign(voxels.side_count(), glm::vec4(0.0f));
  size_t found = 0;
  for (int rank = 0; rank < last->second; ++rank) {
    const fs::path path = file(last->first, rank);
    std::ifstream in(path, std::ios::binary);
    Header header;
    if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != kMagic)
      fail(path, "not a checkpoint of volgi");
    state = state_of(header);
    if (!(state.of == wanted))
      fail(path, "a checkpoint of another scene, of other lights or options; name another folder, or empty this one");
    for (std::int64_t i = 0; i < header.records; ++i) {
      Record record;
      if (!in.read(reinterpret_cast<char*>(&record), sizeof record)) fail(path, "damaged: it ends too early");
      const glm::ivec3 cell = shared::cell_coord(voxels.grid(), record.cell);
      if (!shared::cell_inside(voxels.grid(), cell) || record.face < 0 || record.face > 5)
        fail(path, "damaged: a side in it is in no cell");
      if (!voxels.part().contains(cell / kLeafCells)) continue;
      const glm::uvec2 own = voxels.cell_sides(cell);
      if (!shared::has_side(own, record.face)) fail(path, "damaged: a side in it is not there");
      ++found;
      for (size_t p = 0; p < powers.size(); ++p) (*powers[p])[shared::side_index(own, record.face)] = record.powers[p];
    }
  }
  if (found != voxels.side_count()) fail(folder_, "damaged: some sides are in none of its files");
  return true;
}

void BounceCheckpoint::keep(const VoxelGrid& voxels, const BounceState& state,
                            const std::array<const Powers*, kPowers>& powers) {
  if (state.pass % every_ != 0) return;
  const int rank = ranks_ != nullptr ? ranks_->rank() : 0;
  write_atomically(file(state.pass, rank), [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    const Header header = header_of(state, voxels.side_count());
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      Record record{voxels.sides()[i].cell, voxels.sides()[i].face, {}};
      for (size_t p = 0; p < powers.size(); ++p) record.powers[p] = (*powers[p])[i];
      out.write(reinterpret_cast<const char*>(&record), sizeof record);
    }
    if (!out.flush())
      throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: the disk may be full", temporary.string()));
  });
  if (ranks_ != nullptr) ranks_->gather({});  // all are written
  if (rank > 0) return;
  write_text_atomically(folder_ / "current",
                        fmt::format("{} {}\n", state.pass, ranks_ != nullptr ? ranks_->count() : 1));
  remove_older(state.pass);
}

/// Those of ranks that are at the next one already stay.
void BounceCheckpoint::remove_older(int pass) const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    const std::string name = entry.path().filename().string();
    int of = 0;
    const auto number = std::from_chars(name.data(), name.data() + name.size(), of);
    if (entry.path().extension() == ".part" && number.ec == std::errc() && of < pass) fs::remove(entry.path(), ignored);
  }
}

}  // namespace volgi
