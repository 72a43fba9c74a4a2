// The sheet as a stock model: outlines, snapshots, versions, digests, punching.
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

using test::arc;
using test::line;

std::string fault_of(const PlaneOutline& outline) {
  SheetOptions options;
  options.outline = outline;
  const Result<std::unique_ptr<Sheet>> sheet = Sheet::create(options);
  return sheet ? "" : sheet.error();
}

TEST(Sheet, outlines_of_any_shape) {
  // An L with a hole, and an island in the hole.
  const PlaneOutline outline{{{{0, 0}, {50, 0}, {50, 20}, {20, 20}, {20, 50}, {0, 50}},
                              {{5, 5}, {15, 5}, {15, 15}, {5, 15}},
                              {{8, 8}, {12, 8}, {12, 12}, {8, 12}}},
                             {}};
  for (const int tiles : {1, 6}) {
    const auto sheet = test::make_sheet(outline, tiles);
    EXPECT_DOUBLE_EQ(sheet->remaining_mm2(), 50 * 50 - 30 * 30 - 100 + 16);
    EXPECT_TRUE(sheet->has_material({3, 40}));
    EXPECT_FALSE(sheet->has_material({40, 40}));
    EXPECT_FALSE(sheet->has_material({6, 10}));
    EXPECT_TRUE(sheet->has_material({10, 10}));
    EXPECT_EQ(sheet->pieces().size(), 2u);
    const Box box = sheet->bounds_mm();
    EXPECT_EQ(box, (Box{{0, 0, 0}, {50, 50, 2}}));
  }
}

TEST(Sheet, outlines_that_bound_nothing) {
  EXPECT_EQ(fault_of({}), "the outline is empty; it must have a closed ring");
  EXPECT_EQ(fault_of({{{{0, 0}, {5, 5}}}, {12}}),
            "ring 1 (line 12) has 2 different corners; a closed outline has at least 3");
  EXPECT_EQ(fault_of({{{{0, 0}, {5, 5}, {10, 10}}}, {}}), "ring 1 crosses itself at X10 Y10");
  EXPECT_EQ(fault_of({{{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}, {}}),
            "ring 1 crosses itself at X5 Y5");
  EXPECT_EQ(fault_of({{{{0, 0}, {10, 0}, {10, 10}}, {{5, -5}, {20, -5}, {5, 4}}}, {3, 9}}),
            "ring 1 (line 3) and ring 2 (line 9) cross at X5 Y0");
  EXPECT_EQ(fault_of({{{{0, 0}, {10, 0}, {std::nan(""), 10}}}, {}}),
            "ring 1: a corner is not a number");
  EXPECT_EQ(fault_of({{{{0, 0}, {10, 0}, {10, 2e5}}}, {}}),
            "ring 1: the corner X10 Y200000 is too far out; must be within 100000 mm");
}

TEST(Sheet, thickness_and_tolerance_have_ranges) {
  SheetOptions options;
  options.outline = rectangle_outline({0, 0}, {60, 40});
  options.top_mm = 0;
  EXPECT_EQ(Sheet::create(options).error(),
            "sheet: thickness: 0 is not allowed; must be from 0.001 to 1000 (mm)");
  options.top_mm = 2;
  options.arc_tolerance_mm = 5;
  EXPECT_EQ(Sheet::create(options).error(),
            "sheet: arc tolerance: 5 is not allowed; must be from 0.0001 to 1 (mm)");
}

TEST(Sheet, kerf_has_a_least_width) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}));
  EXPECT_TRUE(sheet->accepts(test::torch(0.01)));
  EXPECT_EQ(sheet->accepts(*parse_shape("flat:0.005")).error(),
            "flat:0.005: a kerf of 0.005 mm is not allowed; must be at least 0.01 mm");
}

TEST(Sheet, cut_twice_changes_nothing) {
  const std::vector<CutMove> moves = {line({5, 5}, {50, 30}), arc({30, 20}, 12, 1, 2 * kPi),
                                      arc({30, 20}, 15, 1, 4)};
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 5);
  test::cut(*sheet, 1, moves);
  // Rounding where kerfs cross leaves less than the grid resolves.
  double removed = 0;
  for (const CutReport& report : test::cut(*sheet, 1, moves)) removed += report.removed_mm3;
  EXPECT_LT(removed, 1e-4);
  EXPECT_EQ(sheet->pieces().size(), test::make_sheet(sheet->outline(), 1)->pieces().size());
}

TEST(Sheet, any_division_into_calls_gives_the_same_bits) {
  std::mt19937 random(51);
  const std::vector<CutMove> moves = test::random_moves(random, 60);
  const auto whole = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 6);
  test::cut(*whole, 1, moves);
  std::unique_ptr<StockModel> parts =
      test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 6)->snapshot();
  std::vector<CutReport> reports;
  for (std::size_t i = 0; i < moves.size();) {
    const std::size_t count = std::min<std::size_t>(1 + random() % 9, moves.size() - i);
    parts->cut(test::torch(1), std::span(moves).subspan(i, count), reports);
    parts->finish(reports);
    if (random() % 3 == 0) parts = parts->snapshot();
    i += count;
  }
  EXPECT_EQ(parts->digest(), whole->digest());
  EXPECT_TRUE(parts->differing_tiles(*whole).empty());
  ASSERT_EQ(reports.size(), moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) EXPECT_EQ(reports[i].id, moves[i].id);
}

