// Which move has made which surface of a turned part.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "stock/turning/turning_stock.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

constexpr double kNear_mm = 1e-4;

TurnedPart marked_bar() {
  TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
  part.keep_cut_ids(true);
  return part;
}

InsertOutline blade(double width_mm) { return *groove_insert({width_mm, 0, 30, 2}); }

TEST(TurningIds, a_cylinder_of_two_moves_has_both) {
  TurnedPart part = marked_bar();
  const TurningTool tool(blade(2));
  part.cut(tool, line({5, 16}, {-8, 16}, 1));
  part.cut(tool, line({-8, 16}, {-17, 16}, 2));
  part.cut(tool, line({-17, 16}, {-17, 25}, 3));
  const auto id = [&](double z, double r) { return part.cut_id_at({z, r}, kNear_mm); };
  EXPECT_EQ(id(-1, 16), 1u);
  EXPECT_EQ(id(-7.9, 16), 1u);
  EXPECT_EQ(id(-14, 16), 2u);
  EXPECT_EQ(id(-25, 20), std::nullopt) << "the bar as it was";
  EXPECT_EQ(id(-10, 15.9), std::nullopt) << "beside the surface";
  // Where the one's ends and the other's begins lies a corner, though the cylinder has none.
  double border = -8;
  for (double z = -5; z > -14; z -= 0.001) {
    if (id(z, 16) == 1u) border = z;
  }
  EXPECT_TRUE(std::abs(border + 8) < 0.002 || std::abs(border + 10) < 0.002) << border;
}

TEST(TurningIds, of_moves_that_cut_equally_deep_the_first_is_kept) {
  for (const bool again : {false, true}) {
    TurnedPart part = marked_bar();
    const TurningTool tool(right_hand(0.4));
    const auto pass = [&](std::uint64_t id) {
      part.cut(tool, line({2, 12}, {-8, 14}, id));
      part.cut(tool, line({-8, 14}, {-15, 14}, id + 1));
      part.cut(tool, arc({-15, 14}, {-15, 18}, -0.25, id + 2));
    };
    pass(10);
    if (again) pass(20);
    const TurnedProfile profile = part.profile();
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < profile[0].size(); ++i) {
      const Vec2 middle = (profile[0][i] + profile[0][(i + 1) % profile[0].size()]) / 2.0;
      if (const auto id = part.cut_id_at(middle, kNear_mm)) seen.insert(*id);
    }
    EXPECT_EQ(seen, (std::set<std::uint32_t>{10, 11, 12}));
  }
}

TEST(TurningIds, a_spring_pass_over_half_of_it_takes_what_is_deeper) {
  TurnedPart part = marked_bar();
  const TurningTool tool(blade(2));
  part.cut(tool, line({5, 16}, {-17, 16}, 1));
  part.cut(tool, line({5, 15.9}, {-6, 15.9}, 2));
  part.cut(tool, line({5, 16}, {-17, 16}, 3));
  EXPECT_EQ(part.cut_id_at({-2, 15.9}, kNear_mm), 2u);
  EXPECT_EQ(part.cut_id_at({-14, 16}, kNear_mm), 1u);
}

TEST(TurningIds, large_numbers_are_named_the_largest) {
  TurnedPart part = marked_bar();
  part.cut(TurningTool(blade(2)), line({-10, 25}, {-10, 15}, 0x1'0000'0005));
  double found = 0;
  for (double z = -13; z < -7; z += 0.01)
    if (part.cut_id_at({z, 15}, kNear_mm)) found = *part.cut_id_at({z, 15}, kNear_mm);
  EXPECT_EQ(found, 0xffff'fffeu);
}

TEST(TurningIds, off_there_are_none_and_parts_are_the_same) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    TurnedPart plain = *TurnedPart::create(bar_profile(-30, 0, 40)), marked = marked_bar();
    for (const TurnMove& move : random_moves(random, 12)) {
      const TurningTool tool(random_tool(random));
      const TurnCut a = plain.cut(tool, move), b = marked.cut(tool, move);
      ASSERT_EQ(a.removed_mm3, b.removed_mm3);
    }
    EXPECT_EQ(plain.digest(), marked.digest());
    EXPECT_FALSE(plain.keeps_cut_ids());
    EXPECT_EQ(plain.cut_id_at({-10, 20}, 100), std::nullopt);
    EXPECT_TRUE(plain.patch(10, 0).cut_by.empty());
  }
}

