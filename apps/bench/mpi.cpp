#include "apps/bench/mpi.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <thread>

#include "apps/bench/closed_box.h"
#include "apps/bench/timing.h"
#include "core/ranks_in_threads.h"
#include "propagation/sweep/sweep_model.h"
#include "propagation/transport_ordinates_cpu.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::app {

namespace {

using Powers = std::vector<glm::vec4>;

/// Meets all others.
void meet(const Ranks& ranks) { ranks.gather({}); }

struct Messages {
  double latency_s = 0.0, bytes_per_s = 1e10;
};

/// There and back between the first rank and the last, which others wait for.
double round_trip_s(const Ranks& ranks, size_t bytes, int repeats) {
  constexpr int kTag = 20;
  Ranks::Bytes buffer(bytes);
  const int last = ranks.count() - 1, rank = ranks.rank();
  const auto wait = [&](std::unique_ptr<Ranks::Message> message) {
    Ranks::Message* const one[1] = {message.get()};
    ranks.wait_any(one);
  };
  std::vector<double> times;
  times.reserve(size_t(repeats));
  for (int i = 0; i < repeats; ++i) {
    times.push_back(1e-3 * time_ms([&] {
                      if (rank == 0) {
                        wait(ranks.send(last, kTag, buffer));
                        wait(ranks.receive(last, kTag, buffer));
                      } else if (rank == last) {
                        wait(ranks.receive(0, kTag, buffer));
                        wait(ranks.send(0, kTag, buffer));
                      }
                    }));
  }
  meet(ranks);
  return median(times);
}

Messages measure_messages(const Ranks& ranks) {
  constexpr size_t kLarge = 1 << 20;
  Messages m;
  m.latency_s = 0.5 * round_trip_s(ranks, 8, 200);
  m.bytes_per_s = double(kLarge) / std::max(0.5 * round_trip_s(ranks, kLarge, 50) - m.latency_s, 1e-9);
  const auto all = ranks.gather(std::array{m.latency_s, m.bytes_per_s});
  return {all[0], all[1]};
}

/// One order from all sides, on so many threads.
class Sweep {
 public:
  Sweep(const VoxelGrid& voxels, OrdinateChoice choice, const RanksOfVolume* ranks)
      : transport_(voxels, choice, nullptr, ranks),
        sent_(voxels.side_count(), glm::vec4(1.0f)),
        received_(voxels.side_count()) {}
  void run(int threads) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      BounceReport report;
      transport_.carry(sent_, received_, BounceRules(), report);
    });
  }
  const SweepPipeline& pipeline() const { return transport_.pipeline(); }
  size_t bytes() const { return transport_.bytes(); }

 private:
  OrdinatesTransportCpu transport_;
  Powers sent_, received_;
};

double unknowns(const Grid& grid, OrdinateChoice choice) { return double(cell_count(grid)) * choice.directions * 3.0; }

struct Problem {
  Grid grid;
  VoxelGrid whole;  // of the first rank alone
  OrdinateChoice choice;
};

Problem make_problem(float length, int cells, bool whole) {
  const Scene scene = closed_box(length);
  Problem p{make_grid(scene, int(std::lround(float(cells) * std::max(length, 1.0f)))), {}, {}};
  p.choice = choose_ordinates(p.grid.cells, {});
  if (whole) p.whole = voxelize_cpu(scene, p.grid);
  return p;
}

/// A rank of its own.
class OneRank : public Ranks {
 public:
  int rank() const override { return 0; }
  int count() const override { return 1; }
  std::unique_ptr<Message> send(int, int, std::span<const std::byte>) const override { return nullptr; }
  std::unique_ptr<Message> receive(int, int, std::span<std::byte>) const override { return nullptr; }
  void wait_any(std::span<Message* const>) const override {}
  void add(std::span<std::int64_t>) const override {}
  std::vector<double> gather(std::span<const double> values) const override { return {values.begin(), values.end()}; }
  std::vector<Bytes> exchange(std::vector<Bytes> to) const override { return to; }
  double waited_s() const override { return 0.0; }
};

