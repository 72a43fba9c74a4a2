// twin/config/option_layers.h - which of those who say something about an option is heard.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "twin/config/setting_table.h"
#include "twin/config/written_options.h"

namespace kerf {

/// Values by key or option, as text: numbers as {fmt} prints them, yes or no, paths as they are
/// good from the current folder. Of a group that stands for an option: nothing but that it is
/// there.
using SaidTexts = std::map<std::string, std::string, std::less<>>;

/// Who says what. The pointers may be null: nobody there.
struct OptionLayers {
  Command command = kRun;
  const WrittenOptions* written = nullptr;  ///< the command line
  const SaidTexts* config = nullptr;        ///< LiveConfig::said, by key
  SaidTexts ini;                            ///< the machine's INI, by option
};

/// In ascending order: who is heard before whom.
enum class ValueFrom : std::uint8_t { kNowhere, kDefault, kIni, kConfig, kCommandLine };

struct ChosenValue {
  std::string text;
  ValueFrom from = ValueFrom::kNowhere;

  /// By somebody, not by the table.
  bool is_said() const { return from > ValueFrom::kDefault; }
};

/// The one place that decides: the command line before the configuration, before the INI, before
/// the default of the table. A repeatable option is heard as a whole: those of the command line
/// replace those of the configuration. The configuration's value does not count for commands that
/// Setting::key_counts_for leaves out, nor beside an option that Setting::yields_to names.
ChosenValue choose(const OptionLayers& layers, std::string_view option);

}  // namespace kerf
