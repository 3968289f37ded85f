#include "apps/bench/propagation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "apps/bench/closed_box.h"
#include "apps/bench/timing.h"
#include "propagation/bounces_cpu.h"
#include "voxel/emitter_pieces.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::app {

namespace {

constexpr float kAlbedo = 0.7f;
constexpr int kLargestConservative = 32;  // cells on an edge
constexpr double kError = 0.005;          // the error must be below this

int add_material(Scene& scene, float albedo, float radiance) {
  Material m;
  m.base_color_factor = glm::vec4(glm::vec3(albedo), 1.0f);
  m.metallic_factor = 0.0f;
  m.emissive_radiance = glm::vec3(radiance);
  scene.materials.push_back(m);
  return int(scene.materials.size()) - 1;
}

void add_quad(Scene& scene, int material, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  Mesh mesh;
  mesh.material = material;
  mesh.object_id = std::uint32_t(scene.meshes.size()) + 1;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.normals.assign(4, glm::normalize(glm::cross(u, v)));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
}

}  // namespace

Scene closed_box(float length) {
  Scene scene;
  scene.name = "closed_box";
  const int wall = add_material(scene, kAlbedo, 0.0f);
  const int lamp = add_material(scene, kAlbedo, 1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    for (float side : {-1.0f, 1.0f}) {
      glm::vec3 n(0.0f), a(0.0f), b(0.0f);
      n[axis] = side;
      a[(axis + 1) % 3] = 1.0f;
      b[(axis + 2) % 3] = -side;
      const glm::vec3 stretched(1.0f, 1.0f, length);
      add_quad(scene, wall, stretched * (n - a - b), stretched * (2.0f * a), stretched * (2.0f * b));
    }
  }
  add_quad(scene, lamp, {-0.25f, 0.999f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f});
  update_bounds(scene);
  return scene;
}

namespace {

/// Everything that the solvers need of the box at one resolution.
struct Box {
  VoxelGrid voxels;
  SideFlux flux;

  explicit Box(int cells) {
    const Scene scene = closed_box();
    const Grid grid = make_grid(scene, cells);
    voxels = voxelize_cpu(scene, grid);
    flux.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
    flux.punctual.assign(voxels.side_count(), glm::vec4(0.0f));
    deposit(voxels, emitter_pieces(scene, grid), flux.emitted, flux.lost);
  }
};

/// RMS over the sides of the received indirect power, over its mean.
double relative_error(const std::vector<glm::vec4>& test, const std::vector<glm::vec4>& reference) {
  double squares = 0.0, sum = 0.0;
  for (size_t i = 0; i < reference.size(); ++i) {
    const double d = double(test[i].x) - double(reference[i].x);
    squares += d * d;
    sum += double(reference[i].x);
  }
  return std::sqrt(squares / double(reference.size())) / (sum / double(reference.size()));
}

BounceRules exact_rules() {
  BounceRules rules;
  rules.largest_albedo = kAlbedo;
  rules.bounces = 60;  // 0.7^60 = 5e-10
  return rules;
}

struct Solved {
  double ms, error;
  int passes;
};

/// The cheapest setting of the passes (`ordinates`: plain orders or conjugate gradients; `conservative`: passes in all)
/// that stays under kError.
Solved solve_ordinates(const Box& box, int directions, Ordinates rule, BounceRules::Solver solver, int repeats) {
  SchemeOptions scheme;
  scheme.directions = directions;
  scheme.ordinates = rule;
  BouncesCpu bounces(make_transport(box.voxels, scheme));
  bounces.run(box.voxels, box.flux, true, exact_rules());
  const std::vector<glm::vec4> converged = bounces.received_indirect();
  BounceRules rules;
  rules.largest_albedo = kAlbedo;
  rules.solver = solver;
  BounceReport report;
  const double ms = median_ms(repeats, [&] { report = bounces.run(box.voxels, box.flux, true, rules); });
  return {ms, relative_error(bounces.received_indirect(), converged), report.passes};
}

Solved solve_conservative(const Box& box, int repeats) {
  SchemeOptions scheme;
  scheme.scheme = Scheme::conservative;
  scheme.coarse_start = false;
  BouncesCpu bounces(make_transport(box.voxels, scheme));
  BounceRules rules;
  rules.largest_albedo = kAlbedo;
  rules.iterations = 60 * std::max(box.voxels.grid().cells.x, 16);
  bounces.run(box.voxels, box.flux, true, rules);
  const std::vector<glm::vec4> converged = bounces.received_indirect();
  const int cells = box.voxels.grid().cells.x;
  Solved solved{0.0, 1.0, 0};
  for (int passes = 6 * cells; solved.error > kError && passes < 60 * cells; passes += 2 * cells) {
    rules.iterations = passes;
    bounces.run(box.voxels, box.flux, true, rules);
    solved = {0.0, relative_error(bounces.received_indirect(), converged), passes};
  }
  rules.iterations = solved.passes;
  solved.ms = median_ms(std::max(1, repeats / 3), [&] { bounces.run(box.voxels, box.flux, true, rules); });
  return solved;
}

nlohmann::json solved_json(int cells, const std::string& what, const Solved& s) {
  return {{"cells", cells}, {"solver", what}, {"ms", s.ms}, {"error_percent", 100.0 * s.error}, {"passes", s.passes}};
}

/// Slope of log y over log x by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  const double n = double(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    const double lx = std::log(x[i]), ly = std::log(y[i]);
    sx += lx;
    sy += ly;
    sxx += lx * lx;
    sxy += lx * ly;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Passes through a box whose walls all send, so that every cell has light to move.
class Passes {
 public:
  Passes(int cells, const SchemeOptions& scheme, int passes)
      : box_(cells),
        transport_(make_transport(box_.voxels, scheme)),
        passes_(passes),
        sent_(box_.voxels.side_count(), glm::vec4(1.0f)),
        received_(box_.voxels.side_count(), glm::vec4(0.0f)) {}

