// Random cutters and moves against points tested one by one at many moments of each move.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

struct Pose {
  Vec3 tip, axis;
};

Pose pose_at(const CutMove& m, double s) {
  Pose pose{m.from_mm + s * (m.to_mm - m.from_mm), m.axis_from};
  if (m.arc) {
    const Vec3 axis = m.arc->axis, out = m.from_mm - m.arc->center_mm;
    const double rise0 = glm::dot(out, axis), rise1 = glm::dot(m.to_mm - m.arc->center_mm, axis);
    const Vec3 u = out - rise0 * axis;
    const double r0 = glm::length(u), r1 = glm::length(m.to_mm - m.arc->center_mm - rise1 * axis);
    const double a = s * m.arc->sweep_rad;
    pose.tip = m.arc->center_mm + (rise0 + s * (rise1 - rise0)) * axis +
               (r0 + s * (r1 - r0)) / r0 * (std::cos(a) * u + std::sin(a) * glm::cross(axis, u));
  }
  const double angle = std::acos(std::min(1.0, glm::dot(m.axis_from, m.axis_to)));
  if (angle > 1e-6)
    pose.axis = (std::sin((1 - s) * angle) * m.axis_from + std::sin(s * angle) * m.axis_to) /
                std::sin(angle);
  return pose;
}

bool in_sweep(const Cutter& cutter, const CutMove& move, const Vec3& p, double slack) {
  constexpr int kSamples = 500;
  for (int i = 0; i <= kSamples; ++i) {
    const Pose pose = pose_at(move, static_cast<double>(i) / kSamples);
    const double z = glm::dot(p - pose.tip, pose.axis);
    const double r = glm::length(p - pose.tip - z * pose.axis);
    if (in_cutter(cutter, r, z, slack)) return true;
  }
  return false;
}

struct Random {
  std::mt19937 engine;
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  Vec3 point() { return {(*this)(-2, 14), (*this)(-2, 14), (*this)(-7, 2)}; }
  Vec3 axis(double tilt) {
    const double a = (*this)(0, 2 * kPi), t = (*this)(0, tilt);
    return {std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)};
  }
};

enum class Motion { kUpright, kTilted, kTurning, kArc };

CutMove random_move(Random& random, Motion motion) {
  CutMove move = line(random.point(), random.point());
  const double which = random(0, 1);
  if (which < 0.2) move.to_mm.z = move.from_mm.z;
  if (which > 0.9) move.to_mm = move.from_mm - Vec3(0, 0, 2);
  if (motion == Motion::kTilted) move.axis_from = move.axis_to = random.axis(1.8);
  if (motion == Motion::kTurning) {
    move.axis_from = random.axis(0.8);
    move.axis_to = glm::normalize(move.axis_from + 0.3 * random.axis(3));
  }
  if (motion == Motion::kArc) {
    move.to_mm = move.from_mm;
    const double r = random(1, 5), a = random(0, 6.2);
    Vec3 axis{0, 0, 1};
    const double plane = random(0, 1);
    if (plane > 0.7) axis = Vec3(0, 1, 0);
    const Vec3 u =
        axis.z > 0 ? Vec3(std::cos(a), std::sin(a), 0) : Vec3(std::cos(a), 0, std::sin(a));
    const double sweep = random(-6.2, 6.2), rise = plane < 0.3 ? random(-2, 2) : 0;
    const Vec3 center = move.from_mm - r * u;
    move.to_mm =
        center + r * (std::cos(sweep) * u + std::sin(sweep) * glm::cross(axis, u)) + rise * axis;
    move.arc = CutArc{center, axis, sweep};
  }
  return move;
}

void compare(Motion motion, const std::vector<const char*>& shapes, unsigned seed) {
  Random random{std::mt19937(seed)};
  for (const char* shape : shapes) {
    SCOPED_TRACE(shape);
    const Cutter cutter = make_cutter(shape);
    const auto tree = make_octree("box:0,0,-8:12,12,0", 0.4);
    std::vector<CutMove> moves;
    for (int i = 0; i < 5; ++i) moves.push_back(random_move(random, motion));
    cut(*tree, cutter, moves);
    const HermiteGrid grid = whole(*tree);
    expect_sound(grid);
    int tested = 0, wrong = 0;
    // What the samples may miss: half a step of the fastest point.
    constexpr double kSlack = 0.04;
    for (int n = 0; n < 300; ++n) {
      const int i = 1 + static_cast<int>(random(0, 30)), j = 1 + static_cast<int>(random(0, 30)),
                k = 1 + static_cast<int>(random(0, 20));
      const Vec3 p = grid.origin_mm + Vec3(i, j, k) * grid.cell_mm;
      const bool solid =
          grid.solid[static_cast<std::size_t>((k * grid.nodes[1] + j) * grid.nodes[0] + i)] != 0;
      bool within = false, near = false;
      for (const CutMove& move : moves) {
        within |= in_sweep(cutter, move, p, 1e-6);
        if (within) break;
        near |= in_sweep(cutter, move, p, -kSlack);
      }
      if (!within && near) continue;
      ++tested;
      wrong += solid == within;
    }
    EXPECT_EQ(wrong, 0) << "of " << tested;
    EXPECT_GT(tested, 220);
    // Crossings lie on the surface: a little to one side is material, to the other it is not.
    const std::vector<SurfacePoint> points = surface_points(grid);
    int off = 0, checked = 0;
    // A place is good to 1 / 65536 of a cell; arcs and turning moves to what is promised of them.
    const bool is_straight = motion == Motion::kUpright || motion == Motion::kTilted;
    const double deviation = is_straight ? 2e-5 : 0.002;
    for (int n = 0; n < 120; ++n) {
      const SurfacePoint& p = points[random.engine() % points.size()];
      const Box box = tree->bounds_mm();
      double to_face = 1e9;
      for (int a = 0; a < 3; ++a)
        to_face =
            std::min({to_face, std::abs(p.at[a] - box.min[a]), std::abs(p.at[a] - box.max[a])});
      if (to_face < 0.05) continue;
      ++checked;
      bool deep = false, touched = false;
      for (const CutMove& move : moves) {
        deep |= in_sweep(cutter, move, p.at, deviation);
        touched |= in_sweep(cutter, move, p.at, -kSlack);
      }
      off += deep || !touched;
    }
    EXPECT_EQ(off, 0) << "of " << checked;
  }
}

const std::vector<const char*> kShapes{"flat:4",      "ball:5",         "bull:6:1.5",
                                       "vee:6:60:1",  "taper:2:10:0.6", "drill:5:118",
                                       "tslot:7:2:3", "lollipop:5:2",   "dovetail:7:50:3"};

TEST(OctreeOracle, UprightMoves) { compare(Motion::kUpright, kShapes, 1); }
TEST(OctreeOracle, TiltedMoves) { compare(Motion::kTilted, kShapes, 2); }
TEST(OctreeOracle, TurningMoves) {
  compare(
      Motion::kTurning,
      {"flat:4", "ball:5", "ball:3", "bull:6:1.5", "vee:6:60:1", "lollipop:5:2", "dovetail:7:50:3"},
      3);
}
TEST(OctreeOracle, Arcs) { compare(Motion::kArc, kShapes, 4); }

}  // namespace
}  // namespace kerf::test
