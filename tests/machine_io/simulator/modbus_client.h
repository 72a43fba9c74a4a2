// tests/machine_io/simulator/modbus_client.h - a Modbus client for tests, by libmodbus.
#pragma once

#include <modbus/modbus.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>

#include "machine_io/simulator/register_layout.h"

namespace kerf {

class ModbusClient {
 public:
  /// "127.0.0.1:41234", or "/dev/pts/5" as unit 1.
  explicit ModbusClient(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    if (address[0] == '/') {
      context_.reset(modbus_new_rtu(address.c_str(), 115200, 'N', 8, 1));
      modbus_set_slave(context_.get(), 1);
    } else {
      context_.reset(
          modbus_new_tcp(address.substr(0, colon).c_str(), std::stoi(address.substr(colon + 1))));
    }
    set_timeout_ms(2000);
    connected_ = modbus_connect(context_.get()) == 0;
  }
  ~ModbusClient() { modbus_close(context_.get()); }
  ModbusClient(const ModbusClient&) = delete;
  ModbusClient& operator=(const ModbusClient&) = delete;

  bool connected() const { return connected_; }
  modbus_t* context() const { return context_.get(); }
  void set_timeout_ms(std::uint32_t ms) {
    modbus_set_response_timeout(context_.get(), ms / 1000, ms % 1000 * 1000);
  }
  void reconnect() {
    modbus_close(context_.get());
    connected_ = modbus_connect(context_.get()) == 0;
  }
  /// All registers; 0, or the error number.
  int read() {
    errno = 0;
    const int got = modbus_read_registers(context_.get(), 0, static_cast<int>(registers.size()),
                                          registers.data());
    return got == static_cast<int>(registers.size()) ? 0 : errno;
  }
  std::int32_t integer(std::size_t at) const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(registers[at + 1]) << 16U |
                                     registers[at]);
  }
  double position(std::size_t axis) const { return integer(2 * axis) * 1e-3; }

  Registers registers{};

 private:
  struct Free {
    void operator()(modbus_t* context) const { modbus_free(context); }
  };
  std::unique_ptr<modbus_t, Free> context_;
  bool connected_ = false;
};

}  // namespace kerf
