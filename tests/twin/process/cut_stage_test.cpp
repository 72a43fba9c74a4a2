#include "twin/process/cut_stage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stock/zmap/zmap.h"
#include "tests/twin/process/motions.h"
#include "twin/process/milling/checks.h"

namespace kerf {
namespace {

/// A block 40 x 40 x 10 mm with its top at Z0, cut by tool 1, a flat cutter of 4 mm.
class Shop {
 public:
  explicit Shop(const MotionList& program, std::size_t batch = 4096, const char* tool = "1=flat:4",
                const TimelineOptions& timeline = {}, const CheckOptions& checks = {}) {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-10:40,40,0").value();
    options.cell_mm = 0.1;
    stock_ = std::move(ZMap::create(options).value());
    ToolSources sources;
    sources.arguments.push_back(std::move(parse_tool_argument(tool).value()));
    ToolTableRow row;
    row.tool = 9;
    row.diameter_mm = 6;
    row.line = 2;
    sources.table.push_back(row);
    resolver_ = std::make_unique<ToolResolver>(sources, ZMap::can_cut);
    stage_ = std::make_unique<CutStage>(*stock_, *resolver_, log_, timeline);
    stage_->set_frame({});
    stage_->check_by(checks);
    std::span<const Motion> left(program.list());
    while (!left.empty()) {
      const std::size_t count = std::min(batch, left.size());
      stage_->take(left.first(count));
      left = left.subspan(count);
    }
    stage_->finish();
  }

  const std::vector<Finding>& findings() const { return log_.kept(); }
  std::vector<FindingId> ids() const {
    std::vector<FindingId> out;
    for (const Finding& f : findings()) out.push_back(f.id);
    return out;
  }
  double removed_mm3() const { return stock_->blank_mm3() - stock_->remaining_mm3(); }
  const ZMap& stock() const { return *stock_; }
  const CutStage& stage() const { return *stage_; }

