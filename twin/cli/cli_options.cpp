#include "twin/cli/cli_options.h"

#include <string>

namespace kerf {
namespace {

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

}  // namespace kerf
