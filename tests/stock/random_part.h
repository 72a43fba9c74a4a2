// tests/stock/random_part.h - workpieces with something of everything, for tests of views.
#pragma once

#include <memory>

#include "tests/stock/stock_samples.h"

namespace kerf::test {

/// A workpiece with pockets, slots, bowls and, if `through`, holes down to nothing.
inline std::unique_ptr<ZMap> random_part(unsigned seed, double cell_mm, bool through = false) {
  std::mt19937 random(seed);
  std::unique_ptr<ZMap> map = make_map("box:0,0,-8:24,18,0", cell_mm);
  const char* const shapes[] = {"flat:4", "ball:5", "vee:8:90", "bull:5:1"};
  for (int n = 0; n < 3; ++n) {
    const Box room{Vec3(-1, -1, through ? -9 : -6), Vec3(25, 19, -0.5)};
    const Result<Cutter> cutter = parse_shape(shapes[(seed + static_cast<unsigned>(n)) % 4]);
    EXPECT_TRUE(cutter) << cutter.error();
    cut(*map, *cutter, random_path(random, room, 40));
    finish(*map);
  }
  return map;
}

}  // namespace kerf::test
