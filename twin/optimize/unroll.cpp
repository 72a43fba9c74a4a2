#include "twin/optimize/unroll.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/optimize/nc_parameters.h"

namespace kerf {
namespace {

/// Calls in calls.
constexpr std::size_t kDeepestCalls = 10;

/// An O-word's line.
struct Control {
  std::string name;  ///< "100", "<pocket>"
  std::string word;  ///< "while"; empty: the line is none
  std::size_t rest = 0;
};

/// Calls `visit(begin, end, is_comment)` for stretches of a line.
template <class Visit>
void for_each_stretch(std::string_view line, Visit&& visit) {
  std::size_t at = 0;
  while (at < line.size()) {
    if (line[at] == ';') return visit(at, line.size(), true);
    const bool is_comment = line[at] == '(';
    const std::size_t end = is_comment ? line.find(')', at) : line.find_first_of("(;", at);
    const std::size_t stop = end == line.npos ? line.size() : is_comment ? end + 1 : end;
    visit(at, stop, is_comment);
    at = stop;
  }
}

/// Comments as blanks, so that places stay.
std::string without_comments(std::string_view line) {
  std::string out(line);
  for_each_stretch(line, [&](std::size_t begin, std::size_t end, bool is_comment) {
    if (is_comment)
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(begin),
                out.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  });
  return out;
}

std::size_t skip_blanks(std::string_view text, std::size_t at) {
  while (at < text.size() && (is_line_blank(text[at]) || text[at] == '\n')) ++at;
  return at;
}

Control control_of(std::string_view code) {
  Control out;
  std::size_t at = skip_blanks(code, 0);
  if (at < code.size() && to_lower(code[at]) == 'n') {
    ++at;
    while (at < code.size() && (is_digit(code[at]) || code[at] == '.' || is_line_blank(code[at])))
      ++at;
  }
  if (at >= code.size() || to_lower(code[at]) != 'o') return out;
  at = skip_blanks(code, at + 1);
  const char end = at < code.size() && code[at] == '<' ? '>' : '\0';
  for (; at < code.size() && (end != '\0' || is_digit(code[at])); ++at) {
    if (!is_line_blank(code[at])) out.name += to_lower(code[at]);
    if (end != '\0' && code[at] == end) {
      ++at;
      break;
    }
  }
  for (at = skip_blanks(code, at); at < code.size() && is_letter(code[at]); ++at)
    out.word += to_lower(code[at]);
  if (out.word.empty()) out.word = "?";
  out.rest = at;
  return out;
}

class Unroller {
 public:
  Unroller(const NcText& text, std::size_t most_lines) : text_(text), most_lines_(most_lines) {}

  Result<UnrolledText> run() {
    read_controls();
    if (fault_.empty()) execute();
    if (!fault_.empty()) return Error{fault_};
    return std::move(out_);
  }

 private:
  struct Loop {
    std::size_t begin = 0, end = 0;  ///< lines of its first and last O-word
    double left = 0;                 ///< passes of a repeat
    std::size_t passes = 0;
    std::size_t depth = 0;  ///< of calls
  };

  bool fail(std::size_t index, const std::string& why) {
    if (fault_.empty()) fault_ = trf("--unroll: line {}: {}", index + 1, why);
    return false;
  }
  std::string_view line(std::size_t index) const { return text_.lines()[index].text; }

