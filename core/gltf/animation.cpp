#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/error.h"
#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

Channel::Interpolation interpolation_of(const Document& document, const std::string& name, const std::string& who) {
  if (name == "LINEAR" || name.empty()) return Channel::Interpolation::linear;
  if (name == "STEP") return Channel::Interpolation::step;
  if (name == "CUBICSPLINE") return Channel::Interpolation::cubic;
  refuse(document.path, fmt::format("{} has the unknown interpolation '{}'", who, name));
}

size_t values_per_key(const Channel& channel) { return channel.interpolation == Channel::Interpolation::cubic ? 3 : 1; }

/// @param first  of the components that are wanted: up to four of them.
glm::dvec4 value_at(const Channel& channel, size_t key, size_t which, size_t first = 0) {
  const float* v = &channel.values[(key * values_per_key(channel) + which) * channel.components];
  glm::dvec4 out(0.0);
  for (size_t c = first; c < std::min(channel.components, first + 4); ++c) out[int(c - first)] = double(v[c]);
  return out;
}

glm::dvec4 key_value(const Channel& channel, size_t key, size_t first = 0) {
  return value_at(channel, key, channel.interpolation == Channel::Interpolation::cubic ? 1 : 0, first);
}

/// False, with a warning, for a channel that cannot be played: the picture needs none.
bool keys_are_good(const Document& document, const Channel& channel, const std::string& who) {
  const auto& times = channel.times_s;
  const auto ignored = [&](const std::string& why) {
    repair(document, fmt::format("{}: {}; it is ignored", who, why));
    return false;
  };
  if (times.empty()) return ignored("it has no keys");
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
    return ignored("its key times do not increase");
  const size_t expected = times.size() * values_per_key(channel) * channel.components;
  if (channel.values.size() != expected)
    return ignored(fmt::format("{} numbers for {} keys instead of {}", channel.values.size(), times.size(), expected));
  for (size_t key = 0; channel.path == Channel::Path::rotation && key < times.size(); ++key) {
    if (!(glm::length(key_value(channel, key)) > 1e-6))
      return ignored(fmt::format("the rotation of key {} is not a unit quaternion", key));
  }
  return true;
}

size_t targets_of(const Document& document, const Node& node) {
  if (node.mesh < 0) return 0;
  size_t most = 0;
  for (const auto& primitive : document.model.meshes[size_t(node.mesh)].primitives)
    most = std::max(most, primitive.targets.size());
  return most;
}

/// Nothing for targets that are ignored.
std::optional<Channel> read_channel(const Document& document, const tinygltf::Animation& animation,
                                    const tinygltf::AnimationChannel& in, const std::vector<Node>& nodes,
                                    const std::string& who) {
  Channel channel;
  if (in.target_path == "translation") {
    channel.path = Channel::Path::translation;
  } else if (in.target_path == "rotation") {
    channel.path = Channel::Path::rotation;
    channel.components = 4;
  } else if (in.target_path == "scale") {
    channel.path = Channel::Path::scale;
  } else if (in.target_path == "weights") {
    channel.path = Channel::Path::weights;
  } else {
    warn(document.path, fmt::format("animation of '{}' is ignored", in.target_path));
    return std::nullopt;
  }
  if (in.target_node < 0) return std::nullopt;  // for extensions
  check_index(document, in.target_node, nodes.size(), who, "node");
  channel.node = in.target_node;
  if (channel.path == Channel::Path::weights) channel.components = targets_of(document, nodes[size_t(channel.node)]);
  if (channel.components == 0) return std::nullopt;
  if (nodes[size_t(channel.node)].matrix && channel.path != Channel::Path::weights) {
    repair(document, fmt::format("{} animates node {}, which has a matrix; it is ignored", who, channel.node));
    return std::nullopt;
  }
  check_index(document, in.sampler, animation.samplers.size(), who, "animation sampler");
  const tinygltf::AnimationSampler& sampler = animation.samplers[size_t(in.sampler)];
  channel.interpolation = interpolation_of(document, sampler.interpolation, who);
  channel.times_s = read_elements(document, sampler.input, {{1}, false, false}, who + " input").values;
  const bool rotates = channel.path == Channel::Path::rotation;
  const bool weighs = channel.path == Channel::Path::weights;
  channel.values = read_elements(document, sampler.output,
                                 {{weighs ? 1 : channel.components}, rotates || weighs, false}, who + " output")
                       .values;
  if (!keys_are_good(document, channel, who)) return std::nullopt;
  return channel;
}

glm::dquat quaternion(glm::dvec4 xyzw) { return glm::normalize(glm::dquat(xyzw.w, xyzw.x, xyzw.y, xyzw.z)); }

