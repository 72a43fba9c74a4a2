#include "twin/page/page_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "stock/blank.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/shape_spec.h"
#include "stock/turning/turning_stock.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

Vec3 place_of(const PageMesh& mesh, std::uint32_t corner) {
  Vec3 place;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = mesh.places[3 * corner + static_cast<std::size_t>(axis)] / 65535.0;
    place[axis] = mesh.box_mm.min[axis] + share * mesh.box_mm.size()[axis];
  }
  return place;
}

/// Of a closed surface.
double volume_mm3(const PageMesh& mesh) {
  double six = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const Vec3 a = place_of(mesh, mesh.triangles[i]), b = place_of(mesh, mesh.triangles[i + 1]);
    six += glm::dot(a, glm::cross(b, place_of(mesh, mesh.triangles[i + 2])));
  }
  return six / 6;
}

/// Each edge is run through once in either direction.
bool is_closed(const PageMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i + k], b = mesh.triangles[i + (k + 1) % 3];
      edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

Vec3 normal_of(const PageMesh& mesh, std::size_t triangle) {
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = place_of(mesh, mesh.triangles[3 * triangle + k]);
  return glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

/// Least cosine between triangles at one edge: -1 where one lies on the other.
double least_cosine(const PageMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> open;
  double least = 1;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(mesh.triangles[i + k], mesh.triangles[i + (k + 1) % 3]);
      const auto [other, is_first] = open.try_emplace(edge, i / 3);
      if (!is_first)
        least = std::min(least, glm::dot(normal_of(mesh, i / 3), normal_of(mesh, other->second)));
    }
  }
  return least;
}

std::unique_ptr<ZMap> blank(const char* spec, double cell_mm) {
  ZMapOptions options;
  options.blank = *parse_blank(spec);
  options.cell_mm = cell_mm;
  auto stock = ZMap::create(options);
  EXPECT_TRUE(stock) << stock.error();
  return std::move(*stock);
}

void cut(ZMap& stock, const char* tool, const Vec3& from, const Vec3& to, std::uint64_t id) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  move.id = id;
  std::vector<CutReport> reports;
  stock.cut(*parse_shape(tool), std::array{move}, reports);
  stock.finish(reports);
}

/// 40 x 30 x 10 mm with a groove of a ball of 8 mm, 3 mm deep, along its middle, and a flat pocket.
std::unique_ptr<ZMap> grooved(double cell_mm) {
  auto stock = blank("box:0,0,-10:40,30,0", cell_mm);
  stock->keep_cut_ids(true);
  cut(*stock, "ball:8", {-10, 15, -3}, {50, 15, -3}, 0);
  cut(*stock, "flat:6", {10, 5, -2}, {30, 5, -2}, 1);
  return stock;
}

TEST(PageMesh, IsTheSurfaceWithinWhatItSays) {
  const std::unique_ptr<ZMap> stock = grooved(0.1);
  const PageMesh mesh = page_mesh(*stock);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_LT(mesh.triangles.size(), mesh.full_triangles);  // of 240 000 cells
  EXPECT_GT(least_cosine(mesh), -0.7);  // nothing is sharper than where the groove leaves the top
  EXPECT_LE(mesh.deviation_mm, 0.003);  // 0.002, and what 16 bits are off
  EXPECT_GT(mesh.measured, 1000u);
  // 12000 mm3 less the groove, 40 mm of a segment of a circle of 4 mm, 3 mm high, and the pocket.
  const double segment = 16 * std::acos(0.25) - std::sqrt(16.0 - 1.0);
  const double pocket = 2 * (20 * 6 + kPi * 9);
  EXPECT_NEAR(volume_mm3(mesh), 12000 - 40 * segment - pocket, 12);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mesh.box_mm.min[axis], stock->bounds_mm().min[axis], 1e-5);
    EXPECT_NEAR(mesh.box_mm.max[axis], stock->bounds_mm().max[axis], 1e-5);
  }
}

TEST(PageMesh, KeepsToItsBudget) {
  PageMeshOptions options;
  options.most_triangles = 1500;
  const PageMesh mesh = page_mesh(*grooved(0.1), options);
  EXPECT_LE(mesh.triangles.size() / 3, 1500u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_GT(least_cosine(mesh), -0.9);
  EXPECT_GT(mesh.deviation_mm, 0);
  EXPECT_LT(mesh.deviation_mm, 1);
}

TEST(PageMesh, SaysWhoCut) {
  PageMeshOptions options;
  options.group_of = [](std::uint32_t move) { return static_cast<std::uint8_t>(move); };
  const PageMesh mesh = page_mesh(*grooved(0.2), options);
  ASSERT_EQ(mesh.groups.size(), mesh.triangles.size() / 3);
  std::map<int, double> area;  // by group, of the middle of the triangle where it is
  for (std::size_t t = 0; t < mesh.groups.size(); ++t) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = place_of(mesh, mesh.triangles[3 * t + k]);
    area[mesh.groups[t]] +=
        glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
  }
  // The groove: 40 mm of an arc of 2 acos(1/4) x 4 mm; the pocket's floor and its wall.
  EXPECT_NEAR(area[0], 40 * 8 * std::acos(0.25), 60);
  EXPECT_NEAR(area[1], 20 * 6 + kPi * 9 + 2 * (40 + kPi * 6), 60);
  // The rest of the top, the sides and the underside are the blank's own.
  EXPECT_GT(area[kNoGroup], 2400);
}

/// The sections of a thread are worked out when the first patch asks for them: in no two threads of
/// one model.
TEST(PageMesh, AThreadOnABarIsTheSameEachTime) {
  PageMesh first;
  for (int round = 0; round < 12; ++round) {
    TurningStock bar(*TurnedPart::create(bar_profile(-64, 0, 40)));
    const Cutter tool = Cutter::from_insert("thread:60", *thread_insert({kPi / 3, 0.2, 3, 6}));
    CutMove move;
    move.from_mm = {18.8, 0, 5};
    move.to_mm = {18.8, 0, -60};
    move.lead_mm = 2.5;
    std::vector<CutReport> reports;
    bar.cut(tool, std::array{move}, reports);
    const PageMesh mesh = page_mesh(bar);
    ASSERT_GT(mesh.triangles.size(), 3000u);
    if (round == 0) first = mesh;
    ASSERT_EQ(mesh.triangles, first.triangles) << round;
    ASSERT_EQ(mesh.places, first.places) << round;
  }
}

TEST(PageMesh, HasNothingOfWhatIsGone) {
  const auto stock = blank("box:0,0,-1:2,2,0", 0.1);
  cut(*stock, "flat:20", {-20, 1, -2}, {22, 1, -2}, 0);
  const PageMesh mesh = page_mesh(*stock);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_EQ(mesh.deviation_mm, 0);
}

}  // namespace
}  // namespace kerf
