#include "twin/scene/body_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "tests/twin/playback/tracks.h"
#include "twin/machine/kinematics/pose.h"
#include "twin/machines/machine_bodies.h"
#include "twin/scene/contact_places.h"

namespace kerf {
namespace {

CollisionWishes wishes_of(const std::vector<std::string>& texts) {
  std::vector<FixtureSpec> specs;
  for (const std::string& text : texts) specs.push_back(parse_fixture(text).value());
  Diagnostics diagnostics;
  CollisionWishes wishes;
  wishes.fixtures = load_fixtures(specs, diagnostics);
  return wishes;
}

std::shared_ptr<const Cutter> cutter_of(std::string_view shape) {
  return std::make_shared<const Cutter>(parse_shape(shape).value());
}

ToolPose at(const Vec3& tip_mm) { return {tip_mm, {0, 0, 1}}; }

Moment look(BodyWatch& watch, const ToolPose& tool, double time_s = 0, double speed = 0,
            const StockModel* stock = nullptr) {
  Moment moment;
  watch.look(tool, time_s, speed, stock, &moment);
  return moment;
}

Finding collision(FindingId id, const std::string& part, const std::string& other, double time_s) {
  Finding finding;
  finding.id = id;
  finding.bodies = {part, other};
  finding.time_s = time_s;
  return finding;
}

TEST(BodyWatch, ClearanceIsThatOfTheNearestPair) {
  BodyWatch watch(wishes_of({"vise=box:20,-50,-10:30,50,40", "post=cylinder:-40,0,0:5:10"}));
  watch.mount(cutter_of("flat:6:flute=20:shank=6:holder=30x20:stickout=30"), 0);
  // The holder reaches to X15, the vise begins at X20; the cutter reaches to X3.
  const Moment moment = look(watch, at({0, 0, 0}));
  ASSERT_TRUE(moment.clearance);
  EXPECT_NEAR(moment.clearance->mm, 5, 0.003);
  EXPECT_FALSE(moment.clearance->is_beyond);
  EXPECT_EQ(moment.clearance->piece, "holder");
  EXPECT_EQ(moment.clearance->fixture, "vise");
  EXPECT_TRUE(moment.contacts.empty());
  // Above the vise, the cutter is nearest.
  EXPECT_NEAR(look(watch, at({25, 0, 43.25})).clearance->mm, 3.25, 0.003);
  // Far from all: so far is not looked.
  const Moment far = look(watch, at({0, 0, 200}));
  EXPECT_TRUE(far.clearance->is_beyond);
  EXPECT_EQ(far.clearance->mm, BodyWatch::kReach_mm);
}

TEST(BodyWatch, ClearanceOfACylinderAndABoxIsTheClosedForm) {
  BodyWatch watch(wishes_of({"box:-5,-8,0:12,9,11"}));
  watch.mount(cutter_of("flat:8"), 0);  // a cylinder 32 mm high: four diameters
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-40, 40);
  int seen = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 tip{place(random), place(random), place(random)};
    const double dx = std::max({-5 - tip.x, tip.x - 12, 0.0});
    const double dy = std::max({-8 - tip.y, tip.y - 9, 0.0});
    const double across = std::max(std::hypot(dx, dy) - 4, 0.0);
    const double along = std::max({tip.z - 11, 0 - (tip.z + 32), 0.0});
    const double expected = std::hypot(across, along);
    const Moment moment = look(watch, at(tip));
    ASSERT_TRUE(moment.clearance);
    if (expected > BodyWatch::kReach_mm + 0.01) {
      EXPECT_TRUE(moment.clearance->is_beyond);
      continue;
    }
    if (expected > BodyWatch::kReach_mm - 0.01) continue;
    ++seen;
    EXPECT_NEAR(moment.clearance->mm, expected, 0.003) << tip.x << ' ' << tip.y << ' ' << tip.z;
    EXPECT_EQ(moment.contacts.empty(), expected > 0);
  }
  EXPECT_GT(seen, 80);
}

TEST(BodyWatch, NothingIsKnownWithoutFixturesOrTool) {
  BodyWatch alone{CollisionWishes{}};
  alone.mount(cutter_of("flat:6"), 0);
  EXPECT_FALSE(look(alone, at({0, 0, 0})).clearance);
  ASSERT_TRUE(alone.scene());
  EXPECT_TRUE(alone.scene()->links.empty());
  BodyWatch unknown(wishes_of({"box:0,0,0:1,1,1"}));
  unknown.mount(nullptr, 0);
  EXPECT_FALSE(look(unknown, at({0, 0, 0})).clearance);
}

