#include "core/visibility/embree_scene.h"

#include <embree3/rtcore.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/hash.h"
#include "core/surface.h"

namespace volgi {
namespace {

// Relative to the largest coordinate in play; 2^-24 is one rounding.
constexpr float kPullBack = 4e-6f;      // leaving_point(): 64 roundings
constexpr float kBlindStart = 1e-5f;    // rays that do not say what they start on
constexpr float kCoincident = 1e-5f;    // hits this close to the start may be the start's own surface, twice
constexpr double kParallel = 1 - 1e-6;  // cosine of 0.08 degrees

float largest_component(glm::vec3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

float unit_hash(std::uint32_t seed, TriangleIndex t) {
  return static_cast<float>(hash(hash(hash(seed) + t.mesh) ^ (t.triangle * 0x9e3779b9u)) >> 8) * 0x1p-24f;
}

struct SharedData {
  const Scene* scene = nullptr;
  float magnitude = 0.0f;  // largest coordinate of the bounds
};

/// Glass that a ray passed, each triangle once: a traversal asks in any order, may ask twice, and about what lies
/// behind the end of the ray.
struct PassedGlass {
  static constexpr size_t MAX = 32;  // what lies behind more panes than that is coloured by these alone
  struct At {
    std::uint32_t mesh, triangle;  // not a TriangleIndex: a ray has no time to initialise what it does not need
    float distance;
    glm::vec3 tint;
  };
  std::array<At, MAX> panes;
  size_t count = 0;

  void add(const At& pane) {
    const auto end = panes.begin() + std::ptrdiff_t(count);
    const bool known = std::any_of(panes.begin(), end,
                                   [&](const At& p) { return p.mesh == pane.mesh && p.triangle == pane.triangle; });
    if (!known && count < MAX) panes[count++] = pane;
  }
  glm::vec3 tint(float before) const {
    glm::vec3 product(1.0f);
    for (size_t i = 0; i < count; ++i)
      if (panes[i].distance < before) product *= panes[i].tint;
    return product;
  }
};

struct QueryContext {
  RTCIntersectContext embree;  // first, so that the filter can cast
  const SharedData* shared;
  const Ray* ray;
  float coincident_distance;
  PassedGlass* glass;
};

glm::dvec3 unit_normal(const Scene& scene, TriangleIndex index) {
  const Mesh& mesh = scene.meshes[index.mesh];
  const glm::uvec3 t = mesh.triangles[index.triangle];
  const glm::dvec3 a(mesh.positions[t.x]);
  const glm::dvec3 n = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
  const double length = glm::length(n);
  return length > 0 ? n / length : glm::dvec3(0);
}

bool coplanar(const Scene& scene, TriangleIndex a, TriangleIndex b) {
  return std::abs(glm::dot(unit_normal(scene, a), unit_normal(scene, b))) > kParallel;
}

bool lets_ray_through(const QueryContext& query, TriangleIndex index, float distance, float u, float v) {
  const Ray& ray = *query.ray;
  const Scene& scene = *query.shared->scene;
  if (index == ray.from || index == ray.to) return true;
  // The other half of a quad, or a duplicate, met at the start only because of rounding.
  if (distance < query.coincident_distance && coplanar(scene, ray.from, index)) return true;
  const Mesh& mesh = scene.meshes[index.mesh];
  const AlphaMode mode = scene.materials[static_cast<size_t>(mesh.material)].alpha_mode;
  if (mode == AlphaMode::opaque) return false;
  const SurfacePoint point = surface_point(scene, mesh, index.triangle, u, v);
  if (mode == AlphaMode::mask) return point.alpha <= 0.0f;
  const bool passes = unit_hash(ray.alpha_seed, index) >= point.alpha;
  if (passes && mode == AlphaMode::glass) query.glass->add({index.mesh, index.triangle, distance, point.tint});
  return passes;
}

void filter(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const QueryContext*>(args->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
  if (args->valid[0] != 0 && lets_ray_through(query, {hit->geomID, hit->primID}, ray->tfar, hit->u, hit->v))
    args->valid[0] = 0;
}

template <class T>
void copy_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& from) {
  void* to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), from.size());
  if (to != nullptr) std::memcpy(to, from.data(), from.size() * sizeof(T));
}

RTCRay to_embree(const Ray& ray, float start) {
  RTCRay r{};
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = start;
  r.tfar = ray.max_distance;
  r.mask = 0xffffffffu;
  return r;
}

}  // namespace

struct EmbreeScene::Data {
  SharedData shared;
  RTCDevice device = nullptr;
  RTCScene embree = nullptr;

