#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace volgi::app {

/// 64-bit FNV-1a, going on from `hash`: tells contents apart, protects against nobody.
std::uint64_t content_hash(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325u);
std::string hex(std::uint64_t hash);  // 16 digits

/// Hash of a scene's file and, for .gltf, of the buffers and images that it names.
/// @throws Error(bad_input) if the file cannot be read.
std::uint64_t scene_hash(const std::filesystem::path& path);

/// Processor, threads and memory: "AMD EPYC 9B14, 2 threads, 24 GiB".
std::string machine_name();
/// Version and hash of the running program's file, so that figures of two builds are never taken for one another.
std::string program_name();
/// Now, in UTC: "2026-11-23 02:10:05 UTC".
std::string date_now();

}  // namespace volgi::app
