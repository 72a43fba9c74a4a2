// twin/config/turret_reader.h - a punch press from a YAML file.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "twin/machine/turret.h"

namespace kerf {

/// All faults at once, each at its place, with what is allowed. Null if there is one:
///     press.yaml:7:14: error: stations.3.angle: 400 is not allowed; must be -360 to 360 (degrees)
/// Files of shapes ("dxf:FILE") are relative to `path`. configs/punch/turret.yaml explains every
/// key.
TurretPointer parse_turret(std::string_view text, const std::string& path,
                           Diagnostics& diagnostics);

/// Reads the file. `path` is not empty.
TurretPointer read_turret(const std::string& path, Diagnostics& diagnostics);

/// Arcs of punches are off by this at most.
inline constexpr double kPunchTolerance_mm = 0.005;

}  // namespace kerf