  void run() {
    BounceRules rules;
    rules.iterations = passes_;
    BounceReport report;
    const int times = transport_->iterative() ? 1 : passes_;
    for (int i = 0; i < times; ++i) transport_->carry(sent_, received_, rules, report);
  }

 private:
  Box box_;
  std::unique_ptr<TransportCpu> transport_;
  int passes_;
  std::vector<glm::vec4> sent_, received_;
};

/// Times of what takes turns, [round][which], after a round that warms up.
std::vector<std::vector<double>> times_in_turn(std::vector<std::unique_ptr<Passes>>& all, int rounds) {
  std::vector<std::vector<double>> times;
  for (int round = -1; round < rounds; ++round) {
    std::vector<double> of_round;
    of_round.reserve(all.size());
    for (auto& passes : all) of_round.push_back(time_ms([&] { passes->run(); }));
    if (round >= 0) times.push_back(std::move(of_round));
  }
  return times;
}

/// Median over the rounds of each round's exponent: on a shared machine some rounds are slow.
double exponent_in_turn(const std::vector<double>& x, const std::vector<std::vector<double>>& rounds) {
  std::vector<double> exponents;
  exponents.reserve(rounds.size());
  for (const auto& times : rounds) exponents.push_back(exponent(x, times));
  return median(exponents);
}

double median_of(const std::vector<std::vector<double>>& rounds, size_t which) {
  std::vector<double> times;
  times.reserve(rounds.size());
  for (const auto& round : rounds) times.push_back(round[which]);
  return median(times);
}

nlohmann::json growth(Scheme scheme_kind, int largest_grid, int repeats) {
  SchemeOptions scheme;
  scheme.scheme = scheme_kind;
  scheme.directions = 24;
  scheme.ordinates = Ordinates::step;
  scheme.coarse_start = false;
  if (scheme_kind != Scheme::ordinates) scheme.directions.reset();
  const int rounds = std::max(repeats, 5);
  std::vector<int> edges;
  std::vector<double> cells;
  std::vector<std::unique_ptr<Passes>> grids;
  // As many passes for all, and enough for light to fill the largest.
  const int count = scheme_kind == Scheme::ordinates ? 8 : 2 * largest_grid;
  for (int n = 32; n <= largest_grid; n += n < 64 ? 16 : 32) {
    edges.push_back(n);
    cells.push_back(double(n) * n * n);
    grids.push_back(std::make_unique<Passes>(n, scheme, count));
  }
  const auto by_cells = times_in_turn(grids, rounds);
  nlohmann::json rows = nlohmann::json::array();
  for (size_t i = 0; i < edges.size(); ++i) {
    const double ms = median_of(by_cells, i) / count;
    const size_t bytes = size_t(cells[i]) * 48;
    Copying copying(bytes);
    const double copy = 2.0 * double(bytes) / (median_ms(rounds, [&] { copying.run(); }) * 1e6);
    rows.push_back(
        {{"cells", edges[i]}, {"ms_a_pass", ms}, {"ns_a_cell", ms * 1e6 / cells[i]}, {"copy_GB_per_s", copy}});
  }
  std::vector<double> passes;
  std::vector<std::unique_ptr<Passes>> runs;
  for (int p : {64, 128, 256}) {
    passes.push_back(p);
    runs.push_back(std::make_unique<Passes>(32, scheme, p));
  }
  return {{"rows", rows},
          {"exponent_cells", exponent_in_turn(cells, by_cells)},
          {"exponent_passes", exponent_in_turn(passes, times_in_turn(runs, rounds))}};
}

}  // namespace

