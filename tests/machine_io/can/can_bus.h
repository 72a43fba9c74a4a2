// tests/machine_io/can/can_bus.h - for tests on a real CAN interface: other programs, and a sender.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "machine_io/can/can_signal.h"

namespace kerf {

inline constexpr const char* kBusName = "vcan0";

/// True if this computer has the interface vcan0, up. If not, tests on it are skipped.
bool has_bus();

/// True if there is such a program.
bool has_program(const std::string& name);

/// A started program; stopped when it goes out of scope.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, const std::string& output = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  int wait();  ///< until it ends; its status
  void stop();

 private:
  int pid_ = -1;
  int status_ = -1;
};

/// Runs a program to its end; true if it ended with 0.
bool run_program(const std::vector<std::string>& arguments);

/// A node that speaks, and one that hears all.
class BusNode {
 public:
  explicit BusNode(const std::string& interface = kBusName);
  ~BusNode();
  BusNode(const BusNode&) = delete;
  BusNode& operator=(const BusNode&) = delete;

  bool is_open() const { return socket_ >= 0; }
  /// False if the kernel does not take it.
  bool send(const CanFrame& frame);
  /// How many frames have come since it was asked last, its own aside.
  int heard();

 private:
  int socket_ = -1;
};

}  // namespace kerf