  /// Which O-words belong together.
  void read_controls() {
    const std::size_t count = text_.lines().size();
    code_.reserve(count);
    std::map<std::string, std::size_t> open;  // of a name: where it began
    for (std::size_t i = 0; i < count; ++i) {
      code_.push_back(without_comments(line(i)));
      controls_.push_back(control_of(code_.back()));
      const Control& control = controls_.back();
      partner_.push_back(i);
      if (code_[i][skip_blanks(code_[i], 0)] == '/' && is_deleted_control(i))
        return void(fail(i, tr("a block that may be deleted has an O-word")));
      if (control.word.empty() || control.word == "call") continue;
      const auto begun = open.find(control.name);
      const bool is_open = begun != open.end();
      if (control.word == "sub" || control.word == "repeat" || control.word == "do" ||
          control.word == "if" || (control.word == "while" && !is_open)) {
        if (is_open) return void(fail(i, tr("an O-word that is open already")));
        open[control.name] = i;
        if (control.word == "sub") subs_[control.name] = i;
      } else if (!is_open) {
        return void(fail(i, trf("'{}' without its beginning", control.word)));
      } else if (control.word == "elseif" || control.word == "else") {
        branches_[begun->second].push_back(i);
      } else if (control.word.starts_with("end") || control.word == "while") {
        partner_[begun->second] = i;
        partner_[i] = begun->second;
        open.erase(begun);
      } else if (control.word == "break" || control.word == "continue" ||
                 control.word == "return") {
        partner_[i] = begun->second;
      } else {
        return void(fail(i, trf("'{}' is not known", control.word)));
      }
    }
    if (!open.empty()) fail(open.begin()->second, tr("an O-word that does not end"));
  }

  bool emit(std::string_view text, std::uint32_t number) {
    out_.text += text;
    if (!text.ends_with('\n')) out_.text += '\n';
    out_.line_before.push_back(number);
    if (out_.line_before.size() <= most_lines_) return true;
    return fail(number > 0 ? number - 1 : 0,
                trf("more than {} lines would come of it", most_lines_));
  }
  bool remark(std::size_t index, std::size_t pass) {
    const Control& control = controls_[index];
    const std::string end = line(index).ends_with('\r') ? "\r\n" : "\n";
    return emit(
        pass > 0 ? fmt::format("(line {}: o{} {}, pass {}){}", index + 1, control.name,
                               control.word, pass, end)
                 : fmt::format("(line {}: o{} {}){}", index + 1, control.name, control.word, end),
        0);
  }

  std::optional<double> value_at(std::size_t index, std::size_t at) {
    NcExpression expression(code_[index], parameters_);
    at = skip_blanks(code_[index], at);
    const std::optional<double> out = expression.value(at);
    if (!out) fail(index, expression.fault());
    return out;
  }

  void execute() {
    std::size_t at = 0;
    while (at < code_.size() && fault_.empty() && !is_over_) {
      const bool is_control = !controls_[at].word.empty();
      const bool is_deleted = code_[at][skip_blanks(code_[at], 0)] == '/';
      if (is_deleted && code_[at].find('#') != std::string::npos &&
          code_[at].find('=') != std::string::npos) {
        fail(at, tr("a block that may be deleted sets a parameter"));
      } else if (is_control) {
        at = step(at);
      } else {
        copy(at++);
      }
    }
    // What ends a file that begins with a percent sign.
    for (; at < code_.size(); ++at) {
      if (code_[at][skip_blanks(code_[at], 0)] == '%')
        emit(line(at), static_cast<std::uint32_t>(at + 1));
    }
  }

  bool is_deleted_control(std::size_t index) const {
    const std::string& code = code_[index];
    return !control_of(std::string_view(code).substr(skip_blanks(code, 0) + 1)).word.empty();
  }

