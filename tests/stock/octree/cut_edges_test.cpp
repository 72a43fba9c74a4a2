// Walls, floors and the edges between them in the mesh of what was really cut, against closed
// forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/stock/octree/dual_contour/mesh_checks.h"
#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

/// Where a feature is cut: its origin, and its axes in the workpiece; z is the spindle.
struct Frame {
  Vec3 origin{0};
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Vec3 out(const Vec3& p) const { return origin + p.x * x + p.y * y + p.z * z; }
  Vec3 in(const Vec3& p) const {
    const Vec3 d = p - origin;
    return {glm::dot(d, x), glm::dot(d, y), glm::dot(d, z)};
  }
};

/// Turned about z, then leaned over about the new x.
Frame frame_of(const Vec3& origin, double turn_rad, double lean_rad) {
  Frame f;
  f.origin = origin;
  f.x = {std::cos(turn_rad), std::sin(turn_rad), 0};
  const Vec3 level{-std::sin(turn_rad), std::cos(turn_rad), 0};
  f.y = std::cos(lean_rad) * level + Vec3(0, 0, std::sin(lean_rad));
  f.z = glm::cross(f.x, f.y);
  return f;
}

/// Moves through corners that are given in a frame.
class Path {
 public:
  Path(const Frame& frame, const Vec3& start) : frame_(frame), at_(start) {}
  void go(const Vec3& to) {
    moves.push_back(line(frame_.out(at_), frame_.out(to), moves.size(), frame_.z));
    at_ = to;
  }
  void circle(const Vec3& to_center) {
    moves.push_back(line(frame_.out(at_), frame_.out(at_), moves.size(), frame_.z));
    moves.back().arc = CutArc{frame_.out(at_ + to_center), frame_.z, 2 * kPi};
  }
  std::vector<CutMove> moves;

 private:
  Frame frame_;
  Vec3 at_;
};

// ---- a trochoidal slot: full circles of radius 3 that advance by 0.5 mm, a cutter of 10 mm

constexpr double kSlotFrom = 10, kSlotTo = 34, kAdvance = 0.5, kCircle = 3, kSlotDepth = 8;
constexpr double kReach = kCircle + 5;  ///< of the cutter from a circle's centre

std::vector<CutMove> slot_moves(const Frame& frame) {
  Path path(frame, {kSlotFrom, 0, 15});
  for (const double z : {-kSlotDepth / 2, -kSlotDepth}) {
    path.go({kSlotFrom, 0, z});
    for (double x = kSlotFrom; x < kSlotTo; x += kAdvance) {
      path.circle({kCircle, 0, 0});
      path.go({x + kAdvance, 0, z});
    }
    path.go({kSlotTo, 0, 15});
    path.go({kSlotFrom, 0, 15});
  }
  return path.moves;
}

/// From the slot's outline, seen along the spindle: discs about the circles' centres, one beside
/// the other. Negative inside.
double outline_mm(double x, double y) {
  const double count = std::round((kSlotTo - kSlotFrom) / kAdvance);
  const double n = std::clamp(std::round((x - kSlotFrom - kCircle) / kAdvance), 0.0, count - 1);
  return std::hypot(x - (kSlotFrom + kCircle + n * kAdvance), y) - kReach;
}

/// From the walls and the floor of the slot.
double slot_mm(const Vec3& p) {
  const double outline = outline_mm(p.x, p.y), above = p.z + kSlotDepth;
  const double floor = std::hypot(above, std::max(0.0, outline));
  const double wall = std::hypot(outline, std::min(0.0, above));
  return std::min(floor, wall);
}

/// Greatest distance from the slot or the blank's faces, of vertices and of points all over
/// triangles.
struct Farthest {
  double vertex_mm = 0, surface_mm = 0;
};

Farthest farthest_from_slot(const TriangleMesh& mesh, const Frame& frame, const Box& blank) {
  const auto distance = [&](const Vec3& p) {
    double least = slot_mm(frame.in(p));
    for (int a = 0; a < 3; ++a)
      least = std::min({least, std::abs(p[a] - blank.min[a]), std::abs(p[a] - blank.max[a])});
    return least;
  };
  Farthest farthest;
  for (const glm::vec3& p : mesh.positions_mm)
    farthest.vertex_mm = std::max(farthest.vertex_mm, distance(Vec3(p)));
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    for (const Vec3& p : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0})
      farthest.surface_mm = std::max(farthest.surface_mm, distance(p));
  }
  return farthest;
}

