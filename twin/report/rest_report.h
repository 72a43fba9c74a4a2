// twin/report/rest_report.h - what is left for rest machining, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "twin/compare/rest.h"

namespace kerf {

/// thickness_mm, cell_mm, volume_mm3, area_mm2, by_none_mm3, regions_total, tools (tool, shape,
/// guessed, used, takes_mm3, clears; or left_out, and why), regions (box_mm, area_mm2, volume_mm3,
/// thickness_mm, position_mm, by_tool: tool, takes_mm3, leaves_mm; kMostRegions at most), seconds.
nlohmann::ordered_json rest_json(const Rest& rest);

/// Lines for the page of text.
std::string rest_text(const Rest& rest);

}  // namespace kerf
