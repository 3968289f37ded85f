#pragma once
#include "core/ranks.h"

namespace volgi::app {

/// The ranks that mpirun has started this program as. Made once, first of all; where the program was started alone
/// there is nothing to it.
class ProgramRanks {
 public:
  /// @throws Error(usage) in a build without MPI where mpirun has started several.
  ProgramRanks(int& argc, char**& argv);
  ~ProgramRanks();
  ProgramRanks(const ProgramRanks&) = delete;
  ProgramRanks& operator=(const ProgramRanks&) = delete;

  /// Ends all ranks with the code of one that has failed, whose line is said: that of rank 0 where all have the same
  /// failure. Returns where there is one rank.
  void end_all(int code) const;
  /// The same where all fail alike, after the first has said so.
  int end_all_alike(int code) const;
  /// Whatever happens in the handler: says the failure, as say_failure(), so that one line comes of all ranks.
  int say_failure() const;
};

/// Null: there is one.
const Ranks* program_ranks();

/// Whether this is the rank that says what there is to say.
inline bool is_first_rank() { return program_ranks() == nullptr || program_ranks()->rank() == 0; }

/// @throws Error(usage) where there are several ranks: for what one alone can do.
void refuse_several_ranks(const char* command);

}  // namespace volgi::app
