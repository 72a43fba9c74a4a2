#include "twin/cli/cli_options.h"

#include <array>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

#include "base/translate.h"

namespace kerf {
namespace {

/// What CLI11 says of its own in a help.
constexpr std::array kLabels{tr_noop("Usage"), tr_noop("Positionals"), tr_noop("OPTIONS"),
                             tr_noop("SUBCOMMAND"), tr_noop("REQUIRED")};

void add_option(CLI::App& app, const Setting& setting, WrittenOptions::Slot& slot) {
  const std::string shorter(setting.short_name);
  const std::string name = (shorter.empty() ? "" : shorter + ",") + std::string(setting.option);
  const std::string help = help_of(setting);
  if (!setting.flag.empty()) {
    app.add_flag(name, slot.is_set, help);
    return;
  }
  CLI::Option* const option = setting.repeatable ? app.add_option(name, slot.list, help)
                                                 : app.add_option(name, slot.text, help);
  // Of several words the first belongs to it, the others are arguments of their own.
  if (setting.repeatable && !setting.is_positional()) option->allow_extra_args(false);
  if (*setting.value_name != 0) option->type_name(setting.value_name);
  if (setting.required) option->required();
}

}  // namespace

void add_options(CLI::App& app, Command command, WrittenOptions& options) {
  for (const Setting& setting : setting_table()) {
    if ((setting.commands & command) == 0) continue;
    add_option(app, setting, options.slot(setting.option));
  }
}

std::vector<std::string> with_bare_options(std::vector<std::string> words) {
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const Setting* bare = nullptr;
    for (const Setting& setting : setting_table()) {
      if (!setting.fallback_if_bare.empty() && setting.option == words[i]) bare = &setting;
    }
    if (bare == nullptr) continue;
    std::error_code ignored;
    const bool has_value = i + 1 < words.size() && !words[i + 1].starts_with('-') &&
                           !std::filesystem::exists(words[i + 1], ignored);
    if (!has_value) words[i] += "=" + std::string(bare->fallback_if_bare);
  }
  return words;
}

void speak_language(CLI::App& app, const std::string& version) {
  app.option_defaults()->group(tr("Options"));
  app.set_help_flag("-h,--help", tr("print this help"));
  const std::shared_ptr<CLI::Formatter> formatter = std::make_shared<CLI::Formatter>();
  for (const char* const label : kLabels) formatter->label(label, tr(label));
  app.formatter(formatter);
  app.set_version_flag("--version", version, tr("print the version"));
}

std::string words_of(const CLI::ParseError& error) {
  const std::string said = error.what();
  constexpr std::string_view kRequired = " is required", kOverride = " was given a disallowed";
  if (error.get_name() == "RequiredError" && said.ends_with(kRequired)) {
    return trf("{} is required", said.substr(0, said.size() - kRequired.size()));
  }
  if (error.get_name() != "ArgumentMismatch") return said;
  if (const std::size_t at = said.find(kOverride); at != said.npos) {
    return trf("{} takes no value", "--" + said.substr(0, at));  // said without its dashes
  }
  const std::string option = said.substr(0, said.find(':'));
  if (said.find(": At Most ") != said.npos) return trf("{} is given more than once", option);
  if (said.ends_with(" missing")) return trf("{}: a value must follow", option);
  return said;
}

}  // namespace kerf
