#include "core/gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/gl/limits.h"
#include "core/gl/objects.h"
#include "core/gl/program_pool_internal.h"

namespace volgi::gl {
namespace {

/// Entry points that exist without a display. Taken by name: libepoxy resolves its own wrappers of them through the
/// current display, and aborts when there is none yet.
struct ClientFunctions {
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr;
};

template <class F>
F load(const char* name) {
  return reinterpret_cast<F>(eglGetProcAddress(name));
}

bool has_word(const char* words, std::string_view word) {
  std::string_view rest = words == nullptr ? "" : words;
  while (!rest.empty()) {
    const size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == word) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

bool client_extension(std::string_view name) { return has_word(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), name); }

ClientFunctions client_functions() {
  ClientFunctions f;
  if (client_extension("EGL_EXT_platform_base")) {
    f.get_platform_display = load<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  }
  const bool devices = client_extension("EGL_EXT_device_base") ||
                       (client_extension("EGL_EXT_device_enumeration") && client_extension("EGL_EXT_device_query"));
  if (devices) {
    f.query_devices = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    f.query_device_string = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  }
  return f;
}

struct Device {
  EGLDeviceEXT handle;
  bool software;
  std::string name;
};

std::string device_string(const ClientFunctions& egl, EGLDeviceEXT device, const char* extensions,
                          const char* extension, EGLint name) {
  const char* text = has_word(extensions, extension) ? egl.query_device_string(device, name) : nullptr;
  return text == nullptr ? "" : text;
}

std::vector<Device> devices(const ClientFunctions& egl) {
  std::vector<Device> found;
  EGLint count = 0;
  if (egl.query_devices == nullptr || egl.query_device_string == nullptr ||
      egl.query_devices(0, nullptr, &count) == EGL_FALSE) {
    return found;
  }
  std::vector<EGLDeviceEXT> handles(static_cast<size_t>(count));
  egl.query_devices(count, handles.data(), &count);
  for (EGLDeviceEXT handle : handles) {
    const char* extensions = egl.query_device_string(handle, EGL_EXTENSIONS);
    const bool software = has_word(extensions, "EGL_MESA_device_software");
    constexpr EGLint renderer_name = 0x335F;  // EGL_RENDERER_EXT, younger than libepoxy 1.5.10
    std::string name = device_string(egl, handle, extensions, "EGL_EXT_device_query_name", renderer_name);
    const std::string file = device_string(egl, handle, extensions, "EGL_EXT_device_drm", EGL_DRM_DEVICE_FILE_EXT);
    if (name.empty()) name = software ? "software rasterizer" : "GPU";
    if (!file.empty()) name += " (" + file + ")";
    found.push_back({handle, software, name});
  }
  return found;
}

bool is_software(std::string_view renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast"}) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

EGLConfig choose_config(EGLDisplay display) {
  for (EGLint surface_type : {EGL_PBUFFER_BIT, 0}) {
    const std::array<EGLint, 5> attributes{EGL_SURFACE_TYPE, surface_type, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                           EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, attributes.data(), &config, 1, &count) == EGL_TRUE && count > 0) return config;
  }
  return nullptr;
}

/// A context, and what is known of it.
struct State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  State* before = nullptr;  // current when this one was made
  int errors = 0;
  std::string first_error;  // since the last throw
  std::map<std::pair<GLenum, std::optional<GLuint>>, GLint64> limits;
  GLuint empty_vertex_array = 0;  // ends with the context
  ProgramPool programs;
};
thread_local State* current = nullptr;

State& current_state() {
  assert(current != nullptr && "OpenGL without a gl::Context on this thread");
  return *current;
}

void GLAPIENTRY on_debug_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                                 const GLchar* text, const void* user) {
  if (severity != GL_DEBUG_SEVERITY_HIGH && type != GL_DEBUG_TYPE_ERROR) return;
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;  // gl::Program says it, with the file's name
  State& state = *static_cast<State*>(const_cast<void*>(user));
  ++state.errors;
  const std::string_view message(text, length < 0 ? std::string_view(text).size() : size_t(length));
  if (state.first_error.empty()) state.first_error = message;
  std::fprintf(stderr, "volgi: OpenGL: %.*s\n", int(message.size()), message.data());
}