TEST(TurningIds, they_are_of_moves_that_touch_the_surface) {
  constexpr double kStep_mm = 1e-3, kUnsure_mm = 1.5e-3;
  int cut = 0, uncut = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = marked_bar();
    std::vector<InsertOutline> outlines;
    const std::vector<TurnMove> moves = random_moves(random, 10);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      outlines.push_back(i % 3 == 0 ? random_tool(random) : outlines.back());
      part.cut(TurningTool(outlines.back()), moves[i]);
    }
    for (const std::vector<Vec2>& ring : part.profile()) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = ring[i], b = ring[(i + 1) % ring.size()], p = (a + b) / 2.0;
        if (glm::distance(a, b) < 0.01 || (a.y == 0 && b.y == 0) || random() % 2 != 0) continue;
        std::set<std::uint32_t> may;
        for (std::size_t m = 0; m < moves.size(); ++m) {
          double t = 0;
          const double off = least_distance(outlines[m], moves[m], p, kStep_mm, t);
          if (std::abs(off) < kUnsure_mm) may.insert(static_cast<std::uint32_t>(m));
        }
        const std::optional<std::uint32_t> id = part.cut_id_at(p, 2e-4);
        const bool on_blank = p.x == -30 || p.x == 0 || p.y == 20;
        if (id) {
          ASSERT_TRUE(may.count(*id) == 1)
              << fmt::format("seed {} at z {} r {}: {}", seed, p.x, p.y, *id);
          ++cut;
        } else {
          ASSERT_TRUE(on_blank) << fmt::format("seed {} at z {} r {}", seed, p.x, p.y);
          ++uncut;
        }
      }
    }
  }
  EXPECT_GT(cut, 1500);
  EXPECT_GT(uncut, 20);
}

CutMove move(double z0, double x0, double z1, double x1, std::uint64_t id) {
  CutMove made;
  made.from_mm = {x0, 0, z0};
  made.to_mm = {x1, 0, z1};
  made.id = id;
  return made;
}

