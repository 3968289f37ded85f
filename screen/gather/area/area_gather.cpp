#include "screen/gather/area/area_gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/error.h"
#include "shaders/screen/gather/area/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

// Of a thread in one dispatch: llvmpipe leaves every loop of one that has had 65,535 turns in all of them together,
// without a word, and GPUs give up on what takes seconds.
constexpr int TURNS_AT_ONCE = 40000;
constexpr const char* REFINE = "screen/gather/area/refine.comp.glsl";

// At most, of all loops.
int turns_of_way(const AreaGather::Hidden& hidden) {
  if (hidden.rays != nullptr) return 1;
  if (hidden.voxels != nullptr) return 6 * hidden.voxels->steps();  // runs, samples, two words or more of each
  if (hidden.faces == nullptr) return 1;
  const glm::ivec3 cells = hidden.faces->voxels.grid.cells;
  return 2 * (cells.x + cells.y + cells.z);
}

void wait_for_pixels() {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_COMMAND_BARRIER_BIT);
}

}  // namespace

void AreaGather::check(const AreaGatherOptions& options) {
  const int n = options.coarsest;
  if (n < 1 || n > 32 || !std::has_single_bit(unsigned(n)))
    throw Error(ExitCode::usage, fmt::format("area.coarsest: 1, 2, 4, 8, 16 or 32 pixels, not {}", n));
}

int AreaGather::lights_in_group(int lights) { return std::max((lights + AREA_GROUPS - 1) / AREA_GROUPS, 1); }

std::string AreaGather::level_name(int step_px) { return fmt::format("{}_{}", name, step_px); }

AreaGather::AreaGather(glm::ivec2 size, const AreaGatherOptions& options)
    : size_(size),
      options_(options),
      irradiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      shared_irradiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      masks_(gl::Texture::make_2d(GL_RGBA32UI, size.x, size.y)),
      gathered_step_(gl::Texture::make_2d(GL_R8UI, size.x, size.y)),
      radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      counts_(2 * sizeof(GLuint)),
      first_(gl::Program::compute(REFINE, {"FIRST"})),
      finer_(gl::Program::compute(REFINE)),
      join_(gl::Program::compute("screen/gather/area/join.comp.glsl")),
      shade_(gl::Program::compute("screen/gather/area/shade.comp.glsl")) {
  check(options);
  for (int step = options.coarsest; step > 0; step /= 2) {
    Level& level = levels_.emplace_back(Level{step, {}});
    const glm::ivec2 grid = (size + step - 1) / step;
    const int shares = step <= options.interleave ? AREA_SHARES : 1;
    for (int share = 0; share < shares; ++share)
      level.lists.emplace_back().reserve(size_t((grid.x + shares - 1) / shares) * size_t(grid.y));
  }
}

const gl::Program& AreaGather::gather_program(bool first, const Hidden& hidden) {
  constexpr const char* GATHER = "screen/gather/area/gather.comp.glsl";
  const std::string hides = hidden.rays != nullptr     ? "RAYS"
                            : hidden.voxels != nullptr ? "VOXELS"
                            : hidden.faces != nullptr  ? "FACES"
                                                       : "NOTHING";
  if (hides_ != hides) {
    hides_ = hides;
    gather_first_ = gl::Program::compute(GATHER, {hides, "FIRST"});
    gather_finer_ = gl::Program::compute(GATHER, {hides});
    if (hidden.rays != nullptr) {
      ask_first_ = gl::Program::compute(GATHER, {hides, "FIRST", "ASK"});
      ask_finer_ = gl::Program::compute(GATHER, {hides, "ASK"});
    }
  }
  return first ? gather_first_ : gather_finer_;
}

