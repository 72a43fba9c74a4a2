// What looks say, held against what moves have removed: which parts count as cut, and which as air.
#include "twin/process/milling/engaged_parts.h"

#include <gtest/gtest.h>

#include <string>

#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

/// A letter a part: c cut, a in the air, ? not measured.
class Letters : public LoadListener {
 public:
  void on_load(const CutLoad& load) override {
    text += !load.is_measured ? '?' : load.is_engaged ? 'c' : 'a';
  }
  std::string text;
};

/// What the rows of --csv are told: a letter and the motion's number a part, `|N` where all before
/// N is said to be told.
class Rows : public MotionRecorder {
 public:
  void restart() override {}
  void name_files(const std::vector<std::string>&) override {}
  void on_step(std::uint64_t, const Motion&, const TimedStep&) override {}
  void on_cut(std::uint64_t, double, double) override {}
  void on_engaged(std::uint64_t number, const EngagementLook& look, const EngagedWay&) override {
    text += (look.is_engaged() ? 'c' : 'a') + std::to_string(number);
  }
  void on_engaged_until(std::uint64_t number) override { text += '|' + std::to_string(number); }
  std::string text;
};

class EngagedPartsTest : public testing::Test {
 protected:
  EngagedPartsTest() {
    loads_.mount(parse_shape("flat:10").value(), 1);
    parts_.set(nullptr, &letters_);
  }
  /// A move of 1 mm that is seen in material or in the air, and has removed so much.
  void move(bool seen, double removed_mm3, double front_mm = 0, double length_mm = 1) {
    EngagedParts::Done done = heard(seen, length_mm);
    done.is_whole = true;
    done.removed_mm3 = removed_mm3;
    done.depth_mm = removed_mm3 > 0 ? 1 : 0;
    done.front_mm = front_mm;
    parts_.judge(done);
  }
  EngagedParts::Done heard(bool seen, double length_mm = 1) {
    EngagementLook look;
    if (seen) look.angle_rad = 1, look.wide_mm = 3, look.deep_mm = 2;
    parts_.hear({look, {length_mm, length_mm / 5, 0}, {0, 1}, 0, Vec3(0), 0, 300});
    EngagedParts::Done done;
    done.parts = 1;
    done.reach_mm = 5, done.cell_mm = 0.1;
    return done;
  }
  void moves(int count, bool seen, double removed_mm3, double front_mm = 0) {
    for (int n = 0; n < count; ++n) move(seen, removed_mm3, front_mm);
  }
  std::string told() {
    parts_.end_way();
    return letters_.text;
  }

  FindingLog log_;
  CutLoads loads_{log_};
  Letters letters_;
  EngagedParts parts_{loads_};
};

TEST_F(EngagedPartsTest, WhatIsSeenAndRemovedIsCut) {
  moves(3, true, 5);
  EXPECT_EQ(told(), "ccc");
}

TEST_F(EngagedPartsTest, ALookThatStandsForTheAirBehindTheWallIsNoCut) {
  moves(2, true, 5);
  moves(3, true, 0);
  moves(2, false, 0);
  EXPECT_EQ(told(), "ccaaaaa");
}

TEST_F(EngagedPartsTest, WhereTheToolEntersItsFrontIsInMaterialBeforeAnythingCounts) {
  moves(2, false, 0);
  // Its front reaches 2 mm: of 4 mm that are seen in material, those.
  moves(4, true, 0);
  moves(2, true, 5, 2);
  EXPECT_EQ(told(), "aaaacccc");
}

TEST_F(EngagedPartsTest, FartherThanAToolReachesNothingWaits) {
  moves(8, true, 0);
  // The last 5 mm may be at a wall; what is before them is decided.
  EXPECT_EQ(letters_.text, "aaa");
  moves(1, true, 5, 5);
  EXPECT_EQ(told(), "aaacccccc");
}

TEST_F(EngagedPartsTest, AFewCellsRemoveNothingNowAndThen) {
  for (int n = 0; n < 3; ++n) {
    move(true, 0.01, 0, 0.1);
    move(true, 0, 0, 0.1);
  }
  move(true, 0.01, 0, 0.1);
  EXPECT_EQ(told(), "ccccccc");
}

TEST_F(EngagedPartsTest, WhatIsRemovedOnAWayThatWasSeenInTheAirIsNotMeasured) {
  moves(1, false, 0);
  moves(2, false, 0.5);
  moves(1, false, 0.0005);  // a skin
  EXPECT_EQ(told(), "a??a");
}

TEST_F(EngagedPartsTest, OfAMotionInSeveralMovesLooksAloneCount) {
  EngagedParts::Done done = heard(true);
  parts_.judge(done);
  done = heard(false);
  done.removed_mm3 = 5;
  parts_.judge(done);
  EXPECT_EQ(told(), "ca");
}

/// A spindle's load is held against what is told: late, it would count as idle.
TEST_F(EngagedPartsTest, BesideAMachineNothingWaits) {
  for (const double length_mm : {0.2, 1.0}) {
    EngagedParts::Done done = heard(true, length_mm);
    done.is_whole = true;
    done.may_wait = false;
    parts_.judge(done);
  }
  EXPECT_EQ(letters_.text, "ca") << "short parts are as they were seen";
}

/// Motions 0 to 4: cut, two behind a wall, one that is cut and was not seen, one in the air.
TEST_F(EngagedPartsTest, RowsAreToldWhatCounts) {
  Rows rows;
  parts_.set(nullptr, &letters_, &rows);
  const bool seen[] = {true, true, true, false, false};
  const double removed_mm3[] = {5, 0, 0, 5, 0};
  for (std::uint64_t n = 0; n < 5; ++n) {
    EngagedParts::Done done = heard(seen[n]);
    done.is_whole = true;
    done.motion = n;
    done.removed_mm3 = removed_mm3[n], done.depth_mm = removed_mm3[n] > 0 ? 1 : 0;
    done.front_mm = 1;
    parts_.judge(done);
  }
  EXPECT_EQ(rows.text, "c0|0|1|1a1c2|3a4|4");
  EXPECT_EQ(told(), "cac?a");
}

TEST_F(EngagedPartsTest, TheEndOfAWayEndsTheWaiting) {
  moves(2, true, 0);
  parts_.end_way();
  moves(1, true, 5, 5);
  EXPECT_EQ(told(), "aac");
}

}  // namespace
}  // namespace kerf
