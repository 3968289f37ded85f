#include "apps/volgi/metrics_json.h"

#include <optional>

namespace volgi::app {
namespace {

void put(nlohmann::ordered_json& json, const char* key, const std::optional<double>& value) {
  if (value) json[key] = *value;
}

}  // namespace

nlohmann::ordered_json to_json(const Metrics& m) {
  nlohmann::ordered_json json{{"pixels", m.pixels}, {"nonfinite", m.nonfinite}, {"negative", m.negative}};
  if (m.pixels == 0) return json;
  json["ref_mean"] = m.ref_mean;
  json["test_mean"] = m.test_mean;
  json["test_max"] = m.test_max;
  json["mean_absolute"] = m.mean_absolute;
  json["max_absolute"] = m.max_absolute;
  if (!m.relative) return json;
  const Metrics::Relative& r = *m.relative;
  json["ratio"] = r.ratio;
  json["ratio_rgb"] = r.ratio_rgb;
  json["rmse_pct"] = r.rmse_pct;
  put(json, "rmse_pct_denoised", r.rmse_pct_denoised);
  json["relmse"] = r.relmse;
  put(json, "relmse_denoised", r.relmse_denoised);
  json["p95_percent"] = r.p95_percent;
  put(json, "blk_pct", r.blk_pct);
  put(json, "blkmax_pct", r.blkmax_pct);
  put(json, "blkbias_pct", r.blkbias_pct);
  json["scale"] = r.scale;
  json["ssim"] = r.ssim;  // null when there is no figure
  return json;
}

}  // namespace volgi::app
