// A part that is turned and milled: closed forms, either order, equal bits, copies.
#include "stock/millturn/mill_turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>
#include <utility>

#include "stock/cutter/insert_shape.h"
#include "stock/cutter/shape_spec.h"
#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr double kRadius_mm = 20, kLow_mm = -50;

TurningStock bar() { return TurningStock(*TurnedPart::create(bar_profile(kLow_mm, 0, 40))); }

std::unique_ptr<MillTurn> stock_of(double cell_mm = 0.25, int threads = 1) {
  MillTurnOptions options;
  options.cell_mm = cell_mm;
  options.threads = threads;
  return std::move(MillTurn::create(bar(), options).value());
}

Cutter driven(const std::string& shape) { return *parse_shape(shape); }

/// Cuts towards -z; its controlled point touches lines along the axes.
Cutter insert() {
  const auto rad = [](double deg) { return deg * kPi / 180; };
  return Cutter::from_insert("insert", *nose_insert({0.4, 2, rad(85), rad(30), 20}));
}
Cutter blade() { return Cutter::from_insert("blade", *groove_insert({3, 0, 30, 2})); }

Vec3 turned_by(const Vec3& p, double deg) {
  const double c = std::cos(deg * kPi / 180), s = std::sin(deg * kPi / 180);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

CutMove line(const Vec3& from, const Vec3& to, const Vec3& axis = {0, 0, 1}, std::uint64_t id = 0) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  move.axis_from = move.axis_to = axis;
  move.id = id;
  return move;
}

double cut(MillTurn& stock, const Cutter& cutter, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  stock.cut(cutter, moves, reports);
  stock.finish(reports);
  EXPECT_EQ(reports.size(), moves.size());
  double removed = 0;
  for (const CutReport& report : reports) removed += report.removed_mm3;
  return removed;
}

double bar_mm3() { return kPi * kRadius_mm * kRadius_mm * -kLow_mm; }

/// Of f(y) over low .. high.
double integral(double low, double high, const std::function<double(double)>& f) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f(low + (high - low) * (i + 0.5) / kSteps);
  return sum * (high - low) / kSteps;
}

/// A keyway 6 wide, its bottom 17 from the axis, from the face to 20 behind it.
std::vector<CutMove> keyway(double deg = 0) {
  return {line(turned_by({17, 0, 10}, deg), turned_by({17, 0, -20}, deg), turned_by({1, 0, 0}, deg),
               7)};
}
double keyway_mm3() {
  const auto height = [](double y) { return std::sqrt(400 - y * y) - 17; };
  return integral(-3, 3, [&](double y) { return height(y) * (20 + std::sqrt(9 - y * y)); });
}

/// From radius 20 to 18 over 30 mm, behind the middle of it a groove.
std::vector<CutMove> turning() {
  return {line({18, 0, 5}, {18, 0, -30}), line({18, 0, -30}, {25, 0, -30})};
}

TEST(MillTurn, UntilItIsMilledItIsTurned) {
  const auto stock = stock_of();
  TurningStock turned = bar();
  std::vector<CutReport> reports, same;
  stock->cut(insert(), turning(), reports);
  turned.cut(insert(), turning(), same);
  ASSERT_EQ(reports.size(), same.size());
  EXPECT_EQ(reports[0].removed_mm3, same[0].removed_mm3);
  EXPECT_FALSE(stock->is_milled());
  EXPECT_EQ(stock->digest(), turned.digest());
  EXPECT_EQ(stock->remaining_mm3(), turned.remaining_mm3());
  EXPECT_EQ(stock->tile_count(), turned.tile_count());
  EXPECT_EQ(stock->name(), "turning");
  EXPECT_EQ(stock->turned()->digest(), turned.digest());
  // A contact with a driven tool leaves it as it is.
  EXPECT_TRUE(stock->first_contact(driven("flat:6:live=z"), line({5, 5, 2}, {5, 5, -1}), 1e-3));
  EXPECT_FALSE(stock->is_milled());
  EXPECT_EQ(stock->digest(), turned.digest());
  // Nor do moves through the air make an octree of it.
  EXPECT_EQ(cut(*stock, driven("flat:6:live=z"), {line({5, 5, 9}, {5, 5, 2})}), 0);
  EXPECT_FALSE(stock->is_milled());
}

