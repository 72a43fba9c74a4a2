#include "twin/optimize/nc_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/geometry.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kDegrees = 180 / kPi;
/// As LinuxCNC's interpreter has it: EQ and NE of what is that near are true and false.
constexpr double kEqual = 1e-4;
constexpr int kMostDigits = 30;
/// Brackets in brackets.
constexpr int kDeepest = 100;

enum class Operator {
  kPower,
  kTimes,
  kOver,
  kMod,
  kPlus,
  kMinus,
  kEq,
  kNe,
  kGt,
  kGe,
  kLt,
  kLe,
  kAnd,
  kOr,
  kXor
};
struct Row {
  std::string_view text;
  Operator operation;
  int level;  ///< 0 binds closest
};
constexpr std::array<Row, 15> kOperators{{{"**", Operator::kPower, 0},
                                          {"*", Operator::kTimes, 1},
                                          {"/", Operator::kOver, 1},
                                          {"mod", Operator::kMod, 1},
                                          {"+", Operator::kPlus, 2},
                                          {"-", Operator::kMinus, 2},
                                          {"eq", Operator::kEq, 3},
                                          {"ne", Operator::kNe, 3},
                                          {"gt", Operator::kGt, 3},
                                          {"ge", Operator::kGe, 3},
                                          {"lt", Operator::kLt, 3},
                                          {"le", Operator::kLe, 3},
                                          {"and", Operator::kAnd, 4},
                                          {"or", Operator::kOr, 4},
                                          {"xor", Operator::kXor, 4}}};
constexpr int kLoosest = 4;

double worked_out(Operator operation, double a, double b) {
  const auto truth = [](bool is_true) { return is_true ? 1.0 : 0.0; };
  switch (operation) {
    case Operator::kPower:
      return std::pow(a, b);
    case Operator::kTimes:
      return a * b;
    case Operator::kOver:
      return a / b;
    case Operator::kMod: {
      const double rest = std::fmod(a, b);
      return rest < 0 ? rest + std::abs(b) : rest;
    }
    case Operator::kPlus:
      return a + b;
    case Operator::kMinus:
      return a - b;
    case Operator::kEq:
      return truth(std::abs(a - b) < kEqual);
    case Operator::kNe:
      return truth(std::abs(a - b) >= kEqual);
    case Operator::kGt:
      return truth(a > b);
    case Operator::kGe:
      return truth(a >= b);
    case Operator::kLt:
      return truth(a < b);
    case Operator::kLe:
      return truth(a <= b);
    case Operator::kAnd:
      return truth(a != 0 && b != 0);
    case Operator::kOr:
      return truth(a != 0 || b != 0);
    case Operator::kXor:
      return truth((a != 0) != (b != 0));
  }
  return 0;
}

std::optional<double> applied(std::string_view name, double x) {
  if (name == "abs") return std::abs(x);
  if (name == "acos") return std::acos(x) * kDegrees;
  if (name == "asin") return std::asin(x) * kDegrees;
  if (name == "cos") return std::cos(x / kDegrees);
  if (name == "exp") return std::exp(x);
  if (name == "fix") return std::floor(x);
  if (name == "fup") return std::ceil(x);
  if (name == "ln") return std::log(x);
  if (name == "round") return std::trunc(x < 0 ? x - 0.5 : x + 0.5);
  if (name == "sin") return std::sin(x / kDegrees);
  if (name == "sqrt") return std::sqrt(x);
  if (name == "tan") return std::tan(x / kDegrees);
  return std::nullopt;
}

}  // namespace

void NcParameters::begin_call(const std::vector<double>& arguments) {
  Call& call = calls_.emplace_back();
  for (std::size_t i = 0; i < std::min<std::size_t>(arguments.size(), kLocals); ++i)
    call.numbers[i + 1] = arguments[i];
}

