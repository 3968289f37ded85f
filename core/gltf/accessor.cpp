#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

constexpr size_t max_unbacked_elements = size_t(1) << 24;  // of an accessor that is zero but for sparse values

size_t component_size(int component_type) {
  const int size = tinygltf::GetComponentSizeInBytes(std::uint32_t(component_type));
  const bool known = component_type != TINYGLTF_COMPONENT_TYPE_INT && component_type != TINYGLTF_COMPONENT_TYPE_DOUBLE;
  return known && size > 0 ? size_t(size) : 0;
}

size_t component_count(int type) { return size_t(std::max(0, tinygltf::GetNumComponentsInType(std::uint32_t(type)))); }

std::string label(size_t accessor, const std::string& who) {
  return who.empty() ? fmt::format("accessor {}", accessor) : fmt::format("accessor {} ({})", accessor, who);
}

template <typename T>
T load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

std::uint32_t load_unsigned(const unsigned char* bytes, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

/// Integer types by glTF's "Animations": signed ones clamp, so that -128 and -127 are both -1.
float load_float(const unsigned char* bytes, int component_type, bool normalized) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<std::int8_t>(bytes);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return float(*bytes) / (normalized ? 255.0f : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<std::int16_t>(bytes);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return float(load<std::uint16_t>(bytes)) / (normalized ? 65535.0f : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return float(load<std::uint32_t>(bytes));
    default:
      return load<float>(bytes);
  }
}

/// Where `count` elements lie, all of them inside their buffer view.
struct Run {
  const unsigned char* data = nullptr;  // null: all zero
  size_t stride = 0;
};

Run locate(const Document& document, int buffer_view, size_t offset, size_t count, size_t element_size,
           const std::string& who) {
  const Bytes view = view_bytes(document, buffer_view, who);
  const size_t given = document.model.bufferViews[size_t(buffer_view)].byteStride;
  const size_t stride = given == 0 ? element_size : given;
  if (stride < element_size) {
    refuse(document.path, fmt::format("{}: byteStride {} of buffer view {} is smaller than an element ({} bytes)", who,
                                      stride, buffer_view, element_size));
  }
  // Without overflow: the last element begins at offset + (count - 1) * stride.
  const bool fits = offset <= view.size && element_size <= view.size - offset &&
                    count - 1 <= (view.size - offset - element_size) / stride;
  if (count > 0 && !fits) {
    refuse(document.path, fmt::format("{}: {} elements of {} bytes from byte {} on do not fit into buffer view {} "
                                      "({} bytes)",
                                      who, count, element_size, offset, buffer_view, view.size));
  }
  return {view.data + (count > 0 ? offset : 0), stride};
}

struct SparseRun {
  Run indices, values;
  size_t count = 0;
};

struct Layout {
  Run base;
  SparseRun sparse;
  size_t element_size = 0;
};

SparseRun locate_sparse(const Document& document, const tinygltf::Accessor& accessor, size_t element_size,
                        const std::string& who) {
  const auto& sparse = accessor.sparse;
  const int type = sparse.indices.componentType;
  const bool is_index_type = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!is_index_type || sparse.count < 0 || size_t(sparse.count) > accessor.count) {
    refuse(document.path, fmt::format("{}: the sparse part has a wrong type or count", who));
  }
  SparseRun run;
  run.count = size_t(sparse.count);
  run.indices = locate(document, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), run.count,
                       component_size(type), who + ", sparse indices");
  run.values = locate(document, sparse.values.bufferView, size_t(sparse.values.byteOffset), run.count, element_size,
                      who + ", sparse values");
  return run;
}

Layout layout(const Document& document, const tinygltf::Accessor& accessor, const std::string& who) {
  Layout result;
  const size_t size = component_size(accessor.componentType);
  if (size == 0) refuse(document.path, fmt::format("{}: unknown componentType {}", who, accessor.componentType));
  result.element_size = size * component_count(accessor.type);
  if (accessor.type == TINYGLTF_TYPE_MAT2 && size == 1) result.element_size = 8;  // columns begin at multiples of 4
  if (accessor.type == TINYGLTF_TYPE_MAT3 && size < 4) result.element_size = size == 1 ? 12 : 24;
  if (accessor.bufferView >= 0) {
    result.base = locate(document, accessor.bufferView, accessor.byteOffset, accessor.count, result.element_size, who);
  } else if (accessor.count > max_unbacked_elements) {
    refuse(document.path, fmt::format("{}: {} elements without data", who, accessor.count));
  }
  if (accessor.sparse.isSparse) result.sparse = locate_sparse(document, accessor, result.element_size, who);
  return result;
}

