#include "core/mpi/ranks_mpi.h"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "core/error.h"

namespace volgi {

namespace {

constexpr size_t kMostBytes = size_t(1) << 30;  // of one MPI message, whose count is an int

/// Looks again and again, but leaves the processor to others that have something to do: there may be more ranks than
/// cores.
template <class Ready>
void wait_until(const Ready& ready, double& waited_s) {
  if (ready()) return;
  constexpr int kSpins = 200, kYields = 2000;
  constexpr auto kNap = std::chrono::microseconds(20);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; !ready(); ++i) {
    if (i > kYields) {
      std::this_thread::sleep_for(kNap);
    } else if (i > kSpins) {
      std::this_thread::yield();
    }
  }
  waited_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class MpiMessage : public Ranks::Message {
 public:
  /// @param expected  bytes; of what is sent.
  MpiMessage(MPI_Request request, size_t expected) : request_(request), bytes_(expected) {}
  bool done() override {
    if (request_ == MPI_REQUEST_NULL) return true;
    int flag = 0;
    MPI_Status status;
    MPI_Test(&request_, &flag, &status);
    if (flag == 0) return false;
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    if (count != MPI_UNDEFINED) bytes_ = std::max(size_t(count), bytes_);
    return true;
  }
  size_t bytes() const override { return bytes_; }

 private:
  MPI_Request request_;
  size_t bytes_;
};

int checked_count(size_t bytes) {
  if (bytes > kMostBytes)
    throw Error(ExitCode::over_limit, "a message between ranks would be larger than 1 GiB: use more ranks");
  return int(bytes);
}

class RanksOfMpi : public Ranks {
 public:
  RanksOfMpi() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }
  int rank() const override { return rank_; }
  int count() const override { return count_; }
  double waited_s() const override { return waited_s_; }

  std::unique_ptr<Message> send(int to, int tag, std::span<const std::byte> bytes) const override {
    MPI_Request request;
    MPI_Isend(bytes.data(), checked_count(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD, &request);
    return std::make_unique<MpiMessage>(request, bytes.size());
  }
  std::unique_ptr<Message> receive(int from, int tag, std::span<std::byte> room) const override {
    MPI_Request request;
    MPI_Irecv(room.data(), checked_count(room.size()), MPI_BYTE, from, tag, MPI_COMM_WORLD, &request);
    return std::make_unique<MpiMessage>(request, 0);
  }
  void wait_any(std::span<Message* const> messages) const override {
    wait_until(
        [&] {
          return std::any_of(messages.begin(), messages.end(), [](Message* m) { return m != nullptr && m->done(); });
        },
        waited_s_);
  }

  void add(std::span<std::int64_t> values) const override {
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, values.data(), int(values.size()), MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD, &request);
    wait(request);
  }
  std::vector<double> gather(std::span<const double> values) const override {
    std::vector<double> all(values.size() * size_t(count_));
    MPI_Request request;
    MPI_Iallgather(values.data(), int(values.size()), MPI_DOUBLE, all.data(), int(values.size()), MPI_DOUBLE,
                   MPI_COMM_WORLD, &request);
    wait(request);
    return all;
  }
  std::vector<Bytes> exchange(std::vector<Bytes> to) const override {
    std::vector<std::uint64_t> sizes_to, sizes_from(size_t(count_), 0);
    for (const Bytes& b : to) sizes_to.push_back(b.size());
    MPI_Request request;
    MPI_Ialltoall(sizes_to.data(), 1, MPI_UINT64_T, sizes_from.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request);
    wait(request);
    std::vector<Bytes> from;
    for (const std::uint64_t size : sizes_from) from.emplace_back(size);
    from[size_t(rank_)] = std::move(to[size_t(rank_)]);
    std::vector<MPI_Request> requests;
    for (int other = 0; other < count_; ++other) {
      if (other == rank_) continue;
      for_pieces(from[size_t(other)], [&](std::byte* piece, int bytes) {
        MPI_Irecv(piece, bytes, MPI_BYTE, other, kTags, MPI_COMM_WORLD, &requests.emplace_back());
      });
      for_pieces(to[size_t(other)], [&](std::byte* piece, int bytes) {
        MPI_Isend(piece, bytes, MPI_BYTE, other, kTags, MPI_COMM_WORLD, &requests.emplace_back());
      });
    }
    wait_until(
        [&] {
          int flag = 0;
          MPI_Testall(int(requests.size()), requests.data(), &flag, MPI_STATUSES_IGNORE);
          return flag != 0;
        },
        waited_s_);
    return from;
  }

 private:
  void wait(MPI_Request& request) const {
    wait_until(
        [&] {
          int flag = 0;
          MPI_Test(&request, &flag, MPI_STATUS_IGNORE);
          return flag != 0;
        },
        waited_s_);
  }
  template <class F>
  static void for_pieces(Bytes& bytes, const F& f) {
    for (size_t at = 0; at < bytes.size(); at += kMostBytes)
      f(bytes.data() + at, int(std::min(kMostBytes, bytes.size() - at)));
  }

  int rank_ = 0, count_ = 1;
  mutable double waited_s_ = 0.0;
};

}  // namespace

MpiRanks::MpiRanks(int& argc, char**& argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  ranks_ = std::make_unique<RanksOfMpi>();
}

MpiRanks::~MpiRanks() {
  ranks_.reset();
  MPI_Finalize();
}

void MpiRanks::abort(int code) const {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

}  // namespace volgi
