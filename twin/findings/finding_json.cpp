#include "twin/findings/finding_json.h"

#include <cmath>
#include <optional>

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& value) {
  return value ? Json(rounded(*value)) : Json(nullptr);
}

}  // namespace

double rounded(double value) {
  const double r = std::round(value * 1e6) / 1e6;
  return r == 0 ? 0.0 : r;
}

Json vector_json(const Vec3& v) { return Json::array({rounded(v.x), rounded(v.y), rounded(v.z)}); }

Json finding_json(const Finding& finding, const std::vector<std::string>& files) {
  Json item;
  item["id"] = to_string(finding.id);
  item["severity"] = to_string(finding.severity);
  item["file"] = diagnostic_of(finding, files).file;
  item["line"] = finding.source.line;
  item["time_s"] = number_or_null(finding.time_s);
  item["position_mm"] = finding.position_mm ? vector_json(*finding.position_mm) : Json(nullptr);
  item["tool"] = finding.tool ? Json(*finding.tool) : Json(nullptr);
  item["depth_mm"] = number_or_null(finding.depth_mm);
  item["bodies"] = finding.has_bodies() ? Json(finding.bodies) : Json(nullptr);
  if (finding.times > 1) item["times"] = finding.times;
  item["message"] = message_of(finding);
  return item;
}

}  // namespace kerf