 private:
  std::unique_ptr<ZMap> stock_;
  std::unique_ptr<ToolResolver> resolver_;
  FindingLog log_;
  std::unique_ptr<CutStage> stage_;
};

MotionList started() {
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true);
  return program;
}

using Ids = std::vector<FindingId>;

TEST(CutStage, SlotRemovesItsVolumeAndFindsNothing) {
  const Shop shop(started().feed({-5, 20, -2}).feed({45, 20, -2}).traverse({45, 20, 5}));
  EXPECT_EQ(shop.ids(), Ids{});
  EXPECT_NEAR(shop.removed_mm3(), 40 * 4 * 2, 40 * 0.1 * 2);
  const ToolUse& use = shop.stage().tools().at(0);
  EXPECT_EQ(use.number, 1);
  EXPECT_EQ(use.shape, "flat:4");
  EXPECT_NEAR(use.removed_mm3, 40 * 4 * 2, 2 * 40 * 2 * 0.1 / 50);  // a fiftieth of a cell
  EXPECT_NEAR(use.removed_mm3, shop.removed_mm3(), 1e-6);
  EXPECT_NEAR(use.max_depth_mm, 2, 1e-4);
  EXPECT_NEAR(use.feed_mm, 7 + 50, 1e-9);
  // From X-2 to X40 at 600 mm/min: the sides of a blank are where cells end.
  EXPECT_NEAR(use.cut_s, 4.2, 0.001);
  EXPECT_NEAR(use.peak_mm3_per_s, 4 * 2 * 10, 0.8);
}

/// W of a mill that has it among its axes is a quill along Z, also under a model for upright tools.
TEST(CutStage, AQuillCutsAsZDoes) {
  MotionList by_z = started();
  by_z.feed({10, 20, 1})
      .feed({10, 20, -3})
      .feed({30, 20, -2})
      .arc({20, 30, -2}, {20, 20, -2}, {0, 0, 1}, kPi / 2);
  MotionList by_w = started();
  by_w.feed({10, 20, 1}).feed({10, 20, 1});
  by_w.last().to_uvw_mm.z = -4;
  by_w.feed({30, 20, 1});
  by_w.last().from_uvw_mm.z = -4;
  by_w.last().to_uvw_mm.z = -3;
  by_w.arc({20, 30, 1}, {20, 20, 1}, {0, 0, 1}, kPi / 2);
  by_w.last().from_uvw_mm.z = by_w.last().to_uvw_mm.z = -3;
  TimelineOptions timeline;
  timeline.kinematics =
      std::make_shared<const MachineKinematics>(known_machine("trivkins", "XYZW", {}, {}).value());
  const Shop quill(by_w, 4096, "1=flat:4", timeline);
  EXPECT_EQ(quill.stock().digest(), Shop(by_z).stock().digest());
  EXPECT_EQ(quill.ids(), Ids{});
  EXPECT_NEAR(quill.stage().tools().at(0).feed_mm, Shop(by_z).stage().tools().at(0).feed_mm, 0.1);
  // Of a machine that has no W nothing is known.
  timeline.kinematics =
      std::make_shared<const MachineKinematics>(known_machine("trivkins", "XYZ", {}, {}).value());
  const Shop unknown(by_w, 4096, "1=flat:4", timeline);
  EXPECT_EQ(unknown.removed_mm3(), 0);
  EXPECT_EQ(unknown.ids().at(0), FindingId::kSecondaryIgnored);
}

/// Tool 9 is known by its diameter alone.
TEST(CutStage, GuessesMakeNoErrors) {
  const auto severities = [](int tool, const CheckOptions& checks) {
    MotionList program;
    program.at({-5, 20, 5}).tool(tool).spindle(true);
    program.traverse({10, 20, 5}).traverse({10, 20, -2}).traverse({10, 20, 5});  // rapid-contact
    program.feed({30, 20, 5}).feed({30, 20, -11}).traverse({30, 20, 5});         // below-stock
    program.spindle(false).feed({10, 30, 5}).feed({10, 30, -2});  // spindle-off-contact
    const Shop shop(program, 4096, "1=flat:4", {}, checks);
    std::string out;
    for (const Finding& f : shop.findings()) {
      if (f.id == FindingId::kToolGuessed) continue;
      out += std::string(to_string(f.id)) + (f.severity == Severity::kError ? "!" : "?") + " ";
    }
    return out;
  };
  EXPECT_EQ(severities(1, {}), "rapid-contact! below-stock! spindle-off-contact! ");
  EXPECT_EQ(severities(1, {true, 0}), "rapid-contact? below-stock? spindle-off-contact? ");
  EXPECT_EQ(severities(9, {}), "rapid-contact? below-stock! spindle-off-contact? ");
  EXPECT_EQ(severities(1, {false, 1.5}), "rapid-contact! spindle-off-contact! ");
  EXPECT_EQ(severities(1, {false, 0.5}), "rapid-contact! below-stock! spindle-off-contact! ");
  EXPECT_EQ(doubt_of(FindingId::kRapidContact, {true, true}),
            " (of a guessed blank, with a guessed tool)");
}

TEST(CutStage, AFeedThatGoesNowhereAsksForNoTool) {
  MotionList program;
  program.at({20, 20, 5}).feed({20, 20, 5}).tool(1).spindle(true).feed({20, 20, -2});
  EXPECT_EQ(Shop(program).ids(), Ids{});
  MotionList moves;
  moves.at({20, 20, 5}).feed({20, 20, 4}).tool(1).spindle(true).feed({20, 20, -2});
  EXPECT_EQ(Shop(moves, 4096, "1=flat:4").ids(), (Ids{FindingId::kToolAssumed}));
}

TEST(CutStage, WhatUSlidesNobodySays) {
  MotionList program = started();
  program.feed({10, 20, -1}).feed({30, 20, -1});
  program.last().to_uvw_mm = {20, 0, 0};
  program.feed({35, 20, -1});
  program.last().from_uvw_mm = {20, 0, 0};
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), Ids{FindingId::kSecondaryIgnored}) << "told once";
  EXPECT_EQ(shop.findings()[0].severity, Severity::kError);
  EXPECT_EQ(shop.findings()[0].source.line, 3U);
  EXPECT_EQ(shop.findings()[0].text.rfind("U moves, and nothing says what it slides", 0), 0U);
}

TEST(CutStage, TraversesThroughMaterialAreOneFinding) {
  // Down in the air, then three traverses through the block, the second deeper.
  const Shop shop(started()
                      .traverse({-5, 20, -1})
                      .traverse({10, 20, -1})
                      .traverse({10, 20, -3})
                      .traverse({45, 20, -3})
                      .traverse({45, 20, 5})
                      .traverse({20, 5, 5})
                      .traverse({20, 5, -0.5}));
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kRapidContact, FindingId::kRapidContact}));
  const Finding& first = shop.findings()[0];
  EXPECT_EQ(first.source.line, 3U);
  EXPECT_EQ(first.tool, 1);
  EXPECT_NEAR(*first.depth_mm, 3, 1e-3);
  EXPECT_NEAR(first.position_mm->x, -2, 0.2) << "the edge of the cutter meets X0";
  EXPECT_NEAR(first.position_mm->z, -1, 1e-6);
  // A tool change of half an I/O period and two whole ones, 6 mm down in at least 2 sqrt(6 / 300)
  // s, and a fifth of 15 mm along.
  EXPECT_GT(*first.time_s, 0.25 + 0.283);
  EXPECT_LT(*first.time_s, 0.9);
  const Finding& second = shop.findings()[1];
  EXPECT_EQ(second.source.line, 8U);
  EXPECT_NEAR(*second.depth_mm, 0.5, 1e-3);
}

