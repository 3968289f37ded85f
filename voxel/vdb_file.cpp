#include "voxel/vdb_file.h"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/one_line.h"

namespace volgi {
namespace {

namespace fs = std::filesystem;

// Header of a file: magic number (8 bytes), file format and library version (3 x 4), whether grids have offsets (1),
// UUID in ASCII.
constexpr std::uint64_t kMagic = 0x56444220;  // OPENVDB_MAGIC
constexpr std::streamoff kUuidAt = 21;
constexpr std::streamoff kUuidLength = 36;
// A list of sizes, of any length.
constexpr const char* DELAYED_LOAD = "__delayedload";
// First format whose grids say their own compression (2013).
constexpr std::uint32_t kOldestKnownFormat = 222;

/// io::File without its stream, whose errors it does not look at.
class SeekableArchive : public openvdb::io::Archive {
 public:
  using Archive::write;
};

/// FNV-1a, 128 bits (Fowler, Noll, Vo).
class Hash {
 public:
  void add(const char* data, size_t size) {
    for (size_t i = 0; i < size; ++i) value_ = (value_ ^ static_cast<unsigned char>(data[i])) * kPrime;
  }
  std::uint64_t high() const { return std::uint64_t(value_ >> 64); }
  std::uint64_t low() const { return std::uint64_t(value_); }

