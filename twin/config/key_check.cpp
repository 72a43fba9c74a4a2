#include "twin/config/key_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// What is shown of a value.
std::string shown(const ConfigNode& node) {
  if (node.kind != NodeKind::kScalar) return to_string(node.kind);
  constexpr std::size_t kLongest_bytes = 60;
  if (node.scalar.size() <= kLongest_bytes) return fmt::format("'{}'", node.scalar);
  return fmt::format("'{}...'", node.scalar.substr(0, kLongest_bytes));
}

std::string source_names(std::uint8_t mask) {
  std::vector<std::string> names;
  if ((mask & kForModbus) != 0) names.emplace_back("modbus");
  if ((mask & kForCan) != 0) names.emplace_back("can");
  if ((mask & kForHal) != 0) names.emplace_back("hal");
  if ((mask & kForLog) != 0) names.emplace_back("log");
  if ((mask & kForMtconnect) != 0) names.emplace_back("mtconnect");
  return fmt::format("{}", fmt::join(names, tr(" and ")));
}

bool segment_matches(std::string_view segment, const std::string& key) {
  if (segment == "ITEM") {
    return std::find(item_names().begin(), item_names().end(), key) != item_names().end();
  }
  if (segment == "PIN") {
    return std::find(pin_names().begin(), pin_names().end(), key) != pin_names().end();
  }
  if (segment == "NUMBER") {
    return !key.empty() && key.size() <= 9 && key.find_first_not_of("0123456789") == key.npos;
  }
  return segment == key;
}

/// The last part of the path if `group` is all before it; empty if not.
std::string_view name_below(const Setting& spec, std::string_view group) {
  const std::size_t dot = spec.key.rfind('.');
  const std::string_view parent = dot == spec.key.npos ? "" : spec.key.substr(0, dot);
  if (parent != group) return {};
  return dot == spec.key.npos ? spec.key : spec.key.substr(dot + 1);
}

std::optional<double> number_of(std::string_view text, bool whole) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text[0] == '-' || text[0] == '+') return std::nullopt;
  double value = 0;
  if (whole && (text.starts_with("0x") || text.starts_with("0X"))) {
    std::uint64_t bits = 0;
    if (!read_number(text.substr(2), bits, 16)) return std::nullopt;
    value = static_cast<double>(bits);
  } else if (!read_number(text, value) || !std::isfinite(value)) {
    return std::nullopt;
  }
  return negative ? -value : value;
}

std::optional<bool> yes_no(std::string_view given) {
  const std::string text = to_lower(given);
  if (text == "yes" || text == "true" || text == "on") return true;
  if (text == "no" || text == "false" || text == "off") return false;
  return std::nullopt;
}

class KeyChecker {
 public:
  KeyChecker(ConfigFaults& faults, std::uint8_t type) : faults_(faults), type_(type) {}

  void check_group(ConfigNode& group, std::string_view pattern) {
    for (const auto& node : group.children) check_key(*node, group, pattern);
  }

 private:
  void check_key(ConfigNode& node, const ConfigNode& group, std::string_view pattern) {
    const Setting* found = nullptr;
    const Setting* found_elsewhere = nullptr;
    for (const Setting& spec : key_table()) {
      const std::string_view name = name_below(spec, pattern);
      if (name.empty() || !segment_matches(name, node.key)) continue;
      if ((spec.sources & type_) == 0) {
        found_elsewhere = &spec;
      } else if (found == nullptr) {
        found = &spec;
      }
    }
    const bool small_item = is_small_item(group.key, pattern);
    if (found != nullptr && found->axes_only && small_item) {
      faults_.at_key(node, tr("only axes have this key"));
    } else if (found != nullptr && found->load_only && group.key != "load") {
      faults_.at_key(node, tr("only load has this key"));
    } else if (found != nullptr) {
      check_value(node, *found);
    } else if (found_elsewhere != nullptr) {
      faults_.at_key(node, trf("is a key of sources of type {}; this one is {}",
                               source_names(found_elsewhere->sources), source_names(type_)));
    } else {
      unknown(node, pattern, small_item, group.key);
    }
  }

  static bool is_small_item(const std::string& item, std::string_view pattern) {
    return pattern.ends_with(".ITEM") && axis_of_item(item) < 0 && joint_of_item(item) < 0;
  }

