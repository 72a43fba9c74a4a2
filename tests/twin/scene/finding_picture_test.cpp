#include "twin/scene/finding_picture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/geometric.hpp>

#include "stock/cutter/shape_spec.h"
#include "tests/twin/playback/tracks.h"
#include "tests/twin/scene/machine_with_arm.h"
#include "twin/machines/machine_bodies.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/finding_view.h"

namespace kerf {
namespace {

CollisionWishes with_clamp() {
  const FixtureSpec clamp[] = {parse_fixture("clamp=box:40.2,15,-10:50,25,3").value()};
  Diagnostics diagnostics;
  CollisionWishes wishes;
  wishes.fixtures = load_fixtures(clamp, diagnostics);
  return wishes;
}

/// A slot along Y20 up to the clamp at the end of the block.
FindingShot shot_at_clamp() {
  FindingShot shot;
  shot.cutter = std::make_shared<const Cutter>(
      parse_shape("flat:6:flute=15:shank=6:holder=30x20:stickout=25").value());
  auto stock = test::block_40(0.2);
  std::vector<CutReport> reports;
  CutMove slot;
  slot.from_mm = {-5, 20, -2};
  slot.to_mm = {37.201, 20, -2};
  stock->cut(*shot.cutter, {&slot, 1}, reports);
  shot.stock = stock->snapshot();
  shot.tool = {slot.to_mm, {0, 0, 1}};
  shot.finding.id = FindingId::kFixtureContact;
  shot.finding.source.line = 12;
  shot.finding.bodies = {"cutter", "clamp"};
  shot.place = "part.ngc:12";
  shot.message = "cutter touches fixture 'clamp', 3.00 mm deep";
  return shot;
}

int red_pixels(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    count += picture.rgb[i] > 110 && picture.rgb[i + 1] < picture.rgb[i] / 2 &&
             picture.rgb[i + 2] < picture.rgb[i] / 2;
  }
  return count;
}

TEST(FindingPicture, NamesSayWhatAndWhere) {
  Finding finding;
  finding.id = FindingId::kHolderContact;
  finding.source.line = 120;
  EXPECT_EQ(finding_picture_name(3, finding), "03-holder-contact-line-120.png");
  finding.source.line = 0;
  EXPECT_EQ(finding_picture_name(20, finding), "20-holder-contact.png");
}

TEST(FindingView, ShowsWhereTheyTouchAndBothBodies) {
  BodyWatch watch(with_clamp());
  const FindingShot shot = shot_at_clamp();
  const FindingView view = finding_view(shot, watch);
  ASSERT_TRUE(view.contact);
  EXPECT_EQ(view.tool_name, "cutter");
  EXPECT_EQ(view.other_name, "clamp");
  EXPECT_NEAR(view.place_mm.x, 40.2, 0.2);
  EXPECT_NEAR(glm::distance(view.axis_mm, Vec3(37.201, 20, view.place_mm.z)), 0, 1e-9);
  // The whole tool, and the clamp.
  EXPECT_LE(view.frame_mm.min.x, 37.2 - 15);
  EXPECT_GE(view.frame_mm.max.x, 50 - 1e-9);
  EXPECT_GE(view.frame_mm.max.z, 43 - 1e-9);
  EXPECT_FALSE(view.close_mm.empty());
}

TEST(FindingView, ASpindleIsShownInPart) {
  CollisionWishes wishes;
  wishes.spindle = {{80, 0, 400}};
  BodyWatch watch(wishes);
  FindingShot shot = shot_at_clamp();
  shot.finding.bodies = {"spindle", kWorkpieceBody};
  EXPECT_NEAR(finding_view(shot, watch).frame_mm.max.z, -2 + 45 + 60, 1e-6);
  shot.finding.bodies = {"cutter", kWorkpieceBody};
  EXPECT_NEAR(finding_view(shot, watch).frame_mm.max.z, -2 + 45, 1e-6) << "not where it is free";
}

/// The work zero is at -150 of the machine, so the table's top at -50 of the work. A vise on it,
/// X80..120 of its frame and its top at Z10 of the work; the head's arm
/// reaches from X60 to X90, to 80 below the nose and so 30 below a tip of 50.
CollisionWishes with_vise_on_table() {
  const FixtureSpec vise[] = {parse_fixture("vise=box:80,-20,-200:120,20,-140:on=table").value()};
  Diagnostics diagnostics;
  CollisionWishes wishes;
  wishes.fixtures = load_fixtures(vise, diagnostics);
  wishes.machine = bodies_of(test::machine_with_arm(), diagnostics);
  return wishes;
}

/// At the vise stands at X80 of the work, and the arm's side at X80.01.
FindingShot shot_at_vise(const MachineModel& machine) {
  FindingShot shot = shot_at_clamp();
  shot.cutter = std::make_shared<const Cutter>(
      parse_shape("flat:6:flute=15:shank=6:holder=20x30:stickout=20").value());
  shot.tool = {{-9.99, 0, -2}, {0, 0, 1}};
  shot.finding.id = FindingId::kMachineCollision;
  shot.finding.bodies = {"vise", "head"};
  shot.message = "fixture 'vise' touches link 'head'";
  shot.link_poses = drawn_poses(machine, shot.tool.tip_mm, {}, 50);
  return shot;
}

TEST(FindingView, OfAMachineShowsTheTwoBodiesWhereTheyTouch) {
  const auto machine = test::drawn_with_arm({0, 0, -150});
  const CollisionWishes wishes = with_vise_on_table();
  BodyWatch watch(wishes);
  watch.set_machine(std::make_shared<const SceneMachine>(scene_machine(*machine)));
  FindingShot shot = shot_at_vise(*machine);
  const FindingView view = finding_view(shot, watch, wishes.machine.get());
  ASSERT_TRUE(view.contact);
  EXPECT_EQ(view.contact->links, std::vector<std::size_t>{2});
  EXPECT_EQ(view.tool_name, "head");
  EXPECT_EQ(view.other_name, "vise");
  ASSERT_TRUE(view.other_mm);
  // The side of the vise at X80 (the table is where it is with the tip at of the work).
  EXPECT_NEAR(view.place_mm.x, 80, 0.1);
  EXPECT_LE(std::abs(view.place_mm.y), 20.1);
  EXPECT_GE(view.place_mm.z, -32.1);
  EXPECT_LE(view.place_mm.z, 10.1);
  EXPECT_LE(view.frame_mm.min.x, -9.99 - 10) << "the tool";
  EXPECT_GE(view.frame_mm.max.x, 100) << "the vise";
  // Where the machine stands is not known: nothing is where it was before.
  shot.link_poses.clear();
  const FindingView unknown = finding_view(shot, watch, wishes.machine.get());
  EXPECT_EQ(unknown.place_mm, shot.tool.tip_mm);
  EXPECT_FALSE(unknown.other_mm);
  EXPECT_EQ(watch.poses(), std::vector<glm::mat4>{kNotDrawn});
}

TEST(FindingView, OfALinkInTheWorkpieceShowsWhere) {
  const auto machine = test::drawn_with_arm({0, 0, -150});
  const CollisionWishes wishes = with_vise_on_table();
  BodyWatch watch(wishes);
  watch.set_machine(std::make_shared<const SceneMachine>(scene_machine(*machine)));
  FindingShot shot = shot_at_vise(*machine);
  // The block is X0..40, its top at 0; the arm ends at the tip - 30, and is at X50..80 from there.
  shot.tool = {{-50, 20, 29.95}, {0, 0, 1}};
  shot.finding.bodies = {kWorkpieceBody, "head"};
  shot.link_poses = drawn_poses(*machine, shot.tool.tip_mm, {}, 50);
  const FindingView view = finding_view(shot, watch, wishes.machine.get());
  ASSERT_TRUE(view.contact && view.contact->point_mm);
  EXPECT_NEAR(view.contact->point_mm->z, 0, 0.01);
  EXPECT_GE(view.contact->point_mm->x, 10 - 0.3);
  EXPECT_EQ(view.tool_name, "head");
  EXPECT_FALSE(view.other_mm);
}

TEST(FindingView, IsSeenFromBesideRatherThanThroughABody) {
  FindingView view;
  view.place_mm = {3, 0, 0};  // on the side of the tool towards +X
  const auto score = [&](double yaw_deg, double pitch_deg, bool shows_place) {
    const ViewAngles angles{yaw_deg * kPi / 180, pitch_deg * kPi / 180};
    return score_of(view, angles, shows_place, true, true);
  };
  EXPECT_GT(score(-75, 28, true), score(0, 28, true)) << "what is touched hides it";
  EXPECT_GT(score(-75, 28, true), score(180, 28, true)) << "the tool hides it";
  EXPECT_GT(score(0, 28, true), score(-75, 28, false)) << "but it is to be seen";
  EXPECT_GT(score(-75, 28, true), score(-75, 75, true)) << "not from high above";
  view.axis = {0.87, 0, 0.5};
  EXPECT_GT(score(90, 28, true), score(0, 28, true)) << "nor along a tilted tool";
  view.axis = {0, 0, 1};
  EXPECT_GT(score(-75, 28, true), score(75, 28, true)) << "from the front, all else being equal";
  EXPECT_TRUE(tool_hides_place(view, {kPi, 0.5}));
  EXPECT_FALSE(tool_hides_place(view, {0, 0.5}));
  view.place_mm = {0, 0, 0};
  EXPECT_FALSE(tool_hides_place(view, {kPi, 0.5})) << "it is on the axis";
  EXPECT_GE(candidate_views().size(), 12u);
}

TEST(FindingPicture, BothBodiesAreRed) {
  unsetenv("DISPLAY");
  Result<FindingPictures> pictures = FindingPictures::create(with_clamp(), nullptr, {640, 480});
  ASSERT_TRUE(pictures) << pictures.error();
  FindingShot shot = shot_at_clamp();
  const Result<Picture> red = pictures->draw(shot);
  ASSERT_TRUE(red) << red.error();
  EXPECT_EQ(red->width_px, 640);
  EXPECT_EQ(red->height_px, 480);
  EXPECT_GT(red_pixels(*red), 3000);
  EXPECT_EQ(pictures->draw(shot)->rgb, red->rgb) << "whatever was drawn before";
  shot.finding.bodies = {"holder", kWorkpieceBody};
  EXPECT_GT(red_pixels(*pictures->draw(shot)), 1000) << "the holder alone";
  // What tells of no two bodies makes nothing red.
  shot.finding.bodies = {};
  EXPECT_EQ(red_pixels(*pictures->draw(shot)), 0);
}

TEST(FindingPicture, BothBodiesOfAMachineAreRed) {
  unsetenv("DISPLAY");
  const auto machine = test::drawn_with_arm({0, 0, -150});
  Result<FindingPictures> pictures =
      FindingPictures::create(with_vise_on_table(), machine, {640, 480});
  ASSERT_TRUE(pictures) << pictures.error();
  FindingShot shot = shot_at_vise(*machine);
  const int both = red_pixels(*pictures->draw(shot));
  // Of these two the vise alone is red.
  shot.finding.bodies = {"vise", kWorkpieceBody};
  EXPECT_GT(red_pixels(*pictures->draw(shot)), 1000) << "the vise, where the table has it";
  shot.link_poses.clear();
  EXPECT_EQ(red_pixels(*pictures->draw(shot)), 0) << "nobody knows where the vise is";
  EXPECT_GT(both, 10000);
}

TEST(FindingPicture, IsDrawnSmallAndWithoutATool) {
  unsetenv("DISPLAY");
  Result<FindingPictures> pictures = FindingPictures::create(with_clamp(), nullptr, {64, 64});
  ASSERT_TRUE(pictures) << pictures.error();
  FindingShot shot = shot_at_clamp();
  EXPECT_GT(red_pixels(*pictures->draw(shot)), 10);
  shot.cutter = nullptr;  // nobody knows it
  EXPECT_TRUE(pictures->draw(shot));
}

}  // namespace
}  // namespace kerf
