// Contours as lines and true arcs: against closed forms, and against the polygons.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <sstream>

#include "base/text_scan.h"
#include "stock/turning/contour_arcs.h"
#include "stock/turning/turned_blank.h"
#include "stock/turning/turned_drawing.h"
#include "stock/turning/turned_features.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

constexpr double kRadius_mm = 1e-4;  // 0.1 um

std::vector<double> radii_of(const TurnedPart& part) {
  std::vector<double> radii;
  for (const turning::Contour& contour : part.contours()) {
    for (const turning::ContourPiece& piece : turning::with_arcs(contour)) {
      if (piece.arc) radii.push_back(piece.arc->radius_mm);
    }
  }
  std::sort(radii.begin(), radii.end());
  return radii;
}

void expect_radii(const TurnedPart& part, const std::vector<double>& expected) {
  const std::vector<double> radii = radii_of(part);
  ASSERT_EQ(radii.size(), expected.size()) << fmt::format("{}", fmt::join(radii, " "));
  for (std::size_t i = 0; i < radii.size(); ++i) EXPECT_NEAR(radii[i], expected[i], kRadius_mm);
}

/// Twice the area over the pieces.
double area_of(const turning::CurvedContour& contour) {
  double twice = 0;
  for (const turning::ContourPiece& piece : contour) {
    twice += cross(piece.from_mm, piece.to_mm);
    if (!piece.arc) continue;
    const double r = piece.arc->radius_mm, sweep = piece.arc->sweep_rad;
    twice += r * r * (sweep - std::sin(sweep));
  }
  return twice / 2;
}

/// A shaft: face, convex edge of radius 5, cylinder, corner of radius 6, shoulder, groove of a full
/// radius of 2, neck whose corner has the nose's radius.
struct Shaft {
  static constexpr double kNose_mm = 0.4;
  TurnedPart part = *TurnedPart::create(bar_profile(-80, 0, 50));

  Shaft() {
    const TurningTool nose(*nose_insert({kNose_mm, 2, radians(85), radians(5), 12}));
    Vec2 at(0, -0.4);
    const auto go = [&](const Vec2& to) {
      part.cut(nose, line(at, to));
      at = to;
    };
    const auto turn = [&](const Vec2& center, double turns) {
      const TurnMove move = arc(at, center, turns);
      part.cut(nose, move);
      at = move.to_mm;
    };
    go({0, 5});
    turn({-5, 5}, 0.25);
    go({-15, 10});
    turn({-15, 16}, -0.25);
    go({-21, 20});
    go({-21, 27});
    // A round tool, straight in: half of it in material.
    part.cut(TurningTool(round_insert(2)), line({-30, 30}, {-30, 25}));
    at = {-64, 30};
    go({-64, 18});
    go({-62, 18});
    go({-62, 30});
  }
};

TEST(TurnedArcs, radii_are_those_of_moves_and_noses) {
  // The nose runs inside of what it leaves: 5 less than its radius, 6 more.
  expect_radii(Shaft().part, {0.4, 2, 4.6, 6.4});
}

TEST(TurnedArcs, areas_and_places_are_those_of_the_polygons) {
  const Shaft shaft;
  for (const turning::Contour& contour : shaft.part.contours()) {
    const turning::CurvedContour curved = turning::with_arcs(contour);
    const double area = static_cast<double>(contour.area2()) / 2 / 1e10;
    EXPECT_NEAR(area_of(curved) / area, 1, 1e-7);
    for (std::size_t i = 0; i < curved.size(); ++i)
      EXPECT_EQ(curved[i].to_mm, curved[(i + 1) % curved.size()].from_mm);
  }
}

