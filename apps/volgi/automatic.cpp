#include "apps/volgi/automatic.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "apps/volgi/front_file.h"
#include "apps/volgi/picture_facts.h"
#include "core/error.h"

namespace volgi::app {

namespace {

/// What was asked for, with a setting in place of auto.
FrameCommandOptions with_setting(FrameCommandOptions asked, const screen::FrontSetting& setting) {
  CLI::App command;
  FrameCommandOptions chosen;
  chosen.add_to(command);
  command.parse(std::vector<std::string>(setting.options.rbegin(), setting.options.rend()));
  asked.gi = chosen.gi;
  asked.budget.clear();
  asked.explain = false;
  asked.quality = chosen.quality;
  asked.cells_times = chosen.cells_times;
  asked.lights_times = chosen.lights_times;
  asked.flagged.insert(chosen.flagged.begin(), chosen.flagged.end());
  asked.parameters.insert(asked.parameters.begin(), chosen.parameters.begin(), chosen.parameters.end());
  return asked;
}

bool goes_with(const FrameCommandOptions& asked, const screen::FrontSetting& setting, glm::ivec2 size) {
  try {
    with_setting(asked, setting).frame_options(size);
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::string in_words(const screen::Prediction& p) {
  return p.ms && p.error_percent ? fmt::format("about {:.3g} ms and {:.2g} % of error", *p.ms, *p.error_percent)
                                 : std::string("not known");
}

}  // namespace

std::string Automatic::summary() const {
  const screen::FrontSetting& setting = front.settings[choice.setting];
  const std::string of_device = calibrated
                                    ? fmt::format("times measured on this device, {}", front.date)
                                    : fmt::format("times of {}; volgi calibrate measures this device", front.device);
  return fmt::format(
      "auto: {}{}: {}\nauto: by {} settings on {} scenes, {} the most alike; {}\n",
      choice.reached ? std::string() : fmt::format("nothing keeps {}; nearest ", budget.text()),
      fmt::format("{}{}", fmt::join(setting.options, " "), choice.reached ? fmt::format(" for {}", budget.text()) : ""),
      in_words(choice.predictions[choice.setting]), front.settings.size(), front.scenes.size(),
      fmt::join(choice.nearest, " and "), of_device);
}

std::string Automatic::rejected() const {
  std::string text;
  const bool by_time = budget.kind == screen::Budget::Kind::time;
  for (size_t s = 0; s < front.settings.size(); ++s) {
    if (s == choice.setting) continue;
    const screen::Prediction& p = choice.predictions[s];
    std::string why = by_time ? "errs more" : "takes longer";
    if (p.ms && p.error_percent && (by_time ? *p.ms : *p.error_percent) * choice.margin > budget.amount)
      why = by_time ? "takes too long" : "errs too much";
    if (!choice.allowed[s]) why = "does not go with the other options";
    text += fmt::format("  {:<54} {:>9.4g} ms {:>8.3g} %  {}\n",
                        fmt::format("{}", fmt::join(front.settings[s].options, " ")), p.ms.value_or(0.0),
                        p.error_percent.value_or(0.0), why);
  }
  return text + (choice.margin > 1.0
                     ? fmt::format("  (predictions times {:.2f}: so that nine in ten are kept)\n", choice.margin)
                     : std::string());
}

nlohmann::json Automatic::json() const {
  nlohmann::json settings = nlohmann::json::array();
  for (size_t s = 0; s < front.settings.size(); ++s) {
    const screen::Prediction& p = choice.predictions[s];
    settings.push_back({{"options", front.settings[s].options},
                        {"ms", p.ms ? nlohmann::json(*p.ms) : nlohmann::json()},
                        {"error_percent", p.error_percent ? nlohmann::json(*p.error_percent) : nlohmann::json()},
                        {"allowed", bool(choice.allowed[s])}});
  }
  return {{"budget", budget.text()},   {"chosen", front.settings[choice.setting].options},
          {"reached", choice.reached}, {"margin", choice.margin},
          {"alike", choice.nearest},   {"device", front.device},
          {"calibrated", calibrated},  {"settings", settings}};
}

std::optional<Automatic> choose_automatically(const FrameCommandOptions& asked, const Scene& scene,
                                              const Camera& camera, glm::ivec2 size, const std::string& device,
                                              bool one_picture) {
  if (!asked.automatic()) return std::nullopt;
  Automatic out;
  out.budget = screen::parse_budget(asked.budget);
  screen::FrameOptions options = asked.frame_options(size);
  const auto fitted = asked.fit(scene, glm::vec3(camera.world_from_camera[3]), 0, options);
  const screen::PictureFacts facts = picture_facts(scene, camera, fitted.facts, options.of<VolumeOptions>().grid_box);
  const std::filesystem::path file = device_times_path(device);
  const std::optional<DeviceTimes> times = file.empty() ? std::nullopt : read_device_times(file);
  out.calibrated = times.has_value();
  out.front = times ? screen::on_device(shipped_front(), factors_of(*times, shipped_front())) : shipped_front();
  const auto allowed = [&](const screen::FrontSetting& setting) {
    return (!one_picture || setting.pictures == 1) && goes_with(asked, setting, size);
  };
  out.choice = screen::choose(out.front, facts, double(size.x) * size.y, options.light, out.budget, allowed);
  out.frame = with_setting(asked, out.front.settings[out.choice.setting]);
  out.frame.facts = fitted.facts;
  return out;
}

}  // namespace volgi::app
