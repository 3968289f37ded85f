#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace volgi::gl {

/// An OpenGL 4.5 core context without a window, current on the thread that made it, through EGL: device platform for
/// hardware first, then Mesa's surfaceless platform, then a software device (llvmpipe).
/// @param device_index as list_devices() numbers them; none: the first hardware device that works, else software.
/// @throws Error(no_device) when nothing gives a 4.5 core context; Error(usage) when the index does not exist.
/// Debug output is synchronous; high-severity messages and GL errors are counted (debug_errors) and printed on stderr.
class Context {
 public:
  explicit Context(std::optional<int> device_index = std::nullopt);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const std::string& device_name() const;  // GL_RENDERER
  const std::string& version() const;      // GL_VERSION
  bool software() const;     // llvmpipe, softpipe, swrast: timer queries lie (docs/conventions.md#statistics)
  int debug_errors() const;  // high-severity or error-type messages so far

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Whether the context that is current on this thread is a software rasterizer.
bool current_is_software();

/// One line per device that EGL reports, in the order of --device.
std::vector<std::string> list_devices();

}  // namespace volgi::gl
