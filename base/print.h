// base/print.h - what a program says on its two standard streams. A stream that takes no more ends
// no run: what became of it is told at the end.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace kerf {

/// Writes to stdout or stderr; never throws for what the stream does. Any thread.
void print_text(std::FILE* stream, std::string_view text);

template <class... Args>
void print(std::FILE* stream, fmt::format_string<Args...> format, Args&&... args) {
  print_text(stream, fmt::format(format, std::forward<Args>(args)...));
}

/// Everything is written now, as far as it can be.
void flush_console();

/// To be called last: the exit code. A reader that has gone (EPIPE) changes nothing, as it has seen
/// what it wanted; a full disk is a sentence on stderr, and kExitFailure.
int end_console(int exit_code);

}  // namespace kerf
