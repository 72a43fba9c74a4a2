// The octree as a StockModel: sharing, ids, contact, limits, adding material.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "stock/octree/sweep_kernel.h"
#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

/// Every `turn_each`th of them turns the spindle; 0: none.
std::vector<CutMove> wandering_moves(int count, unsigned seed, int turn_each = 3) {
  std::mt19937 engine(seed);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  std::vector<CutMove> moves;
  Vec3 at{2, 2, 1};
  Vec3 axis{0, 0, 1};
  for (int i = 0; i < count; ++i) {
    CutMove move = line(at, {random(0, 30), random(0, 30), random(-6, 1)},
                        static_cast<std::uint64_t>(i) + 1, axis);
    if (turn_each > 0 && i % turn_each == 0)
      move.axis_to = glm::normalize(Vec3(random(-.4, .4), random(-.4, .4), 1));
    axis = move.axis_to;
    at = move.to_mm;
    moves.push_back(move);
  }
  return moves;
}

const std::string kBlank = "box:0,0,-8:30,30,0";

TEST(OctreeModel, BatchesAndThreadsGiveTheSameBits) {
  const std::vector<CutMove> moves = wandering_moves(40, 5);
  const Cutter cutter = make_cutter("bull:5:1");
  const auto all = make_octree(kBlank, 0.5), single = make_octree(kBlank, 0.5, 3);
  const std::vector<CutReport> reports = cut(*all, cutter, moves);
  std::vector<CutReport> one_by_one;
  for (const CutMove& move : moves) single->cut(cutter, {&move, 1}, one_by_one);
  EXPECT_EQ(all->digest(), single->digest());
  EXPECT_EQ(all->remaining_mm3(), single->remaining_mm3());
  ASSERT_EQ(reports.size(), one_by_one.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].id, one_by_one[i].id);
    EXPECT_EQ(reports[i].removed_mm3, one_by_one[i].removed_mm3);
    EXPECT_EQ(reports[i].depth_mm, one_by_one[i].depth_mm);
  }
  EXPECT_NEAR(removed_mm3(reports), all->blank_mm3() - all->remaining_mm3(), 1e-6);
}

TEST(OctreeModel, KernelsGiveTheSameBits) {
  if (!octree::has_avx2()) GTEST_SKIP() << "no AVX2 here";
  using namespace octree;
  const SweepKernel a = scalar_kernel(), b = avx2_kernel();
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> place(-8, 8);
  for (const char* shape : {"flat:4", "ball:5", "bull:6:1.5", "taper:2:10:0.6", "lollipop:5:2"}) {
    const auto bodies = tool_bodies(make_cutter(shape));
    for (int n = 0; n < 12; ++n) {
      CutMove move =
          line({place(engine), 0, 0}, {1, place(engine), n % 4 == 0 ? 0 : place(engine)});
      if (n % 3 == 1 && n % 5 != 2) move.axis_to = glm::normalize(Vec3(0.01, 0.004, 1));
      if (n % 5 == 2) {
        move.to_mm = move.from_mm;
        move.arc = CutArc{{0, 0, 0}, {0, 0, 1}, 2.5};
      }
      std::vector<Sweep> sweeps;
      const Box everywhere{Vec3(-50), Vec3(50)};
      append_sweeps(*bodies, move, 0, {everywhere, 0.01, 0}, sweeps);
      alignas(64) double p[3][24], f[2][4][24];
      for (auto& axis : p)
        for (double& value : axis) value = place(engine);
      a.gradient(sweeps[0], 24, p[0], p[1], p[2], f[0][0], f[0][1], f[0][2], f[0][3]);
      b.gradient(sweeps[0], 24, p[0], p[1], p[2], f[1][0], f[1][1], f[1][2], f[1][3]);
      EXPECT_EQ(std::memcmp(f[0], f[1], sizeof f[0]), 0) << shape << ' ' << n;
    }
  }
}

