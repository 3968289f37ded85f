#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace volgi {

/// Writes TARGET so that a killed run never leaves half a file: `write` gets a temporary name beside the target (same
/// extension), which is renamed over the target when `write` returns and removed when it throws.
/// @throws Error(cannot_write) if the folder does not exist or cannot be written, naming the path.
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write);

/// Writes a text so.
/// @throws Error(cannot_write) as well where not all of it could be written, as on a full disk.
void write_text_atomically(const std::filesystem::path& target, std::string_view text);

/// Throws what write_atomically(target) would throw before it writes: for finding out before minutes of work.
void check_writable(const std::filesystem::path& target);

}  // namespace volgi
