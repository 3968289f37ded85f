#pragma once
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// The kernels over sides that solve P = K(e + fP) between applications of K, by conjugate gradients or one bounce
/// after another: the equations are those of bounces_cpu.h. Everything that they decide stays on the GPU, but for
/// whether it is enough: push_sums() asks for that, pop_sums() brings it by when later work is queued. Sums have a
/// fixed order. Memory: 32 bytes a side.
class BounceSolverGl {
 public:
  /// Power per side [W], vec4, rgb.
  struct Powers {
    const gl::Buffer& received;  // by this application of K
    const gl::Buffer& sent;      // to it
    const gl::Buffer& total;     // P, the answer
    const gl::Buffer& direct;    // first arrival of emission
  };
  struct Sums {
    glm::vec3 next_sent,
        total_sent;  // what one more bounce would change of what sides send, and all that they send [W]
  };

  BounceSolverGl();
  void make_room(std::uint32_t side_capacity);
  /// The last run's powers become zero where they are of another number of sides.
  void forget_other_sides(const VoxelGridGl& voxels, const Powers& powers);
  /// e, from punctual flux and `direct`.
  void set_source(const VoxelGridGl& voxels, const Powers& powers, const gl::Buffer& punctual);
  /// sent = e + fP; with `scaled`, P first becomes as much of itself as e has of what it was in the last run.
  void send_all(const VoxelGridGl& voxels, const Powers& powers, bool scaled);
  /// P = received; sent = e + fP.
  void publish(const VoxelGridGl& voxels, const Powers& powers);
  /// Conjugate gradients: after send_all(scaled) and K; then steps, each with the next direction in `sent` and K.
  void start(const VoxelGridGl& voxels, const Powers& powers);
  void step(const VoxelGridGl& voxels, const Powers& powers);
  void end(const VoxelGridGl& voxels, const Powers& powers);

  void push_sums();
  Sums pop_sums();
  size_t pending_sums() const { return readback_.pending(); }
  void drop_sums() { readback_.drop_all(); }
  static size_t bytes_for(std::uint32_t side_capacity);
  size_t bytes() const { return source_.bytes() + residual_.bytes() + partials_.bytes() + state_.bytes(); }

 private:
  void run(const gl::Program& kernel, const VoxelGridGl& voxels, const Powers& powers);
  void add_up(int sums);

  gl::Program source_kernel_, send_kernel_, publish_kernel_, reset_kernel_;
  gl::Program start_kernel_, curvature_kernel_, step_kernel_, direction_kernel_, end_kernel_, scalars_kernel_;
  gl::Buffer source_, residual_, partials_, state_, last_count_;
  gl::Readback readback_;
  std::uint32_t capacity_ = 0;
};

}  // namespace volgi