TEST(BodyWatch, WhatIsInAFixtureIsRedAndWhatGrazesItIsNot) {
  BodyWatch watch(wishes_of({"jaw=box:10,-50,-10:30,50,40"}));
  watch.mount(cutter_of("flat:6"), 0);
  const Moment inside = look(watch, at({7.05, 0, 0}));
  ASSERT_EQ(inside.contacts.size(), 1u);
  EXPECT_EQ(inside.contacts[0].piece, ToolPiece::kCutter);
  EXPECT_EQ(inside.contacts[0].fixture, std::size_t{0});
  EXPECT_EQ(inside.clearance->mm, 0);
  EXPECT_TRUE(look(watch, at({7.008, 0, 0})).contacts.empty()) << "no contact: 0.008 mm";
  EXPECT_TRUE(look(watch, at({6.9, 0, 0})).contacts.empty());
}

TEST(BodyWatch, AFindingIsRedWhileItIsSeen) {
  BodyWatch watch(wishes_of({"jaw=box:100,0,0:110,10,10"}));
  watch.mount(cutter_of("flat:6:flute=10:holder=30x20:stickout=20"), 0);
  watch.set_findings({collision(FindingId::kHolderContact, "holder", kWorkpieceBody, 5),
                      collision(FindingId::kNearMiss, "cutter", "jaw", 30)});
  const auto red = [&](double time_s, double speed) {
    return look(watch, at({0, 0, 0}), time_s, speed).contacts.size();
  };
  EXPECT_EQ(red(5, 0), 1u) << "chosen in the list: it stands there";
  EXPECT_EQ(red(5.01, 0), 0u) << "stands a little behind it";
  EXPECT_EQ(red(4.99, 1), 0u);
  EXPECT_EQ(red(5.45, 1), 1u);
  EXPECT_EQ(red(5.55, 1), 0u);
  EXPECT_EQ(red(9.5, 10), 1u) << "half a second of who looks on";
  const Moment near = look(watch, at({0, 0, 0}), 30, 0);
  ASSERT_EQ(near.contacts.size(), 1u);
  EXPECT_TRUE(near.contacts[0].is_near);
  EXPECT_EQ(near.contacts[0].fixture, std::size_t{0});
}

TEST(BodyWatch, OfAMachineFindingsAreRedFromWhenTheyCome) {
  BodyWatch watch{CollisionWishes{}};
  watch.mount(cutter_of("flat:6:flute=10"), 0);
  watch.add_finding(collision(FindingId::kShankContact, "shank", kWorkpieceBody, 1234), 2);
  EXPECT_EQ(look(watch, at({0, 0, 0}), 2.3, 1).contacts.size(), 1u);
  EXPECT_EQ(look(watch, at({0, 0, 0}), 2.6, 1).contacts.size(), 0u);
}

TEST(BodyWatch, OtherFindingsHaveNoBodies) {
  const CollisionWishes wishes = wishes_of({"jaw=box:100,0,0:110,10,10"});
  const DrawnBodies jaw_alone{wishes.fixtures.get(), nullptr};
  EXPECT_FALSE(contact_of(Finding{}, jaw_alone));
  EXPECT_FALSE(
      contact_of(collision(FindingId::kFixtureContact, "table", "workpiece", 1), jaw_alone));
}

TEST(BodyWatch, BodiesAreFoundByTheirNames) {
  const CollisionWishes wishes = wishes_of({"jaw=box:100,0,0:110,10,10"});
  SceneMachine machine;
  machine.links = {{"table", nullptr}, {"head", nullptr}};
  const DrawnBodies drawn{wishes.fixtures.get(), nullptr, &machine};
  const auto contact = [&](const char* a, const char* b) {
    return contact_of(collision(FindingId::kFixtureContact, a, b, 1), drawn).value();
  };
  EXPECT_EQ(contact("holder", "jaw").piece, ToolPiece::kHolder);
  EXPECT_EQ(contact("holder", "jaw").fixture, std::size_t{0});
  EXPECT_FALSE(contact("holder", "jaw").has_workpiece);
  EXPECT_TRUE(contact("cutter", "workpiece").has_workpiece);
  EXPECT_EQ(contact("head", "table").links, (std::vector<std::size_t>{1, 0}));
  EXPECT_EQ(contact("head", "jaw").fixture, std::size_t{0});
  EXPECT_FALSE(contact("head", "jaw").piece);
  // What is not drawn is not marked, what it touches is.
  EXPECT_EQ(contact("no such", "jaw").fixture, std::size_t{0});
}

