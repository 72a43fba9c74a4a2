#include "viewer/stroke_font.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace kerf {
namespace {

/// Strokes are separated by '/', corners by blanks; a corner marked * is rounded, by kCornerRadius
/// or as much as its sides allow.
struct GlyphSource {
  char32_t code;
  std::string_view strokes;
};

constexpr float kCornerRadius = 4.6f;
constexpr int kCornerSegments = 8;
constexpr char32_t kMissing = 0xFFFD;

constexpr GlyphSource kSources[] = {
    {' ', ""},
    {'!', "0,14 0,4.5/0,0 0,.3"},
    {'"', "0,14 0,10.5/3,14 3,10.5"},
    {'#', "1.5,0 4,14/6,0 8.5,14/.5,9.5 10,9.5/0,4.5 9.5,4.5"},
    {'$', "8.5,10.8 8.5,14* 0,14* 0,7.3* 9,7.3* 9,0* 0,0* 0,3.2/4.5,16 4.5,-2"},
    {'%', "10,14 1,0/0,11.5 0,14* 4,14* 4,9* 0,9* 0,11.5/7,2.5 7,5* 11,5* 11,0* 7,0* 7,2.5"},
    {'&', "9.5,0 1.5,10* 1.5,14* 6.5,14* 6.5,10* 0,5.5* 0,0* 6.5,0* 9.5,6"},
    {'\'', "0,14 0,10.5"},
    {'(', "3,16 0,12.5* 0,.5* 3,-3"},
    {')', "0,16 3,12.5* 3,.5* 0,-3"},
    {'*', "3,13 3,6.5/.2,11.4 5.8,8.1/.2,8.1 5.8,11.4"},
    {'+', "0,6.5 8,6.5/4,2.5 4,10.5"},
    {',', "1,.4 0,-2.4"},
    {'-', "0,6.2 5,6.2"},
    {'.', "0,0 0,.3"},
    {'/', "0,-2 6,15"},
    {'0', "0,7 0,14* 8.5,14* 8.5,0* 0,0* 0,7"},
    {'1', "0,11 3.6,14 3.6,0"},
    {'2', "0,10.5 0,14* 8.3,14* 8.3,8.3* 0,0 8.5,0"},
    {'3', "0,11.3 0,14* 8,14* 8,7.5* 3,7.5/4,7.5 8.5,7.5* 8.5,0* 0,0* 0,2.8"},
    {'4', "6.8,0 6.8,14 0,3.8 9,3.8"},
    {'5', "7.8,14 .9,14 .4,8.7 8.5,8.7* 8.5,0* 0,0* 0,2.6"},
    {'6', "7.9,11.4 7.9,14* 0,14* 0,0* 8.5,0* 8.5,8.3* 0,8.3* 0,4"},
    {'7', "0,14 8.5,14 3,0"},
    {'8',
     "4.2,7.5 .4,7.5* .4,14* 8.1,14* 8.1,7.5* 4.2,7.5/4.2,7.5 0,7.5* 0,0* 8.5,0* 8.5,7.5* 4.2,7.5"},
    {'9', ".6,2.6 .6,0* 8.5,0* 8.5,14* 0,14* 0,5.7* 8.5,5.7* 8.5,10"},
    {':', "0,0 0,.3/0,8.5 0,8.8"},
    {';', "1,.4 0,-2.4/1,8.5 1,8.8"},
    {'<', "7,11.3 0,6.5 7,1.7"},
    {'=', "0,8.5 8,8.5/0,4.5 8,4.5"},
    {'>', "0,11.3 7,6.5 0,1.7"},
    {'?', "0,11 0,14* 7.5,14* 7.5,8.5* 3.7,7.2* 3.7,4.5/3.7,0 3.7,.3"},
    {'@',
     "7.5,6.5 7.5,9* 3.2,9* 3.2,4* 7.5,4* 7.5,6.5/7.5,9 7.5,4* 11.5,4* 11.5,14* 0,14* 0,0* 10,0"},
    {'A', "0,0 4.8,14 9.6,0/1.7,4.7 7.9,4.7"},
    {'B', "0,7.5 0,14 8,14* 8,7.5* 0,7.5 0,0 9,0* 9,7.5* 0,7.5"},
    {'C', "9,10.4 9,14* 0,14* 0,0* 9,0* 9,3.6"},
    {'D', "0,0 0,14 9.2,14* 9.2,0* 0,0 0,1"},
    {'E', "8,14 0,14 0,0 8,0/0,7.3 6.5,7.3"},
    {'F', "8,14 0,14 0,0/0,7.3 6.5,7.3"},
    {'G', "9,10.4 9,14* 0,14* 0,0* 9.2,0* 9.2,6.5 5,6.5"},
    {'H', "0,0 0,14/9,0 9,14/0,7.3 9,7.3"},
    {'I', "0,0 0,14"},
    {'J', "6,14 6,0* 0,0* 0,3.2"},
    {'K', "0,0 0,14/8.5,14 0,5/3.2,8.4 9,0"},
    {'L', "0,14 0,0 7.5,0"},
    {'M', "0,0 0,14 5.5,4 11,14 11,0"},
    {'N', "0,0 0,14 9,0 9,14"},
    {'O', "0,7 0,14* 9.6,14* 9.6,0* 0,0* 0,7"},
    {'P', "0,0 0,14 9,14* 9,6.5* 0,6.5"},
    {'Q', "0,7 0,14* 9.6,14* 9.6,0* 0,0* 0,7/6,3.4 10,-1"},
    {'R', "0,0 0,14 9,14* 9,6.8* 0,6.8/4.6,6.8 9.2,0"},
    {'S', "8.5,10.8 8.5,14* 0,14* 0,7.3* 9,7.3* 9,0* 0,0* 0,3.2"},
    {'T', "0,14 9.4,14/4.7,14 4.7,0"},
    {'U', "0,14 0,0* 9,0* 9,14"},
    {'V', "0,14 4.7,0 9.4,14"},
    {'W', "0,14 3.3,0 6.6,12 9.9,0 13.2,14"},
    {'X', "0,0 9.2,14/0,14 9.2,0"},
    {'Y', "0,14 4.6,6.5 9.2,14/4.6,6.5 4.6,0"},
    {'Z', "0,14 9,14 0,0 9,0"},
    {'[', "3,16 0,16 0,-3 3,-3"},
    {'\\', "0,15 6,-2"},
    {']', "0,16 3,16 3,-3 0,-3"},
    {'^', "0,10 4,14 8,10"},
    {'_', "0,-2.5 8,-2.5"},
    {'`', "0,14 2,11.5"},
    {'a', ".5,8 .5,10* 7.5,10* 7.5,0/7.5,5.8 0,5.8* 0,0* 7.5,0* 7.5,3"},
    {'b', "0,14 0,0/0,3 0,0* 8,0* 8,10* 0,10* 0,7"},
    {'c', "7.4,7.4 7.4,10* 0,10* 0,0* 7.4,0* 7.4,2.6"},
    {'d', "8,14 8,0/8,3 8,0* 0,0* 0,10* 8,10* 8,7"},
    {'e', "0,5.3 8,5.3 8,10* 0,10* 0,0* 7.6,0* 7.6,2.4"},
    {'f', "5,14 1.9,14* 1.9,0/0,10 4.8,10"},
    {'g', "8,10 8,-4* .5,-4* .5,-2/8,3 8,0* 0,0* 0,10* 8,10* 8,7"},
    {'h', "0,0 0,14/0,6 0,10* 7.6,10* 7.6,0"},
    {'i', "0,0 0,10/0,13.5 0,13.9"},
    {'j', "2.5,10 2.5,-4* 0,-4/2.5,13.5 2.5,13.9"},
    {'k', "0,0 0,14/7,10 0,3.5/2.8,6.1 7.5,0"},
    {'l', "0,14 0,0* 2.4,0"},
    {'m', "0,0 0,10/0,6 0,10* 5.8,10* 5.8,0/5.8,6 5.8,10* 11.6,10* 11.6,0"},
    {'n', "0,0 0,10/0,6 0,10* 7.6,10* 7.6,0"},
    {'o', "0,5 0,10* 8,10* 8,0* 0,0* 0,5"},
    {'p', "0,-4 0,10/0,3 0,0* 8,0* 8,10* 0,10* 0,7"},
    {'q', "8,-4 8,10/8,3 8,0* 0,0* 0,10* 8,10* 8,7"},
    {'r', "0,0 0,10/0,5.5 0,10* 4.4,10"},
    {'s', "6.9,7.9 6.9,10* .2,10* .2,5.2* 7.2,5.2* 7.2,0* 0,0* 0,2.2"},
    {'t', "1.9,13.5 1.9,0* 4.8,0/0,10 4.8,10"},
    {'u', "0,10 0,0* 7.6,0* 7.6,4/7.6,10 7.6,0"},
    {'v', "0,10 4,0 8,10"},
    {'w', "0,10 2.8,0 5.6,8.6 8.4,0 11.2,10"},
    {'x', "0,0 7.6,10/0,10 7.6,0"},
    {'y', "0,10 4,0/8,10 2.8,-3* .4,-4"},
    {'z', "0,10 7.4,10 0,0 7.4,0"},
    {'{', "4,16 2,16* 2,6.5* 0,6.5/0,6.5 2,6.5* 2,-3* 4,-3"},
    {'|', "0,16 0,-3"},
    {'}', "0,16 2,16* 2,6.5* 4,6.5/4,6.5 2,6.5* 2,-3* 0,-3"},
    {'~', "0,5.2 0,8* 4.5,8* 4.5,5.2* 9,5.2* 9,8"},
    {0xB0, "0,11.8 0,14* 4.4,14* 4.4,9.6* 0,9.6* 0,11.8"},
    {0xB5, "0,10 0,-4/0,5 0,0* 7.6,0* 7.6,4/7.6,10 7.6,0"},
    {0xC4, "0,0 4.8,14 9.6,0/1.7,4.7 7.9,4.7/2.6,17 2.6,17.4/7,17 7,17.4"},
    {0xD6, "0,7 0,14* 9.6,14* 9.6,0* 0,0* 0,7/2.6,17 2.6,17.4/7,17 7,17.4"},
    {0xD7, "0,3 7,10/0,10 7,3"},
    {0xD8, "0,7 0,14* 9.6,14* 9.6,0* 0,0* 0,7/0,-1 9.6,15"},
    {0xDC, "0,14 0,0* 9,0* 9,14/2.4,17 2.4,17.4/6.6,17 6.6,17.4"},
    {0xDF, "0,0 0,14* 7,14* 7,8* 3,8/3,8 8,8* 8,0* 3,0"},
    {0xE4,
     ".5,8 .5,10* 7.5,10* 7.5,0/7.5,5.8 0,5.8* 0,0* 7.5,0* 7.5,3/2,13.5 2,13.9/6,13.5 6,13.9"},
    {0xF6, "0,5 0,10* 8,10* 8,0* 0,0* 0,5/2,13.5 2,13.9/6,13.5 6,13.9"},
    {0xF8, "0,5 0,10* 8,10* 8,0* 0,0* 0,5/0,-1 8,11"},
    {0xFC, "0,10 0,0* 7.6,0* 7.6,4/7.6,10 7.6,0/1.8,13.5 1.8,13.9/5.8,13.5 5.8,13.9"},
    {kMissing, "0,0 0,14 8,14 8,0 0,0"},
};

struct Corner {
  glm::vec2 at;
  bool rounded = false;
};

std::vector<Corner> parse_stroke(std::string_view text) {
  std::vector<Corner> corners;
  const char* p = text.data();
  const char* const end = p + text.size();
  while (p < end) {
    Corner corner;
    p = std::from_chars(p, end, corner.at.x).ptr + 1;  // the comma
    p = std::from_chars(p, end, corner.at.y).ptr;
    if (p < end && *p == '*') corner.rounded = true, ++p;
    if (p < end) ++p;  // the blank
    corners.push_back(corner);
  }
  return corners;
}

/// Cuts each rounded corner at equal distances on both sides and joins the cuts by a cubic Bezier
/// arc.
std::vector<glm::vec2> round_corners(const std::vector<Corner>& corners) {
  constexpr float kArc = 0.5523f;  // handle length of a quarter circle by a cubic
  std::vector<glm::vec2> line;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    if (!corner.rounded) {
      line.push_back(corner.at);
      continue;
    }
    assert(i > 0 && i + 1 < corners.size());
    const auto reach = [&](const Corner& neighbour) {
      return glm::length(neighbour.at - corner.at) * (neighbour.rounded ? 0.5f : 1.0f);
    };
    const Corner& before = corners[i - 1];
    const Corner& after = corners[i + 1];
    // Different reaches on both sides make an ellipse; that is what narrow letters want.
    const float cut_a = std::min(kCornerRadius, reach(before));
    const float cut_b = std::min(kCornerRadius, reach(after));
    const glm::vec2 a = corner.at + glm::normalize(before.at - corner.at) * cut_a;
    const glm::vec2 d = corner.at + glm::normalize(after.at - corner.at) * cut_b;
    const glm::vec2 b = a + (corner.at - a) * kArc;
    const glm::vec2 c = d + (corner.at - d) * kArc;
    for (int k = 0; k <= kCornerSegments; ++k) {
      const float t = static_cast<float>(k) / kCornerSegments;
      const float s = 1.0f - t;
      line.push_back(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d);
    }
  }
  return line;
}

