#include "twin/playback/packed_column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace kerf {
namespace {

using Of = PackedColumn::Of;

void expect_kept(Of of, const std::vector<std::uint64_t>& values) {
  PackedColumn column(of);
  for (const std::uint64_t value : values) column.push(value);
  ASSERT_EQ(column.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(column.at(i), values[i]) << i;
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
  return bits;
}

TEST(PackedColumn, IntegersOfEveryWidthComeBack) {
  std::mt19937_64 random(1);
  for (const std::uint64_t range :
       {std::uint64_t{1}, std::uint64_t{200}, std::uint64_t{60'000}, std::uint64_t{1} << 23,
        std::uint64_t{1} << 31, std::uint64_t{1} << 39, std::uint64_t{1} << 47,
        std::uint64_t{1} << 55, std::numeric_limits<std::uint64_t>::max()}) {
    std::vector<std::uint64_t> values;
    for (int i = 0; i < 1000; ++i) values.push_back(range / 3 + random() % range);
    expect_kept(Of::kIntegers, values);
    expect_kept(Of::kReals, values);
  }
}

TEST(PackedColumn, DecimalsAndAllOtherNumbersComeBackBitForBit) {
  std::mt19937_64 random(2);
  std::vector<double> decimals;
  for (int i = 0; i < 2000; ++i) {
    decimals.push_back(static_cast<double>(static_cast<int>(random() % 4'000'001) - 2'000'000) /
                       1e4);
  }
  expect_kept(Of::kReals, bits_of(decimals));
  std::vector<double> with_odd_ones = decimals;
  with_odd_ones[300] = -0.0;
  with_odd_ones[700] = std::numeric_limits<double>::quiet_NaN();
  with_odd_ones[900] = -std::numeric_limits<double>::infinity();
  with_odd_ones[1100] = 1e300;
  with_odd_ones[1400] = 5e-324;
  with_odd_ones[1700] = 25.4 * 0.1234;
  expect_kept(Of::kReals, bits_of(with_odd_ones));
  // Almost a decimal: the next double up.
  for (double& number : with_odd_ones) number = std::nextafter(number, 1e9);
  expect_kept(Of::kReals, bits_of(with_odd_ones));
}

TEST(PackedColumn, TakesWhatTheNumbersNeed) {
  constexpr std::size_t kMany = 100 * PackedColumn::kBlock;
  PackedColumn constant(Of::kReals), rows(Of::kReals), decimals(Of::kReals), wild(Of::kReals);
  PackedColumn near(Of::kReals), table(Of::kReals);
  std::mt19937_64 random(3);
  for (std::size_t i = 0; i < kMany; ++i) {
    constant.push_real(std::sqrt(2.0));
    rows.push_real(static_cast<double>(i % 5) / 1e4);
    decimals.push_real(static_cast<double>(random() % 50'000) / 1e4);
    wild.push(random());
    near.push_real(1 + std::sqrt(static_cast<double>(i % 50)) / 0x1p20);  // 35 bits differ
    table.push_real(static_cast<double>(random() % 2'000'000) / 1e4);
  }
  for (PackedColumn* column : {&constant, &rows, &decimals, &wild, &near, &table}) column->shrink();
  const std::size_t heads = constant.bytes();
  EXPECT_LT(heads, sizeof(PackedColumn) + 100 * 24 + 1);
  EXPECT_EQ(rows.bytes(), heads + kMany);
  EXPECT_EQ(decimals.bytes(), heads + 2 * kMany);
  EXPECT_EQ(table.bytes(), heads + 3 * kMany);
  EXPECT_EQ(near.bytes(), heads + 5 * kMany);
  EXPECT_EQ(wild.bytes(), heads + 8 * kMany);
}

}  // namespace
}  // namespace kerf
