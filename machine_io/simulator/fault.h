// machine_io/simulator/fault.h - faults on demand: which, and when.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "machine_io/simulator/state_board.h"

namespace kerf {

/// One --fault. It is on in [k * period_s, k * period_s + duration_s) for k = 1, 2, .. of the time
/// since the program was started: the first period is free of it. With a period of 0 it is on all
/// the time, from before the start.
struct FaultRule {
  FaultKind kind = FaultKind::kDrop;
  int value = 0;          ///< kDelay: ms, 1 to 60000; kException: its code, 1 to 11
  double period_s = 10;   ///< 0 to 1e6
  double duration_s = 1;  ///< above 0, less than the period
};

/// "drop", "drop:5", "drop:5:0.5", "delay:200", "delay:200:5:1", "exception:4:3:0.2": the kind, the
/// value of those that have one, the period and the duration in seconds. If only a period is given
/// that is not above 1 s, the duration is half of it. Error: what was found and what is allowed.
Result<FaultRule> parse_fault(std::string_view text);

/// "drop", "delay", ...
const char* to_string(FaultKind kind);

/// Whether the rule is on at a time since the start of the program (negative: before it).
bool is_active(const FaultRule& rule, double time_s);

/// Decides what goes out. The same times give the same faults: nothing in it is random. Of several
/// rules of a kind that are on at once, the longest delay and the last exception count.
class FaultInjector {
 public:
  explicit FaultInjector(std::vector<FaultRule> rules) : rules_(std::move(rules)) {}

  /// The state as the machine shows it at `time_s`. Freeze and jump are worked in here; the others
  /// are left to those that answer. Times must not go back.
  ServedState serve(const SimulatedState& state, double time_s);

 private:
  std::vector<FaultRule> rules_;
  std::optional<SimulatedState> frozen_;
};

}  // namespace kerf
