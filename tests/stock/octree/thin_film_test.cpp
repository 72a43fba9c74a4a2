// Films: what of a cut is too thin for the octree is told, with its area and place; what is not a
// film is not.
#include <gtest/gtest.h>

#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

const std::string kBlank = "box:0,0,-12:30,20,0";

double film_mm2(const std::vector<CutReport>& reports) {
  double sum = 0;
  for (const CutReport& report : reports) sum += report.film.area_mm2;
  return sum;
}

std::vector<CutReport> cut_film(const std::string& shape, const std::vector<CutMove>& moves,
                                double cell = 0.25) {
  const auto tree = make_octree(kBlank, cell);
  return cut(*tree, make_cutter(shape), moves);
}

TEST(ThinFilm, RoofOfATSlotHasItsAreaThicknessAndPlace) {
  // A head of 10 mm, 4 high, and a neck of 5 mm: 2 x 2.5 mm of roof over 30 mm.
  const auto reports = cut_film("tslot:10:4:5", {line({-10, 10, -4.085}, {40, 10, -4.085}, 7)});
  const CutFilm& film = reports[0].film;
  EXPECT_NEAR(film.area_mm2, 150, 0.1 * 150);
  EXPECT_NEAR(film.thickness_mm, 0.085, 1e-3);
  EXPECT_NEAR(film.at_mm.z, 0, 1e-3);
  EXPECT_EQ(reports[0].id, 7u);
}

TEST(ThinFilm, ThickRoofIsNone) {
  for (const double roof : {0.3, 1.0})
    EXPECT_EQ(film_mm2(cut_film("tslot:10:4:5", {line({-10, 10, -4 - roof}, {40, 10, -4 - roof})})),
              0)
        << roof;
}

// 0.01 mm is none: positions are rounded.
TEST(ThinFilm, FloorFromTheLeastFilmOn) {
  const auto left = [](double floor) {
    return film_mm2(cut_film("flat:8", {line({10, 10, 1}, {10, 10, -12 + floor}, 1),
                                        line({10, 10, -12 + floor}, {20, 10, -12 + floor}, 2)}));
  };
  EXPECT_EQ(left(0), 0);
  EXPECT_EQ(left(0.009), 0);
  EXPECT_NEAR(left(0.02), kPi * 16 + 80, 10);
  EXPECT_NEAR(left(0.1), kPi * 16 + 80, 10);
  EXPECT_EQ(left(0.5), 0);
}

// Both tilted by the same lean, so that the wall meets edges along each axis.
TEST(ThinFilm, SlantingWall) {
  for (const double lean : {0.0, 0.3, 0.7}) {
    const Vec3 axis{0, -std::sin(lean), std::cos(lean)};
    const Vec3 across{0, std::cos(lean), std::sin(lean)};
    const Vec3 tip{-5, 8, -5};
    const auto slot = [&](double aside, std::uint64_t id) {
      const Vec3 from = tip + aside * across;
      return line(from, from + Vec3(40, 0, 0), id, axis);
    };
    const auto wall = cut_film("flat:3", {slot(0, 1), slot(3.1, 2)});
    EXPECT_EQ(wall[0].film.area_mm2, 0) << lean;
    // 5 mm high, less what reaches into a brick by a row; more where it leans; where it slants
    // through the grid a node here and there lies in it and is kept, and bricks that keep many are
    // silent.
    EXPECT_GT(wall[1].film.area_mm2, lean == 0 ? 135 : 40) << lean;
    EXPECT_LT(wall[1].film.area_mm2, 160 / std::cos(lean)) << lean;
    EXPECT_NEAR(wall[1].film.thickness_mm, 0.1, 0.002) << lean;
    EXPECT_EQ(film_mm2(cut_film("flat:3", {slot(0, 1), slot(4, 2)})), 0) << lean;
  }
}

