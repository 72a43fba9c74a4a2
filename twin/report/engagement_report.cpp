#include "twin/report/engagement_report.h"

#include <fmt/format.h>

#include "base/translate.h"
#include "twin/findings/finding_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / kPi;

void add_sums(Json& out, const EngagementSums& sums) {
  out["cut_mm"] = rounded(sums.cut_mm);
  out["plunge_mm"] = rounded(sums.plunge_mm);
  out["full_slot_mm"] = rounded(sums.full_mm);
  const auto pair = [](double mean, double most) {
    return Json{{"mean", rounded(mean)}, {"most", rounded(most)}};
  };
  out["ae_mm"] = pair(sums.mean(sums.wide_sum_mm2), sums.wide_most_mm);
  out["angle_deg"] = pair(kDegrees * sums.mean(sums.angle_sum), kDegrees * sums.angle_most_rad);
  out["ap_mm"] = pair(sums.mean(sums.deep_sum_mm2), sums.deep_most_mm);
  out["removed_mm3"] = rounded(sums.removed_mm3);
}

}  // namespace

Json engagement_json(const Engagement& engagement, const std::vector<std::string>& files) {
  Json out;
  out["tools"] = Json::array();
  for (const EngagementOfTool& tool : engagement.tools) {
    Json row{{"tool", tool.tool},
             {"shape", tool.shape},
             {"diameter_mm", rounded(tool.diameter_mm)},
             {"passes", tool.passes}};
    add_sums(row, tool.sums);
    out["tools"].push_back(std::move(row));
  }
  out["passes"] = Json::array();
  for (const EngagementPass& pass : engagement.passes) {
    Json row;
    row["tool"] = pass.tool;
    const bool has_file = pass.from.line > 0 && pass.from.file < files.size();
    row["file"] = has_file ? Json(files[pass.from.file]) : Json(nullptr);
    row["line"] = pass.from.line;
    row["last_line"] = pass.to.line;
    row["time_s"] = rounded(pass.start_s);
    add_sums(row, pass.sums);
    out["passes"].push_back(std::move(row));
  }
  out["passes_total"] = engagement.passes_in_all;
  out["unmeasured_mm"] = rounded(engagement.unmeasured_mm);
  out["unmeasured_mm3"] = rounded(engagement.unmeasured_mm3);
  return out;
}

std::string engagement_text(const Engagement& engagement) {
  std::string out;
  std::string label = tr("engaged   ");
  for (const EngagementOfTool& tool : engagement.tools) {
    const EngagementSums& sums = tool.sums;
    const double share = tool.diameter_mm > 0 ? 100 / tool.diameter_mm : 0;
    out += label;
    out += trf("T{} in {}", tool.tool, trnf("{} pass", "{} passes", tool.passes));
    if (sums.cut_mm > 0)
      out +=
          trf(": {:.0f} degrees of its edge on average, {:.0f} at most; {:.0f} % of its "
              "diameter; {:.2f} mm deep at most",
              kDegrees * sums.mean(sums.angle_sum), kDegrees * sums.angle_most_rad,
              share * sums.mean(sums.wide_sum_mm2), sums.deep_most_mm);
    if (sums.full_mm > 0) out += trf("; {:.0f} % in full slots", 100 * sums.full_mm / sums.cut_mm);
    if (sums.plunge_mm > 0) out += trf("; {:.1f} mm straight down", sums.plunge_mm);
    out += "\n";
    label = std::string(10, ' ');
  }
  if (engagement.tools.empty() && engagement.unmeasured_mm <= 0)
    out += label + tr("no tool was in material\n");
  if (engagement.unmeasured_mm > 0)
    out += (engagement.tools.empty() ? label : std::string(10, ' ')) +
           trf("not measured: {:.0f} mm of tilted or undercutting tools, or in a model that holds "
               "more than heights\n",
               engagement.unmeasured_mm);
  return out;
}

}  // namespace kerf
