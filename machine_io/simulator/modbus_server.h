// machine_io/simulator/modbus_server.h - a Modbus device that answers with the simulated machine's
// state. Answers, never asks; takes nothing that would change it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "base/result.h"
#include "machine_io/simulator/state_board.h"

namespace kerf {

class ModbusEndpoint;

/// Any number of clients on TCP, any unit id.
struct ModbusTcpEnd {
  std::string host;  ///< number or name, IPv4 or IPv6: where it listens
  int port = 0;      ///< 0 to 65535; 0: a free one is chosen
};

/// Slave of a serial line that it makes itself (pty_line.h), 8N1.
struct ModbusRtuEnd {
  std::string link;   ///< symbolic link to the device; empty: none
  int baud = 115200;  ///< answers are held back by the time that a real line would take
  int unit = 1;       ///< 1 to 247; requests to others get no answer
};

/// A server with a thread of its own. Every answer is made of one moment's state (StateBoard).
/// Layout: register_layout.h. Faults of the state (drop, delay, garbage, exception, restart, nan)
/// are done here; several at once: restart before drop, drop before all others, a delay before
/// whatever is answered, garbage before an exception. While an answer is delayed, other clients
/// wait too.
class ModbusServer {
 public:
  /// Called from the server's thread when it can be reached again after a restart, with address().
  using Reopened = std::function<void(const std::string& address)>;

  /// Listens when it returns. `restarts`: look for the fault restart, 50 times a second; else the
  /// thread sleeps until somebody asks. Error: "listening on 192.168.1.7:502: Cannot assign
  /// requested address". The board must outlive the server.
  static Result<std::unique_ptr<ModbusServer>> open_tcp(const ModbusTcpEnd& end,
                                                        const StateBoard& board, bool restarts,
                                                        Reopened reopened = {});
  static Result<std::unique_ptr<ModbusServer>> open_rtu(const ModbusRtuEnd& end,
                                                        const StateBoard& board, bool restarts,
                                                        Reopened reopened = {});
  /// Ends the thread and closes everything.
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  /// As opened: "127.0.0.1:41234", "[::1]:502", "/dev/pts/5", "/dev/pts/5 link /tmp/ttyM".
  const std::string& address() const { return address_; }
  /// Requests that came, of any function.
  std::uint64_t asked() const { return asked_; }
  /// Requests by a function other than 3 and 4: somebody tried to write, or to ask for coils.
  std::uint64_t refused() const { return refused_; }

 private:
  struct Answering;  // registers and what else the thread uses again
  enum class Outcome : std::uint8_t { kDone, kFailed, kStop };

  static Result<std::unique_ptr<ModbusServer>> open(std::unique_ptr<ModbusEndpoint> endpoint,
                                                    const StateBoard& board, bool restarts,
                                                    Reopened reopened);
  ModbusServer(std::unique_ptr<ModbusEndpoint> endpoint, const StateBoard& board, bool restarts,
               Reopened reopened);
  void run();
  void follow_restarts();
  bool take_request(int fd);
  Outcome answer(int fd, const std::uint8_t* query, int length);
  int send_garbage(int fd, int bytes);
  bool pause(double seconds) const;

  std::unique_ptr<ModbusEndpoint> endpoint_;
  const StateBoard& board_;
  bool restarts_;
  Reopened reopened_;
  std::string address_;
  std::unique_ptr<Answering> answering_;
  std::atomic<std::uint64_t> asked_ = 0;
  std::atomic<std::uint64_t> refused_ = 0;
  std::uint32_t noise_ = 1;  ///< of the fault garbage: the same bytes each time
  int stop_fd_ = -1;
  std::thread thread_;
};

}  // namespace kerf
