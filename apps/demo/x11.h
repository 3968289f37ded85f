#pragma once

namespace volgi::demo {

/// What GLFW does not tell of an X display; nothing where the program was built without X11 or runs on another.

/// Whether a Shift key is down, whichever window has the keyboard: while a file is dragged, that is another one.
bool shift_is_down_anywhere();

/// A display that goes away ends the program with one line and ExitCode::no_device, instead of Xlib's words and its 1.
void end_with_display();

/// A window of another program that goes away while GLFW answers it (what is dragged, the clipboard) is ignored; Xlib
/// would end the program. To be called when the window is there: GLFW 3.3 sets its own handlers before, and resets
/// them.
void outlive_other_windows();

}  // namespace volgi::demo