std::string error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return "error " + std::to_string(error);
  }
}

/// Empties the driver's list of errors. @returns the first; a lost context repeats its own for ever.
GLenum take_errors() {
  constexpr int most = 16;
  const GLenum first = glGetError();
  for (int i = 0; i < most && first != GL_NO_ERROR && glGetError() != GL_NO_ERROR; ++i) {
  }
  return first;
}

}  // namespace

struct Context::Data {
  State state;
  std::string name;
  std::string version;

  bool open(EGLDisplay on_display, bool debug);
  void take_current();
  void check_limits() const;
  void close();
  void watch();
  ~Data() { close(); }
};

bool Context::Data::open(EGLDisplay on_display, bool debug) {
  if (on_display == EGL_NO_DISPLAY || eglInitialize(on_display, nullptr, nullptr) == EGL_FALSE) return false;
  state.display = on_display;
  const EGLConfig config = choose_config(on_display);
  if (config == nullptr || eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return false;
  // A context that does not ask may end the process when its device is reset, or go on with wrong results.
  for (const EGLint when_reset : {EGL_LOSE_CONTEXT_ON_RESET_KHR, EGL_NO_RESET_NOTIFICATION_KHR}) {
    const std::array<EGLint, 11> attributes{EGL_CONTEXT_MAJOR_VERSION_KHR,
                                            4,
                                            EGL_CONTEXT_MINOR_VERSION_KHR,
                                            5,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                            EGL_CONTEXT_FLAGS_KHR,
                                            debug ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0,
                                            EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR,
                                            when_reset,
                                            EGL_NONE};
    state.context = eglCreateContext(on_display, config, EGL_NO_CONTEXT, attributes.data());
    if (state.context != EGL_NO_CONTEXT) break;
  }
  if (state.context == EGL_NO_CONTEXT) return false;
  if (!has_word(eglQueryString(on_display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    const std::array<EGLint, 5> size{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    state.surface = eglCreatePbufferSurface(on_display, config, size.data());
    if (state.surface == EGL_NO_SURFACE) return false;
  }
  if (eglMakeCurrent(on_display, state.surface, state.surface, state.context) == EGL_FALSE) return false;
  take_current();
  return true;
}

void Context::Data::take_current() {
  state.before = std::exchange(current, &state);
  name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

// The display itself stays initialised: EGL hands the same one to every context on the device, without counting.
void Context::Data::close() {
  for (State* later = current; later != nullptr; later = later->before) {
    if (later->before == &state) later->before = state.before;
  }
  if (current == &state) {
    current = state.before;
    if (current != nullptr && current->context != EGL_NO_CONTEXT) {
      eglMakeCurrent(current->display, current->surface, current->surface, current->context);
    } else if (state.context != EGL_NO_CONTEXT) {
      eglMakeCurrent(state.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
  }
  if (state.context != EGL_NO_CONTEXT) eglDestroyContext(state.display, state.context);
  if (state.surface != EGL_NO_SURFACE) eglDestroySurface(state.display, state.surface);
  state = {};
}

void Context::Data::check_limits() const {
  const std::string shortage = first_shortage(needed_limits(), [](GLenum limit_name) { return limit(limit_name); });
  if (!shortage.empty()) throw Error(ExitCode::no_device, name + ": " + shortage + "; try another --device");
}

void Context::Data::watch() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
  glDebugMessageCallback(on_debug_message, &state);
}

namespace {

/// Displays in the order in which they are tried; `hardware` ones count only if their renderer is no software
/// rasterizer.
struct Candidate {
  EGLenum platform;
  void* native;
  bool hardware;
};

std::vector<Candidate> candidates(const ClientFunctions& egl, std::optional<int> device_index) {
  const std::vector<Device> all = devices(egl);
  if (device_index) {
    if (*device_index < 0 || size_t(*device_index) >= all.size()) {
      throw Error(ExitCode::usage, "device " + std::to_string(*device_index) + " does not exist: EGL reports " +
                                       std::to_string(all.size()) + " devices, numbered from 0");
    }
    return {{EGL_PLATFORM_DEVICE_EXT, all[size_t(*device_index)].handle, false}};
  }
  std::vector<Candidate> list;
  const bool by_device = client_extension("EGL_EXT_platform_device");
  for (const Device& d : all) {
    if (by_device && !d.software) list.push_back({EGL_PLATFORM_DEVICE_EXT, d.handle, true});
  }
  if (client_extension("EGL_MESA_platform_surfaceless")) {
    list.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, false});
  }
  for (const Device& d : all) {
    if (by_device && d.software) list.push_back({EGL_PLATFORM_DEVICE_EXT, d.handle, false});
  }
  return list;
}

std::optional<int> device_of_environment() {
  const char* text = std::getenv("VOLGI_DEVICE");
  if (text == nullptr || *text == '\0') return std::nullopt;
  int device = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, device);
  if (error != std::errc() || stop != end)
    throw Error(ExitCode::usage, std::string("VOLGI_DEVICE='") + text + "': give the number of an EGL device");
  return device;
}

}  // namespace

Context::Context(const ContextOptions& options) : data_(std::make_unique<Data>()) {
  const ClientFunctions egl = client_functions();
  bool open = false;
  for (const Candidate& c : candidates(egl, options.device ? options.device : device_of_environment())) {
    if (egl.get_platform_display == nullptr) break;
    open = data_->open(egl.get_platform_display(c.platform, c.native, nullptr), options.debug) &&
           !(c.hardware && is_software(data_->name));
    if (open) break;
    data_->close();
  }
  if (!open) {
    throw Error(ExitCode::no_device,
                "no OpenGL 4.5 core context through EGL; install a driver (on Debian libegl-mesa0 and libgl1-mesa-dri) "
                "or use --backend cpu");
  }
  data_->check_limits();
  if (options.debug) data_->watch();
}

Context::Context(const OfWindow& window) : data_(std::make_unique<Data>()) {
  data_->take_current();
  constexpr int NEEDED = 45;
  if (epoxy_gl_version() < NEEDED)
    throw Error(ExitCode::no_device, data_->name + ": OpenGL " + data_->version + ", but 4.5 is needed");
  data_->check_limits();
  if (window.debug) data_->watch();
}

Context::~Context() = default;

const std::string& Context::device_name() const { return data_->name; }
const std::string& Context::version() const { return data_->version; }
bool Context::software() const { return is_software(data_->name); }
int Context::debug_errors() const { return data_->state.errors; }

bool current_is_software() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer == nullptr || is_software(renderer);
}

void throw_on_error() {
  State& state = current_state();
  const GLenum error = take_errors();
  if (error == GL_CONTEXT_LOST || glGetGraphicsResetStatus() != GL_NO_ERROR)
    throw Error(ExitCode::no_device, "the OpenGL context is lost: its device was reset; start again");
  std::string text = std::exchange(state.first_error, {});
  if (text.empty() && error != GL_NO_ERROR) text = error_name(error) + "; --gl-debug says where";
  if (text.empty()) return;
  throw Error(ExitCode::no_device, "OpenGL reports an error, and the result would be wrong: " + text);
}

bool out_of_memory() {
  State& state = current_state();
  const GLenum error = glGetError();
  if (error == GL_OUT_OF_MEMORY) {
    state.first_error.clear();
  } else if (error != GL_NO_ERROR && state.first_error.empty()) {
    state.first_error = error_name(error);
  }
  return error == GL_OUT_OF_MEMORY;
}

GLuint empty_vertex_array() {
  State& state = current_state();
  if (state.empty_vertex_array == 0) {
    glCreateVertexArrays(1, &state.empty_vertex_array);
    count_object();
  }
  return state.empty_vertex_array;
}

ProgramPool* program_pool() { return current == nullptr ? nullptr : &current->programs; }

GLint64 limit(GLenum name, std::optional<GLuint> index) {
  const auto [known, added] = current_state().limits.try_emplace({name, index}, 0);
  if (added && index) glGetInteger64i_v(name, *index, &known->second);
  if (added && !index) glGetInteger64v(name, &known->second);
  return known->second;
}

}  // namespace volgi::gl
