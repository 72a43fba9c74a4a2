// twin/config/key_table.h - every key that a configuration may have: what checks, prints and
// explains configurations reads this one table.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

enum class KeyType : std::uint8_t {
  kGroup,  ///< keys below it
  kText,
  kFile,  ///< a path, relative to the file's folder
  kNumber,
  kWhole,  ///< a whole number, also as 0x1F
  kYesNo,
  kWord,    ///< one of KeySpec::words
  kTexts,   ///< a list of texts
  kGroups,  ///< a list of groups; the keys below it are those of each
};

/// Kinds of source, as bits: which of them a key is for.
enum SourceMask : std::uint8_t {
  kForModbus = 1,
  kForCan = 2,
  kForHal = 4,
  kForLog = 8,
  kForAny = 15,
};

/// One key. In `path`, ITEM stands for what a map may name (X..W, J0..J8, tool, line, ...), and
/// NUMBER for a tool number, PIN for a number that kinematics take.
struct KeySpec {
  std::string_view path;
  KeyType type = KeyType::kGroup;
  std::uint8_t sources = kForAny;
  std::string_view unit{};  ///< "mm"; may be empty
  double least = 0;         ///< of numbers
  double most = 0;
  bool least_excluded = false;
  std::string_view words{};     ///< "mark|cut|ignore"
  std::string_view fallback{};  ///< what counts where the key is absent; empty: nothing
  std::string_view purpose{};   ///< one line
  std::string_view hint{};      ///< what suits most, for diagnostics
  bool axes_only = false;       ///< below ITEM: not for tool, line, ...
};

/// The axes in the order of positions.
inline constexpr std::string_view kAllAxes = "XYZABCUVW";

/// In the order of the schema: a group before its keys.
std::span<const KeySpec> key_table();

/// The words of a kWord.
std::vector<std::string> words_of(const KeySpec& spec);

/// "X", .. "W": axis 0 to 8; "J0" .. "J8": joint 0 to 8. -1: neither.
int axis_of_item(std::string_view item);
int joint_of_item(std::string_view item);
/// All that PIN stands for: numbers of any of the kinematics.
const std::vector<std::string>& pin_names();
/// All that ITEM stands for.
const std::vector<std::string>& item_names();

/// "above 0 and at most 1000 (mm)", "0 to 255", "one of mark, cut, ignore".
std::string allowed_text(const KeySpec& spec);

}  // namespace kerf
