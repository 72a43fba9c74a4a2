#include "twin/app/draw_option.h"

#include <fmt/format.h>

#include <array>

namespace kerf {
namespace {

struct NamedRoad {
  const char* name;
  DrawRoad road;
};
constexpr std::array<NamedRoad, 3> kRoads{
    {{"mesh", DrawRoad::kMesh}, {"raycast", DrawRoad::kRaycast}, {"csg", DrawRoad::kCsg}}};

}  // namespace

std::optional<DrawRoad> understand_draw(const std::string& text, OptionReader& reader) {
  if (text.empty()) return std::nullopt;
  for (const NamedRoad& road : kRoads) {
    if (text == road.name) return road.road;
  }
  reader.fault("--draw", fmt::format("'{}' is not allowed; must be mesh | raycast | csg", text));
  return std::nullopt;
}

}  // namespace kerf
