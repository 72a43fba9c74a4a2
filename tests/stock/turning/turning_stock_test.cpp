// The contract of stock models, on a turned part.
#include "stock/turning/turning_stock.h"

#include <gtest/gtest.h>

#include "tests/stock/turning/turning_samples.h"

namespace kerf {
namespace {

using namespace turning_test;

Cutter rougher() { return Cutter::from_insert("turn:0.4:2:85:30", right_hand(0.4)); }
Cutter drill() {
  return *Cutter::from_profile("drill:8:118", {{ProfilePiece::Kind::kLine, 0, 0, 4, 2.4},
                                               {ProfilePiece::Kind::kLine, 4, 2.4, 4, 60}});
}

TurningStock bar() { return TurningStock(*TurnedPart::create(bar_profile(-64, 0, 40))); }

/// x is the radius, z along the axis.
CutMove move(const Vec3& from, const Vec3& to, std::uint64_t id = 0) {
  CutMove made;
  made.from_mm = from;
  made.to_mm = to;
  made.id = id;
  return made;
}

std::vector<CutMove> roughing() {
  std::vector<CutMove> moves;
  Vec3 at(25, 0, 2);
  const auto go = [&](double x, double z) {
    moves.push_back(move(at, {x, 0, z}, moves.size() + 10));
    at = {x, 0, z};
  };
  for (double x = 19; x > 12; x -= 1.5) {
    go(x, 2);
    go(x, -40 - x / 2);
    go(x + 1, -39 - x / 2);
    go(x + 1, 2);
  }
  return moves;
}

TEST(TurningStock, moves_in_any_calls_have_equal_bits_and_reports) {
  const std::vector<CutMove> moves = roughing();
  std::string digest;
  std::vector<CutReport> whole;
  for (const std::size_t size : {moves.size(), std::size_t{1}, std::size_t{3}}) {
    TurningStock stock = bar();
    std::vector<CutReport> reports;
    for (std::size_t i = 0; i < moves.size(); i += size) {
      stock.cut(rougher(), std::span(moves).subspan(i, std::min(size, moves.size() - i)), reports);
    }
    stock.finish(reports);
    ASSERT_EQ(reports.size(), moves.size());
    if (digest.empty()) {
      digest = stock.digest();
      whole = reports;
    }
    EXPECT_EQ(stock.digest(), digest);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      EXPECT_EQ(reports[i].id, i + 10);
      EXPECT_EQ(reports[i].removed_mm3, whole[i].removed_mm3);
      EXPECT_EQ(reports[i].depth_mm, whole[i].depth_mm);
    }
  }
  EXPECT_NEAR(whole[1].depth_mm, 1, 1e-4);
  EXPECT_NEAR(whole[5].depth_mm, 1.5, 0.1);
}

TEST(TurningStock, arcs_are_cut_in_the_plane_of_z_and_x) {
  // G2 and G3 of G18: about y. A quarter about z -20, x 20, of radius 6, both ways.
  CutMove there = move({20, 0, -14}, {14, 0, -20});
  there.arc = CutArc{{20, 0, -20}, {0, 1, 0}, -kPi / 2};
  CutMove back = move({14, 0, -20}, {20, 0, -14});
  back.arc = CutArc{{20, 0, -20}, {0, -1, 0}, -kPi / 2};
  const Cutter disc = Cutter::from_insert("turn:1:9", round_insert(1));
  std::string digest;
  for (const CutMove& arc : {there, back}) {
    TurningStock stock = bar();
    std::vector<CutReport> reports;
    stock.cut(disc, {&arc, 1}, reports);
    // A ring of 2 mm about the quarter, as far as it lies in the bar, and a disc's half at the end.
    EXPECT_GT(reports[0].removed_mm3, 1500);
    const std::optional<Contact> contact = bar().first_contact(disc, arc, 0.01);
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->tip_mm.z, arc.from_mm.z);
    if (digest.empty()) digest = std::to_string(reports[0].removed_mm3);
    EXPECT_NEAR(reports[0].removed_mm3, std::stod(digest), 1e-2);
  }
}

TEST(TurningStock, an_arc_about_another_axis_is_what_it_is_in_the_plane) {
  // Half a turn of G17 about z: x runs from 18 to 14 and back as seen in the plane.
  CutMove half = move({18, 0, -10}, {14, 0, -10});
  half.arc = CutArc{{16, 0, -10}, {0, 0, 1}, kPi};
  TurningStock stock = bar(), straight = bar();
  std::vector<CutReport> reports;
  const Cutter blade = Cutter::from_insert("groove:3", *groove_insert({3, 0, 20, 2}));
  stock.cut(blade, {&half, 1}, reports);
  const CutMove line = move({18, 0, -10}, {14, 0, -10});
  straight.cut(blade, {&line, 1}, reports);
  EXPECT_NEAR(reports[0].removed_mm3, reports[1].removed_mm3, 1e-3);
  EXPECT_NEAR(reports[0].removed_mm3, cylinder_mm3(40, 3) - cylinder_mm3(28, 3), 1e-3);
  // Turns without end are not counted out.
  half.arc->sweep_rad = 1e300;
  stock.cut(blade, {&half, 1}, reports);
  EXPECT_EQ(reports[2].removed_mm3, 0);
}