TEST(CutStage, RetractingThroughItsOwnCutIsNoContact) {
  const Shop shop(started()
                      .traverse({20, 20, 5})
                      .feed({20, 20, -4})
                      .feed({30, 20, -4})
                      .traverse({20, 20, -4})
                      .traverse({20, 20, 5}));
  EXPECT_EQ(shop.ids(), Ids{});
}

TEST(CutStage, StandingSpindleIsOneFindingUntilItTurns) {
  MotionList program = started();
  program.spindle(false).traverse({20, 20, 5}).feed({20, 20, -1}).feed({25, 20, -1});
  program.feed({25, 20, -4}).feed({30, 20, -4}).spindle(true).feed({35, 20, -9});
  program.spindle(false).feed({35, 25, -9});
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kSpindleOffContact, FindingId::kSpindleOffContact}));
  EXPECT_EQ(shop.findings()[0].source.line, 3U);
  EXPECT_NEAR(*shop.findings()[0].depth_mm, 4, 1e-3)
      << "the depth with the spindle turning does not count";
  EXPECT_EQ(shop.findings()[1].source.line, 8U);
  EXPECT_NEAR(*shop.findings()[1].depth_mm, 9, 1e-3);
}

TEST(CutStage, StandingSpindleInTheAirIsNothing) {
  MotionList program = started();
  program.spindle(false).feed({20, 20, 1}).feed({30, 20, 0});
  EXPECT_EQ(Shop(program).ids(), Ids{FindingId::kOutsideStock}) << "only that it stays above";
}

TEST(CutStage, CuttingIntoTheTableIsOneFindingWithPlaceAndDepth) {
  const Shop shop(started()
                      .feed({-5, 20, -10.5})
                      .feed({20, 20, -10.5})
                      .feed({20, 20, -12})
                      .feed({20, 30, -10})
                      .feed({20, 31, -10})
                      .feed({20, 31, -11}));
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kBelowStock, FindingId::kBelowStock}));
  const Finding& first = shop.findings()[0];
  EXPECT_EQ(first.source.line, 3U) << "the plunge beside the block cuts no table under it";
  EXPECT_NEAR(first.position_mm->x, 0, 1e-9);
  EXPECT_NEAR(*first.depth_mm, 2, 1e-9);
  EXPECT_EQ(message_of(first),
            "tool cuts into the table under the workpiece, 2.00 mm below its floor at X0.00 Y20.00 "
            "Z-10.50 (tool 1)");
  EXPECT_EQ(shop.findings()[1].source.line, 7U);
}

TEST(CutStage, ArcsBelowTheFloorAreSeen) {
  MotionList program = started();
  // Half a circle in XZ that hangs down from Z-9 to Z-11.
  program.feed({18, 20, -9}).arc({22, 20, -9}, {20, 20, -9}, {0, 1, 0}, -kPi);
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kBelowStock}));
  EXPECT_NEAR(*shop.findings()[0].depth_mm, 1, 0.01);
}

TEST(CutStage, UnknownToolsDoNotCutAndSaySoOnce) {
  MotionList program = started();
  program.tool(3).feed({20, 20, -5}).feed({30, 20, 5}).tool(1).traverse({20, 20, 5});
  program.tool(3).feed({20, 20, -5});
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kToolUndefined}));
  EXPECT_EQ(message_of(shop.findings()[0]),
            "nothing is known of tool 3; its moves do not cut (--tool 3=SHAPE describes it)");
  EXPECT_EQ(shop.findings()[0].severity, Severity::kError);
  EXPECT_EQ(shop.removed_mm3(), 0);
}