TEST(TurningIds, the_stock_tells_them_at_points_of_its_patches) {
  TurningStock stock(*TurnedPart::create(bar_profile(-64, 0, 40)));
  stock.keep_cut_ids(true);
  EXPECT_TRUE(stock.keeps_cut_ids());
  const Cutter tool = Cutter::from_insert("turn:0.4:2:85:30", right_hand(0.4));
  std::vector<CutReport> reports;
  const std::vector<CutMove> moves{move(2, 15, -20.3, 15, 7), move(-20.3, 15, -30.6, 18.5, 8),
                                   move(-30.6, 18.5, -31, 25, 9)};
  stock.cut(tool, moves, reports);
  const std::unique_ptr<StockModel> frame = stock.snapshot();
  EXPECT_TRUE(frame->keeps_cut_ids());
  std::set<std::uint32_t> seen;
  int off_by_one = 0, vertices = 0;
  for (std::uint32_t t = 0; t < frame->tile_count(); ++t) {
    for (int level = 0; level < 2; ++level) {
      const MeshPatch patch = frame->patch(t, level);
      ASSERT_EQ(patch.cut_by.size(), patch.vertices.size());
      seen.insert(patch.cut_by.begin(), patch.cut_by.end());
    }
    // Middles of triangles have the id of their corners.
    const MeshPatch patch = frame->patch(t, 0);
    for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
      glm::vec3 middle(0);
      std::set<std::uint32_t> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        middle += patch.vertices[patch.indices[i + k]].position_mm / 3.0f;
        corners.insert(patch.cut_by[patch.indices[i + k]]);
      }
      ASSERT_EQ(corners.size(), 1u);
      const std::uint32_t id = frame->cut_id_at(Vec3(middle)).value_or(MeshPatch::kNotCut);
      ++vertices;
      off_by_one += id != *corners.begin();
    }
  }
  // From afar as well: points of a patch of level 3 may be 0.4 mm off.
  int unlike = 0, far_vertices = 0;
  for (std::uint32_t t = 0; t < frame->tile_count(); ++t) {
    const MeshPatch patch = frame->patch(t, 3);
    for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
      glm::vec3 middle(0);
      for (std::size_t k = 0; k < 3; ++k)
        middle += patch.vertices[patch.indices[i + k]].position_mm / 3.0f;
      ++far_vertices;
      unlike += frame->cut_id_at(Vec3(middle)).value_or(MeshPatch::kNotCut) !=
                patch.cut_by[patch.indices[i]];
    }
  }
  EXPECT_GT(far_vertices, 2000);
  EXPECT_LT(unlike, far_vertices / 20);
  EXPECT_EQ(seen, (std::set<std::uint32_t>{7, 8, 9, MeshPatch::kNotCut}));
  EXPECT_GT(vertices, 20000);
  EXPECT_LT(off_by_one, vertices / 100) << "near corners another surface is as near";
  EXPECT_EQ(stock.cut_id_at({15, 0, -10}), 7u);
  EXPECT_EQ(stock.cut_id_at({0, -15, -10}), 7u);
  EXPECT_EQ(stock.cut_id_at({20, 0, -50}), std::nullopt);
  EXPECT_EQ(stock.cut_id_at({30, 0, -50}), std::nullopt);
  // A snapshot keeps what it had.
  const CutMove deeper = move(2, 14, -20, 14, 10);
  stock.cut(tool, {&deeper, 1}, reports);
  EXPECT_EQ(stock.cut_id_at({14, 0, -10}), 10u);
  EXPECT_EQ(frame->cut_id_at({15, 0, -10}), 7u);
  EXPECT_FALSE(stock.differing_tiles(*frame).empty());
  stock.keep_cut_ids(false);
  EXPECT_EQ(stock.cut_id_at({14, 0, -10}), std::nullopt);
}

TEST(TurningIds, in_any_calls_they_are_the_same) {
  std::string all;
  for (const std::size_t size : {std::size_t{1}, std::size_t{4}, std::size_t{40}}) {
    TurningStock stock(*TurnedPart::create(bar_profile(-64, 0, 40)));
    stock.keep_cut_ids(true);
    std::vector<CutMove> moves;
    for (int i = 0; i < 40; ++i)
      moves.push_back(
          move(2 - i % 7, 19 - 0.3 * i, -5 - i, 19 - 0.28 * i, 100u + static_cast<unsigned>(i)));
    std::vector<CutReport> reports;
    const Cutter tool = Cutter::from_insert("turn:0.4:2:85:30", right_hand(0.4));
    for (std::size_t i = 0; i < moves.size(); i += size)
      stock.cut(tool, std::span(moves).subspan(i, std::min(size, moves.size() - i)), reports);
    std::string ids;
    for (std::uint32_t t = 0; t < stock.tile_count(); ++t) {
      for (const std::uint32_t id : stock.patch(t, 0).cut_by) ids += std::to_string(id) + ' ';
    }
    if (all.empty()) all = ids;
    EXPECT_EQ(ids, all);
  }
}

TEST(TurningIds, what_falls_has_none_any_more) {
  TurnedPart part = marked_bar();
  const TurningTool parting(blade(2));
  part.cut(parting, line({5, 16}, {-4, 16}, 1));
  part.cut(parting, line({-12, 25}, {-12, -1}, 2));
  ASSERT_EQ(part.freed().size(), 1u);
  EXPECT_EQ(part.cut_id_at({-3, 16}, kNear_mm), std::nullopt);
  std::set<std::uint32_t> face;
  for (double z = -16; z < -8; z += 0.0001)
    if (const auto id = part.cut_id_at({z, 7}, kNear_mm)) face.insert(*id);
  EXPECT_EQ(face, (std::set<std::uint32_t>{2}));
}

}  // namespace
}  // namespace kerf
