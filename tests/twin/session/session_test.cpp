// A session by itself: what it tells its observer, and where its blank and tools come from.
#include "twin/session/session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "twin/machine/kinematics/machine_kinematics.h"

namespace kerf {
namespace {

class Recorder final : public SessionObserver {
 public:
  void on_start(const StockModel& stock) override {
    ++starts;
    start_digest = stock.digest();
  }
  void on_cut(const StockModel&, std::span<const Motion> motions, double end) override {
    EXPECT_GE(end, end_s);
    moves += motions.size();
    end_s = end;
  }
  int starts = 0;
  std::size_t moves = 0;
  double end_s = 0;
  std::string start_digest;
};

class SessionTest : public testing::Test {
 protected:
  SessionTest() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-session-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    options_.program.path = folder_ + "/part.canon";
    options_.stock.cell_mm = 0.1;
  }
  ~SessionTest() override { std::filesystem::remove_all(folder_); }

  void write_listing(const std::string& comments) {
    std::ofstream(options_.program.path)
        << "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
        << comments << "    3 N1     SELECT_TOOL(1)\n"
        << "    4 N1     CHANGE_TOOL(1)\n"
        << "    5 N2     SET_SPINDLE_SPEED(0, 3000.0000)\n"
        << "    5 N2     START_SPINDLE_CLOCKWISE(0)\n"
        << "    6 N3     STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
        << "    7 N4     SET_FEED_RATE(300.0000)\n"
        << "    8 N4     STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
        << "    9 N5     STRAIGHT_FEED(20.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
        << "   10 N6     PROGRAM_END()\n";
  }
  Outcome run(std::stop_token stop = {}) {
    Outcome outcome = Outcome::kFailed;
    session_ = Session::open(options_, diagnostics_, outcome);
    if (!session_) return outcome;
    session_->set_observer(&recorder_);
    return session_->run(stop, diagnostics_);
  }

