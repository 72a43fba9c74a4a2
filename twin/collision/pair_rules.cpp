#include "twin/collision/pair_rules.h"

#include <algorithm>

namespace kerf {
namespace {

constexpr std::array<std::string_view, 3> kOfTool{"cutter", "shank", "holder"};

bool fits(const NamedPair& pair, std::string_view a, std::string_view b) {
  return (PairRules::means(pair[0], a) && PairRules::means(pair[1], b)) ||
         (PairRules::means(pair[0], b) && PairRules::means(pair[1], a));
}

}  // namespace

bool PairRules::means(std::string_view name, std::string_view body) {
  if (name == body) return true;
  return name == "tool" && std::ranges::find(kOfTool, body) != kOfTool.end();
}

bool PairRules::ignores(std::string_view a, std::string_view b) const {
  return std::ranges::any_of(ignored, [&](const NamedPair& pair) { return fits(pair, a, b); });
}

std::optional<double> PairRules::clearance_mm(std::string_view a, std::string_view b) const {
  for (const PairClearance& rule : clearances)
    if (fits(rule.pair, a, b)) return rule.mm;
  return std::nullopt;
}

std::vector<std::string> PairRules::names(std::span<const std::string> bodies) {
  std::vector<std::string> out(bodies.begin(), bodies.end());
  out.insert(out.end(), kOfTool.begin(), kOfTool.end());
  out.insert(out.end(), {"tool", "spindle", "workpiece"});
  return out;
}

}  // namespace kerf
