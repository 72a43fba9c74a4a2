#include "twin/cli/man_page.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "base/exit_code.h"
#include "base/translate.h"
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

/// "run, view; stock.cell_mm": whose it is, and by which key.
std::string belongs_to(const Setting& setting) {
  std::vector<std::string> commands;
  for (const CommandRow& row : command_table()) {
    if ((setting.commands & row.command) != 0) commands.emplace_back(row.name);
  }
  std::string text = fmt::format("kerf {}", fmt::join(commands, ", "));
  if (!setting.key.empty()) text += trf("; key {}", setting.key);
  return text;
}

std::string option_entry(const Setting& setting) {
  std::string head = setting.is_positional() ? slanted(setting.option) : bold(setting.option);
  if (!setting.short_name.empty()) head = bold(setting.short_name) + ", " + head;
  if (*setting.value_name != 0) head += " " + slanted(setting.value_name);
  return fmt::format(".TP\n{}\n{}\n.br\n({})\n", head, plain(help_of(setting)),
                     plain(belongs_to(setting)));
}

/// The schema, as it is.
std::string configuration_section() {
  return section(tr("CONFIGURATION")) + ".nf\n" + plain(schema_text()) + ".fi\n";
}

}  // namespace

std::string man_page() {
  std::string text = fmt::format(".TH KERF 1 \"\" \"kerf {}\" \"\"\n", KERF_VERSION);
  text += section(tr("NAME"));
  text += "kerf \\- " + plain(tr("a twin of a machine under LinuxCNC")) + "\n";
  text += section(tr("SYNOPSIS"));
  for (const CommandRow& row : command_table()) text += synopsis_of(row);
  text += section(tr("COMMANDS"));
  for (const CommandRow& row : command_table()) {
    text += fmt::format(".TP\n{}\n{}\n", bold(row.name), plain(tr(row.purpose)));
  }
  text += section(tr("OPTIONS"));
  for (const Setting& setting : setting_table()) {
    if (!setting.option.empty()) text += option_entry(setting);
  }
  text += configuration_section();
  text += section(tr("EXIT STATUS")) + ".nf\n" + plain(tr(kExitCodes)) + ".fi\n";
  return text;
}

}  // namespace kerf
