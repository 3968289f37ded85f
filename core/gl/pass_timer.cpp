#include "core/gl/pass_timer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "core/gl/context.h"
#include "core/gl/objects.h"

namespace volgi::gl {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// One use of a pass. The queries are 0 once gpu_ms is known.
struct Sample {
  size_t pass;
  std::uint64_t frame;
  Clock::time_point start;
  double cpu_ms;
  double gpu_ms;
  std::array<GLuint, 2> queries;
};

constexpr size_t samples_kept = 1 << 16;  // of the newest frames: a window that stays open for hours must not grow

}  // namespace

struct PassTimer::Data {
  Kind kind;
  bool timing;  // wall clock only
  bool in_frame = false;
  bool in_scope = false;
  std::uint64_t frame = 0;
  Clock::time_point frame_start;
  std::vector<std::string> names;
  std::deque<Sample> samples;
  std::deque<double> frames_ms;
  std::vector<GLuint> free_queries;

  size_t pass_index(std::string_view name) {
    const auto it = std::find(names.begin(), names.end(), name);
    if (it != names.end()) return size_t(it - names.begin());
    names.emplace_back(name);
    return names.size() - 1;
  }

  GLuint query() {
    if (free_queries.empty()) {
      free_queries.resize(16);
      glCreateQueries(GL_TIMESTAMP, GLsizei(free_queries.size()), free_queries.data());
      count_object(free_queries.size());
    }
    const GLuint id = free_queries.back();
    free_queries.pop_back();
    return id;
  }

  bool recording() const { return kind == Kind::gpu || timing; }

  /// Reads finished queries, oldest first; all of them with `wait`.
  void collect(bool wait) {
    for (Sample& s : samples) {
      if (s.queries[1] == 0) continue;
      GLint available = 0;
      if (!wait) glGetQueryObjectiv(s.queries[1], GL_QUERY_RESULT_AVAILABLE, &available);
      if (!wait && available == 0) return;
      std::array<GLuint64, 2> ns{};
      for (size_t i = 0; i < 2; ++i) {
        glGetQueryObjectui64v(s.queries[i], GL_QUERY_RESULT, &ns[i]);
        free_queries.push_back(s.queries[i]);
        s.queries[i] = 0;
      }
      s.gpu_ms = double(ns[1] - ns[0]) * 1e-6;
    }
    while (samples.size() > samples_kept && samples.front().queries[1] == 0) samples.pop_front();
  }

  void release_queries() {
    for (const Sample& s : samples) {
      for (GLuint q : s.queries) {
        if (q != 0) free_queries.push_back(q);
      }
    }
  }

  ~Data() {
    release_queries();
    if (!free_queries.empty()) glDeleteQueries(GLsizei(free_queries.size()), free_queries.data());
  }
};

PassTimer::PassTimer(bool software, bool timing) : data_(std::make_unique<Data>()) {
  data_->kind = software ? Kind::wall : Kind::gpu;
  data_->timing = timing;
  serialised_ = std::getenv("VOLGI_SERIALISE") != nullptr;
}

PassTimer::~PassTimer() = default;

PassTimer::Scope::Scope(PassTimer* timer, size_t index) : timer_(timer), index_(index) {}

PassTimer::Scope::Scope(Scope&& other) noexcept : timer_(std::exchange(other.timer_, nullptr)), index_(other.index_) {}

PassTimer::Scope PassTimer::scope(std::string_view pass_name) {
  Data& d = *data_;
  assert(!d.in_scope);
  d.in_scope = true;
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, GLsizei(pass_name.size()), pass_name.data());
  if (d.recording()) {
    Sample s{d.pass_index(pass_name), d.frame, {}, 0.0, 0.0, {0, 0}};
    if (d.kind == Kind::gpu) {
      s.queries = {d.query(), 0};
      glQueryCounter(s.queries[0], GL_TIMESTAMP);
    } else {
      glFinish();
    }
    s.start = Clock::now();
    d.samples.push_back(s);
  }
  return {this, d.samples.size() - 1};
}

