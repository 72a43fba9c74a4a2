// Outlines from and to drawings, and punch shapes.
#include "stock/plane/outline_file.h"
#include "stock/sheet/punch_shape.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/sheet/sheet_samples.h"

namespace kerf {
namespace {

constexpr double kTolerance_mm = 0.001;

/// Group codes and values, divided by blanks.
std::string dxf(const std::string& entities, const std::string& header = "") {
  std::string text = "0 SECTION 2 HEADER " + header + " 0 ENDSEC 0 SECTION 2 ENTITIES " + entities +
                     " 0 ENDSEC 0 EOF ";
  std::replace(text.begin(), text.end(), ' ', '\n');
  std::string lines;
  for (const char c : text) {
    if (c != '\n' || (!lines.empty() && lines.back() != '\n')) lines += c;
  }
  return lines;
}

double even_odd_area(const PlaneOutline& outline) {
  return test::make_sheet(outline, 1)->remaining_mm2();
}

double dxf_area(const std::string& text) {
  const Result<PlaneOutline> outline = parse_dxf_outline(text, "d.dxf", kTolerance_mm);
  EXPECT_TRUE(outline) << (outline ? "" : outline.error());
  return outline ? even_odd_area(*outline) : 0;
}

double svg_area(const std::string& body, const std::string& attributes = "") {
  const std::string text =
      "<?xml version=\"1.0\"?>\n<svg " + attributes + ">\n" + body + "\n</svg>\n";
  const Result<PlaneOutline> outline = parse_svg_outline(text, "d.svg", kTolerance_mm);
  EXPECT_TRUE(outline) << (outline ? "" : outline.error());
  return outline ? even_odd_area(*outline) : 0;
}

std::string svg_fault(const std::string& text) {
  const Result<PlaneOutline> outline = parse_svg_outline(text, "d.svg", kTolerance_mm);
  return outline ? "" : outline.error();
}

std::string dxf_fault(const std::string& text) {
  const Result<PlaneOutline> outline = parse_dxf_outline(text, "d.dxf", kTolerance_mm);
  return outline ? "" : outline.error();
}

const char* const kSlot =
    "0 LINE 10 0 20 0 11 40 21 0  0 ARC 10 40 20 5 40 5 50 270 51 90 "
    "0 LINE 10 0 20 10 11 40 21 10  0 ARC 10 0 20 5 40 5 50 90 51 270 "
    "0 CIRCLE 10 20 20 5 40 2";

TEST(PlaneOutline, dxf_lines_arcs_and_circles) {
  EXPECT_NEAR(dxf_area(dxf(kSlot)), 400 + kPi * 25 - kPi * 4, 0.05);
  EXPECT_NEAR(dxf_area(dxf(kSlot, "9 $INSUNITS 70 1")), 645.16 * (400 + kPi * 25 - kPi * 4), 2);
  EXPECT_NEAR(dxf_area(dxf(kSlot, "9 $INSUNITS 70 4")), 400 + kPi * 21, 0.05);
}

TEST(PlaneOutline, dxf_polylines) {
  // Half circles by bulges of 1.
  const double area = 400 + kPi * 25;
  EXPECT_NEAR(dxf_area(dxf("0 LWPOLYLINE 90 4 70 1 10 0 20 0 10 40 20 0 42 1 10 40 20 10 "
                           "10 0 20 10 42 1")),
              area, 0.05);
  EXPECT_NEAR(dxf_area(dxf("0 POLYLINE 66 1 70 1 10 0 20 0 0 VERTEX 10 0 20 0 "
                           "0 VERTEX 10 40 20 0 42 1 0 VERTEX 10 40 20 10 "
                           "0 VERTEX 10 0 20 10 42 1 0 SEQEND")),
              area, 0.05);
  // An open one and a line close each other.
  EXPECT_NEAR(dxf_area(dxf("0 LWPOLYLINE 90 3 70 0 10 0 20 0 10 10 20 0 10 10 20 10 "
                           "0 LINE 10 0 20 0 11 10 21 10")),
              50, 1e-3);
}

TEST(PlaneOutline, dxf_faults) {
  EXPECT_EQ(dxf_fault("hello"), "d.dxf:1: 'hello' is not a group code; is this an ASCII DXF file?");
  EXPECT_EQ(dxf_fault(dxf("")), "d.dxf: no closed contour in the section ENTITIES");
  EXPECT_EQ(dxf_fault(dxf("0 LINE 10 0 20 0 11 40 21 0")),
            "d.dxf:12: the contour that begins here is open: nothing goes on at X40.0000 Y0.0000 "
            "(within 0.01 mm)");
  EXPECT_EQ(dxf_fault(dxf("0 LINE 10 0 20 0 11 40")), "d.dxf:12: LINE without group 21");
  EXPECT_EQ(dxf_fault(dxf("0 CIRCLE 10 nan 20 0 40 1")),
            "d.dxf:14: group 10: 'nan' is not a number");
  EXPECT_EQ(dxf_fault(dxf("0 SPLINE 10 0 20 0")),
            "d.dxf:12: SPLINE is not read; allowed are LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE");
  EXPECT_EQ(dxf_fault(dxf("", "9 $INSUNITS 70 2")),
            "d.dxf:8: $INSUNITS is 2; must be 4 (mm), 1 (inch) or 0 (taken as mm)");
}

TEST(PlaneOutline, svg_shapes) {
  EXPECT_NEAR(svg_area("<rect x='1' y=\"2\" width='30' height='20'/>"), 600, 1e-6);
  EXPECT_NEAR(svg_area("<circle cx='5' cy='5' r='10'/>"), kPi * 100, 0.1);
  EXPECT_NEAR(svg_area("<ellipse rx='5' ry='10'/>"), kPi * 50, 0.1);
  EXPECT_NEAR(svg_area("<polygon points='0,0 10,0 10,10'/>"), 50, 1e-6);
  EXPECT_NEAR(svg_area("<defs><rect width='9' height='9'/></defs><!-- <rect/> -->"
                       "<g id='a'><rect width='3' height='3'/></g>"),
              9, 1e-6);
  EXPECT_NEAR(
      svg_area("<rect width='5' height='4'/>", "width='2in' height='1in' viewBox='0 0 20 10'"),
      20 * 2.54 * 2.54, 1e-3);
}

TEST(PlaneOutline, svg_paths) {
  EXPECT_NEAR(svg_area("<path d='M0 0H10V10h-10z'/>"), 100, 1e-6);
  EXPECT_NEAR(svg_area("<path d='m5,5 10 0 0 10 -10 0zm2-2l1,0 0,1z'/>"), 100.5, 1e-6);
  EXPECT_NEAR(svg_area("<path d='M0,0 A10 10 0 0 1 20 0 A10 10 0 1 1 0 0 Z'/>"), kPi * 100, 0.1);
  EXPECT_NEAR(svg_area("<path d='M0 0a10 5 90 1120 0 10 5 90 11-20 0'/>"), kPi * 200, 0.2);
  // Areas of curves with their chord: a quadratic has two thirds of its control triangle.
  EXPECT_NEAR(svg_area("<path d='M0 0Q10 20 20 0Z'/>"), 2.0 / 3 * 200, 0.05);
  EXPECT_NEAR(svg_area("<path d='M0 0C0 20 20 20 20 0Z'/>"), 240, 0.05);
  EXPECT_NEAR(svg_area("<path d='M0 0Q10 20 20 0T40 0L40 30 0 30Z'/>"), 1200, 0.1);
  // A hole.
  EXPECT_NEAR(svg_area("<path d='M0 0H10V10H0ZM2 2H4V4H2Z'/>"), 96, 1e-6);
}

TEST(PlaneOutline, svg_places_its_lower_edge_at_zero) {
  const Result<PlaneOutline> outline = parse_svg_outline(
      "<svg viewBox='0 0 50 40'><rect x='10' y='35' width='5' height='5'/></svg>", "d", 0.01);
  ASSERT_TRUE(outline);
  const Box box = test::make_sheet(*outline)->bounds_mm();
  EXPECT_EQ(box.min, Vec3(10, 0, 0));
  EXPECT_EQ(box.max, Vec3(15, 5, 2));
}

TEST(PlaneOutline, svg_faults) {
  EXPECT_EQ(svg_fault("<html></html>"), "d.svg:1: no <svg> element; is this an SVG file?");
  EXPECT_EQ(svg_fault("<svg>\n<path d='M0 0L5 5 5 0'/></svg>"),
            "d.svg:2: path: an open part, from 0.0000,0.0000 to 5.0000,0.0000; must end with Z");
  EXPECT_EQ(svg_fault("<svg>\n\n<g transform='scale(2)'></g></svg>"),
            "d.svg:3: g: a transform is not read; apply it in the drawing program");
  EXPECT_EQ(svg_fault("<svg><path d='M0 0LX 5z'/></svg>"),
            "d.svg:1: path: character 6: 'X 5z' is not a number");
  EXPECT_EQ(svg_fault("<svg><circle r='nan'/></svg>"), "d.svg:1: r: 'nan' is not a number");
  EXPECT_EQ(svg_fault("<svg><use href='#a'/></svg>"),
            "d.svg:1: use is not read; allowed are path, rect, circle, ellipse and polygon");
}

TEST(PlaneOutline, cut_off_anywhere_gives_an_error_or_an_outline) {
  const std::string drawing = dxf(kSlot, "9 $INSUNITS 70 4");
  const std::string picture =
      "<svg viewBox='0 0 9 9'><path d='M0,0 A10 10 0 0 1 20 0 C1e1 2-3 4 5Q1 2 3 4z'/></svg>";
  int faults = 0;
  for (std::size_t i = 0; i < drawing.size(); ++i)
    faults += !parse_dxf_outline(drawing.substr(0, i), "d", 0.01);
  for (std::size_t i = 0; i < picture.size(); ++i)
    faults += !parse_svg_outline(picture.substr(0, i), "p", 0.01);
  EXPECT_GT(faults, 200);
}

TEST(PlaneOutline, written_and_read_again) {
  const auto sheet = test::make_sheet(rectangle_outline({0, 0}, {60, 40}), 5);
  test::cut(*sheet, 1, {test::line({5, 5}, {55, 30}), test::arc({30, 20}, 12, 0, 2 * kPi)});
  const TemporaryFolder temporary;
  const std::string folder = temporary.path() + "/";
  for (const SheetPiece& piece : sheet->pieces()) {
    const PlaneOutline outline = sheet->outline_of(piece.number);
    ASSERT_TRUE(write_outline_dxf(outline, 0.005, folder + "piece.dxf"));
    ASSERT_TRUE(write_outline_svg(outline, 0.005, folder + "piece.svg"));
    for (const auto format : {OutlineFormat::kDxf, OutlineFormat::kSvg}) {
      const bool dxf_format = format == OutlineFormat::kDxf;
      const Result<PlaneOutline> again =
          read_outline_file(folder + (dxf_format ? "piece.dxf" : "piece.svg"), format, 0.001);
      ASSERT_TRUE(again) << again.error();
      EXPECT_NEAR(even_odd_area(*again), piece.area_mm2, 5e-3 + 1e-6 * piece.area_mm2);
    }
  }
  EXPECT_FALSE(write_outline_svg(sheet->outline(), 0.005, folder + "no/such/folder.svg"));
  EXPECT_FALSE(read_outline_file(folder + "no_such.dxf", OutlineFormat::kDxf, 0.01));
}

TEST(PunchShape, areas) {
  const auto area = [](const std::string& spec) {
    const Result<PlaneOutline> shape = parse_punch_shape(spec, kTolerance_mm);
    EXPECT_TRUE(shape) << (shape ? "" : shape.error());
    return shape ? std::abs(test::area_of(*shape)) : 0;
  };
  EXPECT_NEAR(area("round:10"), kPi * 25, 0.05);
  EXPECT_NEAR(area("Square: 7"), 49, 1e-9);
  EXPECT_NEAR(area("rectangle:20:5"), 100, 1e-9);
  EXPECT_NEAR(area("obround:20:5"), 15 * 5 + kPi * 6.25, 0.05);
  EXPECT_NEAR(area("obround:5:20"), 15 * 5 + kPi * 6.25, 0.05);
  EXPECT_NEAR(area("obround:5:5"), kPi * 6.25, 0.05);
  EXPECT_NEAR(area("polygon:6:10"), 6 * 0.5 * 25 * std::sin(kPi / 3), 1e-9);
  const TemporaryFolder folder;
  const std::string file = folder / "star.svg";
  write_file(file, "<svg><path d='M-5 0L0 -2 5 0 0 2z'/></svg>");
  EXPECT_NEAR(area("svg:" + file), 20, 1e-9);
}

TEST(PunchShape, obround_lies_along_its_longer_side) {
  for (const bool upright : {false, true}) {
    const auto sheet = test::make_sheet(rectangle_outline({-30, -30}, {30, 30}), 3);
    sheet->punch(*parse_punch_shape(upright ? "obround:5:20" : "obround:20:5", kTolerance_mm),
                 {0, 0}, 0, 1);
    EXPECT_EQ(sheet->has_material({9, 0}), upright);
    EXPECT_EQ(sheet->has_material({0, 9}), !upright);
    EXPECT_NEAR(sheet->blank_mm3() - sheet->remaining_mm3(), 2 * (75 + kPi * 6.25), 0.05);
  }
}

TEST(PunchShape, faults) {
  const auto fault = [](const std::string& spec) {
    return parse_punch_shape(spec, kTolerance_mm).error();
  };
  EXPECT_EQ(fault("round"), "round: 0 values after 'round'; the form is round:D");
  EXPECT_EQ(fault("round:0"),
            "round:0: diameter D: 0 is not allowed; must be from 0.1 to 1000 (mm)");
  EXPECT_EQ(fault("polygon:2.5:9"),
            "polygon:2.5:9: corners N: 2.5 is not allowed; must be from 3 to 100 (whole number)");
  EXPECT_EQ(fault("polygon:3.5:9"), "polygon:3.5:9: corners N: 3.5 is not a whole number");
  EXPECT_EQ(fault("dxf:"), "dxf:: the file name is missing; the form is dxf:FILE");
  EXPECT_TRUE(fault("rond:3").starts_with("rond:3: unknown shape 'rond'; did you mean 'round'?"))
      << fault("rond:3");
}

}  // namespace
}  // namespace kerf