TEST(MillTurn, AnEccentricHole) {
  const auto stock = stock_of();
  const double removed = cut(*stock, driven("flat:6:live=z"), {line({10, 5, 5}, {10, 5, -20})});
  EXPECT_NEAR(removed, kPi * 9 * 20, 0.5);
  EXPECT_NEAR(stock->remaining_mm3(), bar_mm3() - kPi * 9 * 20, 0.5);
  EXPECT_TRUE(stock->is_milled());
}

TEST(MillTurn, AFlat) {
  const auto stock = stock_of();
  const double removed =
      cut(*stock, driven("flat:20:live=x"), {line({15, -40, -10}, {15, 40, -10}, {1, 0, 0})});
  const double segment_mm2 = 400 * std::acos(0.75) - 15 * std::sqrt(400.0 - 225);
  EXPECT_NEAR(removed, segment_mm2 * 20, 1e-3 * segment_mm2 * 20);
}

TEST(MillTurn, AKeyway) {
  for (const double deg : {0.0, 90.0, 37.0}) {
    const auto stock = stock_of();
    EXPECT_NEAR(cut(*stock, driven("flat:6:live=x"), keyway(deg)), keyway_mm3(),
                3e-3 * keyway_mm3())
        << deg;
  }
}

TEST(MillTurn, AHexagonByIndexing) {
  const auto stock = stock_of();
  for (int side = 0; side < 6; ++side) {
    const double deg = 60 * side;
    cut(*stock, driven("flat:20:live=x"),
        {line(turned_by({16, -40, -10}, deg), turned_by({16, 40, -10}, deg),
              turned_by({1, 0, 0}, deg))});
  }
  // Corners at 18.5 lie within the bar.
  const double expected = 2 * std::sqrt(3.0) * 256 * 20 + kPi * 400 * 30;
  EXPECT_NEAR(stock->remaining_mm3(), expected, 2e-4 * expected);
}

TEST(MillTurn, TurnedBeforeOrAfterIsTheSamePart) {
  const auto before = stock_of(), after = stock_of();
  cut(*before, insert(), turning());
  cut(*before, driven("flat:6:live=x"), keyway());
  cut(*after, driven("flat:6:live=x"), keyway());
  cut(*after, insert(), turning());
  EXPECT_NEAR(before->remaining_mm3(), after->remaining_mm3(), 1e-4 * after->remaining_mm3());
  const auto height = [](double y) { return std::sqrt(324 - y * y) - 17; };
  const double key_mm3 =
      integral(-3, 3, [&](double y) { return height(y) * (20 + std::sqrt(9 - y * y)); });
  const double turned_mm3 = before->turned()->remaining_mm3();
  EXPECT_NEAR(before->remaining_mm3(), turned_mm3 - key_mm3, 0.01 * key_mm3);
  const auto volume = [](const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
      const auto at = [&](std::size_t n) { return Vec3(mesh.positions_mm[t[n]]); };
      sum += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    }
    return sum;
  };
  EXPECT_NEAR(volume(before->mesh(0)), volume(after->mesh(0)), 1e-4 * turned_mm3);
}

TEST(MillTurn, WhatIsPartedOffIsGoneWithWhatWasMilledOnIt) {
  const auto stock = stock_of();
  cut(*stock, driven("flat:6:live=x"), keyway());
  cut(*stock, blade(), {line({25, 0, -30}, {-1, 0, -30})});
  ASSERT_EQ(stock->turned()->part().freed().size(), 1u);
  // What is left was never milled.
  EXPECT_NEAR(stock->remaining_mm3(), stock->turned()->remaining_mm3(), 1.0);
  for (const glm::vec3& p : stock->mesh(0).positions_mm) ASSERT_LT(p.z, -29.9f);
}

