// Strokes of punches against closed forms and against every point by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stock/sheet/blank_area.h"
#include "stock/sheet/punch_hits.h"
#include "stock/sheet/punch_shape.h"
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

using test::make_sheet;

constexpr double kTolerance_mm = 0.002;
/// Corners are rounded to tenths of a micrometre: times the way round a shape of a few cm.
constexpr double kRounding_mm2 = 0.005;
/// Arcs keep their area.
constexpr double kArcs_mm2 = 0.01;

Cutter punch(const std::string& shape) {
  return std::move(*punch_cutter("punch:" + shape, *parse_punch_shape(shape, kTolerance_mm)));
}

double degrees(double value) { return value * kPi / 180; }

std::unique_ptr<Sheet> plate() { return make_sheet(rectangle_outline({0, 0}, {200, 100})); }

/// Area that strokes of one id take out of a fresh sheet.
double punched(const std::string& shape, const std::vector<CutMove>& strokes) {
  const std::unique_ptr<Sheet> sheet = plate();
  std::vector<CutReport> reports;
  sheet->cut(punch(shape), strokes, reports);
  EXPECT_EQ(reports.size(), strokes.size());
  double removed = 0;
  for (const CutReport& report : reports) removed += report.removed_mm3;
  EXPECT_NEAR(removed, (20000 - sheet->remaining_mm2()) * sheet->thickness_mm(), 1e-6);
  return 20000 - sheet->remaining_mm2();
}

double lens(double r, double d) {
  return 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
}

TEST(SheetPunch, SingleStrokesTakeTheirShape) {
  const auto at = [](double turn_deg) {
    return std::vector<CutMove>{punch_stroke({100.3, 50.7, -1}, degrees(turn_deg), 0)};
  };
  EXPECT_NEAR(punched("round:10", at(0)), kPi * 25, kArcs_mm2);
  EXPECT_NEAR(punched("round:10", at(77)), kPi * 25, kArcs_mm2);
  EXPECT_NEAR(punched("square:10", at(0)), 100, 1e-9);
  EXPECT_NEAR(punched("square:10", at(90)), 100, 1e-9);
  EXPECT_NEAR(punched("square:10", at(-270)), 100, 1e-9);
  EXPECT_NEAR(punched("square:10", at(30)), 100, kRounding_mm2);
  EXPECT_NEAR(punched("rectangle:40:5", at(-117)), 200, kRounding_mm2);
  EXPECT_NEAR(punched("obround:20:6", at(0)), 14 * 6 + kPi * 9, kArcs_mm2);
  EXPECT_NEAR(punched("obround:20:6", at(45)), 14 * 6 + kPi * 9, kArcs_mm2);
  EXPECT_NEAR(punched("polygon:6:14", at(12)), 6 * 0.5 * 49 * std::sin(kPi / 3), kRounding_mm2);
}

TEST(SheetPunch, TurnsCounterClockwise) {
  const std::unique_ptr<Sheet> sheet = plate();
  std::vector<CutReport> reports;
  sheet->cut(punch("rectangle:40:2"),
             std::vector<CutMove>{punch_stroke({100, 50, 0}, degrees(30), 0)}, reports);
  const Vec2 end = 19.0 * Vec2(std::cos(degrees(30)), std::sin(degrees(30)));
  EXPECT_FALSE(sheet->has_material(Vec2(100, 50) + end));
  EXPECT_FALSE(sheet->has_material(Vec2(100, 50) - end));
  EXPECT_TRUE(sheet->has_material({100 + end.x, 50 - end.y}));
}

/// Neighbours alone overlap beyond what they share with the strokes before them.
TEST(SheetPunch, RowsOfDiscsHaveTheAreaOfTheirUnion) {
  const double r = 5;
  for (const double pitch : {0.7, 3.0, 7.0, 9.9}) {
    std::vector<CutMove> row;
    const int steps = static_cast<int>(100 / pitch);
    const Vec3 along(0.96, 0.28, 0);
    for (int i = 0; i <= steps; ++i)
      row.push_back(punch_stroke(Vec3(40, 30, 0) + i * pitch * along, 0, 0));
    const double expected = kPi * r * r + steps * (kPi * r * r - lens(r, pitch));
    EXPECT_NEAR(punched("round:10", row), expected, 1e-4 * expected) << pitch;
  }
  // Along an arc of radius 30: every second stroke lies clear.
  const double step_rad = 7.0 / 30, chord = 2 * 30 * std::sin(step_rad / 2);
  std::vector<CutMove> row;
  for (int i = 0; i <= 12; ++i) {
    row.push_back(punch_stroke(
        {100 + 30 * std::cos(i * step_rad), 50 + 30 * std::sin(i * step_rad), 0}, 0, 0));
  }
  const double expected = 13 * kPi * r * r - 12 * lens(r, chord);
  EXPECT_NEAR(punched("round:10", row), expected, 1e-4 * expected);
}