nlohmann::json bench_propagation(int largest_grid, int repeats) {
  nlohmann::json solved = nlohmann::json::array();
  for (int n : {32, largest_grid}) {
    const Box box(n);
    using Solver = BounceRules::Solver;
    solved.push_back(solved_json(n, "ordinates, step, 24, conjugate gradients",
                                 solve_ordinates(box, 24, Ordinates::step, Solver::conjugate_gradients, repeats)));
    solved.push_back(solved_json(n, "ordinates, step, 24, plain bounces",
                                 solve_ordinates(box, 24, Ordinates::step, Solver::plain, repeats)));
    for (int directions : {48, 80, 128}) {
      solved.push_back(solved_json(
          n, fmt::format("ordinates, characteristic, {}, conjugate gradients", directions),
          solve_ordinates(box, directions, Ordinates::characteristic, Solver::conjugate_gradients, repeats)));
    }
    // At 128^3 its converged answer alone would take minutes.
    if (n > kLargestConservative) continue;
    solved.push_back(solved_json(n, "conservative", solve_conservative(box, repeats)));
    solved.back()["over_ordinates"] = solved.back()["ms"].get<double>() / solved[solved.size() - 6]["ms"].get<double>();
  }
  return {{"scene", "closed box, albedo 0.7, emitter 0.5 m in the ceiling"},
          {"solved", solved},
          {"growth",
           {{"ordinates", growth(Scheme::ordinates, largest_grid, repeats)},
            {"conservative", growth(Scheme::conservative, largest_grid, repeats)}}}};
}

std::string propagation_table(const nlohmann::json& r) {
  std::string text =
      fmt::format("{}, to {} % of its own converged answer:\n", r["scene"].get<std::string>(), 100.0 * kError);
  for (const auto& s : r["solved"]) {
    text += fmt::format("  {:>4}^3  {:<48} {:9.2f} ms  {:4} passes  error {:.3f} %", s["cells"].get<int>(),
                        s["solver"].get<std::string>(), s["ms"].get<double>(), s["passes"].get<int>(),
                        s["error_percent"].get<double>());
    if (s.contains("over_ordinates")) text += fmt::format("  ({:.1f} x ordinates)", s["over_ordinates"].get<double>());
    text += '\n';
  }
  for (const char* scheme : {"ordinates", "conservative"}) {
    const auto& g = r["growth"][scheme];
    text += fmt::format("{}: time grows as cells^{:.2f}, as passes^{:.2f}\n", scheme, g["exponent_cells"].get<double>(),
                        g["exponent_passes"].get<double>());
    for (const auto& row : g["rows"]) {
      text += fmt::format("  {:>4}^3  {:8.3f} ms a pass  {:6.2f} ns a cell  (copy {:.1f} GB/s at 48 bytes a cell)\n",
                          row["cells"].get<int>(), row["ms_a_pass"].get<double>(), row["ns_a_cell"].get<double>(),
                          row["copy_GB_per_s"].get<double>());
    }
  }
  return text;
}

}  // namespace volgi::app
