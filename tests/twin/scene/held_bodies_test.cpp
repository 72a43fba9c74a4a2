// Chuck, jaws and tailstock in views, and findings of turned parts as pictures.
#include "twin/scene/held_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <random>
#include <utility>

#include "stock/cutter/shape_spec.h"
#include "stock/turning/turning_stock.h"
#include "twin/machines/builtin_parts.h"
#include "twin/scene/body_watch.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/finding_picture.h"
#include "twin/scene/turned_finding_view.h"

namespace kerf {
namespace {

/// A bar of 40 x 60, its end in the chuck's face; jaws of 120 mm stand out by 25, a centre of 12 mm
/// goes 3 mm deep into the other end.
CollisionWishes held_bar() {
  CollisionWishes wishes;
  wishes.holding.chuck = *parse_chuck("160:80:120:25");
  wishes.holding.tailstock = *parse_tailstock("12:60:at=-3");
  auto bodies = holding_bodies(wishes.holding, bar_profile(-60, 0, 40));
  wishes.held_by = std::make_shared<const std::vector<HoldingBody>>(std::move(*bodies));
  return wishes;
}

std::shared_ptr<const Cutter> turning_tool(const char* shape) {
  return std::make_shared<const Cutter>(parse_shape(shape).value());
}

TurnedProfile square(double low, double high) {
  return {{{low, low}, {high, low}, {high, high}, {low, high}}};
}

TEST(FlatGap, IsThatOfClosedForms) {
  // 3 along z, 4 along x: 5.
  const auto apart = gap_between(square(0, 2), {0, 10}, {{{5, 16}, {9, 16}, {9, 20}, {5, 20}}});
  ASSERT_TRUE(apart);
  EXPECT_NEAR(apart->mm, 5, 1e-12);
  EXPECT_EQ(apart->depth_mm, 0);
  EXPECT_NEAR(apart->at_mm.x, 3.5, 1e-12);
  EXPECT_NEAR(apart->at_mm.y, 14, 1e-12);
  // A corner 0.5 deep.
  const auto in = gap_between(square(0, 2), {0, 10}, {{{1.5, 11}, {9, 11}, {9, 20}, {1.5, 20}}});
  EXPECT_EQ(in->mm, 0);
  EXPECT_NEAR(in->depth_mm, 0.5, 1e-12);
  // A bar through a slot's walls: no corner of either is in the other.
  const auto through = gap_between({{{-9, 3}, {9, 3}, {9, 4}, {-9, 4}}}, {0, 0}, square(-5, 5));
  EXPECT_EQ(through->mm, 0);
  EXPECT_GT(through->depth_mm, 0);
  // Beyond the axis the body is as on this side: from x = -6 to -4 a body at 3 is 1 away.
  const auto beyond = gap_between(square(0, 2), {0, -6}, {{{0, 0}, {2, 0}, {2, 3}, {0, 3}}});
  EXPECT_NEAR(beyond->mm, 1, 1e-12);
  EXPECT_LT(beyond->at_mm.y, 0);
  EXPECT_FALSE(gap_between({}, {0, 0}, square(0, 1)));
}

/// The boundary in steps of about `step_mm`.
std::vector<Vec2> sampled(const TurnedProfile& profile, double step_mm) {
  std::vector<Vec2> points;
  for (const auto& chain : profile) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const Vec2 a = chain[i], b = chain[(i + 1) % chain.size()];
      const int count = 1 + static_cast<int>(glm::distance(a, b) / step_mm);
      for (int k = 0; k < count; ++k)
        points.push_back(glm::mix(a, b, static_cast<double>(k) / count));
    }
  }
  return points;
}

TEST(FlatGap, IsThatOfPointsAllAlongTheOutlines) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(1, 6), place(-8, 8);
  for (int n = 0; n < 40; ++n) {
    const auto triangle = [&] {
      const double s = side(random);
      return TurnedProfile{{{0, 0}, {s, 0.3 * s}, {0.2 * s, s}}};
    };
    const TurnedProfile tool = triangle();
    TurnedProfile body = triangle();
    for (Vec2& p : body[0]) p += Vec2(0, 12);
    const Vec2 at(place(random), 2);
    TurnedProfile placed = tool;
    for (Vec2& p : placed[0]) p += at;
    constexpr double kStep_mm = 0.02;
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Vec2> others = sampled(body, kStep_mm);
    for (const Vec2& p : sampled(placed, kStep_mm))
      for (const Vec2& q : others) least = std::min(least, glm::distance(p, q));
    const auto gap = gap_between(tool, at, body);
    ASSERT_TRUE(gap);
    if (gap->mm == 0) continue;  // they overlap: the outlines cross, or one is in the other
    EXPECT_NEAR(gap->mm, least, kStep_mm) << n;
  }
}

