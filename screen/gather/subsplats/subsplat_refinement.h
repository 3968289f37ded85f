#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/gather/subsplats/discontinuity_mipmaps.h"
#include "screen/gather/subsplats/light_form.h"
#include "screen/gather/subsplats/subsplat_levels.h"
#include "screen/gather/subsplats/subsplat_receivers.h"

namespace volgi::screen {

void delete_transform_feedback(GLuint id);
void delete_query(GLuint id);

/// Pass "screen/gather/subsplats/refine": the list of a picture's subsplats, from the coarsest level on, each step of
/// which divides those with a discontinuity by four (Nichols 2010, §3.2.3); or a list for each light, by what the light
/// gives their four quadrants (§3.2.3.1). The number of entries stays on the GPU. Cost: a step a level, over the list.
class SubsplatRefinement {
 public:
  static constexpr const char* name = "screen/gather/subsplats/refine";
  enum class By {
    geometry,  // a geometry shader and transform feedback, as in the thesis: the whole list every step
    compute,   // lists of those that a step looks at
  };
  enum class For { all_lights, each_light };
  /// @param shine  of For::each_light: receivers may shine.
  SubsplatRefinement(const SubsplatLevels& levels, By by, For lights, LightForm form, bool shine = false);

  /// Once a frame.
  void run(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps, gl::PassTimer& timer);
  /// For lights [first, first + count) of the block of lights that is bound, at most lights_at_once() of them.
  /// @param most_difference  T: of irradiance between quadrants [W m^-2].
  void run(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps, int first, int count,
           float most_difference, gl::PassTimer& timer);
  int lights_at_once() const { return lights_at_once_; }

  /// A point for each subsplat, with it (uvec2) as attribute 0, in the current program.
  void draw(int instances) const;
  /// Subsplats of all runs since begin_frame().
  void begin_frame();
  size_t count() const;                  // waits for the GPU; after a frame, not in one
  std::vector<glm::uvec2> list() const;  // of the last run: packed, light; waits
  size_t bytes() const;

 private:
  using Feedback = gl::Handle<delete_transform_feedback>;
  using Query = gl::Handle<delete_query>;
  /// A list behind its head (WorkListHead), and the feedback that fills it.
  struct List {
    gl::Buffer buffer;
    Feedback feedback;
  };
  List make_list() const;
  void put_coarsest(int first, int count);
  void refine(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps);
  void step_by_geometry(int step);
  void step_by_compute(int step);
  void bind_vertices(const gl::Buffer& list) const;
  void write_arguments(int instances, bool count) const;
  const List& done() const;

  SubsplatLevels levels_;
  By by_;
  For for_;
  int lights_at_once_, steps_ = 0, coarsest_ = 0;
  gl::Buffer first_;  // the coarsest subsplats
  List lists_[3];     // by turns; done ones of By::compute in the last
  gl::Buffer arguments_;
  std::vector<Query> queries_;  // of each run of a frame
  size_t runs_ = 0;
  gl::VertexArray vertices_;
  gl::Framebuffer nothing_;
  gl::Program step_, arguments_program_;
};

}  // namespace volgi::screen
