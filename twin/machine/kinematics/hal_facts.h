// twin/machine/kinematics/hal_facts.h - what LinuxCNC's HAL files say of single pins, read as text.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/ini_file.h"

namespace kerf {

/// Where the value of a pin comes from.
struct HalValue {
  double number = 0;              ///< of what is written down
  bool is_set = false;            ///< some number is
  bool has_tool_length = false;   ///< motion.tooloffset.z is (part of) it
  std::vector<std::string> from;  ///< other pins that write it, of which no value is known
};

/// setp, sets, net, linksp, linkps and linkpp lines of the HAL files that an INI names. A later
/// line wins over an earlier one, as when HAL runs them.
class HalFacts {
 public:
  /// `folder`: of the INI. Files that cannot be read are passed over.
  HalFacts(IniFile& ini, const std::string& folder);

  /// Some HAL file or command was read as text.
  bool known() const { return known_; }
  /// The value of a pin, through its signal, and through sum2 blocks.
  HalValue value_of(const std::string& pin) const { return value_of(pin, 0); }
  /// Other pins on the signal of this one.
  std::set<std::string> linked_with(const std::string& pin) const;

 private:
  void read_file(IniFile& ini, const std::string& path);
  void read_line(IniFile& ini, std::string_view line);
  void link(const std::string& signal, const std::string& pin);
  HalValue value_of(const std::string& pin, int depth) const;

  bool known_ = false;
  std::map<std::string, double> pins_;     ///< setp
  std::map<std::string, double> signals_;  ///< sets
  std::map<std::string, std::string> signal_of_;
  std::map<std::string, std::set<std::string>> pins_of_;
};

}  // namespace kerf
