#include "interp_bridge/motion_fold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>

namespace kerf {
namespace {

/// Folds calls written without sequence and N column, one a line.
struct Folded {
  std::vector<Motion> motions;
  std::vector<FoldRemark> remarks;

  explicit Folded(std::initializer_list<const char*> calls, std::vector<int> tool_by_index = {}) {
    MotionFold fold(std::move(tool_by_index));
    std::uint32_t number = 0;
    for (const char* call : calls) {
      const std::string text = "    1 N..... " + std::string(call);
      CanonicalLine line;
      parse_canonical_line(text, line);
      EXPECT_EQ(line.kind, CanonicalLineKind::kCommand) << call;
      const FoldRemark remark = fold.fold(line.command, {0, ++number}, motions);
      if (remark != FoldRemark::kNone) remarks.push_back(remark);
    }
    rotary = fold.has_rotary_motion();
    ended = fold.has_program_end();
  }
  const Motion& last() const { return motions.back(); }
  bool rotary = false;
  bool ended = false;
};

void expect_near(const Vec3& actual, const Vec3& expected, double tolerance = 1e-9) {
  EXPECT_LE(glm::length(actual - expected), tolerance)
      << actual.x << " " << actual.y << " " << actual.z << " instead of " << expected.x << " "
      << expected.y << " " << expected.z;
}

/// The point of an arc after the share `t` of its sweep.
Vec3 point_on(const Motion& motion, double t) {
  const Vec3 axis = motion.arc.axis;
  const Vec3 from = motion.from_mm - motion.arc.center_mm;
  const Vec3 to = motion.to_mm - motion.arc.center_mm;
  const Vec3 radial = from - axis * glm::dot(from, axis);
  const Vec3 radial_end = to - axis * glm::dot(to, axis);
  const double angle = motion.arc.sweep_rad * t;
  const Vec3 u = glm::normalize(radial);
  const Vec3 v = glm::cross(axis, u);
  const double radius = glm::length(radial) * (1 - t) + glm::length(radial_end) * t;
  const double along = glm::dot(from, axis) * (1 - t) + glm::dot(to, axis) * t;
  return motion.arc.center_mm + axis * along + (u * std::cos(angle) + v * std::sin(angle)) * radius;
}

TEST(MotionFold, PositionsAreThePrintedNumbers) {
  const Folded folded{"USE_LENGTH_UNITS(CANON_UNITS_MM)",
                      "STRAIGHT_TRAVERSE(1.1000, 2.2000, 3.3000, 0.0000, 0.0000, 0.0000)",
                      "SET_FEED_RATE(300.0000)",
                      "STRAIGHT_FEED(0.1000, -0.0000, 0.3000, 0.0000, 0.0000, 0.0000)"};
  ASSERT_EQ(folded.motions.size(), 2u);
  const Motion& feed = folded.last();
  EXPECT_EQ(feed.kind, MotionKind::kFeed);
  EXPECT_EQ(feed.from_mm, Vec3(1.1, 2.2, 3.3));
  EXPECT_EQ(feed.to_mm, Vec3(0.1, 0.0, 0.3));
  EXPECT_FALSE(std::signbit(feed.to_mm.y));
  EXPECT_EQ(feed.feed_mm_per_min, 300);
  EXPECT_EQ(feed.source, (SourceRef{0, 4}));
  EXPECT_EQ(folded.motions[0].feed_mm_per_min, 0) << "traverses have none";
}

TEST(MotionFold, TheFirstMotionHasNoStart) {
  const Folded folded{"DWELL(1.0)", "STRAIGHT_TRAVERSE(0, 0, 50, 0, 0, 0)",
                      "STRAIGHT_TRAVERSE(7, 0, 50, 0, 0, 0)"};
  EXPECT_FALSE(folded.motions[0].start_known);
  EXPECT_FALSE(folded.motions[1].start_known);
  EXPECT_EQ(folded.motions[1].from_mm, folded.motions[1].to_mm);
  EXPECT_EQ(folded.motions[1].to_mm, Vec3(0, 0, 50));
  EXPECT_TRUE(folded.motions[2].start_known);
  EXPECT_EQ(folded.motions[2].from_mm, Vec3(0, 0, 50));
}

TEST(MotionFold, InchNumbersAndFeedUseTheUnitInForceWhenPrinted) {
  const Folded folded{"USE_LENGTH_UNITS(CANON_UNITS_INCHES)", "SET_FEED_RATE(10)",
                      "STRAIGHT_FEED(1, 2, 0, 90, 0, 0)", "USE_LENGTH_UNITS(CANON_UNITS_MM)",
                      "STRAIGHT_FEED(25.4, 50.8, 1, 90, 0, 0)"};
  EXPECT_EQ(folded.motions[0].to_mm, Vec3(25.4, 50.8, 0));
  EXPECT_EQ(folded.motions[0].to_abc_deg[0], 90) << "degrees have no unit of length";
  EXPECT_EQ(folded.motions[1].feed_mm_per_min, 254) << "G21 does not reprint F";
  EXPECT_EQ(folded.motions[1].from_mm, Vec3(25.4, 50.8, 0));
}

TEST(MotionFold, OffsetsBeforeTheFirstMotionMakeTheWorkpieceFrame) {
  const Folded folded{"SET_G5X_OFFSET(1, 100, 50, -20, 0, 0, 5)",
                      "SET_G92_OFFSET(1, 2, 3, 0, 0, 0)", "SET_XY_ROTATION(30)",
                      "STRAIGHT_FEED(0.1, 0.2, 0.3, 0, 0, 45)"};
  EXPECT_EQ(folded.last().to_mm, Vec3(0.1, 0.2, 0.3)) << "bit for bit";
  EXPECT_EQ(folded.last().to_abc_deg[2], 45);
}

TEST(MotionFold, AnOffsetChangeMovesTheNumbersNotTheTool) {
  const Folded folded{"SET_G5X_OFFSET(1, 10, 0, 0, 0, 0, 0)", "STRAIGHT_TRAVERSE(5, 6, 7, 0, 0, 0)",
                      "SET_G5X_OFFSET(2, 110, 20, -3, 0, 0, 30)",
                      "STRAIGHT_FEED(-95, -14, 10, 0, 0, 0)", "STRAIGHT_FEED(0, 0, 0, 0, 0, 0)"};
  EXPECT_EQ(folded.motions[1].from_mm, Vec3(5, 6, 7));
  expect_near(folded.motions[1].to_mm, Vec3(5, 6, 7));
  expect_near(folded.motions[2].to_mm, Vec3(100, 20, -3));
  EXPECT_EQ(folded.motions[2].to_abc_deg[2], 30) << "rotary offsets add";
}

TEST(MotionFold, G92IsInsideTheRotation) {
  // tip = R(90) * (p + g92) + g5x, workpiece frame = machine frame
  const Folded folded{"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)",
                      "SET_G5X_OFFSET(1, 100, 0, 0, 0, 0, 0)", "SET_XY_ROTATION(90)",
                      "SET_G92_OFFSET(1, 2, 3, 0, 0, 0)", "STRAIGHT_FEED(10, 20, 30, 0, 0, 0)"};
  EXPECT_EQ(folded.last().to_mm, Vec3(100 - 22, 11, 33)) << "R90 keeps its digits";
}

TEST(MotionFold, RotationWithinARotatedWorkpieceFrame) {
  const Folded folded{"SET_G5X_OFFSET(1, 10, 20, 0, 0, 0, 0)", "SET_XY_ROTATION(20)",
                      "STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)", "SET_XY_ROTATION(50)",
                      "STRAIGHT_FEED(10, 0, 0, 0, 0, 0)"};
  const double angle = 30 * kPi / 180;
  expect_near(folded.last().to_mm, Vec3(10 * std::cos(angle), 10 * std::sin(angle), 0));
}

TEST(MotionFold, GoingBackToTheFirstFrameIsExact) {
  const Folded folded{"STRAIGHT_TRAVERSE(0.1, 0.2, 0.3, 0, 0, 0)", "SET_XY_ROTATION(33)",
                      "STRAIGHT_FEED(1, 1, 1, 0, 0, 0)", "SET_XY_ROTATION(0)",
                      "STRAIGHT_FEED(0.7, 0.2, 0.3, 0, 0, 0)"};
  EXPECT_EQ(folded.last().to_mm, Vec3(0.7, 0.2, 0.3));
  EXPECT_EQ(folded.last().from_mm, folded.motions[1].to_mm);
}

TEST(MotionFold, ToolLengthCancelsAtTheTip) {
  const Folded folded{"STRAIGHT_TRAVERSE(0, 0, 100, 0, 0, 0)",
                      "USE_TOOL_LENGTH_OFFSET(0 0 40, 0 0 0, 0 0 0)",
                      "STRAIGHT_TRAVERSE(10, 0, 60, 0, 0, 0)"};
  // The machine stands; with a tool of 40 mm its tip is 40 mm lower than the gauge point was.
  EXPECT_EQ(folded.last().from_mm, Vec3(0, 0, 60));
  EXPECT_EQ(folded.last().to_mm, Vec3(10, 0, 60)) << "the printed number is the tip";
}

TEST(MotionFold, ArcsInThreePlanes) {
  struct Case {
    const char* plane;
    const char* start;
    const char* arc;
    Vec3 center;
    Vec3 axis;
    double sweep;
  };
  const std::vector<Case> cases = {
      {"SELECT_PLANE(CANON_PLANE_XY)",
       "STRAIGHT_TRAVERSE(10, 0, 5, 0, 0, 0)",
       "ARC_FEED(0, 10, 0, 0, 1, 6, 0, 0, 0)",
       {0, 0, 5},
       {0, 0, 1},
       kPi / 2},
      {"SELECT_PLANE(CANON_PLANE_XY)",
       "STRAIGHT_TRAVERSE(10, 0, 5, 0, 0, 0)",
       "ARC_FEED(0, 10, 0, 0, -1, 6, 0, 0, 0)",
       {0, 0, 5},
       {0, 0, 1},
       -3 * kPi / 2},
      // first = z, second = x: from +z to +x is counter-clockwise about +y
      {"SELECT_PLANE(CANON_PLANE_XZ)",
       "STRAIGHT_TRAVERSE(0, 5, 10, 0, 0, 0)",
       "ARC_FEED(0, 10, 0, 0, 1, 6, 0, 0, 0)",
       {0, 5, 0},
       {0, 1, 0},
       kPi / 2},
      {"SELECT_PLANE(CANON_PLANE_YZ)",
       "STRAIGHT_TRAVERSE(5, 10, 0, 0, 0, 0)",
       "ARC_FEED(0, 10, 0, 0, 1, 6, 0, 0, 0)",
       {5, 0, 0},
       {1, 0, 0},
       kPi / 2}};
  for (const Case& one : cases) {
    const Folded folded{one.plane, one.start, one.arc};
    const Motion& arc = folded.last();
    EXPECT_EQ(arc.kind, MotionKind::kArc);
    expect_near(arc.arc.center_mm, one.center);
    expect_near(arc.arc.axis, one.axis);
    EXPECT_NEAR(arc.arc.sweep_rad, one.sweep, 1e-12) << one.plane;
    expect_near(point_on(arc, 1), arc.to_mm);
  }
}

TEST(MotionFold, SeveralTurns) {
  const Folded folded{"STRAIGHT_TRAVERSE(20, -10, -1, 0, 0, 0)",
                      "ARC_FEED(20, -10, 25, -10, 3, -4, 0, 0, 0)",
                      "ARC_FEED(25, -5, 25, -10, -2, -4, 0, 0, 0)"};
  EXPECT_NEAR(folded.motions[1].arc.sweep_rad, 6 * kPi, 1e-12);
  EXPECT_NEAR(folded.motions[2].arc.sweep_rad, -(2 * kPi + kPi / 2), 1e-12);
}

TEST(MotionFold, FullCircleAndItsRounding) {
  const Folded exact{"STRAIGHT_TRAVERSE(10, 0, 0, 0, 0, 0)",
                     "ARC_FEED(10, 0, 3, 7, -1, 0, 0, 0, 0)"};
  EXPECT_NEAR(exact.last().arc.sweep_rad, -2 * kPi, 1e-12);
  // A frame that changed in between leaves the start with other rounding than the end.
  const Folded moved{"STRAIGHT_TRAVERSE(10, 0, 0, 0, 0, 0)", "SET_XY_ROTATION(17)",
                     "ARC_FEED(9.5630, -2.9237, 0, 0, 1, 0, 0, 0, 0)"};
  EXPECT_NEAR(moved.last().arc.sweep_rad, 2 * kPi, 1e-4);
  // A spiral that ends on the ray it began on.
  const Folded spiral{"STRAIGHT_TRAVERSE(7.0711, 7.0711, 0, 0, 0, 0)",
                      "ARC_FEED(7.0852, 7.0853, 0, 0, 1, 0, 0, 0, 0)"};
  EXPECT_NEAR(spiral.last().arc.sweep_rad, 2 * kPi, 1e-4);
  // But a short arc stays one.
  const Folded tiny{"STRAIGHT_TRAVERSE(10, 0, 0, 0, 0, 0)",
                    "ARC_FEED(10, 0.0002, 0, 0, 1, 0, 0, 0, 0)"};
  EXPECT_NEAR(tiny.last().arc.sweep_rad, 2e-5, 1e-9);
}

TEST(MotionFold, ArcUnderRotationIsTheTurnedArc) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-170, 170);
  for (const char* plane : {"SELECT_PLANE(CANON_PLANE_XY)", "SELECT_PLANE(CANON_PLANE_XZ)",
                            "SELECT_PLANE(CANON_PLANE_YZ)"}) {
    const double degrees = std::round(angle(random));
    const std::string rotation = "SET_XY_ROTATION(" + std::to_string(degrees) + ")";
    const char* const start = "STRAIGHT_TRAVERSE(8, 8, 8, 0, 0, 0)";
    const char* const arc = "ARC_FEED(2, 2, 5, 5, 1, 9, 0, 0, 0)";
    const Folded plain{plane, start, arc};
    const Folded turned{plane, "STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)", rotation.c_str(), start, arc};
    const double c = std::cos(degrees * kPi / 180);
    const double s = std::sin(degrees * kPi / 180);
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Vec3 p = point_on(plain.last(), t);
      expect_near(point_on(turned.last(), t), Vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z),
                  1e-9);
    }
    EXPECT_NEAR(glm::length(turned.last().arc.axis), 1, 1e-12);
  }
}

