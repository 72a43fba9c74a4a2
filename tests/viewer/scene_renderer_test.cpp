#include "viewer/window/scene_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/viewer/scene_fixture.h"

namespace kerf {
namespace {

/// Cuts at random places with a local and a full renderer side by side. Both must agree in every
/// pixel of every frame, whatever is transparent and whatever moves besides.
class LocalRedraw : public SceneRendererTest, public testing::WithParamInterface<int> {};

TEST_P(LocalRedraw, GivesThePictureOfAFullRedrawBitForBit) {
  const int variant = GetParam();
  std::mt19937 random(static_cast<unsigned>(variant));
  SCOPED_TRACE("seed " + std::to_string(variant));
  const auto share = [&random] { return std::uniform_real_distribution<double>(0, 1)(random); };
  TestWorkpiece workpiece(200, 170);
  SceneRenderer local = renderer(), full = renderer();
  const SceneUpdate first = first_update(&workpiece);
  local.apply(first);
  full.apply(first);
  DrawOptions options = everything_;
  if (variant % 2 == 1) options.looks[0].opacity = 0.4f;
  if (variant % 3 == 1) options.looks[2].opacity = 0.5f;
  if (variant % 4 == 2) options.upload_bytes_per_frame = 100'000;
  camera_.set_perspective(variant % 3 != 0);
  camera_.look_from(variant % 5 == 4 ? StandardView::kTop : StandardView::kIsometric);
  const Projection projection = view_of(local);
  DrawOptions full_options = options;
  full_options.is_local = false;
  Picture last;
  for (int step = 0; step < 12; ++step) {
    const Vec3 tip(200 * share(), 170 * share(), -1.0 - 3.0 * share());
    for (int dent = 0; dent < step % 4; ++dent) {
      workpiece.dent(tip.x + 5 * dent, tip.y, 4 + 6 * share(), 1 + 4 * share());
    }
    SceneUpdate update = moment_update(tip, static_cast<std::uint64_t>(20 * share()));
    update.patches = workpiece.take_patches();
    local.apply(update);
    full.apply(update);
    draw(&local, projection, options);
    draw(&full, projection, full_options);
    const Picture found = local.read();
    ASSERT_EQ(differing_pixels(found, full.read()), 0) << "step " << step;
    if (step > 0) {
      EXPECT_GT(differing_pixels(found, last), 0) << "step " << step;
    }
    last = found;
  }
  const DrawCounters& counters = local.counters();
  EXPECT_EQ(counters.full.frames, 1u);
  EXPECT_GE(counters.local.frames, 8u);
  EXPECT_LT(counters.local.pixels, counters.local.frames * 400 * 300);
  EXPECT_EQ(full.counters().full.frames, 12u);
}

INSTANTIATE_TEST_SUITE_P(Variants, LocalRedraw, testing::Range(0, 10));

TEST_F(SceneRendererTest, ASmallCutRedrawsASmallRectangle) {
  TestWorkpiece workpiece(200, 170);
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const Picture before = scene.read();
  workpiece.dent(100, 80, 4, 2);
  SceneUpdate update;
  update.patches = workpiece.take_patches();
  scene.apply(update);
  draw(&scene, projection, everything_);
  const Picture after = scene.read();
  EXPECT_GT(differing_pixels(before, after), 10);
  EXPECT_EQ(scene.counters().local.frames, 1u);
  // The dent has a radius below 4 mm; the normals around it reach one cell further.
  EXPECT_LT(scene.counters().local.pixels, 1500u);
  const ScreenRect rect = scene.counters().last_rect;
  for (int y = 0; y < kSize_px.y; ++y) {
    for (int x = 0; x < kSize_px.x; ++x) {
      const int from_below = kSize_px.y - 1 - y;
      if (x >= rect.min.x && x < rect.max.x && from_below >= rect.min.y &&
          from_below < rect.max.y) {
        continue;
      }
      ASSERT_EQ(at(before, {x, y}), at(after, {x, y})) << x << " " << y;
    }
  }
}

TEST_F(SceneRendererTest, NothingNewDrawsNothing) {
  TestWorkpiece workpiece(64, 64);
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  const Projection projection = view_of(scene);
  for (int i = 0; i < 3; ++i) draw(&scene, projection, everything_);
  EXPECT_EQ(scene.counters().full.frames, 1u);
  EXPECT_EQ(scene.counters().still.frames, 2u);
  EXPECT_EQ(scene.counters().still.pixels, 0u);
}

TEST_F(SceneRendererTest, UploadsStayWithinTheBudget) {
  TestWorkpiece workpiece(300, 300);  // 25 tiles of about 116 kB
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  const Projection projection = view_of(scene);
  DrawOptions options;
  options.upload_bytes_per_frame = 300'000;
  std::uint64_t uploaded = 0;
  int frames = 0;
  do {
    draw(&scene, projection, options);
    EXPECT_LE(scene.counters().uploaded_bytes - uploaded, 300'000u);
    uploaded = scene.counters().uploaded_bytes;
    ++frames;
  } while (scene.has_waiting() && frames < 100);
  EXPECT_GE(frames, 8);
  EXPECT_LE(frames, 20);
  EXPECT_EQ(scene.counters().gpu_bytes, uploaded + layers_and_tool_bytes());
  // The end is the same as if all had come at once.
  SceneRenderer at_once = renderer();
  TestWorkpiece same(300, 300);
  at_once.apply(first_update(&same));
  draw(&at_once, projection, everything_);
  EXPECT_EQ(differing_pixels(scene.read(), at_once.read()), 0);
}

TEST_F(SceneRendererTest, OfATileThatChangesWhileItWaitsOnlyTheLastIsUploaded) {
  TestWorkpiece workpiece(64, 64);
  SceneRenderer scene = renderer();
  const SceneUpdate first = first_update(&workpiece);
  scene.apply(first);
  for (int i = 0; i < 5; ++i) {
    workpiece.dent(10 + 10 * i, 30, 5, 3);
    SceneUpdate update;
    update.patches = workpiece.take_patches();
    scene.apply(update);
  }
  draw(&scene, view_of(scene), everything_);
  EXPECT_LT(scene.counters().uploaded_bytes, 150'000u);
}

TEST_F(SceneRendererTest, JumpingBackShowsTheOldPatchAgain) {
  TestWorkpiece workpiece(64, 64);
  SceneRenderer scene = renderer();
  const SceneUpdate first = first_update(&workpiece);
  scene.apply(first);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const Picture before = scene.read();
  workpiece.dent(30, 30, 8, 4);
  SceneUpdate cut, back;
  cut.patches = workpiece.take_patches();
  back.patches = first.patches;  // with a smaller version
  scene.apply(cut);
  draw(&scene, projection, everything_);
  EXPECT_GT(differing_pixels(before, scene.read()), 0);
  scene.apply(back);
  draw(&scene, projection, everything_);
  EXPECT_EQ(differing_pixels(before, scene.read()), 0);
  // Forth and back between two frames: nothing is left to do.
  scene.apply(cut);
  scene.apply(back);
  EXPECT_FALSE(scene.has_waiting());
}

TEST_F(SceneRendererTest, EveryObjectCanBeHidden) {
  TestWorkpiece workpiece(200, 170);
  SceneRenderer scene = renderer();
  SceneUpdate update = first_update(&workpiece);
  update.findings = std::make_shared<const FindingList>(
      FindingList{{{Severity::kError, "", 1, 0.0, Vec3(150, 30, 0), "touches"}}});
  Moment moment;
  moment.tool_pose = ToolPose{Vec3(100, 80, 0)};
  moment.link_poses = {glm::mat4(1.0f)};
  moment.fixture_poses = {glm::mat4(1.0f)};
  update.moment = std::make_shared<const Moment>(moment);
  update.machine = box_machine({{{-40, -40, -60}, {0, 0, 20}}});
  update.fixtures = box_machine({{{160, 140, 0}, {190, 160, 20}}});
  std::vector<PathVertex> path{
      PathVertex{{0, 0, 5}, PathKind::kFeed}, PathVertex{{50, 0, 5}, PathKind::kFeed},
      PathVertex{{50, 50, 5}, PathKind::kTraverse}, PathVertex{{90, 20, 5}, PathKind::kPlanned}};
  update.path = path_chunks(path);
  scene.apply(update);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const Picture all = scene.read();
  DrawOptions none = everything_;
  for (std::size_t object = 0; object < kSceneObjectCount; ++object) {
    DrawOptions options = everything_;
    options.looks[object].is_visible = false;
    none.looks[object].is_visible = false;
    draw(&scene, projection, options);
    EXPECT_GT(differing_pixels(all, scene.read()), 20) << "object " << object;
  }
  draw(&scene, projection, none);
  const Picture empty = scene.read();
  for (int y = 0; y < kSize_px.y; ++y) {
    ASSERT_EQ(at(empty, {0, y}), at(empty, {kSize_px.x / 2, y})) << y;  // background
  }
}

TEST_F(SceneRendererTest, ClearsForgetTheWorkpiece) {
  TestWorkpiece workpiece(64, 64);
  SceneRenderer scene = renderer();
  SceneRenderer empty = renderer();
  const SceneUpdate first = first_update(&workpiece);
  scene.apply(first);
  SceneUpdate only_setup;
  only_setup.setup = first.setup;
  empty.apply(only_setup);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  draw(&empty, projection, everything_);
  EXPECT_GT(differing_pixels(scene.read(), empty.read()), 1000);
  SceneUpdate clears;
  clears.clears = true;
  scene.apply(clears);
  draw(&scene, projection, everything_);
  EXPECT_EQ(differing_pixels(scene.read(), empty.read()), 0);
  EXPECT_EQ(scene.counters().gpu_bytes, layers_and_tool_bytes());
}

TEST_F(SceneRendererTest, PicksAPointOfTheSurface) {
  TestWorkpiece workpiece(200, 170);
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  camera_.look_from(StandardView::kTop);
  camera_.set_perspective(false);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const std::optional<Vec3> found = scene.pick(kSize_px / 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x, 100.0, 1.0);
  EXPECT_NEAR(found->y, 85.0, 1.0);
  EXPECT_NEAR(found->z, 0.0, 0.01);
  EXPECT_FALSE(scene.pick({0, 0}));
  EXPECT_FALSE(scene.pick({-1, 5000}));
}

TEST_F(SceneRendererTest, OnePixelAndTooManyPixels) {
  TestWorkpiece workpiece(64, 64);
  SceneRenderer scene = renderer();
  scene.apply(first_update(&workpiece));
  camera_.fit(scene.fit_box(), {1, 1});
  draw(&scene, camera_.projection(scene.depth_box(), {1, 1}), everything_);
  EXPECT_EQ(scene.read().rgb.size(), 3u);
  const Done done = scene.draw(camera_.projection(scene.depth_box(), {1'000'000, 2}), everything_);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().find("the window has 1000000 x 2"), std::string::npos) << done.error();
}

}  // namespace
}  // namespace kerf