TEST(TurnedArcs, a_hollow_ball_and_a_ring_are_circles) {
  // A ball nose drill on the axis leaves a quarter of a circle.
  TurnedPart bored = *TurnedPart::create(bar_profile(-40, 0, 40));
  const Cutter ball =
      *Cutter::from_profile("ball", {{ProfilePiece::Kind::kArc, 0, 0, 5, 5, 0, 5, 5, true},
                                     {ProfilePiece::Kind::kLine, 5, 5, 5, 60}});
  bored.cut(TurningTool(*axial_outline(ball, 80)), line({5, 0}, {-20, 0}));
  expect_radii(bored, {5});
  // A torus that was drawn is one circle.
  TemporaryFolder folder;
  const std::string path = folder / "torus.dxf";
  std::ofstream(path)
      << "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\n5\n20\n15\n40\n4\n0\nENDSEC\n0\nEOF\n";
  const TurnedPart torus = *TurnedPart::create(*read_profile(path));
  const turning::CurvedContour circle = turning::with_arcs(torus.contours()[0]);
  ASSERT_EQ(circle.size(), 1u);
  ASSERT_TRUE(circle[0].arc);
  EXPECT_NEAR(circle[0].arc->radius_mm, 4, 1e-5);
  EXPECT_NEAR(circle[0].arc->center_mm.x, 5, 1e-5);
  EXPECT_NEAR(circle[0].arc->center_mm.y, 15, 1e-5);
  EXPECT_NEAR(std::abs(circle[0].arc->sweep_rad), 2 * kPi, 1e-12);
}

TEST(TurnedArcs, many_radii_are_found) {
  // Arcs of programs, of many radii, both ways, by two noses.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    const double nose = i % 2 == 0 ? 0.4 : 0.8, r = 1 + 19 * unit(random) * unit(random);
    const bool hollow = i % 3 == 0;
    TurnedPart part = *TurnedPart::create(bar_profile(-80, 0, 100));
    const TurningTool tool(*nose_insert({nose, 2, radians(85), radians(5), 60}));
    const Vec2 from(-30, 20), center = hollow ? from + Vec2(0, r) : from - Vec2(0, r);
    // A quarter from level to steep, on which the nose's front alone cuts.
    TurnMove quarter = hollow ? arc(from, center, -0.2) : arc(center + Vec2(r, 0), center, 0.25);
    part.cut(tool, quarter);
    const double expected = hollow ? r + nose : r - nose;
    if (expected < 0.3) continue;
    double best = 1e300;
    for (const double radius : radii_of(part)) best = std::min(best, std::abs(radius - expected));
    EXPECT_LT(best, kRadius_mm) << fmt::format("{} nose {} radius {}", hollow, nose, r);
    worst = std::max(worst, best);
  }
  EXPECT_LT(worst, 3e-5);
}

/// How far a place of the polygon lies from the curve.
double off_curve(const turning::CurvedContour& contour, const Vec2& p) {
  double least = 1e300;
  for (const turning::ContourPiece& piece : contour) {
    least = std::min(least, turning::distance_to_edge_mm(p, piece.from_mm, piece.to_mm) +
                                (piece.arc ? 1e300 : 0));
    if (!piece.arc) continue;
    const Vec2 a = piece.from_mm - piece.arc->center_mm, b = p - piece.arc->center_mm;
    const double sense = piece.arc->sweep_rad > 0 ? 1 : -1;
    double along = sense * std::atan2(cross(a, b), glm::dot(a, b));
    if (along < -1e-3) along += 2 * kPi;
    if (along > std::abs(piece.arc->sweep_rad) + 1e-3) continue;
    least = std::min(least, std::abs(glm::length(b) - piece.arc->radius_mm));
  }
  return least;
}

TEST(TurnedArcs, of_random_parts_nothing_is_off_by_more_than_the_band) {
  int arcs = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    for (const TurnMove& move : random_moves(random, 12))
      part.cut(TurningTool(random_tool(random)), move);
    for (const turning::Contour& contour : part.contours()) {
      const turning::CurvedContour curved = turning::with_arcs(contour);
      for (const turning::ContourPiece& piece : curved) arcs += piece.arc ? 1 : 0;
      const turning::Ring ring = contour.ring();
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = turning::to_mm(ring[i]), b = turning::to_mm(ring[(i + 1) % ring.size()]);
        ASSERT_LT(off_curve(curved, a), 2 * turning::kArcBand_mm) << seed;
        ASSERT_LT(off_curve(curved, (a + b) / 2.0), 2 * turning::kArcBand_mm) << seed;
      }
    }
  }
  EXPECT_GT(arcs, 40);
}

TEST(TurnedArcs, lines_of_a_program_stay_lines) {
  // A radius that a CAM program has made of chords of 10 um.
  TurnedProfile profile{{{-40, 0}, {0, 0}}};
  for (int i = 0; i <= 40; ++i) {
    const double a = kPi / 2 * i / 40;
    profile[0].push_back({-10 + 10 * std::cos(a), 10 + 10 * std::sin(a)});
  }
  profile[0].push_back({-40, 20});
  expect_radii(*TurnedPart::create(profile), {});
}