  /// A line of words: numbers in the place of expressions, and nothing is set.
  bool copy(std::size_t index) {
    const std::string& code = code_[index];
    const bool is_plain = code.find_first_of("#[") == std::string::npos;
    if (is_plain) {
      note_end(code);
      return emit(line(index), static_cast<std::uint32_t>(index + 1));
    }
    struct Setting {
      NcExpression::Place place;
      double value = 0;
    };
    std::vector<Setting> settings;
    std::string out;
    const std::string_view whole = line(index);
    NcExpression expression(code, parameters_);
    bool has_words = false;
    for (std::size_t at = 0; at < code.size();) {
      if (code[at] == '#') {
        const std::optional<NcExpression::Place> place = expression.place(at);
        if (!place) return fail(index, expression.fault());
        at = skip_blanks(code, at);
        if (at >= code.size() || code[at] != '=') return fail(index, tr("'=' is expected"));
        ++at;
        const std::optional<double> value = expression.value(at);
        if (!value) return fail(index, expression.fault());
        settings.push_back({*place, *value});
        continue;
      }
      const char c = code[at];
      out += whole[at++];
      if (!is_letter(c) && c != '@' && c != '^') continue;
      if (to_lower(c) == 'o') return fail(index, tr("an O-word behind something else"));
      has_words = true;
      const std::size_t value_at = skip_blanks(code, at);
      if (value_at >= code.size()) continue;
      std::size_t sign = value_at;
      while (sign < code.size() && (code[sign] == '+' || code[sign] == '-')) ++sign;
      sign = skip_blanks(code, sign);
      const bool is_worked_out =
          sign < code.size() && (code[sign] == '#' || code[sign] == '[' || is_letter(code[sign]));
      if (!is_worked_out) continue;
      at = value_at;
      const std::optional<double> value = expression.value(at);
      if (!value) return fail(index, expression.fault());
      out += exact_text(*value);
    }
    for (const Setting& one : settings) {
      if (one.place.name.empty()) {
        if (one.place.number >= NcParameters::kFirstOfMachine)
          return fail(index, trf("#{} is set, which is the machine's", one.place.number));
        parameters_.set(one.place.number, one.value);
      } else {
        parameters_.set(one.place.name, one.value);
      }
    }
    const bool is_empty = trim(out, [](char c) { return is_line_blank(c) || c == '\n'; }).empty();
    if (!has_words && is_empty) return true;
    note_end(without_comments(out));
    return emit(out, static_cast<std::uint32_t>(index + 1));
  }

  /// M2 and M30 end it.
  void note_end(std::string_view code) {
    for (std::size_t at = 0; at < code.size(); ++at) {
      if (code[at] == '<') at = std::min(code.find('>', at), code.size() - 1);
      if (to_lower(code[at]) != 'm') continue;
      std::size_t digits = skip_blanks(code, at + 1);
      const std::size_t begin = digits;
      while (digits < code.size() && is_digit(code[digits])) ++digits;
      const std::string_view number = code.substr(begin, digits - begin);
      is_over_ = is_over_ || number == "2" || number == "02" || number == "30";
      if (number == "98" || number == "99")
        fault_ = trf("--unroll: M{} calls or ends a subroutine by its number: that is not followed",
                     number);
    }
  }

  /// An O-word: the line to go on with.
  std::size_t step(std::size_t index) {
    const Control& control = controls_[index];
    const std::string& word = control.word;
    const std::size_t next = index + 1;
    if (word == "call") return call(index);
    if (word == "sub") return partner_[index] + 1;  // read, not called
    if (word == "endsub" || word == "return") return leave(index);
    if (word == "if") return choose(index);
    if (word == "elseif" || word == "else") return partner_[owner_of_branch(index)] + 1;
    if (word == "endif") return next;
    if (word == "repeat") return begin_repeat(index);
    if (word == "do") return begin_do(index);
    if (word == "while" && partner_[index] > index) return test(index, index);
    if (word == "while") return test(index, partner_[index]);
    if (word == "endwhile") return partner_[index];
    if (word == "endrepeat") return next_repeat(partner_[index]);
    if (word == "break") return end_loop(partner_[index]);
    // continue
    const std::size_t begin = partner_[index];
    const std::string& kind = controls_[begin].word;
    return kind == "repeat" ? next_repeat(begin) : kind == "do" ? partner_[begin] : begin;
  }

  std::size_t owner_of_branch(std::size_t index) const {
    for (const auto& [owner, branches] : branches_) {
      for (const std::size_t branch : branches) {
        if (branch == index) return owner;
      }
    }
    return index;
  }

  std::size_t choose(std::size_t index) {
    const std::optional<double> first = value_at(index, controls_[index].rest);
    if (!first || *first != 0) return index + 1;
    for (const std::size_t branch : branches_[index]) {
      if (controls_[branch].word == "else") return branch + 1;
      const std::optional<double> other = value_at(branch, controls_[branch].rest);
      if (!other || *other != 0) return branch + 1;
    }
    return partner_[index] + 1;
  }

