#include "twin/report/engagement_report.h"

#include <fmt/format.h>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/job/load_text.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / kPi;
/// In whole mm.
constexpr double kShown_mm = 0.5;
/// Shares and ways that say nothing.
constexpr double kLeastShare = 5e-4, kLeast_mm = 0.05;

Json pair_of(double mean, double most) {
  return Json{{"mean", rounded(mean)}, {"most", rounded(most)}};
}

void add_sums(Json& out, const EngagementSums& sums) {
  out["cut_mm"] = rounded(sums.cut_mm);
  out["plunge_mm"] = rounded(sums.plunge_mm);
  out["full_slot_mm"] = rounded(sums.full_mm);
  out["ae_mm"] = pair_of(sums.mean(sums.wide_sum_mm2), sums.wide_most_mm);
  out["angle_deg"] = pair_of(kDegrees * sums.mean(sums.angle_sum), kDegrees * sums.angle_most_rad);
  out["ap_mm"] = pair_of(sums.mean(sums.deep_sum_mm2), sums.deep_most_mm);
  out["climb_mm"] = rounded(sums.climb_mm);
  out["ramp_mm"] = rounded(sums.ramp_mm);
  out["ramp_most_deg"] = rounded(kDegrees * sums.ramp_most_rad);
  out["contact_most_mm"] = rounded(sums.contact_most_mm);
  out["effective_diameter_mm"] = rounded(sums.effective_most_mm);
  out["cut_s"] = rounded(sums.cut_s);
  out["removed_mm3"] = rounded(sums.removed_mm3);
  out["rate_mm3_per_s"] = pair_of(sums.rate_mm3_per_s(), sums.rate_most_mm3_per_s);
}

std::string air_text(double air_mm, double feed_mm, double air_s) {
  if (feed_mm <= 0 || air_mm < kLeastShare * feed_mm) return {};
  return trf("{} % of its feeds in air, {}", percent_text(100 * air_mm / feed_mm),
             span_text(air_s));
}

Json turned_row(const TurningEngagement& tool) {
  return Json{{"tool", tool.tool},
              {"shape", tool.shape},
              {"cut_mm", rounded(tool.cut_mm)},
              {"ap_mm", pair_of(tool.mean(tool.depth_sum_mm2), tool.depth_most_mm)},
              {"feed_mm_per_rev", pair_of(tool.mean(tool.feed_sum), tool.feed_most_mm)},
              {"chip_mm", pair_of(tool.mean(tool.chip_sum), tool.chip_most_mm)},
              {"cut_s", rounded(tool.cut_s)},
              {"removed_mm3", rounded(tool.removed_mm3)},
              {"rate_mm3_per_s", pair_of(tool.rate_mm3_per_s(), tool.rate_most_mm3_per_s)},
              {"feed_mm", rounded(tool.feed_mm)},
              {"feed_s", rounded(tool.feed_s)},
              {"air_mm", rounded(tool.air_mm)},
              {"air_s", rounded(tool.air_s)}};
}

std::string turned_text(const TurningEngagement& tool) {
  std::string out = trf("T{}: {:.2f} mm deep on average, {:.2f} mm at most", tool.tool,
                        tool.mean(tool.depth_sum_mm2), tool.depth_most_mm);
  // Of a spindle that stands there is no feed a turn.
  if (tool.feed_most_mm > 0)
    out += trf("; {:.3f} mm a turn on average, {:.3f} mm at most; chips of {:.3f} mm",
               tool.mean(tool.feed_sum), tool.feed_most_mm, tool.mean(tool.chip_sum));
  out += trf("; {} mm3/s on average", load_text(tool.rate_mm3_per_s()));
  const std::string air = air_text(tool.air_mm, tool.feed_mm, tool.air_s);
  return out + (air.empty() ? "" : "; " + air) + "\n";
}

/// The second line of a tool: climb, slopes, how fast, what of its feeds is in no material.
std::string more_text(const EngagementOfTool& tool) {
  const EngagementSums& sums = tool.sums;
  std::string out;
  const auto add = [&out](const std::string& text) { out += (out.empty() ? "" : "; ") + text; };
  if (sums.cut_mm > 0) add(trf("{:.0f} % in climb", 100 * sums.climb_mm / sums.cut_mm));
  if (sums.ramp_mm >= kLeast_mm)
    add(trf("{:.1f} mm down slopes of {:.1f} degrees at most", sums.ramp_mm,
            kDegrees * sums.ramp_most_rad));
  if (sums.cut_s > 0)
    add(trf("{} mm3/s on average, {} mm3/s at most", load_text(sums.rate_mm3_per_s()),
            load_text(sums.rate_most_mm3_per_s)));
  if (const std::string air = air_text(tool.air_mm, tool.feed_mm, tool.air_s); !air.empty())
    add(air);
  if (const Scallops& crests = tool.scallops; crests.count > 0)
    add(trf("crests of {:.2g} mm between its passes, {:.2g} mm at most", crests.p95_mm,
            crests.most_mm));
  return out.empty() ? out : std::string(10, ' ') + out + "\n";
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
    row["feed_mm"] = rounded(tool.feed_mm);
    row["feed_s"] = rounded(tool.feed_s);
    row["air_mm"] = rounded(tool.air_mm);
    row["air_s"] = rounded(tool.air_s);
    if (const Scallops& crests = tool.scallops; crests.count > 0) {
      const Vec3& at = crests.most_at_mm;
      row["scallop_mm"] = {{"p95", rounded(crests.p95_mm)}, {"most", rounded(crests.most_mm)}};
      row["scallop_at_mm"] = {rounded(at.x), rounded(at.y), rounded(at.z)};
    }
    out["tools"].push_back(std::move(row));
  }
  for (const TurningEngagement& tool : engagement.turned) out["tools"].push_back(turned_row(tool));
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
    if (sums.full_mm > kLeastShare * sums.cut_mm)
      out += trf("; {} % in full slots", percent_text(100 * sums.full_mm / sums.cut_mm));
    if (sums.plunge_mm >= kLeast_mm) out += trf("; {:.1f} mm straight down", sums.plunge_mm);
    out += "\n" + more_text(tool);
    label = std::string(10, ' ');
  }
  for (const TurningEngagement& tool : engagement.turned) {
    out += label + turned_text(tool);
    label = std::string(10, ' ');
  }
  const bool none = engagement.tools.empty() && engagement.turned.empty();
  if (none && engagement.unmeasured_mm <= 0) out += label + tr("no tool was in material\n");
  if (engagement.unmeasured_mm >= kShown_mm)
    out += label + trf("not measured: {:.0f} mm of undercutting tools, of tools that turn about on "
                       "their way, of threads, of arcs of tilted tools, in a model that "
                       "cannot be asked, or where no look has seen what was removed\n",
                       engagement.unmeasured_mm);
  return out;
}

}  // namespace kerf
