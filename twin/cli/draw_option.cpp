#include "twin/cli/draw_option.h"

namespace kerf {

std::optional<DrawMode> understand_draw(OptionReader& reader) {
  constexpr DrawMode kDrawModes[] = {DrawMode::kMesh, DrawMode::kRaycast, DrawMode::kCsg};
  const int at = reader.word("--draw");
  return at < 0 ? std::nullopt : std::optional(kDrawModes[at]);
}

}  // namespace kerf
