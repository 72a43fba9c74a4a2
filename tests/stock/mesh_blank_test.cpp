// Blanks from meshes in the models of heights, of columns, and in space.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "mesh/mesh_body.h"
#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

Blank blank_of(const TriangleMesh& mesh) {
  Result<MeshBody> body = mesh_body(mesh, "a.stl");
  EXPECT_TRUE(body) << body.error();
  Blank blank;
  blank.mesh.emplace();
  blank.mesh->body = std::make_shared<const MeshBody>(std::move(body.value()));
  return blank;
}

template <class Model, class Options>
std::unique_ptr<Model> made(const Blank& blank, double cell_mm) {
  Options options;
  options.blank = blank;
  options.cell_mm = cell_mm;
  auto model = Model::create(options);
  EXPECT_TRUE(model) << model.error();
  return std::move(model.value());
}
std::unique_ptr<ZMap> zmap(const Blank& blank, double cell) {
  return made<ZMap, ZMapOptions>(blank, cell);
}
std::unique_ptr<MMap> mmap(const Blank& blank, double cell) {
  return made<MMap, ZMapOptions>(blank, cell);
}
std::unique_ptr<Octree> octree(const Blank& blank, double cell) {
  return made<Octree, OctreeOptions>(blank, cell);
}

const Vec3 kLow{-3, 2, -5}, kHigh{17, 12.5, 3};

TEST(MeshBlank, ABoxIsTheBox) {
  const Blank mesh = blank_of(test::box_of(kLow, kHigh));
  const Blank box = *parse_blank("box:-3,2,-5:17,12.5,3");
  EXPECT_EQ(zmap(mesh, 0.3)->digest(), zmap(box, 0.3)->digest());
  EXPECT_EQ(mmap(mesh, 0.3)->digest(), mmap(box, 0.3)->digest());
  EXPECT_EQ(octree(mesh, 0.3)->digest(), octree(box, 0.3)->digest());
  EXPECT_NEAR(zmap(mesh, 0.3)->blank_mm3(), 20 * 10.5 * 8, 1e-6);
}

/// Also what is told of contacts: the mesh's walls are on the cells' borders.
TEST(MeshBlank, ABoxIsMetLikeTheBox) {
  const auto mesh = zmap(blank_of(test::box_of(kLow, kHigh)), 0.3);
  const auto box = zmap(*parse_blank("box:-3,2,-5:17,12.5,3"), 0.3);
  const Cutter vee = *parse_shape("vee:6:60");
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(-6, 20), y(-1, 15), z(2.5, 3.2);
  int met = 0;
  for (int n = 0; n < 3000; ++n) {
    CutMove move;
    move.from_mm = {x(random), y(random), z(random)};
    move.to_mm = {x(random), y(random), z(random)};
    const auto a = mesh->first_contact(vee, move, 0.01), b = box->first_contact(vee, move, 0.01);
    ASSERT_EQ(a.has_value(), b.has_value()) << n;
    if (!a) continue;
    ++met;
    EXPECT_NEAR(a->depth_mm, b->depth_mm, 1e-6);
  }
  EXPECT_GT(met, 1000);
}

double distance_mm(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_edge = [&](const Vec3& from, const Vec3& to) {
    const Vec3 way = to - from;
    const double t = std::clamp(glm::dot(p - from, way) / glm::dot(way, way), 0.0, 1.0);
    return glm::length(p - from - t * way);
  };
  double least = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  const Vec3 n = glm::normalize(glm::cross(b - a, c - a));
  const Vec3 foot = p - glm::dot(p - a, n) * n;
  const bool is_over = glm::dot(glm::cross(b - a, foot - a), n) >= 0 &&
                       glm::dot(glm::cross(c - b, foot - b), n) >= 0 &&
                       glm::dot(glm::cross(a - c, foot - c), n) >= 0;
  return is_over ? std::min(least, std::abs(glm::dot(p - a, n))) : least;
}

/// What mesh_bricks.h proves, against winding numbers and distances to each triangle.
TEST(MeshBlank, WhatAnOctreeTellsWronglyIsNearerThanACellsDiagonal) {
  std::mt19937 random(21);
  int wrong = 0;
  for (int round = 0; round < 4; ++round) {
    const TriangleMesh mesh = test::random_lumps(random, 2 + round);
    const Blank blank = blank_of(mesh);
    const double cell = 0.9;
    const auto stock = octree(blank, cell);
    const Box box = stock->bounds_mm();
    std::uniform_real_distribution<double> part(-0.02, 1.02);
    for (int n = 0; n < 6000; ++n) {
      Vec3 p;
      for (int a = 0; a < 3; ++a) p[a] = box.min[a] + part(random) * box.size()[a];
      const double winding = test::winding_number(mesh, p);
      if (std::abs(winding - std::round(winding)) > 0.01) continue;
      if (stock->solid_at(p, 0) == (winding > 0.5)) continue;
      ++wrong;
      double nearest = 1e9;
      for (const auto& t : mesh.triangles)
        nearest = std::min(
            nearest, distance_mm(p, Vec3(mesh.positions_mm[t[0]]), Vec3(mesh.positions_mm[t[1]]),
                                 Vec3(mesh.positions_mm[t[2]])));
      EXPECT_LE(nearest, Octree::surface_bound_mm(cell) + 1e-5);
    }
  }
  EXPECT_GT(wrong, 0) << "else this shows nothing";
}

