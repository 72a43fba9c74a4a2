// The Z-map as a model: volumes in closed form, same bits for any threads, kernel and batching,
// snapshots, contact.
#include "stock/zmap/zmap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/path_builder.h"
#include "tests/stock/stock_samples.h"
#include "tests/stock/sweep_oracle.h"

namespace kerf {
namespace {

std::unique_ptr<ZMap> make_map(const std::string& blank, double cell, int threads = 1,
                               ZMapKernel kernel = ZMapKernel::kAuto) {
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell;
  options.threads = threads;
  options.kernel = kernel;
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

std::vector<CutReport> cut_all(ZMap& map, const Cutter& cutter, const std::vector<CutMove>& moves,
                               std::size_t batch = 0) {
  std::vector<CutReport> reports;
  if (batch == 0) batch = std::max<std::size_t>(1, moves.size());
  for (std::size_t i = 0; i < moves.size(); i += batch)
    map.cut(cutter, std::span(moves).subspan(i, std::min(batch, moves.size() - i)), reports);
  map.finish(reports);
  return reports;
}

/// A program of every kind of move: short joined segments, corners, plunges, arcs, helices.
std::vector<CutMove> mixed_moves(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<CutMove> moves;
  Vec3 at(20, 20, 1);
  double heading = 0;
  for (int i = 0; i < count; ++i) {
    CutMove move;
    move.id = static_cast<std::uint64_t>(i);
    move.from_mm = at;
    if (i % 23 == 5) {
      const double r = 1 + 2 * std::abs(unit(random));
      const Vec3 center = at + Vec3(r * std::cos(heading + 1.5), r * std::sin(heading + 1.5), 0);
      const double sweep = 4 * unit(random), dz = i % 2 == 0 ? 0.0 : -0.5;
      const Vec3 arm = at - center;
      move.to_mm = center + Vec3(arm.x * std::cos(sweep) - arm.y * std::sin(sweep),
                                 arm.x * std::sin(sweep) + arm.y * std::cos(sweep), dz);
      move.arc = CutArc{center, Vec3(0, 0, 1), sweep};
    } else if (i % 31 == 7) {
      move.to_mm = at + Vec3(0, 0, unit(random));
    } else {
      heading += i % 17 == 0 ? 2 * unit(random) : 0.2 * unit(random);
      const double step = i % 11 == 0 ? 6.0 : 0.3;
      move.to_mm =
          at + Vec3(step * std::cos(heading), step * std::sin(heading), 0.1 * unit(random));
    }
    if (move.to_mm.x < 2 || move.to_mm.x > 38 || move.to_mm.y < 2 || move.to_mm.y > 38 ||
        move.to_mm.z < -9 || move.to_mm.z > 1) {
      move.arc.reset();
      move.to_mm = Vec3{20 + 5 * unit(random), 20 + 5 * unit(random), -2 + unit(random)};
    }
    at = move.to_mm;
    moves.push_back(move);
  }
  return moves;
}

double worst_difference(const ZMap& a, const ZMap& b) {
  const std::vector<float> x = a.heights_mm(), y = b.heights_mm();
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(worst, static_cast<double>(std::abs(x[i] - y[i])));
  return worst;
}

// --- volumes ---

struct VolumeCase {
  const char* name;
  const char* shape;
  CutMove move;
  double volume_mm3;
  double rim_mm;    ///< length of vertical wall, mm
  double depth_mm;  ///< its height
};

std::vector<VolumeCase> volume_cases() {
  const double r = 5, length = 40, depth = 4;
  // Off the grid lines, so that no accident of symmetry helps.
  const Vec3 a(20.123, 25.456, -depth), b = a + Vec3(length * 0.8, length * 0.6, 0);
  CutMove circle = line(Vec3(42.3, 30.7, -depth), Vec3(42.3, 30.7, -depth));
  circle.arc = CutArc{Vec3(30.3, 30.7, -depth), Vec3(0, 0, 1), 2 * kPi};
  const double half_angle = 30 * kPi / 180, cone_depth = 6,
               cone_r = cone_depth * std::tan(half_angle);
  return {
      {"slot", "flat:10", line(a, b), (kPi * r * r + 2 * r * length) * depth,
       2 * kPi * r + 2 * length, depth},
      {"hole", "flat:10", line(a + Vec3(0, 0, 9), a), kPi * r * r * depth, 2 * kPi * r, depth},
      {"ring", "flat:10", circle, kPi * (17 * 17 - 7 * 7) * depth, 2 * kPi * 24, depth},
      // Ball as deep as its radius: half a capsule.
      {"capsule", "ball:10", line(a - Vec3(0, 0, 1), b - Vec3(0, 0, 1)),
       // Its rim is vertical only at the very top: as a wall of the height a ball rises within a
       // cell.
       kPi * r * r / 2 * length + 2.0 / 3 * kPi * r * r * r, 2 * kPi * r + 2 * length, 0.5},
      {"cone", "vee:12:60", line(Vec3(30.1, 29.8, 2), Vec3(30.1, 29.8, -cone_depth)),
       kPi / 3 * cone_r * cone_r * cone_depth, 0, 0},
  };
}

TEST(ZMapVolume, ApproachesTheClosedFormAsCellsShrink) {
  for (const VolumeCase& c : volume_cases()) {
    SCOPED_TRACE(c.name);
    const auto cutter = parse_shape(c.shape);
    double coarse = 0;
    for (const double cell : {0.4, 0.2, 0.1}) {
      const auto map = make_map("box:0,0,-20:60,60,0", cell);
      const auto reports = cut_all(*map, *cutter, {c.move});
      ASSERT_EQ(reports.size(), 1u);
      const double removed = map->blank_mm3() - map->remaining_mm3();
      // The report counts by cells, in steps of 1/8192 mm a cell.
      const double by_cells = map->blank_mm3() - test::volume_by_cells(*map);
      EXPECT_NEAR(reports[0].removed_mm3, by_cells, 1e-4 * by_cells);
      const double error = std::abs(by_cells - c.volume_mm3);
      // A vertical wall is misplaced by at most half a cell, to either side at random along it: the
      // error of a whole rim is of order depth * cell^1.5 * sqrt(rim). Smooth surfaces lose with
      // the square of the cell.
      const double bound = 2 * c.depth_mm * cell * std::sqrt(cell * c.rim_mm) + 6 * cell * cell;
      EXPECT_LE(error, bound) << "cell " << cell;
      EXPECT_LE(std::abs(removed - c.volume_mm3), bound) << "by its walls, cell " << cell;
      if (cell == 0.4) coarse = bound;
      if (cell == 0.1) {
        EXPECT_LE(error, coarse / 5) << "does not shrink";
      }
    }
  }
}

TEST(ZMapVolume, APocketIsTheUnionOfItsPasses) {
  const auto cutter = parse_shape("flat:6");
  std::vector<CutMove> moves;
  Vec3 at(10, 10, -2);
  for (int pass = 0; pass <= 8; ++pass) {
    const Vec3 start(pass % 2 == 0 ? 10 : 40, 10 + 2.5 * pass, -2),
        end(pass % 2 == 0 ? 40 : 10, 10 + 2.5 * pass, -2);
    if (pass > 0) moves.push_back(line(at, start));
    moves.push_back(line(start, end));
    at = end;
  }
  const auto map = make_map("box:0,0,-10:50,50,0", 0.1);
  double reported = 0;
  for (const CutReport& report : cut_all(*map, *cutter, moves)) reported += report.removed_mm3;
  // 36 x 26 rectangle with corners of radius 3, but for the cusps between the passes at both ends.
  const double corners = (4 - kPi) * 9;
  const double cusp =
      2 * (3 * 1.25 - (0.5 * 1.25 * std::sqrt(9 - 1.25 * 1.25) + 4.5 * std::asin(1.25 / 3)));
  double cusps = 0;
  for (int pass = 0; pass < 8; ++pass)
    cusps += cusp;  // at one end each: the other has the link between passes
  EXPECT_NEAR(reported, 2 * (36 * 26 - corners - cusps), 4.0);
  EXPECT_NEAR(reported, map->blank_mm3() - map->remaining_mm3(), 0.2);
}

// --- the same bits ---

TEST(ZMapBits, DoNotDependOnThreadsKernelOrBatching) {
  for (const char* shape : {"ball:6", "flat:5", "bull:6:1", "vee:6:60", "taper:2:5"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    const std::vector<CutMove> moves = mixed_moves(11, 400);
    const std::string blank = "box:0,0,-10:40,40,0";
    const auto reference = make_map(blank, 0.1, 1, ZMapKernel::kScalar);
    const auto reference_reports = cut_all(*reference, *cutter, moves);
    ASSERT_EQ(reference_reports.size(), moves.size());
    EXPECT_LT(reference->remaining_mm3(), 0.95 * reference->blank_mm3());
    for (const ZMapKernel kernel : zmap_kernels()) {
      SCOPED_TRACE(to_string(kernel));
      for (const int threads : {1, 2, 3, 7}) {
        for (const std::size_t batch : {std::size_t{0}, std::size_t{1}, std::size_t{13}}) {
          if (kernel != zmap_kernels().front() && threads > 2) continue;
          const auto map = make_map(blank, 0.1, threads, kernel);
          const auto reports = cut_all(*map, *cutter, moves, batch);
          EXPECT_EQ(map->digest(), reference->digest()) << threads << " threads, batch " << batch;
          ASSERT_EQ(reports.size(), moves.size());
          for (std::size_t i = 0; i < reports.size(); ++i) {
            ASSERT_EQ(reports[i].id, i);
            ASSERT_EQ(reports[i].removed_mm3, reference_reports[i].removed_mm3) << i;
            ASSERT_EQ(reports[i].depth_mm, reference_reports[i].depth_mm) << i;
          }
        }
      }
    }
  }
}

/// Along X, where a row of cells has its roots but once, beside moves that turn a little, and
/// steep.
TEST(ZMapBits, OfRastersDoNotDependOnTheKernel) {
  for (const char* shape : {"ball:6", "flat:5", "bull:6:1"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    std::vector<CutMove> moves;
    for (const double tilt : {0.0, 1e-9, 0.02}) {
      Vec3 at(-2, 3 + 300 * tilt, -4);
      for (int n = 0; n < 150; ++n) {
        const double along = n % 2 == 0 ? 0.31 : 2.7;
        const Vec3 to = at + Vec3(along / 5, tilt * along, 0.3 * std::sin(0.4 * n) * along / 5);
        moves.push_back(line(at, to));
        at = to;
      }
    }
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i].id = i;
    const auto reference = make_map("box:0,0,-10:40,40,0", 0.1, 1, ZMapKernel::kScalar);
    const auto expected = cut_all(*reference, *cutter, moves);
    EXPECT_LT(reference->remaining_mm3(), 0.99 * reference->blank_mm3());
    for (const ZMapKernel kernel : zmap_kernels()) {
      SCOPED_TRACE(to_string(kernel));
      const auto map = make_map("box:0,0,-10:40,40,0", 0.1, 1, kernel);
      const auto reports = cut_all(*map, *cutter, moves, 7);
      EXPECT_EQ(map->digest(), reference->digest());
      ASSERT_EQ(reports.size(), expected.size());
      for (std::size_t i = 0; i < reports.size(); ++i)
        ASSERT_EQ(reports[i].removed_mm3, expected[i].removed_mm3) << i;
    }
  }
}

TEST(ZMapKernels, AutoIsTheFirstOfThoseThatTheMachineRuns) {
  const std::vector<ZMapKernel> kernels = zmap_kernels();
  EXPECT_EQ(kernels.back(), ZMapKernel::kScalar);
  EXPECT_TRUE(zmap_can_run(ZMapKernel::kAuto));
  std::string names;
  for (const ZMapKernel kernel : kernels) {
    EXPECT_TRUE(zmap_can_run(kernel));
    names += (names.empty() ? "" : ",") + std::string(to_string(kernel));
  }
  if (const char* const expected = std::getenv("KERF_KERNELS_EXPECTED"); expected != nullptr) {
    EXPECT_EQ(names, expected);
    return;
  }
#if defined(__x86_64__)
  EXPECT_EQ(names, __builtin_cpu_supports("avx2") ? "avx2,sse2,scalar" : "sse2,scalar");
  EXPECT_FALSE(zmap_can_run(ZMapKernel::kNeon));
#elif defined(__aarch64__)
  EXPECT_EQ(names, "neon,scalar");
  EXPECT_FALSE(zmap_can_run(ZMapKernel::kSse2));
  EXPECT_FALSE(zmap_can_run(ZMapKernel::kAvx2));
#endif
}

TEST(ZMapBits, AskingInTheMiddleChangesNothing) {
  const auto cutter = parse_shape("ball:6");
  const std::vector<CutMove> moves = mixed_moves(3, 300);
  const auto quiet = make_map("box:0,0,-10:40,40,0", 0.2);
  cut_all(*quiet, *cutter, moves);
  const auto asked = make_map("box:0,0,-10:40,40,0", 0.2);
  std::vector<CutReport> reports;
  for (const CutMove& move : moves) {
    asked->cut(*cutter, std::span(&move, 1), reports);
    const auto now = asked->snapshot();
    EXPECT_LE(now->remaining_mm3(), asked->remaining_mm3());
  }
  asked->finish(reports);
  EXPECT_EQ(asked->digest(), quiet->digest());
}

TEST(ZMapBits, TheDigestTellsWorkpiecesApart) {
  const auto cutter = parse_shape("ball:6");
  const auto a = make_map("box:0,0,-10:40,40,0", 0.2), b = make_map("box:0,0,-10:40,40,0", 0.2);
  EXPECT_EQ(a->digest(), b->digest());
  EXPECT_EQ(a->digest().size(), 32u);
  cut_all(*a, *cutter, {line(Vec3(20, 20, 1), Vec3(20, 20, -0.01))});
  EXPECT_NE(a->digest(), b->digest());
  EXPECT_NE(make_map("box:0,0,-10:40,40,0", 0.25)->digest(), b->digest());
  EXPECT_NE(make_map("box:1,0,-10:41,40,0", 0.2)->digest(), b->digest());
}

// --- what must not matter ---

TEST(ZMapMetamorphic, CuttingTwiceRemovesNothingMore) {
  const auto cutter = parse_shape("bull:6:1");
  const std::vector<CutMove> moves = mixed_moves(5, 200);
  const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
  cut_all(*map, *cutter, moves);
  const std::string once = map->digest();
  for (const CutReport& report : cut_all(*map, *cutter, moves)) EXPECT_EQ(report.removed_mm3, 0);
  EXPECT_EQ(map->digest(), once);
}

TEST(ZMapMetamorphic, TheOrderOfMovesDoesNotMatter) {
  const auto cutter = parse_shape("ball:6");
  std::vector<CutMove> moves = mixed_moves(8, 200);
  const auto forward = make_map("box:0,0,-10:40,40,0", 0.1),
             shuffled = make_map("box:0,0,-10:40,40,0", 0.1);
  cut_all(*forward, *cutter, moves);
  std::shuffle(moves.begin(), moves.end(), std::mt19937(1));
  cut_all(*shuffled, *cutter, moves);
  EXPECT_LE(worst_difference(*forward, *shuffled), 1e-4);
}

TEST(ZMapMetamorphic, SplittingAMoveChangesNothing) {
  for (const char* shape : {"ball:6", "flat:6", "bull:6:1", "drill:6:118"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    const Vec3 a(5.1, 7.3, -1), b(33.7, 29.9, -4.4);
    const auto whole = make_map("box:0,0,-10:40,40,0", 0.1),
               split = make_map("box:0,0,-10:40,40,0", 0.1);
    cut_all(*whole, *cutter, {line(a, b)});
    std::vector<CutMove> parts;
    for (int i = 0; i < 64; ++i)
      parts.push_back(line(a + i / 64.0 * (b - a), a + (i + 1) / 64.0 * (b - a)));
    cut_all(*split, *cutter, parts);
    EXPECT_LE(worst_difference(*whole, *split), 1e-4);
  }
}

TEST(ZMapMetamorphic, TurningTheJobTurnsTheResult) {
  const auto cutter = parse_shape("ball:6");
  const std::vector<CutMove> moves = mixed_moves(21, 200);
  std::vector<CutMove> turned = moves;  // by 90 degrees about the middle of the blank
  const auto turn = [](const Vec3& p) { return Vec3(40 - p.y, p.x, p.z); };
  for (CutMove& move : turned) {
    move.from_mm = turn(move.from_mm);
    move.to_mm = turn(move.to_mm);
    if (move.arc) move.arc->center_mm = turn(move.arc->center_mm);
  }
  const auto straight = make_map("box:0,0,-10:40,40,0", 0.1),
             rotated = make_map("box:0,0,-10:40,40,0", 0.1);
  cut_all(*straight, *cutter, moves);
  cut_all(*rotated, *cutter, turned);
  int walls = 0;
  for (int j = 0; j < 400; ++j)
    for (int i = 0; i < 400; ++i)
      walls += std::abs(straight->height_mm(i, j) - rotated->height_mm(399 - j, i)) > 1e-4f;
  EXPECT_EQ(walls, 0);
}

// --- reports, floor, blanks ---

TEST(ZMapReport, SaysWhatEachMoveRemovedAndHowDeep) {
  const auto cutter = parse_shape("flat:10");
  const auto map = make_map("box:0,0,-20:100,100,0", 0.1);
  const std::vector<CutMove> moves{
      line(Vec3(50, 50, 5), Vec3(50, 50, -3)), line(Vec3(50, 50, -3), Vec3(50, 50, 5)),
      line(Vec3(50, 50, 5), Vec3(80, 50, 5)), line(Vec3(80, 50, 5), Vec3(80, 50, -3)),
      line(Vec3(80, 50, -3), Vec3(50, 50, -3))};
  const auto reports = cut_all(*map, *cutter, moves);
  EXPECT_NEAR(reports[0].removed_mm3, kPi * 25 * 3, 2);
  EXPECT_NEAR(reports[0].depth_mm, 3, 1e-6);
  for (const int i : {1, 2}) EXPECT_EQ(reports[static_cast<std::size_t>(i)].removed_mm3, 0);
  EXPECT_EQ(reports[1].depth_mm, 0);
  EXPECT_NEAR(reports[3].removed_mm3, kPi * 25 * 3, 2);
  EXPECT_NEAR(reports[4].removed_mm3, (30 * 10 - kPi * 25) * 3, 4);
}

TEST(ZMapFloor, NothingIsCutBelowIt) {
  const auto cutter = parse_shape("flat:10");
  const auto map = make_map("box:0,0,-5:40,40,0", 0.2);
  const auto reports = cut_all(*map, *cutter, {line(Vec3(20, 20, 1), Vec3(20, 20, -50))});
  EXPECT_EQ(map->height_mm(100, 100), -5.0f);
  EXPECT_NEAR(reports[0].removed_mm3, kPi * 25 * 5, 4);
  EXPECT_EQ(reports[0].depth_mm, 5);
}

TEST(ZMapBlank, RoundAndSeveralBodies) {
  const auto round = make_map("cylinder:10,20,-8:2:30", 0.1);
  EXPECT_NEAR(round->blank_mm3(), kPi * 225 * 10, 0.001 * kPi * 225 * 10);
  const auto tube = make_map("tube:10,20,-8:2:30:12", 0.1);
  EXPECT_NEAR(tube->blank_mm3(), kPi * (225 - 36) * 10, 0.002 * kPi * 225 * 10);
  EXPECT_EQ(tube->height_mm(150, 150), -8.0f);
  const auto steps = make_map("box:0,0,-5:10,10,0+box:10,0,-5:20,10,3", 0.1);
  EXPECT_NEAR(steps->blank_mm3(), 500 + 800, 1e-3);
}

TEST(ZMapBlank, UnevenCellsFillItExactly) {
  const auto map = make_map("box:0,0,-5:10.05,7.77,0", 0.1);
  EXPECT_EQ(map->nx(), 101);
  EXPECT_EQ(map->ny(), 78);
  EXPECT_NEAR(map->blank_mm3(), 10.05 * 7.77 * 5, 1e-6);
  const auto cutter = parse_shape("ball:4");
  const CutMove move = line(Vec3(2, 2, -1), Vec3(8, 5, -2));
  cut_all(*map, *cutter, {move});
  for (int j = 0; j < 78; j += 7) {
    for (int i = 0; i < 101; i += 7) {
      const test::OracleHeight h =
          test::sweep_height(*cutter, move, (i + 0.5) * 10.05 / 101, (j + 0.5) * 7.77 / 78, 40);
      if (h.edge_distance > 1e-6) {
        EXPECT_NEAR(map->height_mm(i, j), std::min(0.0, h.z), 1e-4);
      }
    }
  }
}

TEST(ZMapCreate, RefusesWithTheNumberFoundAndWhatIsAllowed) {
  const auto fault = [](const char* blank, double cell) {
    ZMapOptions options;
    options.blank = *parse_blank(blank);
    options.cell_mm = cell;
    const auto map = ZMap::create(options);
    return map ? std::string("no fault") : map.error();
  };
  EXPECT_EQ(fault("box:0,0,-5:10,20,0", 0), "cell size 0 mm is not allowed; must be above 0");
  EXPECT_EQ(fault("box:0,0,-5:10,20,0", std::nan("")),
            "cell size nan mm is not allowed; must be above 0");
  EXPECT_EQ(fault("box:0,0,-5:10,20,0", 11),
            "cell size 11 mm exceeds the blank, which is 10 x 20 mm; 0.05 to 0.2 mm "
            "suits most parts");
  EXPECT_EQ(fault("box:0,0,-5:1000,2000,0", 0.005),
            "cell size 0.005 mm makes 200000 x 400000 cells and would take 320.0 GB of memory; at "
            "most 4.3 GB are allowed");
  EXPECT_EQ(fault("cylinder:0,0,0:50:10:x", 0.1),
            "a Z-map cannot hold a cylinder along x; its axis must be z");
  EXPECT_EQ(fault("box:0,0,-5:10,10,0+box:0,0,2:5,5,4", 0.1),
            "a Z-map cannot hold a body that begins at Z2 above the blank's floor Z-5");
}

TEST(ZMapCutter, RefusesUndercutsAndHollowBottoms) {
  EXPECT_TRUE(ZMap::can_cut(*parse_shape("bull:6:1")));
  EXPECT_EQ(ZMap::can_cut(*parse_shape("lollipop:8:4")).error(),
            "lollipop:8:4 cuts below itself (its neck is thinner than its head); a Z-map cannot "
            "hold undercuts");
  ProfilePiece down, rim;
  down.z0 = 1, down.r1 = 4;
  rim.r0 = 4, rim.r1 = 5;
  const auto hollow = Cutter::from_profile("profile:cup", {down, rim});
  ASSERT_TRUE(hollow) << hollow.error();
  EXPECT_EQ(ZMap::can_cut(*hollow).error(),
            "profile:cup has a hollow bottom (its profile falls from radius 0 outward); a Z-map "
            "cannot cut with it");
}

TEST(ZMapCutter, StepsAndHollowFlanksAreCutAsTheyAre) {
  // A step drill with a quarter-round hollow flank: flat to 2, up 3, flat to 3, hollow arc to
  // radius 5.
  ProfilePiece tip, wall, shoulder, flank;
  tip.r1 = 2;
  wall.r0 = wall.r1 = 2, wall.z1 = 3;
  shoulder.r0 = 2, shoulder.z0 = 3, shoulder.r1 = 3, shoulder.z1 = 3;
  flank.kind = ProfilePiece::Kind::kArc, flank.convex = false;
  flank.r0 = 3, flank.z0 = 3, flank.r1 = 5, flank.z1 = 5, flank.center_r = 5, flank.center_z = 3,
  flank.radius = 2;
  const auto cutter = Cutter::from_profile("profile:step", {tip, wall, shoulder, flank});
  ASSERT_TRUE(cutter) << cutter.error();
  for (const CutMove& move :
       {line(Vec3(8, 9, -7), Vec3(13, 11, -7)), line(Vec3(8, 9, -7), Vec3(13, 11, -8.5))}) {
    const auto map = make_map("box:0,0,-12:20,20,0", 0.2);
    cut_all(*map, *cutter, {move});
    for (int j = 0; j < 100; j += 3) {
      for (int i = 0; i < 100; i += 3) {
        const double x = (i + 0.5) * 0.2, y = (j + 0.5) * 0.2;
        const test::OracleHeight h = test::sweep_height(*cutter, move, x, y, 2000);
        // Near the walls of the step and the flank's vertical start the oracle's search is not
        // sharp.
        const double z = std::min(0.0, h.z), got = map->height_mm(i, j);
        if (h.edge_distance > 1e-3 && std::abs(got - z) > 0.002) {
          const auto around = [&](double dx, double dy) {
            return std::min(0.0, test::sweep_height(*cutter, move, x + dx, y + dy, 2000).z);
          };
          const auto [low, high] = std::minmax(
              {around(0.004, 0), around(-0.004, 0), around(0, 0.004), around(0, -0.004), z});
          EXPECT_TRUE(got >= low - 0.002 && got <= high + 0.002)
              << x << " " << y << ": " << got << " oracle " << z;
        }
      }
    }
  }
}

// --- snapshots and contact ---

TEST(ZMapSnapshot, KeepsWhatWasThere) {
  const auto cutter = parse_shape("flat:6");
  const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
  cut_all(*map, *cutter, {line(Vec3(10, 10, -1), Vec3(30, 10, -1))});
  const auto before = map->snapshot();
  const std::string digest = map->digest();
  cut_all(*map, *cutter, {line(Vec3(10, 30, -5), Vec3(30, 10, -5))});
  EXPECT_EQ(before->digest(), digest);
  EXPECT_NE(map->digest(), digest);
  std::vector<CutReport> reports;
  const CutMove again = line(Vec3(10, 30, -5), Vec3(30, 10, -5));
  before->cut(*cutter, std::span(&again, 1), reports);
  before->finish(reports);
  EXPECT_EQ(before->digest(), map->digest());
}

TEST(ZMapContact, FindsWhereAndHowDeep) {
  const auto cutter = parse_shape("flat:6");
  const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
  const auto hit = map->first_contact(*cutter, line(Vec3(-20, 20, -2), Vec3(60, 20, -2)), 0.01);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->tip_mm.x, -3 + 0.01, 1e-6);  // the tolerance, wherever the cells' middles are
  EXPECT_NEAR(hit->depth_mm, 2, 1e-5);
  EXPECT_FALSE(map->first_contact(*cutter, line(Vec3(-20, 20, 0), Vec3(60, 20, 0)), 0.01));
  EXPECT_FALSE(map->first_contact(*cutter, line(Vec3(-20, 50, -2), Vec3(60, 50, -2)), 0.01));
  const auto plunge = map->first_contact(*cutter, line(Vec3(20, 20, 5), Vec3(20, 20, -3)), 0.01);
  ASSERT_TRUE(plunge);
  EXPECT_NEAR(plunge->tip_mm.z, -0.01, 1e-6);
  EXPECT_NEAR(plunge->depth_mm, 3, 1e-5);
  CutMove arc = line(Vec3(-10, 20, -1), Vec3(20, -10, -1));
  arc.arc = CutArc{Vec3(20, 20, -1), Vec3(0, 0, 1), kPi / 2};
  EXPECT_FALSE(map->first_contact(*cutter, arc, 0.01)->depth_mm < 0.99);
}

TEST(ZMapContact, APathJustCutIsFree) {
  for (const char* shape : {"flat:6", "ball:6", "bull:6:1", "taper:2:5"}) {
    SCOPED_TRACE(shape);
    const auto cutter = parse_shape(shape);
    const auto map = make_map("box:0,0,-10:40,40,0", 0.1);
    std::vector<CutMove> moves = mixed_moves(33, 150);
    cut_all(*map, *cutter, moves);
    for (CutMove& move : moves) {
      if (move.arc) continue;
      // Back along it, with the rounding of four decimals.
      std::swap(move.from_mm, move.to_mm);
      move.from_mm = glm::round(move.from_mm * 1e4) / 1e4;
      move.to_mm = glm::round(move.to_mm * 1e4) / 1e4;
      EXPECT_FALSE(map->first_contact(*cutter, move, 0.01));
    }
  }
}

TEST(ZMapContact, RequiresNoMoreThanTheSweepOfAThinnerTool) {
  // Against brute force: contact exactly where the shrunk sweep reaches below the material.
  const auto cutter = parse_shape("ball:6");
  const auto map = make_map("box:0,0,-10:40,40,0", 0.2);
  cut_all(*map, *cutter, mixed_moves(12, 150));
  std::mt19937 random(9);
  std::uniform_real_distribution<double> xy(3, 37), z(-5, 1);
  int touching = 0;
  for (int round = 0; round < 20; ++round) {
    const CutMove move =
        line(Vec3{xy(random), xy(random), z(random)}, Vec3{xy(random), xy(random), z(random)});
    double depth = 0;
    for (int j = 0; j < map->ny(); ++j) {
      for (int i = 0; i < map->nx(); ++i) {
        const double x = (i + 0.5) * 0.2, y = (j + 0.5) * 0.2;
        const double bottom = std::max(-10.0, test::sweep_height(*cutter, move, x, y, 16).z);
        depth = std::max(depth, static_cast<double>(map->height_mm(i, j)) - bottom);
      }
    }
    const auto contact = map->first_contact(*cutter, move, 0.01);
    if (depth > 0.5) {
      ASSERT_TRUE(contact) << round;
      ++touching;
    }
    if (contact) {
      EXPECT_GT(depth, 0.005);
      EXPECT_LE(contact->depth_mm, depth + 0.02);
    }
  }
  EXPECT_GT(touching, 8);
}

}  // namespace
}  // namespace kerf
