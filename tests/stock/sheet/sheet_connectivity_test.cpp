// Pieces kept while cutting, against a fresh search of the whole sheet.
#include <map>
#include <set>

#include "stock/sheet/pieces.h"
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

using sheet::PieceLabels;
using sheet::SheetGrid;

SheetGrid plate(int tiles) {
  return {{{{0, 0}, {600'000, 0}, {600'000, 400'000}, {0, 400'000}}}, tiles, tiles};
}

/// Whether both say the same of which rings hang together.
bool same_partition(const SheetGrid& a, const SheetGrid& b) {
  std::map<std::uint32_t, std::uint32_t> to_b, to_a;
  for (std::size_t t = 0; t < a.tile_count(); ++t) {
    for (std::size_t i = 0; i < a.tile(t).rings.size(); ++i) {
      const std::uint32_t of_a = a.tile(t).pieces[i], of_b = b.tile(t).pieces[i];
      if ((of_a == sheet::kNoPiece) != (of_b == sheet::kNoPiece)) return false;
      if (to_b.emplace(of_a, of_b).first->second != of_b) return false;
      if (to_a.emplace(of_b, of_a).first->second != of_a) return false;
    }
  }
  return true;
}

TEST(SheetConnectivity, labels_are_those_of_a_fresh_search_after_every_move) {
  std::mt19937 random(30);
  std::size_t pieces = 0;
  for (const int tiles : {1, 2, 5, 12}) {
    for (int round = 0; round < 4; ++round) {
      SheetGrid grid = plate(tiles);
      PieceLabels labels(grid);
      sheet::CircleTables tables;
      std::vector<sheet::TileChange> changes;
      for (const CutMove& move : test::random_moves(random, 40)) {
        changes.clear();
        const std::size_t before = labels.records().size();
        grid.subtract(sheet::kerf_of_move(move, 0.3, 0.005, tables), changes);
        labels.update(grid, changes, move.id);
        SheetGrid fresh_grid = grid;
        const PieceLabels fresh(fresh_grid);
        ASSERT_TRUE(same_partition(grid, fresh_grid)) << tiles << ' ' << round << ' ' << move.id;
        const auto freed = std::count_if(
            labels.records().begin(), labels.records().end(),
            [&](const sheet::PieceRecord& record) { return record.freed_by == move.id; });
        EXPECT_EQ(static_cast<std::size_t>(freed), labels.records().size() - before);
        pieces = std::max(pieces, fresh.records().size());
      }
    }
  }
  EXPECT_GT(pieces, 20u);
}

TEST(SheetConnectivity, the_closing_move_frees_the_part) {
  for (const int tiles : {1, 3, 8, 16}) {
    const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
    using test::line;
    // A square with a lead-in, closed by move 14; 15 is overburn.
    const auto reports = test::cut(
        *sheet, 1,
        {line({8, 20}, {10, 20}, 10), line({10, 20}, {10, 30}, 11), line({10, 30}, {30, 30}, 12),
         line({30, 30}, {30, 10}, 13), line({30, 10}, {10, 10}, 14), line({10, 10}, {10, 20}, 15),
         line({10, 20}, {10, 22}, 16)});
    const std::vector<SheetPiece> pieces = sheet->pieces();
    ASSERT_EQ(pieces.size(), 2u) << tiles;
    EXPECT_TRUE(pieces[0].is_main());
    EXPECT_EQ(pieces[1].freed_by, 15u);
    EXPECT_NEAR(pieces[1].area_mm2, 19 * 19, 1e-3);
    EXPECT_NEAR(pieces[1].min_mm.x, 10.5, 1e-4);
    EXPECT_NEAR(pieces[1].max_mm.y, 29.5, 1e-4);
    EXPECT_NEAR(pieces[1].weight_kg(7850), 19 * 19 * 2 * 7850e-9, 1e-8);
    double removed = 0;
    for (const CutReport& report : reports) removed += report.removed_mm3;
    EXPECT_NEAR(pieces[0].volume_mm3 + pieces[1].volume_mm3 + removed, sheet->blank_mm3(), 1e-6);
  }
}

TEST(SheetConnectivity, a_frame_stays_the_main_sheet) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 8);
  // Almost all of the sheet comes out; what goes on is the frame.
  test::cut(*sheet, 1,
            {test::line({2, 2}, {58, 2}, 1), test::line({58, 2}, {58, 38}, 2),
             test::line({58, 38}, {2, 38}, 3), test::line({2, 38}, {2, 2}, 4)});
  const std::vector<SheetPiece> pieces = sheet->pieces();
  ASSERT_EQ(pieces.size(), 2u);
  for (const SheetPiece& piece : pieces) {
    EXPECT_EQ(piece.is_main(), piece.max_mm.x > 59);
    EXPECT_EQ(piece.freed_by.value_or(0), piece.is_main() ? 0u : 4u);
  }
}

TEST(SheetConnectivity, a_sheet_cut_in_two) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 8);
  test::cut(*sheet, 1, {test::line({40, -1}, {40, 41}, 3)});
  const std::vector<SheetPiece> pieces = sheet->pieces();
  ASSERT_EQ(pieces.size(), 2u);
  for (const SheetPiece& piece : pieces) EXPECT_EQ(piece.is_main(), piece.min_mm.x < 1);
}

// Tiles are shared, and pieces are marked in them.
TEST(SheetConnectivity, a_snapshot_keeps_its_pieces) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 8);
  test::cut(*sheet, 1, {test::line({40, -1}, {40, 41}, 3)});
  const std::unique_ptr<StockModel> snapshot = sheet->snapshot();
  auto& before = dynamic_cast<Sheet&>(*snapshot);
  test::cut(*sheet, 1, {test::line({20, -1}, {20, 41}, 4)});
  EXPECT_EQ(sheet->pieces().size(), 3u);
  EXPECT_NE(sheet->piece_at({10, 20}), sheet->piece_at({30, 20}));
  EXPECT_EQ(before.pieces().size(), 2u);
  EXPECT_EQ(before.piece_at({10, 20}), before.piece_at({30, 20}));
  test::cut(before, 1, {test::line({-1, 20}, {39, 20}, 5)});
  EXPECT_EQ(before.pieces().size(), 3u);
  EXPECT_EQ(sheet->piece_at({10, 10}), sheet->piece_at({10, 30}));
}

TEST(SheetConnectivity, along_a_border_of_tiles) {
  // Kerfs that run along borders part tiles without parting any tile's own material.
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 4);
  test::cut(*sheet, 0.2, {test::line({30, -1}, {30, 41}, 1), test::line({-1, 20}, {61, 20}, 2)});
  EXPECT_EQ(sheet->pieces().size(), 4u);
}

TEST(SheetConnectivity, outlines_have_the_area_of_their_pieces) {
  std::mt19937 random(31);
  for (const int tiles : {1, 7}) {
    const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
    test::cut(*sheet, 0.6, test::random_moves(random, 40));
    double area = 0;
    for (const SheetPiece& piece : sheet->pieces()) {
      const PlaneOutline outline = sheet->outline_of(piece.number);
      ASSERT_FALSE(outline.rings.empty());
      EXPECT_NEAR(test::area_of(outline), piece.area_mm2, 1e-5 * piece.area_mm2 + 1e-3);
      area += piece.area_mm2;
    }
    EXPECT_NEAR(area, sheet->remaining_mm2(), 1e-6);
    EXPECT_NEAR(test::area_of(sheet->outline()), area, 0.01);
  }
}

}  // namespace
}  // namespace kerf
