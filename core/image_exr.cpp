#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <new>
#include <stdexcept>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/exr_header_internal.h"
#include "core/image.h"
#include "core/one_line.h"

namespace volgi {
namespace {

constexpr float largest_half = 65504.0f;
constexpr std::int64_t largest_edge = 65536;
constexpr std::int64_t max_values = std::int64_t(1) << 31;  // pixels times channels: 8 GiB

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", path.string(), one_line(why)));
}

size_t channel_count(const Imf::ChannelList& channels) {
  size_t count = 0;
  for (auto c = channels.begin(); c != channels.end(); ++c) ++count;
  return count;
}

/// What the file claims is checked before anything is allocated for it: a byte stands for no more than so many of
/// pixels, with which DWA packs a black picture.
constexpr std::int64_t most_unpacked = 16384;

void check_header(const std::filesystem::path& path, const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) refuse(path, "deep EXR files are not supported");
  const auto& window = header.dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  const auto channels = std::int64_t(channel_count(header.channels()));
  if (channels == 0) refuse(path, "the EXR file has no channels");
  if (width < 1 || height < 1 || width > largest_edge || height > largest_edge ||
      width * height > max_values / channels) {
    refuse(path, fmt::format("an EXR of {}x{} pixels and {} channels is not supported", width, height, channels));
  }
  const auto bytes = std::int64_t(std::filesystem::file_size(path));
  if (width * height * channels * std::int64_t(sizeof(float)) > most_unpacked * bytes)
    refuse(path,
           fmt::format("{}x{} pixels of {} channels do not fit into its {} bytes", width, height, channels, bytes));
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    if (tile.xSize < 1 || tile.ySize < 1 || tile.xSize > largest_edge || tile.ySize > largest_edge ||
        std::int64_t(tile.xSize) * tile.ySize * channels * std::int64_t(sizeof(float)) > most_unpacked * bytes)
      refuse(path, fmt::format("tiles of {}x{} pixels do not fit into its {} bytes", tile.xSize, tile.ySize, bytes));
  }
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
      refuse(path, fmt::format("channel {} is subsampled, which is not supported", c.name()));
    }
  }
}

/// Imf addresses pixel (x,y) of the data window: the base pointer is that of (0,0), which may lie outside the array.
Imf::Slice slice_of(Imf::PixelType type, const void* values, size_t value_size, const Imath::Box2i& window) {
  const size_t row_bytes = value_size * size_t(window.max.x - window.min.x + 1);
  return Imf::Slice::Make(type, values, window, value_size, row_bytes);
}

void check_half_range(const std::filesystem::path& path, const ChannelImage& image) {
  for (const Channel& channel : image.channels) {
    for (const float value : channel.values) {
      if (std::isfinite(value) && std::abs(value) > largest_half) {
        throw Error(ExitCode::over_limit, fmt::format("{}: channel {} holds {}, beyond half precision (65504); "
                                                      "write without --half",
                                                      path.string(), channel.name, value));
      }
    }
  }
}

void write_channels(const std::filesystem::path& path, const ChannelImage& image, bool as_half) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  const size_t pixels = size_t(image.width) * size_t(image.height);
  std::vector<std::vector<half>> halves;
  halves.reserve(image.channels.size());
  Imf::FrameBuffer frame;
  for (const Channel& channel : image.channels) {
    assert(channel.values.size() == pixels);
    header.channels().insert(channel.name, Imf::Channel(as_half ? Imf::HALF : Imf::FLOAT));
    if (as_half) {
      auto& converted = halves.emplace_back(pixels);
      std::transform(channel.values.begin(), channel.values.end(), converted.begin(), [](float v) { return half(v); });
      frame.insert(channel.name, slice_of(Imf::HALF, converted.data(), sizeof(half), header.dataWindow()));
    } else {
      frame.insert(channel.name, slice_of(Imf::FLOAT, channel.values.data(), sizeof(float), header.dataWindow()));
    }
  }
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  // The destructor writes the table of lines and swallows what goes wrong, such as a full disk.
  if (!Imf::InputFile(path.c_str()).isComplete()) throw std::runtime_error("the file is incomplete (disk full?)");
}

void add_three(ChannelImage& to, std::string_view prefix, const char* suffixes, const Image& image) {
  if (to.channels.empty()) {
    to.width = image.width;
    to.height = image.height;
  }
  assert(to.width == image.width && to.height == image.height);
  for (int c = 0; c < 3; ++c) {
    Channel channel{fmt::format("{}{}", prefix, suffixes[c]), {}};
    channel.values.reserve(image.pixels.size());
    for (const glm::vec3& pixel : image.pixels) channel.values.push_back(pixel[c]);
    to.channels.push_back(std::move(channel));
  }
}

}  // namespace

