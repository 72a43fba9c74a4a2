// Where tiles of several levels meet: their skirts are drawn there, and nowhere else.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/viewer/scene_fixture.h"

namespace kerf {
namespace {

constexpr std::uint32_t kRow = 4, kTiles = 12;
constexpr float kEdge_mm = 20;

/// Level 0 is at z = 0, others lie deeper; a skirt of two triangles at each side.
std::shared_ptr<const MeshPatch> square(std::uint32_t tile, int level) {
  auto patch = std::make_shared<MeshPatch>();
  patch->tile = tile;
  patch->level = level;
  patch->tiles_in_row = kRow;
  const float x = kEdge_mm * static_cast<float>(tile % kRow);
  const float y = kEdge_mm * static_cast<float>(tile / kRow);
  const float top = -2.0f * static_cast<float>(level);
  const std::array<glm::vec2, 4> corners{glm::vec2(x, y), glm::vec2(x + kEdge_mm, y),
                                         glm::vec2(x + kEdge_mm, y + kEdge_mm),
                                         glm::vec2(x, y + kEdge_mm)};
  for (const float z : {top, -6.0f}) {
    for (const glm::vec2& corner : corners) {
      patch->vertices.push_back({{corner, z}, pack_normal({0, 0, 1})});
    }
  }
  patch->indices = {0, 1, 2, 0, 2, 3};
  patch->skirt_begin = 6;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    for (const std::uint32_t v : {k, k + 4, next + 4, k, next + 4, next}) {
      patch->indices.push_back(v);
    }
  }
  return patch;
}

class SceneSkirtsTest : public SceneRendererTest {
 protected:
  void SetUp() override {
    SceneRendererTest::SetUp();
    for (ObjectLook& look : everything_.looks) look.is_visible = false;
    everything_.looks[static_cast<std::size_t>(SceneObject::kWorkpiece)].is_visible = true;
    whole_ = everything_;
    whole_.is_local = false;
  }
  static SceneUpdate update_of(const std::vector<std::pair<std::uint32_t, int>>& tiles) {
    SceneUpdate update;
    for (const auto& [tile, level] : tiles) update.patches.push_back(square(tile, level));
    return update;
  }
  static SceneUpdate all_of_level_0() {
    SceneUpdate update;
    auto setup = std::make_shared<SceneSetup>();
    setup->bounds_mm = {Vec3(0, 0, -6), Vec3(80, 60, 0)};
    update.setup = std::move(setup);
    for (std::uint32_t tile = 0; tile < kTiles; ++tile) update.patches.push_back(square(tile, 0));
    return update;
  }
  /// Triangles of a redraw of everything.
  std::uint64_t triangles(SceneRenderer* scene, const Projection& projection) {
    const std::uint64_t before = scene->counters().full.triangles;
    draw(scene, projection, whole_);
    return scene->counters().full.triangles - before;
  }
  DrawOptions whole_;
};

TEST_F(SceneSkirtsTest, AreDrawnOfTilesBesideOnesOfAnotherLevel) {
  SceneRenderer scene = renderer();
  scene.apply(all_of_level_0());
  const Projection projection = view_of(scene);
  EXPECT_EQ(triangles(&scene, projection), 2 * kTiles);
  const Picture level = scene.read();
  //  8  9 10 11
  //  4  5  6  7
  //  0  1  2  3
  scene.apply(update_of({{5, 1}}));
  EXPECT_EQ(triangles(&scene, projection), 2 * kTiles + 8 * 5) << "5 and 1, 4, 6, 9";
  EXPECT_GT(differing_pixels(scene.read(), level), 100);
  scene.apply(update_of({{6, 1}}));
  EXPECT_EQ(triangles(&scene, projection), 2 * kTiles + 8 * 8) << "and 2, 7, 10";
  scene.apply(update_of({{5, 0}, {6, 0}}));
  EXPECT_EQ(triangles(&scene, projection), 2 * kTiles);
  EXPECT_EQ(differing_pixels(scene.read(), level), 0);
  // The last of a row and the first of the next are not beside each other.
  scene.apply(update_of({{3, 1}}));
  EXPECT_EQ(triangles(&scene, projection), 2 * kTiles + 8 * 3) << "3 and 2, 7";
}

TEST_F(SceneSkirtsTest, ThatComeAndGoAreInTheRedrawnRectangles) {
  SceneRenderer local = renderer(), full = renderer();
  local.apply(all_of_level_0());
  full.apply(all_of_level_0());
  const Projection projection = view_of(local);
  draw(&local, projection, everything_);
  std::mt19937 random(7);
  for (int step = 0; step < 40; ++step) {
    std::vector<std::pair<std::uint32_t, int>> tiles;
    for (unsigned n = 0; n < 1 + random() % 3; ++n) {
      const auto tile = random() % kTiles;
      tiles.emplace_back(tile, static_cast<int>(random() % 3));
    }
    const SceneUpdate update = update_of(tiles);
    local.apply(update);
    full.apply(update);
    draw(&local, projection, everything_);
    draw(&full, projection, whole_);
    ASSERT_EQ(differing_pixels(local.read(), full.read()), 0) << "step " << step;
  }
  EXPECT_EQ(local.counters().full.frames, 1u);
  EXPECT_GT(local.counters().local.frames, 25u);
}

}  // namespace
}  // namespace kerf