TEST(BodyWatch, TheSpindleIsDrawnWhereItsNoseIs) {
  CollisionWishes wishes;
  wishes.spindle = {{80, 0, 60}, {120, 60, 160}};
  BodyWatch watch(wishes);
  const auto cutter = cutter_of("flat:6:flute=20:holder=30x20:stickout=30");
  const auto low = watch.mount(cutter, 20);
  ASSERT_TRUE(low);
  ASSERT_EQ(low->spindle.size(), 4u);
  EXPECT_FLOAT_EQ(low->spindle[0].height_mm, 50) << "where the holder ends";
  EXPECT_FLOAT_EQ(low->spindle[0].radius_mm, 40);
  EXPECT_FALSE(watch.mount(cutter, 20)) << "the same as before";
  const auto high = watch.mount(cutter, 75);
  ASSERT_TRUE(high);
  EXPECT_FLOAT_EQ(high->spindle[0].height_mm, 75);
  EXPECT_FLOAT_EQ(high->spindle[3].height_mm, 235);
}

std::shared_ptr<const SceneMachine> machine_of(const std::vector<std::string>& links) {
  auto machine = std::make_shared<SceneMachine>();
  for (const std::string& name : links) machine->links.push_back({name, nullptr});
  return machine;
}

std::vector<glm::mat4> two_links(const Vec3& table_mm) {
  return {glm::mat4(1.0f), to_mat4(shift(table_mm))};
}

TEST(BodyWatch, AFixtureOnALinkGoesWithIt) {
  BodyWatch watch(wishes_of({"vise=box:0,0,0:30,30,40:at=20,-15,-50:on=table"}));
  watch.mount(cutter_of("flat:10"), 0);
  // Nobody knows where it is: it is nowhere, and what may be nearer is not known.
  EXPECT_EQ(watch.poses(), std::vector<glm::mat4>{kNotDrawn});
  EXPECT_FALSE(look(watch, at({0, 0, -20})).clearance);
  watch.set_machine(machine_of({"frame", "table"}));
  EXPECT_EQ(watch.poses(), std::vector<glm::mat4>{kNotDrawn}) << "it does not stand yet";
  // Its side is 20 mm from the table's origin, the tool 5 mm wide on that side.
  watch.set_link_poses(two_links({0, 0, 0}));
  ASSERT_TRUE(look(watch, at({0, 0, -20})).clearance);
  EXPECT_NEAR(look(watch, at({0, 0, -20})).clearance->mm, 15, 0.01);
  watch.set_link_poses(two_links({-12, 0, 0}));
  EXPECT_NEAR(look(watch, at({0, 0, -20})).clearance->mm, 3, 0.01) << "the tool has not moved";
  EXPECT_NEAR(watch.poses()[0][3].x, 8, 1e-4);
  EXPECT_TRUE(look(watch, at({0, 0, -20})).contacts.empty());
  watch.set_link_poses(two_links({-16, 0, 0}));
  ASSERT_EQ(look(watch, at({0, 0, -20})).contacts.size(), 1u);
  EXPECT_EQ(look(watch, at({0, 0, -20})).contacts[0].fixture, 0u);
  // It cannot stand so, or has no such link: not where it was last.
  watch.set_link_poses({});
  EXPECT_EQ(watch.poses(), std::vector<glm::mat4>{kNotDrawn});
  EXPECT_TRUE(look(watch, at({0, 0, -20})).contacts.empty());
  watch.set_machine(machine_of({"frame", "bed"}));
  watch.set_link_poses(two_links({-16, 0, 0}));
  EXPECT_EQ(watch.poses(), std::vector<glm::mat4>{kNotDrawn});
}

TEST(BodyWatch, OthersAreWhereTheyWereWhateverTheMachineDoes) {
  BodyWatch watch(wishes_of({"clamp=box:20,-15,-50:50,15,-10", "vise=box:0,0,0:1,1,1:on=table"}));
  watch.set_machine(machine_of({"frame", "table"}));
  watch.set_link_poses(two_links({7, 8, 9}));
  EXPECT_EQ(watch.poses()[0], glm::mat4(1.0f));
  EXPECT_NEAR(watch.poses()[1][3].z, 9, 1e-6);
}

