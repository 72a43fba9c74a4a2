// What moves of a lathe's work are reported as: depths, sides, contacts, pieces that come off.
#include <gtest/gtest.h>

#include "tests/stock/turning/turning_samples.h"

namespace kerf {
namespace {

using namespace turning_test;

constexpr double kNear_mm = 1e-4;

double side(const TurnCut& cut, InsertSide which) {
  return cut.side_mm[static_cast<std::size_t>(which)];
}

TurnedPart bar(double length = 60) { return *TurnedPart::create(bar_profile(-length, 0, 40)); }

TEST(TurningCuts, depth_is_across_the_way_whatever_the_way) {
  const TurningTool tool(right_hand(0));
  TurnedPart part = bar();
  EXPECT_NEAR(part.cut(tool, line({2, 17.5}, {-20, 17.5})).depth_mm, 2.5, kNear_mm);
  // The same pass once more finds nothing.
  const TurnCut again = part.cut(tool, line({2, 17.5}, {-20, 17.5}));
  EXPECT_EQ(again.depth_mm, 0);
  EXPECT_EQ(again.removed_mm3, 0);
  EXPECT_EQ(again.way_mm, 0);
  // A cut at 45 degrees through the step: from beside the shoulder, whose height is 2.5.
  const TurnCut slope = part.cut(TurningTool(round_insert(3)), line({-17, 30}, {-30, 17}));
  EXPECT_GT(slope.depth_mm, 5.9);
  EXPECT_LE(slope.depth_mm, 6 + kNear_mm);
}

/// The nose's place at a shoulder is left twice: by the cut that ends there, and by the way out
/// that begins there. The chords of the two differ by some 0.1 um, over lengths of 20 um.
TEST(TurningCuts, leaving_a_shoulder_meets_nothing) {
  for (const double radius : {0.1, 0.2, 0.4, 0.8, 1.2, 2.4}) {
    for (const double degrees : {35.0, 45.0, 63.4, 70.0, 80.0}) {
      const TurningTool tool(*nose_insert({radius, 2, radians(85), radians(30), 12}));
      TurnedPart part = bar();
      part.cut(tool, line({2, 17.5}, {-20, 17.5}));
      const Vec2 out = 2.0 * Vec2(std::cos(radians(degrees)), std::sin(radians(degrees)));
      const TurnCut cut = part.cut(tool, line({-20, 17.5}, Vec2(-20, 17.5) + out));
      EXPECT_EQ(side(cut, InsertSide::kBody), 0) << radius << " " << degrees;
      EXPECT_EQ(cut.depth_mm, 0) << radius << " " << degrees;
    }
  }
}

TEST(TurningCuts, way_is_how_long_the_tool_was_in_material) {
  TurnedPart part = bar();
  // A groove from z = -12 to -10 in the way of a pass.
  part.cut(TurningTool(*groove_insert({2, 0, 20, 2})), line({-12, 25}, {-12, 15}));
  const TurnCut cut = part.cut(TurningTool(right_hand(0)), line({5, 18}, {-30, 18}));
  // The front flank leans by 5 degrees from the radial: the groove is passed while it is in both.
  const double lean = 2 * std::tan(radians(5));
  EXPECT_NEAR(cut.way_mm, 30 - 2 + lean, 1e-3);
  EXPECT_NEAR(cut.depth_mm, 2, kNear_mm);
}

TEST(TurningCuts, parts_of_an_outline_are_one_tool) {
  // A blade of 2 mm with a shoulder of 6 mm that is 5 mm behind its front.
  InsertOutline stepped = *groove_insert({2, 0, 20, 6});
  InsertOutline shoulder = *groove_insert({6, 0, 20, 6});
  for (InsertEdge& edge : shoulder.parts[0]) {
    edge.end_mm.y += 5;
    edge.side = InsertSide::kBody;
  }
  stepped.parts.push_back(shoulder.parts[0]);
  TurnedPart part = bar();
  const TurnCut cut = part.cut(TurningTool(stepped), line({-20, 21}, {-20, 13}));
  EXPECT_NEAR(cut.removed_mm3,
              cylinder_mm3(40, 2) - cylinder_mm3(26, 2) + cylinder_mm3(40, 4) - cylinder_mm3(36, 4),
              1e-3);
  EXPECT_NEAR(cut.way_mm, 7, kNear_mm);
  EXPECT_NEAR(side(cut, InsertSide::kNose), 2, kNear_mm);
  EXPECT_NEAR(side(cut, InsertSide::kBody), 4, kNear_mm);
  // The shoulder is met later than the blade.
  const std::optional<TurnContact> contact =
      bar().first_contact(TurningTool(stepped), line({-20, 21}, {-20, 13}));
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->t, 1.0 / 8, 1e-6);
}

/// Chips are as thin as the edge leans: its width across the way over its length.
TEST(TurningCuts, edges_in_material_are_told) {
  for (const double front_deg : {85.0, 60.0, 45.0}) {
    TurnedPart part = bar();
    const TurningTool sharp(*nose_insert({0, 2, radians(front_deg), radians(10), 12}));
    const TurnCut cut = part.cut(sharp, line({2, 17.5}, {-20, 17.5}));
    EXPECT_NEAR(cut.edge_across_mm, 2.5, 1e-3) << front_deg;
    EXPECT_NEAR(cut.edge_mm, 2.5 / std::sin(radians(front_deg)), 1e-3) << front_deg;
  }
  // A nose of 0.8 mm from along the way to 5 degrees beyond the radial one, then the flank.
  TurnedPart part = bar();
  const TurnCut cut = part.cut(TurningTool(right_hand(0.8)), line({2, 17}, {-20, 17}));
  const double nose = 0.8 * (1 + std::sin(radians(5)));
  EXPECT_NEAR(cut.edge_across_mm, 3, 1e-3);
  EXPECT_NEAR(cut.edge_mm, 0.8 * radians(95) + (3 - nose) / std::cos(radians(5)), 0.02);
}

TEST(TurningCuts, sides_that_cut_are_told) {
  // Longitudinal turning: nose, and the front flank for what is deeper than the nose.
  TurnedPart part = bar();
  const TurningTool tool(right_hand(0.8));
  const TurnCut rough = part.cut(tool, line({2, 17}, {-20, 17}));
  // The nose goes from the tangent along the way to the front flank's tangent, 5 degrees beyond
  // the radial one.
  const double nose = 0.8 * (1 + std::sin(radians(5)));
  EXPECT_NEAR(side(rough, InsertSide::kNose), nose, kNear_mm);
  EXPECT_NEAR(side(rough, InsertSide::kFront), 3 - nose, kNear_mm);
  EXPECT_EQ(side(rough, InsertSide::kBack), 0);
  EXPECT_EQ(side(rough, InsertSide::kBody), 0);
  // Pulled back along +z into the shoulder of a groove: the back flank.
  part.cut(TurningTool(*groove_insert({8, 0, 20, 2})), line({-40, 25}, {-40, 12}));
  const TurnCut drag = part.cut(tool, line({-38, 15}, {-28, 15}));
  EXPECT_GT(side(drag, InsertSide::kBack), 3);
  EXPECT_EQ(side(drag, InsertSide::kFront), 0);
}

TEST(TurningCuts, a_plunge_that_is_too_steep_for_the_back_flank_is_told) {
  // The back flank leans by 30 degrees; a way down at 40 makes it cut, one at 20 does not.
  for (const double degrees : {20.0, 40.0}) {
    TurnedPart part = bar();
    const TurningTool tool(right_hand(0.4));
    const Vec2 way(-8, -8 * std::tan(radians(degrees)));
    const TurnCut cut = part.cut(tool, line({-10, 20.5}, Vec2(-10, 20.5) + way));
    EXPECT_EQ(side(cut, InsertSide::kBack) > 0.01, degrees > 30) << degrees;
    EXPECT_GT(side(cut, InsertSide::kFront), 0);
  }
}

TEST(TurningCuts, the_first_contact_is_exact_on_straight_ways) {
  const TurnedPart part = bar();
  const TurningTool tool(right_hand(0.4));
  // From z = 5 to -5, the nose 1 mm deep: its tangent in the way meets the face at z = 0.
  const std::optional<TurnContact> contact = part.first_contact(tool, line({5, 19}, {-5, 19}));
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->t, 0.5, 1e-5);
  EXPECT_NEAR(contact->at_mm.x, 0, 1e-4);
  EXPECT_NEAR(contact->depth_mm, 1, kNear_mm);
  // A rapid from the side that goes 0.3 mm deep.
  const std::optional<TurnContact> plunge = part.first_contact(tool, line({-20, 25}, {-20, 19.7}));
  ASSERT_TRUE(plunge);
  EXPECT_NEAR(plunge->t, 5 / 5.3, 1e-5);
  EXPECT_NEAR(plunge->depth_mm, 0.3, 1e-3);
}

