#include "apps/demo/x11.h"

#ifdef VOLGI_HAS_X11

#include <X11/Xlib.h>

#include <cstdio>
#include <cstdlib>

#include "core/error.h"

namespace volgi::demo {

namespace {

/// Called from within Xlib, which is in no state to be called again: no destructors.
int end(Display* /*display*/) {
  std::fputs("volgi-demo: the display is gone; --headless renders without one (volgi-demo --help)\n", stderr);
  std::fflush(nullptr);
  std::_Exit(int(ExitCode::no_device));
}

}  // namespace

bool shift_is_down_anywhere() {
  Display* display = XOpenDisplay(nullptr);  // GLFW's own is only there in its X11 build
  if (display == nullptr) return false;
  Window root = 0, child = 0;
  int root_x = 0, root_y = 0, x = 0, y = 0;
  unsigned mask = 0;
  XQueryPointer(display, DefaultRootWindow(display), &root, &child, &root_x, &root_y, &x, &y, &mask);
  XCloseDisplay(display);
  return (mask & ShiftMask) != 0;
}

void end_with_display() { XSetIOErrorHandler(end); }

}  // namespace volgi::demo

#else

namespace volgi::demo {

bool shift_is_down_anywhere() { return false; }
void end_with_display() {}

}  // namespace volgi::demo

#endif