TEST(MillTurn, BitsDependNeitherOnCallsNorThreadsNorOnWhoLooks) {
  const std::vector<CutMove> first = keyway(20);
  std::vector<CutMove> holes;
  for (int i = 0; i < 8; ++i) {
    const Vec3 at = turned_by({11, 0, 0}, 45.0 * i);
    holes.push_back(line(at + Vec3(0, 0, 3), at + Vec3(0, 0, -12), {0, 0, 1}, 100 + i));
  }
  const auto run = [&](int threads, bool singly, bool looked_at) {
    const auto stock = stock_of(0.4, threads);
    const auto look = [&] {
      if (looked_at) static_cast<void>(stock->digest() + stock->snapshot()->digest());
    };
    const auto all = [&](const Cutter& cutter, const std::vector<CutMove>& moves) {
      look();
      if (!singly) {
        cut(*stock, cutter, moves);
        return;
      }
      for (const CutMove& move : moves) {
        cut(*stock, cutter, {move});
        look();
      }
    };
    all(driven("flat:6:live=x"), first);
    all(insert(), turning());
    all(driven("drill:5:118:live=z"), holes);
    all(blade(), {line({25, 0, -40}, {12, 0, -40}), line({25, 0, -43}, {12, 0, -43})});
    return stock->digest();
  };
  const std::string digest = run(1, false, false);
  EXPECT_EQ(digest, run(3, false, false));
  EXPECT_EQ(digest, run(1, true, false));
  EXPECT_EQ(digest, run(2, true, true));
}

TEST(MillTurn, ACopyStaysAndGoesOn) {
  const auto stock = stock_of(0.4);
  cut(*stock, driven("flat:6:live=x"), keyway());
  cut(*stock, insert(), turning());
  const auto copy = stock->snapshot();
  const std::string digest = stock->digest();
  EXPECT_EQ(copy->digest(), digest);
  EXPECT_TRUE(stock->differing_tiles(*copy).empty());
  EXPECT_EQ(copy->milling_cell_mm(), stock->milling_cell_mm());
  cut(*stock, driven("flat:6:live=x"), keyway(180));
  EXPECT_EQ(copy->digest(), digest);
  EXPECT_FALSE(stock->differing_tiles(*copy).empty());
  std::vector<CutReport> reports;
  copy->cut(driven("flat:6:live=x"), keyway(180), reports);
  EXPECT_EQ(copy->digest(), stock->digest());
  EXPECT_EQ(copy->remaining_mm3(), stock->remaining_mm3());
}

/// Saved and loaded it goes on as if it had never been away: milled, turned, parted off.
TEST(MillTurn, SavedItGoesOnBeingTurnedAndMilled) {
  const TemporaryFolder folder;
  const std::string path = folder / "part.state";
  const auto stock = stock_of(0.4);
  cut(*stock, insert(), {line({18, 0, 2}, {18, 0, -25})});
  cut(*stock, driven("flat:6:live=x"), keyway());
  cut(*stock, insert(), turning());
  ASSERT_TRUE(stock->save(path));
  const auto loaded = MillTurn::load(path, {});
  ASSERT_TRUE(loaded) << loaded.error();
  MillTurn& back = **loaded;
  EXPECT_TRUE(back.is_milled());
  EXPECT_EQ(back.digest(), stock->digest());
  EXPECT_EQ(back.turned()->digest(), stock->turned()->digest());
  EXPECT_EQ(back.remaining_mm3(), stock->remaining_mm3());
  EXPECT_EQ(back.blank_mm3(), stock->blank_mm3());
  EXPECT_EQ(back.milling_cell_mm(), stock->milling_cell_mm());
  for (MillTurn* one : {stock.get(), &back}) {
    cut(*one, insert(), {line({16, 0, 2}, {16, 0, -22})});
    cut(*one, driven("flat:6:live=x"), keyway(120));
    cut(*one, blade(), {line({25, 0, -30}, {-1, 0, -30})});
  }
  EXPECT_EQ(back.digest(), stock->digest());
  EXPECT_EQ(back.remaining_mm3(), stock->remaining_mm3());
  EXPECT_EQ(back.turned()->part().freed().size(), 1u);
  // A mill takes the same file as the octree that it is.
  const auto tree = Octree::load(path);
  ASSERT_TRUE(tree) << tree.error();
  ASSERT_TRUE((*tree)->save(path));
  const auto without = MillTurn::load(path, {});
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error(), path + ": nothing in it says how it was turned: a mill has saved it");
}

TEST(MillTurn, SavedUnmilledItIsAFileOfTurning) {
  const TemporaryFolder folder;
  const std::string path = folder / "part.state";
  const auto stock = stock_of();
  cut(*stock, insert(), turning());
  ASSERT_TRUE(stock->save(path));
  const auto turned = TurningStock::load(path);
  ASSERT_TRUE(turned) << turned.error();
  EXPECT_EQ((*turned)->digest(), stock->digest());
}

