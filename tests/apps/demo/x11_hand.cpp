// What a desktop does to a window of another program, where there is no desktop: for window_test.py.
//   x11_hand WINDOW drop FILE...   drops files as a file manager does (XDND 5); exit code 1 where they are not taken
//   x11_hand WINDOW vanish         drops something and is gone before it is answered
//   x11_hand WINDOW minimise       and
//   x11_hand WINDOW restore        as window managers do: WM_STATE of ICCCM 4.1.3.1, and unmapped
//   x11_hand WINDOW blur           takes the keyboard away from all windows
//   x11_hand WINDOW picture        its pixels as a PPM (P6) on stdout
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace {

constexpr long XDND_VERSION = 5;
constexpr auto LONGEST_WAIT = std::chrono::seconds(60);

class Hand {
 public:
  Hand(Display* display, Window target) : display_(display), target_(target) {}

  bool drop(const std::vector<std::filesystem::path>& files);
  void vanish();
  void set_state(int state);
  void blur();
  bool write_picture();

 private:
  Atom atom(const char* name) { return XInternAtom(display_, name, False); }
  void send(const char* type, long a, long b, long c, long d);
  bool wait_for(const char* type, XClientMessageEvent& message);
  void make_source();
  void give_files(const XSelectionRequestEvent& request);

  Display* display_;
  Window target_;
  Window source_ = 0;  // of what is dropped
  std::string uris_;
};

std::string uri_of(const std::filesystem::path& file) {
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(file).string()) {
    char text[4] = {c, '\0', '\0', '\0'};
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && std::strchr("/-_.~", c) == nullptr)
      std::snprintf(text, sizeof(text), "%%%02X", static_cast<unsigned char>(c));
    uri += text;
  }
  return uri;
}

void Hand::send(const char* type, long a, long b, long c, long d) {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = target_;
  event.xclient.message_type = atom(type);
  event.xclient.format = 32;
  const long data[5] = {long(source_), a, b, c, d};
  std::memcpy(event.xclient.data.l, data, sizeof(data));
  XSendEvent(display_, target_, False, NoEventMask, &event);
  XFlush(display_);
}

void Hand::give_files(const XSelectionRequestEvent& request) {
  XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(uris_.data()), int(uris_.size()));
  XEvent notice{};
  notice.xselection.type = SelectionNotify;
  notice.xselection.requestor = request.requestor;
  notice.xselection.selection = request.selection;
  notice.xselection.target = request.target;
  notice.xselection.property = request.property;
  notice.xselection.time = request.time;
  XSendEvent(display_, request.requestor, False, NoEventMask, &notice);
  XFlush(display_);
}

/// Answers requests for the files meanwhile.
bool Hand::wait_for(const char* type, XClientMessageEvent& message) {
  const Atom wanted = atom(type);
  const auto end = std::chrono::steady_clock::now() + LONGEST_WAIT;
  while (std::chrono::steady_clock::now() < end) {
    if (XPending(display_) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    XEvent event;
    XNextEvent(display_, &event);
    if (event.type == SelectionRequest) give_files(event.xselectionrequest);
    if (event.type != ClientMessage || event.xclient.message_type != wanted) continue;
    message = event.xclient;
    return true;
  }
  std::fprintf(stderr, "x11_hand: no %s\n", type);
  return false;
}

void Hand::make_source() {
  // A file manager's window: what is dragged from it does not take the keyboard from it.
  XSetWindowAttributes attributes{};
  attributes.override_redirect = True;
  source_ = XCreateWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, CopyFromParent, InputOnly, nullptr,
                          CWOverrideRedirect, &attributes);
}

/// All of it at once, from a window that is no more: whoever answers has an error for it.
void Hand::vanish() {
  make_source();
  XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);
  XDestroyWindow(display_, source_);
  XSync(display_, False);
  send("XdndEnter", XDND_VERSION << 24, long(atom("text/uri-list")), 0, 0);
  send("XdndPosition", 0, 0, CurrentTime, long(atom("XdndActionCopy")));
  send("XdndDrop", 0, CurrentTime, 0, 0);
}

bool Hand::drop(const std::vector<std::filesystem::path>& files) {
  for (const auto& file : files) uris_ += uri_of(file) + "\r\n";
  make_source();
  XMapRaised(display_, source_);
  XSync(display_, False);
  XSetInputFocus(display_, source_, RevertToPointerRoot, CurrentTime);
  XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);

  const Window root = DefaultRootWindow(display_);
  int x = 0, y = 0;
  Window child = 0;
  XTranslateCoordinates(display_, target_, root, 20, 20, &x, &y, &child);
  send("XdndEnter", XDND_VERSION << 24, long(atom("text/uri-list")), 0, 0);
  send("XdndPosition", 0, long(x) << 16 | long(y), CurrentTime, long(atom("XdndActionCopy")));
  XClientMessageEvent answer{};
  bool taken = wait_for("XdndStatus", answer) && (answer.data.l[1] & 1) != 0;
  if (taken) {
    send("XdndDrop", 0, CurrentTime, 0, 0);
    // Bit 0 of it in the protocol; GLFW 3.3 answers with the length of what it got.
    taken = wait_for("XdndFinished", answer) && answer.data.l[1] != 0;
  } else {
    send("XdndLeave", 0, 0, 0, 0);
  }
  XSetInputFocus(display_, target_, RevertToPointerRoot, CurrentTime);
  XSync(display_, False);
  return taken;
}

void Hand::set_state(int state) {
  const Atom wm_state = atom("WM_STATE");
  const long data[2] = {state, 0};
  XChangeProperty(display_, target_, wm_state, wm_state, 32, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(data), 2);
  if (state == IconicState) {
    XUnmapWindow(display_, target_);
  } else {
    XMapWindow(display_, target_);
  }
  XSync(display_, False);
}

void Hand::blur() {
  XSetInputFocus(display_, None, RevertToNone, CurrentTime);
  XSync(display_, False);
}

bool Hand::write_picture() {
  XWindowAttributes a{};
  if (XGetWindowAttributes(display_, target_, &a) == 0 || a.map_state != IsViewable) return false;
  XImage* image = XGetImage(display_, target_, 0, 0, unsigned(a.width), unsigned(a.height), AllPlanes, ZPixmap);
  if (image == nullptr) return false;
  std::printf("P6\n%d %d\n255\n", a.width, a.height);
  std::vector<unsigned char> row(size_t(a.width) * 3);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const unsigned long pixel = XGetPixel(image, x, y);
      for (int c = 0; c < 3; ++c) row[size_t(x) * 3 + size_t(c)] = (unsigned char)(pixel >> (16 - 8 * c) & 0xff);
    }
    std::fwrite(row.data(), 1, row.size(), stdout);
  }
  XDestroyImage(image);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Display* display = argc >= 3 ? XOpenDisplay(nullptr) : nullptr;
  if (display == nullptr) {
    std::fprintf(stderr,
                 "x11_hand WINDOW drop FILE... | vanish | minimise | restore | blur | picture, on an X display\n");
    return 2;
  }
  Hand hand(display, Window(std::stoul(argv[1])));
  const std::string_view what = argv[2];
  bool done = true;
  if (what == "drop") {
    done = hand.drop({argv + 3, argv + argc});
  } else if (what == "vanish") {
    hand.vanish();
  } else if (what == "minimise" || what == "restore") {
    hand.set_state(what == "minimise" ? IconicState : NormalState);
  } else if (what == "blur") {
    hand.blur();
  } else if (what == "picture") {
    done = hand.write_picture();
  } else {
    return 2;
  }
  XCloseDisplay(display);
  return done ? 0 : 1;
}