TEST(TurningStock, cutters_without_an_outline_stand_on_the_axis) {
  TurningStock stock = bar();
  EXPECT_TRUE(stock.accepts(drill()));
  EXPECT_TRUE(stock.accepts(rougher()));
  const Cutter hollow =
      *Cutter::from_profile("hollow", {{ProfilePiece::Kind::kLine, 0, 0, 2, 0},
                                       {ProfilePiece::Kind::kArc, 2, 0, 4, 2, 4, 0, 2, false}});
  EXPECT_FALSE(stock.accepts(hollow));
  std::vector<CutReport> reports;
  const CutMove down = move({0, 0, 5}, {0, 0, -20});
  stock.cut(drill(), {&down, 1}, reports);
  EXPECT_NEAR(reports[0].removed_mm3, cylinder_mm3(8, 17.6) + cone_mm3(4, 0, 2.4), 1e-3);
  EXPECT_NEAR(reports[0].depth_mm, 4, 1e-3);  // on either side of the axis
}

TEST(TurningStock, cutters_know_how_far_an_outline_reaches) {
  const Cutter disc = Cutter::from_insert("turn:2:6", *iso_insert({'R', 4, 2, 6, 0}));
  EXPECT_NEAR(disc.radius_mm(), 4, 1e-9);
  EXPECT_EQ(disc.spec(), "turn:2:6");
  const Cutter copy = disc;
  EXPECT_EQ(copy.insert(), disc.insert());
  EXPECT_EQ(drill().insert(), nullptr);
}

TEST(TurningStock, contacts_are_deeper_than_allowed) {
  TurningStock stock = bar();
  const CutMove along = move({19.9, 0, 5}, {19.9, 0, -30});
  const std::optional<Contact> contact = stock.first_contact(rougher(), along, 0.02);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->depth_mm, 0.1, 1e-3);
  EXPECT_LT(contact->tip_mm.z, 0.1);
  EXPECT_GT(contact->tip_mm.z, -0.5);
  EXPECT_EQ(contact->tip_mm.x, 19.9);
  EXPECT_FALSE(stock.first_contact(rougher(), along, 0.2));
  // Another tolerance is no earlier one.
  EXPECT_TRUE(stock.first_contact(rougher(), along, 0.02));
  EXPECT_TRUE(stock.first_contact(drill(), along, 0.2));  // of 4 mm radius
}

TEST(TurningStock, snapshots_stay_and_tell_their_bands) {
  TurningStock stock = bar();
  EXPECT_EQ(stock.take_dirty_tiles().size(), stock.tile_count());
  EXPECT_TRUE(stock.take_dirty_tiles().empty());
  const std::unique_ptr<StockModel> before = stock.snapshot();
  const std::string digest = before->digest();
  EXPECT_TRUE(stock.differing_tiles(*before).empty());
  std::vector<CutReport> reports;
  const CutMove plunge = move({25, 0, -20.5}, {15, 0, -20.5});
  stock.cut(Cutter::from_insert("groove:2", *groove_insert({2, 0, 20, 2})), {&plunge, 1}, reports);
  const std::vector<std::uint32_t> touched{43, 44, 45};
  EXPECT_EQ(stock.differing_tiles(*before), touched);
  EXPECT_EQ(before->differing_tiles(stock), touched);
  EXPECT_EQ(stock.take_dirty_tiles(), touched);
  EXPECT_EQ(before->digest(), digest);
  EXPECT_NE(stock.digest(), digest);
  const TurningStock other(*TurnedPart::create(bar_profile(-64, 0, 50)));
  EXPECT_EQ(stock.differing_tiles(other).size(), stock.tile_count());
  // Patches of equal versions are equal.
  for (std::uint32_t t = 0; t < stock.tile_count(); ++t) {
    if (stock.patch_version(t) != before->patch_version(t)) continue;
    const MeshPatch a = stock.patch(t, 0), b = before->patch(t, 0);
    EXPECT_EQ(a.indices, b.indices) << t;
    ASSERT_EQ(a.vertices.size(), b.vertices.size()) << t;
    for (std::size_t i = 0; i < a.vertices.size(); ++i)
      EXPECT_EQ(a.vertices[i].position_mm, b.vertices[i].position_mm);
  }
  EXPECT_EQ(stock.tile_box(43).min.z, -21);
  EXPECT_EQ(stock.tile_box(43).max, Vec3(20, 20, -20));
}

TEST(TurningStock, the_sides_of_the_last_moves_are_known) {
  TurningStock stock = bar();
  std::vector<CutReport> reports;
  const std::vector<CutMove> moves = roughing();
  stock.cut(rougher(), moves, reports);
  ASSERT_EQ(stock.last_cuts().size(), moves.size());
  EXPECT_GT(stock.last_cuts()[1].side_mm[static_cast<std::size_t>(InsertSide::kFront)], 0.5);
  EXPECT_EQ(stock.last_cuts()[1].id, moves[1].id);
  EXPECT_GT(stock.last_cuts()[1].way_mm, 25);
}

}  // namespace
}  // namespace kerf
