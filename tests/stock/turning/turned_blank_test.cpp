// Blanks that turn: bodies, drawings, bars with flats.
#include "stock/turning/turned_blank.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/base/temporary_folder.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

double volume_of(const std::string& spec) {
  const Result<Blank> blank = parse_blank(spec);
  EXPECT_TRUE(blank) << blank.error();
  const auto stock = turning_stock_of(*blank);
  EXPECT_TRUE(stock) << stock.error();
  return stock ? (*stock)->remaining_mm3() : 0;
}

std::string fault_of(const std::string& spec) {
  const Result<Blank> blank = parse_blank(spec);
  if (!blank) return "not parsed: " + blank.error();
  const auto profile = turned_profile_of(*blank);
  return profile ? "none" : profile.error();
}

TEST(TurnedBlank, bars_and_tubes) {
  EXPECT_NEAR(volume_of("cylinder:0,0,-60:2:50"), cylinder_mm3(50, 62), 1e-6);
  EXPECT_NEAR(volume_of("tube:0,0,-60:0:50:30"), cylinder_mm3(50, 60) - cylinder_mm3(30, 60), 1e-6);
  EXPECT_NEAR(volume_of("hex:0,0,-40:0:27"), 27 * 27 * std::sqrt(3.0) / 2 * 40, 1e-3);
  EXPECT_NEAR(volume_of("square:0,0,-40:0:20"), 20 * 20 * 40, 1e-3);
}

TEST(TurnedBlank, bodies_add_up) {
  // A flange, which overlaps the bar, and a tube behind it that only touches.
  EXPECT_NEAR(volume_of("cylinder:0,0,-60:0:30 + cylinder:0,0,-20:-10:80 + tube:0,0,-70:-60:30:10"),
              cylinder_mm3(30, 60) + cylinder_mm3(80, 10) - cylinder_mm3(30, 10) +
                  cylinder_mm3(30, 10) - cylinder_mm3(10, 10),
              1e-5);
  EXPECT_NEAR(volume_of("hex:0,0,-40:0:27+cylinder:0,0,-60:-40:20"),
              27 * 27 * std::sqrt(3.0) / 2 * 40 + cylinder_mm3(20, 20), 1e-3);
}

TEST(TurnedBlank, what_does_not_turn_is_told) {
  const auto expect = [](const std::string& spec, const std::string& part) {
    EXPECT_NE(fault_of(spec).find(part), std::string::npos) << fault_of(spec);
  };
  expect("box:0,0,-10:10,10,0", "a lathe turns no box");
  expect("cylinder:0,0,-10:10:5:x", "it lies along X; on a lathe it turns about Z");
  expect("cylinder:3,-1.5,-10:0:5", "its axis is at X3 Y-1.5; on a lathe it turns about X0 Y0");
  expect("cylinder:0,0,-10:0:5+cylinder:0,0,2:4:5", "lie apart, in 2 pieces; must be one");
  expect("tube:0,0,-10:0:50:40+cylinder:0,0,-10:0:30", "lie apart");
  expect("cylinder:0,0,-2500:0:5", "it reaches Z-2500; must be within 2000 mm of Z0");
  expect("cylinder:0,0,-25:0:2500", "its radius is 1250 mm; must be at most 1000 mm");
  expect("hex:0,0,-10:0:20+square:0,0,-20:-10:20", "there is another bar of flats already");
  expect("hex:0,0,-10:0:20+cylinder:0,0,-20:-10:20.1", "nothing may reach beyond these");
  expect("sheet:0,0:10,10:1", "is no bar");
  expect("state:part.state", "is no bar");
  expect("profile:no_such.dxf", "No such file");
  EXPECT_EQ(fault_of("hex:0,0,-10:0:20+cylinder:0,0,-20:-10:20"), "none");
}

/// Of flats, by angles and slices: what turns reaches r(z) from `low` to `high`.
double sliced_mm3(const BarFlats& flats, double low, double high,
                  const std::function<double(double)>& r) {
  constexpr int kAngles = 720, kSlices = 2000;
  double sum = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double reach = flats.reach_mm(2 * kPi * (i + 0.5) / kAngles);
    for (int k = 0; k < kSlices; ++k) {
      const double z = low + (high - low) * (k + 0.5) / kSlices;
      const double outer = std::min(r(z), reach);
      sum += outer * outer / 2 * (2 * kPi / kAngles) * (high - low) / kSlices;
    }
  }
  return sum;
}

