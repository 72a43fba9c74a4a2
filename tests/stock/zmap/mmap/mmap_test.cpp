// The M-map's answers: volumes in closed form, reports, snapshots, contacts.
#include <gtest/gtest.h>

#include <cmath>

#include "stock/zmap/height_mesh.h"
#include "tests/stock/random_part.h"
#include "tests/stock/zmap/mmap/mmap_samples.h"

namespace kerf {
namespace {

using test::cut;
using test::finish;
using test::helix;
using test::line;
using test::make_map;
using test::make_mmap;
using test::removed_mm3;
using test::shape;

TEST(MMap, TslotGrooveHasTheVolumeOfTheFormula) {
  const auto map = make_mmap("box:0,0,-12:40,24,0", 0.05);
  // From outside to outside: 40 mm of a groove 12 wide, 3 high, below a slot 5 wide.
  const double removed =
      removed_mm3(*map, shape("tslot:12:3:5"), {line(Vec3(-10, 12, -8), Vec3(50, 12, -8))});
  const double exact = 40 * (12 * 3 + 5 * 5);
  EXPECT_NEAR(removed, exact, 1e-3 * exact);
  EXPECT_NEAR(map->blank_mm3() - map->remaining_mm3(), removed, 0.05);
  EXPECT_EQ(map->height_mm(400, 240), -8.0f);
  const std::vector<Gap> gaps = map->gaps(400, 160);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].low, -8.0f);
  EXPECT_EQ(gaps[0].high, -5.0f);
  EXPECT_EQ(map->height_mm(400, 160), 0.0f);
}

TEST(MMap, LollipopSlotHasTheVolumeOfTheFormula) {
  const auto map = make_mmap("box:0,0,-12:40,20,0", 0.05);
  const double removed =
      removed_mm3(*map, shape("lollipop:8:4"), {line(Vec3(-10, 10, -10), Vec3(50, 10, -10))});
  // Circle of radius 4 about Z-6, and the neck of 4 above where it leaves the circle.
  const double foot = -6 + std::sqrt(16.0 - 4.0);
  const double cap = 16 * std::asin(0.5) - 2 * std::sqrt(12.0);  // of the circle, above the foot
  const double exact = 40 * (kPi * 16 - cap + 4 * -foot);
  EXPECT_NEAR(removed, exact, 1e-3 * exact);
}

TEST(MMap, DovetailHasTheVolumeOfTheFormula) {
  const auto map = make_mmap("box:0,0,-12:40,24,0", 0.05);
  const double removed =
      removed_mm3(*map, shape("dovetail:12:60:6"), {line(Vec3(-10, 12, -7), Vec3(50, 12, -7))});
  const double high = 3 * std::tan(kPi / 3);
  const double exact = 40 * (high * 9 + 6 * (7 - high));
  EXPECT_NEAR(removed, exact, 1e-3 * exact);
}

TEST(MMap, PlungeAndRetractLeaveTheSweptBody) {
  // The head goes down beside the part, in below a lip, and up there: a shaft below the surface.
  const auto map = make_mmap("box:0,0,-12:20,20,0", 0.05);
  const Cutter tool = shape("tslot:8:2:3");
  const double first = removed_mm3(*map, tool, {line(Vec3(10, 10, -9), Vec3(10, 10, -6))});
  const double exact = kPi * 16 * 5 + kPi * 2.25 * 4;  // Z-9 .. Z-4, and the neck up to Z0
  EXPECT_NEAR(first, exact, 2e-3 * exact);
  EXPECT_EQ(removed_mm3(*map, tool, {line(Vec3(10, 10, -6), Vec3(10, 10, -9))}), 0);
}

