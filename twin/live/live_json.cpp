#include "twin/live/live_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "machine_io/recording_format.h"
#include "twin/findings/finding_json.h"
#include "twin/report/run_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

Json known(double value, bool is_known) {
  return is_known && std::isfinite(value) ? Json(rounded(value)) : Json(nullptr);
}

Json event(const char* name, const EventHead& head) {
  Json out;
  out["event"] = name;
  out["instance_id"] = head.instance_id;
  out["sequence"] = head.sequence;
  out["time"] = iso_time(head.time_ns);
  return out;
}

Json load_json(const std::optional<LoadNow>& load) {
  if (!load) return nullptr;
  Json out;
  out["unit"] = word_of(load->unit);
  out["measured"] = rounded(load->measured);
  out["low"] = known(load->low.value_or(0), load->low.has_value());
  out["high"] = known(load->high.value_or(0), load->high.has_value());
  return out;
}

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string status_json(const LiveStatus& status, const EventHead& head) {
  const ToolState& place = status.place;
  const bool placed = place.has_program_place();
  Json out = event("status", head);
  out["state"] = to_string(status.state);
  out["age_ms"] = rounded(status.age_s * 1e3);
  out["t_s"] = rounded(status.t_s);
  out["run"] = status.run;
  out["part"] = status.part;
  out["samples"] = status.samples;
  out["errors"] = status.source.errors;
  out["lost"] = status.source.lost;
  out["dropped"] = status.dropped;
  out["tip_mm"] = place.known ? vector_json(place.tip_mm) : Json(nullptr);
  out["tool"] = place.tool >= 0 ? Json(place.tool) : Json(nullptr);
  out["on_path"] = place.followed;
  out["distance_mm"] = known(place.distance_mm, place.known);
  out["file"] = placed ? Json(status.file) : Json(nullptr);
  out["line"] = placed ? Json(place.source.line) : Json(nullptr);
  out["program_s"] = known(place.program_s, placed);
  out["remaining_s"] = known(status.remaining_s, placed && status.remaining_s >= 0);
  out["removed_mm3"] = rounded(status.removed_mm3);
  out["load"] = load_json(status.load);
  out["collision_in_s"] = known(status.collision_in_s, status.collision_in_s >= 0);
  out["collision_line"] = status.collision_in_s >= 0 ? Json(status.collision_line) : Json(nullptr);
  return line_of(out);
}

std::string finding_event_json(const Finding& finding, const std::vector<std::string>& files,
                               const EventHead& head) {
  Json out = event("finding", head);
  out.update(finding_json(finding, files));
  return line_of(out);
}

std::string ahead_json(const AheadWarning& warning, const std::vector<std::string>& files,
                       const EventHead& head) {
  Json out = event("ahead", head);
  out["t_s"] = rounded(warning.t_s);
  out["in_s"] = rounded(warning.in_s);
  out.update(finding_json(warning.finding, files));
  return line_of(out);
}

std::string run_event_json(const LiveRun& run, const EventHead& head) {
  Json out = event("run", head);
  out.update(run_json(run));
  return line_of(out);
}

}  // namespace kerf
