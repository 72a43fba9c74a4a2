// machine_io/modbus/modbus_link.h - one connection to one device, over TCP or a serial line.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "machine_io/modbus/modbus_settings.h"
#include "machine_io/modbus/poll_plan.h"
#include "machine_io/modbus/poll_schedule.h"

struct _modbus;

namespace kerf {

/// What both kinds of line have in common: libmodbus' context. Every fault is one text in
/// trouble().
class ModbusLink {
 public:
  enum class Answer : std::uint8_t {
    kWords,      ///< what was asked for
    kException,  ///< the device refused, properly: exception_code(); the line is in order
    kBroken,     ///< anything else. The link is closed, or (RTU) must settle before it can be used
  };
  enum class Settling : std::uint8_t {
    kSettled,  ///< answers can be trusted
    kWaiting,  ///< not yet; ask again
    kBroken,   ///< the line is gone: closed
  };

  virtual ~ModbusLink();
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;

  /// May take timeout_ms, for TCP the look-up of the name before it.
  bool open();
  void close();
  bool is_open() const { return open_; }

  /// Asks for the registers of `read` and waits for the answer, timeout_ms at most.
  virtual Answer read(const PollRead& read, std::uint16_t* words) = 0;
  /// Brings answers and questions into step after open() and after kBroken, working until
  /// `deadline`. A trial read may overrun it by timeout_ms. Always settled for TCP.
  virtual Settling settle(SteadyClock::time_point deadline) = 0;

  /// Reads of settle() that failed since the last call.
  std::uint64_t take_failures() { return std::exchange(failures_, 0); }
  const std::string& trouble() const { return trouble_; }
  int exception_code() const { return exception_code_; }

 protected:
  explicit ModbusLink(const ModbusSettings& settings) : settings_(settings) {}
  /// A new libmodbus context, or nullptr.
  virtual _modbus* create() const = 0;
  virtual void opened() = 0;
  /// "127.0.0.1:502" or "/dev/ttyUSB0".
  virtual std::string place() const = 0;

  _modbus* context() const { return context_; }
  int descriptor() const;
  /// Notes the fault as "holding 0..17: WHAT".
  void note(const PollRead& read, const std::string& what);
  void note(const std::string& what) { trouble_ = what; }
  /// Notes what libmodbus left in errno.
  void note_errno(const PollRead& read, int error);
  Answer refused(const PollRead& read, int code);
  void count_failure() { ++failures_; }

  const ModbusSettings settings_;

 private:
  _modbus* context_ = nullptr;
  bool open_ = false;
  int exception_code_ = 0;
  std::uint64_t failures_ = 0;
  std::string trouble_;
};

std::unique_ptr<ModbusLink> make_tcp_link(const ModbusSettings& settings);
std::unique_ptr<ModbusLink> make_rtu_link(const ModbusSettings& settings);

}  // namespace kerf
