// Path and workpiece coloured by what moves were like.
#include "twin/scene/value_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

using Rgb = std::array<double, 3>;

/// Fifty cuts of some seconds, and a short one.
std::shared_ptr<const ProgramTrack> rows() {
  MotionList program;
  program.at({0, 0, -1}).tool(1).spindle(true);
  for (int i = 1; i <= 50; ++i) program.feed({i % 2 == 0 ? 0.0 : 40.0, i * 0.5, -1});
  program.feed({0.05, 25, -1});
  return test::track_of(program.list());
}

class ValueColorsTest : public testing::Test {
 protected:
  void note(std::size_t motion, LoadKind kind, double value) {
    CutLoad load;
    load.is_engaged = true;
    load.start_s = track_->start_s(motion);
    load.seconds = track_->end_s(motion) - load.start_s;
    load.set(kind, value);
    record_.on_load(load);
  }
  std::shared_ptr<const CutColors> made(ColorBy mode) {
    return value_colors(mode, *track_, {{}, nullptr, &record_, &wish_});
  }
  std::size_t first() const { return track_->size() - 51; }
  std::size_t last() const { return track_->size() - 1; }

  std::shared_ptr<const ProgramTrack> track_ = rows();
  LoadRecord record_{track_};
  CuttingWish wish_;
};

