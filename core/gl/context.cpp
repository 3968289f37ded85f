#include "core/gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "core/error.h"

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

void GLAPIENTRY on_debug_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                                 const void* user) {
  if (severity != GL_DEBUG_SEVERITY_HIGH && type != GL_DEBUG_TYPE_ERROR) return;
  ++*static_cast<int*>(const_cast<void*>(user));
  std::fprintf(stderr, "volgi: OpenGL: %.*s\n", length, text);
}

}  // namespace

struct Context::Data {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  std::string name;
  std::string version;
  int errors = 0;

  bool open(EGLDisplay on_display);
  void close();
  ~Data() { close(); }
};

bool Context::Data::open(EGLDisplay on_display) {
  if (on_display == EGL_NO_DISPLAY || eglInitialize(on_display, nullptr, nullptr) == EGL_FALSE) return false;
  display = on_display;
  const EGLConfig config = choose_config(display);
  if (config == nullptr || eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return false;
  const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION_KHR,
                                         4,
                                         EGL_CONTEXT_MINOR_VERSION_KHR,
                                         5,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                         EGL_CONTEXT_FLAGS_KHR,
                                         EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR,
                                         EGL_NONE};
  context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return false;
  if (!has_word(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    const std::array<EGLint, 5> size{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size.data());
    if (surface == EGL_NO_SURFACE) return false;
  }
  if (eglMakeCurrent(display, surface, surface, context) == EGL_FALSE) return false;
  name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  return true;
}

// The display itself stays initialised: EGL hands the same one to every context on the device, without counting.
void Context::Data::close() {
  if (context != EGL_NO_CONTEXT) {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
  if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
  display = EGL_NO_DISPLAY;
  context = EGL_NO_CONTEXT;
  surface = EGL_NO_SURFACE;
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
      throw Error(ExitCode::usage, "--device " + std::to_string(*device_index) + " does not exist: EGL reports " +
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

}  // namespace

Context::Context(std::optional<int> device_index) : data_(std::make_unique<Data>()) {
  const ClientFunctions egl = client_functions();
  bool open = false;
  for (const Candidate& c : candidates(egl, device_index)) {
    if (egl.get_platform_display == nullptr) break;
    open = data_->open(egl.get_platform_display(c.platform, c.native, nullptr)) &&
           !(c.hardware && is_software(data_->name));
    if (open) break;
    data_->close();
  }
  if (!open) {
    throw Error(ExitCode::no_device,
                "no OpenGL 4.5 core context through EGL; install a driver (on Debian libegl-mesa0 and libgl1-mesa-dri) "
                "or use --backend cpu");
  }
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
  glDebugMessageCallback(on_debug_message, &data_->errors);
}

Context::~Context() = default;

const std::string& Context::device_name() const { return data_->name; }
const std::string& Context::version() const { return data_->version; }
bool Context::software() const { return is_software(data_->name); }
int Context::debug_errors() const { return data_->errors; }

bool current_is_software() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer == nullptr || is_software(renderer);
}

std::vector<std::string> list_devices() {
  std::vector<std::string> lines;
  for (const Device& d : devices(client_functions())) lines.push_back(d.name);
  return lines;
}

}  // namespace volgi::gl
