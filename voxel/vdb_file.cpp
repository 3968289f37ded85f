#include "voxel/vdb_file.h"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi {
namespace {

namespace fs = std::filesystem;

// Header of a file: magic number (8 bytes), file format and library version (3 x 4), whether grids have offsets (1),
// UUID in ASCII.
constexpr std::uint64_t kMagic = 0x56444220;  // OPENVDB_MAGIC
constexpr std::streamoff kOffsetFlagAt = 20;
constexpr std::streamoff kUuidAt = 21;
constexpr std::streamoff kUuidLength = 36;
// First format whose header is as above; OpenVDB reads older ones too.
constexpr std::uint32_t kOldestKnownFormat = 222;

/// io::File without its stream, whose errors it does not look at.
class SeekableArchive : public openvdb::io::Archive {
 public:
  using Archive::write;
};

/// FNV-1a, 128 bits (Fowler, Noll, Vo), as a UUID of version 8, "custom" (RFC 9562, section 5.8).
class ContentUuid {
 public:
  void add(const char* data, size_t size) {
    for (size_t i = 0; i < size; ++i) hash_ = (hash_ ^ static_cast<unsigned char>(data[i])) * kPrime;
  }
  std::string text() const {
    const auto high = std::uint64_t(hash_ >> 64), low = std::uint64_t(hash_);
    const std::uint64_t version = (high & ~0xf000ull) | 0x8000ull;
    const std::uint64_t variant = (low & ~(3ull << 62)) | (2ull << 62);
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", version >> 32, (version >> 16) & 0xffff, version & 0xffff,
                       variant >> 48, variant & 0xffffffffffffull);
  }

 private:
  using Wide = unsigned __int128;
  static constexpr Wide kPrime = (Wide(1) << 88) + 0x13b;
  Wide hash_ = (Wide(0x6c62272e07bb0142ull) << 64) | 0x62b821756295c58dull;
};

void write_content_uuid(const fs::path& path) {
  std::fstream stream;
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  stream.open(path, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(kUuidAt + kUuidLength);
  ContentUuid uuid;
  std::vector<char> block(1 << 20);
  stream.exceptions(std::ios::badbit);
  while (stream.read(block.data(), std::streamsize(block.size())) || stream.gcount() > 0)
    uuid.add(block.data(), size_t(stream.gcount()));
  stream.clear();
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  stream.seekp(kUuidAt);
  stream.write(uuid.text().data(), kUuidLength);
  stream.close();
}

/// OpenVDB makes strings as long as the file says before it reads them. This follows the lengths in the header, the
/// directory and the grids' metadata first, so that none goes beyond the end of the file.
class LengthCheck {
 public:
  explicit LengthCheck(std::istream& stream, std::uint64_t size) : stream_(stream), size_(size) {}

  void run() {
    if (get<std::uint64_t>() != kMagic) throw std::runtime_error("it does not start as an OpenVDB file does");
    if (get<std::uint32_t>() < kOldestKnownFormat) return;
    stream_.seekg(kOffsetFlagAt);
    const bool has_offsets = get<char>() != 0;
    stream_.seekg(kUuidAt + kUuidLength);
    metadata();
    const auto grids = get<std::int32_t>();
    for (std::int32_t i = 0; i < grids; ++i) {
      for (int text = 0; text < 3; ++text) skip_text();  // name, type, name of the grid whose tree it shares
      const auto offsets = get<std::array<std::int64_t, 3>>();
      if (has_offsets && offsets[0] != position()) throw std::runtime_error("a grid is not where the file says");
      get<std::uint32_t>();  // compression
      metadata();
      skip_text();  // kind of transform
      if (!has_offsets) return;
      if (offsets[2] < position() || std::uint64_t(offsets[2]) > size_)
        throw std::runtime_error("a grid ends after the file");
      stream_.seekg(offsets[2]);
    }
  }

 private:
  template <typename Value>
  Value get() {
    Value value;
    stream_.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  std::int64_t position() { return std::int64_t(stream_.tellg()); }
  void skip_text() {
    const auto length = get<std::uint32_t>();
    if (length > size_ - std::uint64_t(position())) throw std::runtime_error("a text is longer than the file");
    stream_.seekg(length, std::ios::cur);
  }
  void metadata() {
    for (auto left = get<std::uint32_t>(); left > 0; --left)
      for (int text = 0; text < 3; ++text) skip_text();  // name, type, value
  }

  std::istream& stream_;
  std::uint64_t size_;
};

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

[[noreturn]] void fail(ExitCode code, const fs::path& path, const std::string& why) {
  throw Error(code, fmt::format("{}: {}", path.string(), one_line(why)));
}

}  // namespace

void label_grid(openvdb::GridBase& grid, const GridLabel& label) {
  grid.setName(label.name);
  grid.setCreator("volgi");
  grid.setGridClass(label.grid_class);
  grid.setSaveFloatAsHalf(false);
  if (grid.valueType().starts_with("vec")) grid.setVectorType(label.vector_type);
  grid.insertMeta(kUnitKey, openvdb::StringMetadata(label.unit));
  grid.insertMeta(kDescriptionKey, openvdb::StringMetadata(label.description));
}

void write_vdb(const fs::path& path, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& file_metadata) {
  openvdb::initialize();
  write_atomically(path, [&](const fs::path& temporary) {
    try {
      std::ofstream stream;
      stream.exceptions(std::ios::badbit | std::ios::failbit);
      stream.open(temporary, std::ios::binary);
      SeekableArchive archive;
      archive.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
      archive.write(stream, grids, true, file_metadata);
      stream.close();
      write_content_uuid(temporary);
    } catch (const std::ios_base::failure&) {
      throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", path.string(),
                                                      errno == 0 ? "the disk may be full" : std::strerror(errno)));
    } catch (const openvdb::Exception& e) {
      throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", path.string(), one_line(e.what())));
    }
  });
}

VdbFile read_vdb(const fs::path& path) {
  openvdb::initialize();
  std::error_code error;
  const std::uint64_t size = fs::file_size(path, error);
  if (error) fail(ExitCode::bad_input, path, "cannot read it: " + error.message());
  try {
    std::ifstream stream;
    // OpenVDB does not ask whether a read succeeded: with these on, none can fail unseen.
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    stream.open(path, std::ios::binary);
    LengthCheck(stream, size).run();
    stream.seekg(0);
    openvdb::io::Stream archive(stream, false);
    VdbFile file;
    file.grids = *archive.getGrids();
    file.metadata = *archive.getMetadata();
    return file;
  } catch (const std::bad_alloc&) {
    fail(ExitCode::over_limit, path, "not enough memory to read it");
  } catch (const std::ios_base::failure&) {
    fail(ExitCode::bad_input, path, "not a complete OpenVDB file: it ends too early or cannot be read");
  } catch (const std::exception& e) {
    fail(ExitCode::bad_input, path, fmt::format("not a sound OpenVDB file: {}", e.what()));
  }
}

}  // namespace volgi