TEST(CutEdges, TrochoidalSlot) {
  struct Case {
    const char* name;
    Frame frame;
  };
  for (const Case& c : {Case{"along x", frame_of({0, 20, 0}, 0, 0)},
                        Case{"turned by 31 degrees", frame_of({3.03, 7.07, 0.04}, 0.54, 0)},
                        Case{"leaned by 20 degrees", frame_of({0, 20, 0}, 0.1, 0.35)}}) {
    const auto tree = make_octree("box:0,0,-15:48,42,0", 0.25);
    cut(*tree, make_cutter("flat:10"), slot_moves(c.frame));
    const TriangleMesh mesh = tree->mesh(0);
    EXPECT_EQ(manifold_fault(mesh), "");
    const Farthest farthest = farthest_from_slot(mesh, c.frame, tree->bounds_mm());
    fmt::print(
        "slot {}: vertices within {:.4f} mm of walls and floor, all of the surface within "
        "{:.4f} mm\n",
        c.name, farthest.vertex_mm, farthest.surface_mm);
    EXPECT_LT(farthest.vertex_mm, 0.010) << c.name;
    // A bevel of width w is w / 2 away from the edge's faces at best.
    EXPECT_LT(farthest.surface_mm, 0.010) << c.name;
  }
}

// ---- a square pocket

constexpr double kHalf = 9.37, kTool = 3, kPocketDepth = 3.3;

std::vector<CutMove> pocket_moves(const Frame& frame) {
  Path path(frame, {0, 0, 20});
  const double depth = -kPocketDepth;
  path.go({0, 0, depth});
  for (const double side : {2.0, 4.1, kHalf - kTool}) {
    path.go({-side, -side, depth});
    path.go({side, -side, depth});
    path.go({side, side, depth});
    path.go({-side, side, depth});
    path.go({-side, -side, depth});
  }
  return path.moves;
}

struct EdgeCheck {
  double farthest_mm = 0;  ///< of sharp edges' ends from where two faces meet
  double floor_mm = 0;     ///< length of sharp edges at the floor
};

/// Sharp edges of the mesh along the straight parts of the pocket.
EdgeCheck check_edges(const TriangleMesh& mesh, const Frame& frame, double cell) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> normals;  // by directed edge
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    for (std::size_t n = 0; n < 3; ++n)
      normals[{t[n], t[(n + 1) % 3]}] = glm::normalize(glm::cross(b - a, c - a));
  }
  EdgeCheck check;
  for (const auto& [edge, normal] : normals) {
    if (edge.first > edge.second) continue;
    if (glm::dot(normal, normals.at({edge.second, edge.first})) > 0.7) continue;
    const Vec3 ends[2] = {Vec3(mesh.positions_mm[edge.first]),
                          Vec3(mesh.positions_mm[edge.second])};
    const Vec3 middle = frame.in(0.5 * (ends[0] + ends[1]));
    const double straight = kHalf - kTool - 2 * cell;
    const double x = std::abs(middle.x), y = std::abs(middle.y);
    const bool is_pocket = std::max(x, y) < kHalf + 2 * cell && middle.z > -kPocketDepth - 2 * cell;
    if (!is_pocket || std::min(x, y) > straight) continue;
    for (const Vec3& end : ends) {
      const Vec3 p = frame.in(end);
      const double wall =
          std::min(std::abs(std::abs(p.x) - kHalf), std::abs(std::abs(p.y) - kHalf));
      const double level = std::min(std::abs(p.z + kPocketDepth), std::abs(end.z));
      check.farthest_mm = std::max({check.farthest_mm, wall, level});
    }
    if (middle.z < -kPocketDepth + cell) check.floor_mm += glm::length(ends[1] - ends[0]);
  }
  return check;
}

TEST(CutEdges, SquarePocket) {
  for (const double cell : {0.5, 0.31}) {
    for (const double turn : {0.0, 0.3, 0.785}) {
      for (const double lean : {0.0, 0.12}) {
        const auto tree = make_octree("box:-20,-20,-12:20,20,0", cell);
        const Frame frame = frame_of({0.21, -0.13, 0}, turn, lean);
        cut(*tree, make_cutter("flat:6"), pocket_moves(frame));
        const TriangleMesh mesh = tree->mesh(0);
        EXPECT_EQ(manifold_fault(mesh), "");
        const EdgeCheck check = check_edges(mesh, frame, cell);
        fmt::print(
            "pocket, cells of {} mm, turned by {} rad, leaned by {}: edges within {:.5f} "
            "cells\n",
            cell, turn, lean, check.farthest_mm / cell);
        EXPECT_LT(check.farthest_mm, cell / 10);
        const double expected = 8 * (kHalf - kTool - 2 * cell);
        EXPECT_NEAR(check.floor_mm, expected, 8 * cell);
      }
    }
  }
}

}  // namespace
}  // namespace kerf::test
