#include "machine_io/mtconnect/mtconnect_settings.h"

#include <algorithm>
#include <cmath>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr const char* kItemKeys[kMaxPositions] = {"X", "Y", "Z", "A", "B", "C", "U", "V", "W"};

void check_item(std::string_view key, const std::optional<ChosenItem>& chosen,
                std::vector<std::string>& faults) {
  if (!chosen) return;
  const auto add = [&](std::string_view part, const auto& found, std::string_view allowed) {
    faults.push_back(trf("map.{}.{}: {} is not allowed; must be {}", key, part, found, allowed));
  };
  if (chosen->item.empty()) add("item", "''", tr("the id or the name of a data item"));
  if (!std::isfinite(chosen->scale) || chosen->scale == 0) {
    add("scale", chosen->scale, tr("a number other than 0"));
  }
  if (!std::isfinite(chosen->offset)) add("offset", chosen->offset, tr("a number"));
}

/// http://HOST[:PORT][/PATH], without a query.
bool is_agent_url(std::string_view url) {
  if (!take_prefix(url, "http://") && !take_prefix(url, "https://")) return false;
  const std::string_view host = url.substr(0, url.find('/'));
  if (host.empty() || host.front() == ':' || host.size() > 1024) return false;
  return std::all_of(url.begin(), url.end(), [](char c) {
    return static_cast<unsigned char>(c) > ' ' && c != '?' && c != '#' && c != '"';
  });
}

}  // namespace

bool MtconnectSettings::chooses_axes() const {
  return std::any_of(axes.begin(), axes.end(), [](const auto& axis) { return axis.has_value(); });
}

std::vector<std::string> validate(const MtconnectSettings& settings) {
  std::vector<std::string> faults;
  const auto need = [&](bool good, std::string_view key, const auto& found,
                        std::string_view allowed) {
    if (!good) faults.push_back(trf("{}: {} is not allowed; must be {}", key, found, allowed));
  };
  need(is_agent_url(settings.url), "url", "'" + shown(settings.url) + "'",
       tr("http://HOST:PORT or https://HOST:PORT"));
  need(settings.interval_ms >= 0 && settings.interval_ms <= 10000, "interval_ms",
       settings.interval_ms, tr("0 to 10000 (ms)"));
  need(settings.heartbeat_ms >= 10 && settings.heartbeat_ms <= 60000, "heartbeat_ms",
       settings.heartbeat_ms, tr("10 to 60000 (ms)"));
  need(settings.gather_ms >= 0 && settings.gather_ms <= 10000, "gather_ms", settings.gather_ms,
       tr("0 to 10000 (ms)"));
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    check_item(kItemKeys[i], settings.axes[i], faults);
  }
  check_item("tool", settings.tool, faults);
  check_item("line", settings.line, faults);
  check_item("spindle", settings.spindle, faults);
  check_item("tool_offset_z", settings.tool_offset_z, faults);
  check_item("load", settings.load, faults);
  return faults;
}

}  // namespace kerf
