#include "twin/process/process_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tests/twin/process/motions.h"
#include "tests/twin/process/punch_shop.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/job/stock_choice.h"
#include "twin/playback/frontier.h"
#include "twin/playback/stock_cursor.h"
#include "twin/process/cut_stage.h"
#include "twin/report/sheet_report.h"

namespace kerf {
namespace {

ProcessWish wish(bool is_sheet, TurretPointer turret = nullptr) {
  ProcessWish wish;
  wish.is_sheet = is_sheet;
  wish.turret = std::move(turret);
  return wish;
}

std::string_view chosen(const ProcessWish& wish) {
  for (const ProcessRow& row : processes()) {
    if (row.choose(wish)) return row.name;
  }
  return "none";
}

TEST(ProcessTable, TheWorkpieceAndTheTurretSayWhichProcessItIs) {
  EXPECT_EQ(chosen(wish(false)), "milling");
  EXPECT_EQ(chosen(wish(true)), "torch");
  EXPECT_EQ(chosen(wish(true, test::turret("m3"))), "punch");
  EXPECT_EQ(chosen(wish(false, test::turret("m3"))), "milling") << "only sheets are punched";
}

TEST(ProcessTable, WithoutAProgramTheTriggerIsTheSpindleAndThatIsTold) {
  ProcessWish beam = wish(true);
  beam.beam.trigger = BeamTrigger::parse("m62:0").value();
  const ProcessPointer with = choose_process(beam);
  EXPECT_EQ(with->warning(), "");
  beam.has_program = false;
  const ProcessPointer without = choose_process(beam);
  EXPECT_NE(without->warning().find("--beam"), std::string::npos);
  MotionList program;
  program.at({0, 0, 0}).tool(1).output(0, true).feed({10, 0, 0});
  const Motion& feed = program.list().back();
  EXPECT_TRUE(with->beam()->trigger.on(feed));
  EXPECT_FALSE(without->beam()->trigger.on(feed)) << "the spindle stands";
}

TEST(ProcessTable, MachinesStandForWhatTheirProcessSays) {
  EXPECT_FALSE(choose_process(wish(false))->holds());
  EXPECT_FALSE(choose_process(wish(true))->holds()) << "only QtPlasmaC holds a program's motions";
  ProcessWish plasmac = wish(true);
  plasmac.is_qtplasmac = true;
  EXPECT_TRUE(choose_process(plasmac)->holds());
  EXPECT_TRUE(choose_process(wish(true, test::turret("m3")))->holds());
}

/// A process that is in no table: a round punch without a turret, wherever a feed ends.
constexpr double kWay_mm = 10;

Cutter die() { return parse_shape("kerf:4").value(); }

CutMove spot_at_end(const Motion& motion, std::uint64_t id) {
  CutMove move;
  move.from_mm = move.to_mm = motion.to_mm;
  move.id = id;
  return move;
}

struct SpotSums final : ProcessSums {
  void add_json(nlohmann::ordered_json& out) const override { out["spots"] = spots; }
  std::string text() const override { return "spots text\n"; }
  std::string run_text() const override { return "spots run"; }
  int spots = 0;
};

class SpotProcess final : public Process {
 public:
  explicit SpotProcess(ProcessSite& site) : site_(site) {}
  void take(const Motion& motion, const TimedStep& /*step*/,
            std::span<const PathPiece> /*path*/) override {
    if (!is_feed(motion)) return;
    const std::vector<CutMove> moves{spot_at_end(motion, 0)};
    std::vector<CutReport> reports;
    site_.stock.cut(die(), moves, reports);
    site_.stock.finish(reports);
    ++spots_;
  }
  void finish(bool whole) override { is_whole_ = whole; }
  void begin_reporting() override { spots_ = 0; }
  const std::vector<ToolUse>& tools() const override { return uses_; }
  std::shared_ptr<const ProcessSums> sums() const override {
    auto sums = std::make_shared<SpotSums>();
    sums->spots = is_whole_ ? spots_ : -1;
    return sums;
  }