TEST(Sheet, split_turned_and_moved_moves_leave_the_same) {
  const auto area = [](const std::vector<CutMove>& moves) {
    const auto sheet = test::make_sheet(rectangle_outline({-60, -60}, {60, 60}), 7);
    test::cut(*sheet, 3, moves);
    return sheet->remaining_mm2();
  };
  const double whole = area({line({-20, -5}, {30, 12}), arc({5, 5}, 20, 1, 2 * kPi)});
  EXPECT_NEAR(area({line({-20, -5}, {5, 3.5}), line({5, 3.5}, {30, 12}), arc({5, 5}, 20, 1, 2),
                    arc({5, 5}, 20, 3, 2 * kPi - 2)}),
              whole, 0.02);
  // Turned by a right angle, and mirrored.
  EXPECT_NEAR(area({line({5, -20}, {-12, 30}), arc({-5, 5}, 20, 1 + kPi / 2, 2 * kPi)}), whole,
              1e-3);
  EXPECT_NEAR(area({line({20, -5}, {-30, 12}), arc({-5, 5}, 20, kPi - 1, -2 * kPi)}), whole, 1e-3);
  // In another order.
  EXPECT_NEAR(area({arc({5, 5}, 20, 1, 2 * kPi), line({-20, -5}, {30, 12})}), whole, 1e-3);
}

TEST(Sheet, tilings_differ_by_rounding_alone) {
  std::mt19937 random(52);
  const std::vector<CutMove> moves = test::random_moves(random, 60);
  std::vector<double> areas;
  std::vector<std::size_t> pieces;
  for (const int tiles : {1, 2, 8, 20}) {
    const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
    test::cut(*sheet, 1, moves);
    areas.push_back(sheet->remaining_mm2());
    std::size_t count = 0;
    for (const SheetPiece& piece : sheet->pieces()) count += piece.area_mm2 > 0.001;
    pieces.push_back(count);
  }
  for (std::size_t i = 1; i < areas.size(); ++i) {
    EXPECT_NEAR(areas[i], areas[0], 2e-6 * 2400);
    EXPECT_EQ(pieces[i], pieces[0]);
  }
}

TEST(Sheet, snapshots_stay) {
  std::mt19937 random(53);
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 6);
  test::cut(*sheet, 1, test::random_moves(random, 10));
  const std::unique_ptr<StockModel> before = sheet->snapshot();
  const std::string digest = before->digest();
  EXPECT_EQ(sheet->digest(), digest);
  EXPECT_EQ(before->unique_bytes(), 0u);
  test::cut(*sheet, 1, {arc({30, 20}, 8, 0, 2 * kPi, 70)});
  EXPECT_EQ(before->digest(), digest);
  EXPECT_NE(sheet->digest(), digest);
  EXPECT_GT(sheet->unique_bytes(), 0u);
  const std::vector<std::uint32_t> differing = sheet->differing_tiles(*before);
  EXPECT_FALSE(differing.empty());
  EXPECT_LT(differing.size(), sheet->tile_count());
  for (std::uint32_t t = 0; t < sheet->tile_count(); ++t) {
    if (sheet->patch_version(t) != before->patch_version(t)) continue;
    const MeshPatch a = sheet->patch(t, 0), b = before->patch(t, 2);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_EQ(a.indices, b.indices);
  }
}

TEST(Sheet, dirty_tiles) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 60}), 6);
  EXPECT_EQ(sheet->take_dirty_tiles().size(), 36u);
  EXPECT_TRUE(sheet->take_dirty_tiles().empty());
  test::cut(*sheet, 1, {line({3, 3}, {14, 3})});
  EXPECT_EQ(sheet->take_dirty_tiles(), (std::vector<std::uint32_t>{0, 1}));
  test::cut(*sheet, 1, {line({3, 3}, {14, 3})});
  EXPECT_TRUE(sheet->take_dirty_tiles().empty());
}

TEST(Sheet, punch) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 4);
  const PlaneOutline square = rectangle_outline({-5, -5}, {5, 5});
  EXPECT_NEAR(sheet->punch(square, {30, 20}, kPi / 4, 1).removed_mm3, 200, 0.01);
  EXPECT_FALSE(sheet->has_material({36, 20}));
  EXPECT_TRUE(sheet->has_material({34.9, 24.9}));
  // Half off the sheet, and wholly.
  EXPECT_NEAR(sheet->punch(square, {0, 10}, 0, 2).removed_mm3, 100, 1e-6);
  EXPECT_EQ(sheet->punch(square, {-20, 10}, 0, 3).removed_mm3, 0);
  // A ring leaves its slug.
  const PlaneOutline ring{
      {{{-4, -4}, {4, -4}, {4, 4}, {-4, 4}}, {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}}, {}};
  EXPECT_NEAR(sheet->punch(ring, {50, 10}, 0, 4).removed_mm3, 2 * (64 - 16), 1e-6);
  const std::vector<SheetPiece> pieces = sheet->pieces();
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[1].freed_by, 4u);
  EXPECT_NEAR(pieces[1].area_mm2, 16, 1e-9);
}

TEST(Sheet, what_is_cut_away_wholly) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 4);
  sheet->punch(rectangle_outline({-50, -50}, {50, 50}), {30, 20}, 0, 9);
  EXPECT_EQ(sheet->remaining_mm3(), 0);
  EXPECT_TRUE(sheet->pieces().empty());
  EXPECT_TRUE(sheet->outline().rings.empty());
  EXPECT_TRUE(sheet->mesh(0).triangles.empty());
  EXPECT_FALSE(sheet->first_contact(test::torch(2), line({0, 0}, {60, 40}), 0));
}

}  // namespace
}  // namespace kerf