TEST(MotionFold, ArcWithoutRadiusOrRotationIsStraight) {
  const Folded folded{"STRAIGHT_TRAVERSE(1, 1, 1, 0, 0, 0)", "ARC_FEED(5, 1, 3, 1, 0, 1, 0, 0, 0)",
                      "ARC_FEED(5, 1, 5, 1, 1, 0, 0, 0, 0)"};
  EXPECT_EQ(folded.motions[1].kind, MotionKind::kFeed);
  EXPECT_EQ(folded.motions[2].kind, MotionKind::kFeed);
  EXPECT_EQ(folded.motions[2].to_mm, Vec3(5, 1, 0));
}

TEST(MotionFold, LastSelectedToolIsTheNewOne) {
  const Folded folded{
      "CHANGE_TOOL(0)", "SELECT_TOOL(20)", "START_CHANGE()", "CHANGE_TOOL(3)",
      "SELECT_TOOL(0)", "CHANGE_TOOL()",   "SELECT_TOOL(7)", "STRAIGHT_FEED(1, 0, 0, 0, 0, 0)"};
  ASSERT_EQ(folded.motions.size(), 4u);
  EXPECT_EQ(folded.motions[0].tool, 0) << "M6 without T";
  EXPECT_EQ(folded.motions[1].kind, MotionKind::kToolChange);
  EXPECT_EQ(folded.motions[1].tool, 20) << "the argument of CHANGE_TOOL is a row";
  EXPECT_EQ(folded.motions[2].tool, 0) << "T0 M6";
  EXPECT_EQ(folded.last().tool, 0) << "T without M6";
}

