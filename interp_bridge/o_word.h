// interp_bridge/o_word.h - which subroutine a line of a program begins, ends or calls.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kerf {

struct OWord {
  enum class Kind { kSub, kEndSub, kCall };
  Kind kind = Kind::kCall;
  std::string name;  ///< as it is spelled, without blanks: "drill", "100"
};

/// `O<drill> SUB`, `O100 ENDSUB`, `O<drill> CALL [1]`, `M98 P100`; nothing: another line, or a name
/// that is worked out while it runs (`O[#1] CALL`). Comments do not count.
std::optional<OWord> o_word(std::string_view line);

}  // namespace kerf