class TurnedDrawing : public testing::Test {
 protected:
  static std::string text_of(const std::string& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  TemporaryFolder folder_;
};

TEST_F(TurnedDrawing, is_read_again_as_the_same_part) {
  TurnedPart bored = Shaft().part;
  bored.cut(TurningTool(*axial_outline(
                *Cutter::from_profile("drill", {{ProfilePiece::Kind::kLine, 0, 0, 4, 2.4},
                                                {ProfilePiece::Kind::kLine, 4, 2.4, 4, 60}}),
                80)),
            line({5, 0}, {-20, 0}));
  TurnedProfile cavity = bar_profile(-64, -4, 40);
  cavity.push_back({{-30, 5}, {-20, 5}, {-20, 9}, {-30, 9}});
  for (const TurnedPart& part : {Shaft().part, bored, *TurnedPart::create(cavity)}) {
    ASSERT_TRUE(write_turned_dxf(part, folder_ / "part.dxf"));
    ASSERT_TRUE(write_turned_svg(part, folder_ / "part.svg"));
    for (const char* const name : {"part.dxf", "part.svg"}) {
      const Result<TurnedProfile> profile = read_profile(folder_ / name);
      ASSERT_TRUE(profile) << profile.error();
      const std::optional<TurnedPart> again = TurnedPart::create(*profile);
      ASSERT_TRUE(again);
      EXPECT_NEAR(again->remaining_mm3() / part.remaining_mm3(), 1, 1e-6) << name;
      EXPECT_EQ(again->contours().size(), part.contours().size());
      EXPECT_NEAR(again->profile()[0][0].x, part.profile()[0][0].x, 70);
      turning::Rect a, b;
      for (const turning::Contour& c : part.contours()) a.extend(c.box());
      for (const turning::Contour& c : again->contours()) b.extend(c.box());
      EXPECT_NEAR(turning::to_mm(a.min_x), turning::to_mm(b.min_x), 2e-4);
      EXPECT_NEAR(turning::to_mm(a.max_x), turning::to_mm(b.max_x), 2e-4);
      EXPECT_NEAR(turning::to_mm(a.max_y), turning::to_mm(b.max_y), 2e-4);
    }
  }
}

// By a reader of its own: what a CAM program sees.
TEST_F(TurnedDrawing, dxf_has_arcs_with_the_radii_and_a_centre_line) {
  ASSERT_TRUE(write_turned_dxf(Shaft().part, folder_ / "part.dxf"));
  std::istringstream in(text_of(folder_ / "part.dxf"));
  struct Corner {
    double x = 0, y = 0, bulge = 0;
  };
  std::vector<Corner> corners;
  std::string code, value, entity;
  int centre_lines = 0, contours = 0;
  while (std::getline(in, code) && std::getline(in, value)) {
    const int group = std::stoi(code);
    if (group == 0) entity = value;
    if (group == 0 && value == "VERTEX") corners.emplace_back();
    if (group == 0 && value == "POLYLINE") ++contours;
    if (group == 8 && entity == "LINE") centre_lines += value == "CENTER" ? 1 : 0;
    if (group == 8 && entity == "VERTEX") {
      EXPECT_EQ(value, "CONTOUR");
    }
    if (entity != "VERTEX") continue;
    if (group == 10) corners.back().x = std::stod(value);
    if (group == 20) corners.back().y = std::stod(value);
    if (group == 42) corners.back().bulge = std::stod(value);
  }
  EXPECT_EQ(contours, 1);
  EXPECT_EQ(centre_lines, 1);
  EXPECT_LT(corners.size(), 25u);
  std::vector<double> radii;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if (a.bulge == 0) continue;
    radii.push_back(std::hypot(b.x - a.x, b.y - a.y) /
                    (2 * std::sin(2 * std::atan(std::abs(a.bulge)))));
  }
  std::sort(radii.begin(), radii.end());
  ASSERT_EQ(radii.size(), 4u);
  const double expected[] = {0.4, 2, 4.6, 6.4};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(radii[i], expected[i], 1.1e-4);
}