/// Seconds from the first rank's start to the last one's end, on all ranks.
double together_s(const Ranks& ranks, const std::function<void()>& run) {
  meet(ranks);
  const double own = 1e-3 * time_ms([&] {
                       run();
                       meet(ranks);
                     });
  const std::vector<double> all = ranks.gather(std::array{own});
  return *std::max_element(all.begin(), all.end());
}

/// Of the first rank, while the others wait.
double alone_s(const Ranks& ranks, const std::function<void()>& run) {
  const double own = ranks.rank() == 0 ? 1e-3 * time_ms(run) : 0.0;
  meet(ranks);
  return ranks.gather(std::array{own})[0];
}

int cores() { return std::max(1, int(std::thread::hardware_concurrency())); }

SweepModel model_of(const Decomposition& d, const SweepPipeline& pipeline, const BlockBox& part, OrdinateChoice choice,
                    const Messages& m, double sweep_s) {
  const double face = double(sweep::kBlockFace) * 3.0 * choice.directions / 8.0 * sizeof(float);
  const double width = pipeline.chunk_blocks();
  return {d.along_yz(),
          pipeline.chunks(),
          sweep_s / (8.0 * pipeline.chunks()),
          width * part.size().z * face,
          width * part.size().y * face,
          m.latency_s,
          m.bytes_per_s,
          pipeline.octants_at_once()};
}

/// What is measured in turns, since a machine that others use as well is slower at times.
struct Turns {
  std::vector<double> one, threads, own, all;
};

/// One grid on all ranks, against the first one alone with a grid of its own, `one`.
nlohmann::json scale(const Ranks& ranks, const Messages& messages, float length, int cells, Sweep* one,
                     double work_of_one, int repeats) {
  const Scene scene = closed_box(length);
  const Problem p = make_problem(length, cells, false);
  const RanksOfVolume of{ranks, Decomposition(leaf_blocks(p.grid), ranks.count())};
  const VoxelGrid voxels = voxelize_cpu(scene, p.grid, voxelization_mipmaps(scene), of);
  // Each its own part, in chunks, as if nothing were around it: what ranks cost each other on one machine is in it, and
  // what chunks cost; waiting and messages are not.
  const OneRank self;
  const RanksOfVolume itself{self, Decomposition(leaf_blocks(p.grid), 1)};
  Sweep own(voxels, p.choice, &itself), sweep(voxels, p.choice, &of);
  Turns turns;
  double waited = 0.0, took = 0.0;
  for (int i = -1; i < repeats; ++i) {  // the first warms up
    const double one_s = alone_s(ranks, [&] { one->run(1); });
    const double threads_s = alone_s(ranks, [&] { one->run(ranks.count()); });
    const double own_s = together_s(ranks, [&] { own.run(1); });
    const double before = ranks.waited_s();
    const double all_s = together_s(ranks, [&] { sweep.run(1); });
    if (i < 0) continue;
    waited += ranks.waited_s() - before;
    took += all_s;
    turns.one.push_back(one_s);
    turns.threads.push_back(threads_s);
    turns.own.push_back(own_s);
    turns.all.push_back(all_s);
  }
  const std::vector<double> waits = ranks.gather(std::array{waited / took});
  const int useful = std::min(ranks.count(), cores());
  const double ideal_of_one = unknowns(p.grid, p.choice) / work_of_one / useful;
  std::vector<double> measured, predicted, against, over_threads;
  SweepPrediction last;
  for (size_t i = 0; i < turns.all.size(); ++i) {
    last = predict(model_of(of.decomposition, sweep.pipeline(), of.part(), p.choice, messages, turns.own[i]));
    measured.push_back(ideal_of_one * turns.one[i] / turns.all[i]);
    predicted.push_back(ideal_of_one * turns.one[i] / last.sweep_s);
    against.push_back(last.sweep_s / turns.all[i]);
    over_threads.push_back(turns.all[i] / turns.threads[i]);
  }
  return {{"cells", {p.grid.cells.x, p.grid.cells.y, p.grid.cells.z}},
          {"ranks_y_z", {of.decomposition.along_yz().x, of.decomposition.along_yz().y}},
          {"chunks", sweep.pipeline().chunks()},
          {"octants_at_once", sweep.pipeline().octants_at_once()},
          {"directions", p.choice.directions},
          {"one_s", median(turns.one)},
          {"own_part_s", median(turns.own)},
          {"sweep_s", median(turns.all)},
          {"least_stages", last.least_stages},
          {"efficiency", median(measured)},
          {"predicted_efficiency", median(predicted)},
          {"measured_over_predicted", median(against)},
          {"over_threads", median(over_threads)},
          {"ns_per_unknown", 1e9 * median(turns.all) * useful / unknowns(p.grid, p.choice)},
          {"megabytes_sent", double(sweep.pipeline().traffic().bytes) / (repeats + 1) / 1e6},
          {"waits", waits},
          {"oversubscribed", ranks.count() > cores()}};
}

