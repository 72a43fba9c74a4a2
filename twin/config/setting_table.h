// twin/config/setting_table.h - all that can be set: by a key of a configuration, by an option of a
// command, or by both. A row says what may be set, what counts where nothing is said, and what it
// is for. From these rows come the checks of configurations (key_check.h) and of command lines
// (twin/cli/option_reader.h), `kerf config schema` and docs/configuration.md, `--help`, completion
// and the manual page.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/translate.h"

namespace kerf {

enum class KeyType : std::uint8_t {
  kGroup,  ///< keys below it; as an option a text that stands for all of them
  kText,
  kFile,    ///< a path; in a configuration relative to its folder
  kFolder,  ///< likewise
  kNumber,
  kWhole,  ///< a whole number; in a configuration also as 0x1F
  kYesNo,
  kWord,    ///< one of Setting::words
  kTexts,   ///< a list of texts
  kPairs,   ///< a list of lists of two texts
  kGroups,  ///< a list of groups; the keys below it are those of each
};

/// Kinds of source, as bits: which of them a key is for.
enum SourceMask : std::uint8_t {
  kForModbus = 1,
  kForCan = 2,
  kForHal = 4,
  kForLog = 8,
  kForMtconnect = 16,
  kForAny = 31,
};

/// Commands, as bits: which of them have an option.
enum Command : std::uint16_t {
  kRun = 1,
  kView = 2,
  kShadow = 4,
  kReplay = 8,
  kCanon = 16,
  kConfig = 32,
  kMachine = 64,
  kModels = 128,
  kSources = 256,
  kTools = 512,
  kDiff = 1024,
  kBatch = 2048,
  kJob = 4096,
  kOptimize = 8192,
  kSetup = 16384,
  kMcp = 32768,
};
inline constexpr std::uint16_t kBesideMachine = kShadow | kReplay;
/// Those that take workpieces of every kind, and those that take what is milled.
inline constexpr std::uint16_t kAnyProcess = kRun | kView | kBesideMachine | kDiff;
inline constexpr std::uint16_t kCutting = kAnyProcess | kOptimize;

/// One row. In `key`, ITEM stands for what a map may name (X..W, J0..J8, tool, line, ...), and
/// NUMBER for a tool number, PIN for a number that kinematics take.
struct Setting {
  std::string_view key{};      ///< "stock.cell_mm"; empty: no configuration has it
  std::string_view option{};   ///< "--cell", or "PROGRAM", by its place; empty: it has none
  std::uint16_t commands = 0;  ///< those that have the option
  std::uint16_t key_counts_for = kCutting;  ///< those for which the key counts as the option does
  KeyType type = KeyType::kGroup;
  std::uint8_t sources = kForAny;
  const char* unit = "";  ///< "mm"; may be empty. Options give lengths of "mm" in --units
  double least = 0;       ///< of numbers
  double most = 0;
  bool least_excluded = false;
  std::string_view words{};     ///< "mark|cut|ignore"
  std::string_view fallback{};  ///< what counts where nothing is said; empty: nothing
  const char* purpose = "";     ///< of the key, one line; tr() shows it
  const char* hint = "";        ///< what suits most, for diagnostics of keys; tr() shows it
  bool axes_only = false;       ///< below ITEM: not for tool, line, ...
  bool load_only = false;       ///< below ITEM: for load alone

  // Of the option alone.
  const char* help = "";          ///< of `--help`; {} is the fallback with its unit. tr() shows it
  const char* value_name = "";    ///< "LENGTH": of its value in `--help`
  std::string_view short_name{};  ///< "-c"
  const char* refusal = "";       ///< of a word: "'{}' is no policy; allowed: {}". tr() shows it
  /// It takes no value; where it is written, this is it: "yes", "no".
  std::string_view flag{};
  /// It may be written without a value; then it is this. No file is meant by it.
  std::string_view fallback_if_bare{};
  bool repeatable = false;
  bool required = false;
  /// "--kerf|--beam": where the command line has one of these, the key does not count.
  std::string_view yields_to{};

  bool is_positional() const { return !option.empty() && option.front() != '-'; }
  bool is_length() const { return unit == std::string_view("mm"); }
};

/// In the order of the schema (a group before its keys), and of `--help`. A row of kRun is one of
/// kBatch, too, where it is passed on (is_passed_on()).
std::span<const Setting> setting_table();

/// That of the command; else that of another one (a view that a run has opened knows the run's).
/// The option is one of the table.
const Setting& setting_of(std::string_view option, Command command);

/// What `--help` says of the option, with its default.
std::string help_of(const Setting& setting);

/// What `kerf batch` hands to each `kerf run`: all options of a run but its files, its window, and
/// what it says on the console. Those are the batch's own.
bool is_passed_on(const Setting& setting);

struct CommandRow {
  Command command;
  const char* name;
  const char* purpose;  ///< tr() shows it
};
/// In the order of `kerf --help`.
std::span<const CommandRow> command_table();
const char* name_of(Command command);

/// "a|b" as its parts.
std::vector<std::string> parts_of(std::string_view words);

// The rows of each topic.
std::span<const Setting> call_settings();       ///< program, configuration, units
std::span<const Setting> machine_settings();    ///< the machine, the interpreter
std::span<const Setting> workpiece_settings();  ///< tools, stock
std::span<const Setting> sheet_settings();      ///< beam, turret
std::span<const Setting> follow_settings();     ///< the program that a machine runs, lines
std::span<const Setting> output_settings();     ///< files
std::span<const Setting> batch_settings();      ///< kerf batch, kerf mcp
std::span<const Setting> job_settings();        ///< kerf job
std::span<const Setting> optimize_settings();   ///< kerf optimize
std::span<const Setting> view_settings();       ///< window, pictures
std::span<const Setting> source_settings();     ///< where positions come from, logs
std::span<const Setting> map_settings();        ///< which number is which position
std::span<const Setting> simulator_settings();  ///< kerf machine

}  // namespace kerf
