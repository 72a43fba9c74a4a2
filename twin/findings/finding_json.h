// twin/findings/finding_json.h - findings and their parts as JSON, for the report and for live
// events.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "twin/findings/finding.h"

namespace kerf {

/// Six decimals: a thousandth of a um. Keeps the text short and free of the last bits of a sum.
double rounded(double value);

nlohmann::ordered_json vector_json(const Vec3& v);

/// id, severity, file, line, time_s, position_mm, tool, depth_mm, message.
nlohmann::ordered_json finding_json(const Finding& finding, const std::vector<std::string>& files);

}  // namespace kerf