TEST(TurnedBlank, a_bar_of_flats_is_turned_round) {
  for (const int n : {6, 4}) {
    const BarFlats flats{n, 10};
    TurnedPart part = *TurnedPart::create(bar_profile(-40, 0, 2 * flats.outer_radius_mm()),
                                          ChuckSide::kLowZ, flats);
    const double bar_mm2 = n * std::tan(kPi / n) * 100;
    EXPECT_NEAR(part.blank_mm3(), bar_mm2 * 40, 1e-3);
    const TurningTool tool(*groove_insert({4, 0, 30, 2}));
    // Down to a radius between flats and corners, over 20 mm.
    const double r = n == 6 ? 10.6 : 12.3;
    part.cut(tool, line({-20, 20}, {-20, r}));
    TurnCut cut = part.cut(tool, line({-20, r}, {2, r}));
    const double half = std::acos(10 / r);
    const double round_mm2 = (kPi - n * half) * r * r + n * 10 * r * std::sin(half);
    EXPECT_NEAR(part.remaining_mm3(), bar_mm2 * 20 + round_mm2 * 20, 1e-3);
    EXPECT_NEAR(part.blank_mm3() - part.remaining_mm3(), cut.removed_mm3 * 20 / 16, 2e-3);
    // Below the flats it is a cylinder.
    part.cut(tool, line({-20, 20}, {-20, 9}));
    cut = part.cut(tool, line({-20, 9}, {2, 9}));
    EXPECT_NEAR(part.remaining_mm3(), bar_mm2 * 20 + cylinder_mm3(18, 20), 1e-3);
  }
}

TEST(TurnedBlank, chamfers_of_flats_are_what_slices_find) {
  for (const int n : {6, 4}) {
    const BarFlats flats{n, 10};
    TurnedPart part = *TurnedPart::create(bar_profile(-10, 0, 2 * flats.outer_radius_mm()),
                                          ChuckSide::kLowZ, flats);
    // A cone of 30 degrees from r = 9.5 at the face on.
    const double rise = 1 / std::tan(radians(30));
    const TurningTool tool(*nose_insert({0, 2, radians(85), radians(5), 12}));
    part.cut(tool, line({0.5 * std::tan(radians(30)), 9}, {-6, 9.5 + 6 * rise}));
    const auto r = [&](double z) { return std::min(9.5 - z * rise, flats.outer_radius_mm()); };
    EXPECT_NEAR(part.remaining_mm3(), sliced_mm3(flats, -10, 0, r), 0.05);
    // Surfaces show it.
    double volume = 0;
    const TriangleMesh mesh = part.mesh(0.01);
    for (const auto& t : mesh.triangles) {
      const glm::dvec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]),
          c(mesh.positions_mm[t[2]]);
      volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    EXPECT_NEAR(volume / part.remaining_mm3(), 1, 1e-3);
    for (const glm::vec3& p : mesh.positions_mm)
      EXPECT_LE(std::hypot(p.x, p.y), flats.reach_mm(std::atan2(p.y, p.x)) + 1e-4);
    double patches = 0;
    for (std::size_t band = 0; band < TurnedPart::kBands; ++band) {
      const MeshPatch patch = part.patch(band, 0);
      for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) {
          return glm::dvec3(patch.vertices[patch.indices[i + k]].position_mm);
        };
        patches += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
        const glm::dvec3 normal(unpack_normal(patch.vertices[patch.indices[i]].normal));
        EXPECT_GE(glm::dot(normal, glm::cross(at(1) - at(0), at(2) - at(0))), -1e-9);
      }
    }
    EXPECT_NEAR(patches / part.remaining_mm3(), 1, 1e-3);
  }
}

TEST(TurnedBlank, flats_count_in_the_digest) {
  const BarFlats flats{6, 10};
  const TurnedProfile profile = bar_profile(-40, 0, 2 * flats.outer_radius_mm());
  EXPECT_NE(TurnedPart::create(profile, ChuckSide::kLowZ, flats)->digest(),
            TurnedPart::create(profile)->digest());
}

/// Drawings from entities; of lines each X Y X Y.
class ProfileFile : public testing::Test {
 protected:
  static std::string dxf_line(double x0, double y0, double x1, double y1) {
    return fmt::format("0\nLINE\n8\n0\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", x0, y0, x1, y1);
  }
  static std::string dxf_arc(double x, double y, double r, double from_deg, double to_deg) {
    return fmt::format("0\nARC\n8\n0\n10\n{}\n20\n{}\n40\n{}\n50\n{}\n51\n{}\n", x, y, r, from_deg,
                       to_deg);
  }
  std::string file(const std::string& entities, const std::string& name = "part.dxf") {
    const std::string path = folder_ / name;
    std::ofstream(path) << "0\nSECTION\n2\nENTITIES\n" << entities << "0\nENDSEC\n0\nEOF\n";
    return path;
  }
  double volume(const std::string& entities) { return volume_of("profile:" + file(entities)); }
  std::string fault(const std::string& entities) {
    return fault_of("profile:" + file(entities)).substr(folder_.path().size() + 1);
  }