/// One operation for many strokes, and one for each, leave the same sheet but for rounding.
TEST(SheetPunch, StrokesTogetherAreStrokesOneByOne) {
  std::vector<CutMove> row;
  for (int i = 0; i < 150; ++i) row.push_back(punch_stroke({20 + 0.9 * i, 50, 0}, 0.02 * i, 7));
  const double together = punched("obround:20:6", row);
  for (std::size_t i = 0; i < row.size(); ++i) row[i].id = i;
  EXPECT_NEAR(punched("obround:20:6", row), together, 0.02);
  // The first report of those that go together has their volume.
  const std::unique_ptr<Sheet> sheet = plate();
  std::vector<CutReport> reports;
  for (CutMove& stroke : row) stroke.id = 3;
  sheet->cut(punch("obround:20:6"), row, reports);
  ASSERT_EQ(reports.size(), row.size());
  EXPECT_GT(reports[0].removed_mm3, 0);
  EXPECT_EQ(reports[1].removed_mm3, 0);
  EXPECT_EQ(reports[sheet::kMostStrokes].id, 3U);
  EXPECT_GT(reports[sheet::kMostStrokes].removed_mm3, 0);
}

TEST(SheetPunch, SlugsAndPartsComeFreeByTheStrokeThatPartsThem) {
  const std::unique_ptr<Sheet> sheet = plate();
  std::vector<CutReport> reports;
  // Four slits of 30 x 5 round a square of 20.
  const std::vector<CutMove> slits{
      punch_stroke({100, 37.5, 0}, 0, 11), punch_stroke({100, 62.5, 0}, degrees(180), 12),
      punch_stroke({87.5, 50, 0}, degrees(90), 13), punch_stroke({112.5, 50, 0}, degrees(90), 14)};
  sheet->cut(punch("rectangle:30:5"), slits, reports);
  ASSERT_EQ(sheet->pieces().size(), 2U);
  const SheetPiece part = sheet->pieces()[1];
  EXPECT_EQ(part.freed_by, 14U);
  EXPECT_NEAR(part.area_mm2, 400, 1e-9);
  EXPECT_NEAR(sheet->remaining_mm2(), 20000 - 4 * 150 + 4 * 25, 1e-9);
}

/// A punch with a hole in it (from a drawing) leaves what lies within.
TEST(SheetPunch, FootprintsMayHaveHoles) {
  PlaneOutline frame = rectangle_outline({-10, -10}, {10, 10});
  frame.rings.push_back({{-8, -8}, {8, -8}, {8, 8}, {-8, 8}});
  const Cutter cutter = std::move(*punch_cutter("punch:frame", frame));
  EXPECT_NEAR(cutter.radius_mm(), std::hypot(10, 10), 1e-9);
  const std::unique_ptr<Sheet> sheet = plate();
  std::vector<CutReport> reports;
  sheet->cut(cutter, std::vector<CutMove>{punch_stroke({50, 50, 0}, degrees(10), 0)}, reports);
  EXPECT_NEAR(20000 - sheet->remaining_mm2(), 400 - 256, kRounding_mm2);
  ASSERT_EQ(sheet->pieces().size(), 2U);
  EXPECT_NEAR(sheet->pieces()[1].area_mm2, 256, kRounding_mm2);
  // What one stroke leaves within, another may take.
  sheet->cut(
      cutter,
      std::vector<CutMove>{punch_stroke({150, 50, 0}, 0, 1), punch_stroke({159, 50, 0}, 0, 1)},
      reports);
  EXPECT_FALSE(sheet->has_material({150, 50}));
}

TEST(SheetPunch, NumbersBeyondAllBoundsTakeNothing) {
  const double nan = std::nan("");
  EXPECT_EQ(punched("round:10", {punch_stroke({nan, 50, 0}, 0, 0)}), 0);
  EXPECT_EQ(punched("round:10", {punch_stroke({50, 50, 0}, nan, 0)}), 0);
  EXPECT_EQ(punched("round:10", {punch_stroke({1e300, 50, 0}, 0, 0)}), 0);
  EXPECT_EQ(punched("round:10", {punch_stroke({-300, 50, 0}, 0, 0)}), 0);
}

TEST(SheetPunch, OverlapIsThatOfTheShapes) {
  const Cutter disc = punch("round:10");
  const PlaneOutline a = footprint_at(disc, punch_stroke({0, 0, 0}, 0, 0));
  EXPECT_NEAR(overlap_mm2(a, footprint_at(disc, punch_stroke({4, 3, 0}, 1, 0))), lens(5, 5),
              kArcs_mm2);
  EXPECT_EQ(overlap_mm2(a, footprint_at(disc, punch_stroke({10.01, 0, 0}, 0, 0))), 0);
  EXPECT_NEAR(overlap_mm2(a, rectangle_outline({0, -50}, {50, 50})), kPi * 12.5, kArcs_mm2);
}

