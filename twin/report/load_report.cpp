#include "twin/report/load_report.h"

#include <fmt/format.h>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/job/load_text.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

void add(Json& out, const char* name, const char* unit, const LoadSpread& spread,
         const ValueRange* most = nullptr) {
  out[fmt::format("{}_max_{}", name, unit)] = rounded(most ? most->nominal : spread.most());
  if (most)
    out[fmt::format("{}_range_{}", name, unit)] =
        Json::array({rounded(most->low), rounded(most->high)});
  out[fmt::format("{}_p50_{}", name, unit)] = rounded(spread.not_above(0.5));
  out[fmt::format("{}_p95_{}", name, unit)] = rounded(spread.not_above(0.95));
  out[fmt::format("{}_line", name)] = spread.most_at().line;
}

std::string most_text(const char* unit, const LoadSpread& spread, const ValueRange& most) {
  return trf("{} {} ({} to {}, line {})", load_text(most.nominal), unit, load_text(most.low),
             load_text(most.high), spread.most_at().line);
}

}  // namespace

void add_loads(Json& out, const ToolLoads& loads) {
  add(out, "chip", "mm", loads.chip_mm);
  add(out, "speed", "m_min", loads.speed_m_per_min);
  if (loads.has_forces) {
    add(out, "force", "n", loads.force_n, &loads.force_most_n);
    add(out, "torque", "nm", loads.torque_nm, &loads.torque_most_nm);
    add(out, "power", "kw", loads.power_kw, &loads.power_most_kw);
  }
  if (loads.has_bend) {
    add(out, "deflection", "mm", loads.bend_mm, &loads.bend_most_mm);
    add(out, "wall", "mm", loads.wall_mm, &loads.wall_most_mm);
  }
}

std::string loads_text(const ToolLoads& loads, bool is_speed_said) {
  const std::string indent = "\n              ";
  std::string out =
      indent + trf("chips {:.2g} mm thick at most (line {}), {:.2g} mm half of the time",
                   loads.chip_mm.most(), loads.chip_mm.most_at().line,
                   loads.chip_mm.not_above(0.5));
  if (!is_speed_said && loads.speed_m_per_min.seconds() > 0)
    out += trf(", cutting speed {} m/min at most (line {})",
               load_text(loads.speed_m_per_min.most()), loads.speed_m_per_min.most_at().line);
  if (loads.has_forces) {
    out += indent + trf("at most {}", most_text("N", loads.force_n, loads.force_most_n));
    out += ", " + most_text("Nm", loads.torque_nm, loads.torque_most_nm);
    out += ", " + most_text("kW", loads.power_kw, loads.power_most_kw);
  }
  if (loads.has_bend) {
    out += indent + trf("its tip bends by {}", most_text("mm", loads.bend_mm, loads.bend_most_mm));
    const ValueRange& wall = loads.wall_most_mm;
    if (wall.nominal > 0)
      out += trf("; walls are left {:.2g} mm too thick", wall.nominal);
    else if (wall.nominal < 0)
      out += trf("; walls are cut {:.2g} mm too thin", -wall.nominal);
  }
  return out;
}

Json material_json(const Material& material) {
  return {{"name", material.name},
          {"kc11_n_per_mm2",
           {material.kc11_n_per_mm2.low, material.kc11_n_per_mm2.nominal,
            material.kc11_n_per_mm2.high}},
          {"mc", material.mc},
          {"rake_deg", material.rake_deg},
          {"source", material.source}};
}

}  // namespace kerf