/// From the model alone: more ranks than there are, on a network that is assumed.
nlohmann::json on_paper(double ns_per_unknown) {
  constexpr double kLatency = 2e-6, kBytesPerSecond = 10e9;
  nlohmann::json rows;
  for (const int ranks : {64, 512, 4096}) {
    for (const bool weak : {false, true}) {
      const int edge = weak ? int(std::lround(128.0 * std::cbrt(double(ranks)))) / 8 * 8 : 1024;
      const glm::ivec3 blocks(edge / 8);
      const Decomposition d(blocks, ranks);
      const OrdinateChoice choice{128, Ordinates::characteristic};
      const glm::ivec3 part =
          (blocks + glm::ivec3(1, d.along_yz().x, d.along_yz().y) - 1) / glm::ivec3(1, d.along_yz().x, d.along_yz().y);
      SweepModel best;
      SweepPrediction found;
      for (const int width : {1, 2, 4, 8}) {
        const double face = double(sweep::kBlockFace) * 3.0 * choice.directions / 8.0 * sizeof(float);
        const double task = double(width) * part.y * part.z * sweep::kBlockVolume * choice.directions / 8.0 * 3.0 *
                            ns_per_unknown * 1e-9;
        // What waits for the next chunk is most of what an octant keeps.
        const bool many = 8.0 * part.y * part.z * face > double(SweepPipeline::kManyFlowsOfRank);
        const SweepModel m{d.along_yz(),
                           (blocks.x + width - 1) / width,
                           task,
                           width * part.z * face,
                           width * part.y * face,
                           kLatency,
                           kBytesPerSecond,
                           many ? 4 : 8};
        const SweepPrediction p = predict(m);
        if (p.efficiency > found.efficiency) best = m, found = p;
      }
      rows.push_back({{"ranks", ranks},
                      {"edge", edge},
                      {"ranks_y_z", {d.along_yz().x, d.along_yz().y}},
                      {"chunks", best.chunks},
                      {"task_ms", 1e3 * best.task_s},
                      {"sweep_s", found.sweep_s},
                      {"least_stages", found.least_stages},
                      {"efficiency", found.efficiency}});
    }
  }
  return rows;
}

nlohmann::json bench(const Ranks& ranks, int cells, int repeats) {
  nlohmann::json r;
  r["ranks"] = ranks.count();
  r["cores"] = cores();
  Messages messages;
  if (ranks.count() > 1) messages = measure_messages(ranks);
  r["latency_us"] = 1e6 * messages.latency_s;
  r["bytes_per_s"] = messages.bytes_per_s;
  const Problem p = make_problem(1.0f, cells, ranks.rank() == 0);
  std::optional<Sweep> one;
  if (ranks.rank() == 0) one.emplace(p.whole, p.choice, nullptr);
  Sweep* const first = one ? &*one : nullptr;
  std::vector<double> times;
  for (int i = 0; i <= repeats; ++i) times.push_back(alone_s(ranks, [&] { first->run(1); }));
  const double work = unknowns(p.grid, p.choice), ns = 1e9 * median(times) / work;
  r["ns_per_unknown_of_one"] = ns;
  if (ranks.count() > 1) {
    r["strong"] = scale(ranks, messages, 1.0f, cells, first, work, repeats);
    r["weak"] = scale(ranks, messages, float(ranks.count()), cells, first, work, repeats);
  }
  if (ranks.rank() == 0) r["on_paper"] = on_paper(ns);
  return r;
}