  TemporaryFolder folder_;
};

TEST_F(ProfileFile, a_chain_is_closed_along_the_axis) {
  // A ball of radius 10 on a shank of radius 6, from right to left, out of order, and a centre
  // line.
  const double z = -10 - std::sqrt(100.0 - 36);
  const std::string ball = dxf_line(-40, 6, z, 6) +
                           dxf_arc(-10, 0, 10, 0, 180 / kPi * std::atan2(6, z + 10)) +
                           dxf_line(-50, 0, 20, 0) + dxf_line(-40, 0, -40, 6);
  const double cap = 10 - std::sqrt(100.0 - 36);  // of the ball, in the shank
  const double expected =
      4.0 / 3 * kPi * 1000 - kPi * cap * cap * (10 - cap / 3) + cylinder_mm3(12, 40 + z);
  EXPECT_NEAR(volume(ball) / expected, 1, 1e-6);
}

TEST_F(ProfileFile, closed_contours_holes_and_both_halves) {
  const auto rectangle = [](double z0, double r0, double z1, double r1) {
    return dxf_line(z0, r0, z1, r0) + dxf_line(z1, r0, z1, r1) + dxf_line(z1, r1, z0, r1) +
           dxf_line(z0, r1, z0, r0);
  };
  const double tube = cylinder_mm3(40, 30) - cylinder_mm3(20, 30);
  EXPECT_NEAR(volume(rectangle(-30, 10, 0, 20)), tube, 1e-6);
  // A hollow inside, as a hole in the contour.
  EXPECT_NEAR(volume(rectangle(-30, 10, 0, 20) + rectangle(-20, 14, -10, 16)),
              tube - cylinder_mm3(32, 10) + cylinder_mm3(28, 10), 1e-6);
  // The full section of a bar, that of a tube.
  EXPECT_NEAR(volume(rectangle(-30, -20, 0, 20)), cylinder_mm3(40, 30), 1e-6);
  EXPECT_NEAR(volume(rectangle(-30, 10, 0, 20) + rectangle(-30, -20, 0, -10)), tube, 1e-6);
  // Half a torus in a ring.
  EXPECT_NEAR(volume("0\nCIRCLE\n8\n0\n10\n5\n20\n15\n40\n4\n") / (2 * kPi * 15 * kPi * 16), 1,
              1e-6);
}

TEST_F(ProfileFile, what_is_no_profile_is_told) {
  const auto rectangle = [](double z0, double r0, double z1, double r1) {
    return dxf_line(z0, r0, z1, r0) + dxf_line(z1, r0, z1, r1) + dxf_line(z1, r1, z0, r1) +
           dxf_line(z0, r1, z0, r0);
  };
  EXPECT_EQ(fault(rectangle(-30, -21, 0, 20)),
            "part.dxf: the halves above and below the axis differ at X-30 Y21; draw the upper half "
            "alone, or both equal");
  EXPECT_EQ(fault(rectangle(-30, -20, 0, -10)),
            "part.dxf: nothing lies above the axis, which is Y0 of the drawing");
  EXPECT_EQ(fault(rectangle(-30, 1, 0, 20) + rectangle(10, 1, 20, 20)),
            "part.dxf: the contours lie apart, in 2 pieces; must be one");
  EXPECT_EQ(fault(rectangle(-3000, 1, 0, 20)),
            "part.dxf: it reaches Z-3000; must be within 2000 mm of Z0");
  // Open above the axis on one side, and on the other.
  const std::string open =
      dxf_line(-30, 0, -30, 10) + dxf_line(-30, 10, 0, 10) + dxf_line(0, 10, 0, 4);
  EXPECT_EQ(fault(open),
            "part.dxf:6: the contour that begins here is open: nothing goes on at X0.0000 Y4.0000 "
            "(within 0.01 mm)");
  // A hundredth from the axis is on it.
  EXPECT_NEAR(
      volume(dxf_line(-30, 0.009, -30, 10) + dxf_line(-30, 10, 0, 10) + dxf_line(0, 10, 0, -0.009)),
      cylinder_mm3(20, 30), 1e-6);
}

TEST_F(ProfileFile, svg_has_its_axis_at_the_lower_edge) {
  const std::string path = folder_ / "part.svg";
  std::ofstream(path) << "<svg width=\"30mm\" height=\"20mm\" viewBox=\"0 0 30 20\">"
                         "<path d=\"M0 20 L0 10 L30 10 L30 20 Z\"/></svg>";
  EXPECT_NEAR(volume_of("profile:" + path), cylinder_mm3(20, 30), 1e-6);
}

}  // namespace
}  // namespace kerf
