#include "screen/gather/subsplats/subsplat_refinement.h"

#include <algorithm>

#include "core/gl/raster_state.h"
#include "shaders/screen/base/work_list.shared.h"
#include "shaders/screen/gather/subsplats/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

using shared::WorkListHead;

void delete_transform_feedback(GLuint id) { glDeleteTransformFeedbacks(1, &id); }
void delete_query(GLuint id) { glDeleteQueries(1, &id); }

namespace {

constexpr size_t kEntryBytes = sizeof(glm::uvec2);
constexpr size_t kMostEntries = size_t(1) << 21;  // of lists for some lights at once; one light always fits

struct DrawArguments {
  GLuint vertices, instances, first_vertex, first_instance, all;
};

std::vector<std::string> defines(SubsplatRefinement::For lights, LightForm form, bool shine) {
  if (lights == SubsplatRefinement::For::all_lights) return {};
  std::vector<std::string> all = defines_of(form);
  all.emplace_back("EACH_LIGHT");
  if (shine) all.emplace_back("SHINES");
  return all;
}

/// Lists by compute have no order, and lights must be added in theirs: one at a time.
int lights_at_once(const SubsplatLevels& levels, SubsplatRefinement::By by, SubsplatRefinement::For lights) {
  if (lights == SubsplatRefinement::For::all_lights || by == SubsplatRefinement::By::compute) return 1;
  return int(std::clamp<size_t>(kMostEntries / levels.most_fragments(), 1, VIRTUAL_LIGHTS_PER_BLOCK));
}

}  // namespace

SubsplatRefinement::SubsplatRefinement(const SubsplatLevels& levels, By by, For lights, LightForm form, bool shine)
    : levels_(levels),
      by_(by),
      for_(lights),
      lights_at_once_(screen::lights_at_once(levels, by, lights)),
      arguments_(sizeof(DrawArguments)),
      nothing_(gl::Framebuffer::without_attachments({1, 1})) {
  const glm::ivec2 coarsest = shared::level_size(levels.size, levels.last);
  first_ = gl::Buffer(sizeof(WorkListHead) +
                      size_t(coarsest.x) * size_t(coarsest.y) * size_t(lights_at_once_) * kEntryBytes);
  for (List& list : lists_) list = make_list();
  GLuint vertices = 0;
  glCreateVertexArrays(1, &vertices);
  gl::count_object();
  vertices_ = gl::VertexArray(vertices);
  glEnableVertexArrayAttrib(vertices, 0);
  glVertexArrayAttribIFormat(vertices, 0, 2, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(vertices, 0, 0);
  if (by == By::geometry) {
    step_ = gl::Program::feedback("screen/gather/subsplats/refine", "refined", defines(lights, form, shine));
  } else {
    step_ = gl::Program::compute("screen/gather/subsplats/refine.comp.glsl", defines(lights, form, shine));
    arguments_program_ = gl::Program::compute("screen/gather/subsplats/splat_arguments.comp.glsl");
  }
}

SubsplatRefinement::List SubsplatRefinement::make_list() const {
  List list;
  const size_t bytes = levels_.most_fragments() * size_t(lights_at_once_) * kEntryBytes;
  list.buffer = gl::Buffer(sizeof(WorkListHead) + bytes);
  GLuint feedback = 0;
  glCreateTransformFeedbacks(1, &feedback);
  gl::count_object();
  list.feedback = Feedback(feedback);
  glTransformFeedbackBufferRange(feedback, 0, list.buffer.id(), sizeof(WorkListHead), GLsizeiptr(bytes));
  return list;
}

void SubsplatRefinement::begin_frame() {
  runs_ = 0;
  arguments_.clear();
}

/// The list that refinement begins with, unless it is there.
void SubsplatRefinement::put_coarsest(int first, int count) {
  const glm::ivec2 size = shared::level_size(levels_.size, levels_.last);
  std::vector<GLuint> words(sizeof(WorkListHead) / sizeof(GLuint));
  for (int light = first; light < first + count; ++light) {
    for (int i = 0; i < size.x * size.y; ++i) {
      words.push_back(shared::pack_subsplat({levels_.last, {i % size.x, i / size.x}}));
      words.push_back(for_ == For::all_lights ? ALL_LIGHTS : GLuint(light));
    }
  }
  coarsest_ = size.x * size.y * count;
  const int groups = (coarsest_ + LINEAR_GROUP - 1) / LINEAR_GROUP;
  const WorkListHead head{GLuint(groups), 1, 1, GLuint(coarsest_)};
  std::copy_n(reinterpret_cast<const GLuint*>(&head), 4, words.begin());
  first_.upload(words.data(), words.size() * sizeof(GLuint));
}

void SubsplatRefinement::run(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps,
                             gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  if (coarsest_ == 0) put_coarsest(0, 1);
  refine(receivers, mipmaps);
}

void SubsplatRefinement::run(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps, int first,
                             int count, float most_difference, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  put_coarsest(first, count);
  step_.set("most_difference", most_difference);
  refine(receivers, mipmaps);
}

void SubsplatRefinement::refine(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps) {
  receivers.bind(step_);
  mipmaps.bind(step_);
  if (by_ == By::compute) {
    constexpr WorkListHead EMPTY{0, 1, 1, 0};
    lists_[2].buffer.upload(&EMPTY, sizeof EMPTY);
  } else if (queries_.size() <= runs_) {
    GLuint query = 0;
    glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &query);
    gl::count_object();
    queries_.emplace_back(query);
  }
  // At least one step, which drops what shows nothing.
  steps_ = std::max(levels_.last - levels_.finest, 1);
  for (int step = 0; step < steps_; ++step) by_ == By::geometry ? step_by_geometry(step) : step_by_compute(step);
  if (by_ == By::compute) write_arguments(0, true);
  ++runs_;
}

