#include "twin/machine/kinematics/hal_facts.h"

#include <algorithm>
#include <cmath>

#include "base/small_file.h"
#include "base/text_scan.h"

namespace kerf {
namespace {

constexpr std::size_t kMostBytes = 1'000'000;
constexpr std::string_view kToolLength = "motion.tooloffset.z";
/// Sums of sums of sums: deeper ones are circles.
constexpr int kMostSums = 8;

std::optional<double> number_of(std::string_view text) {
  if (text == "TRUE" || text == "true") return 1;
  if (text == "FALSE" || text == "false") return 0;
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  double value = 0;
  return read_number(text, value) && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// A number, or [SECTION]KEY.
std::optional<double> value_in(IniFile& ini, std::string_view text) {
  if (text.empty() || text[0] != '[') return number_of(text);
  const std::size_t close = text.find(']');
  if (close == text.npos) return std::nullopt;
  const IniEntry* const entry = ini.find(text.substr(1, close - 1), text.substr(close + 1));
  return entry != nullptr ? number_of(entry->value) : std::nullopt;
}

bool is_arrow(std::string_view word) { return word == "=>" || word == "<=" || word == "<=>"; }

}  // namespace

HalFacts::HalFacts(IniFile& ini, const std::string& folder) {
  for (const char* key : {"HALFILE", "HALCMD", "POSTGUI_HALFILE"}) {
    for (const IniEntry* const entry : ini.find_all("HAL", key)) {
      if (std::string_view(key) == "HALCMD") {
        read_line(ini, entry->value);
        known_ = true;
        continue;
      }
      const std::string name = entry->value.substr(0, entry->value.find_first_of(" \t"));
      const bool tcl = name.size() > 4 && name.compare(name.size() - 4, 4, ".tcl") == 0;
      if (!tcl && name.rfind("LIB:", 0) != 0) read_file(ini, resolve_ini_path(name, folder));
    }
  }
}

void HalFacts::read_file(IniFile& ini, const std::string& path) {
  const Result<std::string> text = read_small_file(path, kMostBytes);
  if (!text) return;
  known_ = true;
  std::string line;
  for (std::size_t at = 0; at <= text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    line += text->substr(at, end - at);
    at = end + 1;
    if (!line.empty() && line.back() == '\\') {
      line.back() = ' ';
      continue;
    }
    read_line(ini, line);
    line.clear();
  }
}

void HalFacts::link(const std::string& signal, const std::string& pin) {
  signal_of_[pin] = signal;
  pins_of_[signal].insert(pin);
}

void HalFacts::read_line(IniFile& ini, std::string_view line) {
  std::vector<std::string> words;
  for (const std::string_view word : words_of(line.substr(0, line.find('#')))) {
    if (!is_arrow(word)) words.emplace_back(word);
  }
  if (words.size() < 3) return;
  const std::string& command = words[0];
  if (command == "setp" || command == "sets") {
    const std::optional<double> value = value_in(ini, words[2]);
    if (value) (command == "setp" ? pins_ : signals_)[words[1]] = *value;
  } else if (command == "net" || command == "linksp") {
    for (std::size_t i = 2; i < words.size(); ++i) link(words[1], words[i]);
  } else if (command == "linkps") {
    link(words[2], words[1]);
  }
}

std::set<std::string> HalFacts::linked_with(const std::string& pin) const {
  const auto signal = signal_of_.find(pin);
  if (signal == signal_of_.end()) return {};
  std::set<std::string> others = pins_of_.at(signal->second);
  others.erase(pin);
  return others;
}

HalValue HalFacts::value_of(const std::string& pin, int depth) const {
  HalValue value;
  const auto signal = signal_of_.find(pin);
  if (signal == signal_of_.end()) {
    const auto set = pins_.find(pin);
    value.is_set = set != pins_.end();
    if (value.is_set) value.number = set->second;
    return value;
  }
  const auto set = signals_.find(signal->second);
  if (set != signals_.end()) {
    value.is_set = true;
    value.number = set->second;
  }
  for (const std::string& other : linked_with(pin)) {
    if (other == kToolLength) {
      value.has_tool_length = true;
      continue;
    }
    const std::size_t dot = other.rfind('.');
    const std::string block = other.substr(0, dot);
    const bool sums = dot != other.npos && other.substr(dot) == ".out" && depth < kMostSums &&
                      (signal_of_.count(block + ".in0") != 0 || pins_.count(block + ".in0") != 0);
    if (!sums) {
      // Readers of the signal stand there as well: only what nobody sets is told of.
      if (!value.is_set) value.from.push_back(other);
      continue;
    }
    for (const char* input : {".in0", ".in1"}) {
      const HalValue part = value_of(block + input, depth + 1);
      value.is_set |= part.is_set;
      value.number += part.number;
      value.has_tool_length |= part.has_tool_length;
      value.from.insert(value.from.end(), part.from.begin(), part.from.end());
    }
  }
  return value;
}

}  // namespace kerf
