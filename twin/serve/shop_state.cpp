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

class Rows {
 public:
  explicit Rows(LengthUnit unit) : unit_(unit) {}
  void add(const std::string& name, const std::string& value) {
    rows_.push_back({name, in_unit(value, unit_)});
  }
  void add_as_it_is(const std::string& name, const std::string& value) {
    rows_.push_back({name, value});
  }
  ShopJson take() { return std::move(rows_); }

 private:
  LengthUnit unit_;
  ShopJson rows_ = ShopJson::array();
};

/// As many digits whatever the place: it changes ten times a second.
std::string place_text(const Vec3& mm, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return fmt::format("X{:.3f} Y{:.3f} Z{:.3f}", mm.x, mm.y, mm.z);
  const Vec3 inch = mm / kMmPerInch;
  return fmt::format("X{:.4f} Y{:.4f} Z{:.4f}", inch.x, inch.y, inch.z);
}

ShopJson rows_of(const LiveStatus& status, const std::string& tool_name, LengthUnit unit) {
  const ToolState& place = status.place;
  Rows rows(unit);
  if (place.followed) {
    rows.add(tr("Program"), fmt::format("{}:{}", file_name(status.file), place.source.line));
  }
  if (place.followed && status.remaining_s >= 0) {
    rows.add(tr("Time left"), time_left_text(status.remaining_s));
  }
  if (place.known) {
    rows.add_as_it_is(tr("Position"), place_text(place.tip_mm, unit));
  }
  if (place.tool >= 0) rows.add(tr("Tool"), fmt::format("T{} {}", place.tool, tool_name));
  if (status.feed_mm_per_min) {
    rows.add(tr("Feed"), fmt::format("{:.0f} mm/min", *status.feed_mm_per_min));
  }
  if (std::isfinite(place.spindle_rpm)) {
    rows.add(tr("Spindle"), fmt::format("{:.0f} rpm", place.spindle_rpm));
  }
  if (status.load) rows.add(tr("Load"), text_of(*status.load));
  if (status.run > 1) {
    rows.add(tr("Run"), trf("{}, part {}", status.run, status.part));
  }
  rows.add(tr("Removed"), fmt::format("{:.2f} cm3", status.removed_mm3 / 1000));
  if (status.dropped > 0 || status.source.lost > 0) {
    rows.add(tr("Lost positions"), std::to_string(status.dropped + status.source.lost));
  }
  return rows.take();
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

std::string state_members(const LiveStatus& status, const std::string& tool_name,
                          const std::vector<ShownLine>& code, LengthUnit unit) {
  const ToolState& place = status.place;
  ShopJson out;
  out["state"] = to_string(status.state);
  out["state_text"] = tr(to_string(status.state));
  out["age_s"] = rounded(status.age_s);
  out["told_ms"] = now_ms();
  out["rows"] = rows_of(status, tool_name, unit);
  out["notice"] = in_unit(notice_of(status), unit);
  out["is_alarm"] = status.collision_in_s >= 0;
  out["line"] = place.followed ? place.source.line : 0;
  out["code"] = ShopJson::array();
  for (const ShownLine& line : code) out["code"].push_back({line.number, line.text});
  out["tip_mm"] = place.known ? vector_json(place.tip_mm) : ShopJson(nullptr);
  out["axis"] = vector_json(place.spindle);
  return members_of(out);
}

std::string waiting_members(const std::string& notice) {
  LiveStatus status;
  ShopJson out;
  out["state"] = to_string(status.state);
  out["state_text"] = tr(to_string(status.state));
  out["age_s"] = 0;
  out["told_ms"] = now_ms();
  out["rows"] = ShopJson::array();
  out["notice"] = notice;
  out["is_alarm"] = false;
  out["line"] = 0;
  out["code"] = ShopJson::array();
  out["tip_mm"] = nullptr;
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