  std::string folder_;
  SessionOptions options_;
  Diagnostics diagnostics_;
  Recorder recorder_;
  std::unique_ptr<Session> session_;
};

TEST_F(SessionTest, TellsItsObserverEverythingInOrder) {
  write_listing("");
  options_.blank = parse_blank("box:-5,-5,-5:25,5,0").value();
  options_.tools.push_back(std::move(parse_tool_argument("1=flat:6").value()));
  ASSERT_EQ(run(), Outcome::kFinished);
  EXPECT_EQ(recorder_.starts, 1);
  EXPECT_GE(recorder_.moves, 3U);
  EXPECT_DOUBLE_EQ(recorder_.end_s, session_->report().motion.duration_s);
  EXPECT_NE(recorder_.start_digest, session_->report().stock->digest);
  EXPECT_EQ(session_->report().motion.moves, 3U);
}

TEST_F(SessionTest, TakesBlankAndToolFromComments) {
  write_listing(
      "    2 N..... COMMENT(\"STOCK/BLOCK,30,10,5,5,5,5\")\n"
      "    2 N..... COMMENT(\"T1 D=6. CR=0. - ZMIN=-1. - flat end mill\")\n");
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  EXPECT_EQ(report.stock->origin, "comment in line 2 (cutviewer)");
  EXPECT_EQ(report.stock->bounds_mm.size(), Vec3(30, 10, 5));
  ASSERT_EQ(report.tools.size(), 1U);
  EXPECT_EQ(report.tools[0].shape, "flat:6");
  ASSERT_EQ(report.findings.total(), 1U);
  EXPECT_EQ(report.findings.kept()[0].id, FindingId::kStopInPart) << "the listing ends in its slot";
}

TEST_F(SessionTest, SaysWhyItIsNoZmap) {
  write_listing("");
  options_.blank = parse_blank("box:-5,-9,-5:25,9,0").value();
  options_.tools.push_back(std::move(parse_tool_argument("1=tslot:8:1:4").value()));
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  EXPECT_EQ(report.stock->model, "mmap");
  EXPECT_NE(
      summary_text(report).find("          mmap because tool 1 (tslot:8:1:4) cuts undercuts\n"),
      std::string::npos)
      << summary_text(report);
  EXPECT_NE(json_text(report).find("\"model_reason\": \"tool 1 (tslot:8:1:4) cuts undercuts\""),
            std::string::npos);
}

/// A bar along X, 20 mm thick, on a table that turns about X: four flats, 8 mm from the middle.
class SessionOnATurningTable : public SessionTest {
 protected:
  SessionOnATurningTable() {
    std::ofstream listing(options_.program.path);
    listing << "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
            << "    2 N1     SELECT_TOOL(1)\n    3 N1     CHANGE_TOOL(1)\n"
            << "    4 N2     SET_SPINDLE_SPEED(0, 3000.0000)\n"
            << "    5 N2     START_SPINDLE_CLOCKWISE(0)\n    6 N2     SET_FEED_RATE(300.0000)\n";
    int number = 7;
    for (int side = 0; side < 4; ++side) {
      const auto step = [&](const char* command, double x, double z) {
        listing << "    " << number++ << " N" << 10 * side + 10 << "    " << command << "(" << x
                << ".0, 0.0, " << z << ".0, " << 90 * side << ".0, 0.0, 0.0)\n";
      };
      step("STRAIGHT_TRAVERSE", -20, 30);
      step("STRAIGHT_TRAVERSE", -20, 8);
      step("STRAIGHT_FEED", 50, 8);
      step("STRAIGHT_TRAVERSE", 50, 30);
    }
    listing << "    " << number << " N99    PROGRAM_END()\n";
    options_.blank = parse_blank("cylinder:0,0,0:30:20:x").value();
    options_.tools.push_back(std::move(parse_tool_argument("1=flat:30").value()));
    options_.stock.cell_mm = 0.4;
    options_.timeline.kinematics = std::make_shared<const MachineKinematics>(
        known_machine("trivkins", "XYZABC", {}, {}).value());
  }
};

TEST_F(SessionOnATurningTable, FourFlatsMakeASquareBar) {
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  EXPECT_EQ(report.stock->model, "octree");
  EXPECT_EQ(report.stock->model_reason, "the blank has a cylinder along x");
  // A disc of radius 10 less four segments beyond 8.
  const double segment = 100 * std::acos(0.8) - 8 * 6;
  const double expected = 30 * (kPi * 100 - 4 * segment);
  EXPECT_NEAR(report.stock->remaining_mm3, expected, 0.003 * expected);
  for (const Finding& finding : report.findings.kept()) {
    EXPECT_EQ(finding.id, FindingId::kKinematics) << finding.text;
  }
}

TEST_F(SessionOnATurningTable, ABoxBeginsAsAZmapAndAgainAsAnOctree) {
  options_.blank = parse_blank("box:0,-9,-9:30,9,9").value();
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  EXPECT_EQ(report.stock->model, "octree");
  EXPECT_EQ(report.stock->model_reason, "line 20 turns the tool or the workpiece: A90");
  EXPECT_NEAR(report.stock->remaining_mm3, 30 * 16 * 16, 5);
  EXPECT_EQ(report.motion.moves, 16U);
  EXPECT_EQ(recorder_.starts, 2);
}

TEST_F(SessionOnATurningTable, AZmapThatWasAskedForIsToldOfAsAnError) {
  options_.blank = parse_blank("box:0,-9,-9:30,9,9").value();
  options_.stock.kind = StockKind::kZmap;
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  EXPECT_EQ(report.stock->model, "zmap");
  ASSERT_EQ(report.findings.count(Severity::kError), 1U);
  const Finding& finding = report.findings.kept()[0];
  EXPECT_EQ(finding.id, FindingId::kRotaryIgnored);
  EXPECT_EQ(finding.source.line, 20U);
  EXPECT_EQ(finding.text,
            "A, B or C move, and the model zmap is for upright tools over a workpiece that lies "
            "still: it is cut as if they stood (--model octree follows them)");
}

TEST_F(SessionOnATurningTable, WithoutABlankItIsGuessedInTheWorkpiece) {
  options_.blank.reset();
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  EXPECT_EQ(report.stock->model, "octree");
  // The tip runs along four lines 8 mm from the middle.
  EXPECT_LE(report.stock->bounds_mm.min.z, -8);
  EXPECT_GE(report.stock->bounds_mm.max.y, 8);
  EXPECT_EQ(recorder_.starts, 1);
}

TEST_F(SessionOnATurningTable, AMachineWithoutTheAxisIsAnError) {
  options_.blank = parse_blank("box:0,-9,-9:30,9,9").value();
  options_.timeline.kinematics =
      std::make_shared<const MachineKinematics>(known_machine("trivkins", "XYZ", {}, {}).value());
  ASSERT_EQ(run(), Outcome::kFinished);
  const Report& report = session_->report();
  bool told = false;
  for (const Finding& finding : report.findings.kept()) {
    told |= finding.id == FindingId::kNoRotaryAxis && finding.source.line == 20;
  }
  EXPECT_TRUE(told);
}

TEST_F(SessionTest, TheZmapRefusesCylindersOnTheirSide) {
  write_listing("");
  options_.stock.kind = StockKind::kZmap;
  options_.blank = parse_blank("cylinder:0,0,-5:25:10:x").value();
  EXPECT_EQ(run(), Outcome::kUsageError);
  ASSERT_EQ(diagnostics_.size(), 1U);
  EXPECT_EQ(diagnostics_[0].message,
            "--stock: a Z-map cannot hold a cylinder along x; its axis must be z");
}

TEST_F(SessionTest, StopRequestedBeforehandGivesAPartialOrAWholeReport) {
  write_listing("");
  options_.blank = parse_blank("box:-5,-5,-5:25,5,0").value();
  std::stop_source stop;
  stop.request_stop();
  // A listing this short may be read whole before the stop is seen: then the report is complete.
  const Outcome outcome = run(stop.get_token());
  EXPECT_EQ(outcome == Outcome::kInterrupted, !session_->report().partial_reason.empty());
}

}  // namespace
}  // namespace kerf