TEST(CutStage, ToolAndOffsetInOneNumberAreHintedAt) {
  for (const auto& [number, tool] : {std::pair{303, 3}, {1212, 12}, {3, 0}, {310, 0}, {100, 0}}) {
    MotionList program = started();
    program.tool(number).feed({20, 20, -5});
    const Shop shop(program);
    ASSERT_EQ(shop.ids(), (Ids{FindingId::kToolUndefined}));
    const std::string& hint = shop.findings()[0].hint;
    if (tool == 0) {
      EXPECT_EQ(hint, "") << number;
    } else {
      EXPECT_NE(hint.find(fmt::format("reads tool {} there", number)), hint.npos) << hint;
      EXPECT_NE(hint.find(fmt::format("T{} M6 G43", tool)), hint.npos) << hint;
    }
  }
}

TEST(CutStage, OneArgumentServesAProgramWithoutToolChange) {
  MotionList program;
  program.at({-5, 20, 5}).spindle(true).feed({-5, 20, -2}).feed({45, 20, -2});
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kToolAssumed}));
  EXPECT_EQ(shop.findings()[0].severity, Severity::kNote);
  EXPECT_GT(shop.removed_mm3(), 300);
}

TEST(CutStage, GuessedToolsAreNamed) {
  MotionList program = started();
  program.tool(9).traverse({20, 20, 5}).feed({20, 20, -1});
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), (Ids{FindingId::kToolGuessed}));
  EXPECT_EQ(message_of(shop.findings()[0]),
            "only the diameter of tool 9 is known (diameter in line 2 of the tool table); a flat "
            "cutter is assumed: flat:6 (--tool 9=SHAPE says better)");
  EXPECT_GT(shop.removed_mm3(), 20);
}

TEST(CutStage, ProbesAndMovesFromNowhereDoNotCut) {
  MotionList program = started();
  program.traverse({20, 20, -5});
  program.last().start_known = false;
  program.traverse({20, 20, 5}).probe({20, 20, -3}).traverse({20, 20, 5});
  MotionList probing = started();
  probing.traverse({20, 20, 5}).probe({20, 20, -3});
  EXPECT_EQ(Shop(probing).removed_mm3(), 0);
  EXPECT_EQ(Shop(probing).ids(), Ids{});
  const Shop shop(program);
  EXPECT_EQ(shop.ids(), Ids{FindingId::kRapidContact})
      << "the way out of the block is a known move";
  EXPECT_EQ(shop.findings()[0].source.line, 3U);
}

TEST(CutStage, AProgramThatNeverReachesItsBlankIsSaid) {
  const Shop away(started().traverse({500, 20, 5}).feed({500, 20, -3}).feed({520, 30, -3}));
  ASSERT_EQ(away.ids(), Ids{FindingId::kOutsideStock});
  EXPECT_NE(message_of(away.findings()[0])
                .find("the moves are at X500.0..520.0 Y20.0..30.0 Z-3.0..5.0, the blank at X"),
            std::string::npos)
      << message_of(away.findings()[0]);
  EXPECT_EQ(Shop(started().traverse({500, 20, 5}).feed({500, 20, -3}).feed({20, 20, -3})).ids(),
            Ids{});
  EXPECT_EQ(Shop(started().traverse({500, 20, 5})).ids(), Ids{}) << "nothing was to be cut";
}

TEST(CutStage, APlungeFromFarAboveRemovesItsAreaTimesItsSpeed) {
  const Shop shop(started().traverse({20, 20, 30}).feed({20, 20, -5}));
  const ToolUse& use = shop.stage().tools().at(0);
  // 5 mm at 10 mm/s, and half of what braking takes, at half of Z's 300 mm/s2: 10 / 150 / 2.
  EXPECT_NEAR(use.cut_s, 0.5 + 10.0 / 150 / 2, 0.01 * 0.5333);
  EXPECT_NEAR(use.peak_mm3_per_s, kPi * 4 * 10, 0.01 * kPi * 4 * 10);
}

/// What is measured is limited by counts: how motions come in batches does not matter.
TEST(CutStage, LoadsAreThoseOfAnyBatches) {
  MotionList program = started();
  for (int y = 0; y < 40; ++y) {
    program.feed({-5, y + 0.3, -1}).feed({45, y + 0.3, -1}).feed({45, y + 0.3, -2});
    program.feed({-5, y + 0.3, -2}).traverse({-5, y + 0.3, 5});
  }
  const Shop whole(program), single(program, 1), some(program, 7);
  const ToolUse& use = whole.stage().tools().at(0);
  EXPECT_GT(use.cut_s, 100);
  for (const Shop* other : {&single, &some}) {
    EXPECT_EQ(use.cut_s, other->stage().tools().at(0).cut_s);
    EXPECT_EQ(use.peak_mm3_per_s, other->stage().tools().at(0).peak_mm3_per_s);
  }
}