  Loop& loop_of(std::size_t begin) { return loops_[{begin, parameters_.depth()}]; }

  bool next_pass(std::size_t begin) {
    ++out_.passes;
    if (out_.passes > most_lines_) return fail(begin, tr("a loop that does not end"));
    return remark(begin, ++loop_of(begin).passes);
  }
  std::size_t end_loop(std::size_t begin) {
    loops_.erase({begin, parameters_.depth()});
    return partner_[begin] + 1;
  }

  /// `condition`: the line that has it; `begin`: the loop's first.
  std::size_t test(std::size_t condition, std::size_t begin) {
    const std::optional<double> goes_on = value_at(condition, controls_[condition].rest);
    if (!goes_on) return condition;
    if (*goes_on == 0) return end_loop(begin);
    next_pass(begin);
    return begin + 1;
  }
  std::size_t begin_do(std::size_t index) {
    next_pass(index);
    return index + 1;
  }
  std::size_t begin_repeat(std::size_t index) {
    const std::optional<double> count = value_at(index, controls_[index].rest);
    if (!count) return index;
    loop_of(index).left = std::round(*count);
    return next_repeat(index);
  }
  std::size_t next_repeat(std::size_t begin) {
    Loop& loop = loop_of(begin);
    if (loop.left <= 0) return end_loop(begin);
    --loop.left;
    next_pass(begin);
    return begin + 1;
  }

  std::size_t call(std::size_t index) {
    const Control& control = controls_[index];
    const auto sub = subs_.find(control.name);
    if (sub == subs_.end()) {
      fail(index, trf("the subroutine o{} is not in this file ahead of it", control.name));
      return index;
    }
    std::vector<double> arguments;
    NcExpression expression(code_[index], parameters_);
    std::size_t at = skip_blanks(code_[index], control.rest);
    while (at < code_[index].size() && code_[index][at] == '[') {
      const std::optional<double> value = expression.value(at);
      if (!value) {
        fail(index, expression.fault());
        return index;
      }
      arguments.push_back(*value);
      at = skip_blanks(code_[index], at);
    }
    if (returns_.size() >= kDeepestCalls) {
      fail(index, tr("subroutines call each other too deeply"));
      return index;
    }
    ++out_.calls;
    remark(index, 0);
    returns_.push_back(index + 1);
    parameters_.begin_call(arguments);
    return sub->second + 1;
  }

  std::size_t leave(std::size_t index) {
    if (returns_.empty()) {
      fail(index, tr("no subroutine has been called"));
      return index;
    }
    const std::size_t at = skip_blanks(code_[index], controls_[index].rest);
    double value = 0;
    const bool has_value = at < code_[index].size() && code_[index][at] == '[';
    if (has_value) {
      const std::optional<double> found = value_at(index, at);
      if (!found) return index;
      value = *found;
    }
    std::erase_if(loops_, [&](const auto& one) { return one.first.second >= parameters_.depth(); });
    parameters_.end_call();
    parameters_.set("_value", value);
    parameters_.set("_value_returned", has_value ? 1 : 0);
    const std::size_t back = returns_.back();
    returns_.pop_back();
    return back;
  }

  const NcText& text_;
  const std::size_t most_lines_;
  std::vector<std::string> code_;  ///< lines without comments
  std::vector<Control> controls_;
  /// Of the first line of what belongs together the last, and the other way round; of break,
  /// continue and return the first.
  std::vector<std::size_t> partner_;
  std::map<std::size_t, std::vector<std::size_t>> branches_;  ///< of an if
  std::map<std::string, std::size_t> subs_;
  std::map<std::pair<std::size_t, std::size_t>, Loop> loops_;  ///< by line and depth of calls
  std::vector<std::size_t> returns_;
  NcParameters parameters_;
  UnrolledText out_;
  bool is_over_ = false;
  std::string fault_;
};

}  // namespace

Result<UnrolledText> unroll(const NcText& text, std::size_t most_lines) {
  return Unroller(text, most_lines).run();
}

}  // namespace kerf
