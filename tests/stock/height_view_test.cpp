// The heights of a Z-map as a view gets them.
#include "stock/zmap/height_view.h"

#include <gtest/gtest.h>

#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

TEST(HeightView, HasTheHeightsOfTheMap) {
  const std::unique_ptr<ZMap> map = test::make_map("box:-3,5,-8:17,20,1", 0.13);
  std::mt19937 random(1);
  test::cut(*map, *parse_shape("ball:4"), test::random_path(random, map->bounds_mm(), 60));
  test::finish(*map);
  const std::shared_ptr<const HeightGrid> grid = map->height_grid();
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->nx(), map->nx());
  ASSERT_EQ(grid->ny(), map->ny());
  EXPECT_EQ(grid->bounds_mm(), map->bounds_mm());
  EXPECT_EQ(static_cast<std::size_t>(grid->tiles_x() * grid->tiles_y()), map->tile_count());
  for (int j = 0; j < grid->ny(); ++j)
    for (int i = 0; i < grid->nx(); ++i) ASSERT_EQ(grid->height(i, j), map->height_mm(i, j));
}

TEST(HeightView, StaysAsItWasAndSharesWhatHasNotChanged) {
  std::unique_ptr<ZMap> map = test::make_map("box:0,0,-8:20,20,0", 0.1);
  const std::shared_ptr<const HeightGrid> before = map->height_grid();
  test::cut(*map, *parse_shape("flat:2"), {test::line(Vec3(3, 3, -2), Vec3(5, 3, -2))});
  test::finish(*map);
  const std::shared_ptr<const HeightGrid> after = map->snapshot()->height_grid();
  map.reset();
  EXPECT_EQ(before->height(40, 30), 0.0f);
  EXPECT_EQ(after->height(40, 30), -2.0f);
  // The cut lies within the first tile of 6.4 mm.
  for (int ty = 0; ty < before->tiles_y(); ++ty)
    for (int tx = 0; tx < before->tiles_x(); ++tx)
      EXPECT_EQ(before->tile(tx, ty) == after->tile(tx, ty), tx + ty > 0) << tx << " " << ty;
}

}  // namespace
}  // namespace kerf