/// Whether p lies in the shape at its place, and how far from its edge at least: negative inside.
double distance_to(const std::string& kind, const CutMove& stroke, const Vec2& p) {
  const Vec2 out = p - Vec2(stroke.to_mm);
  const double c = std::cos(turn_of(stroke)), s = std::sin(turn_of(stroke));
  const Vec2 q(std::abs(c * out.x + s * out.y), std::abs(-s * out.x + c * out.y));
  if (kind == "round:14") return std::hypot(q.x, q.y) - 7;
  if (kind == "obround:24:8") return std::hypot(std::max(q.x - 8, 0.0), q.y) - 4;
  return std::max(q.x - 15, q.y - 3);  // rectangle:30:6
}

TEST(SheetPunch, AgreesWithEveryPointByItself) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> x(-10, 210), y(-10, 110), turn(-400, 400);
  for (const std::string kind : {"round:14", "obround:24:8", "rectangle:30:6"}) {
    const std::unique_ptr<Sheet> sheet = plate();
    std::vector<CutMove> strokes;
    for (std::uint64_t i = 0; i < 40; ++i) {
      strokes.push_back(punch_stroke({x(random), y(random), 0}, degrees(turn(random)), i / 7));
    }
    std::vector<CutReport> reports;
    sheet->cut(punch(kind), strokes, reports);
    int wrong = 0, seen = 0;
    for (double px = 0.25; px < 200; px += 0.5) {
      for (double py = 0.25; py < 100; py += 0.5) {
        double nearest = 1e9;
        for (const CutMove& stroke : strokes) {
          nearest = std::min(nearest, distance_to(kind, stroke, {px, py}));
        }
        if (std::abs(nearest) < 2 * kTolerance_mm) continue;
        ++seen;
        wrong += sheet->has_material({px, py}) != (nearest > 0) ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << kind;
    EXPECT_GT(seen, 79000);
  }
}

TEST(BlankArea, SharesOfStrokesAtTheEdgeByClosedForms) {
  const BlankArea blank(plate()->outline());
  const auto share = [&](const std::string& shape, const Vec2& place, double turn_deg = 0) {
    return blank.share_of(
        footprint_at(punch(shape), punch_stroke(Vec3(place, 0), degrees(turn_deg), 0)));
  };
  EXPECT_EQ(share("round:10", {100, 50}), 1);
  EXPECT_EQ(share("rectangle:200:100", {100, 50}), 1) << "the whole of it";
  EXPECT_EQ(share("round:10", {-5.01, 50}), 0);
  EXPECT_EQ(share("round:10", {300, 300}), 0);
  EXPECT_EQ(share("round:10", {1e15, 0}), 0) << "no shape there";
  EXPECT_NEAR(share("square:10", {200, 50}), 0.5, 1e-9);
  EXPECT_NEAR(share("square:10", {198, 1}), 0.7 * 0.6, 1e-9) << "a corner";
  EXPECT_NEAR(share("round:10", {200, 0}), 0.25, 1e-6);
  EXPECT_NEAR(share("square:10", {0, 50}, 45), 0.5, 1e-6);
  // A segment of a circle, d beyond its centre.
  const double d = 2, segment = 25 * std::acos(d / 5) - d * std::sqrt(25 - d * d);
  EXPECT_NEAR(share("round:10", {100, 102}), segment / (25 * kPi), 1e-4);
  EXPECT_EQ(blank.share_of({}), 0);
}

TEST(BlankArea, HolesAreNoEdgesAndIslandsAreSheet) {
  // An L, a hole in it, a plate in the hole and one apart.
  PlaneOutline outline;
  outline.rings = {{{0, 0}, {90, 0}, {90, 40}, {40, 40}, {40, 90}, {0, 90}},
                   {{5, 5}, {35, 5}, {35, 35}, {5, 35}},
                   {{10, 10}, {20, 10}, {20, 20}, {10, 20}},
                   {{60, 60}, {80, 60}, {80, 80}, {60, 80}}};
  const std::unique_ptr<Sheet> sheet = make_sheet(outline, 5);
  const BlankArea blank(sheet->outline());
  const auto share = [&](const Vec2& place) {
    return blank.share_of(footprint_at(punch("square:10"), punch_stroke(Vec3(place, 0), 0, 0)));
  };
  EXPECT_EQ(share({28, 28}), 1) << "over nothing but the hole";
  EXPECT_EQ(share({12, 12}), 1);
  EXPECT_NEAR(share({40, 40}), 0.75, 1e-9);
  EXPECT_EQ(share({50, 50}), 0);
  EXPECT_NEAR(share({60, 70}), 0.5, 1e-9);
}

}  // namespace
}  // namespace kerf
