// What must hold for any moves: order, repetition, halves, mirrors, copies.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

TurnedPart bar() { return *TurnedPart::create(bar_profile(-30, 0, 40)); }

/// One step of the grid all round: what rounding may change.
double rounding_mm3(const TurnedPart& part) {
  double around = 0;
  for (const std::vector<Vec2>& ring : part.profile()) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      around += glm::distance(ring[i], ring[(i + 1) % ring.size()]) * 2 * kPi * ring[i].y;
  }
  return 1e-5 * around;
}

struct Program {
  std::vector<TurningTool> tools;
  std::vector<TurnMove> moves;
};

Program random_program(unsigned seed, int moves) {
  std::mt19937 random(seed);
  Program program;
  program.moves = random_moves(random, moves);
  for (int i = 0; i < moves; ++i)
    program.tools.push_back(i % 4 == 0 ? TurningTool(random_tool(random)) : program.tools.back());
  return program;
}

TurnedPart cut(const Program& program) {
  TurnedPart part = bar();
  for (std::size_t i = 0; i < program.moves.size(); ++i)
    part.cut(program.tools[i], program.moves[i]);
  return part;
}

TEST(TurningProperties, a_move_cut_twice_changes_nothing) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Program program = random_program(seed, 10);
    TurnedPart part = cut(program);
    const double remaining = part.remaining_mm3();
    // What came free went beside the tool's way: nothing more is met.
    double removed = 0;
    for (std::size_t i = 0; i < program.moves.size(); ++i)
      removed += part.cut(program.tools[i], program.moves[i]).removed_mm3;
    EXPECT_NEAR(part.remaining_mm3(), remaining, rounding_mm3(part)) << "seed " << seed;
    EXPECT_LE(std::abs(removed), rounding_mm3(part));
  }
}

TEST(TurningProperties, a_straight_move_along_the_axis_cut_twice_has_equal_bits) {
  TurnedPart part = bar();
  const TurningTool tool(right_hand(0.8));
  const std::vector<Vec2> way{{2, 18}, {-20, 18}, {-19.5, 18.5}, {2, 18.5},
                              {2, 16}, {-15, 16}, {-15, 19},     {2, 19}};
  cut_along(part, tool, way);
  const std::string digest = part.digest();
  const TurnedPart before = part;
  EXPECT_EQ(cut_along(part, tool, way), 0);
  EXPECT_EQ(part.digest(), digest);
  for (std::size_t band = 0; band < TurnedPart::kBands; ++band)
    EXPECT_EQ(part.band_version(band), before.band_version(band)) << band;
}

TEST(TurningProperties, moves_in_another_order_leave_the_same) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Program program = random_program(seed, 10);
    const TurnedPart forward = cut(program);
    if (!forward.freed().empty()) continue;  // what falls is not cut later
    std::reverse(program.moves.begin(), program.moves.end());
    std::reverse(program.tools.begin(), program.tools.end());
    const TurnedPart backward = cut(program);
    if (!backward.freed().empty()) continue;
    EXPECT_NEAR(forward.remaining_mm3(), backward.remaining_mm3(), rounding_mm3(forward))
        << "seed " << seed;
  }
}

TEST(TurningProperties, a_move_in_halves_leaves_what_the_whole_one_leaves) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Program program = random_program(seed, 6);
    Program halves;
    for (std::size_t i = 0; i < program.moves.size(); ++i) {
      TurnMove first = program.moves[i], second = first;
      first.to_mm = second.from_mm = place_at(program.moves[i], 0.5);
      if (first.arc) first.arc->sweep_rad = second.arc->sweep_rad = first.arc->sweep_rad / 2;
      halves.moves.insert(halves.moves.end(), {first, second});
      halves.tools.insert(halves.tools.end(), {program.tools[i], program.tools[i]});
    }
    const TurnedPart whole = cut(program), parted = cut(halves);
    // Chords of an arc in halves are others: 0.02 um more.
    EXPECT_NEAR(whole.remaining_mm3(), parted.remaining_mm3(), 3 * rounding_mm3(whole))
        << "seed " << seed;
  }
}

TEST(TurningProperties, mirrored_programs_leave_mirrored_parts) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const InsertOutline outline = random_tool(random);
    const std::vector<TurnMove> moves = random_moves(random, 8);
    TurnedPart part = bar();
    TurnedPart mirror = *TurnedPart::create(bar_profile(0, 30, 40), ChuckSide::kHighZ);
    TurnedPart below = bar();
    const TurningTool tool(outline), other(mirrored_in_z(outline)), back(mirrored_in_x(outline));
    for (const TurnMove& move : moves) {
      const auto reflected = [&](const Vec2& factor) {
        TurnMove turned = move;
        turned.from_mm *= factor;
        turned.to_mm *= factor;
        if (turned.arc) {
          turned.arc->center_mm *= factor;
          turned.arc->sweep_rad = -turned.arc->sweep_rad;
        }
        return turned;
      };
      const TurnCut cut = part.cut(tool, move);
      const TurnCut same = mirror.cut(other, reflected({-1, 1}));
      const TurnCut under = below.cut(back, reflected({1, -1}));
      EXPECT_NEAR(cut.depth_mm, same.depth_mm, 1e-4) << "seed " << seed;
      EXPECT_NEAR(cut.depth_mm, under.depth_mm, 1e-4) << "seed " << seed;
    }
    EXPECT_NEAR(part.remaining_mm3(), mirror.remaining_mm3(), rounding_mm3(part)) << seed;
    EXPECT_NEAR(part.remaining_mm3(), below.remaining_mm3(), rounding_mm3(part)) << seed;
    EXPECT_EQ(part.freed().size(), mirror.freed().size()) << seed;
  }
}

