#include "apps/demo/background_reference.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "apps/demo/idle_priority.h"
#include "reference/error_map.h"
#include "reference/progressive_path_tracer.h"

namespace volgi::demo {
namespace {

using Clock = std::chrono::steady_clock;

int number_of_threads(int asked_for) {
  constexpr int left_to_others = 2;
  return asked_for > 0 ? asked_for : std::max(1, int(std::thread::hardware_concurrency()) - left_to_others);
}

}  // namespace

struct BackgroundReference::Data {
  struct Request {
    std::shared_ptr<const Scene> scene;
    Camera camera;
    PathTracerOptions options;
    Clock::time_point begin;
  };

  explicit Data(int asked_for) : thread_count(number_of_threads(asked_for)) {}

  void work();
  bool has_work() const { return (next && at_work == 0) || next_part < part_count; }
  void prepare(std::unique_lock<std::mutex>& lock);
  std::string make_tracer(Request request);
  void trace_part(std::unique_lock<std::mutex>& lock);
  void finish_sample(std::unique_lock<std::mutex>& lock);
  void begin_sample();
  void drop_picture();

  const int thread_count;
  std::vector<std::thread> threads;

  mutable std::mutex mutex;  // of all that follows, but for what says otherwise
  std::condition_variable changed;
  bool ending = false;
  std::optional<Request> next;  // asked for, and taken by no thread yet
  int at_work = 0;              // threads outside of the mutex
  int next_part = 0, part_count = 0, parts_done = 0;
  std::string failure;
  std::atomic<bool> cancelled{false};  // written under the mutex

  // Of the threads at work; while there are none, of the one that has the mutex.
  Request now;
  std::unique_ptr<ProgressivePathTracer> tracer;

  // Apart, as it is taken every frame: a thread that loses its turn with `mutex` locked does not hold that up.
  mutable std::mutex latest_mutex;
  std::shared_ptr<const ReferenceSnapshot> latest;
};

void BackgroundReference::Data::work() {
  take_idle_priority();
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [&] { return ending || has_work(); });
    if (ending) return;
    if (next) {
      prepare(lock);
    } else {
      trace_part(lock);
    }
  }
}

/// With no thread at work.
void BackgroundReference::Data::prepare(std::unique_lock<std::mutex>& lock) {
  Request request = *std::exchange(next, std::nullopt);
  cancelled = false;
  ++at_work;
  lock.unlock();
  std::string wrong = make_tracer(std::move(request));
  lock.lock();
  --at_work;
  failure = std::move(wrong);
  begin_sample();
  changed.notify_all();
}

/// @returns what went wrong; there is no tracer then.
std::string BackgroundReference::Data::make_tracer(Request request) {
  try {
    if (tracer && request.scene == now.scene) {
      tracer->restart(request.camera, request.options);
      now = std::move(request);
    } else {
      tracer.reset();  // before the scene that it refers to
      now = std::move(request);
      tracer = std::make_unique<ProgressivePathTracer>(*now.scene, now.camera, now.options,
                                                       ProgressivePathTracer::PointSets::two);
    }
    return {};
  } catch (const std::exception& e) {
    tracer.reset();
    return e.what();
  }
}

void BackgroundReference::Data::begin_sample() {
  parts_done = next_part = 0;
  const bool more = !cancelled && tracer && tracer->samples_per_pixel() < now.options.samples_per_pixel;
  part_count = more ? tracer->part_count() : 0;
}

void BackgroundReference::Data::trace_part(std::unique_lock<std::mutex>& lock) {
  const int part = next_part++;
  ++at_work;
  lock.unlock();
  const bool done = tracer->trace_part(part, cancelled);
  lock.lock();
  if (done && ++parts_done == part_count) finish_sample(lock);
  if (--at_work == 0 || next_part < part_count) changed.notify_all();
}

/// By the thread that traced the last part; the others wait for the next sample.
void BackgroundReference::Data::finish_sample(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  tracer->finish_sample();
  auto made = std::make_shared<ReferenceSnapshot>();
  made->image = tracer->image();
  made->noise = tracer->noise();
  made->samples = tracer->samples_per_pixel();
  made->seconds = std::chrono::duration<double>(Clock::now() - now.begin).count();
  std::shared_ptr<const ReferenceSnapshot> snapshot = std::move(made);
  {
    // start() cancels first and forgets `latest` then, so that nothing of the picture before comes back.
    const std::lock_guard latest_lock(latest_mutex);
    if (!cancelled) latest.swap(snapshot);
  }
  snapshot.reset();  // the one before, outside of all locks
  lock.lock();
  begin_sample();
}

void BackgroundReference::Data::drop_picture() {
  next.reset();
  cancelled = true;
  next_part = part_count = parts_done = 0;
}

BackgroundReference::BackgroundReference(int threads) : data_(std::make_unique<Data>(threads)) {}

BackgroundReference::~BackgroundReference() {
  {
    const std::lock_guard lock(data_->mutex);
    data_->drop_picture();
    data_->ending = true;
  }
  data_->changed.notify_all();
  for (std::thread& thread : data_->threads) thread.join();
}

void BackgroundReference::start(std::shared_ptr<const Scene> scene, const Camera& camera,
                                const PathTracerOptions& options) {
  assert(scene && options.size.x > 0 && options.size.y > 0);
  Data& d = *data_;
  {
    const std::lock_guard lock(d.mutex);
    d.drop_picture();
    d.next = Data::Request{std::move(scene), camera, options, Clock::now()};
    d.failure.clear();
    const std::lock_guard latest_lock(d.latest_mutex);
    d.latest.reset();
  }
  while (d.threads.size() < size_t(d.thread_count)) d.threads.emplace_back([&d] { d.work(); });
  d.changed.notify_all();
}

void BackgroundReference::stop() {
  const std::lock_guard lock(data_->mutex);
  data_->drop_picture();
}

std::shared_ptr<const ReferenceSnapshot> BackgroundReference::latest() const {
  const std::lock_guard lock(data_->latest_mutex);
  return data_->latest;
}

bool BackgroundReference::busy() const {
  const std::lock_guard lock(data_->mutex);
  return data_->next || data_->at_work > 0 || data_->next_part < data_->part_count;
}

std::string BackgroundReference::failure() const {
  const std::lock_guard lock(data_->mutex);
  return data_->failure;
}

int BackgroundReference::threads() const { return data_->thread_count; }

Metrics figures(const Image& picture, const ReferenceSnapshot& reference) {
  const Mask all(reference.image.pixels.size(), 1);
  return measure(reference.image, picture, reference.noise.pixels.empty() ? nullptr : &reference.noise, all);
}

Image signed_error_map(const Image& picture, const Image& reference) {
  return error_colors(reference, picture, Mask(reference.pixels.size(), 1));
}

}  // namespace volgi::demo
