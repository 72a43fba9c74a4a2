#include "twin/config/live_config.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/small_file.h"
#include "base/translate.h"
#include "twin/config/config_reader.h"
#include "twin/config/config_tree.h"
#include "twin/config/key_check.h"
#include "twin/config/key_table.h"

namespace kerf {
namespace {

Diagnostic about_file(const std::string& path, std::string message, std::string hint = {}) {
  return {Severity::kError, path, 0, 0, std::move(message), {}, std::move(hint)};
}

std::optional<std::string> read_text(const std::string& path, Diagnostics& diagnostics) {
  struct stat facts {};
  if (stat(path.c_str(), &facts) != 0) {
    diagnostics.push_back(
        about_file(path, trf("cannot read the configuration: {}", std::strerror(errno))));
    return std::nullopt;
  }
  if (S_ISDIR(facts.st_mode)) {
    diagnostics.push_back(about_file(path, tr("is a folder; a configuration is a file")));
    return std::nullopt;
  }
  std::ifstream in(path, std::ios::binary);
  // One byte more than allowed tells that there are more; a pipe has no size to ask for.
  std::string text = read_up_to(in, kMaxConfig_bytes + 1);
  if (!in.is_open() || in.bad()) {
    diagnostics.push_back(
        about_file(path, trf("cannot read the configuration: {}", std::strerror(errno))));
    return std::nullopt;
  }
  return text;
}

/// Those about lines of the file in their order, then all others.
void sort_by_line(Diagnostics& diagnostics, std::size_t from, const std::string& path) {
  const auto rank = [&](const Diagnostic& one) {
    return one.file == path && one.line > 0 ? one.line : std::numeric_limits<int>::max();
  };
  std::stable_sort(diagnostics.begin() + static_cast<std::ptrdiff_t>(from), diagnostics.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return rank(a) < rank(b); });
}

/// That of "stock.cell_mm"; of "tools.NUMBER" the group, if there is one in it. Null if it is not
/// there or faulty.
const ConfigNode* find_key(const ConfigNode& root, std::string_view key) {
  const ConfigNode* node = &root;
  while (!key.empty()) {
    const std::size_t dot = std::min(key.find('.'), key.size());
    const std::string_view name = key.substr(0, dot);
    if (name == "NUMBER") return node->children.empty() ? nullptr : node;
    node = node->child(name);
    if (node == nullptr || node->faulty) return nullptr;
    key.remove_prefix(std::min(dot + 1, key.size()));
  }
  return node;
}

std::string said_text(const ConfigNode& node, KeyType type, const ConfigFaults& faults) {
  switch (type) {
    case KeyType::kNumber:
    case KeyType::kWhole:
      return fmt::format("{}", node.number);
    case KeyType::kYesNo:
      return node.number != 0 ? "yes" : "no";
    case KeyType::kFile:
    case KeyType::kFolder:
      return resolved_path(node, node.scalar, faults);
    default:
      return node.scalar;
  }
}

void note_what_is_said(const ConfigNode& root, const ConfigFaults& faults, SaidTexts& said) {
  for (const Setting& setting : key_table()) {
    if (setting.option.empty()) continue;
    if (const ConfigNode* const node = find_key(root, setting.key)) {
      said.emplace(setting.key, said_text(*node, setting.type, faults));
    }
  }
}

}  // namespace

std::optional<LiveConfig> parse_config(std::string_view text, const std::string& path,
                                       const std::vector<std::string>& sets,
                                       Diagnostics& diagnostics) {
  if (text.size() > kMaxConfig_bytes) {
    diagnostics.push_back(
        about_file(path, trf("larger than {} bytes, which no configuration is", kMaxConfig_bytes),
                   tr("is it a log or a program?")));
    return std::nullopt;
  }
  const std::size_t before = diagnostics.size();
  const ConfigText config_text(text, path);
  const std::unique_ptr<ConfigNode> root = parse_config_tree(config_text, diagnostics);
  if (root == nullptr) return std::nullopt;
  for (const std::string& assignment : sets) set_in_tree(*root, assignment, diagnostics);

  ConfigFaults faults(config_text, diagnostics);
  check_keys(*root, faults);
  LiveConfig config;
  const GroupReader reader(root.get(), faults);
  read_workshop(reader, config);
  read_source(reader.group("source"), config);
  note_what_is_said(*root, faults, config.said);
  // Of FILE:NAME the file is meant beside the configuration.
  if (config.material) config.said["material"] = *config.material;
  sort_by_line(diagnostics, before, path);
  const bool failed =
      std::any_of(diagnostics.begin() + static_cast<std::ptrdiff_t>(before), diagnostics.end(),
                  [](const Diagnostic& one) { return one.severity == Severity::kError; });
  if (failed) return std::nullopt;
  return config;
}

std::optional<LiveConfig> read_config(const std::string& path, const std::vector<std::string>& sets,
                                      Diagnostics& diagnostics) {
  if (path.empty()) return parse_config({}, {}, sets, diagnostics);
  const std::optional<std::string> text = read_text(path, diagnostics);
  if (!text) return std::nullopt;
  if (text->find_first_not_of(" \t\r\n") == text->npos) {
    diagnostics.push_back(
        about_file(path, tr("is empty"), tr("`kerf config schema` lists every key there is")));
    return std::nullopt;
  }
  return parse_config(*text, path, sets, diagnostics);
}

}  // namespace kerf
