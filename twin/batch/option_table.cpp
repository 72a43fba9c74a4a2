#include "twin/batch/option_table.h"

#include <fnmatch.h>

#include <optional>
#include <utility>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

struct TableWord {
  std::string text;
  std::size_t at = 0;  ///< of its first sign in the line
};

/// Reads one line; what is wrong with it is told at its place.
class RowReader {
 public:
  RowReader(std::string_view line, int number, const std::string& path, Diagnostics& diagnostics)
      : line_(line), number_(number), path_(path), diagnostics_(diagnostics) {}

  std::optional<OptionRow> read() {
    const std::size_t colon = find_colon();
    OptionRow row;
    row.line = number_;
    row.pattern = std::string(trim(line_.substr(0, colon)));
    if (colon == line_.npos || row.pattern.empty()) {
      fault(0, tr("no pattern; a line is PATTERN: OPTIONS"), "slot*.ngc: --tool 1=flat:6");
      return std::nullopt;
    }
    const std::optional<std::vector<TableWord>> words = words_from(colon + 1);
    if (!words) return std::nullopt;
    if (words->empty()) {
      fault(colon, trf("{}: no options behind the pattern", row.pattern));
      return std::nullopt;
    }
    return read_options(*words, row) ? std::optional(std::move(row)) : std::nullopt;
  }

 private:
  void fault(std::size_t at, std::string message, std::string hint = {}) {
    Diagnostic d;
    d.file = path_;
    d.line = number_;
    d.column = static_cast<int>(at) + 1;
    d.message = std::move(message);
    d.excerpt = std::string(line_);
    d.hint = std::move(hint);
    diagnostics_.push_back(std::move(d));
  }

  /// A colon with a blank, or nothing, behind it: one within a name is none.
  std::size_t find_colon() const {
    for (std::size_t at = line_.find(':'); at != line_.npos; at = line_.find(':', at + 1)) {
      if (at + 1 == line_.size() || is_line_blank(line_[at + 1])) return at;
    }
    return line_.npos;
  }

  std::optional<std::vector<TableWord>> words_from(std::size_t at) {
    std::vector<TableWord> words;
    char quote = 0;
    std::size_t quoted_at = 0;
    bool within = false;
    for (; at < line_.size(); ++at) {
      const char c = line_[at];
      if (quote == 0 && is_line_blank(c)) {
        within = false;
        continue;
      }
      if (!std::exchange(within, true)) words.push_back({{}, at});
      if (quote != 0 ? c == quote : c == '\'' || c == '"') {
        quote = quote != 0 ? '\0' : c;
        quoted_at = at;
      } else if (c == '\\' && quote != '\'' && at + 1 < line_.size()) {
        words.back().text += line_[++at];
      } else {
        words.back().text += c;
      }
    }
    if (quote == 0) return words;
    fault(quoted_at, tr("this quote is not closed"));
    return std::nullopt;
  }

  const Setting* setting_for(const TableWord& word, const std::string& name) {
    std::vector<std::string> allowed;
    for (const Setting& setting : setting_table()) {
      if (!is_passed_on(setting)) continue;
      if (name == setting.option || (!name.empty() && name == setting.short_name)) return &setting;
      allowed.emplace_back(setting.option);
    }
    const std::string near = nearest_word(name, allowed);
    std::string message = trf("{}: no option that a batch passes on", shown(name));
    if (!near.empty()) message += trf("; did you mean {}?", near);
    fault(word.at, std::move(message), tr("kerf batch --help lists what there is"));
    return nullptr;
  }

  bool read_options(const std::vector<TableWord>& words, OptionRow& row) {
    bool good = true;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string& text = words[i].text;
      const std::size_t equals = text.starts_with("--") ? text.find('=') : text.npos;
      const Setting* const setting = setting_for(words[i], text.substr(0, equals));
      good = good && setting != nullptr;
      if (setting == nullptr) {
        // Its value is not another unknown option.
        while (i + 1 < words.size() && !words[i + 1].text.starts_with("--")) ++i;
        continue;
      }
      std::string value;
      if (!setting->flag.empty()) {
        if (equals != text.npos) {
          fault(words[i].at, trf("{} takes no value", setting->option));
          good = false;
        }
      } else if (equals != text.npos) {
        value = text.substr(equals + 1);
      } else if (i + 1 < words.size() && !words[i + 1].text.starts_with("--")) {
        value = words[++i].text;
      }
      if (setting->flag.empty() && value.empty()) {
        fault(words[i].at, trf("{}: a value must follow", setting->option));
        good = false;
      }
      row.said.emplace_back(setting->option, std::move(value));
    }
    return good;
  }

  std::string_view line_;
  int number_;
  const std::string& path_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::vector<OptionRow> parse_option_table(std::string_view text, const std::string& path,
                                          Diagnostics& diagnostics) {
  std::vector<OptionRow> rows;
  int number = 0;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number;
    const std::string_view said = trim(line);
    if (said.empty() || said.front() == '#') continue;
    if (auto row = RowReader(line, number, path, diagnostics).read()) {
      rows.push_back(std::move(*row));
    }
  }
  return rows;
}

bool fits(const OptionRow& row, const std::string& program) {
  return fnmatch(row.pattern.c_str(), program.c_str(), 0) == 0 ||
         fnmatch(("*/" + row.pattern).c_str(), program.c_str(), 0) == 0;
}

void apply(const OptionRow& row, WrittenOptions& options) {
  for (const auto& [option, value] : row.said) {
    const Setting& setting = setting_of(option, kRun);
    if (!setting.flag.empty()) {
      options.set_flag(option);
    } else if (setting.repeatable) {
      options.add(option, value);
    } else {
      options.set(option, value);
    }
  }
}

std::vector<std::string> run_words(const WrittenOptions& options) {
  std::vector<std::string> words;
  for (const Setting& setting : setting_table()) {
    if (!is_passed_on(setting) || !options.has(setting.option)) continue;
    const std::string name(setting.option);
    if (!setting.flag.empty()) {
      words.push_back(name);
    } else if (setting.repeatable && !options.texts(name).empty()) {
      for (const std::string& value : options.texts(name)) words.push_back(name + "=" + value);
    } else {
      words.push_back(name + "=" + options.text(name));
    }
  }
  return words;
}

}  // namespace kerf
