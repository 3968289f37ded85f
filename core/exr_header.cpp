#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "core/exr_header_internal.h"

namespace volgi {
namespace {

// "OpenEXR File Layout": a magic number and a version with flags (4 bytes each), then headers; a header is attributes
// {name, type, size, value} and ends with an empty name. Of a file of several parts the last header is empty.
constexpr std::uint64_t before_headers = 8;
constexpr int parts_flag = 0x10;  // of the byte behind the version's own

// Of these OpenEXR reads as much as the type has, whatever the attribute's length says, and goes on behind that.
const std::map<std::string, std::uint64_t, std::less<>> kLengths{{"box2f", 16},
                                                                 {"box2i", 16},
                                                                 {"chromaticities", 32},
                                                                 {"compression", 1},
                                                                 {"deepImageState", 1},
                                                                 {"double", 8},
                                                                 {"envmap", 1},
                                                                 {"float", 4},
                                                                 {"int", 4},
                                                                 {"keycode", 28},
                                                                 {"lineOrder", 1},
                                                                 {"m33d", 72},
                                                                 {"m33f", 36},
                                                                 {"m44d", 128},
                                                                 {"m44f", 64},
                                                                 {"rational", 8},
                                                                 {"tiledesc", 9},
                                                                 {"timecode", 8},
                                                                 {"v2d", 16},
                                                                 {"v2f", 8},
                                                                 {"v2i", 8},
                                                                 {"v3d", 24},
                                                                 {"v3f", 12},
                                                                 {"v3i", 12}};

/// Reads ahead of OpenEXR.
class HeaderWalk {
 public:
  explicit HeaderWalk(const std::filesystem::path& path) : size_(std::filesystem::file_size(path)) {
    in_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    in_.open(path, std::ios::binary);
  }

  void run() {
    in_.seekg(5);
    const bool parts = (in_.get() & parts_flag) != 0;
    in_.seekg(std::streamoff(before_headers));
    while (header() && parts) {
    }
  }

 private:
  /// @return whether it has attributes.
  bool header() {
    bool any = false;
    for (std::string name = text(); !name.empty(); name = text()) {
      any = true;
      const std::string type = text();
      const std::uint64_t length = number();
      if (length > left()) throw std::runtime_error("attribute " + name + " is longer than the file");
      const auto known = kLengths.find(type);
      if (known != kLengths.end() && known->second != length)
        throw std::runtime_error("attribute " + name + " is not as long as its type");
      if (type == "floatvector" && length % 4 != 0) throw std::runtime_error("attribute " + name + " ends in a number");
      const auto value = in_.tellg();
      if (type == "stringvector") check_texts(length);
      if (type == "preview") check_preview(length);
      if (type == "chlist") check_channels(length);
      in_.seekg(value + std::streamoff(length));
    }
    return any;
  }
  void check_channels(std::uint64_t length) {
    constexpr std::streamoff of_a_channel = 16;
    const auto start = in_.tellg();
    while (!text().empty()) in_.seekg(of_a_channel, std::ios::cur);
    if (std::uint64_t(in_.tellg() - start) != length)
      throw std::runtime_error("its list of channels is not as long as it says");
  }
  void check_texts(std::uint64_t length) {
    for (std::uint64_t at = 0; at < length;) {
      const std::uint64_t text_length = length - at < 4 ? length : number();
      if (text_length > length - at - std::min<std::uint64_t>(4, length - at))
        throw std::runtime_error("a text of a list is longer than the list");
      in_.seekg(std::streamoff(text_length), std::ios::cur);
      at += 4 + text_length;
    }
  }
  void check_preview(std::uint64_t length) {
    const std::uint64_t width = length < 8 ? 0 : number(), height = length < 8 ? 0 : number();
    if (length < 8 || (width != 0 && height > length / width) || 8 + 4 * width * height != length)
      throw std::runtime_error("its preview has another size than it says");
  }

  /// Up to a zero, of 255 characters at most.
  std::string text() {
    constexpr size_t longest = 255;
    std::string out;
    for (int c = in_.get(); c != 0; c = in_.get()) {
      out += char(c);
      if (out.size() > longest) throw std::runtime_error("a name in its header does not end");
    }
    return out;
  }
  std::uint64_t number() {
    unsigned char bytes[4];
    in_.read(reinterpret_cast<char*>(bytes), sizeof bytes);
    return std::uint64_t(bytes[0]) | std::uint64_t(bytes[1]) << 8 | std::uint64_t(bytes[2]) << 16 |
           std::uint64_t(bytes[3]) << 24;
  }
  std::uint64_t left() { return size_ - std::uint64_t(in_.tellg()); }

  std::uint64_t size_;
  std::ifstream in_;
};

}  // namespace

void check_exr_header(const std::filesystem::path& path) { HeaderWalk(path).run(); }

}  // namespace volgi