  void unknown(ConfigNode& node, std::string_view pattern, bool small_item, std::string_view item) {
    std::vector<std::string> names;
    for (const Setting& spec : key_table()) {
      const std::string_view name = name_below(spec, pattern);
      if (name.empty() || (spec.sources & type_) == 0 || (spec.axes_only && small_item)) continue;
      if (spec.load_only && item != "load") continue;
      if (name == "NUMBER") {
        faults_.at_key(node, tr("is no tool number; must be a whole number, 1 to 99999"),
                       tr("as in 3: flat:6"));
        return;
      }
      if (name == "ITEM") {
        names.insert(names.end(), item_names().begin(), item_names().end());
      } else if (name == "PIN") {
        names.insert(names.end(), pin_names().begin(), pin_names().end());
      } else {
        names.emplace_back(name);
      }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const std::string near = nearest_key(node.key, names);
    if (!near.empty()) {
      faults_.at_key(node, tr("unknown key"), trf("did you mean {}?", near));
    } else {
      faults_.at_key(node, tr("unknown key"), trf("here may be: {}", fmt::join(names, ", ")));
    }
  }

  /// A letter more or less says nothing in names of one letter.
  static std::string nearest_key(const std::string& key, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (std::equal(name.begin(), name.end(), key.begin(), key.end(),
                     [](char a, char b) { return (a | 0x20) == (b | 0x20); })) {
        return name;
      }
    }
    if (key.size() <= 2) return {};
    std::vector<std::string> words;
    std::copy_if(names.begin(), names.end(), std::back_inserter(words),
                 [](const std::string& name) { return name.size() > 2; });
    return nearest_word(key, words);
  }

  void check_value(ConfigNode& node, const Setting& spec) {
    if (spec.type == KeyType::kGroup) {
      if (node.kind == NodeKind::kMap) {
        check_group(node, spec.key);
      } else if (node.kind != NodeKind::kNothing) {
        faults_.at_value(node,
                         trf("{} is not allowed; must be a group of keys below it", shown(node)));
      }
      return;
    }
    if (node.kind == NodeKind::kNothing) {
      faults_.at_value(node, trf("has no value; must be {}", allowed_text(spec)));
      return;
    }
    if (spec.type == KeyType::kTexts) {
      check_list(node, spec);
      return;
    }
    if (spec.type == KeyType::kPairs) {
      check_pairs(node, spec);
      return;
    }
    if (spec.type == KeyType::kGroups) {
      check_groups(node, spec);
      return;
    }
    if (node.kind != NodeKind::kScalar) {
      wrong(node, spec);
      return;
    }
    check_scalar(node, spec);
  }

  void check_list(ConfigNode& node, const Setting& spec) {
    if (node.kind != NodeKind::kList) {
      wrong(node, spec);
      return;
    }
    for (const auto& element : node.children) {
      if (element->kind == NodeKind::kScalar) continue;
      faults_.at_value(*element,
                       trf("{} is not allowed; must be a text", to_string(element->kind)));
      node.faulty = true;
    }
  }

  void check_pairs(ConfigNode& node, const Setting& spec) {
    if (node.kind != NodeKind::kList) {
      wrong(node, spec);
      return;
    }
    for (const auto& pair : node.children) {
      const auto is_text = [](const auto& one) { return one->kind == NodeKind::kScalar; };
      if (pair->kind == NodeKind::kList && pair->children.size() == 2 &&
          std::all_of(pair->children.begin(), pair->children.end(), is_text))
        continue;
      faults_.at_value(*pair, trf("{} is not allowed; must be two names, [a, b]", shown(*pair)));
      node.faulty = true;
    }
  }

  void check_groups(ConfigNode& node, const Setting& spec) {
    if (node.kind != NodeKind::kList) {
      wrong(node, spec);
      return;
    }
    for (const auto& element : node.children) {
      if (element->kind == NodeKind::kMap) {
        check_group(*element, spec.key);
      } else {
        faults_.at_value(*element,
                         trf("{} is not allowed; must be a group of keys", shown(*element)));
      }
    }
  }

  void wrong(ConfigNode& node, const Setting& spec, std::string hint = {}) {
    if (hint.empty()) hint = tr(spec.hint);
    faults_.at_value(node, trf("{} is not allowed; must be {}", shown(node), allowed_text(spec)),
                     std::move(hint));
  }

