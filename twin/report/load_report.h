// twin/report/load_report.h - chips, forces, torque and power of a tool, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cutting/material.h"
#include "twin/job/tool_loads.h"

namespace kerf {

/// Adds to tools[].engagement, of each quantity (chip_max_mm, speed_max_m_min; with a material
/// force_max_n, torque_max_nm, power_max_kw; where the stick-out is known deflection_max_mm,
/// wall_max_mm) NAME_max_UNIT and its NAME_line, NAME_p50_UNIT, NAME_p95_UNIT; of what is a range
/// NAME_range_UNIT, low and high of the greatest.
void add_loads(nlohmann::ordered_json& out, const ToolLoads& loads);

/// Lines behind those of the tool. `is_speed_said`: what it cuts at is told in these.
std::string loads_text(const ToolLoads& loads, bool is_speed_said);

/// name, source, kc11_n_per_mm2, mc.
nlohmann::ordered_json material_json(const Material& material);

}  // namespace kerf