PassTimer::Scope::~Scope() {
  if (timer_ == nullptr) return;
  Data& d = *timer_->data_;
  d.in_scope = false;
  if (d.recording()) {
    Sample& s = d.samples[index_];
    s.cpu_ms = ms_since(s.start);
    if (d.kind == Kind::gpu) {
      s.queries[1] = d.query();
      glQueryCounter(s.queries[1], GL_TIMESTAMP);
    } else {
      glFinish();
      s.gpu_ms = ms_since(s.start);
    }
  }
  if (timer_->serialised_) wait_for_all();
  glPopDebugGroup();
}

void PassTimer::wait_for_all() {
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glFinish();
}

void PassTimer::begin_frame() {
  Data& d = *data_;
  assert(!d.in_frame && !d.in_scope);
  d.in_frame = true;
  ++d.frame;  // uses between frames make up a frame of their own
  if (d.timing) glFinish();
  d.frame_start = Clock::now();
}

void PassTimer::end_frame() {
  Data& d = *data_;
  assert(d.in_frame && !d.in_scope);
  if (d.timing) glFinish();
  d.frames_ms.push_back(ms_since(d.frame_start));
  if (d.frames_ms.size() > samples_kept) d.frames_ms.pop_front();
  d.in_frame = false;
  ++d.frame;
  d.collect(false);
  throw_on_error();
}

std::vector<PassTimer::PassTime> PassTimer::medians() {
  Data& d = *data_;
  assert(!d.in_scope);
  d.collect(true);
  std::vector<std::map<std::uint64_t, std::array<double, 2>>> frames_of_pass(d.names.size());
  for (const Sample& s : d.samples) {
    std::array<double, 2>& sum = frames_of_pass[s.pass].try_emplace(s.frame).first->second;
    sum[0] += s.gpu_ms;
    sum[1] += s.cpu_ms;
  }
  std::vector<PassTime> result;
  for (size_t pass = 0; pass < d.names.size(); ++pass) {
    std::array<std::vector<double>, 2> values;
    for (const auto& [frame, sum] : frames_of_pass[pass]) {
      for (size_t i = 0; i < 2; ++i) values[i].push_back(sum[i]);
    }
    result.push_back({d.names[pass], median(values[0]), median(values[1])});
  }
  return result;
}

std::vector<PassTimer::PassTime> PassTimer::latest() const {
  const std::deque<Sample>& samples = data_->samples;
  std::optional<std::uint64_t> under_way;
  auto newest = samples.rbegin();
  for (; newest != samples.rend(); ++newest) {
    if (newest->queries[0] != 0) under_way = newest->frame;
    if (newest->frame != under_way) break;
  }
  if (newest == samples.rend()) return {};
  auto first = newest.base();
  while (first != samples.begin() && std::prev(first)->frame == newest->frame) --first;
  std::vector<PassTime> times;
  for (auto s = first; s != newest.base(); ++s) {
    const std::string& name = data_->names[s->pass];
    const auto known = std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == name; });
    PassTime& time = known != times.end() ? *known : times.emplace_back(PassTime{name, 0.0, 0.0});
    time.gpu_ms += s->gpu_ms;
    time.cpu_ms += s->cpu_ms;
  }
  return times;
}

PassTimer::FrameTime PassTimer::frame_time() const {
  const std::deque<double>& ms = data_->frames_ms;
  if (ms.empty()) return {0.0, 0.0, 0.0};
  const auto [smallest, largest] = std::minmax_element(ms.begin(), ms.end());
  return {*smallest, median({ms.begin(), ms.end()}), *largest};
}

void PassTimer::reset() {
  Data& d = *data_;
  assert(!d.in_scope);
  d.release_queries();
  d.samples.clear();
  d.frames_ms.clear();
  d.names.clear();
}

PassTimer::Kind PassTimer::kind() const { return data_->kind; }

}  // namespace volgi::gl