 private:
  ProcessSite& site_;
  int spots_ = 0;
  bool is_whole_ = false;
  std::vector<ToolUse> uses_;
};

class SpotMoves final : public OrderedMoves {
  void append(std::size_t i, const MotionAt& motion_at, double fraction, const Cutter& /*cutter*/,
              std::uint64_t id, std::vector<CutMove>& out) const override {
    if (is_feed(motion_at(i)) && fraction >= 1) out.push_back(spot_at_end(motion_at(i), id));
  }
};

/// Each feed is a second longer.
class SpotHolds final : public ProgramHolds {
  MotionHold of(const Motion& motion) override {
    MotionHold hold;
    hold.moves = goes_somewhere(motion);
    if (is_feed(motion)) hold.after.strokes_s = 1;
    return hold;
  }
  std::string text() const override { return "; a spot 1 s"; }
};

class SpotPlan final : public ProcessPlan {
 public:
  std::unique_ptr<Process> make(ProcessSite& site) const override {
    return std::make_unique<SpotProcess>(site);
  }
  std::unique_ptr<MotionTools> tools(const ToolSources& /*sources*/,
                                     ToolResolver::CutterCheck /*can_cut*/) const override {
    return nullptr;
  }
  ProcessTraits traits() const override {
    ProcessTraits traits;
    traits.turns = traits.slides = traits.by_length = false;
    return traits;
  }
  MakeHolds holds() const override {
    return [] { return std::make_unique<SpotHolds>(); };
  }
  std::shared_ptr<const OrderedMoves> moves() const override {
    return std::make_shared<SpotMoves>();
  }
};

std::vector<Motion> row_of_spots(int spots) {
  MotionList program;
  program.at({0, 50, 1}).tool(1).traverse({20, 50, 1});
  for (int i = 1; i <= spots; ++i) program.feed({20 + i * kWay_mm, 50, 1});
  return {program.list().begin(), program.list().end()};
}

TEST(ProcessSeam, AProcessThatNobodyKnowsIsCutTimedAndReported) {
  const SpotPlan plan;
  const std::unique_ptr<Sheet> sheet = test::sheet_200();
  FindingLog log;
  ToolResolver resolver({}, nullptr);
  TimelineOptions timing;
  timing.holds = plan.holds();
  CutStage stage(*sheet, resolver, log, timing, plan);
  stage.take(row_of_spots(5));
  stage.finish();
  // Round spots of 4 mm, 10 mm apart.
  EXPECT_NEAR(200 * 100 - sheet->remaining_mm2(), 5 * kPi * 4, 0.02 * 5 * kPi * 4);
  EXPECT_NEAR(stage.timeline().totals().held->strokes_s, 5, 1e-9);
  EXPECT_NE(stage.timeline().time_model().find("a spot 1 s"), std::string::npos);
  const SheetReport report = sheet_report(*sheet, stage.process(), 8000);
  EXPECT_EQ(sheet_json(report, {})["spots"], 5);
  EXPECT_TRUE(sheet_text(report).starts_with("spots text\n"));
  EXPECT_TRUE(sheet_run_text(report).starts_with("sheet: spots run;"));
}

TEST(ProcessSeam, ItIsPlayedAtEveryPlace) {
  const SpotPlan plan;
  const std::vector<Motion> motions = row_of_spots(6);
  ProgramTrackBuilder builder;
  Timeline timeline(TimelineOptions{}, builder);
  for (const Motion& m : motions) timeline.push(m);
  timeline.finish();
  const std::shared_ptr<const ProgramTrack> track = builder.build({"part.ngc"}, {});
  KeyframeStore store(std::size_t{1} << 24, 1e-5);
  Frontier frontier(*track, test::sheet_200(), {}, TimelineOptions{}, store, {}, plan);
  while (!frontier.complete()) frontier.advance(track->size());
  StockCursor cursor(*track, frontier.moves(), frontier.record(), store);
  for (const std::size_t place : {motions.size(), std::size_t{4}, std::size_t{0}, std::size_t{5}}) {
    while (!cursor.approach(place)) {
    }
    const std::unique_ptr<Sheet> sheet = test::sheet_200();
    FindingLog log;
    ToolResolver resolver({}, nullptr);
    CutStage stage(*sheet, resolver, log, TimelineOptions{}, plan);
    stage.take(std::span<const Motion>(motions).first(place));
    stage.finish();
    EXPECT_EQ(cursor.picture(0)->digest(), sheet->digest()) << place;
  }
}

}  // namespace
}  // namespace kerf
