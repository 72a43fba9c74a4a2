#include <fmt/format.h>

#include <algorithm>

#include "base/translate.h"
#include "twin/config/key_table.h"
#include "twin/config/live_config.h"

namespace kerf {
namespace {

constexpr std::size_t kPurposeColumn = 44;

/// Too many words for the column of the keys.
bool is_long(const Setting& spec) { return spec.words.size() > 24; }

std::string form_of(const Setting& spec) {
  switch (spec.type) {
    case KeyType::kGroup:
      return "";
    case KeyType::kGroups:
      return " [{..}, ..]";
    case KeyType::kText:
      return " TEXT";
    case KeyType::kFile:
    case KeyType::kFolder:
      return " FILE";
    case KeyType::kNumber:
      return " NUMBER";
    case KeyType::kWhole:
      return " WHOLE";
    case KeyType::kYesNo:
      return " yes|no";
    case KeyType::kTexts:
      return " [TEXT, ..]";
    case KeyType::kPairs:
      return " [[TEXT, TEXT], ..]";
    case KeyType::kWord:
      break;
  }
  return is_long(spec) ? " WORD" : fmt::format(" {}", spec.words);
}

/// Range and default, below the purpose; empty if there is neither.
std::string details_of(const Setting& spec) {
  std::string text;
  const bool number = spec.type == KeyType::kNumber || spec.type == KeyType::kWhole;
  if (number) text = allowed_text(spec);
  if (is_long(spec)) text = spec.words;
  if (!number && *spec.unit != 0) text = tr(spec.unit);
  if (!spec.fallback.empty()) {
    text += trf("{}default {}", text.empty() ? "" : "; ", spec.fallback);
  }
  return text;
}

std::string sources_of(const Setting& spec) {
  if (spec.sources == kForAny) return "";
  std::string text;
  const auto add = [&](SourceMask mask, const char* name) {
    if ((spec.sources & mask) == 0) return;
    text += fmt::format("{}{}", text.empty() ? "[" : ", ", name);
  };
  add(kForModbus, "modbus");
  add(kForCan, "can");
  add(kForHal, "hal");
  add(kForLog, "log");
  add(kForMtconnect, "mtconnect");
  return text + "] ";
}

}  // namespace

std::string schema_text() {
  std::string out = tr(
      "# Every key of a configuration (YAML). All are optional but source.type and what a source\n"
      "# cannot do without. [modbus] ..: a key of that type of source alone.\n");
  for (const Setting& spec : key_table()) {
    const auto depth = static_cast<std::size_t>(std::count(spec.key.begin(), spec.key.end(), '.'));
    const std::string_view name = spec.key.substr(spec.key.rfind('.') + 1);
    const std::string key =
        fmt::format("{}{}:{}", std::string(2 * depth, ' '), name, form_of(spec));
    out += fmt::format("{:<{}} # {}{}\n", key, kPurposeColumn, sources_of(spec), tr(spec.purpose));
    const std::string details = details_of(spec);
    if (!details.empty()) out += fmt::format("{:<{}} #   {}\n", "", kPurposeColumn, details);
  }
  return out;
}

}  // namespace kerf