TEST(ThinFilm, LayersThinnerThanACellAreNone) {
  std::vector<CutMove> moves;
  for (int n = 1; n <= 6; ++n) moves.push_back(line({-30, 10, -0.1 * n}, {60, 10, -0.1 * n}));
  EXPECT_EQ(film_mm2(cut_film("flat:50", moves)), 0);
  moves.clear();
  for (int n = 1; n <= 6; ++n)
    moves.push_back(line({-10, -5 + 0.1 * n, -6}, {40, -5 + 0.1 * n, -6}));
  EXPECT_EQ(film_mm2(cut_film("flat:10", moves)), 0);
}

// Ridges between passes are no films, nor are the sides of them. (Up to the face at Y20 there would
// be one for a while: the last of a wall.)
TEST(ThinFilm, RidgesAreNone) {
  for (const double stepover : {0.3, 0.7, 1.5, 3.0}) {
    for (const double lean : {0.0, 0.4}) {
      std::vector<CutMove> moves;
      const Vec3 axis{std::sin(lean), 0, std::cos(lean)};
      for (double y = 0; y < 12; y += stepover)
        moves.push_back(line({-5, y, -1}, {35, y + 1, -5}, 0, axis));
      EXPECT_EQ(film_mm2(cut_film("ball:6", moves)), 0) << stepover << ' ' << lean;
    }
  }
}

// What the neck takes, and what a later piece of the same move takes, is not left by the move.
TEST(ThinFilm, WhatTheSameMoveTakesIsNone) {
  // The head is hardly wider than the neck: lips of 0.2 mm.
  EXPECT_EQ(film_mm2(cut_film("tslot:10:4:9.6", {line({-10, 10, -4.085}, {40, 10, -4.085})})), 0);
  // A tilted circle is many chords.
  CutMove circle = line({20, 10, -3}, {20, 10, -3}, 0, glm::normalize(Vec3(0.2, 0, 1)));
  circle.arc = CutArc{{15, 10, -3}, {0, 0, 1}, 2 * kPi};
  EXPECT_EQ(film_mm2(cut_film("flat:6", {circle})), 0);
}

TEST(ThinFilm, CutTwiceIsToldOnce) {
  const CutMove roof = line({-10, 10, -4.085}, {40, 10, -4.085});
  const auto reports = cut_film("tslot:10:4:5", {roof, roof});
  EXPECT_GT(reports[0].film.area_mm2, 100);
  EXPECT_EQ(reports[1].film.area_mm2, 0);
}

// Steps of which none makes an area: told by the same ones, whatever the batches and threads.
TEST(ThinFilm, BatchesAndThreadsTellTheSame) {
  std::vector<CutMove> moves{line({-5, 5, -5}, {35, 5, -5})};
  for (int n = 0; n < 400; ++n) {
    const double x = -5 + 0.1 * n;
    moves.push_back(line({x, 11.1, -5}, {x + 0.1, 11.1, -5}, static_cast<std::uint64_t>(n) + 1));
  }
  const Cutter cutter = make_cutter("flat:6");
  const auto all = make_octree(kBlank, 0.25), single = make_octree(kBlank, 0.25, 3);
  const std::vector<CutReport> reports = cut(*all, cutter, moves);
  std::vector<CutReport> one_by_one;
  for (const CutMove& move : moves) single->cut(cutter, {&move, 1}, one_by_one);
  ASSERT_EQ(reports.size(), one_by_one.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].film.area_mm2, one_by_one[i].film.area_mm2) << i;
    EXPECT_EQ(reports[i].film.thickness_mm, one_by_one[i].film.thickness_mm) << i;
    EXPECT_EQ(reports[i].film.at_mm, one_by_one[i].film.at_mm) << i;
  }
  EXPECT_NEAR(film_mm2(reports), 30 * 5, 0.1 * 150);
}

TEST(ThinFilm, WhereMaterialIsAddedThereIsNone) {
  const auto tree = make_octree(kBlank, 0.25, 1, true);
  EXPECT_EQ(film_mm2(cut(*tree, make_cutter("tslot:10:4:5"),
                         {line({-10, 10, -4.085}, {40, 10, -4.085})})),
            0);
}

}  // namespace
}  // namespace kerf::test
