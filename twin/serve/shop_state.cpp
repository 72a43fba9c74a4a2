#include "twin/serve/shop_state.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/translate.h"
#include "base/units.h"
#include "twin/findings/finding_json.h"
#include "twin/live/live_text.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

using ShopJson = nlohmann::ordered_json;

std::string dumped(const ShopJson& json) {
  return json.dump(-1, ' ', false, ShopJson::error_handler_t::replace);
}

/// Without its braces.
std::string members_of(const ShopJson& json) {
  const std::string text = dumped(json);
  return text.substr(1, text.size() - 2);
}

std::int64_t now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

ShopJson profile_json(const std::vector<ProfilePoint>& profile) {
  ShopJson out = ShopJson::array();
  for (const ProfilePoint& point : profile) {
    out.push_back({rounded(point.radius_mm), rounded(point.height_mm)});
  }
  return out;
}

ShopJson tool_json(const ToolShape& shape) {
  ShopJson out;
  out["cutter"] = profile_json(shape.cutter);
  out["shank"] = profile_json(shape.shank);
  out["holder"] = profile_json(shape.holder);
  out["spindle"] = profile_json(shape.spindle);
  ShopJson plates = ShopJson::array();
  for (const ToolPlate& plate : shape.plates) {
    ShopJson corners = ShopJson::array();
    for (const ToolPlate::Corner& corner : plate.corners) {
      corners.push_back({rounded(corner.zx_mm.x), rounded(corner.zx_mm.y)});
    }
    plates.push_back({{"corners", corners},
                      {"low", rounded(plate.low_y_mm)},
                      {"high", rounded(plate.high_y_mm)},
                      {"is_holder", plate.is_holder}});
  }
  out["plates"] = std::move(plates);
  return out;
}

}  // namespace

std::string place_text(const Vec3& mm, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return fmt::format("X{:.3f} Y{:.3f} Z{:.3f}", mm.x, mm.y, mm.z);
  const Vec3 inch = mm / kMmPerInch;
  return fmt::format("X{:.4f} Y{:.4f} Z{:.4f}", inch.x, inch.y, inch.z);
}

std::string line_text(const std::string& file, int line) {
  return fmt::format("{}:{}", file_name(file), line);
}

ShopMoment moment_of(const LiveStatus& status, const std::string& tool_name, LengthUnit unit) {
  const ToolState& place = status.place;
  ShopMoment out;
  out.state = to_string(status.state);
  out.state_text = tr(to_string(status.state));
  if (status.state != LiveState::kWaiting && status.state != LiveState::kEnded)
    out.age_s = status.age_s;
  const auto add = [&](const std::string& name, const std::string& value) {
    out.rows.emplace_back(name, value);
  };
  if (place.has_program_place()) {
    out.file = status.file;
    out.line = static_cast<int>(place.source.line);
    add(tr("Program"), line_text(out.file, out.line));
  }
  if (place.has_program_place() && status.remaining_s >= 0)
    add(tr("Time left"), time_left_text(status.remaining_s));
  if (place.known) {
    out.tip_mm = place.tip_mm;
    add(tr("Position"), place_text(place.tip_mm, unit));
  }
  out.axis = place.spindle;
  if (place.tool >= 0) add(tr("Tool"), fmt::format("T{} {}", place.tool, tool_name));
  if (status.feed_mm_per_min)
    add(tr("Feed"), in_unit(fmt::format("{:.0f} mm/min", *status.feed_mm_per_min), unit));
  if (std::isfinite(place.spindle_rpm))
    add(tr("Spindle"), fmt::format("{:.0f} rpm", place.spindle_rpm));
  if (status.load) add(tr("Load"), text_of(*status.load));
  if (status.run > 1) add(tr("Run"), trf("{}, part {}", status.run, status.part));
  add(tr("Removed"), in_unit(fmt::format("{:.2f} cm3", status.removed_mm3 / 1000), unit));
  if (status.dropped > 0 || status.source.lost > 0)
    add(tr("Lost positions"), std::to_string(status.dropped + status.source.lost));
  out.notice = in_unit(notice_of(status), unit);
  out.is_alarm = status.collision_in_s >= 0;
  return out;
}

ShopMoment waiting_moment(const std::string& notice) {
  ShopMoment out;
  out.state_text = tr(to_string(LiveState::kWaiting));
  out.notice = notice;
  return out;
}

std::string state_members(const ShopMoment& moment, const std::vector<ShownLine>& code) {
  ShopJson out;
  out["state"] = moment.state;
  out["state_text"] = moment.state_text;
  out["age_s"] = moment.age_s ? ShopJson(rounded(*moment.age_s)) : ShopJson(nullptr);
  out["told_ms"] = now_ms();
  out["rows"] = ShopJson::array();
  for (const auto& [name, value] : moment.rows) out["rows"].push_back({name, value});
  out["notice"] = moment.notice;
  out["is_alarm"] = moment.is_alarm;
  out["line"] = moment.line;
  out["code"] = ShopJson::array();
  for (const ShownLine& line : code) out["code"].push_back({line.number, line.text});
  out["tip_mm"] = moment.tip_mm ? vector_json(*moment.tip_mm) : ShopJson(nullptr);
  out["axis"] = vector_json(moment.axis);
  return members_of(out);
}

std::string setup_members(const ShopSetup& setup) {
  ShopJson out;
  out["title"] = setup.title;
  out["source"] = setup.source;
  out["box"] = {vector_json(setup.blank_mm.min), vector_json(setup.blank_mm.max)};
  out["turns"] = setup.turns;
  out["tool_shape"] = setup.tool != nullptr ? tool_json(*setup.tool) : ShopJson(nullptr);
  return members_of(out);
}

std::string finding_object(const Finding& finding, const std::vector<std::string>& files,
                           bool is_ahead, LengthUnit unit) {
  const Diagnostic told = in_unit(diagnostic_of(finding, files), unit);
  ShopJson out;
  out["severity"] = to_string(finding.severity);
  out["text"] = is_ahead ? tr("ahead: ") + told.message : told.message;
  out["file"] = file_name(told.file);
  out["line"] = told.line;
  return dumped(out);
}

}  // namespace kerf
