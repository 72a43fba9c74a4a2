// twin/collision/pair_rules.h - which bodies may touch, and how near single pairs may come to each
// other.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "twin/collision/tool_bodies.h"

namespace kerf {

/// Two names as a configuration has them: of links and of fixtures; `cutter`, `shank`, `holder`
/// (all three: `tool`), `spindle`, `workpiece`. A link or a fixture of such a name is meant, too.
using NamedPair = std::array<std::string, 2>;

struct PairClearance {
  NamedPair pair;
  double mm = 0;
};

/// Values. Looked at when bodies are paired, not on their ways.
struct PairRules {
  std::vector<NamedPair> ignored;         ///< machine.ignore
  std::vector<PairClearance> clearances;  ///< of these the first that fits

  bool ignores(std::string_view a, std::string_view b) const;
  std::optional<double> clearance_mm(std::string_view a, std::string_view b) const;

  /// `name` is what a rule calls the body `body` ("tool" is the holder, too).
  static bool means(std::string_view name, std::string_view body);
  /// Names that rules may have, if these are the links and fixtures there are.
  static std::vector<std::string> names(std::span<const std::string> bodies);
};

}  // namespace kerf
