// Random programs against brute force: points, contacts.
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

TEST(SheetOracle, points_are_material_where_no_move_came_near) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> x(0, 60), y(0, 40);
  for (int round = 0; round < 6; ++round) {
    const double kerf = round < 3 ? 0.8 : 4;
    const std::vector<CutMove> moves = test::random_moves(random, 14);
    for (const int tiles : {1, 4, 9}) {
      const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
      test::cut(*sheet, kerf, moves);
      int cut = 0;
      for (int i = 0; i < 150; ++i) {
        const Vec2 p{x(random), y(random)};
        double least = 1e300;
        for (const CutMove& move : moves) least = std::min(least, test::distance_to_way(move, p));
        if (std::abs(least - kerf / 2) < 0.006) continue;
        cut += least < kerf / 2;
        ASSERT_EQ(sheet->has_material(p), least > kerf / 2)
            << "round " << round << " tiles " << tiles << " at " << p.x << ' ' << p.y << ' '
            << least;
      }
      EXPECT_GT(cut, 0);
    }
  }
}

/// Whether p is in an odd number of rings.
bool is_within(const PlaneOutline& outline, const Vec2& p) {
  bool inside = false;
  for (const std::vector<Vec2>& ring : outline.rings) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Vec2 &a = ring[i], &b = ring[j];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  }
  return inside;
}

TEST(SheetOracle, piece_at_is_the_piece_whose_outline_holds_the_point) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> x(0, 60), y(0, 40);
  std::size_t pieces = 0;
  for (const int tiles : {1, 3, 8}) {
    for (int round = 0; round < 4; ++round) {
      const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
      test::cut(*sheet, 0.4, test::random_moves(random, 40));
      std::vector<std::pair<std::uint32_t, PlaneOutline>> outlines;
      for (const SheetPiece& piece : sheet->pieces())
        outlines.emplace_back(piece.number, sheet->outline_of(piece.number));
      pieces += outlines.size();
      for (int i = 0; i < 100; ++i) {
        const Vec2 p{x(random), y(random)};
        std::optional<std::uint32_t> expected;
        for (const auto& [number, outline] : outlines) {
          if (is_within(outline, p)) expected = number;
        }
        ASSERT_EQ(sheet->piece_at(p), expected) << tiles << " at " << p.x << ' ' << p.y;
      }
    }
  }
  EXPECT_GT(pieces, 100U);
}

TEST(SheetOracle, contour_is_within_tolerance_of_the_exact_offset) {
  std::mt19937 random(21);
  for (int round = 0; round < 30; ++round) {
    const std::vector<CutMove> moves = test::random_moves(random, 1);
    const auto sheet = test::make_sheet(rectangle_outline({-40, -40}, {120, 120}), 3);
    test::cut(*sheet, 2.4, moves);
    const PlaneOutline outline = sheet->outline();
    double worst = 0;
    for (const std::vector<Vec2>& ring : outline.rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        for (const Vec2& p : {a, (a + b) * 0.5}) {
          const bool border = std::abs(p.x - 40) > 79.9 || std::abs(p.y - 40) > 79.9;
          if (!border) worst = std::max(worst, std::abs(test::distance_to_way(moves[0], p) - 1.2));
        }
      }
    }
    // 2e-4: the oracle's own steps, and the grid.
    EXPECT_LT(worst, 0.005 + 2e-4) << "round " << round;
  }
}

TEST(SheetOracle, first_contact) {
  std::mt19937 random(22);
  int found = 0;
  for (int round = 0; round < 40; ++round) {
    const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 4);
    test::cut(*sheet, 9, test::random_moves(random, 12));
    const CutMove move = test::random_moves(random, 1)[0];
    const Cutter cutter = test::torch(1.2);
    const std::optional<Contact> contact = sheet->first_contact(cutter, move, 0.1);
    // The same question, asked of the outline at many places on the way.
    const PlaneOutline outline = sheet->outline();
    const auto clearance = [&](const Vec2& p) {
      if (sheet->has_material(p)) return 0.0;
      double least = 1e300;
      for (const std::vector<Vec2>& ring : outline.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i)
          least = std::min(
              least, test::distance_to_way(test::line(ring[i], ring[(i + 1) % ring.size()]), p));
      }
      return least;
    };
    constexpr int kSteps = 400;
    bool met = false;
    for (int i = 0; i <= kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      Vec2 tip = Vec2(move.from_mm) + share * Vec2(move.to_mm - move.from_mm);
      if (move.arc) {
        const Vec2 arm = Vec2(move.from_mm - move.arc->center_mm);
        const double c = std::cos(share * move.arc->sweep_rad),
                     s = std::sin(share * move.arc->sweep_rad);
        tip = Vec2(move.arc->center_mm) + Vec2(c * arm.x - s * arm.y, s * arm.x + c * arm.y);
      }
      if (clearance(tip) > 0.5 - 1e-3) continue;
      met = true;
      ASSERT_TRUE(contact) << "round " << round;
      const double step =
          (std::hypot(move.to_mm.x - move.from_mm.x, move.to_mm.y - move.from_mm.y) +
           (move.arc ? 30 * std::abs(move.arc->sweep_rad) : 0)) /
          kSteps;
      EXPECT_LE(std::hypot(tip.x - contact->tip_mm.x, tip.y - contact->tip_mm.y), step + 0.2)
          << "round " << round;
      break;
    }
    if (contact) {
      ++found;
      EXPECT_LT(clearance(Vec2(contact->tip_mm)), 0.5 + 0.006) << "round " << round;
      EXPECT_DOUBLE_EQ(contact->depth_mm, 2);
    } else {
      EXPECT_FALSE(met) << "round " << round;
    }
  }
  EXPECT_GT(found, 5);
  EXPECT_LT(found, 40);
}

}  // namespace
}  // namespace kerf
