#include "twin/config/live_config.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "twin/config/config_reader.h"
#include "twin/config/config_tree.h"
#include "twin/config/key_check.h"

namespace kerf {
namespace {

Diagnostic about_file(const std::string& path, std::string message, std::string hint = {}) {
  return {Severity::kError, path, 0, 0, std::move(message), {}, std::move(hint)};
}

std::optional<std::string> read_text(const std::string& path, Diagnostics& diagnostics) {
  struct stat facts {};
  if (stat(path.c_str(), &facts) != 0) {
    diagnostics.push_back(
        about_file(path, fmt::format("cannot read the configuration: {}", std::strerror(errno))));
    return std::nullopt;
  }
  if (S_ISDIR(facts.st_mode)) {
    diagnostics.push_back(about_file(path, "is a folder; a configuration is a file"));
    return std::nullopt;
  }
  std::ifstream in(path, std::ios::binary);
  std::string text;
  // One byte more than allowed tells that there are more; a pipe has no size to ask for.
  text.resize(kMaxConfig_bytes + 1);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.is_open() || in.bad()) {
    diagnostics.push_back(
        about_file(path, fmt::format("cannot read the configuration: {}", std::strerror(errno))));
    return std::nullopt;
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
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

}  // namespace

std::optional<LiveConfig> parse_config(std::string_view text, const std::string& path,
                                       const std::vector<std::string>& sets,
                                       Diagnostics& diagnostics) {
  if (text.size() > kMaxConfig_bytes) {
    diagnostics.push_back(about_file(
        path, fmt::format("larger than {} bytes, which no configuration is", kMaxConfig_bytes),
        "is it a log or a program?"));
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
        about_file(path, "is empty", "`kerf config schema` lists every key there is"));
    return std::nullopt;
  }
  return parse_config(*text, path, sets, diagnostics);
}

}  // namespace kerf