/// Faces that hold nodes, from all sides: lines of the three axes agree on which side they are.
TEST(MeshBlank, FacesThroughNodesKeepTheirEdges) {
  // Nodes are at halves.
  TriangleMesh mesh = test::box_of({0, 0, 0}, {12, 12, 4.5});
  test::add_box(mesh, {2.5, 3.5, 4.5}, {6.5, 8.5, 10});
  test::add_box(mesh, {8, 1, 4}, {10.5, 9.5, 8.5});
  const auto stock = octree(blank_of(mesh), 1);
  EXPECT_NEAR(stock->bounds_mm().max.z, 10, 1e-6);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> x(-0.5, 12.5), z(-0.5, 10.5);
  for (int n = 0; n < 60'000; ++n) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = a == 2 ? z(random) : x(random);
    const auto depth = [&p](const Vec3& low, const Vec3& high) {  // > 0 inside
      double d = 1e9;
      for (int a = 0; a < 3; ++a) d = std::min({d, p[a] - low[a], high[a] - p[a]});
      return d;
    };
    const double d =
        std::max({depth({0, 0, 0}, {12, 12, 4.5}), depth({2.5, 3.5, 4}, {6.5, 8.5, 10}),
                  depth({8, 1, 4}, {10.5, 9.5, 8.5})});
    if (std::abs(d) < 0.01) continue;
    ASSERT_EQ(stock->solid_at(p, 0), d > 0) << p.x << " " << p.y << " " << p.z;
  }
}

