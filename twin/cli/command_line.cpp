#include "twin/cli/command_line.h"

#include <fmt/format.h>

#include "base/shell_word.h"

namespace kerf {
namespace {

/// A name that begins like an option is none; "-" is standard input.
std::string operand(const std::string& text) {
  return text.front() == '-' && text != "-" ? "./" + text : text;
}

void append(const Setting& setting, const WrittenOptions& options, std::string& line) {
  const auto word = [&line](const std::string& text) { line += ' ' + shell_word(text); };
  const auto one = [&](const std::string& value) {
    if (value.empty()) return;
    if (!setting.is_positional()) word(std::string(setting.option));
    word(setting.is_positional() ? operand(value) : value);
  };
  if (!setting.flag.empty()) {
    if (options.has(setting.option)) word(std::string(setting.option));
  } else if (setting.repeatable && !options.texts(setting.option).empty()) {
    for (const std::string& value : options.texts(setting.option)) one(value);
  } else {
    one(options.text(setting.option));
  }
}

}  // namespace

std::string command_line(const Arguments& arguments) {
  std::string line = fmt::format("{} {}", shell_word(arguments.kerf()), name_of(arguments.command));
  for (const bool positional : {true, false}) {
    for (const Setting& setting : setting_table()) {
      if ((setting.commands & arguments.command) == 0) continue;
      if (setting.is_positional() == positional) append(setting, arguments.options, line);
    }
  }
  return line;
}

std::string command_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

Arguments with_guesses(Arguments arguments, std::span<const GuessRow> rows) {
  for (const GuessRow& row : rows) {
    if (row.option == "--tool") {
      arguments.options.add(row.option, row.value);
    } else if (!row.option.empty()) {
      arguments.options.set(row.option, row.value);
    }
  }
  return arguments;
}

}  // namespace kerf
