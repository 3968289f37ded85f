// An OpenEXR picture.
#include "core/image.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const std::filesystem::path file = folder.write("picture.exr", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] {
    const ChannelImage channels = read_exr(file);
    for (const Channel& channel : channels.channels) {
      if (channel.values.size() != size_t(channels.width) * size_t(channels.height)) fuzz::wrong("another size");
    }
    colors_of(channels, file);
  });
  return 0;
}
