#pragma once
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/image.h"

namespace volgi::demo {

/// Pictures one after another: files of their own, or a film that ffmpeg makes of them (.mp4, .webm, .webp, .gif).
class PictureSequence {
 public:
  /// @param out  where it is no film, a name as app::frame_path() takes it.
  /// @throws Error(usage) for another ending, Error(cannot_write) where ffmpeg is needed and not on the path.
  PictureSequence(const std::filesystem::path& out, glm::ivec2 size, double fps);
  ~PictureSequence();
  PictureSequence(const PictureSequence&) = delete;
  PictureSequence& operator=(const PictureSequence&) = delete;

  /// @param display  RGBA bytes, sRGB encoded, first row at the bottom. @param linear  what an EXR holds.
  void add(const std::vector<unsigned char>& display, const Image& linear);
  /// Ends the film. @throws Error(cannot_write) when ffmpeg fails; nothing half-written stays then.
  void finish();

 private:
  bool is_film() const;
  std::filesystem::path out_, unfinished_;
  glm::ivec2 size_;
  int count_ = 0;
  std::FILE* encoder_ = nullptr;
};

}  // namespace volgi::demo