void SubsplatRefinement::bind_vertices(const gl::Buffer& list) const {
  glVertexArrayVertexBuffer(vertices_.id(), 0, list.id(), sizeof(WorkListHead), GLsizei(kEntryBytes));
  glBindVertexArray(vertices_.id());
}

void SubsplatRefinement::step_by_geometry(int step) {
  const List& to = lists_[step % 2];
  const bool last = step == steps_ - 1;
  gl::begin_fullscreen_pass();
  nothing_.bind();
  step_.set("level", levels_.last - step);
  step_.use();
  bind_vertices(step == 0 ? first_ : lists_[(step - 1) % 2].buffer);
  glEnable(GL_RASTERIZER_DISCARD);
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, to.feedback.id());
  if (last) glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, queries_[runs_].id());
  glBeginTransformFeedback(GL_POINTS);
  if (step == 0) {
    glDrawArrays(GL_POINTS, 0, coarsest_);
  } else {
    glDrawTransformFeedback(GL_POINTS, lists_[(step - 1) % 2].feedback.id());
  }
  glEndTransformFeedback();
  if (last) glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
  glDisable(GL_RASTERIZER_DISCARD);
  glBindVertexArray(0);
}

void SubsplatRefinement::step_by_compute(int step) {
  constexpr WorkListHead EMPTY{0, 1, 1, 0};
  const gl::Buffer& from = step == 0 ? first_ : lists_[(step - 1) % 2].buffer;
  const gl::Buffer& to = lists_[step % 2].buffer;
  to.upload(&EMPTY, sizeof EMPTY);
  from.bind_storage(SUBSPLATS_IN_SLOT);
  to.bind_storage(SUBSPLATS_OUT_SLOT);
  lists_[2].buffer.bind_storage(SUBSPLATS_DONE_SLOT);
  step_.set("level", levels_.last - step);
  step_.use();
  gl::dispatch_indirect(from);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

const SubsplatRefinement::List& SubsplatRefinement::done() const {
  return by_ == By::compute ? lists_[2] : lists_[(steps_ - 1) % 2];
}

void SubsplatRefinement::write_arguments(int instances, bool count) const {
  lists_[2].buffer.bind_storage(SUBSPLATS_IN_SLOT);
  arguments_.bind_storage(SPLAT_ARGUMENTS_SLOT);
  arguments_program_.set("instance_count", instances);
  arguments_program_.set("counts", count ? 1 : 0);
  arguments_program_.use();
  gl::dispatch({1, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void SubsplatRefinement::draw(int instances) const {
  GLint program = 0;
  if (by_ == By::compute) {
    glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    write_arguments(instances, false);
    glUseProgram(GLuint(program));
  }
  bind_vertices(done().buffer);
  if (by_ == By::geometry) {
    glDrawTransformFeedbackInstanced(GL_POINTS, done().feedback.id(), instances);
  } else {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, arguments_.id());
    glDrawArraysIndirect(GL_POINTS, nullptr);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  }
  glBindVertexArray(0);
}

size_t SubsplatRefinement::count() const {
  if (by_ == By::compute) return arguments_.download<GLuint>(5)[4];
  size_t sum = 0;
  for (size_t run = 0; run < runs_; ++run) {
    GLuint written = 0;
    glGetQueryObjectuiv(queries_[run].id(), GL_QUERY_RESULT, &written);
    sum += written;
  }
  return sum;
}

std::vector<glm::uvec2> SubsplatRefinement::list() const {
  GLuint entries = 0;
  if (by_ == By::compute) {
    entries = done().buffer.download<WorkListHead>(1).front().count;
  } else if (runs_ > 0) {
    glGetQueryObjectuiv(queries_[runs_ - 1].id(), GL_QUERY_RESULT, &entries);
  }
  return done().buffer.download<glm::uvec2>(entries, sizeof(WorkListHead));
}

size_t SubsplatRefinement::bytes() const {
  size_t sum = first_.bytes();
  for (const List& list : lists_) sum += list.buffer.bytes();
  return sum;
}

}  // namespace volgi::screen