Glyph make_glyph(std::string_view source) {
  Glyph glyph;
  while (!source.empty()) {
    const std::size_t end = std::min(source.find('/'), source.size());
    glyph.strokes.push_back(round_corners(parse_stroke(source.substr(0, end))));
    for (const glm::vec2& p : glyph.strokes.back()) glyph.width = std::max(glyph.width, p.x);
    source.remove_prefix(std::min(end + 1, source.size()));
  }
  return glyph;
}

const std::map<char32_t, Glyph>& font() {
  static const std::map<char32_t, Glyph> glyphs = [] {
    std::map<char32_t, Glyph> made;
    for (const GlyphSource& source : kSources) made[source.code] = make_glyph(source.strokes);
    made[' '].width = kSpaceWidth;
    return made;
  }();
  return glyphs;
}

/// Removes one code point from the front; kMissing for bytes that are no UTF-8.
char32_t take_code_point(std::string_view* text) {
  const auto byte = [&](std::size_t i) {
    return i < text->size() ? static_cast<unsigned char>((*text)[i]) : 0u;
  };
  const unsigned lead = byte(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC0 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                                           : 4;
  char32_t code = lead < 0x80 ? lead : lead & (0x7Fu >> length);
  bool valid = length > 0;
  for (std::size_t i = 1; i < length; ++i) {
    valid = valid && (byte(i) & 0xC0u) == 0x80u;
    code = (code << 6) | (byte(i) & 0x3Fu);
  }
  text->remove_prefix(valid ? length : 1);
  return valid ? code : kMissing;
}

}  // namespace

std::vector<const Glyph*> glyphs_of(std::string_view utf8_text) {
  std::vector<const Glyph*> glyphs;
  while (!utf8_text.empty()) {
    auto found = font().find(take_code_point(&utf8_text));
    if (found == font().end()) found = font().find(kMissing);
    glyphs.push_back(&found->second);
  }
  return glyphs;
}

}  // namespace kerf
