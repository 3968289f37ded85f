#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::screen {

/// Pass "screen/gather/multires/light_tree": the fine sub-lights of all virtual lights, and sums of them by fours, as
/// levels of nodes (shaders/screen/gather/multires/light_node.shared.h). Sub-lights are sorted by the cluster whose
/// shadow they share, each to the nearest one, and in a cluster stay in the order of Hilbert's curve through what their
/// source sends: runs are compact patches that face one way, and the tree needs no building but sums. A node holds the
/// sum of its sub-lights' flux and area and their mean position and normal by flux, so that all candidates count from
/// afar, and not the one that was chosen of sixteen; and how they are spread, along an axis and off their plane.
///
/// The cut through it (shaders/screen/gather/multires/light_cut.glsl) is soft: a point at squared distance d^2 takes of
/// a node the share that rises from 0 at d^2 = z s to 1 at 2 z s, and of its parts the rest, s being the node's size:
/// the area of its leaves, or that of a disk that is spread as they are, 2 pi times the variance of its flux in space.
/// Nothing pops as a point or a light moves. Nodes whose normals have a mean shorter than 0.95, by flux, or that send
/// light of two kinds, have no share anywhere. Nichols' condition (2010, eq. 4.7 and 4.8) descends by how much a
/// patch's own size bends the form factor as well, but at once. Cost: clusters for each sub-light; 4 / 3 nodes a
/// sub-light, and dark ones where clusters do not fill their nodes.
class LightTree {
 public:
  static constexpr const char* name = "screen/gather/multires/light_tree";
  static constexpr const char* product_name = "the light tree";
  /// @param zone  z of the cut.
  explicit LightTree(float zone);

  /// @param parts  sub-lights of `lights`; null: they have none.
  void run(const VirtualLightListGl& lights, const VirtualLightSubdivision* parts, const VirtualAreaLights& clusters,
           float scene_diagonal_m, gl::PassTimer& timer);
  /// Buffers and uniforms of light_cut.glsl. @param program  in which it is compiled.
  void bind(const gl::Program& program) const;

  const gl::Buffer& nodes() const { return nodes_; }  // shared::LightNode, as light_tree.glsl orders them
  int top_level() const { return top_level_; }
  int most_roots() const { return most_roots_; }  // room for topmost nodes; those that there are not are dark
  size_t bytes() const { return nodes_.bytes() + roots_.bytes() + leaf_clusters_.bytes() + chunk_counts_.bytes(); }

 private:
  void make_room(int leaves, int clusters);
  void set_shape(const gl::Program& program) const;

  float zone_;
  int top_level_ = 0, most_roots_ = 0, clusters_ = 0, leaves_ = 0;
  bool in_parts_ = false;
  gl::Buffer nodes_;
  gl::Texture node_texels_;  // a view of them
  gl::Buffer roots_, leaf_clusters_, chunk_counts_;
  gl::Program assign_, counts_program_, roots_program_, leaves_program_, level_program_;
};

}  // namespace volgi::screen
