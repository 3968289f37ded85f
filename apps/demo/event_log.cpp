#include "apps/demo/event_log.h"

#include "core/error.h"

namespace volgi::demo {

EventLog::EventLog(const std::filesystem::path& file) {
  if (file.empty()) return;
  out_.open(file);
  if (!out_) throw Error(ExitCode::cannot_write, file.string() + ": cannot be written");
}

void EventLog::add(const std::string& event, nlohmann::json more) {
  if (!out_.is_open()) return;
  more["s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  more["event"] = event;
  out_ << more.dump() << '\n' << std::flush;
}

}  // namespace volgi::demo
