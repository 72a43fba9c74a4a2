// twin/config/key_check.h - a tree of keys and values against the table of keys: what can be said
// of each value by itself.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "twin/config/config_tree.h"
#include "twin/config/key_table.h"

namespace kerf {

/// Faults of a configuration, each at its place in the file or with the --set it comes from.
class ConfigFaults {
 public:
  ConfigFaults(const ConfigText& text, Diagnostics& diagnostics)
      : text_(text), diagnostics_(diagnostics) {}

  /// "stock.cell_mm: 0 is not allowed; ...": the path goes in front. The node becomes faulty.
  void at_value(ConfigNode& node, const std::string& message, std::string hint = {});
  void at_key(ConfigNode& node, const std::string& message, std::string hint = {});
  /// Of a group that knows these keys alone: the others are faults, with what may be meant.
  void check_names(ConfigNode& group, const std::vector<std::string>& known);
  /// A remark; the node stays as it is.
  void note_at_value(const ConfigNode& node, const std::string& message, std::string hint = {});
  /// True the first time: what need not be said of each file.
  bool first_outside() { return !std::exchange(told_outside_, true); }
  /// Diagnostics of a file that the node names go where all the others go.
  Diagnostics& diagnostics() { return diagnostics_; }
  const ConfigText& text() const { return text_; }

 private:
  void add(ConfigNode& node, int line, int column, const std::string& message, std::string hint);

  const ConfigText& text_;
  Diagnostics& diagnostics_;
  bool told_outside_ = false;
};

/// The bit of `source.type`; kForAny if there is none or it is no kind of source.
std::uint8_t source_type_of(const ConfigNode& root);

/// Unknown keys (with what may be meant), keys of another kind of source, groups where a value is
/// wanted and the reverse, numbers out of their range, words that are none. Each faulty node is
/// marked; numbers are filled in.
void check_keys(ConfigNode& root, ConfigFaults& faults);

}  // namespace kerf
