// twin/config/written_options.h - what a command line says, as it was written.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "twin/config/setting_table.h"

namespace kerf {

/// The values of options by their names ("--cell", "PROGRAM"): texts that nobody has looked at.
/// Only options of the setting table have a place; which command has them is not asked.
class WrittenOptions {
 public:
  /// One option's. A parser fills in the one that belongs to its kind.
  struct Slot {
    std::string text;
    std::vector<std::string> list;  ///< of one that is repeatable
    bool is_set = false;            ///< of one that takes no value
  };

  bool has(std::string_view option) const;
  /// The (first) value; empty: it is not written, or takes none.
  const std::string& text(std::string_view option) const;
  /// All of a repeatable one.
  const std::vector<std::string>& texts(std::string_view option) const;

  /// Empty: as if it were not written.
  void set(std::string_view option, std::string text);
  void set_all(std::string_view option, std::vector<std::string> texts);
  void add(std::string_view option, std::string text);
  void set_flag(std::string_view option);
  void clear(std::string_view option);

  /// Stays where it is for as long as this object does.
  Slot& slot(std::string_view option);

 private:
  const Slot* find(std::string_view option) const;

  std::map<std::string, Slot, std::less<>> slots_;
};

/// A command as it was called.
struct Arguments {
  Command command = kRun;
  WrittenOptions options;
  std::vector<std::string> words;  ///< all of it, kerf itself first; may be empty
  bool in_window = false;          ///< `kerf view LOG` as a replay: with a window or not at all

  /// By which name kerf was called.
  std::string kerf() const { return words.empty() ? "kerf" : words.front(); }
};

}  // namespace kerf
