// tests/machine_io/modbus/faulty_device.h - a Modbus device that knows the time and can misbehave.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "machine_io/modbus/modbus_settings.h"
#include "tests/machine_io/modbus/pseudo_terminal.h"

namespace kerf {

enum class Fault {
  kNone,
  kException1,  ///< 1..4: the exceptions of these numbers
  kException2,
  kException3,
  kException4,
  kSilent,
  kLate,       ///< every answer comes `late` after its question
  kGarbage,    ///< bytes that are no frame
  kHalfFrame,  ///< half of the answer
  kClose,      ///< TCP: closes instead of answering
  kWrongTransaction,
  kWrongProtocol,
  kWrongUnit,
  kWrongLength,    ///< TCP: the header's length is one too many
  kWrongFunction,  ///< function 4 for 3
  kWrongCount,     ///< two registers fewer, or more where there are not so many
  kNan,
  kInfinite,
  kHuge,
  kWrongOrder,  ///< words the other way round
  kStuck,       ///< values of the time when the fault began, and the counter too
  kTorn,        ///< two of three answers are of two cycles: Y is older, 17 is ahead of 16
  kTornAlways,  ///< all of them are
};

/// Holding registers, float64 abcd: 0 X, 4 Y, 8 Z; float32 abcd 12 A; uint16 14 tool, 15 line,
/// 16 counter (+1 at every question), 17 the same; 18..63 are 0, but 40..43 do not exist. X is the
/// seconds since `epoch()`, Y = 2 X + 1, Z = -X, A = 100 + (X mod 1): so that a reading tells how
/// old it is and whether it is all from one answer. Whatever is answered under a fault that
/// falsifies the address of the answer (transaction, unit, function ...) holds the positions of
/// "another machine": X = kElsewhere.
class FaultyDevice {
 public:
  static constexpr double kElsewhere = 77777;
  static constexpr int kUnit = 1;

  /// Serves TCP on a free port of 127.0.0.1. `start` may be called later again.
  static std::unique_ptr<FaultyDevice> tcp();
  /// Serves the master side of a pseudo-terminal.
  static std::unique_ptr<FaultyDevice> rtu();
  ~FaultyDevice();
  FaultyDevice(const FaultyDevice&) = delete;
  FaultyDevice& operator=(const FaultyDevice&) = delete;

  int port() const { return port_; }
  const std::string& device() const { return terminal_->device(); }

  void start();
  /// As kill -9 would: closes everything at once.
  void kill();
  void set(Fault fault) { fault_ = fault; }
  void set_late(std::chrono::milliseconds late) { late_ms_ = static_cast<int>(late.count()); }
  /// Refuses (exception 2), or does not answer, what asks for fewer registers.
  void refuse_below(int count, bool by_exception) {
    refused_below_ = count;
    refuses_by_exception_ = by_exception;
  }
  /// RTU: sends three bytes unasked, at once.
  void chatter();
  int questions() const { return questions_; }
  /// Of them those that were answered with registers.
  int good_answers() const { return good_answers_; }
  /// Function codes that were ever asked for, as bits.
  std::uint64_t functions() const { return functions_; }

  static std::chrono::steady_clock::time_point epoch();
  /// Seconds since epoch: what X would be now.
  static double now_s();

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Pending {
    std::chrono::steady_clock::time_point due;
    Bytes bytes;
  };

  explicit FaultyDevice(bool rtu);
  void listen_on(int port);
  void serve();
  void serve_line(int fd, bool& closed);
  void take_questions(bool& closed);
  Bytes answer(const Bytes& question, Fault fault);
  std::vector<std::uint16_t> registers(Fault fault);
  Bytes framed_tcp(const Bytes& question, const Bytes& pdu, Fault fault) const;
  Bytes framed_rtu(const Bytes& question, const Bytes& pdu, Fault fault) const;

  const bool rtu_;
  std::unique_ptr<PseudoTerminal> terminal_;
  int port_ = 0;
  int listener_ = -1;
  int client_ = -1;
  int stop_[2] = {-1, -1};
  std::thread thread_;
  Bytes in_;
  std::deque<Pending> out_;
  std::uint16_t counter_ = 0;
  double stuck_s_ = -1;

  std::atomic<Fault> fault_ = Fault::kNone;
  std::atomic<int> late_ms_ = 0;
  std::atomic<int> refused_below_ = 0;
  std::atomic<bool> refuses_by_exception_ = false;
  std::atomic<int> questions_ = 0;
  std::atomic<int> good_answers_ = 0;
  std::atomic<std::uint64_t> functions_ = 0;
};

/// How to read a FaultyDevice: X, Y, Z, A with limits that fit a machine, timeout_ms 100, 50 Hz.
ModbusSettings settings_for(const FaultyDevice& device, bool rtu);

}  // namespace kerf
