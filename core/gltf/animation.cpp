#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

glm::dvec4 value_at(const Channel& channel, size_t key, size_t which) {
  const float* v = &channel.values[(key * values_per_key(channel) + which) * channel.components];
  return {v[0], v[1], v[2], channel.components == 4 ? v[3] : 0.0f};
}

glm::dvec4 key_value(const Channel& channel, size_t key) {
  return value_at(channel, key, channel.interpolation == Channel::Interpolation::cubic ? 1 : 0);
}

void check_keys(const Document& document, const Channel& channel, const std::string& who) {
  const auto& times = channel.times_s;
  if (times.empty() || std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end()) {
    refuse(document.path, fmt::format("{}: its key times do not increase", who));
  }
  const size_t expected = times.size() * values_per_key(channel) * channel.components;
  if (channel.values.size() != expected) {
    refuse(document.path,
           fmt::format("{}: {} numbers for {} keys instead of {}", who, channel.values.size(), times.size(), expected));
  }
  for (size_t key = 0; channel.path == Channel::Path::rotation && key < times.size(); ++key) {
    if (!(glm::length(key_value(channel, key)) > 1e-6)) {
      refuse(document.path, fmt::format("{}: the rotation of key {} is not a unit quaternion", who, key));
    }
  }
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
  } else {
    warn(document.path, fmt::format("animation of '{}' is ignored", in.target_path));
    return std::nullopt;
  }
  check_index(document, in.target_node, nodes.size(), who, "node");
  channel.node = in.target_node;
  if (nodes[size_t(channel.node)].matrix) {
    refuse(document.path, fmt::format("{} animates node {}, which has a matrix", who, channel.node));
  }
  check_index(document, in.sampler, animation.samplers.size(), who, "animation sampler");
  const tinygltf::AnimationSampler& sampler = animation.samplers[size_t(in.sampler)];
  channel.interpolation = interpolation_of(document, sampler.interpolation, who);
  channel.times_s = read_elements(document, sampler.input, {{1}, false, false}, who + " input").values;
  const bool rotates = channel.path == Channel::Path::rotation;
  channel.values =
      read_elements(document, sampler.output, {{channel.components}, rotates, false}, who + " output").values;
  check_keys(document, channel, who);
  return channel;
}

glm::dquat quaternion(glm::dvec4 xyzw) { return glm::normalize(glm::dquat(xyzw.w, xyzw.x, xyzw.y, xyzw.z)); }

/// glTF 2.0, appendix C.5; t in [0,1], step = seconds between the keys.
glm::dvec4 cubic(const Channel& channel, size_t key, double t, double step) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * value_at(channel, key, 1) +
         step * (t3 - 2.0 * t2 + t) * value_at(channel, key, 2) +
         (3.0 * t2 - 2.0 * t3) * value_at(channel, key + 1, 1) + step * (t3 - t2) * value_at(channel, key + 1, 0);
}

glm::dvec4 sample(const Channel& channel, double time_s) {
  const auto& times = channel.times_s;
  if (!(time_s > times.front())) return key_value(channel, 0);
  if (time_s >= times.back()) return key_value(channel, times.size() - 1);
  const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time_s) - times.begin());
  const size_t key = next - 1;
  const double step = double(times[next]) - double(times[key]);
  const double t = (time_s - double(times[key])) / step;
  switch (channel.interpolation) {
    case Channel::Interpolation::step:
      return key_value(channel, key);
    case Channel::Interpolation::cubic:
      return cubic(channel, key, t, step);
    case Channel::Interpolation::linear:
      break;
  }
  if (channel.path != Channel::Path::rotation) return glm::mix(key_value(channel, key), key_value(channel, next), t);
  const glm::dquat q = glm::slerp(quaternion(key_value(channel, key)), quaternion(key_value(channel, next)), t);
  return {q.x, q.y, q.z, q.w};
}

}  // namespace

std::vector<Channel> read_channels(const Document& document, const std::vector<Node>& nodes) {
  std::vector<Channel> channels;
  for (size_t a = 0; a < document.model.animations.size(); ++a) {
    const tinygltf::Animation& animation = document.model.animations[a];
    for (size_t c = 0; c < animation.channels.size(); ++c) {
      const std::string who = fmt::format("{} channel {}", element("animation", a, animation.name), c);
      auto channel = read_channel(document, animation, animation.channels[c], nodes, who);
      if (channel) channels.push_back(std::move(*channel));
    }
  }
  return channels;
}

void animate(std::vector<Node>& nodes, const std::vector<Channel>& channels, double time_s) {
  for (const Channel& channel : channels) {
    const glm::dvec4 value = sample(channel, time_s);
    Node& node = nodes[size_t(channel.node)];
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
    }
  }
}

}  // namespace volgi::gltf
