// tests/twin/config/config_support.h - configurations from text, and what is said of them.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "twin/config/live_config.h"

namespace kerf {

struct ReadText {
  Diagnostics diagnostics;
  std::optional<LiveConfig> config;

  explicit ReadText(std::string_view text, const std::vector<std::string>& sets = {})
      : config(parse_config(text, "dir/m.yaml", sets, diagnostics)) {}

  /// "3:5: message (hint)", one a line, without the file where it is dir/m.yaml.
  std::string said() const {
    std::string out;
    for (const Diagnostic& one : diagnostics) {
      if (one.file != "dir/m.yaml" && !one.file.empty()) out += one.file + ":";
      if (one.line > 0) out += fmt::format("{}:{}: ", one.line, one.column);
      if (one.severity != Severity::kError) out += std::string(to_string(one.severity)) + ": ";
      out += one.message + (one.hint.empty() ? "" : " (" + one.hint + ")") + "\n";
    }
    return out;
  }
};

/// What is said of a faulty text; "read" if it is none.
inline std::string said_of(std::string_view text, const std::vector<std::string>& sets = {}) {
  const ReadText read(text, sets);
  return read.config ? "read\n" + read.said() : read.said();
}

/// A folder that goes away with the test.
class ConfigFolder {
 public:
  ConfigFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-config-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ConfigFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ConfigFolder(const ConfigFolder&) = delete;
  ConfigFolder& operator=(const ConfigFolder&) = delete;

  /// Full path of a new file.
  std::string write(const std::string& name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file.string();
  }
  std::string path(const std::string& name = {}) const {
    return name.empty() ? path_.string() : (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace kerf
