// twin/report/compare_report.h - what a comparison with the design came to, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/compare/comparison.h"
#include "twin/findings/finding.h"

namespace kerf {

/// design, triangles, tolerance_mm, verdict ("in tolerance", "excess left", "gouged"),
/// gouge_max_mm, gouge_mm3, excess_max_mm, excess_mm3, within_percent, area_mm2, outside_mm3,
/// bound_mm, walls_mm, placement, fit_residue_mm, gouge and excess (the worst place: position_mm,
/// mm, file, line, tool; null if there is none), gouges, excesses (regions in all), histogram
/// (from_mm, to_mm, area_mm2; null at the open ends), regions (kind, the worst place, box_mm,
/// area_mm2, volume_mm3, lines: file, line, tool), seconds.
nlohmann::ordered_json compare_json(const Comparison& comparison,
                                    const std::vector<std::string>& files);

/// Lines for the page of text.
std::string compare_text(const Comparison& comparison);

/// A finding for each of the gouges (regions), and one for the greatest excess. Gouges are errors,
/// but warnings where the tool that made it is one of `guessed_tools`.
void add_compare_findings(const Comparison& comparison, const std::vector<int>& guessed_tools,
                          FindingLog& log);

}  // namespace kerf
