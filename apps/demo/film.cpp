#include "apps/demo/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>

#include "apps/volgi/frame_times.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi::demo {

namespace {

struct Encoding {
  const char* ending;
  const char* arguments;  // of ffmpeg
};
constexpr std::array ENCODINGS = {
    Encoding{".mp4", "-c:v libx264 -pix_fmt yuv420p -crf 18 -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2'"},
    Encoding{".webm", "-c:v libvpx-vp9 -crf 30 -b:v 0"},
    Encoding{".webp", "-c:v libwebp -loop 0 -quality 72 -compression_level 6"},
    Encoding{".gif",
             "-vf 'split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer:bayer_scale=4' "
             "-loop 0"},
};

const Encoding* encoding_of(const std::filesystem::path& out) {
  for (const Encoding& e : ENCODINGS) {
    if (out.extension() == e.ending) return &e;
  }
  return nullptr;
}

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

PictureSequence::PictureSequence(const std::filesystem::path& out, glm::ivec2 size, double fps)
    : out_(out), size_(size) {
  if (!is_film()) {
    if (out.extension() != ".png" && out.extension() != ".exr")
      throw Error(ExitCode::usage, out.string() + ": -o ends in .png, .exr, .mp4, .webm, .webp or .gif");
    check_writable(app::frame_path(out, 0));
    return;
  }
  check_writable(out);
  if (std::system("command -v ffmpeg > /dev/null 2>&1") != 0)
    throw Error(ExitCode::cannot_write,
                out.string() + ": a film needs ffmpeg on the path; or pictures: -o NAME.%04d.png");
  unfinished_ = out;
  unfinished_.replace_filename("." + out.stem().string() + ".unfinished" + out.extension().string());
  const std::string command =
      fmt::format("ffmpeg -loglevel error -y -f rawvideo -pix_fmt rgba -s {}x{} -r {} -i - {} {}", size.x, size.y, fps,
                  encoding_of(out)->arguments, shell_quoted(unfinished_.string()));
  encoder_ = ::popen(command.c_str(), "w");
  if (encoder_ == nullptr) throw Error(ExitCode::cannot_write, out.string() + ": ffmpeg does not start");
}

PictureSequence::~PictureSequence() {
  if (encoder_ == nullptr) return;
  ::pclose(encoder_);
  std::error_code error;
  std::filesystem::remove(unfinished_, error);
}

bool PictureSequence::is_film() const { return encoding_of(out_) != nullptr; }

void PictureSequence::add(const std::vector<unsigned char>& display, const Image& linear) {
  const size_t row = size_t(size_.x) * 4;
  if (is_film()) {
    for (int y = size_.y - 1; y >= 0; --y) std::fwrite(display.data() + size_t(y) * row, 1, row, encoder_);
  } else if (out_.extension() == ".exr") {
    write_exr(app::frame_path(out_, count_), linear);
  } else {
    constexpr float MOST = 255.0f;
    Image picture(size_.x, size_.y);
    for (int y = 0; y < size_.y; ++y) {
      for (int x = 0; x < size_.x; ++x) {
        const unsigned char* p = display.data() + size_t(size_.y - 1 - y) * row + size_t(x) * 4;
        picture.at(x, y) = glm::vec3(p[0], p[1], p[2]) / MOST;
      }
    }
    write_png_display(app::frame_path(out_, count_), picture);
  }
  ++count_;
}

void PictureSequence::finish() {
  if (encoder_ == nullptr) return;
  const int status = ::pclose(std::exchange(encoder_, nullptr));
  if (status != 0) {
    std::error_code error;
    std::filesystem::remove(unfinished_, error);
    throw Error(ExitCode::cannot_write, fmt::format("{}: ffmpeg failed ({})", out_.string(), status));
  }
  std::filesystem::rename(unfinished_, out_);
}

}  // namespace volgi::demo
