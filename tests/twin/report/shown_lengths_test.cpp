#include "twin/report/shown_lengths.h"

#include <gtest/gtest.h>

#include <string>

#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

std::string inch(const std::string& text) { return in_unit(text, LengthUnit::kInch); }

TEST(ShownLengths, WithTheirUnitsBesideThem) {
  EXPECT_EQ(inch("traverse touches the workpiece, 2.31 mm deep at X12.40 Y3.00 Z-1.20 (tool 3)"),
            "traverse touches the workpiece, 0.091 in deep at X0.488 Y0.118 Z-0.047 (tool 3)");
  EXPECT_EQ(inch("box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0"),
            "box 3.937 x 2.362 x 0.787 in, X0..3.937 Y0..2.362 Z-0.787..0");
  EXPECT_EQ(inch("tube diameter 50.8 / 25.4 x 127 mm along Z, X0 Y0 Z-127..0"),
            "tube diameter 2 / 1 x 5 in along Z, X0 Y0 Z-5..0");
  EXPECT_EQ(inch("G43 H2 applies X5 Z75 mm, and tool 1 is 50.8 mm long"),
            "G43 H2 applies X0.197 Z2.953 in, and tool 1 is 2 in long");
  EXPECT_EQ(inch("0.05 to 0.2 mm suits most parts"), "0.002 to 0.0079 in suits most parts");
  EXPECT_EQ(inch("for 8000 mm/min where it can do 6000 mm/min"),
            "for 315 in/min where it can do 236.2 in/min");
  EXPECT_EQ(inch("X 60 mm/s 750 mm/s2, C 30 deg/s"), "X 2.36 in/s 29.5 in/s2, C 30 deg/s");
  EXPECT_EQ(inch("removed 30.000 cm3, peak 40.0 mm3/s, 11.28 cm2 left"),
            "removed 1.8307 in3, peak 0.1465 in3/min, 1.748 in2 left");
  EXPECT_EQ(inch("feed 12.35 m, traverse 0.0 mm\n"), "feed 486.2 in, traverse 0 in\n");
  EXPECT_EQ(inch("its tip bends by 0.0254 mm (0.0127 to 0.127, line 37); 801 N (376 to 1322)"),
            "its tip bends by 0.001 in (0.0005 to 0.005, line 37); 801 N (376 to 1322)");
  EXPECT_EQ(inch("takes 25.4 mm (12.7 to 50.8); 3 mm (1 to 3 teeth), 3 mm (of 4), 3 mm (1 to x)"),
            "takes 1 in (0.5 to 2); 0.118 in (1 to 3 teeth), 0.118 in (of 4), 0.118 in (1 to x)");
  EXPECT_EQ(inch("Z0.508 .. -25.400: diameter 50.8 mm, X-2.54..2.54, X5 .. and"),
            "Z0.02 .. -1: diameter 2 in, X-0.1..0.1, X0.197 .. and");
  EXPECT_EQ(inch("2.54e+01 mm wide"), "1 in wide");
  EXPECT_EQ(inch("0.396875 mm, -0.004 mm, 0.0001 mm"), "0.015625 in, -0.00016 in, 0.0000039 in");
}

TEST(ShownLengths, ShapesAndOptionsToo) {
  EXPECT_EQ(inch("taken for flat:6.35, and (drill:3.175:118) fed"),
            "taken for flat:0.25, and (drill:0.125:118) fed");
  EXPECT_EQ(inch("taper:3.175:5:flute=25.4:shank=6.35:holder=25.4x50.8+50.8x25.4"),
            "taper:0.125:5:flute=1:shank=0.25:holder=1x2+2x1");
  EXPECT_EQ(
      inch("1   iso:CNMG432:holder=25.4x101.6:max_ap=0.508 (--tool), thread:60:1.27: a thread"),
      "1   iso:CNMG432:holder=1x4:max_ap=0.02 (--tool), thread:60:0.05: a thread");
  EXPECT_EQ(inch("--cell 0.0254 would do (4 million cells)"),
            "--cell 0.001 would do (4 million cells)");
  EXPECT_EQ(inch("--tool 1=flat:25.4: the program never uses tool 1"),
            "--tool 1=flat:1: the program never uses tool 1");
}