const Channel* ChannelImage::find(std::string_view name) const {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

bool ChannelImage::rgb(std::string_view prefix, Image& out) const {
  for (const char* suffixes : {"RGB", "XYZ"}) {
    std::array<const Channel*, 3> planes{};
    for (size_t c = 0; c < 3; ++c) planes[c] = find(fmt::format("{}{}", prefix, suffixes[c]));
    if (std::count(planes.begin(), planes.end(), nullptr) > 0) continue;
    out = Image(width, height);
    for (size_t i = 0; i < out.pixels.size(); ++i) {
      out.pixels[i] = {planes[0]->values[i], planes[1]->values[i], planes[2]->values[i]};
    }
    return true;
  }
  return false;
}

void ChannelImage::add_rgb(std::string_view prefix, const Image& image) { add_three(*this, prefix, "RGB", image); }
void ChannelImage::add_xyz(std::string_view prefix, const Image& image) { add_three(*this, prefix, "XYZ", image); }

namespace {

/// Adds the channels of a part.
void read_part(const std::filesystem::path& path, Imf::MultiPartInputFile& file, int part, const std::string& prefix,
               ChannelImage& image) {
  Imf::InputPart in(file, part);
  check_header(path, in.header());
  const Imath::Box2i window = in.header().dataWindow();
  const size_t first = image.channels.size();
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) {
    Channel& channel = image.channels.emplace_back();
    channel.name = prefix + c.name();
    channel.values.resize(size_t(image.width) * size_t(image.height));
  }
  Imf::FrameBuffer frame;
  size_t k = first;
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c, ++k)
    frame.insert(c.name(), slice_of(Imf::FLOAT, image.channels[k].values.data(), sizeof(float), window));
  in.setFrameBuffer(frame);
  in.readPixels(window.min.y, window.max.y);
}

/// Imf::isOpenExrFile says "no" when it runs out of memory, too.
bool begins_as_exr(const std::filesystem::path& path) {
  std::ifstream in;
  in.exceptions(std::ios::badbit);
  in.open(path, std::ios::binary);
  char magic[4] = {};
  in.read(magic, sizeof magic);
  return in.gcount() == sizeof magic && Imf::isImfMagic(magic);
}

}  // namespace

ChannelImage read_exr(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) refuse(path, "there is no such file");
  try {
    if (!begins_as_exr(path)) refuse(path, "not an OpenEXR file");
    check_exr_header(path);
    Imf::MultiPartInputFile file(path.c_str());
    constexpr int most_parts = 1024;
    if (file.parts() < 1 || file.parts() > most_parts) refuse(path, fmt::format("an EXR of {} parts", file.parts()));
    const Imf::Header& header = file.header(0);
    check_header(path, header);
    const Imath::Box2i window = header.dataWindow();
    ChannelImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    image.origin = {window.min.x - header.displayWindow().min.x, window.min.y - header.displayWindow().min.y};
    for (int part = 0; part < file.parts(); ++part) {
      const Imf::Header& own = file.header(part);
      if (part > 0 && own.hasType() && Imf::isDeepData(own.type())) continue;
      if (own.dataWindow() != window) continue;
      const bool named = part > 0 && own.hasName() && !own.name().empty();
      read_part(path, file, part, named ? own.name() + "." : std::string(), image);
    }
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {  // Iex: truncated or damaged
    refuse(path, fmt::format("cannot be read as OpenEXR: {}", e.what()));
  }
}

Image read_exr_rgb(const std::filesystem::path& path) { return colors_of(read_exr(path), path); }

Image colors_of(const ChannelImage& channels, const std::filesystem::path& path) {
  Image image;
  if (channels.rgb("", image)) return image;
  // Blender's multilayer files call them ViewLayer.Combined.R; a part of its own ViewLayer.Combined and R.
  constexpr std::string_view red = "Combined.R";
  for (const Channel& channel : channels.channels) {
    const std::string_view name = channel.name;
    if (name.ends_with(red) && channels.rgb(name.substr(0, name.size() - 1), image)) return image;
  }
  std::string names;
  for (const Channel& channel : channels.channels) names += (names.empty() ? "" : ", ") + channel.name;
  refuse(path, fmt::format("no colour channels R, G, B or *.Combined.R, G, B; the file has: {}", names));
}

void write_exr(const std::filesystem::path& path, const ChannelImage& image, bool half) {
  if (half) check_half_range(path, image);
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    try {
      write_channels(temporary, image, half);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", path.string(), e.what()));
    }
  });
}

void write_exr(const std::filesystem::path& path, const Image& image, bool half) {
  ChannelImage channels;
  channels.add_rgb("", image);
  write_exr(path, channels, half);
}

}  // namespace volgi
