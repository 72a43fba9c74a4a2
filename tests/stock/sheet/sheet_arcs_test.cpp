// Arcs in outlines: what is written, by a reader of its own, against closed forms.
#include <fstream>
#include <sstream>

#include "stock/plane/outline_arcs.h"
#include "stock/plane/outline_file.h"
#include "stock/sheet/punch_shape.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

using test::arc;
using test::line;

constexpr double kTolerance_mm = 0.005;  // SheetOptions::arc_tolerance_mm
/// Four digits are written.
constexpr double kWritten_mm = 1e-4;

/// What a CAM program sees of a DXF file: nothing is shared with kerf's own reader.
struct Drawing {
  struct Circle {
    double x = 0, y = 0, r = 0;
  };
  struct Corner {
    double x = 0, y = 0, bulge = 0;
  };
  std::vector<Circle> circles;
  std::vector<std::vector<Corner>> chains;

  static double radius(const Corner& a, const Corner& b) {
    return std::hypot(b.x - a.x, b.y - a.y) / (2 * std::sin(2 * std::atan(std::abs(a.bulge))));
  }
  /// Each contour by itself, counter-clockwise or not: sectors by their radius.
  double area() const {
    double sum = 0;
    for (const Circle& c : circles) sum += kPi * c.r * c.r;
    for (const std::vector<Corner>& chain : chains) {
      double area = 0;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        const Corner &a = chain[i], &b = chain[(i + 1) % chain.size()];
        area += (a.x * b.y - a.y * b.x) / 2;
        if (a.bulge == 0) continue;
        const double r = radius(a, b), angle = 4 * std::atan(a.bulge);
        area += r * r / 2 * (angle - std::sin(angle));
      }
      sum += std::abs(area);
    }
    return sum;
  }
  std::vector<double> radii() const {
    std::vector<double> radii;
    for (const std::vector<Corner>& chain : chains) {
      for (std::size_t i = 0; i < chain.size(); ++i) {
        if (chain[i].bulge != 0) radii.push_back(radius(chain[i], chain[(i + 1) % chain.size()]));
      }
    }
    return radii;
  }
};

Drawing drawn(const PlaneOutline& outline) {
  const TemporaryFolder folder;
  const std::string path = folder / "arcs.dxf";
  EXPECT_TRUE(write_outline_dxf(outline, kTolerance_mm, path));
  std::istringstream in(read_file(path));
  Drawing drawing;
  std::string code, value, kind;
  while (std::getline(in, code) && std::getline(in, value)) {
    const int group = std::stoi(code);
    if (group == 0) {
      kind = value;
      if (kind == "CIRCLE") drawing.circles.emplace_back();
      if (kind == "POLYLINE") drawing.chains.emplace_back();
      if (kind == "VERTEX") drawing.chains.back().emplace_back();
    }
    if (kind == "CIRCLE") {
      Drawing::Circle& circle = drawing.circles.back();
      if (group == 10) circle.x = std::stod(value);
      if (group == 20) circle.y = std::stod(value);
      if (group == 40) circle.r = std::stod(value);
    }
    if (kind == "VERTEX") {
      Drawing::Corner& corner = drawing.chains.back().back();
      if (group == 10) corner.x = std::stod(value);
      if (group == 20) corner.y = std::stod(value);
      if (group == 42) corner.bulge = std::stod(value);
    }
  }
  EXPECT_EQ(value, "EOF");
  return drawing;
}

PlaneOutline main_outline(const Sheet& sheet) { return sheet.outline_of(0); }

TEST(SheetArcs, a_hole_that_is_a_full_circle_is_a_circle_of_its_exact_diameter) {
  for (const int tiles : {1, 4, 13}) {
    for (const double radius : {0.9, 3.0, 12.0, 17.123}) {
      for (const double sweep : {2 * kPi, -2 * kPi}) {
        const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
        // A lead-in from the slug, then the circle, once in one move and once in two.
        const Vec2 center(30.2, 19.7), start = center + Vec2(radius, 0);
        test::cut(*sheet, 1,
                  {line(center + Vec2(radius / 2, 0), start), arc(center, radius, 0, sweep)});
        const Drawing one = drawn(main_outline(*sheet));
        ASSERT_EQ(one.circles.size(), 1u) << tiles << ' ' << radius;
        EXPECT_NEAR(one.circles[0].x, center.x, kWritten_mm);
        EXPECT_NEAR(one.circles[0].y, center.y, kWritten_mm);
        EXPECT_NEAR(one.circles[0].r, radius + 0.5, kWritten_mm) << tiles << ' ' << radius;
        ASSERT_EQ(one.chains.size(), 1u);
        EXPECT_EQ(one.chains[0].size(), 4u);

        const auto halves = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
        test::cut(*halves, 1,
                  {line(center + Vec2(radius / 2, 0), start), arc(center, radius, 0, sweep / 2),
                   arc(center, radius, kPi, sweep / 2)});
        const Drawing two = drawn(main_outline(*halves));
        ASSERT_EQ(two.circles.size(), 1u) << tiles << ' ' << radius;
        EXPECT_NEAR(two.circles[0].r, radius + 0.5, 2 * kWritten_mm) << tiles << ' ' << radius;
      }
    }
  }
}

