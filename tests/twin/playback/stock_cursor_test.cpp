#include "twin/playback/stock_cursor.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/twin/playback/tracks.h"
#include "twin/findings/finding_json.h"
#include "twin/playback/frontier.h"

namespace kerf {
namespace {

/// A program cut once to its end, and a cursor to go about in it.
struct Shop {
  Shop(std::span<const Motion> motions, std::size_t budget_bytes, double finest_s)
      : track(test::track_of(motions)),
        store(budget_bytes, finest_s),
        frontier(*track, test::block_40(), test::two_tools(), TimelineOptions{}, store),
        cursor(*track, frontier.moves(), frontier.record(), store) {
    while (!frontier.complete()) frontier.advance(track->size());
  }

  std::string digest_at(std::size_t motion) {
    while (!cursor.approach(motion)) {
    }
    return cursor.picture(0)->digest();
  }

  std::shared_ptr<const ProgramTrack> track;
  KeyframeStore store;
  Frontier frontier;
  StockCursor cursor;
};

constexpr std::size_t kPlenty = std::size_t{1} << 30;

/// Of every program: many places, forward and back, against what one dry run shows as it passes
/// them; and one of them against a dry run that ends there.
void expect_dry_run_everywhere(unsigned seed, std::size_t budget_bytes) {
  constexpr int kPlaces = 60, kWholeRuns = 1;
  const std::vector<Motion> motions = test::varied_program(seed, 600);
  Shop shop(motions, budget_bytes, 1e-5);
  std::mt19937 random(seed + 100);
  const std::vector<std::size_t> places = test::random_places(random, motions.size(), kPlaces);
  const auto expected = test::digests_after(motions, places);
  for (const std::size_t place : places) {
    ASSERT_EQ(shop.digest_at(place), expected.at(place)) << "seed " << seed << ", motion " << place;
  }
  for (const std::size_t place : std::span(places).first(kWholeRuns)) {
    ASSERT_EQ(test::digest_after(motions, place), expected.at(place)) << "motion " << place;
  }
}

TEST(StockCursor, EveryPlaceIsWhatADryRunLeaves) {
  for (unsigned seed = 1; seed <= 4; ++seed) expect_dry_run_everywhere(seed, kPlenty);
}

TEST(StockCursor, WithFewKeyframesToo) {
  for (unsigned seed = 11; seed <= 12; ++seed) expect_dry_run_everywhere(seed, 3'000'000);
}

TEST(StockCursor, TheOrderOfSeeksDoesNotMatter) {
  const std::vector<Motion> motions = test::varied_program(21, 2500);
  Shop shop(motions, 8'000'000, 1e-5);
  EXPECT_GT(shop.store.count(), 3U);
  std::mt19937 random(22);
  std::map<std::size_t, std::string> seen;
  for (int n = 0; n < 300; ++n) {
    const std::size_t place = random() % 100 * (motions.size() / 100);
    const std::string digest = shop.digest_at(place);
    const auto [entry, fresh] = seen.try_emplace(place, digest);
    ASSERT_EQ(entry->second, digest) << place;
  }
}

/// Keyframes are packed: what comes out of them has the numbers of moves as well, whatever there
/// are of them and wherever the cursor comes from.
TEST(StockCursor, WhichMoveCutACellDoesNotDependOnKeyframes) {
  const std::vector<Motion> motions = test::varied_program(51, 1500);
  const auto track = test::track_of(motions);
  std::mt19937 random(52);
  const std::vector<std::size_t> places = test::random_places(random, motions.size(), 25);
  std::vector<std::vector<std::uint32_t>> expected;
  for (const std::size_t budget_bytes : {std::size_t{0}, std::size_t{3'000'000}, kPlenty}) {
    auto blank = test::block_40();
    blank->keep_cut_ids(true);
    KeyframeStore store(budget_bytes, 1e-5);
    Frontier frontier(*track, std::move(blank), test::two_tools(), {}, store);
    while (!frontier.complete()) frontier.advance(track->size());
    EXPECT_EQ(store.count() == 1, budget_bytes == 0);
    EXPECT_LE(store.bytes(), budget_bytes);
    StockCursor cursor(*track, frontier.moves(), frontier.record(), store);
    for (std::size_t n = 0; n < places.size(); ++n) {
      while (!cursor.approach(places[n])) {
      }
      const auto seen = cursor.picture(0);
      const auto& map = dynamic_cast<const ZMap&>(*seen);
      std::vector<std::uint32_t> ids;
      for (int j = 0; j < map.ny(); ++j) {
        for (int i = 0; i < map.nx(); ++i) ids.push_back(map.present_cut_id(i, j));
      }
      if (budget_bytes == 0) {
        expected.push_back(std::move(ids));
      } else {
        ASSERT_EQ(ids, expected[n]) << "motion " << places[n] << ", " << store.count();
      }
      EXPECT_LE(store.bytes(), budget_bytes);
    }
  }
}

TEST(StockCursor, SmoothRunsWithoutEndGetASeamAndStayExact) {
  std::vector<Motion> motions;
  MotionList program;
  program.at({20, 20, 1}).tool(1).spindle(true);
  for (int i = 0; i < 120'000; ++i) {
    const double angle = i * 0.02;
    program.feed({20 + 15 * std::cos(angle), 20 + 15 * std::sin(angle), 1 - i * 5e-5});
  }
  Shop shop(program.list(), kPlenty, 1e-5);
  EXPECT_GE(shop.store.count(), 3U);
  const std::size_t end = program.list().size();
  const std::string whole = shop.digest_at(end);
  const std::string half = shop.digest_at(end / 2);
  EXPECT_NE(whole, half);
  Shop single(program.list(), 0, 1e-5);
  EXPECT_EQ(single.store.count(), 1U);
  EXPECT_EQ(single.digest_at(end / 2), half);
  EXPECT_EQ(single.digest_at(end), whole);
}

TEST(StockCursor, PartOfAMoveIsInThePictureOnly) {
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true).feed({-5, 20, -2}).feed({45, 20, -2});
  Shop shop(program.list(), kPlenty, 1e-5);
  const std::string before = shop.digest_at(2);
  const auto half = shop.cursor.picture(0.5);
  MotionList shorter;
  shorter.at({-5, 20, 5}).tool(1).spindle(true).feed({-5, 20, -2}).feed({20, 20, -2});
  EXPECT_EQ(half->digest(), test::digest_after(shorter.list(), 3));
  EXPECT_EQ(shop.digest_at(2), before);
  EXPECT_EQ(shop.digest_at(3), test::digest_after(program.list(), 3));
}

TEST(StockCursor, AShankThatCutsDoesSoHereAsInADryRun) {
  MotionList program;
  program.at({20, 20, 5}).tool(1).spindle(true).feed({20, 20, -6}).feed({30, 20, -6});
  ToolSources tools;
  tools.arguments.push_back(parse_tool_argument("1=flat:4:flute=2:shank=8").value());
  const auto track = test::track_of(program.list());
  std::map<bool, double> removed_mm3;
  for (const bool by_shank : {false, true}) {
    CheckOptions checks;
    checks.collisions.cut_by_shank = by_shank;
    KeyframeStore store(kPlenty);
    Frontier frontier(*track, test::block_40(), tools, {}, store, {}, *default_process(), {},
                      checks);
    while (!frontier.complete()) frontier.advance(track->size());
    StockCursor cursor(*track, frontier.moves(), frontier.record(), store);
    while (!cursor.approach(program.list().size())) {
    }
    const auto seen = cursor.picture(0);
    removed_mm3[by_shank] = seen->blank_mm3() - seen->remaining_mm3();
    EXPECT_EQ(frontier.findings().kept().size(), 1u);  // told all the same
  }
  // Slots of 10 mm with round ends: 6 mm deep by the cutter; 4 mm deep by its shank.
  EXPECT_NEAR(removed_mm3[false], 6 * (40 + 4 * kPi), 3);
  EXPECT_NEAR(removed_mm3[true], 6 * (40 + 4 * kPi) + 4 * (40 + 12 * kPi), 3);
}

TEST(Frontier, FindsWhatADryRunFinds) {
  for (unsigned seed = 31; seed <= 33; ++seed) {
    const std::vector<Motion> motions = test::varied_program(seed, 500);
    std::vector<Finding> expected;
    test::digest_after(motions, motions.size(), &expected);
    const Shop shop(motions, kPlenty, 1e-5);
    const std::vector<Finding>& found = shop.frontier.findings().kept();
    ASSERT_EQ(found.size(), expected.size()) << seed;
    EXPECT_GT(found.size(), 1U);
    const std::vector<std::string> files{"part.ngc"};
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(finding_json(found[i], files).dump(), finding_json(expected[i], files).dump());
    }
  }
}

TEST(Frontier, StopsWhereItIsTold) {
  const std::vector<Motion> motions = test::varied_program(41, 1200);
  const auto track = test::track_of(motions);
  KeyframeStore store(kPlenty);
  Frontier frontier(*track, test::block_40(), test::two_tools(), {}, store);
  while (frontier.reached() < 534) frontier.advance(534);
  EXPECT_EQ(frontier.reached(), 534U);
  EXPECT_FALSE(frontier.complete());
  StockCursor cursor(*track, frontier.moves(), frontier.record(), store);
  while (!cursor.approach(534)) {
  }
  EXPECT_EQ(cursor.picture(0)->digest(), test::digest_after(motions, 534));
  while (!frontier.complete()) frontier.advance(track->size());
  while (!cursor.approach(motions.size())) {
  }
  EXPECT_EQ(cursor.picture(0)->digest(), test::digest_after(motions, motions.size()));
}

}  // namespace
}  // namespace kerf
