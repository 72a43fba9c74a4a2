// tests/machine_io/modbus/pseudo_terminal.h - serial lines without hardware.
#pragma once

#include <string>
#include <thread>

namespace kerf {

/// One pseudo-terminal in raw mode. The slave side stays open here too, so that the line does not
/// hang up between two users of it.
class PseudoTerminal {
 public:
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  int master() const { return master_; }
  const std::string& device() const { return device_; }

 private:
  int master_ = -1;
  int slave_ = -1;
  std::string device_;
};

/// Two pseudo-terminals and a thread that carries bytes between them: a null-modem cable.
class SerialCable {
 public:
  SerialCable();
  ~SerialCable();
  SerialCable(const SerialCable&) = delete;
  SerialCable& operator=(const SerialCable&) = delete;

  const std::string& end_a() const { return a_.device(); }
  const std::string& end_b() const { return b_.device(); }

 private:
  void carry();

  PseudoTerminal a_;
  PseudoTerminal b_;
  int stop_[2] = {-1, -1};
  std::thread thread_;
};

}  // namespace kerf
