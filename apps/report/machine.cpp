#include "apps/report/machine.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/error.h"
#include "volgi_version.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ExitCode::bad_input, path.string() + ": cannot read this file");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

}  // namespace

std::uint64_t content_hash(std::string_view bytes, std::uint64_t hash) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::uint64_t scene_hash(const fs::path& path) {
  const std::string bytes = read_bytes(path);
  std::uint64_t hash = content_hash(bytes);
  if (path.extension() != ".gltf") return hash;
  const nlohmann::json gltf = nlohmann::json::parse(bytes, nullptr, false);
  for (const char* kind : {"buffers", "images"}) {
    if (!gltf.is_object() || !gltf.contains(kind) || !gltf[kind].is_array()) continue;
    for (const nlohmann::json& entry : gltf[kind]) {
      const std::string uri = entry.is_object() && entry.contains("uri") && entry["uri"].is_string()
                                  ? entry["uri"].get<std::string>()
                                  : std::string();
      const fs::path file = path.parent_path() / uri;
      if (!uri.empty() && fs::is_regular_file(file)) hash = content_hash(read_bytes(file), hash);
    }
  }
  return hash;
}

std::string machine_name() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return fmt::format("{}, {} threads, {:.0f} GiB", processor(), std::thread::hardware_concurrency(),
                     bytes / double(1 << 30));
}

std::string program_name() {
  static const std::string name =
      fmt::format("{} (build {})", VOLGI_VERSION, hex(content_hash(read_bytes("/proc/self/exe"))));
  return name;
}

std::string date_now() {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::chrono::system_clock::now()));
}

}  // namespace volgi::app
