// KHR_draco_mesh_compression.
#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

template <typename T>
std::vector<unsigned char> bytes_of(const std::vector<T>& values) {
  std::vector<unsigned char> bytes(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Values of an attribute as glTF lays them out: one vertex after another.
template <typename T>
std::vector<unsigned char> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                     std::uint8_t components) {
  std::vector<T> values(size_t(mesh.num_points()) * components, T(0));
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p)
    attribute.ConvertValue<T>(attribute.mapped_index(p), std::int8_t(components),
                              &values[size_t(p.value()) * components]);
  return bytes_of(values);
}

class PrimitiveDecoder {
 public:
  PrimitiveDecoder(Document& document, std::string who) : document_(document), who_(std::move(who)) {}

  void decode(tinygltf::Primitive& primitive, const tinygltf::Value& extension) {
    if (!extension.Has("bufferView") || !extension.Get("bufferView").IsInt() || !extension.Has("attributes"))
      refuse(document_.path, fmt::format("{}: no bufferView or no attributes", who_));
    read(view_bytes(document_, extension.Get("bufferView").GetNumberAsInt(), who_));
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
      refuse(document_.path, fmt::format("{}: only triangles are read, not mode {}", who_, primitive.mode));
    take_indices(primitive);
    const tinygltf::Value& attributes = extension.Get("attributes");
    for (const std::string& name : attributes.Keys()) {
      if (!attributes.Get(name).IsInt())
        refuse(document_.path, fmt::format("{}: the id of {} is no number", who_, name));
      take_attribute(primitive, name, attributes.Get(name).GetNumberAsInt());
    }
  }

 private:
  void read(Bytes bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data), bytes.size);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
      refuse(document_.path,
             fmt::format("{}: the compressed data are damaged ({})", who_, decoded.status().error_msg_string()));
    }
    mesh_ = std::move(decoded).value();
  }

  /// An accessor of the primitive's own, like the one that the file has for it.
  int add_accessor(const tinygltf::Accessor& like, size_t count, std::vector<unsigned char> bytes) {
    tinygltf::Accessor accessor = like;
    accessor.bufferView = add_view(document_, std::move(bytes), who_);
    accessor.byteOffset = 0;
    accessor.count = count;
    accessor.sparse = {};
    document_.model.accessors.push_back(std::move(accessor));
    return int(document_.model.accessors.size()) - 1;
  }

  void take_indices(tinygltf::Primitive& primitive) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * size_t(mesh_->num_faces()));
    for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f) {
      for (const draco::PointIndex& p : mesh_->face(f)) indices.push_back(p.value());
    }
    tinygltf::Accessor plain;
    plain.type = TINYGLTF_TYPE_SCALAR;
    plain.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    primitive.indices = add_accessor(plain, indices.size(), bytes_of(indices));
  }

  void take_attribute(tinygltf::Primitive& primitive, const std::string& name, int id) {
    const auto accessor = primitive.attributes.find(name);
    if (accessor == primitive.attributes.end()) return;
    check_index(document_, accessor->second, document_.model.accessors.size(), who_, "accessor");
    const tinygltf::Accessor like = document_.model.accessors[size_t(accessor->second)];
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(std::uint32_t(id));
    const int components = tinygltf::GetNumComponentsInType(std::uint32_t(like.type));
    if (id < 0 || attribute == nullptr || components < 1 || components > 4)
      refuse(document_.path, fmt::format("{}: there is no {} with the id {}", who_, name, id));
    accessor->second =
        add_accessor(like, mesh_->num_points(), values(*attribute, like, std::uint8_t(components), name));
  }

  std::vector<unsigned char> values(const draco::PointAttribute& attribute, const tinygltf::Accessor& like,
                                    std::uint8_t components, const std::string& name) const {
    switch (like.componentType) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return values_of<std::int8_t>(*mesh_, attribute, components);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return values_of<std::uint8_t>(*mesh_, attribute, components);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return values_of<std::int16_t>(*mesh_, attribute, components);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return values_of<std::uint16_t>(*mesh_, attribute, components);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return values_of<std::uint32_t>(*mesh_, attribute, components);
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return values_of<float>(*mesh_, attribute, components);
      default:
        refuse(document_.path, fmt::format("{}: {} has the componentType {}", who_, name, like.componentType));
    }
  }

  Document& document_;
  std::string who_;
  std::unique_ptr<draco::Mesh> mesh_;
};

}  // namespace

void decompress_draco(Document& document) {
  for (size_t m = 0; m < document.model.meshes.size(); ++m) {
    tinygltf::Mesh& mesh = document.model.meshes[m];
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
      const auto extension = mesh.primitives[p].extensions.find("KHR_draco_mesh_compression");
      if (extension == mesh.primitives[p].extensions.end()) continue;
      const std::string who =
          fmt::format("{} primitive {} (KHR_draco_mesh_compression)", element("mesh", m, mesh.name), p);
      PrimitiveDecoder(document, who).decode(mesh.primitives[p], extension->second);
    }
  }
}

}  // namespace volgi::gltf