/// Each edge has a triangle on either side.
bool is_whole(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  return std::ranges::all_of(edges, [&](const auto& edge) {
    return edge.second == 1 && edges.contains({edge.first.second, edge.first.first});
  });
}

/// By Gauss.
double enclosed_mm3(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

TEST(HeldBodies, AreDrawnAsLargeAsWhatIsChecked) {
  const std::vector<MachineLink> links = held_links(held_bar().held_by);
  ASSERT_EQ(links.size(), 3u);
  EXPECT_EQ(links[0].name, "chuck");
  EXPECT_EQ(links[1].name, "jaws");
  EXPECT_EQ(links[2].name, "tailstock");
  for (const MachineLink& link : links) {
    EXPECT_TRUE(is_whole(*link.mesh)) << link.name;
    EXPECT_LT(link.color >> 24, 0xffu) << "the part is to be seen through it";
  }
  const double ring_mm3 = kPi * 25 * (60 * 60 - 20 * 20);
  EXPECT_NEAR(enclosed_mm3(*links[1].mesh), ring_mm3, 0.005 * ring_mm3);
  EXPECT_TRUE(held_links(nullptr).empty());
  EXPECT_EQ(picture_bodies(held_bar().held_by).size(), 3u);
}

TEST(HeldBodies, ClearanceIsInThePlaneOfTheAxis) {
  BodyWatch watch(held_bar());
  EXPECT_EQ(watch.scene()->links.size(), 3u);
  EXPECT_EQ(watch.poses().size(), 3u);
  watch.mount(turning_tool("turn:0.4:2:85:30"), 0);
  Moment moment;
  // Orientation 2: the point lies at low z and x. The jaws end at Z-35, and at X60.
  watch.look({{40, 0, -30}, {0, 0, 1}}, 0, 0, nullptr, &moment);
  ASSERT_TRUE(moment.clearance);
  EXPECT_NEAR(moment.clearance->mm, 5, 0.01);
  EXPECT_EQ(moment.clearance->fixture, "jaws");
  EXPECT_EQ(moment.clearance->piece, "cutter");
  EXPECT_TRUE(moment.contacts.empty());
  watch.look({{40, 0, -36}, {0, 0, 1}}, 0, 0, nullptr, &moment);
  ASSERT_FALSE(moment.contacts.empty());
  EXPECT_EQ(moment.clearance->mm, 0);
  EXPECT_EQ(moment.contacts[0].piece, ToolPiece::kCutter);
  EXPECT_EQ(moment.contacts[0].fixture, 1u);
  // A driven tool does not lie in that plane.
  watch.mount(turning_tool("flat:6:live=x"), 0);
  Moment driven;
  watch.look({{40, 0, -36}, {0, 0, 1}}, 0, 0, nullptr, &driven);
  EXPECT_FALSE(driven.clearance);
  EXPECT_TRUE(driven.contacts.empty());
}

TEST(HeldBodies, FindingsNameThem) {
  BodyWatch watch(held_bar());
  Finding finding;
  finding.id = FindingId::kJawContact;
  finding.bodies = {"holder", "jaws"};
  const auto contact = contact_of(finding, watch.drawn());
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->piece, ToolPiece::kHolder);
  EXPECT_EQ(contact->fixture, 1u);
}

TEST(HeldBodies, TheLatheHasTheChuckThatIsDescribed) {
  const auto room = chuck_room(held_bar().held_by);
  ASSERT_TRUE(room);
  EXPECT_NEAR(room->diameter_mm, 160, 1e-6);
  EXPECT_NEAR(room->length_mm, 80, 1e-6);
  EXPECT_NEAR(room->face_z_mm, -60, 1e-6);
  EXPECT_NEAR(room->jaw_diameter_mm, 120, 1e-6);
  EXPECT_NEAR(room->jaw_length_mm, 25, 1e-6);
  EXPECT_FALSE(chuck_room(nullptr));
  MachineRoom around;
  around.blank_mm = {{-20, -20, -60}, {20, 20, 0}};
  around.machine_from_workpiece = Pose{glm::dmat3(1.0), {0, 0, 9}};
  around.chuck = room;
  const MachineModel lathe = build_lathe(around);
  Box box;
  for (const LinkShape& link : lathe.links) {
    if (link.name != "chuck") continue;
    EXPECT_TRUE(is_whole(*link.mesh));
    for (const glm::vec3& p : link.mesh->positions_mm) box.extend(Vec3(p));
  }
  // Within the rings, by half a millimetre: they do not flicker in each other.
  EXPECT_NEAR(box.max.z, -60 + 9 + 25 - 1, 1.0);
  EXPECT_LT(box.max.z, -60 + 9 + 25);
  EXPECT_NEAR(box.min.z, -60 + 9 - 80, 1.0);
  EXPECT_LT(box.max.y, 80);
  EXPECT_GT(box.max.y, 78);
}