TEST(MotionFold, M61NamesARowOfTheTable) {
  EXPECT_EQ(Folded({"CHANGE_TOOL_NUMBER(2)"}, {0, 11, 22}).last().tool, 22);
  EXPECT_EQ(Folded({"CHANGE_TOOL_NUMBER(2)"}).last().tool, 2);
  EXPECT_EQ(Folded({"CHANGE_TOOL_NUMBER(0)"}, {0, 11}).last().tool, 0);
}

TEST(MotionFold, ThreadsAndRigidTaps) {
  const Folded folded{"SET_FEED_RATE(100)",
                      "STRAIGHT_TRAVERSE(60, 0, -10, 0, 0, 0)",
                      "START_SPEED_FEED_SYNC(1.5,0)",
                      "STRAIGHT_FEED(60, 0, -20, 0, 0, 0)",
                      "RIGID_TAP(60, 0, -30)",
                      "STOP_SPEED_FEED_SYNCH()",
                      "STRAIGHT_FEED(61, 0, -20, 0, 0, 0)"};
  ASSERT_EQ(folded.motions.size(), 5u);
  EXPECT_EQ(folded.motions[1].kind, MotionKind::kThread);
  EXPECT_TRUE(folded.motions[1].feed_per_rev);
  EXPECT_EQ(folded.motions[1].feed_mm_per_min, 1.5);
  EXPECT_EQ(folded.motions[2].to_mm, Vec3(60, 0, -30));
  EXPECT_EQ(folded.motions[3].from_mm, Vec3(60, 0, -30));
  EXPECT_EQ(folded.motions[3].to_mm, Vec3(60, 0, -20)) << "back where the tap began";
  EXPECT_EQ(folded.motions[4].kind, MotionKind::kFeed);
  EXPECT_EQ(folded.motions[4].feed_mm_per_min, 100);
}

