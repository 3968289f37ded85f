#pragma once

namespace volgi::demo {

/// What GLFW does not tell of an X display; nothing where the program was built without X11 or runs on another.

/// Whether a Shift key is down, whichever window has the keyboard: while a file is dragged, that is another one.
bool shift_is_down_anywhere();

/// A display that goes away ends the program with one line and ExitCode::no_device, instead of Xlib's words and its 1.
void end_with_display();

}  // namespace volgi::demo
