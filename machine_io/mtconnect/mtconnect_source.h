// machine_io/mtconnect/mtconnect_source.h - positions that an MTConnect agent tells.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "machine_io/mtconnect/device_model.h"
#include "machine_io/mtconnect/mtconnect_settings.h"
#include "machine_io/position_source.h"

namespace kerf {

/// What an agent's /probe says of the machine that the settings name.
struct AgentMachine {
  DeviceModel device;
  ItemPlan plan;
};
/// Asks once, and waits 2 s at most. Error: as a source would have it in its trouble.
Result<AgentMachine> ask_machine(const MtconnectSettings& settings);

/// Asks an agent: /probe for what the machine has, /current for how it stands, and /sample for all
/// that changes from then on; by HTTP GET alone. An agent that can streams its answers (one
/// connection, a part for each news, a sign of life every heartbeat_ms); one that cannot, as
/// LinuxCNC's, is asked every interval_ms. The connection is brought back by itself. Starts no
/// thread.
///
/// A sample is what was stamped at one time (gather_ms). What has not been told again holds: where
/// nothing is new for heartbeat_ms, a sample says so, as of the time that the agent wrote its
/// answer less what the machine needs from news to news. `host_ns` is when it was so, by what is
/// known of the agent's clock (StampClock): what was held up on its way is that much older.
///
///   nobody there        tried again after 100 ms, doubling up to 5 s
///   silence             a stream without a part for five heartbeats (2 s at least), an answer that
///                       is not whole after 2 s: closed and connected anew
///   no XML, too long    likewise
///   no such device, two that could be meant, no positions of that kind: kFailed; the trouble names
///                       the key that helps
///   UNAVAILABLE         of X, Y, Z or of the machine: no samples, until there are positions again.
///                       Of others: not known
///   OUT_OF_RANGE, a hole in the sequence numbers: what is missing is counted as lost
///   another instanceId, sequence numbers that begin anew: the agent has begun anew; its model is
///                       read again, and what was between is lost
///   stamps of another clock than the agent's: told once; ages are then by when positions come
///
/// A controller that has ended behind an agent that goes on telling its last values looks like a
/// machine that stands: only the agent can tell.
class MtconnectSource final : public PositionSource {
 public:
  /// `settings` must be free of faults: validate(). Connects at the first next().
  explicit MtconnectSource(MtconnectSettings settings);
  ~MtconnectSource() override;
  MtconnectSource(const MtconnectSource&) = delete;
  MtconnectSource& operator=(const MtconnectSource&) = delete;

  /// May overrun `patience` by the 2 s of an answer to /probe and /current.
  Next next(AxisSample& sample, std::chrono::milliseconds patience) override;
  const SourceStatus& status() const override;
  std::string describe() const override;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace kerf
