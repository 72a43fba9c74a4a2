// bench_seek: how long a jump to a line of a program takes in the player.
//
//   bench_seek [--program FILE --stock SPEC --tool N=SHAPE] [--cell MM] [--seeks N] [--seed N]
//   bench_seek --nest MOVES [--seeks N] [--seed N]
//   bench_seek --workload NAME [--seeks N] [--seed N]
// and --keyframes MB: memory for the keyframes, as kerf view takes it. The numbers of moves are
// kept, as in the window.
//
// Without a program: w2_finish_1m (workloads.h). --nest: a torch program of so many cuts, discs
// with two holes each in a lattice (lead-in and full circle), from a sheet of 2000 mm x 1000 mm.
// --workload: another one of workloads.h; of one that is turned 50 ms are asked for.
// Loads it, cuts it once to its end, and seeks to random lines, to and fro. The workpieces of a
// sample of the places are first compared with those of cutting from the start: wrong ones end the
// run. Then times, from the command until the state of the new place is there: p50, p95, maximum;
// single blocks forward and back; of a Z-map finding the motion that made a point of its surface.
// Ends with 1 if the p95 of the seeks exceeds kMost_ms.
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/bench/workloads.h"
#include "twin/playback/load_program.h"
#include "twin/playback/player.h"
#include "twin/process/cut_stage.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// What is asked of the player: any line of w2_finish_1m within this (p95).
constexpr double kMost_ms = 100;
constexpr double kMostTurned_ms = 50;
constexpr std::chrono::minutes kPatience{30};
constexpr int kComparedPlaces = 4;
constexpr int kSteps = 200;

struct Arguments {
  std::string program, stock, tool;
  double cell_mm = 0;
  int nest_moves = 0;
  std::string workload = "w2_finish_1m";
  bool turns = false;  ///< of the workload
  int seeks = 200;
  double keyframes_mb = 0;  ///< 0: as the player has it
  unsigned seed = 1;
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_seek: {}\n", why);
  std::exit(2);
}

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double rss_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmRSS:") continue;
    double kb = 0;
    status >> kb;
    return kb / 1024;
  }
  return 0;
}

void print_times(const char* what, std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  const auto at = [&](double share) {
    return ms[std::min(ms.size() - 1,
                       static_cast<std::size_t>(share * static_cast<double>(ms.size())))];
  };
  fmt::print("{:30} p50 {:8.2f} ms   p95 {:8.2f} ms   max {:8.2f} ms   ({})\n", what, at(0.5),
             at(0.95), ms.back(), ms.size());
}

double p95(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return ms[ms.size() * 95 / 100];
}

/// The inner contours of a disc first, as nests are cut. One line a motion.
std::string nest_of_discs(int moves) {
  constexpr double kPitch_mm = 30;
  constexpr int kColumns = 66;
  std::string text = "G21 G90 G17 F3000 T1 M6\n";
  for (int part = 0; moves > 0; ++part) {
    const double x = (part % kColumns + 0.5) * kPitch_mm, y = (part / kColumns + 0.5) * kPitch_mm;
    const auto contour = [&](double shift, double radius, double lead) {
      if (moves <= 0) return;
      text += fmt::format("G0 X{:.3f} Y{:.3f}\nM3 S1\nG1 X{:.3f}\n", x + shift + radius + lead, y,
                          x + shift + radius);
      if (moves > 1) text += fmt::format("G{} I{:.3f} J0\n", lead > 0 ? 2 : 3, -radius);
      text += "M5\n";
      moves -= 2;
    };
    contour(kPitch_mm * 0.2, kPitch_mm * 0.17, -2);
    contour(-kPitch_mm * 0.2, kPitch_mm * 0.17, -2);
    contour(0, kPitch_mm * 0.44, 2);
  }
  return text + "M2\n";
}

/// The program to be played, in a folder that goes with it.
class Source {
 public:
  explicit Source(const Arguments& arguments) : arguments_(arguments) {
    if (!arguments_.program.empty()) return;
    std::string name = (fs::temp_directory_path() / "kerf-bench-XXXXXX").string();
    if (!mkdtemp(name.data())) fail("cannot make a folder in " + name);
    folder_ = name;
    if (arguments_.nest_moves > 0) {
      arguments_.program = folder_ / "nest.ngc";
      arguments_.stock = "sheet:0,0:2000,1000:3";
      arguments_.tool = "1=kerf:3";
      std::ofstream(arguments_.program) << nest_of_discs(arguments_.nest_moves);
      return;
    }
    for (const Workload& workload : workloads()) {
      if (workload.name != arguments_.workload) continue;
      arguments_.program = folder_ / (std::string(workload.name) + ".ngc");
      arguments_.stock = workload.stock;
      arguments_.tool = workload.tool;
      arguments_.turns = workload.turns;
      std::ofstream(arguments_.program) << workload.program();
    }
    if (arguments_.program.empty()) fail(arguments_.workload + " is no workload");
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }

