#include "twin/machine/turret.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kFirstUserCode = 100, kLastUserCode = 199;

/// "m120" to 120.
std::optional<int> user_code_in(std::string_view text) {
  if (text.size() != 4 || text[0] != 'm') return std::nullopt;
  int number = 0;
  for (const char c : text.substr(1)) {
    if (c < '0' || c > '9') return std::nullopt;
    number = number * 10 + (c - '0');
  }
  const bool known = number >= kFirstUserCode && number <= kLastUserCode;
  return known ? std::optional(number) : std::nullopt;
}

}  // namespace

Result<PunchTrigger> PunchTrigger::parse(std::string_view text) {
  const std::string word = to_lower(trim(text));
  PunchTrigger trigger;
  if (word == "g81") {
    trigger.kind_ = Kind::kPlunge;
    return trigger;
  }
  if (const std::optional<int> code = user_code_in(word)) {
    trigger.kind_ = Kind::kUserCode;
    trigger.user_code_ = *code;
    return trigger;
  }
  Result<BeamTrigger> state = BeamTrigger::parse(word);
  if (!state) {
    return Error{trf(
        "'{}' is no trigger; must be g81, m100 to m199, or conditions joined by +: m3, m3:0 to "
        "m3:7, m4, m7, m8, m62:0 to m62:63 (M64 counts too), m67:0 to m67:3, s, feed, z<LEVEL in "
        "mm, inverted by !",
        shown(text))};
  }
  trigger.state_ = std::move(*state);
  return trigger;
}

double PunchTimes::period_s(double pitch_mm) const {
  if (period_by_pitch_s.empty()) return 0;
  const auto above = period_by_pitch_s.lower_bound(pitch_mm);
  if (above == period_by_pitch_s.begin()) return above->second;
  const auto below = std::prev(above);
  if (above == period_by_pitch_s.end()) return below->second;
  const double share = (pitch_mm - below->first) / (above->first - below->first);
  return below->second + share * (above->second - below->second);
}

double PunchTimes::change_s(int from, int to) const {
  if (from == to) return 0;
  int steps = from > 0 ? std::abs(to - from) : 0;
  if (places > 0) steps = std::min(steps, places - steps);
  return lock_s + steps * step_s;
}

std::vector<int> Turret::user_codes() const {
  std::vector<int> codes;
  if (trigger.kind() == PunchTrigger::Kind::kUserCode) codes.push_back(trigger.user_code());
  for (const Regrip& regrip : regrips) {
    if (regrip.user_code != 0) codes.push_back(regrip.user_code);
  }
  return codes;
}

}  // namespace kerf
