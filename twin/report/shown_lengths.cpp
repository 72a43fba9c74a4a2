#include "twin/report/shown_lengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

/// A unit of a text, and what becomes of it.
struct ShownUnit {
  std::string_view word;
  std::string_view inch;
  double factor;  ///< one of it is so many of `inch`
  int more_digits;
  int least_digits;
};

constexpr double kInch_mm = mm_of(LengthUnit::kInch);
constexpr double kInch3_mm3 = kInch_mm * kInch_mm * kInch_mm;

// Longer words before those that they begin with.
constexpr std::array<ShownUnit, 10> kUnits{{
    {"mm3/s", "in3/min", 60 / kInch3_mm3, 3, 3},
    {"mm3", "in3", 1 / kInch3_mm3, 4, 4},
    {"mm2", "in2", 1 / (kInch_mm * kInch_mm), 3, 3},
    {"mm/min", "in/min", 1 / kInch_mm, 1, 1},
    {"mm/s2", "in/s2", 1 / kInch_mm, 1, 1},
    {"mm/s", "in/s", 1 / kInch_mm, 1, 2},
    {"mm", "in", 1 / kInch_mm, 1, 3},
    {"cm3", "in3", 1000 / kInch3_mm3, 1, 3},
    {"cm2", "in2", 100 / (kInch_mm * kInch_mm), 1, 2},
    {"m", "in", 1000 / kInch_mm, -1, 1},
}};
constexpr ShownUnit kPlace{"", "", 1 / kInch_mm, 1, 3};

constexpr std::array<std::string_view, 16> kShapes{
    "flat",     "ball", "bull", "vee",    "taper", "drill",      "lollipop", "tslot",
    "dovetail", "kerf", "turn", "groove", "part",  "facegroove", "thread",   "bore"};
constexpr std::string_view kInsert = "iso";  // by its designation
constexpr std::array<std::string_view, 6> kLengthOptions{"cell",   "kerf",  "pierce",
                                                         "margin", "below", "tolerance"};
// TRANSLATORS: between the ends of a range, "0.05 to 0.2 mm"
constexpr const char* kTo = tr_noop(" to ");
constexpr std::array<std::string_view, 5> kBetween{" x ", " / ", kTo, " .. ", ".."};

bool is_word(char c) { return is_digit(c) || is_letter(c) || c == '_'; }

/// A number as it was written.
struct Written {
  double value = 0;
  int digits = 0;  ///< behind the point
  std::size_t length = 0;
};

/// At the beginning of `text`; no exponent without digits, no sign alone.
std::optional<Written> number_at(std::string_view text) {
  std::size_t at = !text.empty() && text[0] == '-' ? 1 : 0;
  const std::size_t first = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  if (at == first) return std::nullopt;
  Written out;
  if (at + 1 < text.size() && text[at] == '.' && is_digit(text[at + 1])) {
    const std::size_t point = at++;
    while (at < text.size() && is_digit(text[at])) ++at;
    out.digits = static_cast<int>(at - point - 1);
  }
  // Small ones are written as 1e-05, and large ones as 2.07e+03.
  const std::string_view behind = text.substr(at);
  if ((behind.starts_with("e-") || behind.starts_with("e+")) && behind.size() > 2 &&
      is_digit(behind[2])) {
    out.digits = behind[1] == '-' ? 6 : 0;
    at += 2;
    while (at < text.size() && is_digit(text[at])) ++at;
  }
  out.length = at;
  const auto read = std::from_chars(text.data(), text.data() + at, out.value);
  return read.ec == std::errc() ? std::optional(out) : std::nullopt;
}

