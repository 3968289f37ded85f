#include <fmt/format.h>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {

std::vector<Skin> read_skins(const Document& document) {
  std::vector<Skin> skins;
  for (size_t s = 0; s < document.model.skins.size(); ++s) {
    const tinygltf::Skin& in = document.model.skins[s];
    const std::string who = element("skin", s, in.name);
    Skin& skin = skins.emplace_back();
    for (const int joint : in.joints) check_index(document, joint, document.model.nodes.size(), who, "joint");
    skin.joints = in.joints;
    skin.joint_from_bind.assign(in.joints.size(), glm::dmat4(1.0));
    if (in.inverseBindMatrices < 0) continue;
    const Elements matrices =
        read_elements(document, in.inverseBindMatrices, {{16}, false, false}, who + " inverseBindMatrices");
    if (matrices.count() < in.joints.size()) {
      refuse(document.path,
             fmt::format("{}: {} inverse bind matrices for {} joints", who, matrices.count(), in.joints.size()));
    }
    for (size_t j = 0; j < in.joints.size(); ++j) {
      for (size_t i = 0; i < 16; ++i)
        skin.joint_from_bind[j][int(i / 4)][int(i % 4)] = double(matrices.values[16 * j + i]);
    }
  }
  return skins;
}

void check_joints(const Document& document, const Node& node, const std::vector<Skin>& skins,
                  const std::vector<Primitive>& primitives) {
  if (node.skin < 0) return;
  const size_t joints = skins[size_t(node.skin)].joints.size();
  for (const Primitive& primitive : primitives) {
    for (const Primitive::Influences& set : primitive.influences) {
      for (size_t i = 0; i < set.joints.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
          if (set.weights[i][k] <= 0.0f || set.joints[i][k] < joints) continue;
          refuse(document.path,
                 fmt::format("node '{}': vertex {} has joint {} of {}", node.name, i, set.joints[i][k], joints));
        }
      }
    }
  }
}

}  // namespace volgi::gltf
