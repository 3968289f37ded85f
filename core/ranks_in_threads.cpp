#include "core/ranks_in_threads.h"

#include <cassert>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <tuple>

namespace volgi {

namespace {

/// Thrown in ranks that wait for one that has failed.
struct OtherRankFailed {};

/// What threads hand each other.
struct PostOffice {
  explicit PostOffice(int n) : count(n), numbers(size_t(n)), packets(size_t(n)) {}

  using Address = std::tuple<int, int, int>;  // from, to, tag
  const int count;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<Address, std::deque<Ranks::Bytes>> boxes;
  bool failed = false;
  // Of what all call together.
  int arrived = 0;
  std::int64_t round = 0;
  std::vector<std::int64_t> sum;
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<Ranks::Bytes>> packets;

  template <class Ready>
  void wait(std::unique_lock<std::mutex>& lock, const Ready& ready) {
    changed.wait(lock, [&] { return failed || ready(); });
    if (failed) throw OtherRankFailed();
  }
  /// Until all are here.
  void meet(std::unique_lock<std::mutex>& lock) {
    const std::int64_t now = round;
    if (++arrived == count) {
      arrived = 0;
      ++round;
      changed.notify_all();
    } else {
      wait(lock, [&] { return round != now; });
    }
  }
  void fail() {
    const std::lock_guard lock(mutex);
    failed = true;
    changed.notify_all();
  }
};

class RankOfThread : public Ranks {
 public:
  RankOfThread(PostOffice& office, int rank) : office_(office), rank_(rank) {}
  int rank() const override { return rank_; }
  int count() const override { return office_.count; }
  double waited_s() const override { return waited_s_; }

  std::unique_ptr<Message> send(int to, int tag, std::span<const std::byte> bytes) const override {
    const std::lock_guard lock(office_.mutex);
    office_.boxes[{rank_, to, tag}].emplace_back(bytes.begin(), bytes.end());
    office_.changed.notify_all();
    return std::make_unique<Sent>(bytes.size());
  }
  std::unique_ptr<Message> receive(int from, int tag, std::span<std::byte> room) const override {
    return std::make_unique<Awaited>(office_, PostOffice::Address{from, rank_, tag}, room);
  }
  void wait_any(std::span<Message* const> messages) const override {
    const Clock clock(waited_s_);
    std::unique_lock lock(office_.mutex);
    office_.wait(lock, [&] {
      for (Message* m : messages) {
        auto* awaited = dynamic_cast<Awaited*>(m);
        if (m != nullptr && (awaited == nullptr || awaited->take())) return true;
      }
      return false;
    });
  }

  void add(std::span<std::int64_t> values) const override {
    const Clock clock(waited_s_);
    std::unique_lock lock(office_.mutex);
    if (office_.sum.empty()) office_.sum.assign(values.size(), 0);
    assert(office_.sum.size() == values.size());
    for (size_t i = 0; i < values.size(); ++i) office_.sum[i] += values[i];
    office_.meet(lock);
    std::copy(office_.sum.begin(), office_.sum.end(), values.begin());
    office_.meet(lock);
    office_.sum.clear();
    office_.meet(lock);
  }
  std::vector<double> gather(std::span<const double> values) const override {
    const Clock clock(waited_s_);
    std::unique_lock lock(office_.mutex);
    office_.numbers[size_t(rank_)].assign(values.begin(), values.end());
    office_.meet(lock);
    std::vector<double> all;
    for (const auto& of_rank : office_.numbers) all.insert(all.end(), of_rank.begin(), of_rank.end());
    office_.meet(lock);
    return all;
  }
  std::vector<Bytes> exchange(std::vector<Bytes> to) const override {
    const Clock clock(waited_s_);
    assert(int(to.size()) == count());
    std::unique_lock lock(office_.mutex);
    office_.packets[size_t(rank_)] = std::move(to);
    office_.meet(lock);
    std::vector<Bytes> from;
    for (auto& of_rank : office_.packets) from.push_back(std::move(of_rank[size_t(rank_)]));
    office_.meet(lock);
    return from;
  }

 private:
  class Clock {
   public:
    explicit Clock(double& sum) : sum_(sum) {}
    ~Clock() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    Clock(const Clock&) = delete;
    Clock& operator=(const Clock&) = delete;

   private:
    double& sum_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };
  class Sent : public Message {
   public:
    explicit Sent(size_t bytes) : bytes_(bytes) {}
    bool done() override { return true; }
    size_t bytes() const override { return bytes_; }

   private:
    size_t bytes_;
  };
  class Awaited : public Message {
   public:
    Awaited(PostOffice& office, PostOffice::Address address, std::span<std::byte> room)
        : office_(office), address_(address), room_(room) {}
    bool done() override {
      const std::lock_guard lock(office_.mutex);
      return take();
    }
    size_t bytes() const override { return bytes_; }
    /// The office must be locked.
    bool take() {
      if (done_) return true;
      auto& box = office_.boxes[address_];
      if (box.empty()) return false;
      assert(box.front().size() <= room_.size());
      std::copy(box.front().begin(), box.front().end(), room_.begin());
      bytes_ = box.front().size();
      box.pop_front();
      return done_ = true;
    }

   private:
    PostOffice& office_;
    PostOffice::Address address_;
    std::span<std::byte> room_;
    size_t bytes_ = 0;
    bool done_ = false;
  };

  PostOffice& office_;
  int rank_;
  mutable double waited_s_ = 0.0;
};

}  // namespace

void run_ranks_in_threads(int count, const std::function<void(const Ranks& ranks)>& work) {
  PostOffice office(count);
  std::exception_ptr first;
  std::vector<std::thread> threads;
  threads.reserve(size_t(count));
  for (int rank = 0; rank < count; ++rank) {
    threads.emplace_back([&, rank] {
      try {
        work(RankOfThread(office, rank));
      } catch (const OtherRankFailed&) {
      } catch (...) {
        {
          const std::lock_guard lock(office.mutex);
          if (!first) first = std::current_exception();
        }
        office.fail();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  if (first) std::rethrow_exception(first);
}

}  // namespace volgi