TEST(MMap, ThreadsOfASinglePointMillAreSeparateGaps) {
  const auto map = make_mmap("box:-12,-12,-12:12,12,0", 0.1);
  const Cutter drill = shape("flat:12");
  removed_mm3(*map, drill, {line(Vec3(0, 0, 5), Vec3(0, 0, -12))});
  // A double cone 2.2 high, at a pitch of 3: four turns.
  removed_mm3(*map, test::double_cone(), {helix(Vec3(0, 0, -11.5), 4.5, 0, 8 * kPi, 12)});
  // Beyond the hole the turns are apart; they reach radius 7.5.
  const std::vector<Gap> gaps = map->gaps(120 + 68, 120);
  ASSERT_GE(gaps.size(), 3u);
  for (std::size_t n = 1; n + 1 < gaps.size(); ++n)
    EXPECT_NEAR(gaps[n - 1].low - gaps[n].low, 3, 1e-3);
}

TEST(MMap, CutsAboveAGapOpenIt) {
  const auto map = make_mmap("box:0,0,-10:20,20,0", 0.1);
  removed_mm3(*map, shape("tslot:10:2:4"), {line(Vec3(-10, 10, -8), Vec3(30, 10, -8))});
  EXPECT_EQ(map->gaps(100, 60).size(), 1u);
  // A pocket from above that ends above the gap, one that ends in it, and one below it.
  const double lid = removed_mm3(*map, shape("flat:6"), {line(Vec3(10, 6, 1), Vec3(10, 6, -3))});
  // The slot of the neck has a segment of the circle, 2 mm from its centre.
  EXPECT_NEAR(lid, 3 * (kPi * 9 - (9 * std::acos(2.0 / 3) - 2 * std::sqrt(5.0))), 0.3);
  EXPECT_EQ(map->gaps(100, 60).size(), 1u);
  removed_mm3(*map, shape("flat:2"), {line(Vec3(10, 6, 1), Vec3(10, 6, -7))});
  EXPECT_TRUE(map->gaps(100, 60).empty());
  EXPECT_EQ(map->height_mm(100, 60), -8.0f);
  removed_mm3(*map, shape("flat:1"), {line(Vec3(10, 6, 1), Vec3(10, 6, -9))});
  EXPECT_EQ(map->height_mm(100, 60), -9.0f);
}

TEST(MMap, AMonotoneProgramGivesTheZMap) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    const auto zmap = make_map("box:0,0,-8:24,18,0", 0.1);
    const auto mmap = make_mmap("box:0,0,-8:24,18,0", 0.1);
    for (const char* const spec : {"flat:4", "ball:5", "bull:5:1", "vee:8:90"}) {
      const auto moves = test::random_path(random, {Vec3(-1, -1, -6), Vec3(25, 19, 0)}, 60);
      std::vector<CutReport> a, b;
      zmap->cut(shape(spec), moves, a);
      zmap->finish(a);
      mmap->cut(shape(spec), moves, b);
      mmap->finish(b);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].removed_mm3, b[i].removed_mm3);
        EXPECT_EQ(a[i].depth_mm, b[i].depth_mm);
      }
    }
    EXPECT_EQ(zmap->digest(), mmap->digest());
    // A Z-map knows besides where walls stand within a cell.
    EXPECT_NEAR(test::volume_by_cells(*zmap), mmap->remaining_mm3(), 1e-6);
    for (std::uint32_t tile = 0; tile < mmap->tile_count(); ++tile) {
      const MeshPatch a = zmap->patch(tile, 0), b = mmap->patch(tile, 0);
      EXPECT_EQ(a.indices, b.indices);
      EXPECT_EQ(a.vertices.size(), b.vertices.size());
    }
    EXPECT_NE(mmap->height_grid(), nullptr);
    // And its mesh.
    const ZMap& heights = dynamic_cast<const ZMap&>(*zmap);
    EXPECT_EQ(mesh_height_grid(
                  {heights.nx(), heights.ny(), zmap->bounds_mm(), heights.heights_mm()}, 0.01)
                  .triangles,
              mmap->mesh(0.01).triangles);
  }
}

