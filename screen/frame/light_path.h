#pragma once
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

namespace volgi::screen {

/// What of the light a picture shows (--light). `direct`: straight from any emitter to the surface, plus emission seen
/// by the camera; `indirect`: after at least one reflection before the visible surface.
enum class LightPart { full, direct, indirect };

/// Kinds of ways from a source to the camera, by the source and by reflections before the visible surface. Every
/// picture is a sum over them, each counted once: by one layer, or by a near and a far one that split it.
enum class LightPath : std::uint8_t {
  emission_seen,    // from an emissive surface to the camera
  punctual_direct,  // punctual light on the visible surface
  emission_direct,  // emission's arrival on the visible surface, bounce 0
  punctual_first,   // punctual light after one reflection, bounce 1
  emission_first,   // emission after one reflection, bounce 1
  punctual_higher,  // bounces 2 ... n
  emission_higher,  // bounces 2 ... n
  sky_seen,         // from the sky to the camera
  sky_direct,       // light straight from the sky on the visible surface
  sky_first,        // sky light after one reflection, bounce 1
  sky_higher,       // bounces 2 ... n
};
inline constexpr int LIGHT_PATH_COUNT = 11;

/// A set of them.
class LightPaths {
 public:
  constexpr LightPaths() = default;
  constexpr LightPaths(std::initializer_list<LightPath> paths) {
    for (const LightPath p : paths) bits_ |= std::uint32_t(1) << int(p);
  }
  static constexpr LightPaths all() { return LightPaths((1u << LIGHT_PATH_COUNT) - 1u); }
  constexpr bool contains(LightPath p) const { return (bits_ >> int(p) & 1u) != 0; }
  constexpr bool meets(LightPaths o) const { return (bits_ & o.bits_) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr LightPaths operator|(LightPaths o) const { return LightPaths(bits_ | o.bits_); }
  constexpr LightPaths operator&(LightPaths o) const { return LightPaths(bits_ & o.bits_); }
  constexpr LightPaths operator-(LightPaths o) const { return LightPaths(bits_ & ~o.bits_); }
  constexpr bool operator==(const LightPaths&) const = default;

 private:
  explicit constexpr LightPaths(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

inline constexpr LightPaths DIRECT_PATHS{LightPath::emission_seen, LightPath::punctual_direct,
                                         LightPath::emission_direct, LightPath::sky_seen, LightPath::sky_direct};
inline constexpr LightPaths INDIRECT_PATHS = LightPaths::all() - DIRECT_PATHS;
inline constexpr LightPaths EMISSION_PATHS{LightPath::emission_seen, LightPath::emission_direct,
                                           LightPath::emission_first, LightPath::emission_higher};
inline constexpr LightPaths SKY_PATHS{LightPath::sky_seen, LightPath::sky_direct, LightPath::sky_first,
                                      LightPath::sky_higher};
inline constexpr LightPaths PUNCTUAL_PATHS = LightPaths::all() - EMISSION_PATHS - SKY_PATHS;

/// What a layer or a stage has of its paths. `near` and `far` are the two parts of a whole; `mirror` is what the
/// visible surface's mirror of facets reflects of it, where a stage has that apart and the whole is the rest
/// (GBuffer::set_mirror_apart).
enum class LightShare { whole, near, far, mirror };
inline constexpr int LIGHT_SHARE_COUNT = 4;

/// In words, for messages: "light straight from emissive surfaces".
const char* in_words(LightPath path);
std::string in_words(LightPaths paths);  // "a, b and c"

/// What --light and --bounces ask for. @param bounces  reflections; 0: direct light alone; none: all of them.
LightPaths asked_paths(LightPart part, std::optional<int> bounces);

}  // namespace volgi::screen