void AreaGather::run(const GBuffer& gbuffer, const AreaLights& lights, const Hidden& hidden, gl::PassTimer& timer) {
  gbuffer.bind();
  if (hidden.rays != nullptr) lights_ = lights.download();
  counts_.clear();
  gathered_step_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  const int per_group = lights_in_group(lights.count());
  for (const Level& level : levels_) {
    const auto scope = timer.scope(level_name(level.step_px));
    refine(level, (lights.count() + per_group - 1) / per_group);
    gather(level, lights, hidden);
    if (level.step_px == 1 && level.lists.size() > 1 && per_group >= AREA_SHARES) join(level);
  }
  const auto scope = timer.scope(shade_name);
  irradiance_.bind(AREA_IRRADIANCE_UNIT);
  radiance_.bind_image(AREA_RADIANCE_IMAGE, GL_WRITE_ONLY);
  shade_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void AreaGather::bind_pictures() const {
  irradiance_.bind(AREA_IRRADIANCE_UNIT);
  irradiance_.bind_image(AREA_IRRADIANCE_IMAGE, GL_READ_WRITE);
  masks_.bind(AREA_MASK_UNIT);
  masks_.bind_image(AREA_MASK_IMAGE, GL_READ_WRITE);
}

void AreaGather::refine(const Level& level, int groups) {
  bind_pictures();
  gathered_step_.bind_image(AREA_STEP_IMAGE, GL_WRITE_ONLY);
  const int shares = int(level.lists.size());
  const gl::Program& program = level.step_px == options_.coarsest ? first_ : finer_;
  program.set("step_px", level.step_px);
  program.set("tolerance", options_.tolerance);
  program.set("most_in_part", options_.in_part * float(groups));
  program.set("shares", shares);
  program.use();
  const glm::ivec2 grid = (size_ + level.step_px - 1) / level.step_px;
  for (int share = 0; share < shares; ++share) {
    const WorkList& list = level.lists[size_t(share)];
    list.clear();
    list.bind(AREA_LIST_SLOT);
    program.set("share", share);
    gl::dispatch({(grid.x + shares - 1) / shares, grid.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  }
  wait_for_pixels();
}

/// Of one dispatch: some members of some groups.
struct AreaGather::Part {
  bool first_level;
  int per_group, shares, first, end;
  glm::ivec2 groups;
  void set(const gl::Program& program) const {
    program.set("first", first);
    program.set("end", end);
    program.set("groups", groups);
  }
};

void AreaGather::ask(const WorkList& list, const Part& part, const HostRays& rays) {
  const size_t pixels = list.count();
  const auto members = size_t((part.end - part.first + part.shares - 1) / part.shares);
  gl::reserve(askers_, 2 * pixels * sizeof(glm::vec4));
  gl::reserve(questions_, members * pixels * sizeof(glm::uvec2));
  askers_.bind_storage(AREA_ASKERS_SLOT);
  questions_.bind_storage(AREA_QUESTIONS_SLOT);
  const gl::Program& program = part.first_level ? ask_first_ : ask_finer_;
  part.set(program);
  program.use();
  list.dispatch();
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  rays.answer({pixels, part.per_group, part.shares, part.first, part.end}, lights_, askers_, questions_);
}

void AreaGather::gather(const Level& level, const AreaLights& lights, const Hidden& hidden) {
  const bool first_level = level.step_px == options_.coarsest;
  const gl::Program& program = gather_program(first_level, hidden);
  if (hidden.voxels != nullptr) hidden.voxels->bind(program);
  if (hidden.faces != nullptr && hidden.rays == nullptr) {
    hidden.faces->voxels.bind();
    cells_.bind(hidden.faces->voxels);
  }
  const int per_group = lights_in_group(lights.count());
  const int shares = per_group >= AREA_SHARES ? int(level.lists.size()) : 1;
  lights.buffer().bind_storage(AREA_LIGHTS_SLOT);
  counts_.bind_storage(AREA_COUNTS_SLOT);
  bind_pictures();
  if (shares > 1 && level.step_px == 1) shared_irradiance_.bind_image(AREA_IRRADIANCE_IMAGE, GL_READ_WRITE);
  const auto set_level = [&](const gl::Program& p) {
    p.set("step_px", level.step_px);
    p.set("light_count", lights.count());
    p.set("per_group", per_group);
    p.set("shares", shares);
    p.set("incremental", options_.incremental ? 1 : 0);
  };
  set_level(program);
  if (hidden.rays != nullptr) set_level(first_level ? ask_first_ : ask_finer_);
  const int ways = std::max(TURNS_AT_ONCE / turns_of_way(hidden), 1);  // of a thread
  const int groups = std::min(ways, AREA_GROUPS);
  const int members = hidden.rays != nullptr ? AREA_SHARES : std::max(ways / AREA_GROUPS, 1);
  for (size_t k = 0; k < level.lists.size(); ++k) {
    const int share = shares > 1 ? int(k) : 0;
    level.lists[k].bind(AREA_LIST_SLOT);
    bool begun = false;
    for (int first = share; first < per_group; first += members * shares) {
      for (int group = 0; group < AREA_GROUPS; group += groups) {
        const Part part{first_level,
                        per_group,
                        shares,
                        first,
                        std::min(first + members * shares, per_group),
                        {group, std::min(group + groups, AREA_GROUPS)}};
        if (hidden.rays != nullptr) ask(level.lists[k], part, *hidden.rays);
        part.set(program);
        program.set("begun", begun ? 1 : 0);
        program.use();
        level.lists[k].dispatch();
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        begun = true;
      }
    }
  }
  wait_for_pixels();
}

void AreaGather::join(const Level& level) {
  bind_pictures();
  shared_irradiance_.bind(AREA_SHARED_UNIT);
  gathered_step_.bind(AREA_STEP_UNIT);
  join_.set("step_px", level.step_px);
  join_.use();
  for (const WorkList& list : level.lists) {
    list.bind(AREA_LIST_SLOT);
    list.dispatch();
  }
  wait_for_pixels();
}

AreaGather::Figures AreaGather::figures() const {
  Figures f{};
  double gathered = 0.0;
  for (const Level& level : levels_) {
    double here = 0.0;
    for (const WorkList& list : level.lists) here += double(list.count());
    const glm::dvec2 grid((size_ + level.step_px - 1) / level.step_px);
    f.level.push_back(here / (grid.x * grid.y));
    gathered += here;
  }
  const std::vector<GLuint> counts = counts_.download<GLuint>(2);
  f.gathered = gathered / (double(size_.x) * double(size_.y));
  f.ways = double(counts[1]);
  f.asked = double(counts[1]) / std::max(double(counts[0]), 1.0);
  return f;
}

size_t AreaGather::bytes() const {
  size_t bytes = (4 * 16 + 1) * size_t(size_.x) * size_t(size_.y) + counts_.bytes();
  if (questions_.id() != 0) bytes += questions_.bytes() + askers_.bytes();
  for (const Level& level : levels_) {
    for (const WorkList& list : level.lists) bytes += list.bytes();
  }
  return bytes;
}

}  // namespace volgi::screen
