// After every hundredth of a program the mesh is a closed 2-manifold as large as the model says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "stock/zmap/mmap/mmap.h"
#include "tests/interp_bridge/program_test_support.h"
#include "tests/stock/octree/dual_contour/mesh_checks.h"
#include "tests/stock/octree/octree_samples.h"
#include "twin/machine/kinematics/tool_path.h"
#include "twin/motion/motion_geometry.h"

namespace kerf::test {
namespace {

constexpr int kParts = 100;

std::unique_ptr<MMap> make_mmap(const std::string& blank, double cell) {
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell;
  auto map = MMap::create(options);
  EXPECT_TRUE(map) << map.error();
  return std::move(*map);
}

/// Moves of one tool.
struct Job {
  Cutter cutter;
  std::vector<CutMove> moves;
};

/// How far volumes may differ, as a share of the mesh's area times the cell: the surface is off by
/// no more than that part of a cell, on the whole.
constexpr double kVolumeShare = 0.01;

struct Worst {
  double off_mm3 = 0;
  double share = 0;  ///< of area times cell
  std::size_t triangles = 0;
};

void expect_sound_mesh(const StockModel& model, int part, Worst& worst) {
  const TriangleMesh mesh = model.mesh(0);
  const std::string fault = manifold_fault(mesh);
  EXPECT_EQ(fault, "") << model.name() << " after " << part << " %";
  const double volume = mesh_volume(mesh), left = model.remaining_mm3();
  EXPECT_GT(volume, 0);
  const double off = std::abs(volume - left);
  const double share = off / (mesh_area(mesh) * model.cell_mm());
  EXPECT_LT(share, kVolumeShare) << model.name() << " after " << part << " %: " << volume
                                 << " mm3 in the mesh, " << left << " in the model";
  // As files of meshes have it, with fewer triangles.
  if (part % 20 == 0) {
    EXPECT_EQ(manifold_fault(model.mesh(0.05)), "") << model.name() << " after " << part << " %";
  }
  if (share > worst.share) worst = {off, share, mesh.triangles.size()};
}

/// All jobs, a hundredth of their moves at a time.
void check_while_cutting(StockModel& model, const std::vector<Job>& jobs) {
  std::size_t total = 0, done = 0;
  for (const Job& job : jobs) total += job.moves.size();
  ASSERT_GE(total, static_cast<std::size_t>(kParts));
  Worst worst;
  std::vector<CutReport> reports;
  int part = 0;
  for (const Job& job : jobs) {
    for (std::size_t first = 0; first < job.moves.size();) {
      const std::size_t stop = total * static_cast<std::size_t>(part + 1) / kParts;
      const std::size_t last = std::min(job.moves.size(), first + (stop - done));
      model.cut(job.cutter, std::span(job.moves).subspan(first, last - first), reports);
      done += last - first;
      first = last;
      if (done < stop) continue;
      model.finish(reports);
      expect_sound_mesh(model, ++part, worst);
    }
  }
  model.finish(reports);
  EXPECT_EQ(part, kParts);
  fmt::print(
      "{}, cells of {:.2f} mm, {} moves, {:.0f} of {:.0f} mm3 left: volumes differ by at "
      "most {:.2f} mm3, {:.4f} of area times cell, where the mesh has {} triangles\n",
      model.name(), model.cell_mm(), total, model.remaining_mm3(), model.blank_mm3(), worst.off_mm3,
      worst.share, worst.triangles);
}

std::vector<CutMove> upright_moves(const std::vector<Motion>& motions) {
  std::vector<CutMove> moves;
  for (const Motion& m : motions)
    if (m.start_known && (is_feed(m) || m.kind == MotionKind::kTraverse))
      moves.push_back(cut_move_from(m, moves.size()));
  return moves;
}

/// LinuxCNC's own program, where it is installed.
std::vector<CutMove> chips() {
  const std::string path = "/usr/share/linuxcnc/ncfiles/3D_Chips.ngc";
  if (!std::filesystem::exists(path)) return {};
  return upright_moves(run_program(path).motions);
}

TEST(MeshWhileCutting, FaultsAreSeen) {
  const TriangleMesh sound = make_octree("box:0,0,0:3,3,3", 1)->mesh(0);
  EXPECT_EQ(manifold_fault(sound), "");
  TriangleMesh open = sound;
  open.triangles.pop_back();
  EXPECT_EQ(manifold_fault(open), "boundary edge");
  TriangleMesh twice = sound;
  twice.triangles.push_back(twice.triangles.front());
  EXPECT_EQ(manifold_fault(twice), "edge twice in one direction");
  // Two boxes that share one corner.
  TriangleMesh touching = sound;
  const std::uint32_t count = static_cast<std::uint32_t>(sound.positions_mm.size());
  touching.positions_mm.insert(touching.positions_mm.end(), sound.positions_mm.begin() + 1,
                               sound.positions_mm.end());
  for (const auto& t : sound.triangles) {
    std::array<std::uint32_t, 3> other{};
    for (std::size_t n = 0; n < 3; ++n) other[n] = t[n] == 0 ? 0 : t[n] + count - 1;
    touching.triangles.push_back(other);
  }
  EXPECT_EQ(manifold_fault(touching), "two rings at a vertex");
}

TEST(MeshWhileCutting, Chips) {
  const std::vector<CutMove> moves = chips();
  if (moves.empty()) GTEST_SKIP() << "3D_Chips.ngc of LinuxCNC is not installed";
  const std::vector<Job> jobs{{make_cutter("ball:10"), moves}};
  const std::string blank = "box:-50,-50,-50:50,50,0";
  const auto tree = make_octree(blank, 2);
  check_while_cutting(*tree, jobs);
  const auto map = make_mmap(blank, 2);
  check_while_cutting(*map, jobs);
}

/// Slots under slots, cut to and fro by every kind of head, and a mill that opens some of them.
std::vector<Job> undercut_jobs() {
  std::mt19937 engine(31);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  std::vector<Job> jobs;
  for (const char* shape :
       {"flat:5", "tslot:9:2:4", "dovetail:8:55:3", "lollipop:6:2.5", "tslot:12:1.5:5", "ball:4"}) {
    Job job{make_cutter(shape), {}};
    Vec3 at{-10, random(2, 28), random(-9, -3)};
    for (int n = 0; n < 40; ++n) {
      Vec3 to{random(-4, 44), random(-4, 34), n % 3 == 0 ? random(-11, -2) : at.z};
      if (n % 8 == 7) {
        CutMove arc = line(at, at + Vec3(4, 4, 0));
        arc.arc = CutArc{at + Vec3(4, 0, 0), {0, 0, 1}, 1.5 * kPi};
        job.moves.push_back(arc);
        at = arc.to_mm;
        continue;
      }
      job.moves.push_back(line(at, to, static_cast<std::uint64_t>(n)));
      at = to;
    }
    jobs.push_back(std::move(job));
  }
  return jobs;
}

TEST(MeshWhileCutting, Undercuts) {
  const std::string blank = "box:0,0,-14:40,30,0";
  const auto tree = make_octree(blank, 0.7);
  check_while_cutting(*tree, undercut_jobs());
  const auto map = make_mmap(blank, 0.7);
  check_while_cutting(*map, undercut_jobs());
}

/// Blades in a block on a tilting rotary table: the tip follows spirals about Z while the tool
/// leans outward and the table turns.
std::vector<Motion> blade_motions() {
  std::vector<Motion> motions;
  Motion m;
  m.kind = MotionKind::kFeed;
  m.torch.analog[3] = 1;
  const auto go = [&](double radius, double angle, double z, double a, double c) {
    m.from_mm = m.to_mm;
    m.from_abc_deg = m.to_abc_deg;
    m.to_mm = {radius * std::cos(angle), radius * std::sin(angle), z};
    m.to_abc_deg = {a, 0, c};
    motions.push_back(m);
  };
  go(30, 0, 20, 0, 0);
  for (int blade = 0; blade < 5; ++blade) {
    const double begin = 2 * kPi * blade / 5;
    for (int level = 0; level < 3; ++level) {
      go(28, begin, 14 - 4.0 * level, -20, 72.0 * blade);
      for (int step = 0; step <= 10; ++step) {
        const double s = step / 10.0;
        go(26 - 20 * s, begin + 1.2 * s, 10 - 4.0 * level + 8 * s * s, -20 - 40 * s,
           72.0 * blade + 50 * s);
      }
      go(6, begin + 1.2, 30, -60, 72.0 * blade + 50);
    }
  }
  return motions;
}

std::vector<CutMove> on_tilting_table(const std::vector<Motion>& motions, double cell_mm) {
  const auto machine = known_machine("xyzac-trt-kins", "", {}, {});
  EXPECT_TRUE(machine);
  const auto path = ToolPath::create(*machine, {}, ToolPathTolerance::of_cell(cell_mm));
  EXPECT_TRUE(path);
  std::vector<CutMove> moves;
  for (const Motion& m : motions) path->moves_of(m, 40, moves.size(), moves);
  return moves;
}

TEST(MeshWhileCutting, TurningTable) {
  const std::vector<CutMove> moves = on_tilting_table(blade_motions(), 1.3);
  for (const char* shape : {"flat:4", "taper:2:8:1"}) {
    const auto tree = make_octree("cylinder:0,0,-10:20:56", 1.3);
    check_while_cutting(*tree, {{make_cutter(shape), moves}});
  }
}

}  // namespace
}  // namespace kerf::test