  void check_scalar(ConfigNode& node, const Setting& spec) {
    switch (spec.type) {
      case KeyType::kText:
      case KeyType::kFile:
      case KeyType::kFolder:
        if (node.scalar.empty()) wrong(node, spec);
        break;
      case KeyType::kWord:
        check_word(node, spec);
        break;
      case KeyType::kYesNo:
        if (const std::optional<bool> value = yes_no(node.scalar)) {
          node.number = *value ? 1 : 0;
        } else {
          wrong(node, spec);
        }
        break;
      case KeyType::kNumber:
      case KeyType::kWhole:
        check_number(node, spec);
        break;
      case KeyType::kGroup:
      case KeyType::kTexts:
      case KeyType::kPairs:
      case KeyType::kGroups:
        break;  // check_value() has seen to these
    }
  }

  void check_word(ConfigNode& node, const Setting& spec) {
    const std::vector<std::string> words = parts_of(spec.words);
    const auto at = std::find(words.begin(), words.end(), node.scalar);
    node.number = static_cast<double>(at - words.begin());
    if (at != words.end()) return;
    const std::string near = nearest_word(node.scalar, words);
    wrong(node, spec, near.empty() ? "" : trf("did you mean {}?", near));
  }

  void check_number(ConfigNode& node, const Setting& spec) {
    const bool whole = spec.type == KeyType::kWhole;
    const std::optional<double> value = number_of(node.scalar, whole);
    if (!value) {
      const bool comma = node.scalar.find(',') != node.scalar.npos;
      wrong(node, spec, comma ? tr("the decimal sign is a point") : "");
      return;
    }
    const bool low = spec.least_excluded ? *value <= spec.least : *value < spec.least;
    if (low || *value > spec.most || (whole && *value != std::floor(*value))) {
      faults_.at_value(node, trf("{} is not allowed; must be {}", node.scalar, allowed_text(spec)),
                       tr(spec.hint));
      return;
    }
    node.number = *value;
  }

  ConfigFaults& faults_;
  std::uint8_t type_;
};

}  // namespace

void ConfigFaults::add(ConfigNode& node, int line, int column, const std::string& message,
                       std::string hint) {
  node.faulty = true;
  if (line > 0) {
    diagnostics_.push_back(
        text_.diagnostic(line, column, fmt::format("{}: {}", node.path, message), std::move(hint)));
    return;
  }
  Diagnostic diagnostic;
  diagnostic.message = fmt::format("--set {}: {}", node.path, message);
  diagnostic.hint = std::move(hint);
  diagnostics_.push_back(std::move(diagnostic));
}

void ConfigFaults::at_value(ConfigNode& node, const std::string& message, std::string hint) {
  add(node, node.line, node.column, message, std::move(hint));
}

void ConfigFaults::check_names(ConfigNode& group, const std::vector<std::string>& known) {
  for (const auto& child : group.children) {
    if (std::find(known.begin(), known.end(), child->key) != known.end()) continue;
    const std::string near = nearest_word(child->key, known);
    at_key(*child, tr("unknown key"),
           near.empty() ? trf("here may be: {}", fmt::join(known, ", "))
                        : trf("did you mean {}?", near));
  }
}

void ConfigFaults::note_at_value(const ConfigNode& node, const std::string& message,
                                 std::string hint) {
  Diagnostic note = text_.diagnostic(node.line, node.column,
                                     fmt::format("{}: {}", node.path, message), std::move(hint));
  note.severity = Severity::kNote;
  diagnostics_.push_back(std::move(note));
}

void ConfigFaults::at_key(ConfigNode& node, const std::string& message, std::string hint) {
  // An element of a list has no key.
  const bool has_key = node.key_line > 0 || node.from_set;
  add(node, has_key ? node.key_line : node.line, has_key ? node.key_column : node.column, message,
      std::move(hint));
}

std::uint8_t source_type_of(const ConfigNode& root) {
  const ConfigNode* const source = root.child("source");
  const ConfigNode* const type = source != nullptr ? source->child("type") : nullptr;
  if (type == nullptr) return kForAny;
  if (type->scalar == "modbus") return kForModbus;
  if (type->scalar == "can") return kForCan;
  if (type->scalar == "hal") return kForHal;
  if (type->scalar == "log") return kForLog;
  if (type->scalar == "mtconnect") return kForMtconnect;
  return kForAny;
}

void check_keys(ConfigNode& root, ConfigFaults& faults) {
  KeyChecker(faults, source_type_of(root)).check_group(root, "");
}

}  // namespace kerf
