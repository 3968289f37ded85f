#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace volgi {

/// Processes that hold one volume together, each a part of it, as one of them sees them. Nothing here knows how they
/// talk: over MPI (core/mpi/ranks_mpi.h), or as threads of one process (core/ranks_in_threads.h). What all ranks call
/// together ("all") they must call in the same order. One thread of a rank at a time.
class Ranks {
 public:
  using Bytes = std::vector<std::byte>;
  /// A message under way. The bytes it was made with must stay until it is done.
  class Message {
   public:
    virtual ~Message() = default;
    /// Whether it has arrived, or what was sent may be written again.
    virtual bool done() = 0;
    /// Of a message that has arrived.
    virtual size_t bytes() const = 0;
  };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int count() const = 0;

  /// Messages between two ranks under one tag arrive in the order in which they were sent. @param tag  0 ... kTags - 1.
  virtual std::unique_ptr<Message> send(int to, int tag, std::span<const std::byte> bytes) const = 0;
  /// @param room  for the longest that may come.
  virtual std::unique_ptr<Message> receive(int from, int tag, std::span<std::byte> room) const = 0;
  /// Waits until one of them is done. @param messages  null: not looked at. Not all may be null.
  virtual void wait_any(std::span<Message* const> messages) const = 0;

  /// All: sums over ranks, to each of them. In integers, so that no order matters.
  virtual void add(std::span<std::int64_t> values) const = 0;
  /// All: the numbers of every rank, rank after rank, to each of them. As many of each.
  virtual std::vector<double> gather(std::span<const double> values) const = 0;
  /// All: to[r] goes to rank r. @return  from[r] came from there.
  virtual std::vector<Bytes> exchange(std::vector<Bytes> to) const = 0;
  /// Seconds spent waiting for others, in all calls so far.
  virtual double waited_s() const = 0;

  static constexpr int kTags = 32;
};

/// All: like exchange(), of values.
template <class T>
std::vector<std::vector<T>> exchange_values(const Ranks& ranks, const std::vector<std::vector<T>>& to) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<Ranks::Bytes> bytes;
  for (const std::vector<T>& values : to) {
    const auto view = std::as_bytes(std::span(values));
    bytes.emplace_back(view.begin(), view.end());
  }
  std::vector<std::vector<T>> from;
  for (const Ranks::Bytes& b : ranks.exchange(std::move(bytes))) {
    from.emplace_back(b.size() / sizeof(T));
    if (!b.empty()) std::memcpy(from.back().data(), b.data(), b.size());
  }
  return from;
}

}  // namespace volgi
