// Polls the registers of a ClassicLadder until SIGTERM, inside a LinuxCNC's namespaces, for
// classicladder_live_test.
// register_probe PORT RATE_HZ OUT: one line a poll, registers 0 to 15; before the first poll of
// each connection a line "connected". An answer whose two scan counters differ is not written:
// a line "refused" is, and it is asked for again at once.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <modbus.h>
#include <signal.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <thread>

namespace {

volatile sig_atomic_t is_ending = 0;
void on_signal(int /*number*/) { is_ending = 1; }

constexpr int kRegisters = 16;
constexpr std::size_t kScan = 8;
constexpr std::size_t kScanBegun = 15;
constexpr int kAttempts = 5;

using Registers = std::array<std::uint16_t, kRegisters>;

/// False if the connection is of no use any more.
bool poll(modbus_t* device, Registers& registers, std::FILE* out) {
  for (int i = 0; i < kAttempts; ++i) {
    if (modbus_read_registers(device, 0, kRegisters, registers.data()) != kRegisters) return false;
    if (registers[kScan] == registers[kScanBegun]) {
      fmt::print(out, "{}\n", fmt::join(registers, " "));
      break;
    }
    fmt::print(out, "refused\n");
  }
  return true;
}

int number_of(const char* text) {
  int value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const int rate_hz = number_of(argv[2]);
  if (rate_hz < 1) return 2;
  signal(SIGTERM, on_signal);
  modbus_t* device = modbus_new_tcp("127.0.0.1", number_of(argv[1]));
  if (device == nullptr) return 2;

  std::FILE* const out = std::fopen(argv[3], "w");
  if (out == nullptr) return 2;
  // The session waits for polls by counting lines.
  std::setvbuf(out, nullptr, _IOLBF, BUFSIZ);
  Registers registers{};
  bool is_connected = false;
  auto due = std::chrono::steady_clock::now();
  while (is_ending == 0) {
    due += std::chrono::microseconds(1'000'000 / rate_hz);
    std::this_thread::sleep_until(due);
    if (!is_connected) {
      is_connected = modbus_connect(device) == 0;
      if (!is_connected) continue;
      fmt::print(out, "connected\n");
    }
    is_connected = poll(device, registers, out);
    if (!is_connected) modbus_close(device);
  }
  if (is_connected) modbus_close(device);
  modbus_free(device);
  return std::fclose(out) == 0 ? 0 : 1;
}
