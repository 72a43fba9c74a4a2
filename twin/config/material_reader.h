// twin/config/material_reader.h - what workpieces are made of: the rows that are compiled in
// (configs/materials.yaml), and files of the user's own.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "cutting/material.h"

namespace kerf {

/// All faults at once, each at its place, with what is allowed. Nothing if there is one:
///     shop.yaml:4:9: error: materials[1].mc: '1.5' is not allowed; must be 0 to 0.9
///     shop.yaml:9:5: error: materials[2]: mc is missing; ..
std::optional<std::vector<Material>> parse_materials(std::string_view text, const std::string& path,
                                                     Diagnostics& diagnostics);

/// The rows of configs/materials.yaml.
const std::vector<Material>& known_materials();

/// Of a file: its rows, then the known ones.
std::optional<std::vector<Material>> read_materials(const std::string& path,
                                                    Diagnostics& diagnostics);

}  // namespace kerf
