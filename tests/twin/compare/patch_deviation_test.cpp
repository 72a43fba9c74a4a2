#include "twin/compare/patch_deviation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "tests/twin/compare/meshes.h"
#include "tests/twin/playback/tracks.h"
#include "twin/scene/patch_feeder.h"
#include "twin/scene/player_scene.h"

namespace kerf {
namespace {

using test::box_mesh;
constexpr double kTolerance_mm = 0.05;

void cut(StockModel& stock, const char* tool, const std::vector<Vec3>& path) {
  const ToolShapeArgument shape = parse_tool_argument(tool).value();
  std::vector<CutReport> reports;
  for (std::size_t n = 0; n + 1 < path.size(); ++n) {
    CutMove move;
    move.from_mm = path[n];
    move.to_mm = path[n + 1];
    stock.cut(shape.cutter, std::span(&move, 1), reports);
  }
  stock.finish(reports);
}

std::shared_ptr<const DesignPart> part_of(const TriangleMesh& mesh) {
  Diagnostics diagnostics;
  auto part = std::make_shared<const DesignPart>(mesh, "part.stl", diagnostics);
  EXPECT_FALSE(has_error(diagnostics));
  return part;
}

std::vector<std::shared_ptr<const MeshPatch>> patches_of(const StockModel& stock,
                                                         std::shared_ptr<const DesignPart> part) {
  PatchFeeder feeder;
  feeder.compare_with(std::move(part), kTolerance_mm);
  feeder.follow(stock.snapshot());
  return feeder.make_until(PatchFeeder::Clock::time_point::max());
}

struct Extremes {
  float least = 1e9f, most = -1e9f;
  glm::vec3 least_at{0}, most_at{0};
};

/// Of vertices that triangles of the surface have.
Extremes extremes_of(const std::vector<std::shared_ptr<const MeshPatch>>& patches) {
  Extremes found;
  for (const auto& patch : patches) {
    EXPECT_EQ(patch->deviation_mm.size(), patch->vertices.size());
    for (const std::uint32_t v : patch->surface_indices()) {
      const float d = patch->deviation_mm.at(v);
      const glm::vec3& at = patch->vertices[v].position_mm;
      if (d < found.least) std::tie(found.least, found.least_at) = std::tie(d, at);
      if (d > found.most) std::tie(found.most, found.most_at) = std::tie(d, at);
    }
  }
  return found;
}

TEST(PatchDeviation, CutExactlyItIsWithinACell) {
  const auto stock = test::block_40();
  cut(*stock, "1=flat:6", {{10, 10, -4}, {30, 10, -4}, {30, 30, -4}});
  cut(*stock, "1=ball:6", {{8, 22, -2}, {20, 32, -3}});
  const Extremes found = extremes_of(patches_of(*stock, part_of(stock->mesh(0.001))));
  EXPECT_LT(found.most, 0.1f);
  EXPECT_GT(found.least, -0.1f);
}

TEST(PatchDeviation, GougeAndExcessWhereTheyAreAndAsLarge) {
  const auto design = test::block_40();
  cut(*design, "1=flat:6", {{8, 10, -4}, {32, 10, -4}});
  cut(*design, "1=flat:6", {{8, 30, -4}, {32, 30, -4}});
  const auto stock = test::block_40();
  cut(*stock, "1=flat:6", {{8, 10, -4}, {20, 10, -4}, {20, 10, -4.7}, {20, 10, -4}, {32, 10, -4}});
  cut(*stock, "1=flat:6", {{8, 30, -3.5}, {32, 30, -3.5}});
  const Extremes found = extremes_of(patches_of(*stock, part_of(design->mesh(0.001))));
  EXPECT_NEAR(found.least, -0.7f, 0.01f);
  EXPECT_LT(glm::distance(found.least_at, glm::vec3(20, 10, -4.7)), 3.2f);
  EXPECT_NEAR(found.most, 0.5f, 0.01f);
  EXPECT_NEAR(found.most_at.y, 30, 3.2);
  EXPECT_NEAR(found.most_at.z, -3.5, 0.01);
}

/// What is seen between vertices is what a triangle's corners say: it must be right there as well.
TEST(PatchDeviation, LevelGroundAndWallsShowWhatTheyCover) {
  const auto stock = test::block_40();
  // A blank that nothing was cut from, and a design with a step of 1 mm, then a narrow slot.
  TriangleMesh mesh = box_mesh({0, 0, -10}, {19.37, 40, -1});
  const auto add = [&](const TriangleMesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.insert(mesh.positions_mm.end(), more.positions_mm.begin(),
                             more.positions_mm.end());
    for (const auto& t : more.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  };
  add(box_mesh({20.8, 0, -10}, {40, 40, 0}));
  const auto part = part_of(mesh);
  double worst = 0;
  std::size_t looked_at = 0;
  for (const auto& patch : patches_of(*stock, part)) {
    const auto indices = patch->surface_indices();
    for (std::size_t n = 0; n + 2 < indices.size(); n += 3) {
      Vec3 middle(0);
      double shown = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        middle += Vec3(patch->vertices[indices[n + k]].position_mm) / 3.0;
        shown += static_cast<double>(patch->deviation_mm[indices[n + k]]) / 3;
      }
      const double is = part->distance_mm(middle);
      // Farther off both are beyond all colours.
      if (is > 1.0 && shown > 1.0) continue;
      ++looked_at;
      worst = std::max(worst, std::abs(is - shown));
    }
  }
  EXPECT_GT(looked_at, 1000u);
  EXPECT_LT(worst, 0.15) << "the step's edge lies within a cell and a half of 0.1 mm";
}

TEST(PatchDeviation, DividedSurfaceIsAsClosedAsBefore) {
  const auto stock = test::block_40();
  cut(*stock, "1=flat:6", {{10, 10, -4}, {30, 25, -4}});
  const auto part = part_of(test::sphere_mesh(12, 40));
  std::map<std::array<float, 6>, int> edges;
  double volume = 0;
  for (const auto& patch : patches_of(*stock, part)) {
    const auto indices = patch->surface_indices();
    ASSERT_EQ(indices.size() % 3, 0u);
    for (std::size_t n = 0; n < indices.size(); n += 3) {
      std::array<glm::vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = patch->vertices[indices[n + k]].position_mm;
      volume += glm::dot(Vec3(p[0]), glm::cross(Vec3(p[1]), Vec3(p[2]))) / 6;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 a = p[k], b = p[(k + 1) % 3];
        ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
        --edges[{b.x, b.y, b.z, a.x, a.y, a.z}];
      }
    }
  }
  EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; }));
  EXPECT_NEAR(volume, stock->remaining_mm3(), 1e-3 * stock->remaining_mm3());
}

