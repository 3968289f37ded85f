#include "core/virtual_light_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi {
namespace {

constexpr const char* kFormat = "volgi virtual lights 1";
constexpr size_t kMaxLights = size_t{1} << 22;  // 200 MB of them; a renderer's list has thousands
constexpr double kUnitTolerance = 1e-4;         // of a normal's length: a float's rounding is 1e-7, a half's 5e-4
constexpr std::array<const char*, 4> kKinds = {"reflected", "emitted", "negative", "lattice"};  // VIRTUAL_LIGHT_*

enum Field { kind, source, position, normal, flux, area, field_count };
constexpr std::array<const char*, field_count> kFields = {"kind", "source", "position", "normal", "flux", "area_m2"};

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// What is wrong with a light, "" if nothing. A light without flux stands for nothing, so its normal may be anything.
std::string complaint(const shared::VirtualLight& light) {
  if (light.kind < 0 || light.kind >= static_cast<int>(kKinds.size())) return "kind is not one of the four";
  if (light.source < -1) return "source must be the index of a light, or -1";
  if (!finite(light.position)) return "position must be finite";
  if (!finite(light.flux) || glm::any(glm::lessThan(light.flux, glm::vec3(0.0f))))
    return "flux must be finite and not negative";
  if (!std::isfinite(light.area_m2) || light.area_m2 < 0.0f) return "area_m2 must be finite and not negative";
  if (!finite(light.normal)) return "normal must be finite";
  const double length = glm::length(glm::dvec3(light.normal));
  if (light.flux != glm::vec3(0.0f) && std::abs(length - 1.0) > kUnitTolerance)
    return fmt::format("normal must have length 1, it has {:.6g}", length);
  return {};
}

/// Text of a file that may hold anything, for a message.
std::string printable(std::string_view text) {
  constexpr size_t longest = 60;
  std::string line(text.substr(0, longest));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c < 32 || c > 126; }, ' ');
  return text.size() > longest ? line + "..." : line;
}

