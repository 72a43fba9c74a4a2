#include "twin/report/rest_report.h"

#include <fmt/format.h>

#include "base/translate.h"
#include "twin/findings/finding_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

/// Tools that are named in the page of text.
constexpr std::size_t kMostToolsShown = 5;
/// What is less is 0 in the page of text.
constexpr double kShown_mm3 = 0.0005;

Json rest_tool_json(const RestTool& tool) {
  Json out{
      {"tool", tool.number}, {"shape", tool.shape}, {"guessed", tool.guessed}, {"used", tool.used}};
  if (!tool.left_out.empty()) {
    out["left_out"] = tool.left_out;
    return out;
  }
  out["takes_mm3"] = rounded(tool.takes_mm3);
  out["clears"] = tool.clears;
  return out;
}

Json rest_region_json(const RestRegion& region, const std::vector<RestTool>& tools) {
  Json out;
  out["box_mm"] = {vector_json(region.box_mm.min), vector_json(region.box_mm.max)};
  out["area_mm2"] = rounded(region.area_mm2);
  out["volume_mm3"] = rounded(region.volume_mm3);
  out["thickness_mm"] = rounded(region.thickness_mm);
  out["position_mm"] = vector_json(region.at_mm);
  out["by_tool"] = Json::array();
  for (const RestReach& reach : region.by_tool) {
    out["by_tool"].push_back({{"tool", tools[reach.tool].number},
                              {"shape", tools[reach.tool].shape},
                              {"takes_mm3", rounded(reach.takes_mm3)},
                              {"leaves_mm", rounded(reach.leaves_mm)}});
  }
  return out;
}

/// Lines of the greatest region: what each tool would leave.
std::string reach_text(const RestRegion& region, const std::vector<RestTool>& tools) {
  std::string out;
  std::size_t shown = 0;
  for (const RestReach& reach : region.by_tool) {
    if (shown++ == kMostToolsShown) break;
    out +=
        trf("          T{} ({}) would leave {:.3f} mm there, and take {:.3f} mm3 of {:.3f} mm3\n",
            tools[reach.tool].number, tools[reach.tool].shape, reach.leaves_mm, reach.takes_mm3,
            region.volume_mm3);
  }
  return out;
}

}  // namespace

Json rest_json(const Rest& rest) {
  Json out;
  out["thickness_mm"] = rounded(rest.thickness_mm);
  out["cell_mm"] = rounded(rest.cell_mm);
  out["volume_mm3"] = rounded(rest.volume_mm3);
  out["area_mm2"] = rounded(rest.area_mm2);
  out["by_none_mm3"] = rounded(rest.by_none_mm3);
  out["regions_total"] = rest.regions_in_all;
  out["tools"] = Json::array();
  for (const RestTool& tool : rest.tools) out["tools"].push_back(rest_tool_json(tool));
  out["regions"] = Json::array();
  for (const RestRegion& region : rest.regions)
    out["regions"].push_back(rest_region_json(region, rest.tools));
  out["seconds"] = rounded(rest.seconds);
  return out;
}

std::string rest_text(const Rest& rest) {
  if (rest.regions_in_all == 0)
    return trf("rest      nothing is thicker than {:g} mm above the design\n", rest.thickness_mm);
  std::string out = trf("rest      {:.3f} mm3 thicker than {:g} mm in {}", rest.volume_mm3,
                        rest.thickness_mm, trnf("{} place", "{} places", rest.regions_in_all));
  out += rest.by_none_mm3 >= kShown_mm3
             ? trf("; {:.3f} mm3 of it is out of reach of all tools\n", rest.by_none_mm3)
             : "\n";
  const RestRegion& greatest = rest.regions.front();
  const Vec3& at = greatest.at_mm;
  out += trf("          the greatest is {:.3f} mm thick at X{:.2f} Y{:.2f} Z{:.2f}\n",
             greatest.thickness_mm, at.x, at.y, at.z);
  return out + reach_text(greatest, rest.tools);
}

}  // namespace kerf
