#include "cutting/material.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kOfEachDegree = 0.01;

std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c == '-' || c == '_' || c == ' ' || c == '.') continue;
    out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

}  // namespace

const Material* find_material(std::span<const Material> materials, std::string_view name) {
  const std::string wanted = plain(name);
  for (const Material& material : materials) {
    if (plain(material.name) == wanted) return &material;
  }
  for (const Material& material : materials) {
    const auto is_wanted = [&](const std::string& alias) { return plain(alias) == wanted; };
    if (std::any_of(material.aliases.begin(), material.aliases.end(), is_wanted)) return &material;
  }
  return nullptr;
}

Result<const Material*> need_material(std::span<const Material> materials, std::string_view name) {
  if (const Material* found = find_material(materials, name)) return found;
  std::vector<std::string> allowed, names;
  for (const Material& material : materials) {
    names.push_back(material.name);
    allowed.push_back(material.name);
    allowed.insert(allowed.end(), material.aliases.begin(), material.aliases.end());
  }
  std::string small(name);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string nearest = nearest_word(small, allowed);
  const std::string shown_name = shown(name);
  if (!nearest.empty())
    return Error{trf("there is no material '{}'; did you mean '{}'?", shown_name, nearest)};
  return Error{trf("there is no material '{}'; there are: {}", shown_name,
                   fmt::to_string(fmt::join(names, ", ")))};
}

ValueRange kc11_at_rake(const Material& material, std::optional<double> rake_deg) {
  if (!rake_deg) return material.kc11_n_per_mm2;
  return material.kc11_n_per_mm2.times((1 - kOfEachDegree * *rake_deg) /
                                       (1 - kOfEachDegree * material.rake_deg));
}

}  // namespace kerf