TEST(MotionFold, FeedModes) {
  const Folded folded{
      "SET_FEED_MODE(0, 1)", "SET_FEED_RATE(0.2)", "STRAIGHT_FEED(1, 0, 0, 0, 0, 0)",
      "SET_FEED_MODE(0, 0)", "SET_FEED_RATE(20)",  "STRAIGHT_FEED(2, 0, 0, 0, 0, 0)"};
  EXPECT_TRUE(folded.motions[0].feed_per_rev);
  EXPECT_EQ(folded.motions[0].feed_mm_per_min, 0.2);
  EXPECT_FALSE(folded.motions[1].feed_per_rev);
  EXPECT_EQ(folded.motions[1].feed_mm_per_min, 20);
}

TEST(MotionFold, RotaryMoves) {
  const Folded still{"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)", "STRAIGHT_FEED(1, 0, 0, 0, 0, 0)"};
  EXPECT_FALSE(still.rotary);
  const Folded folded{"USE_LENGTH_UNITS(CANON_UNITS_INCHES)", "SET_FEED_RATE(1000)",
                      "STRAIGHT_TRAVERSE(1, 0, 0, 0, 0, 0)",
                      "STRAIGHT_FEED(1, 0, 0, 90, -30, 400)"};
  EXPECT_TRUE(folded.rotary);
  EXPECT_EQ(folded.last().to_abc_deg, (std::array<double, 3>{90, -30, 400}));
  EXPECT_EQ(folded.last().feed_mm_per_min, 1000) << "degrees a minute, not inches";
}