/// Without zeros at its end; of what is not 0 two digits at least.
std::string shown_number(const Written& number, const ShownUnit& unit) {
  constexpr int kMostDigits = 9;
  const double value = number.value * unit.factor;
  int digits = std::clamp(number.digits + unit.more_digits, unit.least_digits, kMostDigits);
  while (value != 0 && digits < kMostDigits && std::abs(value) * std::pow(10, digits) < 10) {
    ++digits;
  }
  std::string out = fmt::format("{:.{}f}", value, digits);
  if (out.find('.') != out.npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out == "-0" ? "0" : out;
}

/// Goes through a text once.
class Translation {
 public:
  Translation(std::string_view text, LengthUnit unit) : left_(text), unit_(unit) {}

  std::string take() {
    while (!left_.empty()) {
      const bool begins = !is_word(last_) && last_ != '.' && last_ != '-';
      if (begins && (shape() || option() || places() || lengths())) continue;
      copy(begins && number_at(left_) ? number_at(left_)->length : 1);
    }
    return std::move(out_);
  }

 private:
  void copy(std::size_t count) {
    out_ += left_.substr(0, count);
    pass(count);
  }
  void pass(std::size_t count) {
    last_ = left_[count - 1];
    left_.remove_prefix(count);
  }

  /// The unit that stands behind `at`, after a blank.
  const ShownUnit* unit_at(std::size_t at) const {
    if (at >= left_.size() || left_[at] != ' ') return nullptr;
    const std::string_view word = left_.substr(at + 1);
    for (const ShownUnit& unit : kUnits) {
      if (!word.starts_with(unit.word)) continue;
      const char next = word.size() > unit.word.size() ? word[unit.word.size()] : ' ';
      if (!is_word(next) && next != '/') return &unit;
    }
    return nullptr;
  }

  bool shape() {
    const std::size_t colon = left_.find(':');
    if (colon == left_.npos || colon + 1 >= left_.size()) return false;
    const std::string_view name = left_.substr(0, colon);
    const bool is_insert = name == kInsert && is_letter(left_[colon + 1]);
    if (!is_insert && (!is_digit(left_[colon + 1]) ||
                       std::find(kShapes.begin(), kShapes.end(), name) == kShapes.end())) {
      return false;
    }
    std::size_t end = colon;
    while (end < left_.size() &&
           (is_word(left_[end]) ||
            std::string_view(":.=+").find(left_[end]) != std::string_view::npos)) {
      ++end;
    }
    while (left_[end - 1] == '.' || left_[end - 1] == ':') --end;
    out_ += shape_in(left_.substr(0, end), unit_);
    pass(end);
    return true;
  }

  bool option() {
    if (!left_.starts_with("--")) return false;
    for (const std::string_view name : kLengthOptions) {
      const std::string_view rest = left_.substr(2);
      if (!rest.starts_with(name) || rest.size() <= name.size() || rest[name.size()] != ' ') {
        continue;
      }
      const std::size_t at = name.size() + 3;
      const std::optional<Written> number = number_at(left_.substr(at));
      if (!number) return false;
      out_ += left_.substr(0, at);
      out_ += shown_number(*number, kPlace);
      pass(at + number->length);
      return true;
    }
    return false;
  }

  /// "X5 Z75 mm", "X0..100".
  bool places() {
    std::string text;
    std::size_t at = 0;
    while (at + 1 < left_.size() && left_[at] >= 'X' && left_[at] <= 'Z') {
      const std::optional<Written> from = number_at(left_.substr(at + 1));
      if (!from) break;
      std::size_t end = at + 1 + from->length;
      std::string place = left_[at] + shown_number(*from, kPlace);
      for (const std::string_view dots : {"..", " .. "}) {
        if (!left_.substr(end).starts_with(dots)) continue;
        if (const std::optional<Written> to = number_at(left_.substr(end + dots.size()))) {
          place += dots;
          place += shown_number(*to, kPlace);
          end += dots.size() + to->length;
        }
      }
      if (end < left_.size() && is_word(left_[end])) break;
      text += (at > 0 ? " " : "") + place;
      const bool more = end + 1 < left_.size() && left_[end] == ' ' && left_[end + 1] >= 'X' &&
                        left_[end + 1] <= 'Z';
      at = more ? end + 1 : end;
      if (!more) break;
    }
    if (text.empty()) return false;
    if (at > 0 && left_[at - 1] == ' ') --at;  // what was more is no place
    out_ += text;
    if (const ShownUnit* const unit = unit_at(at); unit && unit->word == "mm") {
      out_ += " in";
      at += 3;
    }
    pass(at);
    return true;
  }

  /// "300 x 200 x 20 mm".
  bool lengths() {
    std::vector<std::pair<std::string_view, Written>> numbers;  // with what stands before each
    std::size_t at = 0;
    std::string_view between;
    while (const std::optional<Written> number = number_at(left_.substr(at))) {
      numbers.emplace_back(between, *number);
      at += number->length;
      if (const ShownUnit* const unit = unit_at(at)) {
        for (const auto& [before, one] : numbers) {
          out_ += before;
          out_ += shown_number(one, *unit);
        }
        out_ += ' ';
        out_ += unit->inch;
        pass(at + 1 + unit->word.size());
        range_behind(*unit);
        return true;
      }
      const std::string_view rest = left_.substr(at);
      const std::string_view to = tr(kTo);
      const auto joint =
          std::find_if(kBetween.begin(), kBetween.end(),
                       [&](const std::string_view& word) { return rest.starts_with(word); });
      if (joint == kBetween.end() && !rest.starts_with(to)) return false;
      between = joint == kBetween.end() ? to : *joint;
      at += between.size();
    }
    return false;
  }

  /// " (0.0105 to 0.106)", " (0.0105 to 0.106, line 37)" behind "0.0224 mm".
  void range_behind(const ShownUnit& unit) {
    if (!left_.starts_with(" (")) return;
    const std::optional<Written> low = number_at(left_.substr(2));
    if (!low) return;
    std::size_t at = 2 + low->length;
    const std::string_view to = left_.substr(at).starts_with(tr(kTo)) ? tr(kTo) : kTo;
    if (!left_.substr(at).starts_with(to)) return;
    at += to.size();
    const std::optional<Written> high = number_at(left_.substr(at));
    if (!high) return;
    at += high->length;
    if (at >= left_.size() || (left_[at] != ')' && left_[at] != ',')) return;
    out_ += fmt::format(" ({}{}{}", shown_number(*low, unit), to, shown_number(*high, unit));
    pass(at);
  }

  std::string_view left_;
  LengthUnit unit_;
  std::string out_;
  char last_ = ' ';
};

}  // namespace

std::string in_unit(std::string_view text, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return std::string(text);
  return Translation(text, unit).take();
}

Diagnostic in_unit(Diagnostic diagnostic, LengthUnit unit) {
  if (diagnostic.message.starts_with("interpreter-")) return diagnostic;
  diagnostic.message = in_unit(diagnostic.message, unit);
  diagnostic.hint = in_unit(diagnostic.hint, unit);
  return diagnostic;
}

}  // namespace kerf
