#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct GpuBenchOptions {
  int frames = 5;                    // measured, after two that warm up
  double budget_s = 300.0;           // of wall time, about
  bool quick = false;                // cornell alone, small: a test of the benchmark itself
  std::filesystem::path references;  // folder of SCENE.exr
  /// The pages are made of it: how these figures come about.
  std::string command, date, machine;
};

/// What a GPU does with volgi, all on the device of `context`, in parts:
/// - copies: a buffer to another on the GPU, several sizes. GB/s counts every byte twice, read and written.
/// - error: frame time and error of indirect light against the references of cornell and room, at their size, for a few
///   settings; RMSE as Yardstick has it.
/// - volume: cornell at several numbers of cells, scheme ordinates: voxelization and propagation of a frame, passes
///   over the volume, and a sweep alone. A sweep's share of the copy bandwidth is what it must move
///   (OrdinatesTransportGl::moved_bytes_for) over its time, over the best copy. It is below 1 where a sweep waits or
///   moves more, and may be above where caches hold the planes.
/// - passes: every pass of the default recipe for cornell and atrium at 512 x 512 and 1920 x 1080.
/// The volume is on the GPU in all of them. Sizes grow within a part. Where the time left is short, frames become 1,
/// and what would exceed it by the time that smaller sizes took is listed in `skipped`: all ends in about budget_s on a
/// software rasterizer too.
/// @param show  called with each part as Markdown, as soon as it is there.
/// @throws Error(bad_input) for a scene or reference that is not there.
nlohmann::json bench_gpu(const std::function<Scene(const std::string&)>& scene, const gl::Context& context,
                         const GpuBenchOptions& options, const std::function<void(const std::string&)>& show);

/// Results of bench_gpu as Markdown: a part, and the whole page.
std::string gpu_heading(const nlohmann::json& r);
std::string gpu_copies_table(const nlohmann::json& r);
std::string gpu_error_table(const nlohmann::json& r);
std::string gpu_volume_table(const nlohmann::json& r);
std::string gpu_passes_tables(const nlohmann::json& r);
std::string gpu_skipped_list(const nlohmann::json& r);
std::string gpu_page(const nlohmann::json& r);

}  // namespace volgi::app
