#include "viewer/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "viewer/stroke_font.h"

namespace kerf {
namespace {

TEST(StrokeFontTest, EveryPrintableAsciiCharacterHasItsOwnStrokes) {
  const Glyph* missing = glyphs_of("\xEF\xBF\xBD")[0];
  for (char c = '!'; c <= '~'; ++c) {
    const auto glyphs = glyphs_of(std::string(1, c));
    ASSERT_EQ(glyphs.size(), 1u);
    EXPECT_NE(glyphs[0], missing) << c;
    EXPECT_FALSE(glyphs[0]->strokes.empty()) << c;
    for (const auto& stroke : glyphs[0]->strokes) {
      EXPECT_GE(stroke.size(), 2u) << c;
      for (const glm::vec2& p : stroke) {
        EXPECT_TRUE(p.x >= -0.01f && p.x <= glyphs[0]->width + 0.01f) << c;
        EXPECT_TRUE(p.y >= -4.01f && p.y <= 16.01f) << c;
      }
    }
  }
  EXPECT_TRUE(glyphs_of(" ")[0]->strokes.empty());
}

TEST(StrokeFontTest, DecodesUtf8AndBoxesWhatItDoesNotKnow) {
  const Glyph* missing = glyphs_of("\xEF\xBF\xBD")[0];
  EXPECT_NE(glyphs_of("\xC2\xB0")[0], missing);  // degree sign
  EXPECT_EQ(glyphs_of("\xC3\xA4").size(), 1u);   // a umlaut
  EXPECT_NE(glyphs_of("\xC3\xA4")[0], missing);
  EXPECT_EQ(glyphs_of("\xC3\xB1").size(), 1u);  // n tilde
  EXPECT_EQ(glyphs_of("\xC3\xB1")[0], missing);
  EXPECT_EQ(glyphs_of("\xF0\x9F\x94\xA7").size(), 1u);  // four bytes
  EXPECT_EQ(glyphs_of("\xC3").size(), 1u);              // cut off
  EXPECT_EQ(glyphs_of("\xC3(")[1], glyphs_of("(")[0]);  // the byte after a bad one survives
  EXPECT_EQ(glyphs_of("\x80\xFF"
                      "A")[2],
            glyphs_of("A")[0]);
}

TEST(LabelsTest, AnchorPlacesTheBoxOfTheText) {
  for (const glm::vec2 anchor : {glm::vec2(0, 0), glm::vec2(0.5f, 0.5f), glm::vec2(1, 1)}) {
    LabelStyle style;
    style.cap_height_px = 28.0f;
    std::vector<Stroke> strokes;
    add_label("HH", {100, 200}, anchor, style, &strokes);
    glm::vec2 low(1e9f);
    glm::vec2 high(-1e9f);
    for (const Stroke& s : strokes) {
      low = {std::min({low.x, s.from_px.x, s.to_px.x}), std::min({low.y, s.from_px.y, s.to_px.y})};
      high = {std::max({high.x, s.from_px.x, s.to_px.x}),
              std::max({high.y, s.from_px.y, s.to_px.y})};
    }
    const float width = label_width_px("HH", 28.0f);
    EXPECT_NEAR(high.x - low.x, width, 0.01f);
    EXPECT_NEAR(high.y - low.y, 28.0f, 0.01f);
    EXPECT_NEAR(low.x, 100.0f - anchor.x * width, 0.01f);
    EXPECT_NEAR(high.y, 200.0f + anchor.y * 28.0f, 0.01f);
  }
}

TEST(LabelsTest, WidthGrowsWithTextAndSize) {
  EXPECT_EQ(label_width_px("", 20.0f), 0.0f);
  EXPECT_GT(label_width_px("100 mm", 20.0f), label_width_px("10 mm", 20.0f));
  EXPECT_NEAR(label_width_px("X 12.5 mm", 40.0f), 2.0f * label_width_px("X 12.5 mm", 20.0f), 0.01f);
}

TEST(LabelsTest, HaloLiesUnderTheText) {
  LabelStyle style;
  style.halo_rgba = {1, 1, 1, 1};
  std::vector<Stroke> strokes;
  add_label("T", {0, 0}, {0, 0}, style, &strokes);
  ASSERT_EQ(strokes.size(), 4u);
  EXPECT_GT(strokes[0].width_px, strokes[2].width_px);
  EXPECT_EQ(strokes[0].rgba, style.halo_rgba);
  EXPECT_EQ(strokes[3].rgba, style.rgba);
}

}  // namespace
}  // namespace kerf