TEST(MMap, HeightsOfMonotoneToolsAreTheZMapsInTilesWithGapsToo) {
  // With a gap far below, the tile is cut by the other way; what it leaves above is the same.
  const auto zmap = make_map("box:0,0,-20:12,12,0", 0.1);
  const auto mmap = make_mmap("box:0,0,-20:12,12,0", 0.1);
  removed_mm3(*mmap, shape("tslot:8:1:2"), {line(Vec3(-8, 6, -19), Vec3(20, 6, -19))});
  std::mt19937 random(9);
  for (const char* const spec : {"ball:5", "vee:8:90", "taper:2:5"}) {
    const auto moves = test::random_path(random, {Vec3(-1, -1, -6), Vec3(13, 13, 0)}, 60);
    removed_mm3(*zmap, shape(spec), moves);
    removed_mm3(*mmap, shape(spec), moves);
  }
  int with_gaps = 0;
  for (int j = 0; j < mmap->ny(); ++j) {
    for (int i = 0; i < mmap->nx(); ++i) {
      const std::vector<Gap> gaps = mmap->gaps(i, j);
      with_gaps += !gaps.empty();
      if (mmap->height_mm(i, j) <= -19) continue;  // in the slot of the neck
      EXPECT_EQ(mmap->height_mm(i, j), zmap->height_mm(i, j));
    }
  }
  EXPECT_GT(with_gaps, 1000);
}

/// Several convex parts in one cutter: steep, then less so.
Cutter stepped() {
  std::vector<ProfilePiece> pieces(2);
  pieces[0].r1 = 1;
  pieces[0].z1 = 2;
  pieces[1].r0 = 1;
  pieces[1].z0 = 2;
  pieces[1].r1 = 3;
  pieces[1].z1 = 2.5;
  return Cutter::from_profile("stepped", pieces).value();
}

/// A cut from above that ends in a gap, or as good as on it, opens it; what it leaves over a gap
/// stays.
TEST(MMap, CutsFromAboveOpenTheGapsThatTheyReach) {
  for (const ZMapKernel kernel : zmap_kernels()) {
    SCOPED_TRACE(to_string(kernel));
    const auto zmap = make_map("box:0,0,-20:24,18,0", 0.1);
    const auto mmap = make_mmap("box:0,0,-20:24,18,0", 0.1, 1, kernel);
    const auto before = make_mmap("box:0,0,-20:24,18,0", 0.1);
    for (const double z : {-4.5, -6.0, -7.0}) {
      for (MMap* const map : {mmap.get(), before.get()}) {
        removed_mm3(*map, shape("tslot:9:0.5:1"), {line(Vec3(-9, 9, z), Vec3(33, 9, z))});
      }
    }
    const double hollow = mmap->blank_mm3() - mmap->remaining_mm3();
    std::mt19937 random(11);
    double removed = 0;
    for (const Cutter& cutter : {shape("ball:5"), shape("vee:8:90"), stepped()}) {
      const auto moves = test::random_path(random, {Vec3(-1, -1, -8), Vec3(25, 19, -3)}, 40);
      removed_mm3(*zmap, cutter, moves);
      removed += removed_mm3(*mmap, cutter, moves);
    }
    // In the material over the uppermost gap, but for what is too thin to be kept; and in a gap.
    for (const double z : {-4.0 + 5e-5, -6.5}) {
      const CutMove along = line(Vec3(5, -9, z), Vec3(5, 30, z));
      removed_mm3(*zmap, shape("flat:2"), {along});
      removed += removed_mm3(*mmap, shape("flat:2"), {along});
    }
    int opened = 0, left = 0;
    for (int j = 0; j < mmap->ny(); ++j) {
      for (int i = 0; i < mmap->nx(); ++i) {
        float height = std::min(before->height_mm(i, j), zmap->height_mm(i, j));
        std::vector<Gap> gaps = before->gaps(i, j);
        while (!gaps.empty() && gaps.front().high >= height - kThinnest_mm) {
          height = std::min(height, gaps.front().low);
          gaps.erase(gaps.begin());
          ++opened;
        }
        left += static_cast<int>(gaps.size());
        ASSERT_EQ(mmap->height_mm(i, j), height) << i << ' ' << j;
        ASSERT_EQ(mmap->gaps(i, j), gaps) << i << ' ' << j;
      }
    }
    EXPECT_GT(opened, 1000);
    EXPECT_GT(left, 1000);
    EXPECT_NEAR(removed, mmap->blank_mm3() - mmap->remaining_mm3() - hollow, 1e-5 * removed);
  }
}

