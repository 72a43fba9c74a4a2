// twin/page/page_sections.h - the parts of a page that need no script: tables and texts.
#pragma once

#include <string>

#include "twin/page/report_page.h"

namespace kerf {

/// Each with its heading; empty where there is nothing to tell.
std::string head_section(const Report& report, const PageOptions& options);
/// The list of findings alone, a button each, in their order.
std::string finding_list(const Report& report, LengthUnit units);
std::string setup_section(const Report& report, const PageOptions& options, bool has_view);
std::string tool_section(const Report& report, LengthUnit units);
std::string collision_section(const Report& report, LengthUnit units);
/// The part against its design.
std::string compare_section(const Report& report, LengthUnit units);
/// What became of a sheet or a turned part.
std::string part_section(const Report& report, LengthUnit units);
std::string curve_section(const PageCurves& curves, LengthUnit units);
/// How exact it is, what was guessed, and how to make it again. `mesh`: of the view, a sentence;
/// may be empty.
std::string exactness_section(const Report& report, const PageOptions& options,
                              const std::string& mesh);

}  // namespace kerf
