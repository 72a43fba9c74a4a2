// Materials: found by any of their names, kc11 by the rake.
#include "cutting/material.h"

#include <gtest/gtest.h>

#include <vector>

namespace kerf {
namespace {

std::vector<Material> two() {
  Material steel;
  steel.name = "steel-mild";
  steel.aliases = {"s235", "1018"};
  steel.kc11_n_per_mm2 = {1388, 2160, 2900};
  steel.mc = 0.2;
  steel.rake_deg = 6;
  Material brass;
  brass.name = "brass";
  brass.kc11_n_per_mm2 = {400, 530, 700};
  return {steel, brass};
}

TEST(Material, IsFoundByAnyOfItsNames) {
  const std::vector<Material> all = two();
  for (const char* name : {"steel-mild", "Steel Mild", "STEEL_MILD", "s235", "1018"})
    EXPECT_EQ(find_material(all, name), &all[0]) << name;
  EXPECT_EQ(find_material(all, "brass"), &all[1]);
  EXPECT_EQ(find_material(all, "steel"), nullptr);
}

TEST(Material, UnknownOnesNameTheNearest) {
  const std::vector<Material> all = two();
  EXPECT_EQ(need_material(all, "bras").error(),
            "there is no material 'bras'; did you mean 'brass'?");
  EXPECT_EQ(need_material(all, "unobtainium").error(),
            "there is no material 'unobtainium'; there are: steel-mild, brass");
}

/// FreeCAD's card of mild steel says 2298 at rake 0, the book 1800 * 1.2 = 2160 at 6 degrees.
TEST(Material, ADegreeMoreRakeIsAHundredthLess) {
  const Material steel = two()[0];
  EXPECT_EQ(kc11_at_rake(steel, {}), steel.kc11_n_per_mm2);
  EXPECT_NEAR(kc11_at_rake(steel, 0).nominal, 2298, 0.5);
  EXPECT_NEAR(kc11_at_rake(steel, 16).nominal, 2160 * 0.84 / 0.94, 1e-9);
}

}  // namespace
}  // namespace kerf