/// Calls as kerf-interp records them: with U, V, W, which listings do not hold.
struct Recorded {
  MotionFold fold;
  std::vector<Motion> motions;
  Recorded& call(CanonicalName name, std::initializer_list<double> numbers) {
    CanonicalCommand command;
    command.name = name;
    for (const double number : numbers) command.arguments[command.argument_count++] = number;
    fold.fold(command, {0, 1}, motions);
    return *this;
  }
};

TEST(MotionFold, SecondaryAxesAddTheirOffsetsInMm) {
  using enum CanonicalName;
  Recorded r;
  r.call(kUseLengthUnits, {0})
      .call(kSetG5xOffset, {1, 0, 0, 0, 0, 0, 0, 1, 2, 3})
      .call(kSetG92Offset, {0, 0, 0, 0, 0, 0, 0, 0, 0.5})
      .call(kSetFeedRate, {10})
      .call(kStraightTraverse, {1, 0, 0, 0, 0, 0, 1, 2, -4})
      .call(kStraightFeed, {1, 0, 0, 30, 0, 0, 1, 2, -3});
  const Motion& feed = r.motions.back();
  EXPECT_EQ(r.fold.workpiece_frame().offset_uvw_mm, Vec3(25.4, 50.8, 3.5 * 25.4));
  EXPECT_EQ(feed.from_uvw_mm, Vec3(25.4, 50.8, -4 * 25.4)) << "under the first offset";
  EXPECT_EQ(feed.to_uvw_mm, Vec3(25.4, 50.8, -3 * 25.4));
  EXPECT_EQ(feed.feed_mm_per_min, 254) << "W moves: no degrees a minute";
  // Another offset moves the program's numbers, not the slides; so does a tool's.
  r.call(kSetG5xOffset, {2, 0, 0, 0, 0, 0, 0, 1, 2, 1});
  r.call(kStraightFeed, {1, 0, 0, 30, 0, 0, 1, 2, -1});
  expect_near(r.motions.back().from_uvw_mm, r.motions.back().to_uvw_mm);
  r.call(kUseToolLengthOffset, {0, 0, 0, 0, 0, 0, 0, 0, 2});
  r.call(kStraightFeed, {1, 0, 0, 30, 0, 0, 1, 2, -1});
  EXPECT_EQ(r.motions.back().tool_offset_uvw_mm, Vec3(0, 0, 50.8));
  expect_near(r.motions.back().to_uvw_mm - r.motions.back().from_uvw_mm, {0, 0, 50.8});
}