/// Whole cuts: of tools that stand upright, lean, and turn on the way.
TEST(OctreeModel, KernelsLeaveTheSameWorkpiece) {
  using octree::KernelChoice;
  std::vector<KernelChoice> kernels{KernelChoice::kAuto};
  if (octree::has_avx2()) kernels.push_back(KernelChoice::kAvx2);
  if (octree::has_avx512()) kernels.push_back(KernelChoice::kAvx512);
  for (const double lean : {0.0, 0.3}) {
    std::vector<CutMove> moves = wandering_moves(14, 19);
    for (std::size_t n = 0; n < moves.size(); ++n) {
      const double way = static_cast<double>(n);
      moves[n].axis_from = glm::normalize(Vec3(lean * std::sin(way), lean * std::cos(way), 1));
      moves[n].axis_to =
          n % 3 == 0 ? moves[n].axis_from : glm::normalize(Vec3(lean * std::sin(way + 1), 0, 1));
    }
    for (const char* shape : {"flat:4", "ball:5", "bull:6:1.5", "taper:2:10:0.6"}) {
      const auto left_by = [&](KernelChoice kernel) {
        OctreeOptions options;
        options.blank = parse_blank(kBlank).value();
        options.cell_mm = 0.5;
        options.kernel = kernel;
        const std::unique_ptr<Octree> tree = std::move(Octree::create(options).value());
        const double removed = removed_mm3(cut(*tree, make_cutter(shape), moves));
        EXPECT_GT(removed, 1) << shape;
        return std::pair(tree->digest(), removed);
      };
      const auto plain = left_by(KernelChoice::kScalar);
      for (const KernelChoice kernel : kernels)
        EXPECT_EQ(left_by(kernel), plain) << shape << ", kernel " << static_cast<int>(kernel);
    }
  }
}

/// Of a ball nose whose spindle turns, against points tried along the way: in the hemisphere, above
/// it, and where it goes over from one to the other.
TEST(OctreeModel, ATurningBallIsAsFarAsItsNearestPose) {
  using namespace octree;
  const double radius = 2.5;
  const auto bodies = tool_bodies(make_cutter("ball:5"));
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> place(-4, 4);
  const SweepKernel kernel = pick_kernel(KernelChoice::kAuto);
  const Box everywhere{Vec3(-20), Vec3(20)};
  int below = 0, above = 0;
  for (int n = 0; n < 40; ++n) {
    CutMove move = line({place(engine), 0, 0}, {1, place(engine), 0.3 * place(engine)});
    move.axis_from = glm::normalize(Vec3(0.1 * place(engine), 0.1 * place(engine), 1));
    move.axis_to = glm::normalize(move.axis_from + Vec3(0.02 * place(engine), 0.03, 0));
    std::vector<Sweep> sweeps;
    append_sweeps(*bodies, move, 0, {everywhere, 0.002, 0}, sweeps);
    ASSERT_FALSE(sweeps.empty());
    alignas(64) double p[3][8], f[8], nearest[8];
    for (auto& axis : p)
      for (double& value : axis) value = place(engine);
    std::fill_n(nearest, 8, 1e9);
    for (const Sweep& sweep : sweeps) {
      kernel.distance(sweep, 8, p[0], p[1], p[2], f);
      for (int l = 0; l < 8; ++l) nearest[l] = std::min(nearest[l], f[l]);
    }
    const double angle = std::acos(glm::dot(move.axis_from, move.axis_to));
    for (int l = 0; l < 8; ++l) {
      double tried = 1e9, height = 0;
      for (int step = 0; step <= 4000; ++step) {
        const double s = step / 4000.0;
        const Vec3 w =
            (std::sin((1 - s) * angle) * move.axis_from + std::sin(s * angle) * move.axis_to) /
            std::sin(angle);
        const Vec3 from = Vec3(p[0][l], p[1][l], p[2][l]) - move.from_mm -
                          s * (move.to_mm - move.from_mm) - radius * w;
        const double up = glm::dot(from, w);
        const double value = glm::length(up > 0 ? from - up * w : from) - radius;
        if (value < tried) height = up;
        tried = std::min(tried, value);
      }
      (height < 0 ? below : above) += 1;
      // What the centre's straight way leaves, and half a step of the points tried.
      EXPECT_NEAR(nearest[l], tried, 0.0012) << n << ' ' << l;
    }
  }
  EXPECT_GT(below, 100);
  EXPECT_GT(above, 40);
}

TEST(OctreeModel, CuttingTwiceRemovesNothing) {
  const std::vector<CutMove> moves = wandering_moves(12, 7);
  for (const char* shape : {"ball:5", "flat:4", "bull:6:1", "tslot:7:2:3"}) {
    const auto tree = make_octree(kBlank, 0.5);
    cut(*tree, make_cutter(shape), moves);
    const std::string digest = tree->digest();
    for (const CutReport& report : cut(*tree, make_cutter(shape), moves))
      EXPECT_EQ(report.removed_mm3, 0) << shape << " move " << report.id;
    EXPECT_EQ(tree->digest(), digest) << shape;
  }
}

