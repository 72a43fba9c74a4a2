#include "interp_bridge/beam_trigger.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

using Kind = BeamTrigger::Kind;
using Term = BeamTrigger::Term;

struct Word {
  std::string_view text;
  Kind kind;
  int indices;  ///< how many ":N" may name; 0: it has none
  bool index_needed;
};
constexpr std::array<Word, 10> kWords = {{
    {"m3", Kind::kSpindle, 8, false},
    {"m4", Kind::kCounterclockwise, 0, false},
    {"s", Kind::kSpeed, 0, false},
    {"m7", Kind::kMist, 0, false},
    {"m8", Kind::kFlood, 0, false},
    {"m62", Kind::kOutput, static_cast<int>(TorchState::kOutputs), true},
    {"m64", Kind::kOutput, static_cast<int>(TorchState::kOutputs), true},
    {"m67", Kind::kAnalog, static_cast<int>(TorchState::kAnalogs), true},
    {"m68", Kind::kAnalog, static_cast<int>(TorchState::kAnalogs), true},
    {"feed", Kind::kFeed, 0, false},
}};

struct Name {
  std::string_view name;
  std::string_view meaning;
};
constexpr std::array<Name, 2> kNames = {{{"plasmac", "m3:0+!m62:3"}, {"laser", "m3+s+feed"}}};

constexpr const char* kAllowed = tr_noop(
    "allowed are m3, m3:0 to m3:7, m4, m7, m8, m62:0 to m62:63, m67:0 to m67:3, s, feed and "
    "z<LEVEL in mm, joined by + and inverted by !; or plasmac, laser");

/// "12" below `count`.
std::optional<int> index_of(std::string_view digits, int count) {
  if (digits.empty() || digits.size() > 2) return std::nullopt;
  int value = 0;
  for (const char c : digits) {
    if (!is_digit(c)) return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value < count ? std::optional(value) : std::nullopt;
}

std::optional<Term> term_of(std::string_view text) {
  Term term;
  term.inverted = !text.empty() && text.front() == '!';
  if (term.inverted) text.remove_prefix(1);
  if (text.substr(0, 2) == "z<") {
    constexpr std::size_t kLongestNumber = 40;
    constexpr double kFarthest_mm = 1e6;
    const std::string digits(text.substr(2, kLongestNumber));
    char* end = nullptr;
    term.kind = Kind::kBelow;
    term.level_mm = std::strtod(digits.c_str(), &end);
    const bool fits = !digits.empty() && end == digits.c_str() + text.size() - 2;
    return fits && std::abs(term.level_mm) <= kFarthest_mm ? std::optional(term) : std::nullopt;
  }
  const std::size_t colon = text.find(':');
  const auto word = std::find_if(kWords.begin(), kWords.end(), [&](const Word& known) {
    return known.text == text.substr(0, colon);
  });
  if (word == kWords.end()) return std::nullopt;
  term.kind = word->kind;
  if (colon == text.npos) return word->index_needed ? std::nullopt : std::optional(term);
  const std::optional<int> index = index_of(text.substr(colon + 1), word->indices);
  if (!index) return std::nullopt;
  term.index = *index;
  return term;
}

bool holds(const Term& term, const Motion& motion) {
  const TorchState& torch = motion.torch;
  switch (term.kind) {
    case Kind::kSpindle:
      return term.index == BeamTrigger::kAny ? torch.spindles_on != 0
                                             : (torch.spindles_on >> term.index & 1) != 0;
    case Kind::kCounterclockwise:
      return motion.spindle == SpindleState::kCounterclockwise;
    case Kind::kSpeed:
      return motion.spindle_rpm > 0;
    case Kind::kMist:
      return motion.mist;
    case Kind::kFlood:
      return motion.flood;
    case Kind::kOutput:
      return torch.output(static_cast<unsigned>(term.index));
    case Kind::kAnalog:
      return torch.analog[static_cast<std::size_t>(term.index)] > 0;
    case Kind::kFeed:
      return motion.kind != MotionKind::kTraverse;
    case Kind::kBelow:
      return std::max(motion.from_mm.z, motion.to_mm.z) <= term.level_mm;
  }
  return false;
}

}  // namespace

Result<BeamTrigger> BeamTrigger::parse(std::string_view text) {
  constexpr std::size_t kLongest = 200;
  constexpr std::size_t kShown = 60;
  const auto refuse = [&](std::string_view part) {
    return Error{trf(
        "beam trigger '{}': {}; {}", text.substr(0, kShown),
        part.empty() ? tr("a condition is missing") : trf("'{}' is none", part.substr(0, kShown)),
        tr(kAllowed))};
  };
  std::string bare;
  for (const char c : text.substr(0, kLongest + 1)) {
    if (is_blank(c)) continue;
    bare += to_lower(c);
  }
  if (bare.size() > kLongest) return refuse(bare);
  for (const Name& known : kNames) {
    if (bare == known.name) bare = std::string(known.meaning);
  }
  BeamTrigger trigger;
  trigger.terms_.clear();
  std::string_view left = bare;
  for (bool more = true; more;) {
    const std::size_t plus = left.find('+');
    const std::string_view part = left.substr(0, plus);
    const std::optional<Term> term = term_of(part);
    if (!term || trigger.terms_.size() == kMaxTerms) return refuse(part);
    trigger.terms_.push_back(*term);
    more = plus != left.npos;
    if (more) left.remove_prefix(plus + 1);
  }
  return trigger;
}

bool BeamTrigger::on(const Motion& motion) const {
  return std::all_of(terms_.begin(), terms_.end(),
                     [&](const Term& term) { return holds(term, motion) != term.inverted; });
}

}  // namespace kerf
