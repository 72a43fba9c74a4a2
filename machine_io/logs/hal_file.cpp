// Which HAL pin stands in which column of a sampler: from the .hal file that connected them.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/logs/log_source.h"

namespace kerf {
namespace {

// The sampler of LinuxCNC has 20 pins; more is a number that was mistyped.
constexpr std::size_t kMostPins = 64;

struct Word {
  std::string text;
  int column = 0;
};

bool is_arrow(const std::string& word) { return word == "=>" || word == "<=" || word == "<=>"; }

/// One command with what `\` continues it by.
struct Command {
  int line = 0;
  std::vector<Word> words;
};

std::vector<Command> split_commands(std::string_view text) {
  std::vector<Command> commands;
  bool is_continued = false;
  int number = 0;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool continues = line.ends_with('\\');
    if (continues) line.remove_suffix(1);
    if (!is_continued) commands.push_back({number, {}});
    is_continued = continues;
    for (std::size_t at = 0; at < line.size();) {
      if (line[at] == '#') break;
      const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
      if (stop > at) {
        commands.back().words.push_back(
            {std::string(line.substr(at, stop - at)), static_cast<int>(at) + 1});
      }
      at = stop + 1;
    }
  }
  return commands;
}

struct Signal {
  std::string writer;  // the pin that an arrow says is the source
  std::string pin;     // the first one that is no sampler's
};

struct Connections {
  std::map<std::string, Signal> signals;
  std::map<std::size_t, std::string> signal_of_column;
  std::optional<std::size_t> configured;  // columns by cfg=
};

class Collector {
 public:
  Collector(const std::string& name, int channel, Diagnostics& diagnostics)
      : name_(name),
        prefix_(fmt::format("sampler.{}.pin.", channel)),
        channel_(channel),
        diagnostics_(diagnostics) {}

  void take(const Command& command) {
    const auto& words = command.words;
    if (words.size() < 2) return;
    const std::string& verb = words[0].text;
    if (verb == "net") {
      connect(command, words[1].text, 2);
    } else if (verb == "linksp" && words.size() > 2) {
      connect(command, words[1].text, 2);
    } else if (verb == "linkps" && words.size() > 2) {
      connect_pin(command, words.back().text, words[1], true);
    } else if (verb == "loadrt" && words[1].text == "sampler") {
      configure(command);
    }
  }

  std::vector<std::string> pins() {
    std::size_t count = found_.configured.value_or(0);
    if (!found_.signal_of_column.empty()) {
      count = std::max(count, found_.signal_of_column.rbegin()->first + 1);
    }
    if (count == 0 || found_.signal_of_column.empty()) {
      fail(0, 0, trf("nothing is connected to {}N here", prefix_),
           tr("name the .hal file that has the sampler's net lines, or give the pins themselves"));
    }
    if (has_error(diagnostics_)) return {};
    std::vector<std::string> pins(count);
    for (const auto& [column, name] : found_.signal_of_column) {
      const Signal& signal = found_.signals[name];
      pins[column] = !signal.writer.empty() ? signal.writer
                     : !signal.pin.empty()  ? signal.pin
                                            : "signal " + name;
    }
    return pins;
  }

 private:
  void fail(int line, int column, std::string message, std::string hint) {
    diagnostics_.push_back(
        {Severity::kError, name_, line, column, std::move(message), {}, std::move(hint)});
  }

  void connect(const Command& command, const std::string& signal, std::size_t first) {
    const auto& words = command.words;
    for (std::size_t i = first; i < words.size(); ++i) {
      if (is_arrow(words[i].text)) continue;
      const bool writes =
          (i + 1 < words.size() && words[i + 1].text == "=>") || (words[i - 1].text == "<=");
      connect_pin(command, signal, words[i], writes);
    }
  }

  void connect_pin(const Command& command, const std::string& signal, const Word& pin,
                   bool writes) {
    Signal& known = found_.signals[signal];
    if (!pin.text.starts_with(prefix_)) {
      if (pin.text.starts_with("sampler.")) return;
      if (writes && known.writer.empty()) known.writer = pin.text;
      if (known.pin.empty()) known.pin = pin.text;
      return;
    }
    const std::string_view digits = std::string_view(pin.text).substr(prefix_.size());
    std::size_t column = 0;
    if (!read_number(digits, column) || column >= kMostPins) {
      fail(command.line, pin.column, trf("{} is no pin of a sampler", pin.text), "");
      return;
    }
    if (found_.configured && column >= *found_.configured) {
      fail(command.line, pin.column,
           trf("{}: cfg= gives channel {} only {} pins", pin.text, channel_, *found_.configured),
           "");
      return;
    }
    found_.signal_of_column[column] = signal;
  }

  /// cfg=ffb,uu: a letter per pin, channels apart by commas.
  void configure(const Command& command) {
    for (const Word& word : command.words) {
      std::string_view value = word.text;
      if (!value.starts_with("cfg=")) continue;
      value.remove_prefix(4);
      if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
        value = value.substr(1, value.size() - 2);
      }
      for (int skipped = 0; skipped < channel_; ++skipped) {
        value.remove_prefix(std::min(value.find(','), value.size()));
        if (!value.empty()) value.remove_prefix(1);
      }
      found_.configured = std::min(std::min(value.find(','), value.size()), kMostPins);
    }
  }

  const std::string& name_;
  std::string prefix_;
  int channel_;
  Diagnostics& diagnostics_;
  Connections found_;
};

}  // namespace

std::vector<std::string> pins_from_hal_text(std::string_view text, const std::string& name,
                                            int channel, Diagnostics& diagnostics) {
  Diagnostics mine;
  Collector collector(name, channel, mine);
  for (const Command& command : split_commands(text)) collector.take(command);
  std::vector<std::string> pins = collector.pins();
  diagnostics.insert(diagnostics.end(), mine.begin(), mine.end());
  return pins;
}

std::vector<std::string> pins_from_hal_file(const std::string& path, int channel,
                                            Diagnostics& diagnostics) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in) {
    diagnostics.push_back({Severity::kError, path, 0, 0, tr("the file cannot be read"), {}, {}});
    return {};
  }
  return pins_from_hal_text(text.str(), path, channel, diagnostics);
}

}  // namespace kerf
