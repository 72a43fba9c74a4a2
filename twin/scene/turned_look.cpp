#include "twin/scene/turned_look.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "interp_bridge/turning_text.h"

namespace kerf {
namespace {

constexpr std::size_t kMostCorners = 24;
constexpr int kCircleSteps = 72;  // of a circle; a multiple of four

glm::vec3 on_round(const Vec2& zr, int step) {
  const double angle = 2 * kPi * step / kCircleSteps;
  return glm::vec3(Vec3(zr.y * std::cos(angle), zr.y * std::sin(angle), zr.x));
}

void add_profile(const std::vector<Vec2>& chain, std::vector<LineSegment>& lines) {
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2& from = chain[i];
    const Vec2& to = chain[(i + 1) % chain.size()];
    if (from.y > 0) {
      for (int k = 0; k < kCircleSteps; ++k)
        lines.push_back({on_round(from, k), on_round(from, k + 1)});
    }
    // A face is seen by its circles.
    if (from.x == to.x || (from.y == 0 && to.y == 0)) continue;
    for (int k = 0; k < kCircleSteps; k += kCircleSteps / 4)
      lines.push_back({on_round(from, k), on_round(to, k)});
  }
}

/// Of each file the lines that say G7 or G8.
using DiameterLines = std::vector<std::vector<std::pair<int, bool>>>;

DiameterLines diameter_lines(const ProgramText& text) {
  DiameterLines files;
  for (const SourceFile& file : text.files) {
    auto& lines = files.emplace_back();
    SourceLines text_lines(file);
    for (int line = 1; line <= file.line_count(); ++line) {
      if (const auto said = diameter_word(text_lines.line(line))) lines.emplace_back(line, *said);
    }
  }
  return files;
}

}  // namespace

std::vector<LineSegment> turned_outline(const TurningStock& stock) {
  const TurnedPart& part = stock.part();
  std::vector<LineSegment> lines;
  if (part.corner_count() <= kMostCorners) {
    for (const std::vector<Vec2>& chain : part.profile()) add_profile(chain, lines);
  } else {
    const Box box = part.bounds_mm();
    add_profile(bar_profile(box.min.z, box.max.z, box.size().x).front(), lines);
  }
  return lines;
}

std::vector<LineSegment> blank_outline_of(const StockModel& blank) {
  const TurningStock* const turned = blank.turned();
  return turned ? turned_outline(*turned) : box_outline(blank.bounds_mm());
}

DiameterMode::DiameterMode(const ProgramTrack& track, const ProgramText& text) {
  const DiameterLines files = diameter_lines(text);
  const bool is_ever =
      std::any_of(files.begin(), files.end(), [](const auto& lines) { return !lines.empty(); });
  if (!is_ever) return;
  SourceRef before{0, 0};
  bool holds = false;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const SourceRef here = track.source(i);
    if (here.file >= files.size() || here == before) continue;
    // Of another file, or jumped to: from its beginning, where nothing else is known.
    const std::uint32_t from =
        here.file == before.file && here.line > before.line ? before.line : 0;
    bool now = holds;
    for (const auto& [line, is_diameter] : files[here.file]) {
      const auto at = static_cast<std::uint32_t>(line);
      if (at > from && at <= here.line) now = is_diameter;
    }
    // A jump backwards does not undo what was said behind it.
    const bool jumps_back = here.file == before.file && here.line < before.line;
    before = here;
    if (now == holds || jumps_back) continue;
    holds = now;
    changes_.push_back(i);
  }
}

bool DiameterMode::holds_at(std::size_t motion) const {
  const auto after = std::upper_bound(changes_.begin(), changes_.end(), motion);
  return (after - changes_.begin()) % 2 != 0;
}

}  // namespace kerf
