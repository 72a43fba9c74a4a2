#include "stock/cutter/tool_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/suggest.h"
#include "base/translate.h"
#include "stock/cutter/profile_file.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_limits.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxParts = 64;
/// A cone whose rise is a whole number of steps, up to rounding, has no step more.
constexpr double kRounding = 1e-9;

/// Where the '-' of "28-46" is; that of an exponent is none.
std::size_t find_cone(std::string_view text) {
  for (std::size_t at = text.find('-'); at != text.npos; at = text.find('-', at + 1)) {
    if (at > 0 && to_lower(text[at - 1]) != 'e') return at;
  }
  return text.npos;
}

Result<HolderSection> parse_section(std::string_view what, std::string_view text,
                                    bool length_needed, LengthUnit unit) {
  const std::size_t cross = text.find_first_of("xX");
  const std::string_view widths = text.substr(0, cross);
  const std::size_t cone = find_cone(widths);
  HolderSection section;
  const Result<double> lower = parse_length(trf("{} diameter", what), widths.substr(0, cone),
                                            kMinDiameter_mm, kMaxDiameter_mm, unit);
  if (!lower) return Error{lower.error()};
  section.lower_mm = section.upper_mm = *lower;
  if (cone != widths.npos) {
    const Result<double> upper = parse_length(trf("{} diameter", what), widths.substr(cone + 1),
                                              kMinDiameter_mm, kMaxDiameter_mm, unit);
    if (!upper) return Error{upper.error()};
    section.upper_mm = *upper;
  }
  if (cross == text.npos) {
    if (length_needed || cone != widths.npos) {
      return Error{trf("{}: '{}' has no length; write DxL ({})", what, shown(text), name_of(unit))};
    }
    return section;
  }
  const Result<double> length = parse_length(trf("{} length", what), text.substr(cross + 1),
                                             kMinLength_mm, kMaxLength_mm, unit);
  if (!length) return Error{length.error()};
  section.length_mm = *length;
  return section;
}

Result<ToolPart> parse_named(std::string_view text) {
  const NamedHolder* const named = find_holder(text);
  if (named) return ToolPart{std::string(named->name), {named->section}};
  std::vector<std::string_view> names;
  for (const NamedHolder& holder : named_holders()) names.push_back(holder.name);
  return Error{
      trf("unknown holder '{}'{} `kerf tools --holders` lists them; or its sections, "
          "DxL[+DxL..]",
          shown(text), did_you_mean(to_lower(text), names))};
}

Result<std::vector<ToolPart>> parse_stack(std::string_view what, std::string_view text,
                                          bool is_holder, LengthUnit unit) {
  const std::vector<std::string_view> texts = split(text, '+');
  if (texts.size() > kMaxParts) {
    return Error{trf("{}: {} sections; at most {} are allowed", what, texts.size(), kMaxParts)};
  }
  std::vector<ToolPart> parts;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (is_holder && !texts[i].empty() && is_letter(texts[i].front())) {
      Result<ToolPart> named = parse_named(texts[i]);
      if (!named) return Error{named.error()};
      parts.push_back(std::move(named.value()));
      continue;
    }
    const bool length_needed = is_holder || i + 1 < texts.size();
    const Result<HolderSection> section = parse_section(what, texts[i], length_needed, unit);
    if (!section) return Error{section.error()};
    parts.push_back({"", {*section}});
  }
  return parts;
}

}  // namespace

Result<std::vector<ToolPart>> parse_shank(std::string_view text, LengthUnit unit) {
  return parse_stack("shank", text, false, unit);
}

Result<std::vector<ToolPart>> parse_holder(std::string_view text, LengthUnit unit) {
  constexpr std::string_view kProfile = "profile:";
  if (to_lower(text.substr(0, kProfile.size())) == kProfile) {
    const std::string path(text.substr(kProfile.size()));
    if (path.empty()) return Error{tr("holder: file name FILE is missing after profile:")};
    if (path.find('\0') != path.npos) return Error{tr("a file name cannot hold NUL")};
    Result<std::vector<HolderSection>> sections = read_holder_profile(path);
    if (!sections) return Error{sections.error()};
    return std::vector<ToolPart>{{std::string(kProfile) + path, std::move(sections.value())}};
  }
  return parse_stack("holder", text, true, unit);
}

std::string parts_text(const std::vector<ToolPart>& parts) {
  std::string text;
  for (const ToolPart& part : parts) {
    if (!text.empty()) text += '+';
    if (!part.name.empty()) {
      text += part.name;
      continue;
    }
    const HolderSection& section = part.sections.front();
    text += number_text(section.lower_mm);
    if (section.upper_mm != section.lower_mm) text += '-' + number_text(section.upper_mm);
    if (section.length_mm > 0) text += 'x' + number_text(section.length_mm);
  }
  return text;
}

std::string parts_in(std::string_view text, LengthUnit unit) {
  std::string out;
  while (true) {
    const std::size_t end =
        std::min({text.find_first_of("xX+"), find_cone(text.substr(0, text.find_first_of("xX+"))),
                  text.size()});
    const std::optional<double> mm = parse_decimal(text.substr(0, end));
    out += mm ? length_number(*mm, unit) : std::string(text.substr(0, end));
    if (end == text.size()) return out;
    out += text[end];
    text.remove_prefix(end + 1);
  }
}

std::vector<ToolSection> sections_of(const std::vector<ToolPart>& parts, double from_z_mm) {
  std::vector<ToolSection> out;
  double z = from_z_mm;
  for (const ToolPart& part : parts) {
    for (const HolderSection& section : part.sections) {
      const double rise_mm = (section.upper_mm - section.lower_mm) / 2;
      const int steps =
          std::max(1, static_cast<int>(std::ceil(std::abs(rise_mm) / kConeStep_mm - kRounding)));
      const auto at = [&](int step) {
        return section.lower_mm + (section.upper_mm - section.lower_mm) * step / steps;
      };
      for (int i = 0; i < steps; ++i) {
        out.push_back({std::max(at(i), at(i + 1)), z + section.length_mm * i / steps,
                       z + section.length_mm * (i + 1) / steps});
      }
      z += section.length_mm;
    }
  }
  return out;
}

}  // namespace kerf
