#include "apps/volgi/shared_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "apps/volgi/parse_number.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi::app {
namespace fs = std::filesystem;

namespace {

std::vector<std::string> words_of_this_process() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  if (!words.empty()) words.erase(words.begin());
  return words;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::string shared_command(const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 4> WITH_VALUE{"--share", "--stats", "--device", "--threads"};
  constexpr std::array<std::string_view, 2> ALONE{"--quiet", "--gl-debug"};
  std::string text;
  for (size_t k = 0; k < words.size(); ++k) {
    const std::string_view name = std::string_view(words[k]).substr(0, words[k].find('='));
    if (std::ranges::find(ALONE, name) != ALONE.end()) continue;
    if (std::ranges::find(WITH_VALUE, name) != WITH_VALUE.end()) {
      k += name.size() == words[k].size() ? 1 : 0;
      continue;
    }
    text += (text.empty() ? "" : " ") + words[k];
  }
  return text;
}

SharedFrames::SharedFrames(const fs::path& folder) : claims_(folder) {
  const fs::path file = folder / "command.txt";
  const std::string own = shared_command(words_of_this_process());
  const Claims::Claim claim = claims_.wait_for("command");
  if (!fs::exists(file)) write_text_atomically(file, own);
  const std::string others = text_of(file);
  if (others != own)
    throw Error(ExitCode::usage, fmt::format("--share {}: that folder is of another command, '{}', and this is '{}'; "
                                             "take another folder, or remove that one",
                                             folder.string(), others, own));
}

void SharedFrames::work(int first, int count, const std::function<void(int)>& frame) {
  const auto name = [&](int k) { return fmt::format("frame-{:04}", first + k); };
  const auto done_file = [&](int k) { return claims_.folder() / (name(k) + ".done"); };
  claims_.work(
      count, name, [&](int k) { return fs::exists(done_file(k)); },
      [&](int k) {
        frame(first + k);
        write_text_atomically(done_file(k), "");
      });
}

void SharedFrames::keep_exposure(float stops) {
  write_text_atomically(claims_.folder() / "exposure.txt",
                        fmt::format("{}", stops));  // as many digits as it takes to be the same
}

float SharedFrames::exposure() const {
  const fs::path file = claims_.folder() / "exposure.txt";
  const std::optional<float> stops = parse_number<float>(text_of(file));
  if (!stops) throw Error(ExitCode::bad_input, file.string() + ": no exposure; remove the folder and begin again");
  return *stops;
}

}  // namespace volgi::app
