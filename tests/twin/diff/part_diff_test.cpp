#include "twin/diff/part_diff.h"

#include <gtest/gtest.h>

#include "stock/cutter/shape_spec.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

/// A slot along X in a plate of 40 x 20 x 10 mm, by a cutter of 6 mm.
struct Slotted {
  std::unique_ptr<StockModel> stock;
  CutLabels labels;
  DiffedPart part() const { return {stock.get(), &labels}; }
};

Slotted slotted(double y_mm, double z_mm, std::uint32_t line,
                std::optional<StockKind> kind = StockKind::kZmap) {
  Slotted out;
  StockSettings settings;
  settings.kind = kind;
  settings.cell_mm = 0.1;
  StockChoice choice;
  choice.kind = *kind;
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFinished;
  out.stock = make_stock(*parse_blank("box:0,0,-10:40,20,0"), choice, settings, "a test",
                         diagnostics, outcome)
                  .stock;
  if (!out.stock) {
    ADD_FAILURE() << "no workpiece";
    return out;
  }
  out.stock->keep_cut_ids(true);
  CutMove move;
  move.from_mm = {-5, y_mm, z_mm};
  move.to_mm = {45, y_mm, z_mm};
  move.id = out.labels.number_of({1, {0, line}});
  std::vector<CutReport> reports;
  out.stock->cut(*parse_shape("flat:6"), {&move, 1}, reports);
  out.stock->finish(reports);
  return out;
}

constexpr double kTolerance_mm = 0.001;

TEST(PartDiff, EqualOnesAreEqualBitForBit) {
  const Slotted a = slotted(10, -3, 7), b = slotted(10, -3, 9);
  const PartDiff found = diff_parts(a.part(), b.part(), kTolerance_mm, true);
  EXPECT_TRUE(found.same);
  EXPECT_TRUE(found.equal_bits);
}

/// A hundredth deeper, over the slot's floor of 40 x 6 mm.
TEST(PartDiff, ADeeperFloorIsToldWithPlaceAndLines) {
  const Slotted a = slotted(10, -3, 7), b = slotted(10, -3.01, 9);
  const PartDiff found = diff_parts(a.part(), b.part(), kTolerance_mm, true);
  EXPECT_FALSE(found.same);
  EXPECT_TRUE(found.by_heights);
  EXPECT_NEAR(found.most_mm, 0.01, 1e-6);
  EXPECT_NEAR(found.at_mm.z, -3.01, 1e-6);
  EXPECT_NEAR(found.area_mm2, 240, 1e-6);
  EXPECT_NEAR(found.a_more_mm3, 2.4, 1e-3);
  EXPECT_EQ(found.b_more_mm3, 0);
  ASSERT_TRUE(found.a_cut && found.b_cut);
  EXPECT_EQ(found.a_cut->source.line, 7u);
  EXPECT_EQ(found.b_cut->source.line, 9u);
  EXPECT_EQ(found.a_cut->tool, 1);
  // Within the tolerance it is the same.
  EXPECT_TRUE(diff_parts(a.part(), b.part(), 0.02, true).same);
}

/// Walls that move by less than a cell say so, instead of their height.
TEST(PartDiff, AWallWithinACellIsNoDifferenceInHeight) {
  const Slotted a = slotted(10, -3, 7), b = slotted(10.06, -3, 9);
  const PartDiff found = diff_parts(a.part(), b.part(), kTolerance_mm, true);
  EXPECT_FALSE(found.same);
  EXPECT_LE(found.most_mm, kTolerance_mm);
  EXPECT_GT(found.wall_cells, 0u);
  EXPECT_TRUE(diff_parts(a.part(), b.part(), kTolerance_mm, false).same);
}

TEST(PartDiff, AWallThatMovesByMoreIsOne) {
  const Slotted a = slotted(10, -3, 7), b = slotted(10.5, -3, 9);
  const PartDiff found = diff_parts(a.part(), b.part(), kTolerance_mm, false);
  EXPECT_FALSE(found.same);
  EXPECT_NEAR(found.most_mm, 3, 1e-6);
}

TEST(PartDiff, WhatHasNoHeightsIsMeasuredByItsSurface) {
  const Slotted a = slotted(10, -3, 7, StockKind::kOctree);
  const Slotted b = slotted(10, -3.2, 9, StockKind::kOctree);
  const PartDiff found = diff_parts(a.part(), b.part(), kTolerance_mm, true);
  EXPECT_FALSE(found.same);
  EXPECT_FALSE(found.by_heights);
  EXPECT_NEAR(found.most_mm, 0.2, 0.02);
  EXPECT_TRUE(diff_parts(a.part(), a.part(), kTolerance_mm, true).same);
}

/// Another model, or another blank: by the surface as well.
TEST(PartDiff, ModelsOfTwoKindsAreCompared) {
  const Slotted a = slotted(10, -3, 7), b = slotted(10, -3, 9, StockKind::kOctree);
  const PartDiff found = diff_parts(a.part(), b.part(), 0.06, true);
  EXPECT_TRUE(found.same) << found.most_mm;
  EXPECT_FALSE(found.equal_bits);
}

}  // namespace
}  // namespace kerf