/// A bar of 40 x 60 with a bore of 20, a boring tool in it.
FindingShot shot_in_bore() {
  FindingShot shot;
  const TurningStock stock(*TurnedPart::create(tube_profile(-60, 0, 40, 20)));
  shot.stock = stock.snapshot();
  shot.cutter = turning_tool("turn:0.4:3:275:335");
  shot.tool = {{10, 0, -20}, {0, 0, 1}};
  shot.finding.id = FindingId::kRapidContact;
  shot.message = "traverse touches the workpiece";
  return shot;
}

TEST(TurnedFindingView, LooksIntoABore) {
  BodyWatch watch(held_bar());
  FindingShot shot = shot_in_bore();
  ASSERT_TRUE(is_turned_shot(shot));
  FindingView view = finding_view(shot, watch);
  EXPECT_TRUE(view.is_flat);
  EXPECT_TRUE(view.is_inside);
  EXPECT_EQ(view.standing, Standing::kInLathe);
  EXPECT_EQ(view.place_mm, shot.tool.tip_mm) << "a finding of one body";
  shot.tool.tip_mm = {20, 0, -20};
  EXPECT_FALSE(finding_view(shot, watch).is_inside) << "on the outside nothing stands before it";
  shot.cutter = turning_tool("flat:6:live=x");
  EXPECT_FALSE(is_turned_shot(shot));
  view = finding_view(shot, watch);
  EXPECT_FALSE(view.is_flat);
  EXPECT_EQ(view.standing, Standing::kInLathe);
}

TEST(TurnedFindingView, ThePlaceIsWhereTheOutlinesMeet) {
  BodyWatch watch(held_bar());
  FindingShot shot = shot_in_bore();
  shot.cutter = turning_tool("turn:0.4:2:85:30");
  shot.tool.tip_mm = {40, 0, -35.05};  // 0.05 into the face of the jaws
  shot.finding.id = FindingId::kJawContact;
  shot.finding.bodies = {"cutter", "jaws"};
  const FindingView view = finding_view(shot, watch);
  ASSERT_TRUE(view.contact);
  EXPECT_NEAR(view.place_mm.z, -35.05, 0.05);
  EXPECT_NEAR(view.place_mm.x, 40.4, 0.2);
  EXPECT_EQ(view.tool_name, "cutter");
  EXPECT_EQ(view.other_name, "jaws");
  ASSERT_TRUE(view.other_mm);
  EXPECT_FALSE(view.close_mm.empty());
  EXPECT_FALSE(view.is_inside);
}

int red_of(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    count += picture.rgb[i] > 110 && picture.rgb[i + 1] < picture.rgb[i] / 2 &&
             picture.rgb[i + 2] < picture.rgb[i] / 2;
  }
  return count;
}

/// Of the hatched face of a section.
int hatched_of(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
    count += picture.rgb[i] > 150 && picture.rgb[i] - picture.rgb[i + 2] > 60 &&
             picture.rgb[i + 1] > picture.rgb[i] / 2;
  return count;
}

TEST(TurnedFindingPicture, IsRedAndCutOpenWhereItIsInside) {
  unsetenv("DISPLAY");
  Result<FindingPictures> pictures = FindingPictures::create(held_bar(), nullptr, {640, 480});
  ASSERT_TRUE(pictures) << pictures.error();
  FindingShot shot = shot_in_bore();
  const Result<Picture> inside = pictures->draw(shot);
  ASSERT_TRUE(inside) << inside.error();
  EXPECT_GT(hatched_of(*inside), 10000);
  EXPECT_EQ(red_of(*inside), 0);
  shot.cutter = turning_tool("turn:0.4:2:85:30");
  shot.tool.tip_mm = {40, 0, -36};
  shot.finding.id = FindingId::kJawContact;
  shot.finding.bodies = {"cutter", "jaws"};
  const Result<Picture> jaws = pictures->draw(shot);
  ASSERT_TRUE(jaws) << jaws.error();
  EXPECT_GT(red_of(*jaws), 10000);
  EXPECT_LT(hatched_of(*jaws), hatched_of(*inside) / 2) << "the section is of the picture before";
}

}  // namespace
}  // namespace kerf
