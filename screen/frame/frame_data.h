#pragma once
#include <cassert>
#include <map>
#include <span>
#include <typeindex>
#include <vector>

#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/scene_buffers.h"
#include "core/scene.h"
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/base/sky_seen.h"
#include "screen/frame/light_path.h"

namespace volgi::screen {

/// Something that a stage makes for later ones, known by its C++ type; `name` for messages, T::product_name.
struct Product {
  std::type_index type;
  const char* name;
  bool operator==(const Product& o) const { return type == o.type; }
};
template <class T>
Product product() {
  return {typeid(T), T::product_name};
}

/// A part of the picture: radiance [W m^-2 sr^-1] at every pixel, RGBA32F of the picture's size.
struct RadianceLayer {
  const gl::Texture* texture;
  LightPaths paths;
  LightShare share = LightShare::whole;
};

/// Products by their types, lent by the stages that made them.
class Products {
 public:
  template <class T>
  void lend(const T& made) {
    made_[typeid(T)] = &made;
  }
  template <class T>
  const T* find() const {
    const auto found = made_.find(typeid(T));
    return found == made_.end() ? nullptr : static_cast<const T*>(found->second);
  }

 private:
  std::map<std::type_index, const void*> made_;
};

/// What stages of one frame work on.
struct FrameData {
  const Scene& scene;
  const gl::SceneBuffers& triangles;
  const Camera& camera;
  const GBuffer& gbuffer;
  const ReflectiveShadowMap& shadow_maps;
  LightPaths wanted;  // what the picture shows, and the recipe claims
  float scene_diagonal_m;
  const SkySeen* sky = nullptr;  // what is seen where there is no surface; null: nothing
  int sample = 0;  // of the pictures that are averaged: what stages choose by chance (core/sample_sequence.h)
  std::vector<RadianceLayer> layers = {};       // of the stage that runs
  std::span<const RadianceLayer> earlier = {};  // of the stages before it
  Products products = {};

  template <class T>
  void lend(const T& made) {
    products.lend(made);
  }
  /// Of a product that a stage needs: plan_picture() has seen to it that there is one.
  template <class T>
  const T& get() const {
    const T* made = products.find<T>();
    assert(made != nullptr);
    return *made;
  }
  /// Of one that it uses where there is one; else null.
  template <class T>
  const T* find() const {
    return products.find<T>();
  }
};

}  // namespace volgi::screen
