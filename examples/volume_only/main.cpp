// Triangles in, OpenVDB out: the light of a lamp in a box, as radiance in every cell. No OpenGL, no glTF.
//   volume_only OUT.vdb
#include <core/error.h>
#include <core/scene.h>
#include <openvdb/openvdb.h>
#include <propagation/light_in/direct_light_cpu.h>
#include <propagation/radiance_volume.h>
#include <propagation/volume_cpu.h>
#include <voxel/cell_volumes.h>
#include <voxel/vdb_file.h>

#include <cstdio>

namespace {

// One wall: two triangles whose front is on the side from which a, b, c, d go counter-clockwise.
void add_wall(volgi::Scene& scene, int material, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  volgi::Mesh mesh;
  mesh.material = material;
  mesh.positions = {a, b, c, d};
  mesh.normals.assign(4, glm::normalize(glm::cross(b - a, d - a)));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
}

volgi::Scene box_with_a_lamp() {
  volgi::Scene scene;
  for (const glm::vec3 albedo : {glm::vec3(0.7f), glm::vec3(0.7f, 0.1f, 0.1f), glm::vec3(0.1f, 0.6f, 0.1f)}) {
    volgi::Material material;
    material.base_color_factor = glm::vec4(albedo, 1.0f);
    material.metallic_factor = 0.0f;
    scene.materials.push_back(material);
  }
  add_wall(scene, 0, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});    // floor
  add_wall(scene, 0, {-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});    // ceiling
  add_wall(scene, 0, {-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});  // back
  add_wall(scene, 0, {1, 0, 1}, {-1, 0, 1}, {-1, 2, 1}, {1, 2, 1});      // front
  add_wall(scene, 1, {-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1});  // left, red
  add_wall(scene, 2, {1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1});      // right, green
  volgi::Light lamp;
  lamp.position = {0, 1.8f, 0};
  lamp.intensity = glm::vec3(10.0f);  // W/sr
  scene.lights = {lamp};
  volgi::update_bounds(scene);
  return scene;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::puts("usage: volume_only OUT.vdb"), 2;
  const volgi::Scene scene = box_with_a_lamp();
  volgi::VolumeOptions options;
  options.grid_cells = 24;
  volgi::VolumeCpu volume(scene, options);
  volgi::run_with_direct_light(volume, scene);

  const openvdb::Vec3SGrid::Ptr fluence = volgi::fluence(volume.radiance());
  fluence->setTransform(volgi::world_from_index(volume.grid(), scene.world_origin));
  volgi::label_grid(*fluence, {"fluence", "W m^-2", "radiance over all directions"});
  volgi::write_vdb(argv[1], {fluence}, openvdb::MetaMap());

  const volgi::BounceReport& report = volume.report();
  std::printf("%s: %d x %d x %d cells, %d orders, %s\n", argv[1], volume.grid().cells.x, volume.grid().cells.y,
              volume.grid().cells.z, report.orders, report.converged ? "converged" : "not converged");
  return 0;
} catch (const volgi::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return int(error.code());
}
