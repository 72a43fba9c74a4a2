#include "twin/tool_library/json_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/geometry.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"

namespace kerf {
namespace {

struct Unit {
  std::string_view name;
  double factor;
};
constexpr std::array kLengthUnits{Unit{"mm", 1},          Unit{"in", 25.4},  Unit{"\"", 25.4},
                                  Unit{"cm", 10},         Unit{"m", 1000},   Unit{"um", 0.001},
                                  Unit{"\u00b5m", 0.001}, Unit{"ft", 304.8}, Unit{"'", 304.8}};
constexpr std::array kAngleUnits{Unit{"", 1}, Unit{"\u00b0", 1}, Unit{"deg", 1},
                                 Unit{"rad", 180 / kPi}};

/// A number and the unit behind it. In some languages the decimal sign is a comma.
struct Measured {
  double value;
  std::string_view unit;
};
std::optional<Measured> measured(std::string_view text, std::string& kept) {
  kept = std::string(trim(text));
  std::replace(kept.begin(), kept.end(), ',', '.');
  const std::size_t end = std::min(kept.find_first_not_of("+-.0123456789eE"), kept.size());
  const std::optional<double> value = parse_decimal(std::string_view(kept).substr(0, end));
  if (!value) return std::nullopt;
  return Measured{*value, trim(std::string_view(kept).substr(end))};
}

std::optional<double> in_units(const Json& value, std::span<const Unit> units, double bare) {
  if (value.is_number()) return value.get<double>() * bare;
  if (!value.is_string()) return std::nullopt;
  std::string kept;
  const std::optional<Measured> number = measured(value.get_ref<const std::string&>(), kept);
  if (!number) return std::nullopt;
  if (number->unit.empty()) return number->value * bare;
  for (const Unit& unit : units) {
    if (number->unit == unit.name) return number->value * unit.factor;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Json> parse_json(std::string_view text, const std::string& path,
                               Diagnostics& diagnostics) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& fault) {
    // Its own words name a byte; people count lines.
    Diagnostic d;
    d.file = path;
    d.message = tr("is JSON with a number that is too large");
    if (const auto* const parse = dynamic_cast<const Json::parse_error*>(&fault)) {
      const std::string_view before = text.substr(0, parse->byte > 0 ? parse->byte - 1 : 0);
      d.line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
      const std::size_t newline = before.rfind('\n');
      d.column = static_cast<int>(before.size() - (newline == before.npos ? 0 : newline + 1)) + 1;
      d.message = parse->byte > text.size() ? tr("the file ends within its JSON; it is not whole")
                                            : tr("is no JSON from here on");
    }
    diagnostics.push_back(std::move(d));
    return std::nullopt;
  }
}

const Json* member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto at = object.find(name);
  return at == object.end() || at->is_null() ? nullptr : &*at;
}

std::string text_of(const Json* value) {
  return value != nullptr && value->is_string()
             ? std::string(trim(value->get_ref<const std::string&>()))
             : std::string();
}

const Json* JsonFields::find(const char* name) const {
  return object_ == nullptr ? nullptr : member(*object_, name);
}

std::optional<double> JsonFields::fault(const char* name, const Json& value, const char* wanted) {
  const std::string found = shown(value.dump(-1, ' ', false, Json::error_handler_t::replace));
  faults_.push_back(fmt::format("{}{}: {}", prefix_, name,
                                formatted(wanted, tr(wanted), fmt::make_format_args(found))));
  return std::nullopt;
}

std::optional<double> JsonFields::length_mm(const char* name) {
  const Json* const value = find(name);
  if (value == nullptr) return std::nullopt;
  const std::optional<double> mm = in_units(*value, kLengthUnits, mm_);
  return mm && std::isfinite(*mm) ? mm : fault(name, *value, tr_noop("{} is no length"));
}

std::optional<double> JsonFields::angle_deg(const char* name) {
  const Json* const value = find(name);
  if (value == nullptr) return std::nullopt;
  const std::optional<double> deg = in_units(*value, kAngleUnits, 1);
  return deg && std::isfinite(*deg) ? deg : fault(name, *value, tr_noop("{} is no angle"));
}

std::optional<double> JsonFields::number(const char* name) {
  const Json* const value = find(name);
  if (value == nullptr) return std::nullopt;
  const std::optional<double> number = in_units(*value, {}, 1);
  return number && std::isfinite(*number) ? number
                                          : fault(name, *value, tr_noop("{} is no number"));
}

std::optional<double> JsonFields::positive_mm(const char* name) {
  const std::optional<double> mm = length_mm(name);
  return mm && *mm > 0 ? mm : std::nullopt;
}

}  // namespace kerf