// What octree.h says of cutters with a sharp point.
TEST(OctreeModel, CuttingTwiceWithASharpVeeRemovesNextToNothing) {
  const std::vector<CutMove> moves = wandering_moves(30, 13, 0);
  double length = 0;
  for (const CutMove& move : moves) length += glm::length(move.to_mm - move.from_mm);
  for (const char* shape : {"vee:10:90", "vee:10:60", "vee:10:20:0.1"}) {
    for (const double cell : {0.5, 0.25}) {
      const auto tree = make_octree(kBlank, cell);
      cut(*tree, make_cutter(shape), moves);
      double again = 0;
      for (const CutReport& report : cut(*tree, make_cutter(shape), moves)) {
        EXPECT_LT(std::abs(report.removed_mm3), 4 * cell * cell * cell) << shape << ' ' << cell;
        again += std::abs(report.removed_mm3);
      }
      EXPECT_LT(again, 0.02 * cell * cell * length) << shape << ' ' << cell;
      // What was missed is gone now.
      EXPECT_LE(std::abs(removed_mm3(cut(*tree, make_cutter(shape), moves))), 0.1 * again + 1e-6);
    }
  }
}

TEST(OctreeModel, SnapshotsStayAsTheyWere) {
  const std::vector<CutMove> moves = wandering_moves(20, 9);
  const Cutter cutter = make_cutter("ball:6");
  const auto tree = make_octree(kBlank, 0.5);
  EXPECT_EQ(tree->take_dirty_tiles().size(), tree->tile_count());
  EXPECT_TRUE(tree->take_dirty_tiles().empty());
  std::vector<std::unique_ptr<StockModel>> snapshots;
  std::vector<std::string> digests;
  for (const CutMove& move : moves) {
    snapshots.push_back(tree->snapshot());
    digests.push_back(tree->digest());
    cut(*tree, cutter, {move});
    const std::vector<std::uint32_t> dirty = tree->take_dirty_tiles();
    EXPECT_EQ(dirty, tree->differing_tiles(*snapshots.back()));
    for (std::uint32_t t = 0; t < tree->tile_count(); ++t)
      if (tree->patch_version(t) == snapshots.back()->patch_version(t)) {
        EXPECT_FALSE(std::binary_search(dirty.begin(), dirty.end(), t)) << t;
      }
  }
  for (std::size_t i = 0; i < snapshots.size(); ++i) EXPECT_EQ(snapshots[i]->digest(), digests[i]);
  // A snapshot that cuts on goes its own way.
  std::vector<CutReport> reports;
  const std::string now = tree->digest();
  snapshots[0]->cut(cutter, moves, reports);
  EXPECT_EQ(snapshots[0]->digest(), now);
  EXPECT_EQ(tree->digest(), now);
  EXPECT_EQ(snapshots[1]->digest(), digests[1]);
  EXPECT_LT(snapshots[5]->unique_bytes(), tree->unique_bytes() + 1'000'000);
}

TEST(OctreeModel, PatchVersionTellsOfChangesNearby) {
  const auto tree = make_octree("box:0,0,-20:60,60,0", 0.5);
  const auto before = tree->snapshot();
  cut(*tree, make_cutter("flat:4"), {line({8, 8, -2}, {9, 9, -2})});
  std::size_t changed = 0;
  for (std::uint32_t t = 0; t < tree->tile_count(); ++t)
    changed += tree->patch_version(t) != before->patch_version(t);
  EXPECT_GT(changed, 0u);
  EXPECT_LT(changed, tree->tile_count() / 2);
}

TEST(OctreeModel, RemembersWhichMoveCut) {
  const auto tree = make_octree(kBlank, 0.5);
  const Cutter cutter = make_cutter("flat:6");
  EXPECT_FALSE(tree->cut_id_at({10, 10, 0}));
  tree->keep_cut_ids(true);
  cut(*tree, cutter, {line({5, 10, -3}, {25, 10, -3}, 41)});
  const auto plain = make_octree(kBlank, 0.5);
  cut(*plain, cutter, {line({5, 10, -3}, {25, 10, -3}, 41)});
  EXPECT_EQ(tree->digest(), plain->digest());
  cut(*tree, cutter, {line({5, 10, -3}, {25, 10, -3}, 42), line({15, 2, -1}, {15, 28, -1}, 43)});
  EXPECT_EQ(tree->cut_id_at({10, 10, -3}), 41u);
  EXPECT_EQ(tree->cut_id_at({15, 22, -1}), 43u);
  EXPECT_EQ(tree->cut_id_at({25, 25, 0}), std::nullopt);
  EXPECT_EQ(tree->cut_id_at({100, 25, 0}), std::nullopt);
  tree->keep_cut_ids(false);
  EXPECT_FALSE(tree->cut_id_at({10, 10, -3}));
}