/// A head that slides up and down, and carries the tool.
MachineBodiesPointer bodies_with_head() {
  auto machine = std::make_shared<MachineBodies>();
  ChainLink frame, head, nozzle;
  frame.name = "frame";
  head.name = "head";
  head.parent = "frame";
  head.joint = JointKind::kPrismatic;
  head.input = 2;
  nozzle.name = "nozzle";
  nozzle.parent = "head";
  machine->chain = KinematicChain::create({frame, head, nozzle}, "frame", "head").value();
  return machine;
}

TEST(BodyWatch, WhatTheToolsLinkCarriesIsNotNear) {
  for (const std::string on : {"head", "nozzle", "frame"}) {
    CollisionWishes wishes = wishes_of({"pipe=box:-2,-2,0:2,2,40:on=" + on});
    wishes.machine = bodies_with_head();
    BodyWatch watch(wishes);
    watch.mount(cutter_of("flat:10"), 0);
    watch.set_machine(machine_of({"frame", "head", "nozzle"}));
    watch.set_link_poses(std::vector<glm::mat4>(3, glm::mat4(1.0f)));
    const Moment moment = look(watch, at({0, 0, 0}));
    EXPECT_EQ(moment.contacts.size(), on == "frame" ? 1u : 0u) << on;
    ASSERT_TRUE(moment.clearance) << on;
    EXPECT_EQ(moment.clearance->is_beyond, on != "frame") << on;
  }
}

TEST(ContactPlaces, OnTheWorkpieceOfAnyBody) {
  const std::unique_ptr<ZMap> stock = test::block_40(0.2);  // top at 0
  const CollisionWishes wishes = wishes_of({"arm=box:10,10,0:14,14,50"});
  const Solid& arm = *(*wishes.fixtures)[0].solid;
  const auto place = place_on_workpiece(arm, shift({0, 0, -0.05}), *stock);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->z, 0, 0.01);
  EXPECT_GT(place->x, 9.7);
  EXPECT_LT(place->x, 14.3);
  EXPECT_FALSE(place_on_workpiece(arm, shift({0, 0, 1}), *stock)) << "farther than a cell";
}

TEST(ContactPlaces, BetweenAToolAndAFixture) {
  const CollisionWishes wishes = wishes_of({"clamp=box:100.2,15,-20:110,25,3"});
  const Fixture& clamp = (*wishes.fixtures)[0];
  const auto bodies = tool_bodies(*cutter_of("flat:6"), {}, 0);
  Pose tool;
  tool.origin_mm = {97.201, 20, -2};
  const auto place =
      place_between(*bodies[0].solid, tool, *clamp.solid, clamp.workpiece_from_fixture);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x, 100.2, 0.2);
  EXPECT_NEAR(place->y, 20, 0.6) << "a cylinder meets a plane along a line";
  EXPECT_GT(place->z, -2.2);
  EXPECT_LT(place->z, 3.2);
  tool.origin_mm = {0, 0, 0};
  EXPECT_FALSE(place_between(*bodies[0].solid, tool, *clamp.solid, clamp.workpiece_from_fixture))
      << "far apart";
}

TEST(ContactPlaces, OnTheWorkpiece) {
  const std::unique_ptr<ZMap> stock = test::block_40(0.2);  // top at 0
  const auto bodies = tool_bodies(*cutter_of("flat:6:flute=5:holder=20x20:stickout=5"), {}, 0);
  ASSERT_EQ(bodies.back().part, ToolPart::kHolder);
  Pose tool;
  tool.origin_mm = {20, 20, -5.01};
  const auto on_top = place_on_workpiece(bodies.back(), tool, *stock);
  ASSERT_TRUE(on_top);
  EXPECT_NEAR(on_top->z, 0, 1e-5);
  EXPECT_NEAR(glm::distance(Vec3(on_top->x, on_top->y, 0), Vec3(20, 20, 0)), 10, 0.5)
      << "at the rim, where it is seen";
  tool.origin_mm = {-9.95, 20, -8};  // beside the block, and into its side
  const auto on_side = place_on_workpiece(bodies.back(), tool, *stock);
  ASSERT_TRUE(on_side);
  EXPECT_NEAR(on_side->x, 0, 1e-5);
  EXPECT_NEAR(on_side->y, 20, 1.5);
  tool.origin_mm = {20, 20, 10};
  EXPECT_FALSE(place_on_workpiece(bodies.back(), tool, *stock)) << "high above";
}

}  // namespace
}  // namespace kerf