TEST(ShownLengths, WhatIsNoLengthStays) {
  for (const std::string text : {"part.ngc: 2 errors, 1 warning",
                                 "12 moves in 3 min 04 s, 5 ms old",
                                 "G54 to G59, M3 S8000",
                                 "kerf: note: 3 more",
                                 "line 12 (tool 3)",
                                 "Mild Steel 3mm 45A",
                                 "4.20 million",
                                 "N10 XY 5",
                                 "X.. Y",
                                 "--cell: the value",
                                 "--tool-table FILE",
                                 "flat: a word",
                                 "thread: 60, iso: what, part: 2",
                                 "3 mmm",
                                 "Y2K",
                                 "Z1a",
                                 "7850 kg/m3",
                                 "X",
                                 "-",
                                 "",
                                 "1-2",
                                 "kerf-report/1"}) {
    EXPECT_EQ(inch(text), text);
  }
  EXPECT_EQ(in_unit("2.31 mm", LengthUnit::kMm), "2.31 mm");
}

TEST(ShownLengths, OfAFindingNeitherTheLineNorTheInterpretersWords) {
  Diagnostic d;
  d.message = "rapid-contact: 2.54 mm deep";
  d.hint = "--below 2.54 does";
  d.excerpt = "G0 X25.4 (25.4 mm)";
  const Diagnostic shown = in_unit(d, LengthUnit::kInch);
  EXPECT_EQ(shown.message, "rapid-contact: 0.1 in deep");
  EXPECT_EQ(shown.hint, "--below 0.1 does");
  EXPECT_EQ(shown.excerpt, d.excerpt);
  d.message = "interpreter-error: Radius to end of arc differs: start=(X1.0000,Y2.0000) 3 mm";
  EXPECT_EQ(in_unit(d, LengthUnit::kInch).message, d.message);
}

TEST(LengthUnits, SpecsAreReadInInches) {
  const Result<Blank> blank =
      parse_blank("box:0,-0.5,-0.3:4,2.25,0.1+cylinder:1,1,0:2:0.75:x", LengthUnit::kInch);
  ASSERT_TRUE(blank);
  const Result<Blank> same =
      parse_blank("box:0,-12.7,-7.62:101.6,57.15,2.54+cylinder:25.4,25.4,0:50.8:19.05:x");
  ASSERT_TRUE(same);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(blank->bodies[i].bounds_mm, same->bodies[i].bounds_mm);
    EXPECT_EQ(blank->bodies[i].diameter_mm, same->bodies[i].diameter_mm);
  }
  const Result<Blank> sheet = parse_blank("sheet:0,0:24,12:0.25", LengthUnit::kInch);
  ASSERT_TRUE(sheet);
  EXPECT_EQ(sheet->sheet->thickness_mm, 6.35);
  EXPECT_EQ(sheet->sheet->high_mm, (Vec2{609.6, 304.8}));
  const Result<Cutter> cutter =
      parse_shape("taper:0.125:5:0.03:flute=1:shank=0.25:holder=1x2+2x1", LengthUnit::kInch);
  ASSERT_TRUE(cutter) << cutter.error();
  EXPECT_EQ(cutter->spec(), "taper:3.175:5:0.762:flute=25.4:shank=6.35:holder=25.4x50.8+50.8x25.4");
  EXPECT_EQ(shape_in(cutter->spec(), LengthUnit::kInch),
            "taper:0.125:5:0.03:flute=1:shank=0.25:holder=1x2+2x1");
  EXPECT_EQ(parse_tool_argument("3=vee:0.5:60", LengthUnit::kInch)->cutter.spec(), "vee:12.7:60");
}

TEST(LengthUnits, WhatIsWrongIsToldInThem) {
  EXPECT_EQ(parse_shape("flat:80", LengthUnit::kInch).error(),
            "flat:80: diameter D: 80 is not allowed; must be from 3.937e-05 to 39.37 (in)");
  EXPECT_EQ(parse_shape("bull:0.5:0.3", LengthUnit::kInch).error(),
            "bull:0.5:0.3: corner radius R: 0.3 is not allowed; must be from 0 to 0.25 (in)");
  EXPECT_EQ(parse_shape("tslot:0.5:0.1:0.5", LengthUnit::kInch).error(),
            "tslot:0.5:0.1:0.5: shaft diameter SHAFT: 0.5 is not allowed; must be less than "
            "diameter D, 0.5 (in)");
  EXPECT_EQ(parse_blank("box:0,0,0:4,-1,1", LengthUnit::kInch).error(),
            "box:0,0,0:4,-1,1: Y runs from 0 to -1; the second must be at least 3.9e-05 in above "
            "the first");
}

}  // namespace
}  // namespace kerf
