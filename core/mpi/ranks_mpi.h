#pragma once
#include <memory>

#include "core/ranks.h"

namespace volgi {

/// The processes that an MPI launcher (mpirun) has started, from here to the end of this object's life: one in a
/// program, made before anything else and by the thread that is to talk.
class MpiRanks {
 public:
  MpiRanks(int& argc, char**& argv);
  ~MpiRanks();
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  const Ranks& ranks() const { return *ranks_; }
  /// Ends all ranks, with this exit code.
  [[noreturn]] void abort(int code) const;

 private:
  std::unique_ptr<Ranks> ranks_;
};

}  // namespace volgi
