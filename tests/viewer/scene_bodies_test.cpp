// Fixtures, and what is red where bodies touch.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/viewer/scene_fixture.h"

namespace kerf {
namespace {

bool is_red(const Color& c) { return c.r > 100 && c.g < c.r / 2 && c.b < c.r / 2; }

class BodiesTest : public SceneRendererTest {
 protected:
  /// A workpiece of 64 mm, a fixture of 16 mm, the tool's tip at `tip_mm`.
  SceneRenderer scene() {
    SceneRenderer scene = renderer();
    SceneUpdate update = first_update(&workpiece_);
    update.path.clear();
    update.tool_shape = test_tool(2);  // the holder ends 32 mm above the tip, 8 mm wide all around
    update.fixtures = box_machine({{Vec3(-8), Vec3(8)}});
    scene.apply(update);
    camera_.look_from(StandardView::kTop);
    return scene;
  }
  static SceneUpdate moment(const Vec3& fixture_mm, std::vector<SceneContact> contacts = {}) {
    Moment moment;
    moment.tool_pose = ToolPose{{44, 44, 20}, {0, 0, 1}};
    moment.fixture_poses = {glm::translate(glm::mat4(1.0f), glm::vec3(fixture_mm))};
    moment.contacts = std::move(contacts);
    SceneUpdate update;
    update.moment = std::make_shared<const Moment>(std::move(moment));
    return update;
  }
  static DrawOptions without(SceneObject object) {
    DrawOptions options;
    options.upload_bytes_per_frame = std::size_t{1} << 30;
    options.looks[static_cast<std::size_t>(object)].is_visible = false;
    return options;
  }
  Color color_at(SceneRenderer* scene, const Vec3& place, const DrawOptions& options) {
    const Projection projection = view_of(*scene);
    draw(scene, projection, options);
    return at(scene->read(), pixel_of(projection, place));
  }
  TestWorkpiece workpiece_{64, 64};
};

TEST_F(BodiesTest, AFixtureIsWhereItsPoseIsUntilItIsHidden) {
  SceneRenderer renderer = scene();
  renderer.apply(moment({20, 20, 12}));
  const Color with = color_at(&renderer, {20, 20, 20}, everything_);
  EXPECT_NE(with, color_at(&renderer, {20, 20, 20}, without(SceneObject::kFixtures)));
  EXPECT_EQ(with, color_at(&renderer, {20, 20, 20}, without(SceneObject::kMachine)));
  // Nothing is drawn of one whose pose is not known.
  SceneUpdate lost;
  lost.moment = std::make_shared<const Moment>();
  renderer.apply(lost);
  EXPECT_EQ(color_at(&renderer, {20, 20, 20}, everything_),
            color_at(&renderer, {20, 20, 20}, without(SceneObject::kFixtures)));
  Moment nowhere;
  nowhere.fixture_poses = {kNotDrawn};
  renderer.apply(moment({20, 20, 12}));
  EXPECT_EQ(color_at(&renderer, {20, 20, 20}, everything_), with);
  lost.moment = std::make_shared<const Moment>(std::move(nowhere));
  renderer.apply(lost);
  EXPECT_EQ(color_at(&renderer, {20, 20, 20}, everything_),
            color_at(&renderer, {20, 20, 20}, without(SceneObject::kFixtures)));
}

TEST_F(BodiesTest, WhatTouchesIsRedAndNothingElse) {
  SceneRenderer renderer = scene();
  const Vec3 fixture(20, 20, 12), tool(44, 44, 52);
  renderer.apply(moment(fixture));
  EXPECT_FALSE(is_red(color_at(&renderer, {20, 20, 20}, everything_)));
  EXPECT_FALSE(is_red(color_at(&renderer, tool, everything_)));
  SceneContact contact;
  contact.piece = ToolPiece::kHolder;
  contact.fixture = 0;
  renderer.apply(moment(fixture, {contact}));
  EXPECT_TRUE(is_red(color_at(&renderer, {20, 20, 20}, everything_)));
  EXPECT_TRUE(is_red(color_at(&renderer, tool, everything_))) << "seen from above: the holder";
  // The workpiece has no body of its own: the tool's piece alone.
  contact.fixture.reset();
  renderer.apply(moment(fixture, {contact}));
  EXPECT_FALSE(is_red(color_at(&renderer, {20, 20, 20}, everything_)));
  EXPECT_TRUE(is_red(color_at(&renderer, tool, everything_)));
  // It is over.
  renderer.apply(moment(fixture));
  EXPECT_FALSE(is_red(color_at(&renderer, tool, everything_)));
}

TEST_F(BodiesTest, OneThatTouchesShinesThroughTheWorkpiece) {
  SceneRenderer renderer = scene();
  const Vec3 below(20, 20, -30);
  renderer.apply(moment(below));
  const Color covered = color_at(&renderer, {20, 20, 0}, everything_);
  SceneContact contact;
  contact.fixture = 0;
  renderer.apply(moment(below, {contact}));
  const Color seen = color_at(&renderer, {20, 20, 0}, everything_);
  EXPECT_GT(seen.r - seen.g, covered.r - covered.g + 20);
  EXPECT_EQ(color_at(&renderer, {20, 20, 0}, without(SceneObject::kFixtures)), covered);
}

TEST_F(BodiesTest, LinksOfAMachineAreMarkedToo) {
  SceneRenderer renderer = scene();
  SceneUpdate update = moment({20, 20, 12});
  update.machine = box_machine({{Vec3(-6), Vec3(6)}, {Vec3(-6), Vec3(6)}});
  Moment values = *update.moment;
  for (const glm::vec3& middle : {glm::vec3(48, 16, 12), glm::vec3(16, 48, 12)})
    values.link_poses.push_back(glm::translate(glm::mat4(1.0f), middle));
  update.moment = std::make_shared<const Moment>(values);
  renderer.apply(update);
  const Vec3 one(48, 16, 18), other(16, 48, 18);
  EXPECT_FALSE(is_red(color_at(&renderer, other, everything_)));
  SceneContact contact;
  contact.links = {1};
  values.contacts = {contact};
  SceneUpdate touched;
  touched.moment = std::make_shared<const Moment>(values);
  renderer.apply(touched);
  EXPECT_TRUE(is_red(color_at(&renderer, other, everything_)));
  EXPECT_FALSE(is_red(color_at(&renderer, one, everything_)));
}

TEST_F(BodiesTest, WhatComesNearIsAmber) {
  SceneRenderer renderer = scene();
  SceneContact contact;
  contact.fixture = 0;
  contact.is_near = true;
  renderer.apply(moment({20, 20, 12}, {contact}));
  const Color amber = color_at(&renderer, {20, 20, 20}, everything_);
  EXPECT_GT(amber.r, amber.g + 30);
  EXPECT_GT(amber.g, amber.b + 30);
}

TEST_F(BodiesTest, APlaceOnTheWorkpieceIsMarked) {
  SceneRenderer renderer = scene();
  SceneContact contact;
  contact.point_mm = Vec3(40, 20, 0);
  contact.mark_mm = 3;
  renderer.apply(moment({20, 20, 12}));
  const Color plain = color_at(&renderer, {40, 20, 0}, everything_);
  renderer.apply(moment({20, 20, 12}, {contact}));
  EXPECT_TRUE(is_red(color_at(&renderer, {40, 20, 0}, everything_)));
  EXPECT_EQ(color_at(&renderer, {40, 20, 0}, without(SceneObject::kFindings)), plain);
  renderer.apply(moment({20, 20, 12}));
  EXPECT_EQ(color_at(&renderer, {40, 20, 0}, everything_), plain);
}

TEST_F(BodiesTest, RedrawingWhatChangedGivesTheSamePicture) {
  SceneRenderer renderer = scene();
  SceneContact contact;
  contact.fixture = 0;
  contact.point_mm = Vec3(40, 20, 0);
  contact.mark_mm = 3;
  DrawOptions whole = everything_;
  whole.is_local = false;
  const Projection projection = view_of(renderer);
  for (const SceneUpdate& update :
       {moment({20, 20, 12}), moment({20, 20, 12}, {contact}), moment({26, 22, 4}, {contact}),
        moment({26, 22, 4}), moment({20, 20, -30}, {contact})}) {
    renderer.apply(update);
    draw(&renderer, projection, everything_);
    const Picture local = renderer.read();
    draw(&renderer, projection, whole);
    EXPECT_EQ(differing_pixels(local, renderer.read()), 0);
  }
}

TEST_F(BodiesTest, ATransparentHolderLetsTheCutterBeSeen) {
  SceneRenderer renderer = scene();
  renderer.apply(moment({20, 20, 12}));
  const Vec3 holder(44, 44, 52);
  const Color seen_through = color_at(&renderer, holder, everything_);
  // What stands behind it, seen from above, is the shank.
  const Color behind = color_at(&renderer, holder, without(SceneObject::kHolder));
  EXPECT_NE(seen_through, behind);
}

}  // namespace
}  // namespace kerf
