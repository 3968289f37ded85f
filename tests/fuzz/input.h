#pragma once
// What the fuzzed readers share. Each NAME.cpp has LLVMFuzzerTestOneInput for one reader: with the preset `fuzz` linked
// to libFuzzer (fuzz_NAME), and in every other build to replay.cpp, which runs the corpus through it (test fuzz.NAME).
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/log.h"

namespace volgi::fuzz {

inline std::string_view text_of(const std::uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder in memory of this process alone, removed when it ends.
class Folder {
 public:
  Folder() {
    const std::filesystem::path memory("/dev/shm");
    std::error_code none;
    std::string name =
        ((std::filesystem::is_directory(memory, none) ? memory : std::filesystem::temp_directory_path()) /
         "volgi-fuzz-XXXXXX")
            .string();
    if (mkdtemp(name.data()) == nullptr) std::terminate();
    path_ = name;
    set_quiet(true);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const char* name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

 private:
  std::filesystem::path path_;
};

[[noreturn]] inline void wrong(const std::string& what) {
  std::fprintf(stderr, "volgi: fuzz: %s\n", what.c_str());
  std::abort();
}

/// Reads, or refuses as it is documented: Error with a line and the exit code of bad input or of limits. Anything else
/// that is thrown ends the process, which is a finding. With VOLGI_FUZZ_SAY in the environment what is refused is said.
inline void read_or_refuse(const std::function<void()>& read) {
  static const bool says = std::getenv("VOLGI_FUZZ_SAY") != nullptr;
  try {
    read();
  } catch (const Error& e) {
    const std::string line = e.what();
    if (says) std::printf("  refused: %s\n", line.c_str());
    if (e.code() != ExitCode::bad_input && e.code() != ExitCode::over_limit)
      wrong("exit code " + std::to_string(int(e.code())) + ": " + line);
    if (line.empty() || line.find('\n') != std::string::npos) wrong("not one line: " + line);
  } catch (const std::bad_alloc&) {  // exit code 5
  }
}

}  // namespace volgi::fuzz
