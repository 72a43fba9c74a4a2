#include "machine_io/simulator/fault.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::array<const char*, kFaultKinds> kNames = {"drop",    "delay", "garbage", "exception",
                                                         "restart", "nan",   "freeze",  "jump"};
constexpr double kMaxPeriod_s = 1e6;
constexpr int kMaxDelay_ms = 60000;
constexpr int kMaxException = 11;  // of the Modbus specification

/// A time on the edge of a window is in or out by the rule's own numbers, not by rounding.
constexpr double kEdge_s = 1e-9;

std::optional<FaultKind> kind_of(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<FaultKind>(i);
  }
  return {};
}

Error fault_error(std::string_view text, std::string reason) {
  return Error{fmt::format("'{}': {}", text, reason)};
}

/// The value that a kind needs; empty text: fine.
std::string read_value(const std::vector<std::string_view>& parts, int most, const char* meaning,
                       int& value) {
  if (parts.size() > 1 && read_number(parts[1], value) && value >= 1 && value <= most) return "";
  return trf("{} needs {}: a whole number from 1 to {}, as in {}:{}", parts[0], meaning, most,
             parts[0], most == kMaxDelay_ms ? 200 : 4);
}

}  // namespace

const char* to_string(FaultKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

Result<FaultRule> parse_fault(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  const auto kind = kind_of(parts[0]);
  if (!kind) {
    return Error{trf("'{}' is no fault; allowed: {}", parts[0], fmt::join(kNames, ", "))};
  }
  FaultRule rule;
  rule.kind = *kind;
  std::size_t next = 1;
  if (*kind == FaultKind::kDelay || *kind == FaultKind::kException) {
    const bool delay = *kind == FaultKind::kDelay;
    const std::string wrong = read_value(parts, delay ? kMaxDelay_ms : kMaxException,
                                         delay ? "ms" : tr("a code"), rule.value);
    if (!wrong.empty()) return fault_error(text, wrong);
    next = 2;
  }
  if (parts.size() > next + 2) return fault_error(text, tr("too many parts; KIND:period:duration"));
  if (parts.size() > next) {
    if (!read_number(parts[next], rule.period_s) || !(rule.period_s >= 0) ||
        rule.period_s > kMaxPeriod_s) {
      return fault_error(text, trf("the period '{}' is not allowed; must be at least 0 (0: "
                                   "always) and at most {:g} (s)",
                                   parts[next], kMaxPeriod_s));
    }
    if (rule.period_s > 0 && rule.period_s <= rule.duration_s) rule.duration_s = rule.period_s / 2;
  }
  if (parts.size() > next + 1) {
    if (rule.period_s == 0) return fault_error(text, tr("with a period of 0 there is no duration"));
    if (!read_number(parts[next + 1], rule.duration_s) || !(rule.duration_s > 0) ||
        !(rule.duration_s < rule.period_s)) {
      return fault_error(text, trf("the duration '{}' is not allowed; must be above 0 and "
                                   "less than the period (s)",
                                   parts[next + 1]));
    }
  }
  return rule;
}

bool is_active(const FaultRule& rule, double time_s) {
  if (rule.period_s == 0) return true;
  const double round = std::floor((time_s + kEdge_s) / rule.period_s);
  return round >= 1 && time_s + kEdge_s - round * rule.period_s < rule.duration_s;
}

ServedState FaultInjector::serve(const SimulatedState& state, double time_s) {
  ServedState served;
  served.state = state;
  for (const FaultRule& rule : rules_) {
    if (!is_active(rule, time_s)) continue;
    served.faults.add(rule.kind);
    if (rule.kind == FaultKind::kDelay) {
      served.faults.delay_ms = std::max(served.faults.delay_ms, rule.value);
    }
    if (rule.kind == FaultKind::kException) served.faults.exception_code = rule.value;
  }
  if (!served.faults.has(FaultKind::kFreeze)) {
    frozen_.reset();
  } else {
    if (!frozen_) frozen_ = state;
    served.state = *frozen_;
  }
  if (served.faults.has(FaultKind::kJump)) {
    for (std::size_t i = 0; i < 3; ++i) served.state.position[i] += kJump_mm;
  }
  return served;
}

}  // namespace kerf
