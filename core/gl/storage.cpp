#include "core/gl/storage.h"

#include <atomic>

namespace volgi::gl {
namespace {
std::atomic<int> wide = 0;
}

WideStorage::WideStorage() { ++wide; }
WideStorage::~WideStorage() { --wide; }

bool wide_storage() { return wide > 0; }

GLenum stored_format(GLenum format) {
  if (!wide_storage()) return format;
  switch (format) {
    case GL_RGBA16:
    case GL_RGBA16F:
    case GL_RGBA16_SNORM:
      return GL_RGBA32F;
    case GL_RG16:
    case GL_RG16F:
    case GL_RG16_SNORM:
      return GL_RG32F;
    case GL_R16:
    case GL_R16F:
    case GL_R16_SNORM:
      return GL_R32F;
    default:
      return format;
  }
}

}  // namespace volgi::gl