TEST(OctreeModel, FirstContact) {
  const auto tree = make_octree(kBlank, 0.5);
  const Cutter cutter = make_cutter("flat:6");
  const std::string before = tree->digest();
  EXPECT_FALSE(tree->first_contact(cutter, line({-10, 15, 2}, {40, 15, 2}), 0.01));
  EXPECT_FALSE(tree->first_contact(cutter, line({-10, 15, 0}, {40, 15, 0}), 0.01));
  const auto side = tree->first_contact(cutter, line({-10, 15, -2}, {40, 15, -2}), 0.01);
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->tip_mm.x, -3 + 0.01, 0.02);
  EXPECT_NEAR(side->depth_mm, 2, 1e-3);
  const auto down = tree->first_contact(cutter, line({15, 15, 10}, {15, 15, -3.3}), 0.01);
  ASSERT_TRUE(down);
  EXPECT_NEAR(down->tip_mm.z, -0.01, 1e-3);
  EXPECT_NEAR(down->depth_mm, 3.3, 1e-3);
  EXPECT_EQ(tree->digest(), before);
  // Along what it has just cut it does not touch.
  cut(*tree, cutter, {line({-10, 15, -2}, {40, 15, -2})});
  EXPECT_FALSE(tree->first_contact(cutter, line({-10, 15, -2}, {40, 15, -2}), 0.01));
  EXPECT_TRUE(tree->first_contact(cutter, line({-10, 15.1, -2}, {40, 15.1, -2}), 0.01));
}

TEST(OctreeModel, AddsMaterial) {
  double error[2];
  for (int fine = 0; fine < 2; ++fine) {
    const auto tree = make_octree("box:0,0,0:20,20,10", fine ? 0.25 : 0.5, 1, true);
    EXPECT_EQ(tree->remaining_mm3(), 0);
    const Cutter bead = make_cutter("lollipop:6:1");
    const std::vector<CutMove> moves{line({5.1, 8.03, 2.2}, {15.1, 8.03, 2.2}, 3)};
    const auto reports = cut(*tree, bead, moves);
    // A capsule with its neck's slot above.
    const double foot = std::sqrt(8.75), top = 10 - 5.2;
    const double under_neck = 2 * (0.5 * (foot * 0.5 + 9 * std::asin(0.5 / 3)));
    const double sides = 10 * (top - 0) - 10 * under_neck;
    const double cap_end = kPi * 0.25 * (top - 2.96);
    error[fine] = tree->remaining_mm3() - (kPi * 9 * 10 + 36 * kPi + sides + cap_end);
    EXPECT_NEAR(reports[0].removed_mm3, -tree->remaining_mm3(), 1e-6);
    expect_sound(whole(*tree));
  }
  EXPECT_LT(std::abs(error[0]), 3.0);
  EXPECT_LT(std::abs(error[1]), 1.0);
  // What reaches beyond the space ends at its faces.
  const auto tree = make_octree("box:0,0,0:20,20,10", 0.5, 1, true);
  const Cutter wide = make_cutter("flat:60");
  cut(*tree, wide, {line({10, 10, -5}, {10, 10, -5})});
  EXPECT_NEAR(tree->remaining_mm3(), 4000, 4000 * 0.002);
  const HermiteGrid grid = whole(*tree);
  expect_sound(grid);
  for (const SurfacePoint& p : surface_points(grid)) {
    int faces = 0;
    for (int a = 0; a < 3; ++a) {
      const bool low = std::abs(p.at[a]) < 1e-4,
                 high = std::abs(p.at[a] - (a == 2 ? 10 : 20)) < 1e-4;
      faces += low || high;
      if (low) {
        EXPECT_LT(p.normal[a], -0.999);
      }
      if (high) {
        EXPECT_GT(p.normal[a], 0.999);
      }
    }
    ASSERT_EQ(faces, 1);
  }
}

