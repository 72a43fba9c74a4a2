// twin/config/job_nodes.h - nodes of a job file, with what is said of wrong ones.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "twin/config/config_reader.h"
#include "twin/config/job_turn.h"

namespace kerf {

inline constexpr double kMostJobCoordinate_mm = 100'000;

/// Keys that are none of `known` are faults. `others`: what else may stand there, for the hint;
/// empty: nothing.
void check_job_names(ConfigNode& node, const std::vector<std::string>& known,
                     const std::string& others, ConfigFaults& faults);
/// Null: it is not there, or is no plain value, which is said.
ConfigNode* job_value(ConfigNode& node, std::string_view name, ConfigFaults& faults);
/// [x, y, z], or "x,y,z".
std::optional<Vec3> job_three(ConfigNode& node, double most, const char* unit,
                              ConfigFaults& faults);
/// flip, rotate, zero and points of a setup.
void read_job_turn(ConfigNode& setup, JobTurn& turn, ConfigFaults& faults);

}  // namespace kerf