 private:
  using Wide = unsigned __int128;
  static constexpr Wide kPrime = (Wide(1) << 88) + 0x13b;
  Wide value_ = (Wide(0x6c62272e07bb0142ull) << 64) | 0x62b821756295c58dull;
};

/// "volg" in ASCII: which files have a UUID that can be checked.
constexpr const char* kUuidStart = "766f6c67-";

/// The hash of all bytes but the UUID's own as a UUID of version 8, "custom" (RFC 9562, section 5.8): 90 bits of it.
std::string content_uuid(std::istream& stream, std::uint64_t size) {
  Hash hash;
  std::vector<char> block(1 << 20);
  const auto add = [&](std::uint64_t from, std::uint64_t to) {
    stream.seekg(std::streamoff(from));
    for (std::uint64_t next = 0; from < to; from += next) {
      next = std::min<std::uint64_t>(block.size(), to - from);
      stream.read(block.data(), std::streamsize(next));
      hash.add(block.data(), size_t(next));
    }
  };
  add(0, kUuidAt);
  add(kUuidAt + kUuidLength, size);
  const std::uint64_t high = hash.high(), low = hash.low();
  return fmt::format("{}{:04x}-8{:03x}-{:04x}-{:012x}", kUuidStart, high & 0xffff, (high >> 16) & 0xfff,
                     0x8000 | ((low >> 48) & 0x3fff), low & 0xffffffffffffull);
}

void write_content_uuid(const fs::path& path) {
  std::fstream stream;
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  stream.open(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string uuid = content_uuid(stream, fs::file_size(path));
  stream.seekp(kUuidAt);
  stream.write(uuid.data(), kUuidLength);
  stream.close();
}

/// OpenVDB's decoders (10.0) write beyond their buffers when a block's length is wrong, so what can be checked is
/// checked before they see it: our own files as a whole.
void check_content(std::istream& stream, std::uint64_t size) {
  std::string uuid(size_t(kUuidLength), '\0');
  stream.seekg(kUuidAt);
  stream.read(uuid.data(), kUuidLength);
  if (uuid.starts_with(kUuidStart) && uuid != content_uuid(stream, size))
    throw std::runtime_error("it has changed since volgi wrote it");
}

/// io::Stream that trusts no length and no place in a file. OpenVDB makes strings as long as the file says before it
/// reads them, and does not ask whether a read succeeded: here every length is held against the size of the file first,
/// and the stream throws.
class Reader : public openvdb::io::Archive {
 public:
  Reader(std::istream& stream, std::uint64_t size) : stream_(stream), size_(size) {}
  ~Reader() override { openvdb::io::clearStreamMetadataPtr(stream_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  VdbFile read() {
    read_header();
    VdbFile file;
    check([&] { check_metadata(); });
    file.metadata.readMeta(stream_);
    NamedGridMap named;
    std::vector<openvdb::io::GridDescriptor> descriptors;
    for (std::int32_t left = readGridCount(stream_); left > 0; --left) {
      descriptors.emplace_back();
      file.grids.push_back(read_grid(descriptors.back()));
      named[descriptors.back().uniqueName()] = file.grids.back();
    }
    for (const auto& descriptor : descriptors) connectInstance(descriptor, named);
    return file;
  }

 private:
  void read_header() {
    check([&] {
      if (get<std::uint64_t>() != kMagic) throw std::runtime_error("it does not start as an OpenVDB file does");
      const auto format = get<std::uint32_t>();
      if (format < kOldestKnownFormat || format > openvdb::OPENVDB_FILE_VERSION)
        throw std::runtime_error(fmt::format("its format is {}, formats {} to {} can be read", format,
                                             kOldestKnownFormat, std::uint32_t(openvdb::OPENVDB_FILE_VERSION)));
    });
    readHeader(stream_);
    openvdb::io::setStreamMetadataPtr(stream_, state_, false);
    openvdb::io::setVersion(stream_, libraryVersion(), fileVersion());
    openvdb::io::setDataCompression(stream_, compression());
  }

  openvdb::GridBase::Ptr read_grid(openvdb::io::GridDescriptor& descriptor) {
    check([&] {
      for (int text = 0; text < 3; ++text) skip_text();  // name, type, name of the grid whose tree it shares
    });
    openvdb::GridBase::Ptr grid = descriptor.read(stream_);
    if (inputHasGridOffsets() && descriptor.getGridPos() != position())
      throw std::runtime_error("a grid is not where its directory says");
    check([&] {
      get<std::uint32_t>();  // compression
      check_metadata();
      skip_text();  // kind of transform
    });
    readGrid(grid, descriptor, stream_);
    if (inputHasGridOffsets() && descriptor.getEndPos() != position())
      throw std::runtime_error("a grid does not end where its directory says");
    return grid;
  }

  /// Looks ahead: the stream is where it was afterwards.
  template <typename Look>
  void check(Look look) {
    const auto start = stream_.tellg();
    look();
    stream_.seekg(start);
  }
  void check_metadata() {
    for (auto left = get<std::uint32_t>(); left > 0; --left) {
      skip_text();  // name
      const std::string type = read_text();
      const auto start = position();
      const auto length = get<std::uint32_t>();
      check_value(type, length);
      if (type == DELAYED_LOAD && length > 0) check_leaf_sizes();
      stream_.seekg(start);
      skip_text();
    }
  }
  /// Of values of one size OpenVDB reads as many bytes as their type has, whatever length the file gives, and takes
  /// what follows for the next one: a length that nobody has looked at.
  static void check_value(const std::string& type, std::uint32_t length) {
    if (type == openvdb::StringMetadata::staticTypeName() || type == DELAYED_LOAD ||
        !openvdb::Metadata::isRegisteredType(type))
      return;
    if (length != openvdb::Metadata::createMetadata(type)->size())
      throw std::runtime_error("a value in it is not as long as its type");
  }
  /// A mark and then a size for each leaf, packed or as they are. OpenVDB makes room for as many as the value says.
  void check_leaf_sizes() {
    const auto leaves = get<std::uint32_t>();
    if (leaves > size_) throw std::runtime_error("a list in it is of more leaves than the file has bytes");
    skip_list(get<std::uint32_t>(), leaves);
    constexpr std::uint32_t NO_SIZES = std::numeric_limits<std::uint32_t>::max();
    if (const auto packed = get<std::uint32_t>(); packed != NO_SIZES) skip_list(packed, 8ull * leaves);
  }
  /// @param packed  bytes; 0: the list is not, and has so many as it has.
  void skip_list(std::uint64_t packed, std::uint64_t plain) {
    const std::uint64_t length = packed > 0 ? packed : plain;
    if (length > size_ - std::uint64_t(position())) throw std::runtime_error("a list in it is longer than the file");
    stream_.seekg(std::streamoff(length), std::ios::cur);
  }
  std::string read_text() {
    const auto start = position();
    const auto length = get<std::uint32_t>();
    stream_.seekg(start);
    skip_text();  // within the file
    std::string text(length, '\0');
    stream_.seekg(start + std::streamoff(sizeof length));
    stream_.read(text.data(), std::streamsize(length));
    return text;
  }
  void skip_text() {
    const auto length = get<std::uint32_t>();
    if (length > size_ - std::uint64_t(position())) throw std::runtime_error("a text in it is longer than the file");
    stream_.seekg(length, std::ios::cur);
  }
  template <typename Value>
  Value get() {
    Value value;
    stream_.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  std::int64_t position() { return std::int64_t(stream_.tellg()); }

  std::istream& stream_;
  std::uint64_t size_;
  // The stream keeps the address of this pointer.
  openvdb::SharedPtr<openvdb::io::StreamMetadata> state_ = std::make_shared<openvdb::io::StreamMetadata>();
};

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
      archive.setCompression(openvdb::io::Archive::DEFAULT_COMPRESSION_FLAGS);
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
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    stream.open(path, std::ios::binary);
    check_content(stream, size);
    stream.seekg(0);
    return Reader(stream, size).read();
  } catch (const std::bad_alloc&) {
    fail(ExitCode::over_limit, path, "not enough memory to read it");
  } catch (const std::ios_base::failure&) {
    fail(ExitCode::bad_input, path, "not a complete OpenVDB file: it ends too early or cannot be read");
  } catch (const std::exception& e) {
    fail(ExitCode::bad_input, path, fmt::format("damaged, or not an OpenVDB file: {}", e.what()));
  }
}

}  // namespace volgi