TEST(SheetArcs, a_part_with_round_corners_has_eight_edges) {
  for (const int tiles : {1, 9}) {
    const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), tiles);
    const double r = 5;
    test::cut(
        *sheet, 1,
        {line({15, 5}, {45, 5}), arc({45, 10}, r, -kPi / 2, kPi / 2), line({50, 10}, {50, 30}),
         arc({45, 30}, r, 0, kPi / 2), line({45, 35}, {15, 35}), arc({15, 30}, r, kPi / 2, kPi / 2),
         line({10, 30}, {10, 10}), arc({15, 10}, r, kPi, kPi / 2)});
    const std::vector<SheetPiece> pieces = sheet->pieces();
    ASSERT_EQ(pieces.size(), 2u);
    // Counter-clockwise: the part is what is within.
    const Drawing part = drawn(sheet->outline_of(1));
    ASSERT_EQ(part.chains.size(), 1u);
    EXPECT_EQ(part.chains[0].size(), 8u) << tiles;
    ASSERT_EQ(part.radii().size(), 4u);
    for (const double radius : part.radii()) EXPECT_NEAR(radius, r - 0.5, 0.001);
    EXPECT_NEAR(part.area(), 39 * 29 - (4 - kPi) * 4.5 * 4.5, 0.005);
    const Drawing rest = drawn(main_outline(*sheet));
    ASSERT_EQ(rest.radii().size(), 4u);
    for (const double radius : rest.radii()) EXPECT_NEAR(radius, r + 0.5, 0.001);
    EXPECT_NEAR(rest.area(), 2400 + 41 * 31 - (4 - kPi) * 5.5 * 5.5, 0.005);
  }
}

TEST(SheetArcs, a_slot_ends_in_half_circles) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 6);
  test::cut(*sheet, 3, {line({10, 8}, {48, 31})});
  const Drawing rest = drawn(main_outline(*sheet));
  ASSERT_EQ(rest.radii().size(), 2u);
  for (const double radius : rest.radii()) EXPECT_NEAR(radius, 1.5, 2 * kWritten_mm);
  const double length = std::hypot(38, 23);
  EXPECT_NEAR(rest.area(), 2400 + 3 * length + kPi * 2.25, 0.005);
}

TEST(SheetArcs, polygons_and_rectangles_stay_what_they_are) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 5);
  sheet->punch(*parse_punch_shape("polygon:12:15", kTolerance_mm), {20, 20}, 0.3, 1);
  sheet->punch(*parse_punch_shape("square:9", kTolerance_mm), {45, 20}, 0.1, 2);
  const PlaneOutline outline = main_outline(*sheet);
  const Drawing drawing = drawn(outline);
  EXPECT_TRUE(drawing.circles.empty());
  EXPECT_TRUE(drawing.radii().empty());
  ASSERT_EQ(drawing.chains.size(), outline.rings.size());
  for (std::size_t i = 0; i < outline.rings.size(); ++i) {
    ASSERT_EQ(drawing.chains[i].size(), outline.rings[i].size());
    for (std::size_t k = 0; k < outline.rings[i].size(); ++k) {
      EXPECT_NEAR(drawing.chains[i][k].x, outline.rings[i][k].x, 1e-9);
      EXPECT_NEAR(drawing.chains[i][k].y, outline.rings[i][k].y, 1e-9);
    }
  }
}

TEST(SheetArcs, round_and_obround_punches) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 5);
  sheet->punch(*parse_punch_shape("round:10", kTolerance_mm), {20, 20}, 0.3, 1);
  sheet->punch(*parse_punch_shape("obround:20:6", kTolerance_mm), {45, 20}, 1.1, 2);
  const Drawing drawing = drawn(main_outline(*sheet));
  ASSERT_EQ(drawing.circles.size(), 1u);
  EXPECT_NEAR(drawing.circles[0].r, 5, kWritten_mm);
  ASSERT_EQ(drawing.radii().size(), 2u);
  for (const double radius : drawing.radii()) EXPECT_NEAR(radius, 3, 2 * kWritten_mm);
}