TEST_F(ValueColorsTest, ClassesAreAsWideAsARoundNumber) {
  for (std::size_t i = 0; i < 50; ++i)
    note(first() + i, LoadKind::kForce, 6.0 * static_cast<double>(i + 1));  // 6 .. 300
  const auto colors = made(ColorBy::kForce);
  ASSERT_EQ(colors->legend.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    ASSERT_TRUE(colors->legend[k].range);
    EXPECT_NEAR(colors->legend[k].range->from, 50.0 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(colors->legend[k].range->to, 50.0 * static_cast<double>(k + 1), 1e-9);
  }
  EXPECT_EQ(colors->of_move[first()], colors->legend[0].color);
  EXPECT_EQ(colors->of_move[first() + 49], colors->legend[5].color);
  EXPECT_EQ(colors->of_move[first() + 8], colors->legend[1].color) << "54 N";
  EXPECT_EQ(colors->of_move[last()], colors->other) << "it has cut nothing";
  EXPECT_EQ(colors->of_move[0], colors->other);
  EXPECT_EQ(colors->mode, ColorBy::kForce);
}

/// 20 N for minutes, 900 for a moment: what lasts is not all of one colour.
TEST_F(ValueColorsTest, APeakDoesNotFlattenTheRest) {
  for (std::size_t i = 0; i < 50; ++i) note(first() + i, LoadKind::kForce, i < 25 ? 10 : 60);
  note(last(), LoadKind::kForce, 900);
  const auto colors = made(ColorBy::kForce);
  EXPECT_NE(colors->of_move[first()], colors->of_move[first() + 30]);
  ASSERT_FALSE(colors->legend.empty());
  EXPECT_EQ(colors->of_move[last()], colors->legend.back().color);
  EXPECT_NEAR(colors->legend.back().range->to, 900, 1e-9) << "the last class says how far it goes";
}

TEST_F(ValueColorsTest, WhatIsAboveALimitHasAColourOfItsOwn) {
  wish_.spindle_power_kw = 2.2;
  for (std::size_t i = 0; i < 50; ++i) note(first() + i, LoadKind::kPower, i < 40 ? 1.0 : 3.0);
  const auto colors = made(ColorBy::kPower);
  ASSERT_GE(colors->legend.size(), 2u);
  const ColorLegendEntry& beyond = colors->legend.back();
  ASSERT_TRUE(beyond.range);
  EXPECT_EQ(beyond.range->kind, LegendRange::Kind::kBeyondLimit);
  EXPECT_EQ(beyond.range->from, 2.2);
  EXPECT_EQ(colors->of_move[first() + 45], beyond.color);
  EXPECT_NE(colors->of_move[first()], beyond.color);
  EXPECT_EQ(colors->legend[colors->legend.size() - 2].range->to, 2.2);
  // The sound twin: below the limit nothing has it.
  wish_.spindle_power_kw = 5;
  const auto below = made(ColorBy::kPower);
  for (const ColorLegendEntry& entry : below->legend)
    EXPECT_EQ(entry.range->kind, LegendRange::Kind::kWithin);
  // Nor has force a limit.
  note(first(), LoadKind::kForce, 1000);
  const auto force = made(ColorBy::kForce);
  for (const ColorLegendEntry& entry : force->legend)
    EXPECT_EQ(entry.range->kind, LegendRange::Kind::kWithin);
}

TEST_F(ValueColorsTest, StraightDownIsNoAngle) {
  for (std::size_t i = 0; i < 50; ++i) note(first() + i, LoadKind::kAngle, i < 25 ? 180 : 360);
  const auto colors = made(ColorBy::kAngle);
  EXPECT_EQ(colors->legend.back().range->kind, LegendRange::Kind::kStraightDown);
  EXPECT_EQ(colors->of_move[first() + 30], colors->legend.back().color);
  EXPECT_EQ(colors->of_move[first()], colors->legend[5].color) << "a full slot, 150 to 180 degrees";
}

TEST_F(ValueColorsTest, FeedsAreOfWhatHasCut) {
  std::vector<float> removed(track_->size(), 0.0f);
  for (std::size_t i = 0; i < 25; ++i) removed[first() + i] = 5;
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=flat:6:teeth=2").value()));
  const CutQuery cuts(track_, sources);
  const auto feed = value_colors(ColorBy::kFeed, *track_, {removed, &cuts, nullptr, nullptr});
  EXPECT_NE(feed->of_move[first() + 3], feed->other);
  EXPECT_EQ(feed->of_move[first() + 30], feed->other);
  const auto tooth =
      value_colors(ColorBy::kFeedPerTooth, *track_, {removed, &cuts, nullptr, nullptr});
  EXPECT_NE(tooth->of_move[first() + 3], tooth->other);
  // Nobody knows the teeth.
  const auto unknown =
      value_colors(ColorBy::kFeedPerTooth, *track_, {removed, nullptr, nullptr, nullptr});
  EXPECT_EQ(unknown->of_move[first() + 3], unknown->other);
  EXPECT_TRUE(unknown->legend.empty());
}

TEST_F(ValueColorsTest, WhereNothingIsKnownThereIsNoLegend) {
  const auto colors = made(ColorBy::kTorque);
  ASSERT_TRUE(colors);
  EXPECT_TRUE(colors->legend.empty());
  EXPECT_EQ(colors->of_move.size(), track_->size());
}

Rgb linear(std::uint32_t color) {
  Rgb out{};
  for (unsigned k = 0; k < 3; ++k) {
    const double value = static_cast<double>(color >> (8 * k) & 0xffu) / 255;
    out[k] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return out;
}

using Matrix = std::array<Rgb, 3>;

Rgb times(const Matrix& m, const Rgb& v) {
  Rgb out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

/// CIE 1976 L*a*b* under D65.
Rgb lab(Rgb rgb) {
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  Rgb xyz =
      times({{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}}, rgb);
  xyz[0] /= 0.9505;
  xyz[2] /= 1.089;
  for (double& value : xyz)
    value = value > 0.008856 ? std::cbrt(value) : 7.787 * value + 16 / 116.0;
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

/// Machado, Oliveira, Fernandes, "A physiologically-based model for simulation of color vision
/// deficiency", IEEE TVCG 15 (2009), severity 1.
TEST_F(ValueColorsTest, WhoLacksAKindOfConeTellsThemApart) {
  const std::array<Matrix, 4> eyes{{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                    {{{0.152286, 1.052583, -0.204868},
                                      {0.114503, 0.786281, 0.099216},
                                      {-0.003882, -0.048116, 1.051998}}},
                                    {{{0.367322, 0.860646, -0.227968},
                                      {0.280085, 0.672501, 0.047413},
                                      {-0.011820, 0.042940, 0.968881}}},
                                    {{{1.255528, -0.076749, -0.178779},
                                      {-0.078411, 0.930809, 0.147602},
                                      {0.004733, 0.691367, 0.303900}}}}};
  wish_.spindle_power_kw = 6;
  for (std::size_t i = 0; i < 50; ++i)
    note(first() + i, LoadKind::kPower, 0.15 * static_cast<double>(i + 1));
  const auto made_colors = made(ColorBy::kPower);
  std::set<std::uint32_t> colors{made_colors->other};
  for (const ColorLegendEntry& entry : made_colors->legend) colors.insert(entry.color);
  ASSERT_EQ(colors.size(), 8u) << "six classes, beyond the limit, not known";
  for (const Matrix& eye : eyes) {
    for (const std::uint32_t a : colors) {
      for (const std::uint32_t b : colors) {
        if (a == b) continue;
        const Rgb one = lab(times(eye, linear(a))), other = lab(times(eye, linear(b)));
        EXPECT_GT(std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]), 13);
      }
    }
  }
  // Brighter is more, in grey as well.
  for (std::size_t k = 1; k < 6; ++k)
    EXPECT_GT(lab(linear(made_colors->legend[k].color))[0],
              lab(linear(made_colors->legend[k - 1].color))[0] + 5);
}

}  // namespace
}  // namespace kerf
