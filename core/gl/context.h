#pragma once
#include <memory>
#include <optional>
#include <string>

namespace volgi::gl {

struct ContextOptions {
  std::optional<int> device = {};  // as EGL numbers them; none: VOLGI_DEVICE, else the first of hardware, else software
  bool debug = false;              // GL says what is wrong where it is wrong; slower on some drivers
};

/// Says that a window toolkit has made a context current on this thread: volgi uses it.
struct OfWindow {
  bool debug = false;  // as ContextOptions::debug; the context has to be a debug one for messages to come
};

/// An OpenGL 4.5 core context without a window, current on the thread that made it, through EGL: device platform for
/// hardware first, then Mesa's surfaceless platform, then a software device (llvmpipe). The context that was current
/// before is current again when this one ends.
/// @throws Error(no_device) when nothing gives a 4.5 core context, or its limits are below what the passes need
///   (core/gl/limits.h); Error(usage) when the device, or that of VOLGI_DEVICE, does not exist.
/// With `debug`, messages of high severity and of errors are counted, printed on stderr, and thrown by throw_on_error.
class Context {
 public:
  explicit Context(const ContextOptions& options = {});
  /// The toolkit's context, which stays its own: this neither makes nor ends it, and ends before it.
  /// @throws Error(no_device) when it is older than OpenGL 4.5 or below the limits.
  explicit Context(const OfWindow& window);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const std::string& device_name() const;  // GL_RENDERER
  const std::string& version() const;      // GL_VERSION
  bool software() const;     // llvmpipe, softpipe, swrast: timer queries lie (docs/conventions.md#statistics)
  int debug_errors() const;  // high-severity or error-type messages so far; 0 without `debug`

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Whether the context that is current on this thread is a software rasterizer.
bool current_is_software();

/// Ends what must not go on after an OpenGL error: its result would be wrong. Called where results leave the GPU, at
/// the end of frames and in downloads, never from within the driver.
/// @throws Error(no_device) with the first error since the last call, from debug messages or glGetError.
void throw_on_error();

/// Whether the last command ran out of memory. Such an error is forgotten, as the caller says it better; others wait
/// for throw_on_error().
bool out_of_memory();

/// A vertex array without attributes, made once for each context: the core profile draws only with one bound.
unsigned empty_vertex_array();

}  // namespace volgi::gl
