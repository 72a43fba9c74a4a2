// twin/process/collision_table.h - which bodies came how near to each other: a row each pair.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/collision/tool_bodies.h"

namespace kerf {

/// A part of a tool, or a body that is no tool's, and what it was held against.
struct CollisionPair {
  int tool = 0;
  ToolPart part = ToolPart::kCutter;
  std::string first;           ///< empty: `part` of `tool`; else the body instead
  std::string other;           ///< name of a fixture or a link; empty: the workpiece
  std::uint32_t contacts = 0;  ///< events, each a finding
  /// 0: they touched. Nothing: it is not known, as nothing but contacts was looked for.
  std::optional<double> least_clearance_mm;
  /// Where that is nothing: it is no less than this. Nothing: nobody has measured.
  std::optional<double> clearance_above_mm;
  SourceRef source;  ///< of the move with the least clearance, or the first contact
};

}  // namespace kerf
