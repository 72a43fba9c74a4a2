// What one move takes away, against closed forms.
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

using test::arc;
using test::line;

constexpr double kTolerance_mm = 0.005;  // SheetOptions::arc_tolerance_mm
/// Rounding to units of 0.1 um moves a contour by half of one.
constexpr double kGrid_mm = 1e-4;

/// Area removed from the middle of a large sheet, for each of some tilings.
void expect_area(const CutMove& move, double kerf_mm, double area_mm2, double round_length_mm,
                 double straight_length_mm, bool keeps_area = false) {
  for (const int tiles : {1, 5, 16}) {
    const auto sheet = test::make_sheet(rectangle_outline({-100, -100}, {100, 100}), tiles);
    const std::vector<CutReport> reports = test::cut(*sheet, kerf_mm, {move});
    ASSERT_EQ(reports.size(), 1u);
    const double bound =
        kTolerance_mm * round_length_mm + kGrid_mm * (straight_length_mm + round_length_mm);
    EXPECT_NEAR(reports[0].removed_mm3 / 2, area_mm2, bound * (1 + 1e-6)) << tiles;
    EXPECT_DOUBLE_EQ(reports[0].depth_mm, 2);
    EXPECT_NEAR(sheet->remaining_mm3() + reports[0].removed_mm3, sheet->blank_mm3(), 1e-6);
    // Whole circles keep their area: only the grid is in the way.
    if (keeps_area) {
      EXPECT_NEAR(reports[0].removed_mm3 / 2, area_mm2, kGrid_mm * round_length_mm) << tiles;
    }
  }
}

TEST(SheetKerf, line) {
  const double r = 0.75;
  for (const double turn : {0.0, 0.3, kPi / 2, 2.0, -2.5}) {
    const Vec2 way = 50.0 * Vec2(std::cos(turn), std::sin(turn));
    expect_area(line({3, -7}, Vec2(3, -7) + way), 2 * r, 50 * 2 * r + kPi * r * r, 2 * kPi * r,
                100);
  }
}

TEST(SheetKerf, no_way_is_a_disc) {
  expect_area(line({3, -7}, {3, -7}), 4, kPi * 4, 4 * kPi, 0, true);
  CutMove plunge = line({3, -7}, {3, -7});
  plunge.from_mm.z = 20;
  expect_area(plunge, 4, kPi * 4, 4 * kPi, 0, true);
  expect_area(arc({3, -7}, 10, 1, 0), 4, kPi * 4, 4 * kPi, 0, true);
}

TEST(SheetKerf, full_circle_is_a_ring) {
  for (const double sweep : {2 * kPi, -2 * kPi, 6 * kPi}) {
    expect_area(arc({1, 2}, 40, 0.7, sweep), 3, 2 * kPi * 40 * 3, 2 * 2 * kPi * 40, 0, true);
  }
}

TEST(SheetKerf, full_circle_narrower_than_the_kerf_is_a_disc) {
  expect_area(arc({1, 2}, 2, 0.7, 2 * kPi), 6, kPi * 25, 2 * kPi * 5, 0, true);
  expect_area(arc({1, 2}, 3, 0.7, 2 * kPi), 6, kPi * 36, 2 * kPi * 6, 0, true);
}

TEST(SheetKerf, arcs_of_any_sweep) {
  const double r = 1.5, radius = 30;
  for (const double sweep : {0.1, 1.0, kPi, 1.5 * kPi, -1.5 * kPi, 6.0}) {
    const double length = std::abs(sweep) * radius;
    expect_area(arc({-5, 4}, radius, 2.2, sweep), 2 * r, length * 2 * r + kPi * r * r,
                2 * length + 2 * kPi * r, 0);
  }
}

TEST(SheetKerf, helix_is_its_arc) {
  CutMove move = arc({-5, 4}, 30, 2.2, 2);
  move.to_mm.z = -3;
  expect_area(move, 3, 60 * 3 + kPi * 2.25, 120 + 3 * kPi, 0);
}

/// Where every disc covers the centre, the contour is a function of the angle: that of the nearest
/// end beyond the arc.
double area_round_centre(double radius, double r, double sweep) {
  double area = sweep / 2 * (radius + r) * (radius + r);
  const double end = kPi - sweep / 2;
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = end * (i + 0.5) / kSteps;
    const double reach =
        radius * std::cos(angle) + std::sqrt(r * r - std::pow(radius * std::sin(angle), 2));
    area += reach * reach * end / kSteps;
  }
  return area;
}

TEST(SheetKerf, arc_within_the_kerf) {
  for (const double radius : {0.3, 2.0, 4.9, 5.0}) {
    for (const double sweep : {0.2, 1.0, kPi, 4.5, 6.2}) {
      const double area = area_round_centre(radius, 5, sweep);
      expect_area(arc({-5, 4}, radius, 2.2, sweep), 10, area, 2 * kPi * (radius + 5), 0);
      expect_area(arc({-5, 4}, radius, 2.2, -sweep), 10, area, 2 * kPi * (radius + 5), 0);
    }
  }
}

TEST(SheetKerf, spiral) {
  // Radius 10 to 30 in one turn: the strip's area is its length times its width, and two half
  // discs.
  CutMove move = arc({0, 0}, 10, 0, 2 * kPi);
  move.to_mm = {30, 0, 0};
  const double a = 20 / (2 * kPi);
  double length = 0;
  for (int i = 0; i < 100'000; ++i)
    length += std::hypot(a, 10 + a * 2 * kPi * (i + 0.5) / 100'000) * 2 * kPi / 100'000;
  expect_area(move, 2, length * 2 + kPi, 2 * length + 2 * kPi, 0);
}

TEST(SheetKerf, what_is_no_number_removes_nothing) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}));
  const std::string uncut = sheet->digest();
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  CutMove turned = arc({20, 20}, 5, 0, 1);
  turned.arc->sweep_rad = nan;
  CutMove centre = arc({20, 20}, 5, 0, 1);
  centre.arc->center_mm.x = inf;
  const auto reports = test::cut(
      *sheet, 1,
      {line({nan, 2}, {30, 30}), line({1, 2}, {inf, 3}), line({1, 2}, {1e15, 3}), turned, centre});
  ASSERT_EQ(reports.size(), 5u);
  for (const CutReport& report : reports) EXPECT_EQ(report.removed_mm3, 0);
  EXPECT_EQ(sheet->digest(), uncut);
  EXPECT_EQ(sheet->punch(rectangle_outline({-1, -1}, {1, 1}), {nan, 3}, 0, 7).removed_mm3, 0);
}

TEST(SheetKerf, moves_that_come_from_afar) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}));
  const auto reports =
      test::cut(*sheet, 2, {line({-1e6, 20}, {1e6, 20}), arc({30, -5e5}, 5e5 + 5, 1.5, 0.2)});
  EXPECT_NEAR(reports[0].removed_mm3, 60 * 2 * 2, 1e-2);
  EXPECT_NEAR(reports[1].removed_mm3, 60 * 2 * 2, 1);
}

}  // namespace
}  // namespace kerf