TEST(MotionFold, ArcsCarryTheSecondaryAxesAlong) {
  using enum CanonicalName;
  Recorded r;
  r.call(kUseLengthUnits, {1}).call(kStraightTraverse, {10, 0, 0, 0, 0, 0, 0, 0, 5});
  r.call(kArcFeed, {-10, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 8});
  EXPECT_EQ(r.motions.back().from_uvw_mm, Vec3(0, 0, 5));
  EXPECT_EQ(r.motions.back().to_uvw_mm, Vec3(0, 0, 8));
}

TEST(MotionFold, SpindleAndCoolant) {
  const Folded folded{"SET_SPINDLE_SPEED(0, 1200)",
                      "START_SPINDLE_COUNTERCLOCKWISE(0)",
                      "MIST_ON()",
                      "FLOOD_ON()",
                      "DWELL(0.5)",
                      "STOP_SPINDLE_TURNING(-1)",
                      "MIST_OFF()",
                      "PROGRAM_STOP()",
                      "START_SPINDLE_CLOCKWISE(1)",
                      "OPTIONAL_PROGRAM_STOP()"};
  EXPECT_EQ(folded.motions[0].spindle, SpindleState::kCounterclockwise);
  EXPECT_EQ(folded.motions[0].spindle_rpm, 1200);
  EXPECT_TRUE(folded.motions[0].flood && folded.motions[0].mist);
  EXPECT_EQ(folded.motions[0].duration_s, 0.5);
  EXPECT_EQ(folded.motions[1].kind, MotionKind::kStop);
  EXPECT_EQ(folded.motions[1].spindle, SpindleState::kStopped);
  EXPECT_TRUE(folded.motions[1].flood && !folded.motions[1].mist);
  EXPECT_EQ(folded.motions[2].spindle, SpindleState::kClockwise) << "a second spindle";
}

