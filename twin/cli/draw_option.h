// twin/cli/draw_option.h - --draw and --section, which several commands have.
#pragma once

#include <optional>

#include "twin/cli/option_reader.h"
#include "viewer/scene.h"
#include "viewer/section.h"

namespace kerf {

/// The draw mode that --draw names; none if it is not given, or wrong.
std::optional<DrawMode> understand_draw(OptionReader& reader);
SectionKind understand_section(OptionReader& reader);

}  // namespace kerf
