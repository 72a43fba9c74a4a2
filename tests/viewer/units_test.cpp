#include "viewer/window/units.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(Measures, Millimetres) {
  const Measures mm(LengthUnit::kMm);
  EXPECT_EQ(mm.position(12.5), "12.500");
  EXPECT_EQ(mm.length(12.3456), "12.346 mm");
  EXPECT_EQ(mm.length(-3, 1), "-3.0 mm");
  EXPECT_EQ(mm.signed_length(0.02), "+0.020 mm");
  EXPECT_EQ(mm.feed(1500), "1500 mm/min");
  EXPECT_EQ(mm.feeds(1480.4, 1500), "1480 / 1500 mm/min");
  EXPECT_EQ(mm.volume(12345), "12.3 cm³");
  EXPECT_EQ(mm.rate_up_to(120), "<= 120 mm³/s");
}

TEST(Measures, Inches) {
  const Measures inch(LengthUnit::kInch);
  EXPECT_EQ(inch.position(12.7), "0.5000");
  EXPECT_EQ(inch.length(25.4), "1.0000 in");
  EXPECT_EQ(inch.length(-2.54, 1), "-0.1 in");
  EXPECT_EQ(inch.signed_length(-0.0254), "-0.0010 in");
  EXPECT_EQ(inch.feed(1500), "59.1 in/min");  // 1500 / 25.4 = 59.055
  EXPECT_EQ(inch.feeds(1270, 1524), "50.0 / 60.0 in/min");
  EXPECT_EQ(inch.volume(16387.064), "1.000 in³");       // 25.4^3
  EXPECT_EQ(inch.rate_up_to(120), "<= 0.00732 in³/s");  // 120 / 16387.064 = 0.0073228
}

TEST(Measures, AZeroHasNoSign) {
  const Measures mm(LengthUnit::kMm);
  EXPECT_EQ(mm.position(-0.0004), "0.000");
  EXPECT_EQ(mm.signed_length(-0.0004), "0.000 mm");
  EXPECT_EQ(mm.signed_length(0.0), "0.000 mm");
  EXPECT_EQ(mm.position(-0.0006), "-0.001");
}

TEST(Measures, StepsAreToldApart) {
  EXPECT_EQ(Measures(LengthUnit::kMm).digits_for(0.05), 3);
  EXPECT_EQ(Measures(LengthUnit::kMm).digits_for(5), 1);
  EXPECT_EQ(Measures(LengthUnit::kMm).digits_for(40), 0);
  EXPECT_EQ(Measures(LengthUnit::kInch).digits_for(0.05), 4);  // 0.00197 in
  EXPECT_EQ(Measures(LengthUnit::kInch).digits_for(0), 6);
}

}  // namespace
}  // namespace kerf
