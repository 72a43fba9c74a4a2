#include "twin/cli/man_page.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/command_examples.h"
#include "twin/config/key_table.h"
#include "twin/config/live_config.h"

namespace kerf {
namespace {

/// As text that troff leaves alone.
std::string plain(std::string_view text) {
  std::string out;
  bool at_line_start = true;
  for (const char c : text) {
    if (at_line_start && (c == '.' || c == '\'')) out += "\\&";
    at_line_start = c == '\n';
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + plain(text) + "\\fR"; }
std::string slanted(std::string_view text) { return "\\fI" + plain(text) + "\\fR"; }

std::string section(const char* title) { return fmt::format(".SH {}\n", plain(title)); }

/// `kerf run [OPTIONS] PROGRAM..`
std::string synopsis_of(const CommandRow& row) {
  std::string operands;
  bool has_options = false;
  for (const Setting& setting : setting_table()) {
    if ((setting.commands & row.command) == 0) continue;
    has_options |= !setting.is_positional();
    if (!setting.is_positional()) continue;
    const std::string name = slanted(setting.option) + (setting.repeatable ? ".." : "");
    operands += setting.required ? " " + name : " [" + name + "]";
  }
  return fmt::format("{}{}{}\n.br\n", bold(fmt::format("kerf {}", row.name)),
                     has_options ? fmt::format(" [{}]", slanted(tr("OPTIONS"))) : "", operands);
}

std::string option_entry(const Setting& setting) {
  std::string head = setting.is_positional() ? slanted(setting.option) : bold(setting.option);
  if (!setting.short_name.empty()) head = bold(setting.short_name) + ", " + head;
  if (*setting.value_name != 0) head += " " + slanted(setting.value_name);
  std::string entry = fmt::format(".TP\n{}\n{}\n", head, plain(help_of(setting)));
  if (!setting.key.empty()) {
    entry += fmt::format(".br\n{}\n", plain(trf("(key {})", setting.key)));
  }
  return entry;
}

std::string head_of(std::string name, std::string_view purpose) {
  std::string title = name;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format(".TH {} 1 \"\" \"kerf {}\" \"\"\n", plain(title), KERF_VERSION) +
         section(tr("NAME")) + fmt::format("{} \\- {}\n", plain(name), plain(purpose));
}

/// Lines that stay as they are.
std::string as_written(std::string_view text) { return ".nf\n" + plain(text) + ".fi\n"; }

}  // namespace

std::string man_page() {
  std::string text = head_of("kerf", tr("a twin of a machine under LinuxCNC"));
  text += section(tr("SYNOPSIS"));
  for (const CommandRow& row : command_table()) text += synopsis_of(row);
  text += section(tr("COMMANDS"));
  for (const CommandRow& row : command_table()) {
    text += fmt::format(".TP\n{}\n{}\n.br\n{}\n", bold(row.name), plain(tr(row.purpose)),
                        plain(trf("{}(1) has its options.", name_of_page(row))));
  }
  text += section(tr("EXAMPLES")) + as_written(examples_of_kerf());
  text += section(tr("CONFIGURATION")) + as_written(schema_text());
  text += section(tr("EXIT STATUS")) + as_written(tr(kExitCodes));
  return text;
}

std::string name_of_page(const CommandRow& command) { return fmt::format("kerf-{}", command.name); }

std::string man_page_of(const CommandRow& command) {
  std::string text = head_of(name_of_page(command), tr(command.purpose));
  text += section(tr("SYNOPSIS")) + synopsis_of(command);
  text += section(tr("OPTIONS"));
  for (const Setting& setting : setting_table()) {
    if ((setting.commands & command.command) != 0) text += option_entry(setting);
  }
  text += section(tr("EXAMPLES")) + as_written(tr(examples_of(command.command)));
  text += section(tr("EXIT STATUS")) + as_written(tr(kExitCodes));
  text += section(tr("SEE ALSO")) + bold("kerf") + "(1)\n";
  return text;
}

}  // namespace kerf