TEST(MMap, DivisionIntoCallsThreadsAndKernelChangeNoBit) {
  std::string digest;
  double remaining = 0;
  struct Variant {
    std::size_t at_once;
    int threads;
    ZMapKernel kernel;
    bool ids;
  };
  std::vector<Variant> variants{{1000, 1, ZMapKernel::kAuto, false},
                                {1, 1, ZMapKernel::kAuto, true},
                                {5, 3, ZMapKernel::kAuto, false}};
  for (const ZMapKernel kernel : zmap_kernels()) variants.push_back({1000, 4, kernel, true});
  for (const Variant& v : variants) {
    const auto map = make_mmap("box:0,0,-10:24,18,0", 0.1, v.threads, v.kernel);
    map->keep_cut_ids(v.ids);
    double removed = 0;
    std::size_t count = 0, moves = 0;
    for (const test::Job& job : test::random_jobs(4)) {
      std::vector<CutReport> reports;
      for (std::size_t i = 0; i < job.moves.size(); i += v.at_once) {
        const std::size_t n = std::min(v.at_once, job.moves.size() - i);
        map->cut(job.cutter, std::span(job.moves).subspan(i, n), reports);
      }
      map->finish(reports);
      for (const CutReport& report : reports) removed += report.removed_mm3;
      count += reports.size();
      moves += job.moves.size();
    }
    EXPECT_EQ(count, moves);
    EXPECT_NEAR(removed, map->blank_mm3() - map->remaining_mm3(), 1e-4 * removed);
    EXPECT_TRUE(map->has_gaps());
    if (digest.empty()) {
      digest = map->digest();
      remaining = map->remaining_mm3();
    }
    EXPECT_EQ(map->digest(), digest);
    EXPECT_EQ(map->remaining_mm3(), remaining);
  }
}

TEST(MMap, WhatIsCutTwiceIsNotThereTheSecondTime) {
  const auto map = make_mmap("box:0,0,-10:24,18,0", 0.1);
  for (const test::Job& job : test::random_jobs(5)) {
    EXPECT_GT(removed_mm3(*map, job.cutter, job.moves), 0);
    const std::string digest = map->digest();
    EXPECT_EQ(removed_mm3(*map, job.cutter, job.moves), 0) << job.cutter.spec();
    EXPECT_EQ(map->digest(), digest);
  }
}

TEST(MMap, SnapshotsKeepWhatTheySaw) {
  const auto map = make_mmap("box:0,0,-10:24,18,0", 0.1);
  EXPECT_EQ(map->take_dirty_tiles().size(), map->tile_count());
  std::vector<std::unique_ptr<StockModel>> snapshots;
  std::vector<std::string> digests;
  for (const test::Job& job : test::random_jobs(6)) {
    cut(*map, job.cutter, job.moves);
    snapshots.push_back(map->snapshot());
    finish(*map);
    digests.push_back(map->digest());
    EXPECT_EQ(snapshots.back()->digest(), digests.back());
    EXPECT_TRUE(snapshots.back()->differing_tiles(*map).empty());
  }
  for (std::size_t i = 0; i < snapshots.size(); ++i) EXPECT_EQ(snapshots[i]->digest(), digests[i]);
  EXPECT_FALSE(snapshots[0]->differing_tiles(*map).empty());
  map->take_dirty_tiles();
  // A gap far below changes no height: its tile is dirty, and no longer like the snapshot's.
  const auto before = map->snapshot();
  const std::vector<std::uint64_t> versions{map->patch_version(0)};
  removed_mm3(*map, shape("tslot:3:0.4:1"), {line(Vec3(-4, 3, -9.8), Vec3(2, 3, -9.8))});
  const std::vector<std::uint32_t> dirty = map->take_dirty_tiles();
  EXPECT_EQ(dirty, map->differing_tiles(*before));
  EXPECT_NE(map->patch_version(0), versions[0]);
  EXPECT_EQ(before->patch_version(0), versions[0]);
}