/// Reads as the parser goes, so that a message can name the light and the field, and that a file of any size is refused
/// after as much memory as its lights need. Depth 1 is the file's object, 2 its origin and its list, 3 a light, 4 a
/// light's vectors.
class ListReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit ListReader(const std::filesystem::path& file) : file_(file) {}

  VirtualLightList take() {
    if (!has_format_) refuse_format();
    for (const auto& [there, name] : {std::pair(has_origin_, "world_origin"), std::pair(has_lights_, "lights")})
      if (!there) refuse(fmt::format("{} is missing", name));
    return std::move(list_);
  }

  bool start_object(std::size_t) override {
    if (depth_ == 2 && in_lights_) {
      if (list_.lights.size() == kMaxLights) refuse(fmt::format("more than {} lights", kMaxLights));
      list_.lights.emplace_back();
      seen_.fill(false);
    } else if (depth_ != 0) {
      wrong_type("an object");
    }
    ++depth_;
    return true;
  }

  bool key(string_t& name) override {
    if (depth_ == 1) {
      root_key(name);
    } else {
      const auto* found = std::find(kFields.begin(), kFields.end(), name);
      field_.reset();
      if (found == kFields.end()) refuse(fmt::format("unknown field '{}'", printable(name)));
      field_ = static_cast<Field>(found - kFields.begin());
      if (std::exchange(seen_[*field_], true)) refuse("is given twice");
    }
    return true;
  }

  bool end_object() override {
    --depth_;
    field_.reset();
    if (depth_ == 2) end_light();
    return true;
  }

  bool start_array(std::size_t) override {
    const bool vector_of_light = depth_ == 3 && field_ && *field_ >= position && *field_ <= flux;
    const bool of_root = depth_ == 1 && (root_key_ == "world_origin" || root_key_ == "lights");
    if (!vector_of_light && !of_root) wrong_type("a list");
    in_lights_ = in_lights_ || root_key_ == "lights";
    numbers_ = 0;
    ++depth_;
    return true;
  }

  bool end_array() override {
    --depth_;
    if (depth_ == 1 && in_lights_) {
      in_lights_ = false;
      return true;
    }
    if (numbers_ != 3) refuse(fmt::format("must have 3 numbers, it has {}", numbers_));
    return true;
  }

  bool string(string_t& text) override {
    if (depth_ == 1 && root_key_ == "format") {
      if (text != kFormat) refuse_format();
      has_format_ = true;
    } else if (depth_ == 3 && field_ == kind) {
      const auto* found = std::find(kKinds.begin(), kKinds.end(), text);
      if (found == kKinds.end())
        refuse(fmt::format("must be \"reflected\", \"emitted\" or \"negative\", not \"{}\"", printable(text)));
      light().kind = static_cast<int>(found - kKinds.begin());
    } else {
      wrong_type("a string");
    }
    return true;
  }

  bool number_integer(number_integer_t value) override {
    if (depth_ != 3 || field_ != source) return number(static_cast<double>(value));
    if (value < -1 || value > std::numeric_limits<int>::max()) refuse("must be the index of a light, or -1");
    light().source = static_cast<int>(value);
    return true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    constexpr auto largest = number_unsigned_t(std::numeric_limits<number_integer_t>::max());
    return value <= largest ? number_integer(static_cast<number_integer_t>(value)) : number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }

  bool null() override { return wrong_type("null"); }
  bool boolean(bool) override { return wrong_type("true or false"); }
  bool binary(binary_t&) override { return wrong_type("binary data"); }

  bool parse_error(std::size_t at, const std::string& token, const nlohmann::json::exception& error) override {
    constexpr int number_overflow = 406;
    if (error.id == number_overflow) refuse(fmt::format("{} is too large for a number", printable(token)));
    refuse(fmt::format("not JSON at byte {}, near '{}'", at, printable(token)));
  }

 private:
  [[noreturn]] void refuse_format() const {
    throw Error(ExitCode::bad_input,
                fmt::format("{}: not a list of virtual lights: \"format\" must be \"{}\"", file_.string(), kFormat));
  }

  /// FILE: light 3: flux: WHAT.
  [[noreturn]] void refuse(const std::string& what) const {
    std::string where;
    if (in_lights_ && depth_ > 2) where += fmt::format("light {}: ", list_.lights.size() - 1);
    if (in_lights_ && depth_ > 2 && field_) where += fmt::format("{}: ", kFields[*field_]);
    if (!in_lights_ && depth_ > 0 && !root_key_.empty()) where += fmt::format("{}: ", root_key_);
    throw Error(ExitCode::bad_input, fmt::format("{}: {}{}", file_.string(), where, what));
  }

  bool wrong_type(const char* got) const {
    if (depth_ == 0) refuse_format();
    if (depth_ == 2 && in_lights_) refuse(fmt::format("light {}: must be an object, not {}", list_.lights.size(), got));
    if (depth_ == 1 && root_key_ == "format") refuse_format();
    refuse(fmt::format("must be {}, not {}", wanted(), got));
  }

  const char* wanted() const {
    if (depth_ == 1 && root_key_ == "lights") return "a list of lights";
    if (depth_ == 1) return "a list of 3 numbers";
    if (depth_ == 3 && field_ == kind) return "a string";
    if (depth_ == 3 && field_ == source) return "a whole number";
    return depth_ == 3 && field_ != area ? "a list of 3 numbers" : "a number";
  }

  void root_key(const std::string& name) {
    bool* const has = name == "format" ? &has_format_ : name == "lights" ? &has_lights_ : &has_origin_;
    if (name != "format" && name != "lights" && name != "world_origin") {
      if (!has_format_) refuse_format();
      root_key_.clear();
      refuse(fmt::format("unknown field '{}'", printable(name)));
    }
    root_key_ = name;
    if (std::exchange(*has, true)) refuse("is given twice");
    if (name == "format") has_format_ = false;  // until its text is seen to be right
  }

  bool number(double value) {
    if (depth_ == 2 && !in_lights_) {
      if (!std::isfinite(value)) refuse("must be finite");
      if (numbers_ < 3) list_.world_origin[numbers_] = value;
      ++numbers_;
      return true;
    }
    if (depth_ == 3 && field_ == source) refuse("must be a whole number");
    const bool vector = depth_ == 4, scalar = depth_ == 3 && field_ == area;
    if (!vector && !scalar) return wrong_type("a number");
    const auto narrow = static_cast<float>(value);
    if (!std::isfinite(narrow)) refuse(fmt::format("{:g} is too large for a float", value));
    if (scalar) {
      light().area_m2 = narrow;
    } else {
      if (numbers_ < 3)
        (*field_ == position ? light().position : *field_ == normal ? light().normal : light().flux)[numbers_] = narrow;
      ++numbers_;
    }
    return true;
  }

  void end_light() const {
    const std::string who = fmt::format("{}: light {}: ", file_.string(), list_.lights.size() - 1);
    for (size_t i = 0; i < kFields.size(); ++i)
      if (!seen_[i]) throw Error(ExitCode::bad_input, fmt::format("{}{} is missing", who, kFields[i]));
    const std::string wrong = complaint(list_.lights.back());
    if (!wrong.empty()) throw Error(ExitCode::bad_input, who + wrong);
  }

  shared::VirtualLight& light() { return list_.lights.back(); }

  const std::filesystem::path& file_;
  VirtualLightList list_;
  int depth_ = 0;
  int numbers_ = 0;  // of the vector being read
  std::string root_key_;
  bool in_lights_ = false;
  std::optional<Field> field_;
  std::array<bool, field_count> seen_{};
  bool has_format_ = false, has_origin_ = false, has_lights_ = false;
};

// A float is written as the double it is, which reads back as the same float; 9 digits would be rounded twice.
nlohmann::ordered_json numbers(glm::dvec3 v) { return {v.x, v.y, v.z}; }

nlohmann::ordered_json to_json(const shared::VirtualLight& light) {
  return {{"kind", kKinds[static_cast<size_t>(light.kind)]},
          {"source", light.source},
          {"position", numbers(light.position)},
          {"normal", numbers(light.normal)},
          {"flux", numbers(light.flux)},
          {"area_m2", double(light.area_m2)}};
}

}  // namespace

void write_virtual_lights(const std::filesystem::path& file, const VirtualLightList& list) {
  for (size_t i = 0; i < list.lights.size(); ++i) {
    const std::string wrong = complaint(list.lights[i]);
    if (!wrong.empty())
      throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: light {}: {}", file.string(), i, wrong));
  }
  std::string text = fmt::format("{{\"format\": \"{}\",\n \"world_origin\": {},\n \"lights\": [", kFormat,
                                 numbers(list.world_origin).dump());
  for (size_t i = 0; i < list.lights.size(); ++i) text += (i == 0 ? "\n  " : ",\n  ") + to_json(list.lights[i]).dump();
  write_text_atomically(file, text + "]}\n");
}

VirtualLightList read_virtual_lights(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file, ignored))
    throw Error(ExitCode::bad_input, fmt::format("{}: no such file, or it cannot be read", file.string()));
  ListReader reader(file);
  nlohmann::json::sax_parse(in, &reader);
  return reader.take();
}

}  // namespace volgi