  SessionOptions options() const {
    SessionOptions options;
    options.program.path = arguments_.program;
    options.stock.cell_mm = arguments_.cell_mm;
    options.stock.keeps_cut_ids = !turns() && arguments_.nest_moves == 0;
    if (turns()) options.stock.kind = StockKind::kTurning;
    if (!arguments_.stock.empty()) {
      const Result<Blank> blank = parse_blank(arguments_.stock);
      if (!blank) fail(blank.error());
      options.blank = *blank;
    }
    Result<ToolShapeArgument> tool = parse_tool_argument(arguments_.tool);
    if (!tool) fail(tool.error());
    options.tools.push_back(std::move(*tool));
    return options;
  }

  bool turns() const { return arguments_.turns; }

 private:
  Arguments arguments_;
  fs::path folder_;
};

std::unique_ptr<LoadedProgram> load(const SessionOptions& options) {
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  const Clock::time_point start = Clock::now();
  std::unique_ptr<LoadedProgram> loaded = load_program(options, {}, diagnostics, outcome);
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (!loaded || loaded->player.track->empty()) fail("nothing to play");
  const ProgramTrack& track = *loaded->player.track;
  fmt::print("{}: {} motions ({}), loaded in {:.2f} s, of which {:.2f} s interpreting\n",
             fs::path(options.program.path).filename().string(), track.size(),
             loaded->summary.interpreter, ms_since(start) / 1e3, loaded->summary.interpret_s);
  return loaded;
}

std::shared_ptr<const PlayerState> reached(const Player& player, Player::Ticket ticket) {
  if (!player.wait(ticket, kPatience)) fail("a seek does not arrive");
  return player.state();
}

void cut_to_the_end(const Player& player) {
  const Clock::time_point start = Clock::now();
  std::shared_ptr<const PlayerState> state = player.state();
  while (state->motions_checked < player.track().size()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    state = player.state();
  }
  fmt::print(
      "cut to its end in {:.2f} s; {} findings; {} keyframes, {:.0f} MB; worst way from one to the "
      "next {:.1f} ms of cutting\n",
      ms_since(start) / 1e3, state->findings->size(), state->keyframes,
      static_cast<double>(state->keyframe_bytes) / 1e6, 1e3 * state->worst_seek_s);
}

/// Digests at some motions, by cutting from the start; no keyframes, no record.
std::vector<std::string> dry_run(const ProgramTrack& track, const SessionOptions& options,
                                 const ToolSources& tools, const ProcessPlan& process,
                                 std::span<const TorchMaterial> materials,
                                 const std::vector<std::size_t>& places) {
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  StockChoice choice;
  if (options.stock.kind) choice.kind = *options.stock.kind;
  const StockSetup setup =
      make_stock(*options.blank, choice, options.stock, "--stock", diagnostics, outcome);
  if (!setup.stock) fail("no blank");
  ToolResolver resolver(tools, row_of(*setup.stock).can_cut);
  FindingLog log;
  CutStage stage(*setup.stock, resolver, log, {}, process);
  stage.set_materials(materials);
  std::vector<std::string> digests;
  std::size_t done = 0;
  for (const std::size_t place : places) {
    for (; done < place; ++done) stage.take_timed(track.motion(done), track.step(done));
    stage.take({});
    digests.push_back(setup.stock->snapshot()->digest());
  }
  return digests;
}

void compare(Player& player, const std::vector<std::size_t>& places,
             const std::vector<std::string>& digests) {
  // From the last to the first, and again upward.
  for (const bool down : {true, false}) {
    for (std::size_t n = 0; n < places.size(); ++n) {
      const std::size_t i = down ? places.size() - 1 - n : n;
      const auto state = reached(player, player.seek_motion(places[i]));
      if (state->stock->digest() != digests[i]) {
        fail(fmt::format("wrong workpiece at motion {}", places[i]));
      }
    }
  }
  fmt::print("{} places, down and up: the workpieces are those of cutting from the start\n",
             places.size());
}

std::vector<double> time_seeks(Player& player, const Arguments& arguments) {
  std::mt19937 random(arguments.seed);
  std::vector<double> ms;
  for (int n = 0; n < arguments.seeks; ++n) {
    const SourceRef line = player.track().source(random() % player.track().size());
    const Clock::time_point start = Clock::now();
    reached(player, player.seek_line(line));
    ms.push_back(ms_since(start));
  }
  return ms;
}

std::vector<double> time_steps(Player& player, int blocks) {
  std::vector<double> ms;
  reached(player, player.seek_motion(player.track().size() / 2));
  for (int n = 0; n < kSteps; ++n) {
    const Clock::time_point start = Clock::now();
    reached(player, player.step_block(blocks));
    ms.push_back(ms_since(start));
  }
  return ms;
}

