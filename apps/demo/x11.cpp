#include "apps/demo/x11.h"

#ifdef VOLGI_HAS_X11

#include <X11/Xlib.h>
#include <X11/Xproto.h>

#include <algorithm>
#include <array>
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

XErrorHandler other_errors = nullptr;

/// What GLFW asks of windows of other programs: where something is dragged from, whose clipboard it is, who has the
/// keyboard. They may have gone meanwhile, which is no reason to go too; Xlib's own handler ends the program.
int forgive_others(Display* display, XErrorEvent* error) {
  constexpr std::array OF_OTHERS{X_SendEvent,           X_GetProperty,  X_ChangeProperty,  X_DeleteProperty,
                                 X_GetWindowAttributes, X_QueryPointer, X_TranslateCoords, X_SetInputFocus};
  const auto* found = std::find(OF_OTHERS.begin(), OF_OTHERS.end(), int(error->request_code));
  if (found != OF_OTHERS.end() && (error->error_code == BadWindow || error->error_code == BadMatch)) return 0;
  return other_errors != nullptr ? other_errors(display, error) : 0;
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
void outlive_other_windows() { other_errors = XSetErrorHandler(forgive_others); }

}  // namespace volgi::demo

#else

namespace volgi::demo {

bool shift_is_down_anywhere() { return false; }
void end_with_display() {}
void outlive_other_windows() {}

}  // namespace volgi::demo

#endif
