#include "twin/job/stock_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

ToolSources with_tool(const char* argument) {
  ToolSources tools;
  tools.arguments.push_back(parse_tool_argument(argument).value());
  return tools;
}

Motion feed_to(const Vec3& to_mm, double a_deg, std::uint32_t line) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.to_mm = to_mm;
  m.to_abc_deg[0] = a_deg;
  m.source.line = line;
  return m;
}

std::shared_ptr<const MachineKinematics> table_machine() {
  return std::make_shared<const MachineKinematics>(
      known_machine("trivkins", "XYZABC", {}, {}).value());
}

TEST(StockChoice, TheSimplestThatHoldsIt) {
  const StockSettings settings;
  EXPECT_EQ(choose_stock(settings, {}).kind, StockKind::kZmap);
  EXPECT_EQ(choose_stock(settings, {}).reason, "");
  const StockChoice undercut = choose_stock(settings, stock_needs(with_tool("3=tslot:16:4:8")));
  EXPECT_EQ(undercut.kind, StockKind::kMmap);
  EXPECT_EQ(undercut.reason, "tool 3 (tslot:16:4:8) cuts undercuts");
  StockNeeds both = stock_needs(with_tool("3=tslot:16:4:8"));
  both.tilt = "line 7 turns";
  EXPECT_EQ(choose_stock(settings, both).kind, StockKind::kOctree);
  EXPECT_EQ(choose_stock(settings, both).reason, "line 7 turns");
}

TEST(StockChoice, WhatIsAskedForIsTaken) {
  StockSettings settings;
  settings.kind = StockKind::kZmap;
  EXPECT_EQ(choose_stock(settings, stock_needs(with_tool("3=tslot:16:4:8"))).kind,
            StockKind::kZmap);
  settings = {};
  settings.additive = true;
  EXPECT_EQ(choose_stock(settings, {}).kind, StockKind::kOctree);
}

TEST(StockChoice, SheetsAndTheirModelAreForEachOther) {
  const Blank sheet = parse_blank("sheet:0,0:100,50:3").value();
  const Blank box = parse_blank("box:0,0,-3:100,50,0").value();
  StockSettings settings;
  EXPECT_EQ(misfit(settings, sheet), "");
  EXPECT_EQ(misfit(settings, box), "");
  settings.kind = StockKind::kSheet;
  EXPECT_EQ(misfit(settings, sheet), "");
  EXPECT_EQ(misfit(settings, box),
            "--model sheet: the blank is not a sheet (box 100 x 50 x 3 mm, X0..100 Y0..50 Z-3..0); "
            "--stock sheet:x0,y0:x1,y1:THICKNESS is one");
  settings.kind = StockKind::kZmap;
  EXPECT_EQ(misfit(settings, sheet),
            "--model zmap: the blank is a sheet (sheet 100 x 50 x 3 mm, X0..100 Y0..50 Z-3..0); "
            "allowed for it: sheet, auto");
  const Result<std::unique_ptr<StockModel>> made = stock_model(StockKind::kSheet).create(sheet, {});
  ASSERT_TRUE(made) << made.error();
  EXPECT_EQ((*made)->name(), "sheet");
  EXPECT_EQ((*made)->bounds_mm(), sheet.bounds_mm());
  EXPECT_EQ(&row_of(**made), &stock_model(StockKind::kSheet));
  EXPECT_NE((*made)->sheet(), nullptr);
}

TEST(StockChoice, BlanksThatOnlyTheOctreeHolds) {
  EXPECT_EQ(need_of_blank(parse_blank("box:0,0,-5:10,10,0").value()), "");
  EXPECT_EQ(need_of_blank(parse_blank("cylinder:0,0,-5:0:10").value()), "");
  EXPECT_EQ(need_of_blank(parse_blank("cylinder:0,0,-5:25:10:x").value()),
            "the blank has a cylinder along x");
  EXPECT_EQ(need_of_blank(parse_blank("box:0,0,-5:10,10,0+box:20,0,-2:30,10,0").value()),
            "the blank has a body that begins at Z-2, above its floor Z-5");
}

TEST(StockChoice, WhatALatheMayHold) {
  for (const char* const spec : {"cylinder:0,0,-60:0:40", "tube:0,0,-60:0:40:20",
                                 "hex:0,0,-60:0:27", "square:0,0,-60:0:27", "profile:part.dxf"}) {
    EXPECT_TRUE(may_be_turned(*parse_blank(spec))) << spec;
  }
  for (const char* const spec :
       {"box:0,0,0:1,1,1", "cylinder:0,0,0:9:4:x", "cylinder:0,0,0:9:4+box:0,0,0:1,1,1",
        "sheet:0,0:9,9:1", "state:no_such.state"}) {
    EXPECT_FALSE(may_be_turned(*parse_blank(spec))) << spec;
  }
  const StockModelRow& row = stock_model(StockKind::kTurning);
  const auto made = row.create(*parse_blank("hex:0,0,-10:0:20"), {});
  ASSERT_TRUE(made) << made.error();
  EXPECT_NEAR((*made)->blank_mm3(), 20 * 20 * std::sqrt(3.0) / 2 * 10, 1e-3);
  const auto refused = stock_model(StockKind::kZmap).create(*parse_blank("hex:0,0,-10:0:20"), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), "a Z-map cannot hold it: the blank is a hexagonal bar");
}

TEST(StockChoice, ACutterThatNoModelHoldsIsRefused) {
  const Cutter lollipop = parse_shape("lollipop:6:3").value();
  EXPECT_FALSE(can_be_cut(StockKind::kZmap, lollipop));
  EXPECT_TRUE(can_be_cut(StockKind::kMmap, lollipop));
  EXPECT_TRUE(can_be_cut(std::nullopt, lollipop));
}

TEST(TiltWatch, FindsTheFirstMotionThatTilts) {
  TiltWatch watch(table_machine());
  std::vector<Motion> motions = {feed_to({10, 0, 0}, 0, 4), feed_to({20, 0, 0}, 30, 5),
                                 feed_to({30, 0, 0}, 40, 6)};
  watch.look_at(std::span(motions).first(1), {});
  EXPECT_EQ(watch.found(), "");
  watch.look_at(motions, {});
  EXPECT_EQ(watch.found(), "line 5 turns the tool or the workpiece: A30");
}

TEST(TiltWatch, NothingTiltsWithoutAMachineOrWithoutTheAxis) {
  const std::vector<Motion> motions = {feed_to({20, 0, 0}, 30, 5)};
  TiltWatch nobody(nullptr);
  nobody.look_at(motions, {});
  EXPECT_EQ(nobody.found(), "");
  TiltWatch three_axes(
      std::make_shared<const MachineKinematics>(known_machine("trivkins", "XYZ", {}, {}).value()));
  three_axes.look_at(motions, {});
  EXPECT_EQ(three_axes.found(), "");
}

}  // namespace
}  // namespace kerf
