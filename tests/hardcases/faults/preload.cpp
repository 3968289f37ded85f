// What faults.py puts under a program (LD_PRELOAD) that fails on purpose: each fault is asked for by a variable of the
// environment, and none without.
//   VOLGI_FAULT_NEW=K            the K-th allocation by operator new fails, counted from the moment
//   VOLGI_FAULT_NEW_AFTER=NAME   when a file whose name ends in NAME is opened
//   VOLGI_FAULT_NEW_COUNT=FILE   writes to FILE how many there were
//   VOLGI_FAULT_KILL=K           SIGKILL in place of the K-th write to, or rename of, a regular file
//   VOLGI_FAULT_CLOCK=1          the clock of the day jumps by up to a year, to and fro, at every look
//   VOLGI_FAULT_LOST=K           OpenGL says from the K-th question for errors on that its context is lost
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "tests/hardcases/faults/failing_new.h"

namespace {

long number(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::atol(text);
}

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

std::atomic<long> writes{0}, clock_looks{0}, error_looks{0};
long killing_write = 0, losing_look = 0;
bool clock_jumps = false;
const char* count_after = nullptr;

void saw_file(const char* name) {
  if (count_after != nullptr && name != nullptr && std::string_view(name).ends_with(count_after))
    volgi::test::failing_new.counting = true;
}

/// Of a linear congruential generator (Knuth, MMIX): seconds within a year, before or after.
std::int64_t jump_s() {
  const auto k = std::uint64_t(clock_looks.fetch_add(1)) + 1;
  const std::uint64_t mixed = k * 6364136223846793005ull + 1442695040888963407ull;
  return std::int64_t((mixed >> 33) % 63115200u) - 31557600;
}

bool is_regular(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

void count_write() {
  if (killing_write > 0 && ++writes == killing_write) kill(getpid(), SIGKILL);
}

// --- OpenGL: libepoxy keeps its functions in variables
// ----------------------------------------------------------------

constexpr unsigned GL_CONTEXT_LOST_ = 0x0507, GL_UNKNOWN_CONTEXT_RESET_ = 0x8255;
using NoArguments = unsigned (*)();
NoArguments real_error = nullptr;

unsigned lost_error() { return ++error_looks >= losing_look ? GL_CONTEXT_LOST_ : real_error(); }
unsigned lost_status() { return error_looks >= losing_look ? GL_UNKNOWN_CONTEXT_RESET_ : 0; }

void lose_context() {
  auto** error = static_cast<NoArguments*>(dlsym(RTLD_DEFAULT, "epoxy_glGetError"));
  auto** status = static_cast<NoArguments*>(dlsym(RTLD_DEFAULT, "epoxy_glGetGraphicsResetStatus"));
  if (error == nullptr) return;
  real_error = *error;
  *error = lost_error;
  if (status != nullptr) *status = lost_status;
}

struct Faults {
  Faults() {
    volgi::test::failing_new.failing = number("VOLGI_FAULT_NEW");
    killing_write = number("VOLGI_FAULT_KILL");
    losing_look = number("VOLGI_FAULT_LOST");
    clock_jumps = number("VOLGI_FAULT_CLOCK") != 0;
    count_after = std::getenv("VOLGI_FAULT_NEW_AFTER");
    if (losing_look > 0) lose_context();
  }
  ~Faults() {
    const char* file = std::getenv("VOLGI_FAULT_NEW_COUNT");
    std::FILE* out = file == nullptr ? nullptr : std::fopen(file, "w");
    if (out == nullptr) return;
    std::fprintf(out, "%ld\n", volgi::test::failing_new.count.load());
    std::fclose(out);
  }
};
const Faults faults;

}  // namespace

extern "C" {

int open(const char* name, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  saw_file(name);
  static const auto real = next<int (*)(const char*, int, mode_t)>("open");
  return real(name, flags, mode);
}

int open64(const char* name, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  saw_file(name);
  static const auto real = next<int (*)(const char*, int, mode_t)>("open64");
  return real(name, flags, mode);
}

std::FILE* fopen(const char* name, const char* mode) {
  saw_file(name);
  static const auto real = next<std::FILE* (*)(const char*, const char*)>("fopen");
  return real(name, mode);
}

std::FILE* fopen64(const char* name, const char* mode) {
  saw_file(name);
  static const auto real = next<std::FILE* (*)(const char*, const char*)>("fopen64");
  return real(name, mode);
}

ssize_t write(int file, const void* data, size_t size) {
  if (killing_write > 0 && is_regular(file)) count_write();
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  return real(file, data, size);
}

ssize_t writev(int file, const iovec* parts, int count) {
  if (killing_write > 0 && is_regular(file)) count_write();
  static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
  return real(file, parts, count);
}

int rename(const char* from, const char* to) {
  count_write();
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return real(from, to);
}

int clock_gettime(clockid_t clock, timespec* time) {
  static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, time);
  if (clock_jumps && result == 0 && clock == CLOCK_REALTIME) time->tv_sec += jump_s();
  return result;
}

int gettimeofday(timeval* time, void* zone) {
  static const auto real = next<int (*)(timeval*, void*)>("gettimeofday");
  const int result = real(time, zone);
  if (clock_jumps && result == 0) time->tv_sec += jump_s();
  return result;
}

time_t time(time_t* out) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}

/// Where the kernel's clock would be asked, ours is.
int utimensat(int folder, const char* name, const timespec* times, int flags) {
  static const auto real = next<int (*)(int, const char*, const timespec*, int)>("utimensat");
  if (!clock_jumps || times != nullptr) return real(folder, name, times, flags);
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const timespec both[2] = {now, now};
  return real(folder, name, both, flags);
}

}  // extern "C"