TEST(TurningProperties, copies_are_cut_apart_and_share_the_rest) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Program program = random_program(seed, 16);
    const std::string whole = cut(program).digest();
    TurnedPart part = bar();
    std::vector<TurnedPart> copies;
    std::vector<std::string> digests;
    for (std::size_t i = 0; i < program.moves.size(); ++i) {
      copies.push_back(part);
      digests.push_back(part.digest());
      part.cut(program.tools[i], program.moves[i]);
    }
    EXPECT_EQ(part.digest(), whole) << "seed " << seed;
    for (std::size_t i = 0; i < copies.size(); ++i) EXPECT_EQ(copies[i].digest(), digests[i]);
    // From any of them on it ends with equal bits.
    for (std::size_t i = 7; i < copies.size(); ++i)
      copies[7].cut(program.tools[i], program.moves[i]);
    EXPECT_EQ(copies[7].digest(), whole);
  }
}

/// Contours cross neither themselves nor each other, sides add up to at least the depth, and what
/// is gone was removed or fell: also with noses of some grid steps, and in ways of hundreds of
/// moves.
TEST(TurningProperties, contours_stay_simple) {
  for (const double r : {0.0, 0.0005, 0.01, 0.4}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> unit(-1, 1);
      TurnedPart part = *TurnedPart::create(tube_profile(-30, 0, 40, 1));
      const TurningTool tool(*iso_insert({"CDEKMPSTVW"[seed], 9.525, r, 2, radians(93)}));
      Vec2 at(2, 22);
      double gone = 0;
      for (unsigned i = 0; i < 120; ++i) {
        TurnMove move = line(at, at + Vec2{3 * unit(random) - 0.05, 2 * unit(random)}, i);
        move.to_mm = glm::clamp(move.to_mm, Vec2(-28, 4), Vec2(3, 22));
        if (i % 3 == 0) move.to_mm.x = at.x;
        if (i % 7 == 3)
          move = arc(at, at + 2.0 * Vec2{unit(random), unit(random)}, 0.3 * unit(random), i);
        at = move.to_mm;
        const TurnCut cut = part.cut(tool, move);
        gone += cut.removed_mm3;
        ASSERT_GE(cut.removed_mm3, 0);
        double sides = 0;
        for (const double side : cut.side_mm) sides += side;
        ASSERT_LE(cut.depth_mm, sides + 0.02) << "r " << r << " seed " << seed << " move " << i;
      }
      for (const TurnedPiece& piece : part.freed()) gone += piece.volume_mm3;
      // But for moves that cut next to nothing.
      EXPECT_NEAR(part.blank_mm3() - gone, part.remaining_mm3(), rounding_mm3(part));
      turning::Rings rings, simple;
      std::int64_t area2 = 0, simple2 = 0;
      for (const turning::Contour& contour : part.contours()) {
        rings.push_back(contour.ring());
        area2 += contour.area2();
      }
      ClipperLib::SimplifyPolygons(rings, simple, ClipperLib::pftNonZero);
      for (const turning::Ring& ring : simple) simple2 += plane::twice_area(ring);
      EXPECT_EQ(area2, simple2) << "r " << r << " seed " << seed;
      EXPECT_EQ(part.library_calls(), 0u);
    }
  }
}

TEST(TurningProperties, bands_tell_where_something_changed) {
  TurnedPart part = *TurnedPart::create(bar_profile(-64, 0, 40));  // bands of 1 mm
  const TurnedPart before = part;
  part.cut(TurningTool(*groove_insert({2, 0, 20, 2})), line({-20.5, 25}, {-20.5, 15}));
  for (std::size_t band = 0; band < TurnedPart::kBands; ++band) {
    // From z -20.5 to -18.5: bands from -21 to -18.
    const bool touched = band >= 43 && band <= 45;
    EXPECT_EQ(part.band_version(band) != before.band_version(band), touched) << band;
  }
  EXPECT_DOUBLE_EQ(part.band_low_z_mm(43), -21);
}

TEST(TurningProperties, numbers_that_are_none_and_far_places_cut_nothing) {
  TurnedPart part = bar();
  const std::string digest = part.digest();
  const TurningTool tool(right_hand(0.4));
  const double nan = std::nan(""), far = 1e300;
  EXPECT_EQ(part.cut(tool, line({nan, 0}, {0, 0})).removed_mm3, 0);
  EXPECT_EQ(part.cut(tool, line({far, 5}, {far, -5})).removed_mm3, 0);
  TurnMove wide = arc({0, 10}, {0, 0}, 0.25);
  wide.arc->center_mm = {far, 0};
  EXPECT_EQ(part.cut(tool, wide).removed_mm3, 0);
  EXPECT_EQ(part.digest(), digest);
  // A way from far beyond is cut where it matters.
  const TurnCut cut = part.cut(tool, line({1e9, 18}, {-1e9, 18}));
  EXPECT_NEAR(cut.removed_mm3, cylinder_mm3(40, 30) - cylinder_mm3(36, 30), 1e-3);
}

}  // namespace
}  // namespace kerf
