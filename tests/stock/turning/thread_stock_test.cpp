// The contract of stock models, with moves that have a lead.
#include <gtest/gtest.h>

#include <cmath>

#include "stock/turning/turning_stock.h"
#include "tests/stock/turning/turning_samples.h"

namespace kerf {
namespace {

using namespace turning_test;

Cutter thread_tool() {
  return Cutter::from_insert("thread:60", *thread_insert({radians(60), 0.2, 3, 6}));
}

TurningStock long_bar() { return TurningStock(*TurnedPart::create(bar_profile(-64, 0, 40))); }

/// Passes of a thread, each deeper, with ways in and out.
std::vector<CutMove> passes() {
  std::vector<CutMove> moves;
  Vec3 at(30, 0, 5);
  const auto go = [&](double x, double z, double lead = 0) {
    CutMove move;
    move.from_mm = at;
    move.to_mm = at = {x, 0, z};
    move.id = moves.size() + 100;
    move.lead_mm = lead;
    moves.push_back(move);
  };
  for (const double x : {19.6, 19.2, 18.8}) {
    go(x, 5);
    go(x, -30, 2.5);
    go(x + 2, -32, 3);
    go(25, -32);
    go(25, 5);
  }
  return moves;
}

TEST(ThreadStock, moves_in_any_calls_have_equal_bits_and_reports) {
  const std::vector<CutMove> moves = passes();
  for (const bool keeps_ids : {false, true}) {
    std::string digest;
    std::vector<CutReport> whole;
    for (const std::size_t size : {moves.size(), std::size_t{1}, std::size_t{4}}) {
      TurningStock stock = long_bar();
      stock.keep_cut_ids(keeps_ids);
      std::vector<CutReport> reports;
      double removed = 0;
      for (std::size_t i = 0; i < moves.size(); i += size) {
        stock.cut(thread_tool(), std::span(moves).subspan(i, std::min(size, moves.size() - i)),
                  reports);
        stock.finish(reports);
        // A snapshot goes on as the model does.
        TurningStock next(static_cast<const TurningStock&>(*stock.snapshot()).part());
        EXPECT_EQ(next.digest(), stock.digest());
      }
      ASSERT_EQ(reports.size(), moves.size());
      for (const CutReport& report : reports) removed += report.removed_mm3;
      EXPECT_NEAR(removed, stock.blank_mm3() - stock.remaining_mm3(), 1e-6);
      if (whole.empty()) {
        whole = reports;
        digest = stock.digest();
      }
      EXPECT_EQ(stock.digest(), digest);
      for (std::size_t i = 0; i < moves.size(); ++i) {
        EXPECT_EQ(reports[i].removed_mm3, whole[i].removed_mm3) << i;
        EXPECT_EQ(reports[i].depth_mm, whole[i].depth_mm) << i;
      }
    }
  }
}

TEST(ThreadStock, ways_out_and_back_touch_nothing) {
  TurningStock stock = long_bar();
  std::vector<CutReport> reports;
  for (const CutMove& move : passes()) {
    if (move.lead_mm == 0) {
      EXPECT_FALSE(stock.first_contact(thread_tool(), move, 0.01)) << move.id;
    }
    stock.cut(thread_tool(), {&move, 1}, reports);
  }
}

TEST(ThreadStock, flanks_know_the_move_that_made_them) {
  TurningStock stock = long_bar();
  stock.keep_cut_ids(true);
  std::vector<CutReport> reports;
  const std::vector<CutMove> moves = passes();
  stock.cut(thread_tool(), moves, reports);
  std::size_t of_thread = 0, of_blank = 0, other = 0;
  for (std::uint32_t t = 40; t < 60; ++t) {
    const MeshPatch patch = stock.patch(t, 0);
    ASSERT_EQ(patch.cut_by.size(), patch.vertices.size());
    for (std::size_t i = 0; i < patch.vertices.size(); i += 7) {
      const glm::vec3& p = patch.vertices[i].position_mm;
      const double r = std::hypot(p.x, p.y);
      if (r > 18.82 && r < 19.9) {
        // The last pass, whose way is the second of its five.
        ++(patch.cut_by[i] == moves[11].id ? of_thread : other);
        EXPECT_EQ(stock.cut_id_at(p), patch.cut_by[i]);
      }
      if (patch.cut_by[i] == MeshPatch::kNotCut) ++of_blank;
    }
  }
  EXPECT_GT(of_thread, 200u);
  EXPECT_EQ(other, 0u);
  EXPECT_GT(of_blank, 500u);
}

}  // namespace
}  // namespace kerf
