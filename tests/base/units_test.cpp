#include "base/units.h"

#include <gtest/gtest.h>

#include "base/geometry.h"
#include "base/length_unit.h"

namespace kerf {
namespace {

TEST(Units, AreOneAnothersAndThoseOfGeometry) {
  EXPECT_EQ(kMmPerInch, 25.4);
  EXPECT_EQ(kRadPerDeg, kPi / 180.0);
  EXPECT_EQ(kDegPerRad, 180.0 / kPi);
  EXPECT_EQ(mm_of_unit(true), mm_of(LengthUnit::kInch));
  EXPECT_EQ(mm_of_unit(false), mm_of(LengthUnit::kMm));
}

TEST(Units, OfInchesAreMmAsTheyAreWritten) {
  EXPECT_EQ(to_mm(0.3, LengthUnit::kInch), 7.62);
  EXPECT_EQ(from_mm(50.8, LengthUnit::kInch), 2.0);
  EXPECT_EQ(to_mm(0.3, LengthUnit::kMm), 0.3);
  EXPECT_STREQ(name_of(LengthUnit::kInch), "in");
  EXPECT_STREQ(name_of(LengthUnit::kMm), "mm");
}

}  // namespace
}  // namespace kerf
