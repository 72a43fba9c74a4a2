// machine_io/simulator/modbus_endpoint.h - what a Modbus server listens on, and how its clients are
// found there. For modbus_server.cpp alone.
#pragma once

#include <modbus/modbus.h>
#include <poll.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "machine_io/simulator/modbus_server.h"
#include "machine_io/simulator/pty_line.h"

namespace kerf {

/// One thread uses it. Opened and closed as often as the machine restarts; the address stays, as
/// far as the system lets it (a TCP port does, the number of a pty may not).
class ModbusEndpoint {
 public:
  virtual ~ModbusEndpoint() = default;
  virtual Done open() = 0;
  virtual void close() = 0;
  bool is_open() const { return !fds_.empty(); }
  virtual std::string address() const = 0;

  /// What to wait for.
  const std::vector<pollfd>& fds() const { return fds_; }
  /// Takes up a new client if `fd` is where they come in; else false: a request is waiting.
  virtual bool accept_client(int fd) = 0;
  /// The request, or the client, was not in order: nothing is read from it that belongs to another
  /// request. A client on TCP is hung up on.
  virtual void recover(int fd) = 0;
  /// The request was for another unit.
  virtual void passed_over() = 0;
  /// How long so many bytes are on the way.
  virtual double line_seconds(int bytes) const = 0;
  /// Bytes around function and data of a frame: unit, check sum, TCP head.
  virtual int envelope_bytes() const = 0;
  modbus_t* context() const { return context_.get(); }

 protected:
  struct Free {
    void operator()(modbus_t* context) const { modbus_free(context); }
  };
  std::unique_ptr<modbus_t, Free> context_;
  std::vector<pollfd> fds_;
};

class ModbusTcpEndpoint final : public ModbusEndpoint {
 public:
  explicit ModbusTcpEndpoint(ModbusTcpEnd end) : end_(std::move(end)) {}
  ~ModbusTcpEndpoint() override { close(); }
  Done open() override;
  void close() override;
  std::string address() const override { return address_; }
  bool accept_client(int fd) override;
  void recover(int fd) override;
  void passed_over() override {}
  double line_seconds(int) const override { return 0; }
  int envelope_bytes() const override { return 7; }

 private:
  ModbusTcpEnd end_;
  std::string address_;
};

class ModbusRtuEndpoint final : public ModbusEndpoint {
 public:
  explicit ModbusRtuEndpoint(ModbusRtuEnd end) : end_(std::move(end)) {}
  Done open() override;
  void close() override;
  std::string address() const override;
  bool accept_client(int) override { return false; }
  void recover(int fd) override;
  /// libmodbus would take the next frame for the other unit's answer: on this line nobody else is.
  void passed_over() override { make_context(); }
  double line_seconds(int bytes) const override;
  int envelope_bytes() const override { return 3; }

 private:
  void make_context();

  ModbusRtuEnd end_;
  std::optional<PtyLine> line_;
};

}  // namespace kerf
