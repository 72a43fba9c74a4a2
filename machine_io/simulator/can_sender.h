// machine_io/simulator/can_sender.h - the simulated machine's drives on a CAN bus: one position
// frame an axis and update. Sends, never reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "base/result.h"
#include "machine_io/simulator/state_board.h"

namespace kerf {

/// How positions lie in the frames. X to C are nodes 1 to 6 of CiA 402, and 0 to 5 of ODrive.
enum class CanLayout : std::uint8_t {
  kCia402,  ///< TPDO3: id 0x380 + node; u16 status word 6041, i32 position 6064 in 0.001 mm (deg)
  kOdrive,  ///< Get_Encoder_Estimates: id node << 5 | 9; f32 turns, f32 turns/s
};

/// What one turn of an ODrive motor moves: a 5 mm screw; A, B, C directly.
inline constexpr double kOdriveTurn_mm = 5;
inline constexpr double kOdriveTurn_deg = 360;

/// Sent with either layout, little endian. kCanStatusId: u16 tool, u32 program line, u16 scan
/// counter; kCanSpindleId: i16 rpm, i32 tool offset Z in 0.001 mm, i16 spindle load in 0.01.
inline constexpr std::uint32_t kCanStatusId = 0x6f0;
inline constexpr std::uint32_t kCanSpindleId = 0x6f1;

/// A frame with an 11-bit id.
struct SentCanFrame {
  std::uint32_t id = 0;
  std::size_t size = 0;  ///< bytes of data
  std::array<std::uint8_t, 8> data{};
};

/// Makes the frames of one update after the other.
class CanEncoder {
 public:
  /// The most frames of an update: position and boot-up of each axis, status, spindle.
  static constexpr std::size_t kMaxFrames = 2 * kSimulatedAxes + 2;

  explicit CanEncoder(CanLayout layout) : layout_(layout) {}

  /// The frames of this update into `frames`; their number. `since_last_s`: time since the update
  /// before, for speeds (0: the speed is 0). Faults: drop and restart give none, and when a restart
  /// is over CiA 402 nodes say so (boot-up, id 0x700 + node); garbage gives random bytes under the
  /// right ids; nan the float, or the lowest integer.
  std::size_t encode(const ServedState& served, double since_last_s,
                     std::array<SentCanFrame, kMaxFrames>& frames);

 private:
  SentCanFrame position_frame(std::size_t axis, double position, double speed) const;

  CanLayout layout_;
  std::array<double, kSimulatedAxes> before_{};
  bool gone_ = false;
  std::uint32_t noise_ = 1;
};

/// The encoder on a SocketCAN interface. Never waits: what the interface does not take is counted.
class CanSender {
 public:
  /// Error: "opening vcan0: No such device".
  static Result<std::unique_ptr<CanSender>> open(const std::string& interface, CanLayout layout);
  ~CanSender();
  CanSender(const CanSender&) = delete;
  CanSender& operator=(const CanSender&) = delete;

  void send(const ServedState& served, double since_last_s);

  std::uint64_t sent() const { return sent_; }
  std::uint64_t not_sent() const { return not_sent_; }  ///< queue full, interface down
  /// The last reason for the latter; empty if there was none.
  std::string trouble() const;

 private:
  CanSender(int fd, CanLayout layout) : fd_(fd), encoder_(layout) {}

  int fd_;
  CanEncoder encoder_;
  std::array<SentCanFrame, CanEncoder::kMaxFrames> frames_{};
  std::uint64_t sent_ = 0;
  std::uint64_t not_sent_ = 0;
  int last_error_ = 0;
};

}  // namespace kerf