TEST(PatchDeviation, KeepsOneOfEachAVertex) {
  const auto stock = test::block_40();
  stock->keep_cut_ids(true);
  cut(*stock, "1=flat:6", {{10, 10, -4}, {30, 25, -4}});
  for (const auto& patch : patches_of(*stock, part_of(test::sphere_mesh(12, 40)))) {
    EXPECT_EQ(patch->cut_by.size(), patch->vertices.size());
    EXPECT_EQ(patch->deviation_mm.size(), patch->vertices.size());
    EXPECT_EQ(patch->level, 0);
  }
}

TEST(PatchDeviation, TrianglesWithoutAreaComeToAnEnd) {
  MeshPatch patch;
  const std::uint32_t up = pack_normal({0, 0, 1});
  for (const float x : {0.0f, 3.0f, 1.3f, 3.0f}) patch.vertices.push_back({{x, 0, 0.1f}, up});
  patch.indices = {0, 1, 2, 1, 3, 0, 0, 0, 1};
  patch.skirt_begin = 9;
  add_deviation(*part_of(test::sphere_mesh(1.5, 30)), {0.1, kTolerance_mm}, &patch);
  EXPECT_EQ(patch.indices.size() % 3, 0u);
  EXPECT_LT(patch.vertices.size(), 300u);
}

TEST(PatchDeviation, PickedPointsAndSetupHaveIt) {
  MotionList program;
  program.at({0, 0, 5}).tool(1).spindle(true);
  const auto track = test::track_of(program.list());
  ViewedProgram shown;
  shown.design = part_of(box_mesh({0, 0, -10}, {40, 40, -0.25}));
  shown.tolerance_mm = 0.02;
  PlayerScene scene(track, shown);
  PlayerState state;
  state.stock = test::block_40()->snapshot();
  EXPECT_EQ(scene.start(state).setup->tolerance_mm, 0.02);
  scene.pick({20, 20, 0}, state);
  const SceneUpdate update =
      scene.update(std::make_shared<const PlayerState>(state), PlayerScene::Clock::now());
  ASSERT_TRUE(update.picked && update.picked->deviation_mm);
  EXPECT_NEAR(*update.picked->deviation_mm, 0.25, 1e-6);
}

}  // namespace
}  // namespace kerf