std::string scaling_row(const char* name, const nlohmann::json& s, int ranks) {
  const auto& cells = s["cells"];
  const auto waits = s["waits"].get<std::vector<double>>();
  return fmt::format(
      "{} scaling, {} x {} x {} cells, {} directions, {} ranks as {} x {}, {} chunks, {} octants at once{}\n"
      "  one rank {:.1f} ms, all {:.1f} ms, its own part alone {:.1f} ms; {:.3f} ns an unknown and core, {:.1f} MB "
      "sent "
      "by the first rank\n"
      "  efficiency {:.1f} %, predicted {:.1f} %, measured over predicted {:.3f}; least stages {}\n"
      "  waiting, share of the time by rank: {:.3f}\n",
      name, cells[0].get<int>(), cells[1].get<int>(), cells[2].get<int>(), s["directions"].get<int>(), ranks,
      s["ranks_y_z"][0].get<int>(), s["ranks_y_z"][1].get<int>(), s["chunks"].get<int>(),
      s["octants_at_once"].get<int>(),
      s["oversubscribed"].get<bool>() ? " (more ranks than cores: efficiency is of the cores)" : "",
      1e3 * s["one_s"].get<double>(), 1e3 * s["sweep_s"].get<double>(), 1e3 * s["own_part_s"].get<double>(),
      s["ns_per_unknown"].get<double>(), s["megabytes_sent"].get<double>(), 100.0 * s["efficiency"].get<double>(),
      100.0 * s["predicted_efficiency"].get<double>(), s["measured_over_predicted"].get<double>(),
      s["least_stages"].get<int>(), fmt::join(waits, ", "));
}

}  // namespace

nlohmann::json bench_mpi(const Ranks* ranks, int cells, int repeats) {
  if (ranks != nullptr) return bench(*ranks, cells, repeats);
  nlohmann::json result;
  run_ranks_in_threads(1, [&](const Ranks& one) { result = bench(one, cells, repeats); });
  return result;
}

std::string mpi_table(const nlohmann::json& r) {
  const int ranks = r["ranks"].get<int>();
  std::string text = fmt::format("one rank, one thread: {:.3f} ns an unknown (cell, direction, band)\n",
                                 r["ns_per_unknown_of_one"].get<double>());
  if (ranks > 1) {
    text += fmt::format("messages: latency {:.1f} us, {:.2f} GB/s; {} cores\n", r["latency_us"].get<double>(),
                        1e-9 * r["bytes_per_s"].get<double>(), r["cores"].get<int>());
    text += scaling_row("strong", r["strong"], ranks);
    text += fmt::format("  against one rank of {} threads: {:.2f} x its time\n", ranks,
                        r["strong"]["over_threads"].get<double>());
    text += scaling_row("weak", r["weak"], ranks);
  }
  text += "on paper, from this time per unknown, 2 us and 10 GB/s, a core a rank:\n";
  for (const auto& p : r["on_paper"])
    text += fmt::format(
        "  {:5} ranks as {:3} x {:3}, {}^3 cells, {:3} chunks of {:.2f} ms: {:.2f} s an order, "
        "efficiency {:.0f} %, least stages {}\n",
        p["ranks"].get<int>(), p["ranks_y_z"][0].get<int>(), p["ranks_y_z"][1].get<int>(), p["edge"].get<int>(),
        p["chunks"].get<int>(), p["task_ms"].get<double>(), p["sweep_s"].get<double>(),
        100.0 * p["efficiency"].get<double>(), p["least_stages"].get<int>());
  return text;
}

}  // namespace volgi::app
