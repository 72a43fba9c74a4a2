#include "twin/cli/shell_completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

#include "base/translate.h"
#include "twin/cli/man_page.h"
#include "twin/config/key_table.h"

namespace kerf {
namespace {

constexpr const char* kShells = "bash zsh";

std::vector<const Setting*> rows_of(Command command) {
  std::vector<const Setting*> rows;
  for (const Setting& setting : setting_table()) {
    if ((setting.commands & command) != 0) rows.push_back(&setting);
  }
  return rows;
}

std::string with_blanks(std::string_view words) {
  std::string text(words);
  std::replace(text.begin(), text.end(), '|', ' ');
  return text;
}

/// Of keys that a --set reaches as they stand: not of lists, nor of names that are to be filled in.
bool is_plain(const Setting& setting) {
  if (setting.type == KeyType::kGroup || setting.type == KeyType::kGroups) return false;
  return setting.key.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos &&
         !setting.key.starts_with("machine.links.");
}

/// "machine.ini= machine.tool_table= .."; a key of several kinds of source comes once.
std::string keys_with_equals() {
  std::vector<std::string> keys;
  for (const Setting& setting : key_table()) {
    if (is_plain(setting)) keys.push_back(std::string(setting.key) + "=");
  }
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return fmt::format("{}", fmt::join(keys, " "));
}

/// "run view ..".
std::string all_commands() {
  std::vector<std::string> names;
  for (const CommandRow& row : command_table()) names.emplace_back(row.name);
  return fmt::format("{}", fmt::join(names, " "));
}

/// "kerf kerf-run ..".
std::string manual_pages() {
  std::vector<std::string> names{"kerf"};
  for (const CommandRow& row : command_table()) names.push_back(name_of_page(row));
  return fmt::format("{}", fmt::join(names, " "));
}

/// Its value, or each of its values, is the name of a file.
bool takes_file(const Setting& setting) {
  return setting.type == KeyType::kFile ||
         (setting.type == KeyType::kTexts && setting.value_name == std::string_view("FILE"));
}

/// The words that a value may be, "a b c"; empty: it is another thing.
std::string values_of(const Setting& setting) {
  if (setting.type == KeyType::kYesNo) return "yes no";
  return setting.type == KeyType::kWord ? with_blanks(setting.words) : "";
}

constexpr std::string_view kBashHead =
    R"(# What completes the command lines of kerf in bash; `kerf config completion bash` has written it.

_kerf_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$word")
}

_kerf_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$1" -- "$word")
}

_kerf_keys() {
  compopt -o nospace 2>/dev/null
  _kerf_words "$keys"
}

# What is no value of an option: another option, or what is worked on.
_kerf_rest() {
  if [[ $word == -* ]]; then _kerf_words "$1"; else _kerf_files -f; fi
}

_kerf() {
  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD-1]} keys
  COMPREPLY=()
  # --option=value, and KEY=VALUE behind --set: bash takes the sign for a word.
  if [[ $word == = ]]; then
    word=
  elif [[ $option == = ]]; then
    option=${COMP_WORDS[COMP_CWORD-2]}
  fi
)";

/// A case for each kind of value that the options have.
std::string bash_cases(Command command) {
  std::map<std::string, std::vector<std::string>> options_of;  // by what is to be done
  std::vector<std::string> all;
  for (const Setting* const setting : rows_of(command)) {
    if (setting->is_positional()) continue;
    std::vector<std::string> names{std::string(setting->option)};
    if (!setting->short_name.empty()) names.insert(names.begin(), std::string(setting->short_name));
    all.insert(all.end(), names.begin(), names.end());
    if (!setting->flag.empty() || !setting->fallback_if_bare.empty()) continue;
    const std::string values = values_of(*setting);
    std::string action = ":";
    if (setting->option == "--set") action = "_kerf_keys";
    if (takes_file(*setting)) action = "_kerf_files -f";
    if (setting->type == KeyType::kFolder) action = "_kerf_files -d";
    if (!values.empty()) action = fmt::format("_kerf_words '{}'", values);
    std::vector<std::string>& list = options_of[action];
    list.insert(list.end(), names.begin(), names.end());
  }
  all.emplace_back("--help");
  std::string text;
  for (const auto& [action, options] : options_of) {
    text += fmt::format("    {}) {} ;;\n", fmt::join(options, "|"), action);
  }
  return text + fmt::format("    *) _kerf_rest '{}' ;;\n", fmt::join(all, " "));
}

std::string_view actions_of_config() { return setting_of("ACTION", kConfig).words; }

