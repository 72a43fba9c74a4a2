#include "twin/config/option_layers.h"

#include <algorithm>

namespace kerf {
namespace {

bool yields(const Setting& setting, const WrittenOptions* written) {
  if (written == nullptr) return false;
  const std::vector<std::string> rivals = parts_of(setting.yields_to);
  return std::any_of(rivals.begin(), rivals.end(),
                     [&](const std::string& rival) { return written->has(rival); });
}

}  // namespace

ChosenValue choose(const OptionLayers& layers, std::string_view option) {
  const Setting& setting = setting_of(option, layers.command);
  if (layers.written != nullptr && layers.written->has(option)) {
    const bool is_flag = !setting.flag.empty();
    return {is_flag ? std::string(setting.flag) : layers.written->text(option),
            ValueFrom::kCommandLine};
  }
  const bool key_counts = !setting.key.empty() && (setting.key_counts_for & layers.command) != 0;
  if (layers.config != nullptr && key_counts && !yields(setting, layers.written)) {
    const auto at = layers.config->find(setting.key);
    if (at != layers.config->end()) return {at->second, ValueFrom::kConfig};
  }
  const auto at = layers.ini.find(option);
  if (at != layers.ini.end()) return {at->second, ValueFrom::kIni};
  if (!setting.fallback.empty()) return {std::string(setting.fallback), ValueFrom::kDefault};
  return {};
}

}  // namespace kerf
