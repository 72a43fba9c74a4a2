#include "twin/report/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "twin/findings/finding_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

void add_who(Json& out, const CutBy& by, const std::vector<std::string>& files) {
  const bool is_known = by.source.line > 0;
  const bool has_file = is_known && by.source.file < files.size();
  out["file"] = has_file ? Json(files[by.source.file]) : Json(nullptr);
  out["line"] = is_known ? Json(by.source.line) : Json(nullptr);
  out["tool"] = is_known ? Json(by.tool) : Json(nullptr);
}

void add_worst(Json& out, const DeviationPlace& place, const std::vector<std::string>& files) {
  out["mm"] = rounded(place.mm);
  out["position_mm"] = vector_json(place.at_mm);
  add_who(out, place.by, files);
  if (place.pass_distance_mm > 0) out["pass_distance_mm"] = rounded(place.pass_distance_mm);
}

Json worst_json(const DeviationPlace& place, const std::vector<std::string>& files) {
  if (place.mm == 0) return nullptr;
  Json out;
  add_worst(out, place, files);
  return out;
}

Json deviation_region_json(const DeviationRegion& region, const std::vector<std::string>& files) {
  Json out;
  out["kind"] = region.is_gouge ? "gouge" : "excess";
  add_worst(out, region.worst, files);
  out["box_mm"] = {vector_json(region.box_mm.min), vector_json(region.box_mm.max)};
  out["area_mm2"] = rounded(region.area_mm2);
  out["volume_mm3"] = rounded(region.volume_mm3);
  out["lines"] = Json::array();
  for (const CutBy& by : region.by) {
    Json line;
    add_who(line, by, files);
    out["lines"].push_back(std::move(line));
  }
  return out;
}

std::string worst_text(const DeviationPlace& place) {
  const Vec3& p = place.at_mm;
  std::string out = trf("{:.3f} mm at most, at X{:.2f} Y{:.2f} Z{:.2f}", place.mm, p.x, p.y, p.z);
  if (place.by.source.line > 0) {
    out += place.pass_distance_mm > 0
               ? trf(", {:.2f} mm beside the pass of line {} (tool {})", place.pass_distance_mm,
                     place.by.source.line, place.by.tool)
               : trf(", line {} (tool {})", place.by.source.line, place.by.tool);
  }
  return out;
}

std::string places_text(std::size_t count) { return trnf("{} place", "{} places", count); }

Finding deviation_finding(FindingId id, Severity severity, const DeviationRegion& region) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.source = region.worst.by.source;
  finding.position_mm = region.worst.at_mm;
  finding.depth_mm = region.worst.mm;
  if (finding.source.line > 0) finding.tool = region.worst.by.tool;
  return finding;
}

}  // namespace

Json compare_json(const Comparison& c, const std::vector<std::string>& files) {
  Json out;
  out["design"] = c.design;
  out["triangles"] = c.triangles;
  out["tolerance_mm"] = rounded(c.tolerance_mm);
  out["verdict"] = to_string(c.verdict);
  out["gouge_max_mm"] = rounded(c.gouge.mm);
  out["gouge_mm3"] = rounded(c.gouge_mm3);
  out["excess_max_mm"] = rounded(c.excess.mm);
  out["excess_mm3"] = rounded(c.excess_mm3);
  out["within_percent"] = rounded(c.within_percent());
  out["area_mm2"] = rounded(c.area_mm2);
  out["outside_mm3"] = rounded(c.outside_mm3);
  out["bound_mm"] = rounded(c.bound_mm);
  out["walls_mm"] = rounded(c.walls_mm);
  if (c.piece > 0) out["piece"] = c.piece;
  if (!c.placement.empty()) out["placement"] = c.placement;
  if (c.fit_residue_mm) out["fit_residue_mm"] = rounded(*c.fit_residue_mm);
  out["gouge"] = worst_json(c.gouge, files);
  out["excess"] = worst_json(c.excess, files);
  out["gouges"] = c.gouges;
  out["excesses"] = c.excesses;
  out["histogram"] = Json::array();
  for (const DeviationBin& bin : c.histogram) {
    const auto edge = [](double mm) { return std::isfinite(mm) ? Json(rounded(mm)) : Json(); };
    out["histogram"].push_back({{"from_mm", edge(bin.from_mm)},
                                {"to_mm", edge(bin.to_mm)},
                                {"area_mm2", rounded(bin.area_mm2)}});
  }
  out["regions"] = Json::array();
  for (const DeviationRegion& region : c.regions)
    out["regions"].push_back(deviation_region_json(region, files));
  out["seconds"] = rounded(c.seconds);
  return out;
}

std::string compare_text(const Comparison& c) {
  std::string out = trf("compare   {}: {}; {:.2f} % of the surface within {:g} mm\n", c.design,
                        tr(to_string(c.verdict)), c.within_percent(), c.tolerance_mm);
  if (c.gouge.mm > 0)
    out += trf("          gouge {}; {:.3f} mm3 in {}\n", worst_text(c.gouge), c.gouge_mm3,
               places_text(c.gouges));
  if (c.excess.mm > 0)
    out += trf("          excess {}; {:.3f} mm3 in {}\n", worst_text(c.excess), c.excess_mm3,
               places_text(c.excesses));
  if (c.piece > 0) out += trf("          of piece {}, which was parted off\n", c.piece);
  if (!c.placement.empty()) out += trf("          the design is {}\n", c.placement);
  if (c.fit_residue_mm)
    out += trf("          fitted, {:.4f} mm off in the root mean square\n", *c.fit_residue_mm);
  if (c.outside_mm3 > 0)
    out += trf("          {:.1f} mm3 of the design lie outside the blank\n", c.outside_mm3);
  out += c.walls_mm > 0
             ? trf("          exact to {:.4f} mm; walls of the model to {:.4f} mm, which is "
                   "taken off\n",
                   c.bound_mm, c.walls_mm)
             : trf("          exact to {:.4f} mm\n", c.bound_mm);
  return out;
}

void add_compare_findings(const Comparison& c, const std::vector<int>& guessed_tools,
                          FindingLog& log) {
  bool has_excess = false;
  for (const DeviationRegion& region : c.regions) {
    if (region.is_gouge) {
      const bool is_known = region.worst.by.source.line > 0;
      const bool is_guess =
          is_known && std::ranges::find(guessed_tools, region.worst.by.tool) != guessed_tools.end();
      Finding finding = deviation_finding(FindingId::kGouge,
                                          is_guess ? Severity::kWarning : Severity::kError, region);
      finding.text = is_known ? tr("the design part is cut into")
                              : tr("of the design part material is missing");
      if (is_guess) finding.hint = tr("the shape of the tool is a guess: --tool says it");
      log.add(std::move(finding));
    } else if (!has_excess) {
      has_excess = true;
      Finding finding = deviation_finding(FindingId::kExcess, Severity::kWarning, region);
      finding.text = tr("material is left over");
      if (c.excesses > 1)
        finding.hint = trf("the greatest of {} places; the report lists more", c.excesses);
      log.add(std::move(finding));
    }
  }
}

}  // namespace kerf
