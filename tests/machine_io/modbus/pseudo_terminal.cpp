#include "tests/machine_io/modbus/pseudo_terminal.h"

#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>

namespace kerf {

PseudoTerminal::PseudoTerminal() {
  char name[128];
  termios raw{};
  cfmakeraw(&raw);
  if (openpty(&master_, &slave_, name, &raw, nullptr) != 0) std::abort();
  device_ = name;
}

PseudoTerminal::~PseudoTerminal() {
  close(master_);
  close(slave_);
}

SerialCable::SerialCable() {
  if (pipe(stop_) != 0) std::abort();
  thread_ = std::thread([this] { carry(); });
}

SerialCable::~SerialCable() {
  close(stop_[1]);
  thread_.join();
  close(stop_[0]);
}

void SerialCable::carry() {
  for (;;) {
    pollfd ends[] = {{a_.master(), POLLIN, 0}, {b_.master(), POLLIN, 0}, {stop_[0], 0, 0}};
    if (poll(ends, 3, -1) < 0 || ends[2].revents != 0) return;
    for (int i = 0; i < 2; ++i) {
      if ((ends[i].revents & POLLIN) == 0) continue;
      char bytes[256];
      const ssize_t got = read(ends[i].fd, bytes, sizeof bytes);
      if (got > 0 && write(ends[1 - i].fd, bytes, static_cast<std::size_t>(got)) != got) return;
    }
  }
}

}  // namespace kerf