/// Calls visit(element, bytes) for the base's elements, then for the sparse ones that replace some.
template <typename Visit>
void for_each_element(const Document& document, const tinygltf::Accessor& accessor, const Layout& at,
                      const std::string& who, Visit visit) {
  if (at.base.data != nullptr) {
    for (size_t i = 0; i < accessor.count; ++i) visit(i, at.base.data + i * at.base.stride);
  }
  for (size_t i = 0; i < at.sparse.count; ++i) {
    const size_t index =
        load_unsigned(at.sparse.indices.data + i * at.sparse.indices.stride, accessor.sparse.indices.componentType);
    if (index >= accessor.count) {
      refuse(document.path, fmt::format("{}: sparse index {} of {} elements", who, index, accessor.count));
    }
    visit(index, at.sparse.values.data + i * at.sparse.values.stride);
  }
}

/// Integers where only normalized ones make sense, without the word.
bool repairs_normalized(const tinygltf::Accessor& accessor, const Expected& expected) {
  return !accessor.normalized && expected.normalized_integers && !expected.plain_integers &&
         accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && component_size(accessor.componentType) <= 2;
}

void check_type(const Document& document, const tinygltf::Accessor& accessor, const Expected& expected,
                const std::string& who) {
  const bool is_vector = accessor.type == TINYGLTF_TYPE_SCALAR || accessor.type <= TINYGLTF_TYPE_VEC4 ||
                         accessor.type == TINYGLTF_TYPE_MAT4;
  const bool is_float = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool is_short = component_size(accessor.componentType) <= 2;
  const bool forgotten = repairs_normalized(accessor, expected);
  const bool good_component = is_float || forgotten ||
                              (accessor.normalized && expected.normalized_integers && is_short) ||
                              (!accessor.normalized && expected.plain_integers && is_short);
  if (!is_vector || !good_component || !expected.components.contains(component_count(accessor.type))) {
    refuse(document.path, fmt::format("{}: wrong accessor type (type {}, componentType {}{})", who, accessor.type,
                                      accessor.componentType, accessor.normalized ? ", normalized" : ""));
  }
}

}  // namespace

Bytes view_bytes(const Document& document, int buffer_view, const std::string& who) {
  check_index(document, buffer_view, document.model.bufferViews.size(), who, "buffer view");
  const tinygltf::BufferView& view = document.model.bufferViews[size_t(buffer_view)];
  const std::string view_name = fmt::format("buffer view {} ({})", buffer_view, who);
  check_index(document, view.buffer, document.model.buffers.size(), view_name, "buffer");
  const auto& data = document.model.buffers[size_t(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    refuse(document.path, fmt::format("{}: bytes {} + {} lie outside buffer {} ({} bytes)", view_name, view.byteOffset,
                                      view.byteLength, view.buffer, data.size()));
  }
  return {data.data() + view.byteOffset, view.byteLength};
}

Elements read_elements(const Document& document, int index, const Expected& expected, const std::string& who) {
  check_index(document, index, document.model.accessors.size(), who, "accessor");
  const tinygltf::Accessor& accessor = document.model.accessors[size_t(index)];
  const std::string name = label(size_t(index), who);
  check_type(document, accessor, expected, name);
  const Layout at = layout(document, accessor, name);
  const size_t size = component_size(accessor.componentType);

  const bool forgotten = repairs_normalized(accessor, expected);
  if (forgotten) repair(document, name + ": integers without 'normalized'; they count as normalized");

  Elements elements;
  elements.components = component_count(accessor.type);
  elements.values.assign(accessor.count * elements.components, 0.0f);
  for_each_element(document, accessor, at, name, [&](size_t i, const unsigned char* bytes) {
    for (size_t c = 0; c < elements.components; ++c) {
      float value = load_float(bytes + c * size, accessor.componentType, accessor.normalized || forgotten);
      if (!std::isfinite(value)) {
        const std::string what = fmt::format("{}: element {} is {}", name, i, value);
        if (!expected.repair) refuse(document.path, what);
        repair(document, what + "; it counts as 0");
        value = 0.0f;
      }
      elements.values[i * elements.components + c] = value;
    }
  });
  return elements;
}

std::vector<std::uint32_t> read_indices(const Document& document, int index, const std::string& who) {
  check_index(document, index, document.model.accessors.size(), who, "accessor");
  const tinygltf::Accessor& accessor = document.model.accessors[size_t(index)];
  const std::string name = label(size_t(index), who);
  const bool is_unsigned = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned || accessor.normalized) {
    refuse(document.path, fmt::format("{}: wrong accessor type for indices (type {}, componentType {})", name,
                                      accessor.type, accessor.componentType));
  }
  std::vector<std::uint32_t> indices(accessor.count, 0);
  for_each_element(document, accessor, layout(document, accessor, name), name,
                   [&](size_t i, const unsigned char* b) { indices[i] = load_unsigned(b, accessor.componentType); });
  return indices;
}

void check_accessors(const Document& document) {
  for (size_t i = 0; i < document.model.bufferViews.size(); ++i) view_bytes(document, int(i), "unused");
  for (size_t i = 0; i < document.model.accessors.size(); ++i) {
    layout(document, document.model.accessors[i], label(i, document.model.accessors[i].name));
  }
}

}  // namespace volgi::gltf
