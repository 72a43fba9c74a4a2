// base/shell_word.h - text as an argument of a command that is shown to be copied.
#pragma once

#include <string>

namespace kerf {

/// A word that a POSIX shell reads as this text.
std::string shell_word(const std::string& text);

}  // namespace kerf