/// A hexagon of 35 across flats, its corners at 20.2: turned to 30 in front, with a groove to 34 in
/// the rest and one to 36, which leaves something of the corners.
TEST_F(TurnedDrawing, flats_are_dashed_where_the_bar_still_has_them) {
  const BarFlats flats{6, 17.5};
  TurnedPart part = *TurnedPart::create(bar_profile(-60, 0, 2 * flats.outer_radius_mm()),
                                        ChuckSide::kLowZ, flats);
  part.cut(TurningTool(right_hand(0)), line({2, 15}, {-20, 15}));
  const TurningTool blade(*groove_insert({3, 0, 40, 2}));
  for (const auto& [z, r] : {std::pair(-34.0, 17.0), std::pair(-50.0, 18.0)}) {
    part.cut(blade, line({z, 25}, {z, r}));
    part.cut(blade, line({z, r}, {z, 25}));
  }
  ASSERT_TRUE(write_turned_dxf(part, folder_ / "hex.dxf"));
  ASSERT_TRUE(write_turned_svg(part, folder_ / "hex.svg"));
  std::istringstream in(text_of(folder_ / "hex.dxf"));
  std::vector<std::array<double, 4>> lines;
  int notes = 0;
  std::string code, value, entity, layer;
  while (std::getline(in, code) && std::getline(in, value)) {
    const int group = std::stoi(code);
    if (group == 0) entity = value;
    if (group == 8) layer = value;
    if (layer != "FLATS") continue;
    if (group == 1) {
      EXPECT_EQ(value, "HEX 35");
      ++notes;
    }
    if (entity != "LINE") continue;
    if (group == 10) lines.push_back({std::stod(value)});
    if (group == 20) lines.back()[1] = std::stod(value);
    if (group == 11) lines.back()[2] = std::stod(value);
    if (group == 21) lines.back()[3] = std::stod(value);
  }
  // The shoulder leans by 5 degrees from the radius of 15 at Z-20 on: at the corners, where flats
  // end, it is farthest in front.
  const double shoulder = -20 + (flats.outer_radius_mm() - 15) * std::tan(radians(5));
  const double expected[2][2] = {{-60, -34}, {-31, shoulder}};
  ASSERT_EQ(lines.size(), 2u) << "the groove to 36 has no end of the flats";
  EXPECT_EQ(notes, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(lines[i][0], expected[i][0], 1e-4);
    EXPECT_NEAR(lines[i][2], expected[i][1], 1e-4);
    EXPECT_EQ(lines[i][1], 17.5);
    EXPECT_EQ(lines[i][3], 17.5);
  }
  const std::string svg = text_of(folder_ / "hex.svg");
  EXPECT_NE(svg.find("class=\"flats\""), std::string::npos);
  EXPECT_NE(svg.find("<title>HEX 35</title>"), std::string::npos);
  // They are no part of the profile.
  for (const char* const name : {"hex.dxf", "hex.svg"}) {
    const Result<TurnedProfile> profile = read_profile(folder_ / name);
    ASSERT_TRUE(profile) << profile.error();
    TurnedProfile round = part.profile();
    EXPECT_NEAR(
        TurnedPart::create(*profile)->remaining_mm3() / TurnedPart::create(round)->remaining_mm3(),
        1, 1e-6);
  }
  // Nothing is left of them: nothing is drawn.
  part.cut(TurningTool(right_hand(0)), line({2, 15}, {-70, 15}));
  ASSERT_TRUE(write_turned_dxf(part, folder_ / "round.dxf"));
  EXPECT_EQ(text_of(folder_ / "round.dxf").find("FLATS"), std::string::npos);
}

TEST_F(TurnedDrawing, says_what_cannot_be_written) {
  EXPECT_FALSE(write_turned_dxf(Shaft().part, folder_ / "no/such.dxf"));
  EXPECT_FALSE(write_turned_svg(Shaft().part, folder_ / "no/such.svg"));
}

using Kind = TurnedFeature::Kind;

std::string feature_text(const TurnedFeature& f) {
  const char* const names[] = {"cylinder", "face", "taper", "radius", "groove"};
  std::string text = f.is_inside ? "inner " : "";
  text += names[static_cast<std::size_t>(f.kind)];
  const auto rounded = [](double value) {
    return number_text(std::round(value * 1e3) / 1e3 + 0.0);
  };
  text += fmt::format(" z {}..{}", rounded(f.high_z_mm), rounded(f.low_z_mm));
  text += fmt::format(" d {}..{}", rounded(f.low_d_mm), rounded(f.high_d_mm));
  if (f.kind == Kind::kTaper) text += fmt::format(" angle {}", rounded(f.angle_deg));
  if (f.kind == Kind::kRadius)
    text += fmt::format(" {} r {}", f.is_hollow ? "hollow" : "round", rounded(f.radius_mm));
  return text;
}

