// Contacts and depths of the Z-map in cells that are coarse for the tools, against brute force.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/stock/sweep_oracle.h"

namespace kerf {
namespace {

constexpr double kTolerance_mm = 0.01;
/// Heights are good to 0.0001 mm, balls count as uncertain by up to 0.002.
constexpr double kMargin_mm = 0.0025;
constexpr double kFloor_mm = -10;

std::unique_ptr<ZMap> make_map(double cell, const char* blank = "box:0,0,-10:24,24,0") {
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell;
  auto map = ZMap::create(options);
  EXPECT_TRUE(map) << map.error();
  return std::move(*map);
}

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

std::vector<CutReport> cut_all(ZMap& map, const Cutter& cutter, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  map.cut(cutter, moves, reports);
  map.finish(reports);
  return reports;
}

/// Level, slanting and vertical lines, and level arcs: shallow, as engravers are led.
CutMove random_move(std::mt19937& random) {
  std::uniform_real_distribution<double> xy(2, 22), z(-0.6, 0.1), part(0, 1);
  const Vec3 from{xy(random), xy(random), z(random)};
  Vec3 to{xy(random), xy(random), part(random) < 0.5 ? from.z : z(random)};
  const double kind = part(random);
  if (kind < 0.2) to = Vec3(from.x, from.y, z(random));
  CutMove move = line(from, to);
  if (kind > 0.8) {
    const Vec3 center(12, 12, from.z);
    const double angle = 0.3 + 2 * part(random);
    const Vec3 arm = from - center;
    move.to_mm = center + Vec3(std::cos(angle) * arm.x - std::sin(angle) * arm.y,
                               std::sin(angle) * arm.x + std::cos(angle) * arm.y, 0);
    move.arc = CutArc{center, Vec3(0, 0, 1), angle};
  }
  return move;
}

/// How deep `probe` goes into what `cut` has left, at points about its axis and under its sides.
double depth_of(const Cutter& cutter, const std::vector<CutMove>& cut, const CutMove& probe) {
  double depth = 0;
  const auto look_at = [&](double x, double y) {
    if (x < 0 || y < 0 || x > 24 || y > 24) return;
    const double bottom = std::max(kFloor_mm, test::sweep_height(cutter, probe, x, y, 8).z);
    if (bottom + depth >= 0) return;
    double material = 0;
    for (const CutMove& move : cut) {
      material = std::min(material, test::sweep_height(cutter, move, x, y, 8).z);
      if (material <= bottom + depth) return;
    }
    depth = material - bottom;
  };
  const double wide = 0.99 * cutter.radius_mm();
  const int rings = wide > 1 ? 8 : 3;
  for (int n = 0; n <= 40; ++n) {
    const Vec3 tip = test::tip_at(probe, n / 40.0);
    look_at(tip.x, tip.y);
    for (int ring = 1; ring <= rings && probe.from_mm != probe.to_mm; ++ring) {
      for (int turn = 0; turn < 8; ++turn) {
        const double angle = (turn + 0.1 * n) * kPi / 4, r = wide * ring / rings;
        look_at(tip.x + r * std::cos(angle), tip.y + r * std::sin(angle));
      }
    }
  }
  return depth;
}

TEST(ContactOracle, NothingIsToldThatDoesNotTouch) {
  std::mt19937 random(41);
  int told = 0, missed = 0, touching = 0;
  for (const char* shape : {"vee:3:30", "vee:6:90", "ball:1", "ball:6", "drill:5:118", "flat:0.3",
                            "taper:0.2:10", "flat:3"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    for (const double cell : {0.5, 0.2}) {
      const auto map = make_map(cell);
      std::vector<CutMove> cut;
      for (int n = 0; n < 8; ++n) cut.push_back(random_move(random));
      cut_all(*map, *cutter, cut);
      for (int n = 0; n < 8; ++n) {
        const CutMove probe = random_move(random);
        const double depth = depth_of(*cutter, cut, probe);
        const auto contact = map->first_contact(*cutter, probe, kTolerance_mm);
        told += contact.has_value();
        touching += depth > kTolerance_mm + kMargin_mm;
        if (contact) {
          EXPECT_GT(depth, kTolerance_mm - kMargin_mm) << n;
          EXPECT_LE(contact->depth_mm, std::max(depth, kTolerance_mm) + kMargin_mm + 0.02) << n;
        } else if (depth > kTolerance_mm + kMargin_mm) {
          ++missed;
        }
      }
    }
  }
  RecordProperty("told", told);
  RecordProperty("touching", touching);
  RecordProperty("missed", missed);
  EXPECT_GT(touching, 50);
  EXPECT_LE(missed, touching / 50) << "of " << touching;
}

TEST(ContactOracle, AnUntouchedTopIsToldExactly) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> xy(4, 20), z(0.002, 0.6);
  for (const char* shape : {"vee:3:30", "ball:1", "ball:6", "drill:5:118", "flat:0.3"}) {
    const auto cutter = parse_shape(shape);
    for (const double cell : {1.0, 0.5, 0.2}) {
      const auto map = make_map(cell);
      for (int n = 0; n < 20; ++n) {
        const double depth = z(random) * (n % 2 ? 1 : 0.04);
        const Vec3 from{xy(random), xy(random), -depth};
        const Vec3 to = n % 3 ? Vec3{xy(random), xy(random), -depth} : from + Vec3(0, 0, 2);
        const auto contact = map->first_contact(*cutter, line(from, to), kTolerance_mm);
        ASSERT_EQ(contact.has_value(), depth > kTolerance_mm) << shape << " " << depth;
        if (contact) {
          EXPECT_NEAR(contact->depth_mm, depth, 1e-6) << shape;
        }
      }
    }
  }
}

TEST(ContactOracle, TheWayBackIsFree) {
  std::mt19937 random(43);
  for (const char* shape : {"vee:3:30", "vee:8:90:0.4", "ball:1", "ball:6", "drill:5:118",
                            "flat:0.3", "flat:3", "taper:0.2:10", "bull:6:1"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    for (const double cell : {1.0, 0.5, 0.1}) {
      const auto map = make_map(cell);
      std::vector<CutMove> moves;
      for (int n = 0; n < 12; ++n) moves.push_back(random_move(random));
      cut_all(*map, *cutter, moves);
      for (CutMove& move : moves) {
        if (move.arc) {
          move.id = 1;
        } else {
          // With the rounding of three decimals.
          std::swap(move.from_mm, move.to_mm);
          move.from_mm = glm::round(move.from_mm * 1e3) / 1e3;
          move.to_mm = glm::round(move.to_mm * 1e3) / 1e3;
        }
        const auto contact = map->first_contact(*cutter, move, kTolerance_mm);
        EXPECT_FALSE(contact) << "cell " << cell << " at " << contact->tip_mm.x << " "
                              << contact->tip_mm.y << " " << contact->tip_mm.z << ", "
                              << contact->depth_mm << " deep, from " << move.from_mm.x << " "
                              << move.from_mm.y << " " << move.from_mm.z << " to " << move.to_mm.x
                              << " " << move.to_mm.y << " " << move.to_mm.z;
        EXPECT_FALSE(map->snapshot()->first_contact(*cutter, move, kTolerance_mm));
      }
    }
  }
}

TEST(ContactOracle, TheGreatestDepthIsThatOfTheTip) {
  for (const char* shape : {"vee:3:30", "ball:1", "ball:6", "drill:5:118", "flat:0.3"}) {
    const auto cutter = parse_shape(shape);
    for (const double cell : {1.0, 0.5, 0.2}) {
      const auto map = make_map(cell);
      const auto reports = cut_all(*map, *cutter,
                                   {line(Vec3(7.03, 7.11, 2), Vec3(7.03, 7.11, -1.5)),
                                    line(Vec3(7.03, 7.11, -1.5), Vec3(7.03, 7.11, -1.2)),
                                    line(Vec3(7.03, 7.11, -1.2), Vec3(7.03, 7.11, -3.5)),
                                    line(Vec3(7.03, 7.11, -3.5), Vec3(7.03, 7.11, 5))});
      ASSERT_EQ(reports.size(), 4u);
      EXPECT_NEAR(reports[0].depth_mm, 1.5, 0.002) << shape << cell;
      EXPECT_NEAR(reports[1].depth_mm, 0, 1e-6) << shape << cell;
      EXPECT_NEAR(reports[2].depth_mm, 2.0, 0.002) << shape << cell;
    }
  }
}

/// Of a tube about (12, 12): its side of radius 11, or its bore of 5; into it by `in` under
/// `angle`.
CutMove toward_side(bool bore, double radius, double angle, double in, double z) {
  const Vec3 way(std::cos(angle), std::sin(angle), 0);
  const Vec3 middle(12, 12, z);
  const double off = bore ? 5 - radius + in : 11 + radius - in;
  return line(middle + (bore ? 0.0 : 11 + 3 * radius) * way, middle + off * way);
}

TEST(RoundSides, AreToldFromTheToleranceOn) {
  std::mt19937 random(4);
  // Not where the side is also that of the grid: there a cell counts as material in full.
  std::uniform_real_distribution<double> angle(0.6, 0.97);
  for (const double cell : {0.1, 0.37, 1.0}) {
    const auto map = make_map(cell, "tube:12,12,-10:0:22:10");
    for (const double radius : {0.25, 1.5, 3.0}) {
      const auto cutter = parse_shape(fmt::format("flat:{}", 2 * radius));
      for (int n = 0; n < 60; ++n) {
        const bool bore = n % 2 == 0;
        const double at = angle(random) + n / 2 % 4 * kPi / 2;
        const auto touch = [&](double in) {
          return map->first_contact(*cutter, toward_side(bore, radius, at, in, -2), kTolerance_mm);
        };
        ASSERT_TRUE(touch(0.0105)) << cell << " " << radius << " " << at;
        EXPECT_NEAR(touch(0.0105)->depth_mm, 2, 1e-4);
        ASSERT_FALSE(touch(0.0095)) << cell << " " << radius << " " << at;
      }
    }
  }
}

TEST(RoundSides, TheWayBackIsFree) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> xy(-3, 27), z(-3, 0.5), part(0, 1);
  int touched = 0;
  for (const char* spec : {"flat:3", "flat:0.4", "ball:2", "vee:4:60", "drill:3:118"}) {
    const auto cutter = parse_shape(spec);
    for (const double cell : {0.3, 1.0}) {
      const auto map = make_map(cell, "tube:12,12,-10:0:22:10");
      for (int n = 0; n < 60; ++n) {
        CutMove move = line(Vec3{xy(random), xy(random), z(random)}, Vec3(0));
        move.to_mm = Vec3{xy(random), xy(random), part(random) < 0.5 ? move.from_mm.z : z(random)};
        touched += map->first_contact(*cutter, move, kTolerance_mm) ? 1 : 0;
        cut_all(*map, *cutter, {move});
        const CutMove back = line(move.to_mm, move.from_mm);
        ASSERT_FALSE(map->first_contact(*cutter, move, kTolerance_mm)) << spec << " " << n;
        ASSERT_FALSE(map->first_contact(*cutter, back, kTolerance_mm)) << spec << " " << n;
      }
    }
  }
  EXPECT_GT(touched, 100);
}

/// A whole move and its halves: the same up to the rounding of where it is halved.
TEST(Halves, LeaveWhatTheWholeLeaves) {
  std::mt19937 random(44);
  std::uniform_real_distribution<double> part(0.01, 0.99);
  for (const char* shape : {"flat:6", "ball:6", "bull:6:1", "vee:6:60"}) {
    const auto cutter = parse_shape(shape);
    const auto whole = make_map(0.1), halves = make_map(0.1);
    std::vector<CutMove> moves, divided;
    for (int n = 0; n < 60; ++n) {
      CutMove move = random_move(random);
      move.arc.reset();
      moves.push_back(move);
      const Vec3 middle = move.from_mm + part(random) * (move.to_mm - move.from_mm);
      divided.push_back(line(move.from_mm, middle));
      divided.push_back(line(middle, move.to_mm));
    }
    cut_all(*whole, *cutter, moves);
    cut_all(*halves, *cutter, divided);
    const double removed = whole->blank_mm3() - whole->remaining_mm3();
    EXPECT_NEAR(halves->remaining_mm3(), whole->remaining_mm3(), 1e-5 * removed) << shape;
    int walls = 0;
    for (int j = 0; j < whole->ny(); ++j) {
      for (int i = 0; i < whole->nx(); ++i)
        walls += std::abs(whole->height_mm(i, j) - halves->height_mm(i, j)) > 1e-4f;
    }
    EXPECT_EQ(walls, 0) << shape;
  }
}

}  // namespace
}  // namespace kerf
