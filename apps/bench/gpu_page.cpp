#include <fmt/format.h>

#include <algorithm>

#include "apps/bench/gpu.h"

namespace volgi::app {

namespace {

using Json = nlohmann::json;

double number(const Json& row, const char* name) { return row[name].get<double>(); }
std::string text(const Json& row, const char* name) { return row[name].get<std::string>(); }
std::string by(const Json& numbers) {
  std::string all;
  for (const Json& n : numbers) all += fmt::format("{}{}", all.empty() ? "" : " × ", n.get<int>());
  return all;
}

std::string passes_table(const Json& row) {
  std::string out =
      fmt::format("{} ({} triangles), `--gi {}`, {}, {:.0f} MiB, median of {}:\n\n| pass | ms |\n| --- | ---: |\n",
                  text(row, "scene"), row["triangles"].get<size_t>(), text(row, "recipe"), by(row["size"]),
                  number(row, "memory_bytes") / double(1 << 20), row["frames"].get<int>());
  for (const Json& pass : row["passes"])
    out += fmt::format("| `{}` | {:.3f} |\n", text(pass, "name"), number(pass, "ms"));
  return out + fmt::format("| all passes | {:.3f} |\n| **frame** | **{:.3f}** |\n\n", number(row, "all_passes_ms"),
                           number(row, "frame_ms"));
}

}  // namespace

std::string gpu_heading(const Json& r) {
  return fmt::format(
      "# {}: what the GPU does\n\n- OpenGL: {}\n- timer: {}\n- machine: {}\n- date: {}\n- command: `{}`\n\n"
      "Times are medians in ms, of {} frames unless a row says otherwise, after frames that warm up; the volume is on "
      "the "
      "GPU throughout.\n\n",
      text(r, "device"), text(r, "gl_version"),
      text(r, "timer") == "gpu" ? "gpu, timer queries" : "wall clock between two `glFinish`, a software rasterizer",
      text(r, "machine"), text(r, "date"), text(r, "command"), r["frames"].get<int>());
}

std::string gpu_copies_table(const Json& r) {
  std::string out =
      "## Copying\n\nA buffer to another on the GPU; each byte counts twice, read and written.\n\n"
      "| MiB | ms | GB/s |\n| ---: | ---: | ---: |\n";
  for (const Json& row : r["copies"]) {
    out += fmt::format("| {} | {:.4f} | {:.1f} |\n", row["mebibytes"].get<int>(), number(row, "ms"),
                       number(row, "gb_per_s"));
  }
  return out + "\n";
}

std::string gpu_error_table(const Json& r) {
  std::string out =
      "## Frame time against error\n\nIndirect light against the references in data/references, at their size: "
      "energy is the ratio of means, error the RMSE in % of the reference's mean, its noise taken out "
      "(`volgi compare`, rmse%*). `vpl` carries one bounce without shadows.\n\n"
      "| scene | size | options | frame ms | error % | energy | frames |\n"
      "| --- | --- | --- | ---: | ---: | ---: | ---: |\n";
  for (const Json& row : r["error"]) {
    out += fmt::format("| {} | {} | `{}` | {:.2f} | {:.2f} | {:.3f} | {} |\n", text(row, "scene"), by(row["size"]),
                       text(row, "options"), number(row, "frame_ms"), number(row, "error_percent"),
                       number(row, "energy"), row["frames"].get<int>());
  }
  return out + "\n";
}

std::string gpu_volume_table(const Json& r) {
  std::string out = fmt::format(
      "## The volume\n\n`--gi volume --scheme ordinates`. A sweep is one pass over the volume by itself; its bytes are "
      "what "
      "it must move at least (`OrdinatesTransportGl::moved_bytes_for`), its share is of the best copy above, {:.1f} "
      "GB/s.\n\n"
      "| scene | grid | sides | directions | voxelization ms | propagation ms | passes | sweep ms | dispatches | sweep "
      "MB | "
      "GB/s | share of copy | frames |\n"
      "| --- | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
      number(r, "copy_gb_per_s"));
  for (const Json& row : r["volume"]) {
    out += fmt::format(
        "| {} | {} | {} | {}, {} | {:.3f} | {:.3f} | {}{} | {:.3f} | {} | {:.1f} | {:.1f} | {:.2f} | {} |\n",
        text(row, "scene"), by(row["grid"]), row["sides"].get<size_t>(), row["directions"].get<int>(),
        text(row, "rule"), number(row, "voxelization_ms"), number(row, "propagation_ms"), row["passes"].get<int>(),
        row["converged"].get<bool>() ? "" : ", not converged", number(row, "sweep_ms"), row["dispatches"].get<int>(),
        1e-6 * number(row, "sweep_bytes"), number(row, "gb_per_s"), number(row, "share_of_copy"),
        row["frames"].get<int>());
  }
  return out + "\n";
}

std::string gpu_passes_tables(const Json& r) {
  std::string out = "## Passes\n\n";
  for (const Json& row : r["passes"]) out += passes_table(row);
  return out;
}

std::string gpu_skipped_list(const Json& r) {
  if (r["skipped"].empty()) return "";
  std::string out = fmt::format("## Skipped\n\nFor want of time (`--budget {:g}`):\n\n", number(r, "budget_s"));
  for (const Json& row : r["skipped"]) {
    out += fmt::format("- {}: {}, estimated to take {:.0f} s where {:.0f} s were left\n", text(row, "part"),
                       text(row, "what"), number(row, "estimate_s"), number(row, "left_s"));
  }
  return out + "\n";
}

std::string gpu_page(const Json& r) {
  return gpu_heading(r) + gpu_copies_table(r) + gpu_error_table(r) + gpu_volume_table(r) + gpu_passes_tables(r) +
         gpu_skipped_list(r);
}

}  // namespace volgi::app