std::optional<double> NcParameters::get(int number) const {
  if (number >= 1 && number <= kLocals)
    return calls_.back().numbers[static_cast<std::size_t>(number)];
  const auto found = numbers_.find(number);
  return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> NcParameters::get(const std::string& name) const {
  const auto& names = name.starts_with('_') ? names_ : calls_.back().names;
  const auto found = names.find(name);
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

void NcParameters::set(int number, double value) {
  if (number >= 1 && number <= kLocals) {
    calls_.back().numbers[static_cast<std::size_t>(number)] = value;
  } else {
    numbers_[number] = value;
  }
}

void NcParameters::set(const std::string& name, double value) {
  (name.starts_with('_') ? names_ : calls_.back().names)[name] = value;
}

char NcExpression::peek() {
  while (at_ < text_.size() && is_line_blank(text_[at_])) ++at_;
  return at_ < text_.size() ? to_lower(text_[at_]) : '\0';
}

bool NcExpression::take(char c) {
  if (peek() != c) return false;
  ++at_;
  return true;
}

bool NcExpression::take_word(std::string_view word) {
  const std::size_t before = at_;
  for (const char c : word) {
    if (take(c)) continue;
    at_ = before;
    return false;
  }
  return true;
}

std::optional<double> NcExpression::fail(std::string why) {
  if (fault_.empty()) fault_ = std::move(why);
  return std::nullopt;
}

std::optional<double> NcExpression::number() {
  std::string digits;
  if (peek() == '+' || peek() == '-') digits += text_[at_++];
  while (is_digit(peek()) || peek() == '.') digits += text_[at_++];
  if (digits.starts_with('+')) digits.erase(0, 1);
  double out = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, out);
  if (error != std::errc() || stopped != end) return fail(tr("a number is expected"));
  return out;
}

std::optional<NcExpression::Place> NcExpression::place(std::size_t& at) {
  at_ = at;
  Place out;
  if (!take('#')) return std::nullopt;
  if (take('<')) {
    while (peek() != '>' && peek() != '\0') out.name += to_lower(text_[at_++]);
    if (!take('>')) {
      fail(tr("'>' is missing"));
      return std::nullopt;
    }
  } else {
    const std::optional<double> which = single();
    if (!which) return std::nullopt;
    out.number = static_cast<int>(std::lround(*which));
    if (out.number < 1 || std::abs(*which - out.number) > kEqual) {
      fail(trf("#{:g} is no parameter", *which));
      return std::nullopt;
    }
  }
  at = at_;
  return out;
}

std::optional<double> NcExpression::parameter() {
  std::size_t at = at_;
  const std::optional<Place> which = place(at);
  if (!which) return std::nullopt;
  const std::optional<double> found =
      which->name.empty() ? parameters_.get(which->number) : parameters_.get(which->name);
  if (found) return found;
  const std::string name =
      which->name.empty() ? fmt::format("#{}", which->number) : fmt::format("#<{}>", which->name);
  return fail(trf("{} is read, which the program has not set: it is the machine's", name));
}

std::optional<double> NcExpression::bracketed() {
  if (!take('[')) return fail(tr("'[' is expected"));
  if (++depth_ > kDeepest) return fail(tr("too many brackets"));
  const std::optional<double> out = chain(kLoosest);
  --depth_;
  if (out && !take(']')) return fail(tr("']' is missing"));
  return out;
}

/// Operators of that level and of those that bind closer, from left to right.
std::optional<double> NcExpression::chain(int level) {
  std::optional<double> left = level == 0 ? single() : chain(level - 1);
  while (left) {
    const auto next = std::find_if(kOperators.begin(), kOperators.end(), [&](const Row& row) {
      const std::size_t before = at_;
      const bool is_there = take_word(row.text);
      if (!is_there || row.level != level) at_ = before;
      return is_there;
    });
    if (next == kOperators.end() || next->level != level) break;
    const std::optional<double> right = level == 0 ? single() : chain(level - 1);
    if (!right) return std::nullopt;
    left = worked_out(next->operation, *left, *right);
  }
  if (left && !std::isfinite(*left)) return fail(tr("an expression without a value"));
  return left;
}

std::optional<double> NcExpression::function() {
  std::string name;
  while (is_letter(peek())) name += to_lower(text_[at_++]);
  if (name == "exists") {
    if (!take('[')) return fail(tr("'[' is expected"));
    std::size_t at = at_;
    const std::optional<Place> which = place(at);
    if (!which || !take(']')) return fail(tr("a parameter is expected in EXISTS[]"));
    if (which->name.starts_with('_') && !parameters_.get(which->name))
      return fail(
          trf("#<{}> is read, which the program has not set: it is the machine's", which->name));
    const bool is_there = which->name.empty() || parameters_.get(which->name).has_value();
    return is_there ? 1.0 : 0.0;
  }
  const std::optional<double> x = bracketed();
  if (!x) return std::nullopt;
  if (name == "atan") {
    if (!take('/')) return fail(tr("atan[]/[] is expected"));
    const std::optional<double> y = bracketed();
    return y ? std::optional(std::atan2(*x, *y) * kDegrees) : std::nullopt;
  }
  const std::optional<double> out = applied(name, *x);
  return out ? out : fail(trf("{}[] is no function", name));
}

std::optional<double> NcExpression::single() {
  const char first = peek();
  if (first == '[') return bracketed();
  if (first == '#') return parameter();
  if (is_letter(first)) return function();
  const std::size_t before = at_;
  if (first == '+' || first == '-') {
    ++at_;
    const char second = peek();
    if (second == '[' || second == '#' || is_letter(second)) {
      const std::optional<double> out = single();
      return out ? std::optional(first == '-' ? -*out : *out) : std::nullopt;
    }
    at_ = before;
  }
  return number();
}

std::optional<double> NcExpression::value(std::size_t& at) {
  at_ = at;
  const std::optional<double> out = single();
  if (out && !std::isfinite(*out)) return fail(tr("an expression without a value"));
  if (!out) return out;
  // Blanks behind it belong to what follows.
  while (at_ > at && is_line_blank(text_[at_ - 1])) --at_;
  at = at_;
  return out;
}

std::string exact_text(double value) {
  std::string text;
  for (int digits = 0; digits <= kMostDigits; ++digits) {
    text = fmt::format("{:.{}f}", value, digits);
    if (std::strtod(text.c_str(), nullptr) == value) break;
  }
  return text;
}

}  // namespace kerf