std::vector<std::string> features_text(const TurnedPart& part) {
  std::vector<std::string> texts;
  for (const TurnedFeature& f : features_of(part)) texts.push_back(feature_text(f));
  return texts;
}

TEST(TurnedFeatures, of_a_stepped_shaft_with_a_bore) {
  const TurnedPart part = *TurnedPart::create({{{-60, 0},
                                                {-30, 0},
                                                {-30, 5},
                                                {-20, 5},
                                                {-20, 6},
                                                {-18, 6},
                                                {-18, 5},
                                                {0, 5},
                                                {0, 10},
                                                {-2, 12},
                                                {-15, 12},
                                                {-15, 11},
                                                {-17, 11},
                                                {-17, 12},
                                                {-25, 12},
                                                {-45, 16},
                                                {-45, 20},
                                                {-60, 20}}});
  const std::vector<std::string> expected{"face z 0..0 d 10..20",
                                          "taper z 0..-2 d 20..24 angle 45",
                                          "cylinder z -2..-15 d 24..24",
                                          "inner cylinder z 0..-18 d 10..10",
                                          "face z -15..-15 d 22..24",
                                          "cylinder z -15..-17 d 22..22",
                                          "groove z -15..-17 d 22..24",
                                          "face z -17..-17 d 22..24",
                                          "face z -18..-18 d 10..12",
                                          "inner cylinder z -18..-20 d 12..12",
                                          "inner groove z -18..-20 d 10..12",
                                          "face z -20..-20 d 10..12",
                                          "cylinder z -17..-25 d 24..24",
                                          "inner cylinder z -20..-30 d 10..10",
                                          "face z -30..-30 d 0..10",
                                          "taper z -25..-45 d 24..32 angle 11.31",
                                          "face z -45..-45 d 32..40",
                                          "cylinder z -45..-60 d 40..40",
                                          "face z -60..-60 d 0..40"};
  std::vector<std::string> found = features_text(part), sorted = expected;
  std::sort(found.begin(), found.end());
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(found, sorted);
  // From the highest z on.
  double last = 1e300;
  for (const TurnedFeature& f : features_of(part)) {
    EXPECT_LE(f.low_z_mm + f.high_z_mm, last);
    last = f.low_z_mm + f.high_z_mm;
  }
}

TEST(TurnedFeatures, of_a_part_that_was_cut) {
  std::vector<std::string> found = features_text(Shaft().part);
  const auto has = [&](const std::string& text) {
    EXPECT_TRUE(std::find(found.begin(), found.end(), text) != found.end())
        << text << " is not in\n"
        << fmt::format("{}", fmt::join(found, "\n"));
  };
  has("radius z 0..-4.6 d 10.8..20 round r 4.6");
  has("cylinder z -4.6..-14.6 d 20..20");
  has("radius z -14.6..-21 d 20..32.8 hollow r 6.4");
  has("radius z -28..-32 d 46..50 hollow r 2");
  has("groove z -28..-32 d 46..50");
}

TEST(TurnedFeatures, passes_of_the_same_diameter_are_one_cylinder) {
  TurnedPart part = *TurnedPart::create(bar_profile(-60, 0, 40));
  const TurningTool blade(*groove_insert({4, 0, 30, 2}));
  // One pass ends 0.1 um above the other.
  part.cut(blade, line({2, 15}, {-20, 15}));
  part.cut(blade, line({-20, 15.0001}, {-40, 15.0001}));
  int cylinders = 0;
  for (const TurnedFeature& f : features_of(part)) cylinders += f.kind == Kind::kCylinder;
  EXPECT_EQ(cylinders, 2) << "that and the bar";
}

TEST(TurnedFeatures, of_nothing_there_is_none) {
  TurnedPart gone = *TurnedPart::create(bar_profile(-1, 0, 4));
  gone.cut(TurningTool(*groove_insert({6, 0, 40, 2})), line({-3, 5}, {-3, -5}));
  EXPECT_TRUE(features_of(gone).empty());
}

}  // namespace
}  // namespace kerf
