// twin/page/load_section.h - how tools were engaged, and what that took: tables of a page.
#pragma once

#include <string>

#include "twin/page/page_spots.h"
#include "twin/page/report_page.h"

namespace kerf {

/// Two tables: engagement of each tool (what Report::engagement has), and of its feed per tooth,
/// chips, speeds, forces, torque, power, bending what was not exceeded for half and for 95 % of the
/// time, the most with its range and its line (what tools[].engagement of the JSON has). Empty:
/// neither was measured.
std::string load_section(const Report& report, LengthUnit units, PageSpots& spots);

}  // namespace kerf