TEST(MillTurn, ADamagedFileIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "part.state";
  const auto stock = stock_of(1);
  cut(*stock, driven("flat:6:live=x"), keyway());
  ASSERT_TRUE(stock->save(path));
  std::string bytes = text_of(path);
  const std::size_t beside = bytes.find("\nmodel turning\n");
  ASSERT_NE(beside, std::string::npos);
  for (const std::size_t at : {beside + 30, beside + 100, bytes.size() / 2, bytes.size() - 30}) {
    std::string wrong = bytes;
    wrong[at] ^= 1;
    std::ofstream(path, std::ios::binary) << wrong;
    EXPECT_FALSE(MillTurn::load(path, {})) << at;
    EXPECT_FALSE(Octree::load(path)) << at;
  }
  for (const std::size_t size : {beside + 30, bytes.size() - 1, std::size_t{40}}) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, size);
    EXPECT_FALSE(MillTurn::load(path, {})) << size;
    EXPECT_FALSE(Octree::load(path)) << size;
  }
}

TEST(MillTurn, TilesAreToldOfWhatIsTurnedLater) {
  const auto stock = stock_of(0.4);
  EXPECT_EQ(stock->take_dirty_tiles().size(), stock->tile_count());
  cut(*stock, driven("flat:6:live=x"), keyway());
  EXPECT_EQ(stock->take_dirty_tiles().size(), stock->tile_count());  // other ones
  EXPECT_TRUE(stock->take_dirty_tiles().empty());
  cut(*stock, insert(), turning());
  const auto dirty = stock->take_dirty_tiles();
  EXPECT_FALSE(dirty.empty());
  for (const std::uint32_t tile : dirty) EXPECT_GT(stock->tile_box(tile).max.z, -31);
  EXPECT_TRUE(stock->take_dirty_tiles().empty());
}

TEST(MillTurn, TheMeshIsClosedAndOfTheSameVolume) {
  const auto stock = stock_of(0.4);
  cut(*stock, insert(), turning());
  cut(*stock, driven("flat:6:live=x"), keyway(33));
  cut(*stock, driven("drill:5:118:live=z"), {line({9, -3, 5}, {9, -3, -15})});
  cut(*stock, blade(), {line({25, 0, -40}, {12, 0, -40})});
  const TriangleMesh mesh = stock->mesh(0);
  double volume = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t n) { return Vec3(mesh.positions_mm[t[n]]); };
    volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    for (std::size_t n = 0; n < 3; ++n) edges.emplace_back(t[n], t[(n + 1) % 3]);
  }
  EXPECT_NEAR(volume, stock->remaining_mm3(), 1e-3 * stock->remaining_mm3());
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges)
    ASSERT_TRUE(std::binary_search(edges.begin(), edges.end(), std::pair(b, a)));
  std::size_t triangles = 0;
  for (std::uint32_t tile = 0; tile < stock->tile_count(); ++tile) {
    const MeshPatch patch = stock->patch(tile, 0);
    EXPECT_EQ(patch.version, stock->patch_version(tile));
    triangles += patch.surface_indices().size() / 3;
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
}

TEST(MillTurn, DrivenToolsMeetWhatIsLeft) {
  const auto stock = stock_of();
  const Cutter mill = driven("flat:6:live=x");
  const CutMove along = keyway()[0];
  const auto met = stock->first_contact(mill, along, 1e-3);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->tip_mm.z, 3, 0.1);
  cut(*stock, mill, {along});
  EXPECT_FALSE(stock->first_contact(mill, along, 1e-3));
  // 1 mm deeper than the bar is thick there now.
  cut(*stock, insert(), turning());
  EXPECT_FALSE(
      stock->first_contact(mill, line({18.05, 10, 10}, {18.05, 10, -20}, {1, 0, 0}), 1e-3));
  EXPECT_TRUE(stock->first_contact(mill, line({17.5, 0, -60}, {17.5, 0, -24}, {1, 0, 0}), 1e-3));
}

TEST(MillTurn, WhatItDoesNotTake) {
  MillTurnOptions options;
  options.cell_mm = 0.01;
  options.memory_limit_bytes = 1 << 20;
  EXPECT_FALSE(MillTurn::create(bar(), options));
  EXPECT_TRUE(MillTurn::can_cut(driven("ball:6:live=z")));
  EXPECT_TRUE(MillTurn::can_cut(insert()));
}

}  // namespace
}  // namespace kerf