/// 'it''s' for a shell.
std::string single_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Of a text within the brackets or between the colons of a specification.
std::string in_spec(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '[' || c == ']' || c == ':') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const Setting& setting) {
  const std::string values = values_of(setting);
  if (!values.empty()) return fmt::format("({})", values);
  if (setting.option == "--set") return "_kerf_keys";
  if (takes_file(setting)) return "_files";
  if (setting.type == KeyType::kFolder) return "_files -/";
  return " ";
}

/// One argument of _arguments.
std::string zsh_spec(const Setting& setting) {
  const std::string option(setting.option);
  if (setting.is_positional()) {
    const char* const many = setting.repeatable ? "*" : "";
    return single_quoted(fmt::format("{}:{}:{}", many, in_spec(option), zsh_action(setting)));
  }
  std::string after = fmt::format("[{}]", in_spec(help_of(setting)));
  if (setting.flag.empty()) {
    after += fmt::format("{}:{}:{}", setting.fallback_if_bare.empty() ? "" : ":",
                         in_spec(setting.value_name), zsh_action(setting));
  }
  if (!setting.short_name.empty()) {
    return fmt::format("{}{{{},{}}}{}",
                       single_quoted(fmt::format("({} {})", setting.short_name, option)),
                       setting.short_name, option, single_quoted(after));
  }
  return single_quoted((setting.repeatable ? "*" : "") + option + after);
}

}  // namespace

std::string bash_completion() {
  std::string text(kBashHead);
  text += fmt::format("  keys='{}'\n", keys_with_equals());
  text += fmt::format(
      "  if ((COMP_CWORD == 1)); then\n    _kerf_words '{} --help --version'\n    return\n  fi\n",
      all_commands());
  text += "  case $option in\n";
  std::string_view last;
  for (const Setting& setting : key_table()) {
    const std::string values = values_of(setting);
    if (!is_plain(setting) || values.empty() || setting.key == last) continue;
    last = setting.key;
    text += fmt::format("  {}) _kerf_words '{}'; return ;;\n", setting.key, values);
  }
  text += "  esac\n  case ${COMP_WORDS[1]} in\n";
  for (const CommandRow& row : command_table()) {
    text += fmt::format("  {})\n", row.name);
    if (row.command == kConfig) {
      text += fmt::format(
          "    if ((COMP_CWORD == 2)); then\n      _kerf_words '{} --set --help'\n      return\n"
          "    fi\n    [[ $option == completion ]] && _kerf_words '{}' && return\n"
          "    [[ $option == man ]] && _kerf_words '{}' && return\n",
          with_blanks(actions_of_config()), kShells, manual_pages());
    }
    text += "    case $option in\n" + bash_cases(row.command) + "    esac\n    ;;\n";
  }
  return text + "  esac\n}\n\ncomplete -F _kerf kerf\n";
}

std::string zsh_completion() {
  std::string text =
      "#compdef kerf\n# What completes the command lines of kerf in zsh; `kerf config completion "
      "zsh` has written it.\n\n";
  text +=
      fmt::format("_kerf_keys() {{\n  local -a keys\n  keys=({})\n  compadd -S '' -a keys\n}}\n\n",
                  keys_with_equals());
  text += "_kerf() {\n  local -a commands\n  commands=(\n";
  for (const CommandRow& row : command_table()) {
    text += fmt::format("    {}\n",
                        single_quoted(fmt::format("{}:{}", row.name, in_spec(tr(row.purpose)))));
  }
  text +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n"
      "  local called=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $called in\n";
  for (const CommandRow& row : command_table()) {
    text += fmt::format("  {})\n", row.name);
    if (row.command == kConfig) {
      text += fmt::format(
          "    if [[ $words[2] == completion ]] && (( CURRENT == 3 )); then\n"
          "      compadd {}\n      return\n    fi\n"
          "    if [[ $words[2] == man ]] && (( CURRENT == 3 )); then\n"
          "      compadd {}\n      return\n    fi\n",
          kShells, manual_pages());
    }
    text += "    _arguments";
    for (const Setting* const setting : rows_of(row.command)) {
      text += " \\\n      " + zsh_spec(*setting);
    }
    text += " \\\n      '(- *)'{-h,--help}" +
            single_quoted(fmt::format("[{}]", in_spec(tr("print this help")))) + "\n    ;;\n";
  }
  return text +
         "  esac\n}\n\nif [[ $zsh_eval_context[-1] == loadautofunc ]]; then\n  _kerf \"$@\"\n"
         "else\n  compdef _kerf kerf\nfi\n";
}

}  // namespace kerf
