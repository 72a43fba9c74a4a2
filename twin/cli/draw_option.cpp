#include "twin/cli/draw_option.h"

namespace kerf {

std::optional<DrawMode> understand_draw(OptionReader& reader) {
  constexpr DrawMode kDrawModes[] = {DrawMode::kMesh, DrawMode::kRaycast, DrawMode::kCsg};
  const int at = reader.word("--draw");
  return at < 0 ? std::nullopt : std::optional(kDrawModes[at]);
}

SectionKind understand_section(OptionReader& reader) {
  SectionKind kind = SectionKind::kNone;
  reader.word("--section", {SectionKind::kNone, SectionKind::kHalf, SectionKind::kQuarter}, kind);
  return kind;
}

}  // namespace kerf
