// SHAPE texts of turning tools: canonical text, where outlines lie, holders, what is refused.
#include "stock/cutter/turning_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/units.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/turning_flanks.h"
#include "tests/stock/insert_points.h"

namespace kerf {
namespace {

std::string turning_error(std::string_view spec) {
  const Result<Cutter> cutter = parse_shape(spec);
  return cutter ? "no error" : cutter.error();
}

Cutter tool(std::string_view spec) {
  Result<Cutter> cutter = parse_shape(spec);
  EXPECT_TRUE(cutter) << (cutter ? "" : cutter.error());
  return cutter ? std::move(*cutter) : Cutter::from_insert("none", {});
}

/// Corners and arcs of the parts of a kind; holders or what is held.
std::vector<Vec2> corners_of(const Cutter& cutter, bool holder) {
  std::vector<Vec2> points;
  for (const InsertPart& part : cutter.insert()->parts) {
    if ((part.back().side == InsertSide::kHolder) != holder) continue;
    for (const Vec2& p : insert_points(part, 200)) points.push_back(p);
  }
  return points;
}

struct Span {
  Vec2 low{1e300}, high{-1e300};
};
Span span_of(const std::vector<Vec2>& points) {
  Span span;
  for (const Vec2& p : points) {
    span.low = glm::min(span.low, p);
    span.high = glm::max(span.high, p);
  }
  return span;
}

/// The contract of InsertPart: convex, counter-clockwise.
void expect_convex_parts(const Cutter& cutter) {
  for (const InsertPart& part : cutter.insert()->parts) {
    const std::vector<Vec2> points = insert_points(part, 60);
    const std::size_t n = points.size();
    double turned = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 in = points[(i + 1) % n] - points[i],
                 out = points[(i + 2) % n] - points[(i + 1) % n];
      const double cross = in.x * out.y - in.y * out.x;
      EXPECT_GT(cross, -1e-9) << cutter.spec();
      turned += std::atan2(cross, glm::dot(in, out));
    }
    EXPECT_NEAR(turned, 2 * kPi, 1e-6) << cutter.spec();
  }
}

TEST(TurningShape, CanonicalTextParsesToTheSameTool) {
  const std::vector<std::pair<const char*, const char*>> texts = {
      {"turn:0.4:2:85:25", "turn:0.4:2:85:25"},
      {"TURN:.80:3:275:335:12", "turn:0.8:3:275:335:12"},
      {"turn:0.4:2:85:25:10", "turn:0.4:2:85:25"},
      {"turn:0.4:2:85:25:edge=6", "turn:0.4:2:85:25:6"},
      {"turn:0:6:120:60", "turn:0:6:120:60"},
      {"turn:3:9", "turn:3:9"},
      {"turn:0.2:7:330:30", "turn:0.2:7:330:30"},
      {"iso:cnmg 12 04 08", "iso:CNMG120408"},
      {"iso:CNMG120408-PM:r", "iso:CNMG120408:R"},
      {"iso:DCMT11T304:L:93", "iso:DCMT11T304:L:93"},
      {"iso:VBMT160404::72.5", "iso:VBMT160404:R:72.5"},
      {"iso:CNMG432:orient=3", "iso:CNMG432:orient=3"},
      {"iso:RCMT10T3M0", "iso:RCMT10T3M0"},
      {"groove:3", "groove:3"},
      {"groove:3:0.2:edge=20:orient=6", "groove:3:0.2:orient=6:edge=20"},
      {"part:2:0:holder=16x60", "part:2:holder=16x60"},
      {"facegroove:4:0.4:orient=7", "facegroove:4:0.4:orient=7"},
      {"thread:60", "thread:60"},
      {"thread:55:1.814", "thread:55:1.814"},
      {"thread:60:1.5:bar=12x40:f=9", "thread:60:1.5:bar=12x40:f=9"},
      {"bore:0.4:12", "bore:0.4:12"},
      {"bore:0.4:12:50:275:335:orient=3", "bore:0.4:12:50:275:335:orient=3"},
      {"bore:0.4:12::275:335", "bore:0.4:12::275:335"},
  };
  for (const auto& [text, canonical] : texts) {
    const Cutter first = tool(text);
    EXPECT_EQ(first.spec(), canonical);
    const Cutter again = tool(first.spec());
    EXPECT_EQ(again.spec(), first.spec());
    ASSERT_NE(first.insert(), nullptr) << text;
    expect_convex_parts(first);
    EXPECT_EQ(span_of(corners_of(again, false)).high, span_of(corners_of(first, false)).high);
  }
}

TEST(TurningShape, TheNoseTouchesTheLinesThroughTheControlledPoint) {
  struct Case {
    const char* text;
    int orientation;
    double radius_mm;
    bool at_z, at_x;  ///< the outline ends at z = 0, x = 0
  };
  for (const Case& c :
       {Case{"turn:0.8:2:85:25", 2, 0.8, true, true}, Case{"iso:CNMG120408", 2, 0.8, true, true},
        Case{"iso:CNMG120408:L", 1, 0.8, true, true},
        Case{"iso:WNMG080404:orient=3", 3, 0.4, true, true},
        Case{"iso:DNMG150608:L:orient=4", 4, 0.8, true, true},
        Case{"iso:DCMT070204:N", 6, 0.4, false, true},
        Case{"iso:VCMT160404:N:orient=8", 8, 0.4, false, true},
        Case{"iso:CCMT060204:bar=8x40", 3, 0.4, true, true},
        Case{"groove:3:0.3", 2, 0.3, true, true},
        Case{"groove:3:0.3:orient=8", 8, 0.3, false, true},
        Case{"facegroove:3:0.3", 2, 0.3, true, true}, Case{"thread:60:2", 6, 0, false, true},
        Case{"thread:60:bar=8x40", 8, 0, false, true}, Case{"bore:0.2:8", 3, 0.2, true, true}}) {
    const Cutter cutter = tool(c.text);
    EXPECT_EQ(cutter.insert_tip().orientation, c.orientation) << c.text;
    EXPECT_EQ(cutter.insert_tip().nose_radius_mm, c.radius_mm) << c.text;
    const Vec2 behind = nose_direction(c.orientation);
    const Span span = span_of(corners_of(cutter, false));
    const double z = behind.x > 0 ? span.low.x : span.high.x;
    const double x = behind.y > 0 ? span.low.y : span.high.y;
    if (c.at_z) {
      EXPECT_NEAR(z, 0, 1e-4) << c.text;
    }
    if (c.at_x) {
      EXPECT_NEAR(x, 0, 1e-4) << c.text;
    }
    if (behind.x == 0) {
      EXPECT_NEAR(span.low.x, -span.high.x, 1e-9) << c.text;
    }
  }
}

TEST(TurningShape, HandsAndSidesOfTheAxisAreMirrors) {
  const auto expect_same = [](const InsertOutline& a, const Cutter& b) {
    std::vector<Vec2> one, other = corners_of(b, false);
    for (const Vec2& p : insert_points(a.parts.at(0), 200)) one.push_back(p);
    for (const Vec2& p : one) {
      double nearest = 1e300;
      for (const Vec2& q : other) nearest = std::min(nearest, glm::distance(p, q));
      EXPECT_LT(nearest, 1e-6);
    }
    EXPECT_EQ(one.size(), other.size());
  };
  for (const char* const code : {"CNMG120408", "DNMG150608", "VBMT160404", "TNMG160404",
                                 "SNMG120408", "WNMG080408", "KNUX160405", "RCMT10T3M0"}) {
    const std::string iso = std::string("iso:") + code;
    const Cutter right = tool(iso);
    expect_same(mirrored_in_z(*right.insert()), tool(iso + ":L"));
    expect_same(mirrored_in_x(*right.insert()), tool(iso + ":R:orient=3"));
    expect_same(mirrored_in_x(mirrored_in_z(*right.insert())), tool(iso + ":L:orient=4"));
  }
  expect_same(mirrored_in_x(*tool("groove:3:0.2").insert()), tool("groove:3:0.2:orient=3"));
  expect_same(mirrored_in_x(*tool("thread:60:2").insert()), tool("thread:60:2:orient=8"));
}

TEST(TurningShape, FlanksLieAsTheHolderLaysThem) {
  struct Case {
    const char* text;
    double front_deg, back_deg;
  };
  // kappa 95 leaves 5 degrees behind an edge of 80; LinuxCNC's sample tables have 85 for it.
  for (const Case& c :
       {Case{"iso:CNMG120408", 85, 5}, Case{"iso:CNMG120408:L", 95, 175},
        Case{"iso:CNMG120408:orient=3", 275, 355}, Case{"iso:CNMG120408:orient=4", 265, 185},
        Case{"iso:DNMG150608", 87, 32}, Case{"iso:VBMT160404", 87, 52},
        Case{"iso:TNMG160408", 89, 29}, Case{"iso:WNMG080408", 85, 5},
        Case{"iso:SNMG120408", 105, 15}, Case{"iso:SNMG120408:R:45", 135, 45},
        Case{"iso:VBMT160404:N", 107.5, 72.5}, Case{"iso:VBMT160404:N:orient=7", 17.5, -17.5},
        Case{"bore:0.4:10", 275, 355}, Case{"bore:0.4:10:orient=2", 85, 5},
        Case{"bore:0.4:10:orient=1", 95, 175}, Case{"bore:0.4:10:orient=4", 265, 185},
        Case{"thread:60", 120, 60}}) {
    const Cutter cutter = tool(c.text);
    EXPECT_NEAR(cutter.insert_tip().front_deg.value_or(1e9), c.front_deg, 1e-9) << c.text;
    EXPECT_NEAR(cutter.insert_tip().back_deg.value_or(1e9), c.back_deg, 1e-9) << c.text;
    // The edges themselves, from the nose.
    for (const auto& [side, degrees] :
         {std::pair(InsertSide::kFront, c.front_deg), std::pair(InsertSide::kBack, c.back_deg)}) {
      const InsertPart& part = cutter.insert()->parts.at(0);
      int found = 0;
      for (std::size_t i = 0; i < part.size(); ++i) {
        if (part[i].side != side) continue;
        ++found;
        const Vec2 way = part[i].end_mm - part[(i + part.size() - 1) % part.size()].end_mm;
        const double angle = std::atan2(way.y, way.x) / kRadPerDeg;
        // One of the two runs towards the nose.
        EXPECT_NEAR(std::remainder(angle - degrees, 180), 0, 1e-9) << c.text;
      }
      EXPECT_EQ(found, 1) << c.text;
    }
  }
}

/// Width of an outline's part at a distance from its tip, which points to -x: by brute force.
double width_at(const Cutter& cutter, double x) {
  double low = 1e300, high = -1e300;
  const std::vector<Vec2> points = corners_of(cutter, false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 a = points[i], b = points[(i + 1) % points.size()];
    if ((a.y - x) * (b.y - x) > 0 || a.y == b.y) continue;
    const double z = a.x + (b.x - a.x) * (x - a.y) / (b.y - a.y);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return high - low;
}

TEST(TurningShape, ThreadsAreAsWideAsTheirStandardHasThem) {
  struct Case {
    const char* text;
    double angle_deg, flat_mm;
  };
  for (const Case& c : {Case{"thread:60:2", 60, 0.25}, Case{"thread:60", 60, 0},
                        Case{"thread:29:5.08", 29, 0.3707 * 5.08},
                        Case{"thread:30:4", 30, 0.366 * 4}, Case{"thread:40:edge=5", 40, 0}}) {
    const Cutter cutter = tool(c.text);
    for (const double x : {0.1, 0.7, 1.5}) {
      EXPECT_NEAR(width_at(cutter, x), c.flat_mm + 2 * x * std::tan(c.angle_deg / 2 * kRadPerDeg),
                  1e-9)
          << c.text;
    }
  }
  // Whitworth: the round tip meets flanks whose point would be r / sin - r below it.
  const double pitch = 2.309, r = 0.137329 * pitch, half = 27.5 * kRadPerDeg;
  const Cutter round = tool("thread:55:2.309");
  EXPECT_NEAR(round.insert_tip().nose_radius_mm, r, 1e-12);
  EXPECT_NEAR(width_at(round, 1), 2 * std::tan(half) * (1 + r / std::sin(half) - r), 1e-6);
  // The sides end at the depth.
  EXPECT_NEAR(span_of(corners_of(round, false)).high.y, pitch, 1e-9);
}

TEST(TurningShape, BladesNarrowByADegreeAtMostAThird) {
  const Cutter groove = tool("groove:3:edge=12");
  EXPECT_NEAR(width_at(groove, 1e-9), 3, 1e-6);
  EXPECT_NEAR(width_at(groove, 12 - 1e-9), 3 - 24 * std::tan(kRadPerDeg), 1e-6);
  EXPECT_NEAR(width_at(tool("part:1"), 30 - 1e-9), 1 - 1.0 / 3, 1e-6);
}

TEST(TurningShape, ShanksBeginBehindTheInsertAndNeverLeadIt) {
  struct Case {
    const char* text;
    Vec2 low, high;
  };
  const double height = span_of(corners_of(tool("iso:CNMG120408"), false)).high.y;
  EXPECT_GT(height, 12);
  for (const Case& c : {Case{"turn:0.4:2:85:25:holder=20x100", {5, 0}, {25, 100}},
                        Case{"turn:0.4:1:95:155:holder=20x100:f=24", {-24, 0}, {-4, 100}},
                        Case{"turn:0.4:3:275:335:holder=12x50", {3, -50}, {15, 0}},
                        Case{"groove:3:holder=16x60", {0, 12}, {16, 60}},
                        Case{"groove:3:orient=6:holder=16x60", {-8, 12}, {8, 60}},
                        Case{"groove:3:orient=4:holder=16x60", {-16, -60}, {0, -12}},
                        Case{"facegroove:3:holder=16x60", {12, 0}, {60, 16}},
                        Case{"turn:0.2:7:-30:30:holder=10x60", {0, -5}, {60, 5}}}) {
    const Cutter cutter = tool(c.text);
    const Span holder = span_of(corners_of(cutter, true)),
               insert = span_of(corners_of(cutter, false));
    // Its near end is where the insert ends, which a nose's flanks say.
    const auto near = [&](double wanted, double got, double edge_low, double edge_high) {
      if (wanted != 0) {
        EXPECT_NEAR(got, wanted, 1e-9) << c.text;
      } else {
        EXPECT_TRUE(std::abs(got) < 1e-9 || std::abs(got - edge_low) < 1e-9 ||
                    std::abs(got - edge_high) < 1e-9)
            << c.text << got;
      }
    };
    near(c.low.x, holder.low.x, insert.low.x, insert.high.x);
    near(c.low.y, holder.low.y, insert.low.y, insert.high.y);
    near(c.high.x, holder.high.x, insert.low.x, insert.high.x);
    near(c.high.y, holder.high.y, insert.low.y, insert.high.y);
  }
}

TEST(TurningShape, BoringBarsStayBehindTheirEdge) {
  for (const char* const text : {"bore:0.4:8", "bore:0.4:16:100", "bore:0.2:32:200:280:340",
                                 "iso:CCMT060204:bar=10x50", "iso:TCMT110204:bar=12x60"}) {
    const Cutter cutter = tool(text);
    const Span bar = span_of(corners_of(cutter, true));
    const double d = bar.high.y - bar.low.y;
    EXPECT_NEAR((bar.low.y + bar.high.y) / 2, -0.68 * d, 1e-9) << text;
    // Every point is on the inner side of the line along the front flank.
    const InsertTip& tip = cutter.insert_tip();
    const double front = *tip.front_deg * kRadPerDeg;
    const Vec2 along(std::cos(front), std::sin(front));
    const Vec2 from = tip.nose_radius_mm * nose_direction(3);
    for (const Vec2& p : corners_of(cutter, true)) {
      const Vec2 way = p - from;
      EXPECT_GT(along.x * way.y - along.y * way.x, -tip.nose_radius_mm) << text;
    }
    EXPECT_GE(bar.low.x, 1) << text;
  }
  EXPECT_NEAR(span_of(corners_of(tool("bore:0.4:16"), true)).high.x, 80, 1e-9);
  EXPECT_NEAR(span_of(corners_of(tool("bore:0.4:16:orient=2"), true)).low.y, 2.88, 1e-9);
  EXPECT_NEAR(span_of(corners_of(tool("bore:0.4:16:f=11"), true)).high.y, -3, 1e-9);
}

TEST(TurningShape, InchesAreMillimetresInside) {
  const Result<Cutter> inch = parse_shape("turn:0.03125:2:85:25:0.5", LengthUnit::kInch);
  ASSERT_TRUE(inch);
  EXPECT_EQ(inch->spec(), "turn:0.79375:2:85:25:12.7");
  EXPECT_EQ(shape_in(inch->spec(), LengthUnit::kInch), "turn:0.03125:2:85:25:0.5");
  const Result<Cutter> blade =
      parse_shape("part:0.125:0.01:orient=6:holder=0.75x4:f=0.8", LengthUnit::kInch);
  ASSERT_TRUE(blade);
  EXPECT_EQ(shape_in(blade->spec(), LengthUnit::kInch),
            "part:0.125:0.01:orient=6:holder=0.75x4:f=0.8");
  EXPECT_EQ(shape_in("iso:CNMG432:R:95", LengthUnit::kInch), "iso:CNMG432:R:95");
  EXPECT_EQ(shape_in("bore:0.4:25.4:127:275:335", LengthUnit::kInch), "bore:0.015748:1:5:275:335");
}

TEST(TurningShape, EachFaultIsNamed) {
  for (const auto& [text, wanted] : std::vector<std::pair<const char*, const char*>>{
           {"turn:0.4", "turn:0.4: orientation ORIENT is missing; the form is turn:R:ORIENT:"},
           {"turn:0.4:2", "front angle FRONT is missing"},
           {"turn:0.4:2:85", "back angle BACK is missing; both angles are needed"},
           {"turn:x:2:85:25", "nose radius R: 'x' is not a number"},
           {"turn:60:2:85:25", "nose radius R: 60 is not allowed; must be from 0 to 50 (mm)"},
           {"turn:0.4:0:85:25",
            "orientation ORIENT: '0' is not allowed; must be a whole number "
            "from 1 to 9"},
           {"turn:0.4:2:205:25", "leave no insert between them"},
           {"turn:0.4:2:400:25", "front angle FRONT: 400 is not allowed; must be from -360 to 360"},
           {"turn:0.4:2:25:25", "leave no insert between them"},
           {"turn:0.4:2:275:335", "do not lie behind a nose of orientation 2; usual are 85 and 25"},
           {"turn:0:9", "a disc (orientation 9) needs a radius above 0"},
           {"turn:3:9:85:25", "orientation 9 is a disc, which has no flanks"},
           {"turn:0.4:2:85:25:0", "edge length EDGE: 0 is not allowed"},
           {"turn:0.4:2:85:25:5:6", "6 values are too many"},
           {"turn:0.4:2:85:25:5:edge=6", "the length of the edges is given twice"},
           {"turn:0.4:2:85:25:orient=3", "orient= is the second value"},
           {"iso", "designation CODE is missing"},
           {"iso:CNMG", "'CNMG' is no insert of ISO 1832"},
           {"iso:CNMG120408:X", "hand HAND: 'X' is not allowed; must be R"},
           {"iso:CNMG120408:R:120", "must be from 10 to 100 (degrees)"},
           {"iso:CNMG120408:N:95", "an even-handed tool (N) has no angle"},
           {"iso:RCMT10T3M0:R:95", "a round insert (R) has no angle"},
           {"iso:CNMG120408:R:orient=1", "orient=1 has its tip on the other side than hand R"},
           {"iso:CNMG120408:edge=5", "edge= is not for iso"},
           {"iso:CNMG120408:teeth=4", "teeth= is for tools that turn"},
           {"iso:CNMG120408:holdr=20x100", "unknown option 'holdr'; did you mean 'holder'?"},
           {"iso:CNMG120408:holder=20", "holder: '20' is not WIDTHxLENGTH"},
           {"iso:CNMG120408:holder=20x8", "8 mm end within the insert, which is"},
           {"iso:CNMG120408:holder=20x100:bar=10x40", "two ways to hold it"},
           {"iso:CNMG120408:holder=20x290:f=200", "no tool has these sizes together"},
           {"iso:CNMG120408:f=20", "f= needs a holder"},
           {"iso:CNMG120408:holder=20x60:R", "'R' stands behind the options"},
           {"iso:CNMG120408:orient=2:orient=3", "orient= is given twice"},
           {"groove:3:2", "corner radius R: 2 is not allowed; must be from 0 to 1.5 (mm)"},
           {"groove:3:orient=7", "orient=7 is not allowed; must be 1 to 4, 6 or 8"},
           {"facegroove:3:orient=6", "orient=6 is not allowed; must be 1 to 4, 5 or 7"},
           {"thread:60:1.5:orient=2", "orient=2 is not allowed; must be 6"},
           {"thread:40:1.5", "the tip of a thread of 40 degrees is not known"},
           {"thread:5", "thread angle ANGLE: 5 is not allowed; must be from 10 to 120"},
           {"bore:0.4", "bar diameter BAR is missing"},
           {"bore:0.4:12:holder=20x100", "bore has its bar as its second value"},
           {"bore:0.4:12:orient=6", "orient=6 is not allowed; must be 1 to 4"},
           {"bore:0.4:30:2", "ends before it begins"},
           {"turn:0.4:7:-30:30:bar=10x60", "orientation 7 does not"}}) {
    const std::string error = turning_error(text);
    EXPECT_NE(error.find(wanted), std::string::npos) << text << " -> " << error;
    EXPECT_TRUE(error.starts_with(text)) << error;
  }
}

TEST(TurningFlanks, AnglesAreTakenAsTheyAreNearest) {
  const auto near = nearest_flanks({330, 30});
  ASSERT_TRUE(near);
  EXPECT_DOUBLE_EQ(near->back_deg, 390);
  EXPECT_TRUE(fits_orientation(*near, 7));
  EXPECT_FALSE(fits_orientation(*near, 5));
  EXPECT_FALSE(nearest_flanks({0, 180}));
  EXPECT_EQ(nearest_flanks({-80, -25})->front_deg, -80);
  for (int orientation = 1; orientation <= 8; ++orientation) {
    EXPECT_TRUE(fits_orientation(usual_flanks(orientation), orientation)) << orientation;
    for (int other = 1; other <= 8; ++other) {
      const Vec2 a = nose_direction(orientation), b = nose_direction(other);
      if (glm::dot(a, b) < 0) {
        EXPECT_FALSE(fits_orientation(usual_flanks(orientation), other));
      }
    }
  }
}

TEST(TurningShape, HowItIsUsedIsInItsText) {
  const Cutter cutter = *parse_shape("turn:0.4:2:85:5:max_ap=2.5:path=tool");
  EXPECT_EQ(cutter.spec(), "turn:0.4:2:85:5:max_ap=2.5:path=tool");
  EXPECT_EQ(insert_use_of(cutter).max_depth_mm, 2.5);
  EXPECT_TRUE(insert_use_of(cutter).goes_its_path);
  EXPECT_EQ(turning_shape_in(cutter.spec(), LengthUnit::kInch),
            turning_shape_in("turn:0.4:2:85:5", LengthUnit::kInch) + ":max_ap=0.098425:path=tool");
  const Cutter plain = *parse_shape("turn:0.4:2:85:5:path=contour");
  EXPECT_FALSE(insert_use_of(plain).max_depth_mm);
  EXPECT_FALSE(insert_use_of(plain).goes_its_path);
  EXPECT_FALSE(insert_use_of(*parse_shape("flat:6")).goes_its_path);
  const Cutter fed = *parse_shape("iso:CNMG120408:max_ap=2.5:max_f=0.3");
  EXPECT_EQ(fed.spec(), "iso:CNMG120408:max_ap=2.5:max_f=0.3");
  EXPECT_EQ(insert_use_of(fed).max_feed_mm, 0.3);
  EXPECT_FALSE(insert_use_of(cutter).max_feed_mm);
  EXPECT_FALSE(parse_shape("turn:0.4:2:85:5:max_f=0"));
  EXPECT_NE(parse_shape("turn:0.4:2:85:5:path=centre").error().find("must be tool"),
            std::string::npos);
  EXPECT_NE(parse_shape("turn:0.4:2:85:5:max_ap=1:max_ap=2").error().find("given twice"),
            std::string::npos);
}

}  // namespace
}  // namespace kerf