/// A pyramid of facets: nothing is told of a vee whose tip stays above them, however they lie
/// between the middles of cells.
TEST(MeshBlank, NothingIsToldOfWhatPassesAboveTheTriangles) {
  TriangleMesh mesh;
  mesh.positions_mm = {{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}, {17.3f, 22.1f, 11.7f}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const auto stock = zmap(blank_of(mesh), 0.7);
  EXPECT_NEAR(stock->blank_mm3(), 40 * 40 * 11.7 / 3, 40 * 40 * 0.05);
  const Vec3 top(17.3, 22.1, 11.7);
  const auto height = [&](const Vec3& p) {
    double least = 1e9;
    const Vec3 around[4] = {{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}};
    for (int k = 0; k < 4; ++k) {
      const Vec3 u = around[(k + 1) % 4] - around[k], v = top - around[k];
      const Vec3 n = glm::cross(u, v);
      least = std::min(least, (n.x * (around[k].x - p.x) + n.y * (around[k].y - p.y)) / n.z);
    }
    return least;
  };
  const Cutter needle = *parse_shape("vee:1:10");
  std::mt19937 random(9);
  std::uniform_real_distribution<double> at(1, 39);
  int far = 0;
  for (int n = 0; n < 4000; ++n) {
    Vec3 p{at(random), at(random), 0};
    const double z = height(p);
    for (const double up : {0.05, -0.8}) {
      CutMove move;
      p.z = z + up;
      if (p.z < 0.2) continue;
      move.from_mm = {p.x, p.y, 20};
      move.to_mm = p;
      const bool met = stock->first_contact(needle, move, 0.01).has_value();
      // The needle is 0.09 mm wide a millimetre up: beside it the flanks rise by no more.
      if (up < 0) far += met ? 1 : 0;
      EXPECT_FALSE(met && up > 0) << p.x << " " << p.y;
    }
  }
  EXPECT_GT(far, 2000) << "what goes in by more than a cell's rise is told";
}

TEST(MeshBlank, ACylinderOfFacetsIsNearlyTheCylinder) {
  TriangleMesh mesh;
  test::add_prism(mesh, test::circle(15, 400), -10, 4);
  const auto facets = zmap(blank_of(mesh), 0.1);
  const auto round = zmap(*parse_blank("cylinder:0,0,-10:4:30"), 0.1);
  // The facets leave out 400 segments: r^2/2 (a - sin a) each.
  const double angle = 2 * kPi / 400, lost = 400 * 15 * 15 / 2.0 * (angle - std::sin(angle)) * 14;
  const double exact = kPi * 225 * 14 - lost;
  EXPECT_NEAR(facets->blank_mm3(), exact, 14 * 0.6) << "0.6 mm2 of cells at the outline";
  EXPECT_NEAR(facets->blank_mm3(), round->blank_mm3(), lost + 14 * 0.6);
  EXPECT_NEAR(octree(blank_of(mesh), 0.25)->blank_mm3(), exact, 1.0);
}

TEST(MeshBlank, ASphere) {
  const TriangleMesh mesh = test::sphere(Vec3(0, 0, 12), 12, 120);
  const double exact = test::volume_mm3(mesh);
  const Blank blank = blank_of(mesh);
  ZMapOptions options;
  options.blank = blank;
  options.cell_mm = 0.2;
  const auto refused = ZMap::create(options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(),
            "a Z-map cannot hold it: the mesh has undercuts; models mmap and octree do");
  const auto columns = mmap(blank, 0.1);
  EXPECT_NEAR(columns->blank_mm3(), exact, 2e-4 * exact);
  EXPECT_TRUE(columns->has_gaps());
  EXPECT_NEAR(octree(blank, 0.3)->blank_mm3(), exact, 2e-4 * exact);
}

/// A slab on a foot, 3 mm thick from Z5.
TEST(MeshBlank, AnUndercutCasting) {
  TriangleMesh mesh = test::box_of({0, 0, 0}, {4, 10, 5.5});
  test::add_box(mesh, {0, 0, 5}, {10, 10, 8});
  const Blank blank = blank_of(mesh);
  const double exact = 4 * 10 * 5 + 10 * 10 * 3;
  const auto columns = mmap(blank, 0.1);
  EXPECT_NEAR(columns->blank_mm3(), exact, 1e-3);
  EXPECT_NEAR(columns->remaining_mm3(), exact, 1e-3);
  const auto in_space = octree(blank, 0.25);
  EXPECT_NEAR(in_space->blank_mm3(), exact, 1e-3);
  // A hole through the slab beside the foot takes no more than the slab.
  CutMove move;
  move.from_mm = {7, 5, 20};
  move.to_mm = {7, 5, -1};
  std::vector<CutReport> reports;
  const Cutter flat = *parse_shape("flat:2");
  columns->cut(flat, std::span(&move, 1), reports);
  columns->finish(reports);
  in_space->cut(flat, std::span(&move, 1), reports);
  EXPECT_NEAR(exact - columns->remaining_mm3(), kPi * 3, 0.15);
  EXPECT_NEAR(exact - in_space->remaining_mm3(), kPi * 3, 0.02);
  // Below the slab, its neck beside it, a T-slot cutter passes through air; higher it meets the
  // slab.
  const Cutter slot = *parse_shape("tslot:3:2:1");
  move.from_mm = {11.2, -5, 2};
  move.to_mm = {11.2, 15, 2};
  EXPECT_FALSE(columns->first_contact(slot, move, 0.01));
  EXPECT_FALSE(in_space->first_contact(slot, move, 0.01));
  move.from_mm.z = move.to_mm.z = 4;
  EXPECT_TRUE(columns->first_contact(slot, move, 0.01));
  EXPECT_TRUE(in_space->first_contact(slot, move, 0.01));
}

/// Against winding numbers.
TEST(MeshBlank, RandomLumps) {
  std::mt19937 random(23);
  for (int round = 0; round < 6; ++round) {
    const TriangleMesh mesh = test::random_lumps(random, 1 + round % 4);
    const Blank blank = blank_of(mesh);
    const Box box = blank.bounds_mm();
    double inside = 0;
    constexpr int kPoints = 20000;
    std::uniform_real_distribution<double> part(0, 1);
    for (int n = 0; n < kPoints; ++n) {
      const Vec3 p = box.min + Vec3{part(random), part(random), part(random)} * box.size();
      inside += test::winding_number(mesh, p) > 0.5 ? 1 : 0;
    }
    const double share = inside / kPoints, volume = share * box.volume_mm3();
    const double sigma = std::sqrt(share * (1 - share) / kPoints) * box.volume_mm3();
    EXPECT_NEAR(mmap(blank, 0.15)->blank_mm3(), volume, 4 * sigma + 0.005 * volume) << round;
    const auto in_space = octree(blank, 0.2);
    EXPECT_NEAR(in_space->blank_mm3(), volume, 4 * sigma + 0.005 * volume) << round;
    int wrong = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = box.min + Vec3{part(random), part(random), part(random)} * box.size();
      const double winding = test::winding_number(mesh, p);
      bool near = false;
      for (int k = 0; k < 6; ++k) {
        Vec3 q = p;
        q[k / 2] += k % 2 == 0 ? 0.35 : -0.35;
        near |= (test::winding_number(mesh, q) > 0.5) != (winding > 0.5);
      }
      if (!near && in_space->solid_at(p, 0) != (winding > 0.5)) ++wrong;
    }
    EXPECT_EQ(wrong, 0) << round;
  }
}

}  // namespace
}  // namespace kerf