// The mesh of what was cut is closed and as large as the model says.
TEST(OctreeModel, MeshIsClosedAndOfTheSameVolume) {
  const auto tree = make_octree(kBlank, 0.5);
  cut(*tree, make_cutter("bull:6:1"), wandering_moves(15, 11));
  const TriangleMesh mesh = tree->mesh(0);
  double volume = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int n) { return Vec3(mesh.positions_mm[t[static_cast<std::size_t>(n)]]); };
    volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    for (std::size_t n = 0; n < 3; ++n) edges.emplace_back(t[n], t[(n + 1) % 3]);
  }
  EXPECT_NEAR(volume, tree->remaining_mm3(), 0.002 * tree->blank_mm3());
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges)
    ASSERT_TRUE(std::binary_search(edges.begin(), edges.end(), std::pair(b, a)));
  std::size_t triangles = 0;
  for (std::uint32_t t = 0; t < tree->tile_count(); ++t) {
    const MeshPatch patch = tree->patch(t, 0);
    EXPECT_EQ(patch.version, tree->patch_version(t));
    triangles += patch.surface_indices().size() / 3;
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
}

TEST(OctreeModel, RefusesWhatItCannotHold) {
  const auto error = [](double cell, std::size_t limit) {
    OctreeOptions options;
    options.blank = *parse_blank("box:0,0,0:100,100,50");
    options.cell_mm = cell;
    options.memory_limit_bytes = limit;
    const auto tree = Octree::create(options);
    return tree ? std::string() : tree.error();
  };
  EXPECT_EQ(error(0, 1 << 30), "cell size 0 mm is not allowed; must be above 0");
  EXPECT_EQ(
      error(60, 1 << 30),
      "cell size 60 mm exceeds the blank, which is 100 x 100 x 50 mm; 0.05 to 0.5 mm suits most "
      "parts");
  EXPECT_EQ(error(0.01, 1'000'000'000),
            "cell size 0.01 mm would need about 12.4 GB of memory; 1.0 GB are allowed, for which "
            "0.035 mm fits");
  EXPECT_EQ(error(0.035, 1'000'000'000), "");
  EXPECT_NE(error(1e-9, 1'000'000'000), "");
  EXPECT_TRUE(Octree::can_cut(make_cutter("dovetail:10:60:4")));
}

TEST(OctreeModel, TheWallsOfATallBlockAreAlikeAndShared) {
  const auto slotted = [](const char* blank) {
    auto tree = make_octree(blank, 1);
    for (const char* tool : {"bull:6:1", "tslot:12:4:6"}) {
      CutMove helix = line({20, 20, -3}, {20, 20, -5});
      helix.arc = CutArc{{25, 20, -3}, {0, 0, 1}, 2 * kPi};
      cut(*tree, make_cutter(tool), {line({10, 8, -3}, {50, 9, -4}), helix});
    }
    return tree;
  };
  const auto low = slotted("box:0,0,-20:60,40,100"), tall = slotted("box:0,0,-20:60,40,3000"),
             taller = slotted("box:0,0,-20:60,40,6000");
  // Above the heads it is the same cut for each mm, and what differs is held once.
  const auto removed = [](const auto& tree) { return tree->blank_mm3() - tree->remaining_mm3(); };
  EXPECT_NEAR((removed(taller) - removed(tall)) / 3000, (removed(tall) - removed(low)) / 2900,
              1e-3);
  EXPECT_LT(taller->unique_bytes(), 3 * low->unique_bytes() + 2'000'000);
}

TEST(OctreeModel, RefusesWhatWouldTakeForEver) {
  const auto error = [](const char* blank, double cell) {
    OctreeOptions options;
    options.blank = *parse_blank(blank);
    options.cell_mm = cell;
    options.memory_limit_bytes = std::size_t{8} << 30;
    const auto tree = Octree::create(options);
    return tree ? std::string() : tree.error();
  };
  // An upright tool without an end cuts through 50 010 layers with each of its moves: 27 s for six.
  EXPECT_EQ(error("box:0,0,-20:100,60,100000", 2),
            "cell size 2 mm makes 50010 layers of cells between the blank's floor and its top; "
            "20000 are allowed, for which 5.1 mm fits");
  EXPECT_EQ(error("box:0,0,-20:100,60,100000", 5.1), "");
  EXPECT_EQ(error("box:0,0,0:100,60,20000", 1), "");
}

}  // namespace
}  // namespace kerf::test