TEST(TurningCuts, what_only_touches_is_no_contact) {
  const TurnedPart part = bar();
  const TurningTool tool(right_hand(0.4));
  EXPECT_FALSE(part.first_contact(tool, line({-5, 20}, {-40, 20})));
  EXPECT_FALSE(part.first_contact(tool, line({0, 30}, {0, 5})));
  // 0.05 mm deep, with 0.1 mm allowed, and with 0.02.
  EXPECT_FALSE(part.first_contact(tool.inset(0.1), line({-5, 19.95}, {-40, 19.95})));
  EXPECT_TRUE(part.first_contact(tool.inset(0.02), line({-5, 19.95}, {-40, 19.95})));
}

TEST(TurningCuts, a_tool_that_begins_in_material_has_met_it) {
  const TurnedPart part = bar();
  const TurningTool tool(right_hand(0.4));
  const std::optional<TurnContact> contact = part.first_contact(tool, line({-20, 15}, {-20, 25}));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->t, 0);
  EXPECT_GT(contact->depth_mm, 2);
  EXPECT_TRUE(part.first_contact(tool, line({-20, 15}, {-20, 15})));
  EXPECT_FALSE(part.first_contact(tool, line({-20, 25}, {-20, 25})));
}

TEST(TurningCuts, part_off_leaves_what_the_chuck_holds) {
  const TurningTool tool(*groove_insert({3, 0.2, 25, 2}));
  for (const ChuckSide chuck : {ChuckSide::kLowZ, ChuckSide::kHighZ}) {
    TurnedPart part = *TurnedPart::create(bar_profile(-60, 0, 40), chuck);
    // To the axis and a little past it, since the corners are round.
    const TurnCut cut = part.cut(tool, line({-25, 22}, {-25, -0.5}, 12));
    EXPECT_NEAR(cut.removed_mm3, cylinder_mm3(40, 3), 1e-3);
    ASSERT_EQ(part.freed().size(), 1u);
    const TurnedPiece& piece = part.freed()[0];
    EXPECT_EQ(piece.freed_by, 12u);
    if (chuck == ChuckSide::kLowZ) {
      EXPECT_NEAR(piece.volume_mm3, cylinder_mm3(40, 22), 1e-3);
      EXPECT_DOUBLE_EQ(piece.low_z_mm, -22);
      EXPECT_DOUBLE_EQ(piece.high_z_mm, 0);
      EXPECT_NEAR(part.remaining_mm3(), cylinder_mm3(40, 35), 1e-3);
    } else {
      EXPECT_NEAR(piece.volume_mm3, cylinder_mm3(40, 35), 1e-3);
      EXPECT_DOUBLE_EQ(piece.low_z_mm, -60);
      EXPECT_NEAR(part.remaining_mm3(), cylinder_mm3(40, 22), 1e-3);
    }
    EXPECT_DOUBLE_EQ(piece.low_r_mm, 0);
    EXPECT_DOUBLE_EQ(piece.high_r_mm, 20);
  }
}

