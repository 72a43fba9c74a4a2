// Contacts of an octree: what cells are too coarse to show, ways of thousands of moves, and the
// bound by which turns are told to miss a brick.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "stock/octree/sweep.h"
#include "stock/octree/sweep_kernel.h"
#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

constexpr double kTolerance_mm = 0.01;

bool touches(const Octree& tree, const char* shape, const CutMove& move) {
  return tree.first_contact(make_cutter(shape), move, kTolerance_mm).has_value();
}

/// Across the top of the blank, `deep_mm` in it, aside of nodes by odd parts of a cell.
CutMove across(double deep_mm, const Vec3& axis = {0, 0, 1}) {
  return line({-3.3, 7.37, -deep_mm}, {33.1, 12.61, -deep_mm}, 0, axis);
}

TEST(OctreeContact, APointInAnUntouchedTopIsToldWhateverTheCells) {
  for (const double cell : {2.0, 1.0, 0.3}) {
    const auto tree = make_octree("box:0,0,-10:30,20,0", cell);
    for (const char* shape : {"vee:6:60", "vee:10:90", "ball:3", "flat:0.2"}) {
      EXPECT_TRUE(touches(*tree, shape, across(0.05))) << shape << ' ' << cell;
      EXPECT_FALSE(touches(*tree, shape, across(0.009))) << shape << ' ' << cell;
      EXPECT_FALSE(touches(*tree, shape, across(0))) << shape << ' ' << cell;
    }
  }
}

TEST(OctreeContact, SoItIsUnderATiltedTool) {
  const auto tree = make_octree("box:0,0,-10:30,20,0", 1);
  for (const double tilt : {0.1, 0.5, 1.0}) {
    const Vec3 axis(std::sin(tilt), 0, std::cos(tilt));
    EXPECT_TRUE(touches(*tree, "vee:6:20", across(0.05, axis))) << tilt;
    EXPECT_FALSE(touches(*tree, "vee:6:20", across(0.005, axis))) << tilt;
    CutMove turning = across(0.05, axis);
    turning.axis_to = glm::normalize(axis + Vec3(0, 0.1, 0));
    EXPECT_TRUE(touches(*tree, "vee:6:20", turning)) << tilt;
    turning.from_mm.z = turning.to_mm.z = -0.005;
    EXPECT_FALSE(touches(*tree, "vee:6:20", turning)) << tilt;
  }
}

TEST(OctreeContact, AWallAndARoundOneAreEnteredByLessThanACell) {
  const auto box = make_octree("box:0,0,-10:30,20,0", 1);
  EXPECT_TRUE(touches(*box, "flat:6", line({-10, -2.97, -5}, {40, -2.97, -5})));
  EXPECT_FALSE(touches(*box, "flat:6", line({-10, -3, -5}, {40, -3, -5})));
  EXPECT_FALSE(touches(*box, "flat:6", line({-10, -2.995, -5}, {40, -2.995, -5})));
  const auto round = make_octree("cylinder:0,0,-20:0:30", 1);
  // 15 mm and 3 mm from middle to middle.
  EXPECT_TRUE(touches(*round, "flat:6", line({-40, 17.97, -5}, {40, 17.97, -5})));
  EXPECT_FALSE(touches(*round, "flat:6", line({-40, 18, -5}, {40, 18, -5})));
}

TEST(OctreeContact, TheWayBackThroughAGrooveThatNoNodeShowsIsSilent) {
  const auto tree = make_octree("box:0,0,-10:30,20,0", 1);
  const CutMove groove = across(0.2);
  cut(*tree, make_cutter("vee:6:30"), {groove});
  CutMove back = groove;
  std::swap(back.from_mm, back.to_mm);
  EXPECT_FALSE(touches(*tree, "vee:6:30", back));
  // Rounded to another last digit, and another point of the same angle.
  back.from_mm.y += 0.008;
  EXPECT_FALSE(touches(*tree, "vee:6:30", back));
  // Far from the groove it is as it was, and so for a picture of it.
  const CutMove beside = line({-3, 17.5, -0.2}, {33, 17.5, -0.2});
  EXPECT_TRUE(touches(*tree, "vee:6:30", beside));
  EXPECT_TRUE(tree->snapshot()->first_contact(make_cutter("vee:6:30"), beside, kTolerance_mm));
}