  ~Data() {
    if (embree != nullptr) rtcReleaseScene(embree);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void check(const char* doing) const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw Error(ExitCode::over_limit, std::string("Embree failed while ") + doing + " for '" + shared.scene->name +
                                          "' (error " + std::to_string(static_cast<int>(error)) +
                                          (error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : "") +
                                          "): use a smaller scene or a machine with more memory");
  }

  void attach(std::uint32_t index, const Mesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    copy_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    copy_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree, geometry, index);
    rtcReleaseGeometry(geometry);
    check("copying triangles");
  }

  float scale_at(glm::vec3 position) const { return std::max(shared.magnitude, largest_component(position)); }

  QueryContext context(const Ray& ray, PassedGlass& glass) const {
    QueryContext query{};
    rtcInitIntersectContext(&query.embree);
    query.glass = &glass;
    query.shared = &shared;
    query.ray = &ray;
    query.coincident_distance = ray.from.mesh == TriangleIndex::none ? -1.0f : kCoincident * scale_at(ray.origin);
    return query;
  }

  bool intersect(const Ray& ray, float start, RayHit& hit) const {
    PassedGlass glass;
    QueryContext query = context(ray, glass);
    RTCRayHit r{};
    r.ray = to_embree(ray, start);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree, &query.embree, &r);
    hit = {r.ray.tfar, r.hit.geomID, r.hit.primID, r.hit.u, r.hit.v, glass.tint(r.ray.tfar)};
    return r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

  glm::vec3 passed(const Ray& ray, float start) const {
    PassedGlass glass;
    QueryContext query = context(ray, glass);
    RTCRay r = to_embree(ray, start);
    rtcOccluded1(embree, &query.embree, &r);
    return r.tfar < 0.0f ? glm::vec3(0.0f) : glass.tint(std::numeric_limits<float>::infinity());
  }
  bool occluded(const Ray& ray, float start) const {
    PassedGlass glass;
    QueryContext query = context(ray, glass);
    RTCRay r = to_embree(ray, start);
    rtcOccluded1(embree, &query.embree, &r);
    return r.tfar < 0.0f;
  }
};

EmbreeScene::EmbreeScene(const Scene& scene) : data_(std::make_unique<Data>()) {
  // One thread: a parallel build may order triangles by scheduling, which shows where two are met at the same distance.
  // An arena of the caller's own, so that nobody else in the program is held to one thread meanwhile.
  tbb::task_arena one_thread(1);
  data_->shared.scene = &scene;
  for (const Mesh& mesh : scene.meshes)
    for (const glm::vec3& p : mesh.positions)
      data_->shared.magnitude = std::max(data_->shared.magnitude, largest_component(p));
  data_->device = rtcNewDevice(nullptr);
  data_->check("starting");
  data_->embree = rtcNewScene(data_->device);
  rtcSetSceneFlags(data_->embree, RTC_SCENE_FLAG_ROBUST);
  for (size_t i = 0; i < scene.meshes.size(); ++i)
    if (!scene.meshes[i].triangles.empty()) data_->attach(static_cast<std::uint32_t>(i), scene.meshes[i]);
  one_thread.execute([this] { rtcCommitScene(data_->embree); });
  data_->check("building");
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::intersect(const Ray& ray, RayHit& hit) const { return data_->intersect(ray, 0.0f, hit); }

bool EmbreeScene::occluded(const Ray& ray) const { return data_->occluded(ray, 0.0f); }

glm::vec3 EmbreeScene::passed(const Ray& ray) const { return data_->passed(ray, 0.0f); }

bool EmbreeScene::intersect(glm::vec3 origin, glm::vec3 direction, float max_distance, std::uint32_t alpha_seed,
                            RayHit& hit) const {
  return data_->intersect({origin, direction, max_distance, alpha_seed, {}, {}}, kBlindStart * data_->scale_at(origin),
                          hit);
}

bool EmbreeScene::occluded(glm::vec3 origin, glm::vec3 direction, float max_distance, std::uint32_t alpha_seed) const {
  return data_->occluded({origin, direction, max_distance, alpha_seed, {}, {}}, kBlindStart * data_->scale_at(origin));
}

glm::vec3 EmbreeScene::leaving_point(glm::vec3 position, glm::vec3 direction, float distance) const {
  return position - direction * std::min(kPullBack * data_->scale_at(position), 0.5f * distance);
}

const Scene& EmbreeScene::scene() const { return *data_->shared.scene; }

}  // namespace volgi
