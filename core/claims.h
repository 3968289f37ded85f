#pragma once
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace volgi {

/// Work that processes share, on one machine or on several that see one folder: a piece belongs to whoever makes the
/// file NAME.claim first. While the piece is held the file's time is renewed; a claim is taken over when its process is
/// no longer there (seen at once on its own machine) or when it has been silent for too long (as the file server's
/// clock has it, so that machines' clocks may differ). A worker that was only asleep may then do a piece that another
/// does as well: a piece has to give the same result whoever does it, and write it atomically.
///
/// link() and rename() decide, and flock() keeps a take-over from being one of two; all three work on NFS.
class Claims {
 public:
  static constexpr std::chrono::milliseconds kSilence{60000};

  /// A piece that is held; given back at its end.
  class Claim {
   public:
    Claim(Claim&& other) noexcept;
    Claim& operator=(Claim&&) = delete;
    ~Claim();

   private:
    friend class Claims;
    Claim(Claims& claims, std::string name) : claims_(&claims), name_(std::move(name)) {}
    Claims* claims_;  // null: moved away
    std::string name_;
  };

  /// @param folder  made where it is not there; a file called lock stays in it.
  /// @throws Error(cannot_write) naming the folder.
  explicit Claims(std::filesystem::path folder, std::chrono::milliseconds silence = kSilence);
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// Nothing where a worker that lives has it, this one included. @param name  a file's, without '/'.
  /// @throws Error(cannot_write).
  std::optional<Claim> take(const std::string& name);
  /// Waits until it is free.
  Claim wait_for(const std::string& name);

  /// Does the pieces 0 … count − 1 together with all that share the folder, and returns when each is done.
  /// @param name     of a piece: the same for all workers.
  /// @param is_done  looks at what everybody has finished; asked again once a piece is held.
  void work(int count, const std::function<std::string(int)>& name, const std::function<bool(int)>& is_done,
            const std::function<void(int)>& piece);

 private:
  std::filesystem::path file_of(const std::string& name) const { return folder_ / (name + ".claim"); }
  void give_back(const std::string& name);
  bool take_over(const std::filesystem::path& own, const std::filesystem::path& claim, const std::string& seen) const;
  bool is_dead(const std::filesystem::path& own, const std::filesystem::path& claim, const std::string& owner) const;
  void renew();

  std::filesystem::path folder_;
  std::chrono::milliseconds silence_;
  std::string self_;  // this process, unlike any other anywhere
  std::mutex mutex_;
  std::condition_variable wake_;
  std::set<std::string> held_;
  bool ended_ = false;
  std::thread renewing_;
};

}  // namespace volgi