TEST(MMap, ContactsOfAHead) {
  const auto map = make_mmap("box:0,0,-12:40,24,0", 0.2);
  const Cutter tool = shape("tslot:12:3:5");
  const CutMove groove = line(Vec3(-10, 12, -8), Vec3(50, 12, -8));
  const std::optional<Contact> first = map->first_contact(tool, groove, 0.01);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->tip_mm.x, -6, 0.22);
  removed_mm3(*map, tool, {groove});
  // It may go where it has cut, but no higher and no lower, and not out through the top.
  EXPECT_FALSE(map->first_contact(tool, groove, 0.01));
  EXPECT_TRUE(map->first_contact(tool, line(Vec3(-10, 12, -7.9), Vec3(50, 12, -7.9)), 0.01));
  EXPECT_TRUE(map->first_contact(tool, line(Vec3(-10, 12, -8.1), Vec3(50, 12, -8.1)), 0.01));
  const std::optional<Contact> out =
      map->first_contact(tool, line(Vec3(20, 12, -8), Vec3(20, 12, 5)), 0.01);
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->tip_mm.z, -8, 0.02);
  EXPECT_NEAR(out->depth_mm, 5, 0.03);
  // A thinner head has room in the groove; a monotone tool meets the lips from above.
  EXPECT_FALSE(
      map->first_contact(shape("tslot:8:2:3"), line(Vec3(10, 11, -7.5), Vec3(30, 13, -7)), 0.01));
  const std::optional<Contact> lip =
      map->first_contact(shape("flat:4"), line(Vec3(20, 7.5, 5), Vec3(20, 7.5, -8)), 0.01);
  ASSERT_TRUE(lip);
  EXPECT_NEAR(lip->tip_mm.z, 0, 0.02);
}

TEST(MMap, BothSidesOfAGapKnowTheirMoves) {
  const auto map = make_mmap("box:0,0,-12:40,24,0", 0.1);
  map->keep_cut_ids(true);
  CutMove low = line(Vec3(-10, 12, -9), Vec3(50, 12, -9)), high = low;
  low.id = 7;
  high.from_mm.z = high.to_mm.z = -7;
  high.id = 9;
  removed_mm3(*map, shape("tslot:12:3:5"), {low, high});
  const std::vector<Gap> gaps = map->gaps(200, 80);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].low_id, 7u);
  EXPECT_EQ(gaps[0].high_id, 9u);
  EXPECT_EQ(map->cut_id_at(Vec3(20, 8, -9)), 7u);
  EXPECT_EQ(map->cut_id_at(Vec3(20, 8, -4)), 9u);
  EXPECT_EQ(map->cut_id_at(Vec3(20, 12, -9)), 7u);
  EXPECT_EQ(map->cut_id_at(Vec3(20, 8, 0)), std::nullopt);
}

TEST(MMap, SaysWhatItCannotDo) {
  Cutter cup = *Cutter::from_profile("cup", [] {
    std::vector<ProfilePiece> pieces(1);
    pieces[0].z0 = 1;
    pieces[0].r1 = 4;
    return pieces;
  }());
  EXPECT_EQ(MMap::can_cut(cup).error(),
            "cup has a hollow bottom (its profile falls from radius 0 outward); an M-map cannot "
            "cut with it");
  EXPECT_TRUE(MMap::can_cut(shape("lollipop:8:4")));
  ZMapOptions options;
  options.blank = *parse_blank("cylinder:0,0,0:10:5:x");
  EXPECT_EQ(MMap::create(options).error(),
            "an M-map cannot hold a cylinder along x; its axis must be z");
}

}  // namespace
}  // namespace kerf