/// Points of the surface at the end, and as many below it, which nothing has touched: the whole
/// program is searched for those.
std::vector<double> time_queries(const CutQuery& cuts, const Player& player, bool touched) {
  std::mt19937 random(2);
  const auto* stock = dynamic_cast<const ZMap*>(player.state()->stock.get());
  const ProgramTrack& track = player.track();
  const Vec3 size = stock->bounds_mm().size(), corner = stock->bounds_mm().min;
  std::vector<double> ms;
  std::size_t found = 0;
  for (int n = 0; n < 200; ++n) {
    const int i = static_cast<int>(random() % static_cast<unsigned>(stock->nx()));
    const int j = static_cast<int>(random() % static_cast<unsigned>(stock->ny()));
    const Vec3 point{corner.x + (i + 0.5) / stock->nx() * size.x,
                     corner.y + (j + 0.5) / stock->ny() * size.y,
                     stock->height_mm(i, j) - (touched ? 0.0 : 0.01)};
    const Clock::time_point start = Clock::now();
    const auto motion = cuts.last_cut_at(point, 1e-3, track.place_before(track.size()));
    ms.push_back(ms_since(start));
    if (motion) ++found;
  }
  if (!touched && found > 0) fail("a motion is said to have cut what lies below the surface");
  if (touched && found == 0) fail("no motion is said to have cut the surface");
  return ms;
}

int run(const Arguments& arguments) {
  const Source source(arguments);
  const SessionOptions options = source.options();
  const double empty_mb = rss_mb();
  std::unique_ptr<LoadedProgram> loaded = load(options);
  const std::shared_ptr<const CutQuery> cuts = loaded->cuts;
  const ToolSources tools = loaded->player.tools;
  const ProcessPointer process = loaded->player.process;
  const std::vector<TorchMaterial> materials = loaded->player.materials;
  const std::shared_ptr<const ProgramTrack> track = loaded->player.track;
  const double loaded_mb = rss_mb();
  PlayerOptions player_options;
  if (arguments.keyframes_mb > 0) {
    player_options.keyframe_bytes = static_cast<std::size_t>(arguments.keyframes_mb * 1048576.0);
  }
  Player player(std::move(loaded->player), player_options);
  cut_to_the_end(player);
  fmt::print(
      "memory: track {:.1f} MB by itself; process {:.0f} MB before, {:.0f} MB loaded, {:.0f} "
      "MB with keyframes\n",
      static_cast<double>(track->bytes()) / 1e6, empty_mb, loaded_mb, rss_mb());
  if (options.blank) {
    std::mt19937 random(arguments.seed + 1);
    std::set<std::size_t> places{track->size()};
    while (static_cast<int>(places.size()) < kComparedPlaces) {
      places.insert(random() % track->size());
    }
    const std::vector<std::size_t> list(places.begin(), places.end());
    compare(player, list, dry_run(*track, options, tools, *process, materials, list));
  }
  const std::vector<double> seeks = time_seeks(player, arguments);
  print_times("seek to a random line", seeks);
  print_times("again, the same lines", time_seeks(player, arguments));
  print_times("a block forward", time_steps(player, 1));
  print_times("a block back", time_steps(player, -1));
  reached(player, player.seek_end());
  if (cuts && dynamic_cast<const ZMap*>(player.state()->stock.get())) {
    print_times("who cut this point", time_queries(*cuts, player, true));
    print_times("who cut this point (nobody)", time_queries(*cuts, player, false));
  }
  const auto state = player.state();
  fmt::print("afterwards: {} keyframes, {:.0f} MB; process {:.0f} MB, at most {:.0f} MB\n",
             state->keyframes, static_cast<double>(state->keyframe_bytes) / 1e6, rss_mb(),
             peak_rss_mb());
  const double most_ms = source.turns() ? kMostTurned_ms : kMost_ms;
  const bool good = p95(seeks) <= most_ms;
  fmt::print("p95 of seeks {} {:g} ms: {}\n", good ? "<=" : ">", most_ms, good ? "good" : "BAD");
  return good ? 0 : 1;
}

Arguments understand(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 == argc) fail(fmt::format("{} lacks its value", name));
    const char* const value = argv[i + 1];
    if (name == "--program") {
      arguments.program = value;
    } else if (name == "--stock") {
      arguments.stock = value;
    } else if (name == "--tool") {
      arguments.tool = value;
    } else if (name == "--cell") {
      arguments.cell_mm = std::atof(value);
    } else if (name == "--workload") {
      arguments.workload = value;
    } else if (name == "--nest") {
      arguments.nest_moves = std::max(1, std::atoi(value));
    } else if (name == "--keyframes") {
      arguments.keyframes_mb = std::atof(value);
    } else if (name == "--seeks") {
      arguments.seeks = std::max(1, std::atoi(value));
    } else if (name == "--seed") {
      arguments.seed = static_cast<unsigned>(std::atoi(value));
    } else {
      fail(fmt::format("{} is not known", name));
    }
  }
  return arguments;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(kerf::understand(argc, argv)); }
