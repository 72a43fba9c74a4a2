// twin/app/draw_option.h - --draw, which several commands have.
#pragma once

#include <optional>
#include <string>

#include "twin/app/option_reader.h"
#include "viewer/scene.h"

namespace kerf {

/// The road that --draw names; none if it is not given, or wrong.
std::optional<DrawRoad> understand_draw(const std::string& text, OptionReader& reader);

}  // namespace kerf
