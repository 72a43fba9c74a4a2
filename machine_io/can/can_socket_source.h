// machine_io/can/can_socket_source.h - live positions from a CAN bus by SocketCAN. Listens only.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "machine_io/can/can_map.h"
#include "machine_io/position_source.h"

namespace kerf {

struct CanSourceOptions {
  std::string interface = "can0";  ///< as `ip link` has it, 1 to 15 bytes
  CanMap map;
  /// Frames wait here while nobody reads; bytes, 4096 to 256 MiB. The kernel takes about 850 bytes
  /// a frame, and gives an ordinary user no more than net.core.rmem_max (208 KiB: 0.06 s of a full
  /// bus at 1 Mbit/s).
  int receive_buffer_bytes = 4 * 1024 * 1024;
  /// How long after a failure the interface is tried again: the first time, and at most. Doubled
  /// from one to the next; ms, 1 to 600 000.
  int retry_first_ms = 100;
  int retry_longest_ms = 5000;
};

/// All that is wrong, each a sentence beginning with the key ("interface: ...", "map.X.id: ...").
std::vector<std::string> validate(const CanSourceOptions& options);

/// Frames of one interface -> samples, by the map. Never transmits: the socket is bound and read,
/// and nothing here writes to it. (The controller still acknowledges frames, unless it was set up
/// `listen-only`; that and the bit rate are the user's, by `ip link`.)
///   - The kernel hands over only frames of mapped ids; CAN FD frames, too.
///   - `device_ns` is the kernel's stamp of a frame (CLOCK_REALTIME of this computer, at the
///     interrupt), `host_ns` when it was fetched: their distance is the time it waited.
///   - Counted: frames dropped by the full queue and by a full controller in `lost`; error frames,
///     failed reads and frames that do not fit the map in `errors`. `trouble` says the last of
///     them.
///   - Bus-off: kConnecting until a frame comes or the controller says it is restarted.
///   - Interface down: kConnecting; goes on when it is up. Absent or deleted: looked for again with
///     growing pauses. A kernel without CAN: kFailed.
/// No allocation per frame. Waits in poll(), reads up to 64 frames per call.
class CanSource final : public PositionSource {
 public:
  /// The options must be valid. Opens nothing yet.
  explicit CanSource(CanSourceOptions options);
  ~CanSource() override;
  CanSource(const CanSource&) = delete;
  CanSource& operator=(const CanSource&) = delete;

  Next next(AxisSample& sample, std::chrono::milliseconds patience) override;
  const SourceStatus& status() const override;
  std::string describe() const override;  ///< "can can0"

 private:
  class Reader;  // keeps linux/can.h out of here
  std::unique_ptr<Reader> reader_;
};

}  // namespace kerf
