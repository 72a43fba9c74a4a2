#include "base/geometry.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(Box, starts_empty_and_grows_from_a_point) {
  Box box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.volume_mm3(), 0.0);
  box.extend(Vec3{1, 2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.volume_mm3(), 0.0);
  box.extend(Vec3{-1, 5, 3.5});
  EXPECT_EQ(box.min, (Vec3{-1, 2, 3}));
  EXPECT_EQ(box.max, (Vec3{1, 5, 3.5}));
  EXPECT_EQ(box.size(), (Vec3{2, 3, 0.5}));
  EXPECT_EQ(box.volume_mm3(), 3.0);
}

TEST(Box, extending_by_an_empty_box_changes_nothing) {
  Box box{{0, 0, 0}, {1, 1, 1}};
  box.extend(Box{});
  EXPECT_EQ(box, (Box{{0, 0, 0}, {1, 1, 1}}));
  box.extend(Box{{-2, 0.5, 0}, {-1, 4, 1}});
  EXPECT_EQ(box, (Box{{-2, 0, 0}, {1, 4, 1}}));
}

TEST(Box, is_empty_if_any_axis_is) {
  EXPECT_TRUE((Box{{0, 0, 1}, {1, 1, 0}}).empty());
  EXPECT_EQ((Box{{0, 0, 1}, {1, 1, 0}}).volume_mm3(), 0.0);
}

}  // namespace
}  // namespace kerf
