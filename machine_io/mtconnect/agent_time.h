// machine_io/mtconnect/agent_time.h - the times that an agent writes, and how old what it tells is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf {

/// A moment on the clock of who wrote it.
struct AgentTime {
  std::int64_t ns = 0;             ///< since 1970, UTC
  std::int64_t resolution_ns = 1;  ///< the last digit that was written: it is up to so much later
};

/// "2026-08-22T13:21:27.123Z", with another zone ("+02:00"), or none (UTC, as the standard wants);
/// what follows an '@' (the time that a sample is of) is passed over. Nothing: it is no such time.
std::optional<AgentTime> parse_agent_time(std::string_view text);

/// How old observations are, by what is known of the agent's clock. Times of this computer are
/// CLOCK_MONOTONIC's, so nobody can set them.
///
/// The agent's clock is read at each answer: it was written after the question was sent and before
/// it was here. Where the quickest observations are 0 to kMostUsual_ns old by it, it is the clock
/// of the stamps as well, and an age is by it. Else the stamps are another clock's (an adapter's on
/// another computer): then an age is how much later it came than the quickest, and trouble() says
/// by how much the clocks differ.
class StampClock {
 public:
  static constexpr std::int64_t kMostUsual_ns = 2'000'000'000;

  /// An answer that the agent wrote at `created`; `asked_ns`: when it was asked for, nothing of a
  /// stream, which was asked for long before.
  void heard(std::optional<std::int64_t> asked_ns, std::int64_t received_ns, AgentTime created);
  /// What is new of this stamp came at `received_ns`.
  void observed(std::int64_t stamp_ns, std::int64_t received_ns);
  /// Of what was so at `stamp_ns`, at the moment `received_ns`; 0 or more.
  std::int64_t age_ns(std::int64_t stamp_ns, std::int64_t received_ns) const;
  /// The same by the agent's own clock (of the moment that an answer was written).
  std::int64_t answer_age_ns(std::int64_t created_ns, std::int64_t received_ns) const;
  /// By how much the stamps' clock is behind the agent's, s; nothing: they go together.
  std::optional<double> behind_s() const;
  /// This computer's clock less the agent's: half of the range in which it must lie, ns.
  std::int64_t doubt_ns() const { return known_ ? (most_ns_ - least_ns_) / 2 : 0; }

 private:
  std::int64_t offset_ns() const { return least_ns_ + (most_ns_ - least_ns_) / 2; }

  bool known_ = false;
  std::int64_t least_ns_ = 0, most_ns_ = 0;  ///< this clock less the agent's lies between these
  std::int64_t heard_ns_ = 0;
  std::optional<std::int64_t> quickest_ns_;  ///< received less stamp, the least of late
  std::int64_t observed_ns_ = 0;
};

}  // namespace kerf