TEST(MotionFold, ConstantSurfaceSpeed) {
  const Folded folded{"START_SPINDLE_CLOCKWISE(0)", "SET_SPINDLE_MODE(0 2500)",
                      "SET_SPINDLE_SPEED(0, 120)", "STRAIGHT_TRAVERSE(30, 0, 0, 0, 0, 0)",
                      "STRAIGHT_FEED(0, 0, 0, 0, 0, 0)"};
  EXPECT_NEAR(folded.motions[0].spindle_rpm, 120'000 / (2 * kPi * 30), 1e-9);
  EXPECT_EQ(folded.motions[1].spindle_rpm, 2500) << "the cap";
}

TEST(MotionFold, ALostSplineMakesTheNextStartUnknown) {
  const Folded folded{"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)", "NURBS_FEED(4, ...)",
                      "STRAIGHT_FEED(9, 0, 0, 0, 0, 0)", "STRAIGHT_FEED(10, 0, 0, 0, 0, 0)"};
  EXPECT_EQ(folded.remarks, std::vector<FoldRemark>{FoldRemark::kSplineLost});
  EXPECT_FALSE(folded.motions[1].start_known);
  EXPECT_EQ(folded.motions[1].to_mm, Vec3(9, 0, 0));
  EXPECT_TRUE(folded.motions[2].start_known);
}

TEST(MotionFold, ArcInAPlaneOfUvwIsReported) {
  const Folded folded{"SELECT_PLANE(CANON_PLANE_UNKNOWN)", "STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)",
                      "ARC_FEED(1, 0, 0, 0, 1, 0, 0, 0, 0)"};
  EXPECT_EQ(folded.remarks, std::vector<FoldRemark>{FoldRemark::kArcPlaneUnknown});
  EXPECT_EQ(folded.motions.size(), 1u);
}

TEST(MotionFold, PathModeAndItsTolerancesInMm) {
  const Folded folded{"STRAIGHT_TRAVERSE(0, 0, 0, 0, 0, 0)",
                      "USE_LENGTH_UNITS(CANON_UNITS_INCHES)",
                      "SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, 0.010000)",
                      "SET_NAIVECAM_TOLERANCE(0.0050)",
                      "STRAIGHT_FEED(1, 0, 0, 0, 0, 0)",
                      "SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)",
                      "STRAIGHT_FEED(2, 0, 0, 0, 0, 0)",
                      "SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)",
                      "STRAIGHT_FEED(3, 0, 0, 0, 0, 0)"};
  ASSERT_EQ(folded.motions.size(), 4u);
  EXPECT_EQ(folded.motions[0].path_mode, PathMode::kContinuous) << "as LinuxCNC begins";
  EXPECT_EQ(folded.motions[0].blend_tolerance_mm, 0);
  EXPECT_EQ(folded.motions[1].path_mode, PathMode::kContinuous);
  EXPECT_FLOAT_EQ(folded.motions[1].blend_tolerance_mm, 0.254F);
  EXPECT_FLOAT_EQ(folded.motions[1].merge_tolerance_mm, 0.127F);
  EXPECT_EQ(folded.motions[2].path_mode, PathMode::kExactStop);
  EXPECT_EQ(folded.motions[2].blend_tolerance_mm, 0);
  EXPECT_EQ(folded.motions[3].path_mode, PathMode::kExactPath);
}

TEST(MotionFold, ProbeAndProgramEnd) {
  const Folded folded{"STRAIGHT_PROBE(0, 0, -50, 0, 0, 0)", "PROGRAM_END()"};
  EXPECT_EQ(folded.motions[0].kind, MotionKind::kProbe);
  EXPECT_EQ(folded.motions[1].kind, MotionKind::kProgramEnd);
  EXPECT_TRUE(folded.ended);
  EXPECT_TRUE(Folded({"FINISH()"}).ended);
}

/// M3 and M5 without a move between them leave no other trace.
TEST(MotionFold, SignalsTellWhatIsSwitchedWhereNothingMoves) {
  const auto folded = [](bool wanted) {
    MotionFold fold;
    fold.set_signals(wanted);
    std::vector<Motion> motions;
    std::uint32_t number = 0;
    for (const char* const call :
         {"STRAIGHT_TRAVERSE(1.0, 2.0, 3.0, 0.0, 0.0, 0.0)", "SET_SPINDLE_SPEED(0, 1.0000)",
          "START_SPINDLE_CLOCKWISE(0)", "START_SPINDLE_CLOCKWISE(0)", "STOP_SPINDLE_TURNING(0)",
          "SET_AUX_OUTPUT_BIT(5)", "SET_MOTION_OUTPUT_BIT(6)", "SET_FEED_RATE(100.0)", "FLOOD_ON()",
          "DWELL(0.5)"}) {
      CanonicalLine line;
      const std::string text = std::string("    1 N..... ") + call;
      parse_canonical_line(text, line);
      EXPECT_EQ(line.kind, CanonicalLineKind::kCommand) << call;
      fold.fold(line.command, {0, ++number}, motions);
    }
    fold.signal(123, {0, ++number}, motions);
    return motions;
  };
  EXPECT_EQ(folded(false).size(), 3U);
  const std::vector<Motion> motions = folded(true);
  ASSERT_EQ(motions.size(), 8U);
  EXPECT_EQ(motions[1].kind, MotionKind::kSignal) << "S";
  EXPECT_EQ(motions[2].source.line, 3U) << "a second M3 switches nothing";
  EXPECT_EQ(motions[2].torch.spindles_on, 1);
  EXPECT_EQ(motions[2].to_mm, Vec3(1, 2, 3));
  EXPECT_TRUE(motions[2].start_known);
  EXPECT_EQ(motions[3].torch.spindles_on, 0);
  EXPECT_TRUE(motions[4].torch.output(5));
  EXPECT_TRUE(motions[5].flood);
  EXPECT_FALSE(motions[5].torch.output(6)) << "M62 takes effect with the next move";
  EXPECT_EQ(motions[6].kind, MotionKind::kDwell);
  EXPECT_EQ(motions[7].user_m, 123);
}

}  // namespace
}  // namespace kerf
