#include "stock/blank_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/translate.h"
#include "stock/cutter/scan.h"

namespace kerf {
namespace {

/// 100 m: beyond any machine.
constexpr double kMostShift_mm = 1e5;

Done read_three(std::string_view name, std::string_view text, const LengthUnit* unit, Vec3& out) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 3) {
    return Error{trf("{}: '{}' has {} {}; must be {}", name, shown(text), parts.size(),
                     parts.size() == 1 ? tr("value") : tr("values"), unit ? "x,y,z" : "A,B,C")};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view part = trim(parts[axis]);
    const Result<double> value = unit ? parse_length(fmt::format("{} {}", name, "XYZ"[axis]), part,
                                                     -kMostShift_mm, kMostShift_mm, *unit)
                                      : parse_within(fmt::format("{} {}", name, "ABC"[axis]), part,
                                                     -360, 360, tr("degrees"));
    if (!value) return Error{value.error()};
    out[static_cast<int>(axis)] = *value;
  }
  return std::monostate{};
}

std::string number(double value) { return fmt::format("{:.10g}", value + 0.0); }

}  // namespace

Placement BlankPlace::placement() const {
  Placement out = flip != 0 ? Placement::flipped(flip) : Placement();
  out = out.then(Placement::turned(rotate_deg));
  out.at_mm += at_mm;
  return out;
}

std::string BlankPlace::text() const {
  std::string out;
  if (flip != 0) out += trf(", flipped about {}", flip == 'x' ? 'X' : 'Y');
  if (rotate_deg != Vec3(0))
    out += trf(", turned by {}, {}, {} degrees about X, Y, Z", number(rotate_deg.x),
               number(rotate_deg.y), number(rotate_deg.z));
  if (at_mm != Vec3(0))
    out += trf(", its zero at X{} Y{} Z{}", number(at_mm.x), number(at_mm.y), number(at_mm.z));
  return out;
}

Result<BlankPlace> take_place(std::string_view& text, LengthUnit unit,
                              const std::vector<std::string_view>& words, std::string* found) {
  BlankPlace place;
  std::array<bool, 3> given{};
  bool has_word = false;
  for (std::size_t colon = text.rfind(':'); colon != std::string_view::npos;
       colon = text.rfind(':')) {
    const std::string_view field = trim(text.substr(colon + 1));
    const std::string lower = to_lower(field);
    constexpr std::array<std::string_view, 3> kNames{"flip=", "rotate=", "at="};
    const auto name = std::find_if(kNames.begin(), kNames.end(),
                                   [&](std::string_view n) { return lower.starts_with(n); });
    const bool is_word = std::find(words.begin(), words.end(), lower) != words.end();
    if (name == kNames.end() && !is_word) break;
    const std::string_view told = is_word ? std::string_view(lower) : *name;
    bool& before = is_word ? has_word : given[static_cast<std::size_t>(name - kNames.begin())];
    if (before) return Error{trf("'{}': {} is given twice", shown(field), told)};
    before = true;
    if (is_word) {
      *found = lower;
    } else {
      const std::string_view value = field.substr(name->size());
      if (*name == "flip=") {
        const std::string axis = to_lower(trim(value));
        if (axis != "x" && axis != "y")
          return Error{trf("'{}' is not allowed; must be flip=x or flip=y", shown(field))};
        place.flip = axis[0];
      } else if (*name == "at=") {
        if (const Done done = read_three("at", value, &unit, place.at_mm); !done)
          return Error{done.error()};
      } else if (const Done done = read_three("rotate", value, nullptr, place.rotate_deg); !done) {
        return Error{done.error()};
      }
    }
    text = text.substr(0, colon);
  }
  text = trim(text);
  return place;
}

}  // namespace kerf