TEST(OctreeContact, ManyMovesAreOneWay) {
  const auto tree = make_octree("box:0,0,-10:30,20,0", 0.5);
  // Down in steps of 0.02 mm, each deeper than the one before.
  std::vector<CutMove> moves;
  for (int i = 0; i < 400; ++i)
    moves.push_back(line({15, 10, 4 - 0.02 * i}, {15, 10, 4 - 0.02 * (i + 1)}));
  const auto met = first_contact_of(*tree, make_cutter("flat:6"), moves, kTolerance_mm, {});
  ASSERT_TRUE(met);
  EXPECT_EQ(met->move, 200u);
  EXPECT_NEAR(met->contact.depth_mm, 4, 1e-3);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(
      first_contact_of(*tree, make_cutter("flat:6"), moves, kTolerance_mm, {stop.get_token(), {}}));
  // Who watches is told how far it is, again and again.
  std::vector<double> shares;
  first_contact_of(*tree, make_cutter("flat:6"), moves, kTolerance_mm,
                   {{}, [&shares](double share) { shares.push_back(share); }});
  EXPECT_GE(shares.size(), 10u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_LT(shares.front(), 0.1);
  EXPECT_GT(shares.back(), 0.8);
  EXPECT_LE(shares.back(), 1);
  moves.resize(200);
  EXPECT_FALSE(first_contact_of(*tree, make_cutter("flat:6"), moves, kTolerance_mm, {}));
}

TEST(OctreeContact, ATurningPieceStaysByItsWayWithoutTheTurn) {
  using namespace octree;
  const auto bodies = tool_bodies(make_cutter("bull:6:1"));
  ASSERT_TRUE(bodies);
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> place(-25, 25);
  const Box everywhere{Vec3(-60), Vec3(60)};
  const SweepKernel kernel = pick_kernel(KernelChoice::kAuto);
  int pieces = 0, apart = 0;
  for (int round = 0; round < 100; ++round) {
    const Vec3 tip{0.4 * place(engine), 0.4 * place(engine), place(engine) / 5};
    CutMove move = line(tip, tip + Vec3(0.4, 0.01 * place(engine), -0.2), 0, Vec3(0, 0, 1));
    move.axis_to = glm::normalize(Vec3(0.05, 0.001 * place(engine), 1));
    std::vector<Sweep> sweeps;
    append_sweeps(*bodies, move, 0, {everywhere, 0.002, 0}, sweeps);
    for (const Sweep& sweep : sweeps) {
      ASSERT_EQ(sweep.kind, Sweep::Kind::kTurn);
      ++pieces;
      Sweep fixed = sweep;
      fixed.kind = Sweep::Kind::kRamp;
      fixed.w = sweep.mean_w;
      fixed.bend_mm = 0;
      alignas(64) double p[3][8], f[8], bound[8];
      for (auto& row : p)
        for (double& value : row) value = place(engine);
      kernel.distance(sweep, 8, p[0], p[1], p[2], f);
      kernel.distance(fixed, 8, p[0], p[1], p[2], bound);
      for (int n = 0; n < 8; ++n) {
        const double reach = glm::length(Vec3(p[0][n], p[1][n], p[2][n]) - sweep.origin_mm) +
                             glm::length(sweep.step);
        EXPECT_LE(std::abs(bound[n] - f[n]), sweep.off_rad * reach + 1e-6);
        apart += std::abs(bound[n] - f[n]) > 0.1 * sweep.off_rad * reach;
      }
    }
  }
  EXPECT_GT(pieces, 200);
  EXPECT_GT(apart, 200) << "ways that do not turn would pass as well";
}

}  // namespace
}  // namespace kerf::test