/// What drawing programs make of curves.
TEST(SheetArcs, a_circle_of_short_chords_is_a_circle) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 5);
  std::vector<CutMove> moves;
  const int count = 600;
  const auto at = [](int i) {
    return Vec2(30, 20) + 10.0 * Vec2(std::cos(2 * kPi * i / count), std::sin(2 * kPi * i / count));
  };
  for (int i = 0; i < count; ++i) moves.push_back(line(at(i), at(i + 1)));
  test::cut(*sheet, 1, moves);
  const Drawing drawing = drawn(main_outline(*sheet));
  ASSERT_EQ(drawing.circles.size(), 1u);
  EXPECT_NEAR(drawing.circles[0].r, 10.5, kTolerance_mm) << "the round end of each is a polygon";
}

TEST(SheetArcs, a_circle_that_is_read_cut_and_written_again_keeps_its_radius) {
  const TemporaryFolder folder;
  const std::string path = folder / "again.dxf";
  PlaneOutline outline = rectangle_outline({0, 0}, {60, 40});
  std::ofstream(path) << "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\n30.5\n20\n20.25\n40\n15.1\n"
                         "0\nENDSEC\n0\nEOF\n";
  for (int i = 0; i < 3; ++i) {
    const auto read = read_outline_file(path, OutlineFormat::kDxf, kTolerance_mm);
    ASSERT_TRUE(read) << read.error();
    const auto sheet = test::make_sheet(*read, 3 + i);
    ASSERT_TRUE(write_outline_dxf(sheet->outline(), kTolerance_mm, path));
    const Drawing drawing = drawn(sheet->outline());
    ASSERT_EQ(drawing.circles.size(), 1u);
    EXPECT_NEAR(drawing.circles[0].r, 15.1, kWritten_mm);
    EXPECT_NEAR(drawing.circles[0].x, 30.5, kWritten_mm);
  }
}

double distance_to(const Vec2& p, const PlaneOutline& outline) {
  double best = 1e9;
  for (const std::vector<Vec2>& ring : outline.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      best = std::min(best, test::distance_to_way(line(ring[i], ring[(i + 1) % ring.size()]), p));
  }
  return best;
}

/// Any cuts: nothing moves by more than is said, the area stays, and it can be read again.
TEST(SheetArcs, curves_of_any_cuts_are_where_the_chords_are) {
  std::mt19937 random(7);
  std::size_t arcs = 0;
  for (int round = 0; round < 8; ++round) {
    const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 1 + 3 * round);
    test::cut(*sheet, 0.4 + 0.2 * round, test::random_moves(random, 12));
    for (const SheetPiece& piece : sheet->pieces()) {
      const PlaneOutline outline = sheet->outline_of(piece.number);
      const std::vector<plane::Curve> curves = plane::curves_of(outline, kTolerance_mm);
      const PlaneOutline again = plane::chords_of(curves, 0.0002);
      double length = 0;
      for (const std::vector<Vec2>& ring : outline.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Vec2 way = ring[(i + 1) % ring.size()] - ring[i];
          length += std::hypot(way.x, way.y);
          EXPECT_LT(distance_to(ring[i], again), 2 * kTolerance_mm);
        }
      }
      for (const std::vector<Vec2>& ring : again.rings) {
        for (const Vec2& p : ring) EXPECT_LT(distance_to(p, outline), 2 * kTolerance_mm);
      }
      // Circles turn one way, whether they bound a hole or not.
      ASSERT_EQ(again.rings.size(), outline.rings.size());
      for (std::size_t i = 0; i < again.rings.size(); ++i) {
        EXPECT_NEAR(std::abs(test::area_of({{again.rings[i]}, {}})),
                    std::abs(test::area_of({{outline.rings[i]}, {}})), kTolerance_mm * length / 2);
      }
      EXPECT_TRUE(check_outline(again));
      for (const plane::Curve& curve : curves) {
        for (const plane::CurveCorner& corner : curve.corners) arcs += corner.bulge != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(arcs, 200u);
}

TEST(SheetArcs, svg_has_the_same_arcs) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 5);
  test::cut(*sheet, 1, {arc({30, 20}, 10, 0, 2 * kPi), line({10, 8}, {10, 31})});
  const TemporaryFolder folder;
  const std::string path = folder / "arcs.svg";
  ASSERT_TRUE(write_outline_svg(main_outline(*sheet), kTolerance_mm, path));
  const std::string text = read_file(path);
  // Two halves of the hole, y downward, to the left first; two ends of the slot.
  EXPECT_NE(text.find("M40.5000 20.0000\nA10.5000 10.5000 0 0 0 19.5000 20.0000\n"
                      "A10.5000 10.5000 0 0 0 40.5000 20.0000\nZ\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), 'A'), 4);
  const auto read = read_outline_file(path, OutlineFormat::kSvg, 1e-4);
  ASSERT_TRUE(read) << read.error();
  EXPECT_NEAR(test::make_sheet(*read, 1)->remaining_mm2(), sheet->pieces()[0].area_mm2, 0.005);
}

}  // namespace
}  // namespace kerf