TEST(TurningCuts, a_pip_holds_the_piece) {
  TurnedPart part = bar();
  const TurningTool tool(*groove_insert({3, 0, 25, 2}));
  part.cut(tool, line({-25, 22}, {-25, 0.05}));
  EXPECT_TRUE(part.freed().empty());
  EXPECT_EQ(part.contours().size(), 1u);
  // Exactly to the axis it falls: nothing holds by a line.
  part.cut(tool, line({-25, 0.05}, {-25, 0}));
  EXPECT_EQ(part.freed().size(), 1u);
}

TEST(TurningCuts, a_tube_is_parted_when_the_bore_is_reached) {
  TurnedPart part = *TurnedPart::create(tube_profile(-60, 0, 40, 20));
  const TurningTool tool(*groove_insert({3, 0, 25, 2}));
  part.cut(tool, line({-25, 22}, {-25, 10.001}));
  EXPECT_TRUE(part.freed().empty());
  part.cut(tool, line({-25, 10.001}, {-25, 9.5}));
  ASSERT_EQ(part.freed().size(), 1u);
  EXPECT_NEAR(part.freed()[0].volume_mm3, cylinder_mm3(40, 22) - cylinder_mm3(20, 22), 1e-6);
}

TEST(TurningCuts, a_face_groove_cuts_a_ring_out) {
  // A ring groove through a disc of 10 mm: the core falls, the rim is held.
  TurnedPart part = *TurnedPart::create(bar_profile(-10, 0, 40));
  GrooveInsert blade{2, 0, 20, 5, true};
  const TurningTool tool(*groove_insert(blade));
  // Orientation 5: the blade points to +z, from behind the disc.
  part.cut(tool, line({-15, 12}, {1, 12}));
  ASSERT_EQ(part.freed().size(), 1u);
  EXPECT_NEAR(part.freed()[0].volume_mm3, cylinder_mm3(22, 10), 1e-3);
  EXPECT_NEAR(part.remaining_mm3(), cylinder_mm3(40, 10) - cylinder_mm3(26, 10), 1e-3);
}

TEST(TurningCuts, a_void_inside_is_kept_and_falls_with_its_piece) {
  // A bar with a closed ring of air in it, as a profile may have.
  TurnedPart part = *TurnedPart::create(
      {{{-60, 0}, {0, 0}, {0, 20}, {-60, 20}}, {{-15, 5}, {-10, 5}, {-10, 10}, {-15, 10}}});
  const double air = kPi * (100 - 25) * 5;
  EXPECT_NEAR(part.blank_mm3(), cylinder_mm3(40, 60) - air, 1e-6);
  EXPECT_EQ(part.contours().size(), 2u);
  part.cut(TurningTool(*groove_insert({3, 0, 25, 2})), line({-25, 22}, {-25, 0}));
  ASSERT_EQ(part.freed().size(), 1u);
  EXPECT_NEAR(part.freed()[0].volume_mm3, cylinder_mm3(40, 22) - air, 1e-6);
  EXPECT_EQ(part.contours().size(), 1u);
}

}  // namespace
}  // namespace kerf
