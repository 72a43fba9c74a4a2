// The machine in the picture, and what is asked of OpenGL itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "tests/viewer/scene_fixture.h"
#include "viewer/window/gl_failure.h"
#include "viewer/window/patch_change.h"

namespace kerf {
namespace {

SceneUpdate poses(const std::vector<glm::vec3>& offsets_mm) {
  Moment moment;
  for (const glm::vec3& offset : offsets_mm) {
    moment.link_poses.push_back(glm::translate(glm::mat4(1.0f), offset));
  }
  SceneUpdate update;
  update.moment = std::make_shared<const Moment>(std::move(moment));
  return update;
}

class MachineTest : public SceneRendererTest {
 protected:
  /// A workpiece of 64 mm and two cubes of 20 mm.
  SceneRenderer scene_with_cubes() {
    SceneRenderer scene = renderer();
    SceneUpdate update = first_update(&workpiece_);
    const Box cube{Vec3(-10), Vec3(10)};
    update.machine = box_machine({cube, cube});
    scene.apply(update);
    return scene;
  }
  TestWorkpiece workpiece_{64, 64};
};

TEST_F(MachineTest, IsWhereItsPosesAre) {
  SceneRenderer scene = scene_with_cubes();
  scene.apply(poses({{0, 0, 30}, {64, 64, 30}}));
  const Projection projection = view_of(scene);
  DrawOptions hidden = everything_;
  hidden.looks[static_cast<std::size_t>(SceneObject::kMachine)].is_visible = false;
  draw(&scene, projection, hidden);
  const Picture without = scene.read();
  draw(&scene, projection, everything_);
  const Picture with = scene.read();
  for (const Vec3& middle : {Vec3(0, 0, 30), Vec3(64, 64, 30)}) {
    const glm::ivec2 px = pixel_of(projection, middle);
    EXPECT_NE(at(with, px), at(without, px));
  }
  // A link whose pose is not known is not drawn.
  scene.apply(poses({{0, 0, 30}}));
  draw(&scene, projection, everything_);
  const glm::ivec2 px = pixel_of(projection, Vec3(64, 64, 30));
  EXPECT_EQ(at(scene.read(), px), at(without, px));
}

TEST_F(MachineTest, LiesBehindWhatIsBeforeIt) {
  SceneRenderer scene = scene_with_cubes();
  scene.apply(poses({{32, 32, -30}, {500, 500, 0}}));
  camera_.look_from(StandardView::kTop);
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const Picture with = scene.read();
  DrawOptions hidden = everything_;
  hidden.looks[static_cast<std::size_t>(SceneObject::kMachine)].is_visible = false;
  draw(&scene, projection, hidden);
  EXPECT_EQ(differing_pixels(with, scene.read()), 0);
}

/// What the machine changes of the picture of the workpiece's middle: 0 to 255, the largest
/// channel.
int veil_of(SceneRenderer* scene, const Projection& projection, const DrawOptions& options) {
  const auto middle = [&](bool with_machine) {
    DrawOptions looks = options;
    looks.looks[static_cast<std::size_t>(SceneObject::kMachine)].is_visible = with_machine;
    EXPECT_TRUE(scene->draw(projection, looks));
    const Picture picture = scene->read();
    return at(picture, pixel_of(projection, scene->fit_box().min + 0.5 * scene->fit_box().size()));
  };
  const Color with = middle(true), without = middle(false);
  return std::max(
      {std::abs(with.r - without.r), std::abs(with.g - without.g), std::abs(with.b - without.b)});
}

TEST_F(MachineTest, WhatHidesTheWorkpieceIsSeenThrough) {
  for (const bool perspective : {true, false}) {
    SceneRenderer scene = renderer();
    TestWorkpiece workpiece(64, 64);
    SceneUpdate update = first_update(&workpiece);
    update.machine = box_machine({{Vec3(-60, -60, 0), Vec3(60, 60, 10)}});
    scene.apply(update);
    camera_.set_perspective(perspective);
    camera_.look_from(StandardView::kTop);
    scene.apply(poses({{500, 500, 0}}));
    EXPECT_EQ(veil_of(&scene, view_of(scene), everything_), 0) << "far away";
    scene.apply(poses({{32, 32, 40}}));
    const Projection projection = view_of(scene);
    const int veil = veil_of(&scene, projection, everything_);
    EXPECT_GT(veil, 5) << "it can still be seen";
    EXPECT_LT(veil, 40);
    // The same picture as drawn anew.
    draw(&scene, projection, everything_);
    const Picture faded = scene.read();
    DrawOptions full = everything_;
    full.is_local = false;
    draw(&scene, projection, full);
    EXPECT_EQ(differing_pixels(faded, scene.read()), 0);
    // Below the workpiece it hides nothing and is opaque, behind the workpiece.
    scene.apply(poses({{32, 32, -40}}));
    EXPECT_EQ(veil_of(&scene, projection, everything_), 0);
    // Without a workpiece to be seen it is as opaque as it is.
    DrawOptions machine_alone = everything_;
    machine_alone.looks[static_cast<std::size_t>(SceneObject::kWorkpiece)].is_visible = false;
    scene.apply(poses({{32, 32, 40}}));
    EXPECT_GT(veil_of(&scene, projection, machine_alone), 60);
  }
}

TEST_F(MachineTest, ALinkFadesTheMoreItHides) {
  SceneRenderer scene = renderer();
  SceneUpdate update = first_update(&workpiece_);
  update.machine = box_machine({{Vec3(-60, -60, 0), Vec3(60, 60, 10)}});
  scene.apply(update);
  camera_.look_from(StandardView::kTop);
  camera_.fit(Box{Vec3(-80, -20, -40), Vec3(144, 84, 50)}, kSize_px);
  const Projection projection = camera_.projection(scene.depth_box(), kSize_px);
  // From the side until it covers a little, a part, and all of the workpiece of 64 mm. Where it is
  // seen beside the workpiece: the point that all of its places cover.
  const auto color_of_link = [&](float x) {
    scene.apply(poses({{x, 32, 40}}));
    EXPECT_TRUE(scene.draw(projection, everything_));
    return at(scene.read(), pixel_of(projection, Vec3(-16, 32, 40)));
  };
  const Color whole = color_of_link(-74.0f);
  EXPECT_EQ(color_of_link(-62.0f), whole) << "a few hundredths";
  const Color some = color_of_link(-48.0f), all = color_of_link(20.0f);
  EXPECT_NE(some, whole);
  EXPECT_NE(some, all);
}

TEST_F(MachineTest, ALinkAroundTheEyeDoesNotHideTheWorkpiece) {
  SceneRenderer scene = renderer();
  SceneUpdate update = first_update(&workpiece_);
  const Box column{Vec3(-1), Vec3(1)};
  update.machine = box_machine({column});
  scene.apply(update);
  scene.apply(poses({{5000, 0, 0}}));
  const Projection projection = view_of(scene);
  const glm::mat4 world_from_view = glm::inverse(projection.view_from_world);
  const glm::mat4 around_eye = world_from_view * glm::scale(glm::mat4(1.0f), glm::vec3(20.0f));
  Moment moment;
  moment.link_poses = {around_eye};
  SceneUpdate news;
  news.moment = std::make_shared<const Moment>(moment);
  scene.apply(news);
  EXPECT_EQ(veil_of(&scene, projection, everything_), 0);
}

TEST_F(MachineTest, AMoveCopiesOnlyWhatTheMovedLinkCovers) {
  SceneRenderer scene = scene_with_cubes();
  scene.apply(poses({{0, 0, 30}, {64, 64, 30}}));
  const Projection projection = view_of(scene);
  draw(&scene, projection, everything_);
  const std::uint64_t before = scene.counters().shown_pixels;
  scene.apply(poses({{1, 0, 30}, {64, 64, 30}}));
  draw(&scene, projection, everything_);
  EXPECT_EQ(scene.counters().still.frames, 1u);
  EXPECT_EQ(scene.counters().still.pixels, 0u);
  const std::uint64_t copied = scene.counters().shown_pixels - before;
  EXPECT_GT(copied, 500u);
  EXPECT_LT(copied, static_cast<std::uint64_t>(kSize_px.x * kSize_px.y / 8));
  // The same picture as drawn anew.
  const Picture moved = scene.read();
  DrawOptions full = everything_;
  full.is_local = false;
  draw(&scene, projection, full);
  EXPECT_EQ(differing_pixels(moved, scene.read()), 0);
}

TEST_F(MachineTest, UploadsALinkAFrameWhenTheBudgetIsSmall) {
  SceneRenderer scene = scene_with_cubes();
  scene.apply(poses({{0, 0, 30}, {64, 64, 30}}));
  const Projection projection = view_of(scene);
  DrawOptions options = everything_;
  draw(&scene, projection, options);
  EXPECT_FALSE(scene.has_waiting());
  const std::size_t bytes = scene.counters().gpu_bytes;
  SceneUpdate again;
  again.machine = box_machine({{Vec3(0), Vec3(5)}, {Vec3(0), Vec3(6)}, {Vec3(0), Vec3(7)}});
  scene.apply(again);
  options.upload_bytes_per_frame = 1;
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_TRUE(scene.has_waiting()) << frame;
    draw(&scene, projection, options);
  }
  EXPECT_FALSE(scene.has_waiting());
  EXPECT_GT(scene.counters().gpu_bytes, bytes);
}

TEST(GlFailure, SaysWhatIsLost) {
  EXPECT_EQ(gl_failure(0, 0, 1 << 20), "");
  EXPECT_EQ(gl_failure(0x8253, 0, 0),
            "the graphics driver was reset after it got stuck on this picture: what is shown is "
            "lost; close the window and open it again");
  EXPECT_EQ(gl_failure(0x8254, 0, 0),
            "the graphics driver was reset because of another program: what is shown is lost; "
            "close the window and open it again");
  EXPECT_EQ(gl_failure(0x8255, 0x0505, 0),
            "the graphics driver was reset: what is shown is lost; close the window and open it "
            "again");
  EXPECT_EQ(
      gl_failure(0, 0x0507, 0),
      "the OpenGL context is lost: what is shown is lost; close the window and open it again");
  EXPECT_EQ(gl_failure(0, 0x0505, std::size_t{1500} << 20),
            "the graphics memory is full with 1500 MB: use a coarser grid (--cell) or a smaller "
            "window");
  EXPECT_NE(gl_failure(0, 0x0502, 0).find("error 0x0502"), std::string::npos);
}

/// Squares in a row, of which `skipped` is left out and `raised` lies higher.
MeshPatch row_of_squares(int skipped, int raised) {
  MeshPatch patch;
  for (int k = 0; k < 20; ++k) {
    if (k == skipped) continue;
    const auto x = static_cast<float>(k);
    const float z = k == raised ? 1.0f : 0.0f;
    const auto first = static_cast<std::uint32_t>(patch.vertices.size());
    for (const glm::vec3& p : {glm::vec3(x, 0, z), glm::vec3(x + 1, 0, z), glm::vec3(x, 1, z)}) {
      patch.vertices.push_back({p, pack_normal({0, 0, 1})});
    }
    for (std::uint32_t corner = 0; corner < 3; ++corner) patch.indices.push_back(first + corner);
  }
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  return patch;
}

TEST(ChangedBox, HoldsTheTrianglesThatDifferAndNoOthers) {
  const MeshPatch before = row_of_squares(-1, -1);
  EXPECT_TRUE(changed_box(&before, before, false).empty());
  EXPECT_EQ(changed_box(nullptr, before, false), (Box{Vec3(0, 0, 0), Vec3(20, 1, 0)}));
  EXPECT_EQ(changed_box(&before, row_of_squares(-1, 7), false),
            (Box{Vec3(7, 0, 0), Vec3(8, 1, 1)}));
  // All that follow have other numbers, but are the same.
  EXPECT_EQ(changed_box(&before, row_of_squares(4, -1), false),
            (Box{Vec3(4, 0, 0), Vec3(5, 1, 0)}));
  EXPECT_EQ(changed_box(&before, row_of_squares(4, 7), false), (Box{Vec3(4, 0, 0), Vec3(8, 1, 1)}));
}

TEST(ChangedBox, AnotherMoveIsAChange) {
  MeshPatch before = row_of_squares(-1, -1), after = before;
  before.cut_by.assign(before.vertices.size(), 3);
  after.cut_by = before.cut_by;
  after.cut_by[3 * 9] = 4;
  EXPECT_EQ(changed_box(&before, after, false), (Box{Vec3(9, 0, 0), Vec3(10, 1, 0)}));
}

}  // namespace
}  // namespace kerf
