#pragma once
#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace volgi::app {

/// Manual pages (man1/NAME.1 and man1/NAME-COMMAND.1) and what completes a command line (bash/NAME, zsh/_NAME), from
/// the tables of options that the program itself reads: they cannot say anything else than --help does.
/// @param version  "volgi 0.1.0". @throws Error(cannot_write).
void write_program_help(const CLI::App& program, const std::string& version, const std::filesystem::path& folder);

/// For main(), before it parses: whether the command line is `PROGRAM --write-help FOLDER`, which the build runs; it is
/// done then.
bool wrote_program_help(const CLI::App& program, const std::string& version, int argc, char** argv);

}  // namespace volgi::app