/// glTF 2.0, appendix C.5; t in [0,1], step = seconds between the keys.
glm::dvec4 cubic(const Channel& channel, size_t key, double t, double step, size_t first) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * value_at(channel, key, 1, first) +
         step * (t3 - 2.0 * t2 + t) * value_at(channel, key, 2, first) +
         (3.0 * t2 - 2.0 * t3) * value_at(channel, key + 1, 1, first) +
         step * (t3 - t2) * value_at(channel, key + 1, 0, first);
}

glm::dvec4 sample(const Channel& channel, double time_s, size_t first = 0) {
  const auto& times = channel.times_s;
  if (!(time_s > times.front())) return key_value(channel, 0, first);
  if (time_s >= times.back()) return key_value(channel, times.size() - 1, first);
  const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time_s) - times.begin());
  const size_t key = next - 1;
  const double step = double(times[next]) - double(times[key]);
  const double t = (time_s - double(times[key])) / step;
  switch (channel.interpolation) {
    case Channel::Interpolation::step:
      return key_value(channel, key, first);
    case Channel::Interpolation::cubic:
      return cubic(channel, key, t, step, first);
    case Channel::Interpolation::linear:
      break;
  }
  if (channel.path != Channel::Path::rotation) {
    return glm::mix(key_value(channel, key, first), key_value(channel, next, first), t);
  }
  const glm::dquat q = glm::slerp(quaternion(key_value(channel, key)), quaternion(key_value(channel, next)), t);
  return {q.x, q.y, q.z, q.w};
}

}  // namespace

namespace {

/// Which animations play.
std::vector<size_t> chosen(const Document& document) {
  const auto& animations = document.model.animations;
  const std::string& asked = document.reading.animation;
  std::vector<size_t> all(animations.size());
  std::iota(all.begin(), all.end(), size_t(0));
  if (asked.empty() || asked == "all") return all;
  const bool number = asked.find_first_not_of("0123456789") == std::string::npos && asked.size() < 9;
  if (number && size_t(std::stoul(asked)) < all.size()) return {size_t(std::stoul(asked))};
  std::vector<std::string> names;
  for (const size_t a : all) {
    if (animations[a].name == asked) return {a};
    names.push_back(fmt::format("{} '{}'", a, animations[a].name));
  }
  throw Error(ExitCode::usage,
              fmt::format("--animation {}: {} has {}", asked, document.path.string(),
                          names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

std::vector<Channel> read_channels(const Document& document, const std::vector<Node>& nodes) {
  std::vector<Channel> channels;
  std::map<std::pair<int, Channel::Path>, size_t> first_to_move;
  for (const size_t a : chosen(document)) {
    const tinygltf::Animation& animation = document.model.animations[a];
    std::vector<Channel> own;
    bool moves_again = false;
    for (size_t c = 0; c < animation.channels.size(); ++c) {
      const std::string who = fmt::format("{} channel {}", element("animation", a, animation.name), c);
      auto channel = read_channel(document, animation, animation.channels[c], nodes, who);
      if (!channel) continue;
      const auto [first, is_new] = first_to_move.try_emplace({channel->node, channel->path}, a);
      moves_again |= !is_new && first->second != a;
      own.push_back(std::move(*channel));
    }
    if (moves_again && document.reading.animation.empty()) {
      warn(document.path, fmt::format("{} moves what one before it moves and does not play; --animation chooses",
                                      element("animation", a, animation.name)));
      continue;
    }
    std::move(own.begin(), own.end(), std::back_inserter(channels));
  }
  return channels;
}

void animate(std::vector<Node>& nodes, const std::vector<Channel>& channels, double time_s) {
  for (const Channel& channel : channels) {
    Node& node = nodes[size_t(channel.node)];
    if (channel.path == Channel::Path::weights) {
      node.morph_weights.resize(channel.components);
      for (size_t k = 0; k < channel.components; ++k) node.morph_weights[k] = sample(channel, time_s, k).x;
      continue;
    }
    const glm::dvec4 value = sample(channel, time_s);
    switch (channel.path) {
      case Channel::Path::translation:
        node.translation = glm::dvec3(value);
        break;
      case Channel::Path::scale:
        node.scale = glm::dvec3(value);
        break;
      case Channel::Path::rotation:
        // A spline may pass through zero, where no rotation is defined: the last one stays.
        if (glm::length(value) > 1e-9) node.rotation = quaternion(value);
        break;
      case Channel::Path::weights:
        break;
    }
  }
}

}  // namespace volgi::gltf
