// twin/config/config_tree.h - a YAML text as a tree of keys and values that know where they stand.
// The only part that knows the YAML library is config_tree.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace kerf {

enum class NodeKind : std::uint8_t { kNothing, kScalar, kMap, kList };
/// "a value", "keys with values", "a list", "nothing".
const char* to_string(NodeKind kind);

/// A value, where it stands, and the key it belongs to.
struct ConfigNode {
  NodeKind kind = NodeKind::kNothing;
  std::string key;     ///< in its map; empty in a list and for the root
  std::string path;    ///< "source.map.X.register"; of a list's element "source.pins[2]"
  std::string scalar;  ///< text of a kScalar, without quotes
  double number = 0;   ///< check_keys(): of a number; yes is 1; the place of a word
  int line = 0;        ///< of the value, 1-based; 0: it comes from --set
  int column = 0;
  int key_line = 0;
  int key_column = 0;
  bool from_set = false;
  bool faulty = false;  ///< has been reported; nobody need look at it again
  std::vector<std::unique_ptr<ConfigNode>> children;

  ConfigNode* child(std::string_view name);
  const ConfigNode* child(std::string_view name) const;
};

/// The text of a file with its name, for diagnostics about places in it.
class ConfigText {
 public:
  ConfigText(std::string_view text, std::string path);

  const std::string& path() const { return path_; }
  const std::string& text() const { return text_; }
  /// False if a quote opens at this place and none closes it before the line ends: the library
  /// takes all that follows for a part of the text.
  bool quote_ends_at(int line, int column) const;
  /// With excerpt; long lines are cut. Line 0: about the file as a whole.
  Diagnostic diagnostic(int line, int column, std::string message, std::string hint = {}) const;

 private:
  std::string text_;  ///< without byte order mark
  std::string path_;
  std::vector<std::size_t> line_starts_;
};

/// Parses the text. Duplicate keys, anchors, aliases, tags, further documents, keys that are no
/// plain texts and all faults of syntax are errors. The root is of kind kMap; null after anything
/// but a duplicate key, as what follows a fault of syntax cannot be told.
std::unique_ptr<ConfigNode> parse_config_tree(const ConfigText& text, Diagnostics& diagnostics);

/// Lays "KEY=VALUE" over the tree: the value replaces what the key had or is added.
void set_in_tree(ConfigNode& root, std::string_view assignment, Diagnostics& diagnostics);

}  // namespace kerf