/// Looking at a motion in pieces leaves no trace in the workpiece.
TEST(CutStage, MeasuringChangesNoBit) {
  MotionList slow = started(), fast = started();
  for (MotionList* program : {&slow, &fast}) {
    program->feed_rate(program == &slow ? 60 : 1e5);
    program->feed({-5, 11.3, -2}).feed({37, 22.7, -4.1}).feed({3, 30, -1});
    program->arc({23, 30, -3}, {13, 30, -1}, {0, 0, 1}, -kPi).feed({23, 2, -5});
  }
  EXPECT_EQ(Shop(slow).stock().digest(), Shop(fast).stock().digest());
}

TEST(CutStage, AToolThatIsSelectedAndNotChangedIsSaidWithTheLineOfItsTWord) {
  MotionList program = started();
  program.feed({-5, 20, -2}).feed({5, 20, -2});
  program.last().selected_tool = 2;
  program.last().selected_at = {0, 7};
  program.feed({8, 20, -2});
  program.last().selected_tool = 2;
  program.last().selected_at = {0, 7};
  const Shop shop(program);
  ASSERT_EQ(shop.ids(), Ids{FindingId::kToolNotChanged});
  EXPECT_EQ(shop.findings()[0].source.line, 7U);
  EXPECT_EQ(shop.findings()[0].severity, Severity::kWarning);
}

TEST(CutStage, ASpindleThatIsToldToTurnAtNothingStands) {
  MotionList program = started();
  program.feed({-5, 20, -2});
  program.feed({5, 20, -2}).last().spindle_rpm = 0;
  program.feed({9, 20, -2}).last().spindle_rpm = 0;
  const Shop unsaid(program);
  ASSERT_EQ(unsaid.ids(), Ids{FindingId::kSpindleOffContact});
  EXPECT_EQ(unsaid.findings()[0].severity, Severity::kWarning) << "no S word in the whole program";
  program.feed({12, 20, -2}).last().speed_said = true;
  EXPECT_EQ(Shop(program).findings().at(0).severity, Severity::kError) << "one comes after all";
}

TEST(CutStage, ADrillThatIsFedSidewaysIsAnError) {
  MotionList program = started();
  program.traverse({20, 20, 5}).feed({20, 20, -4}).feed({20, 20, -1}).feed({28, 20, -1});
  const Shop shop(program, 4096, "1=drill:4:118");
  ASSERT_EQ(shop.ids(), Ids{FindingId::kDrillSideways});
  EXPECT_EQ(shop.findings()[0].severity, Severity::kError);
  EXPECT_EQ(shop.findings()[0].source.line, 5U);
  EXPECT_EQ(Shop(program, 4096, "1=drill:4:90").findings().at(0).severity, Severity::kWarning);
  EXPECT_EQ(Shop(program).ids(), Ids{}) << "an end mill may";
}

TEST(CutStage, MissingFeedIsSaidOnce) {
  const Shop shop(started().feed_rate(0).feed({20, 20, 1}).feed({30, 20, 1}));
  EXPECT_EQ(shop.ids(), (Ids{FindingId::kFeedMissing, FindingId::kOutsideStock}));
}

TEST(CutStage, ResultDoesNotDependOnBatches) {
  MotionList program = started();
  program.traverse({2, 20, 5});
  for (int i = 0; i < 200; ++i) {
    program.feed({2 + 0.18 * i, 20 + (i % 7), -0.02 * i});
    if (i % 50 == 49) program.traverse({2 + 0.18 * i, 20, -1});
    if (i % 70 == 69) program.spindle(i % 140 != 69);
  }
  const Shop whole(program);
  ASSERT_GE(whole.findings().size(), 2U);
  for (const std::size_t batch : {1U, 3U, 64U}) {
    const Shop parts(program, batch);
    EXPECT_EQ(parts.stock().digest(), whole.stock().digest()) << "batch " << batch;
    EXPECT_EQ(parts.ids(), whole.ids());
    for (std::size_t i = 0; i < whole.findings().size(); ++i) {
      EXPECT_EQ(message_of(parts.findings()[i]), message_of(whole.findings()[i]));
    }
    EXPECT_DOUBLE_EQ(parts.stage().tools()[0].removed_mm3, whole.stage().tools()[0].removed_mm3);
  }
}

}  // namespace
}  // namespace kerf
