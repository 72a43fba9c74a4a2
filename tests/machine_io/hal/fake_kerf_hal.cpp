// Stands for kerf-hal: writes records as FAKE_KERF_HAL_MODE says. Each start adds one byte to the
// file FAKE_KERF_HAL_STARTS, so that a mode can differ from start to start.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <thread>

#include "machine_io/hal/hal_stream.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

/// Record number n of a machine with three joints whose positions tell n.
HalSampleRecord record_number(std::uint64_t n) {
  HalSampleRecord record;
  record.bytes = sizeof(record);
  record.sequence = n;
  const auto step = static_cast<std::int64_t>(n);
  record.realtime_ns = 1'700'000'000'000'000'000 + step * 1'000'000;
  record.monotonic_ns = 5'000'000'000 + step * 1'000'000;
  record.joint.fill(kHalAbsent);
  for (std::size_t i = 0; i < 3; ++i) {
    record.joint[i] = static_cast<double>(n) + static_cast<double>(i) / 8.0;
  }
  record.axis_offset.fill(kHalAbsent);
  record.tool_offset.fill(0.0);
  record.tool_offset[2] = 35.0;
  record.spindle_rpm = -1200.0;
  record.velocity = 50.0;
  record.program_line = 12;
  record.tool_number = 3;
  record.joint_count = 3;
  record.known = kHalPinsTaken | kHalToolNumber | kHalProgramLine | kHalInPosition;
  return record;
}

void put(const void* bytes, std::size_t count) {
  const ssize_t written = write(STDOUT_FILENO, bytes, count);
  if (written != static_cast<ssize_t>(count)) std::_Exit(kHalExitAsked);
}

void put(const HalSampleRecord& record) { put(&record, sizeof(record)); }

void put_first_three() {
  for (std::uint64_t n = 0; n < 3; ++n) put(record_number(n));
}

void pause_for(milliseconds time) { std::this_thread::sleep_for(time); }

[[noreturn]] void be_good(milliseconds between) {
  for (std::uint64_t n = 0;; ++n) {
    put(record_number(n));
    pause_for(between);
  }
}

[[noreturn]] void stay() {
  while (true) pause();
}

/// Each record in pieces, so that none comes whole.
[[noreturn]] void be_slow() {
  for (std::uint64_t n = 0;; ++n) {
    const HalSampleRecord record = record_number(n);
    char bytes[sizeof(record)];
    std::memcpy(bytes, &record, sizeof(record));
    for (std::size_t at = 0; at < sizeof(record); at += 96) {
      put(bytes + at, std::min<std::size_t>(96, sizeof(record) - at));
      pause_for(milliseconds(1));
    }
  }
}

/// What came in by stdin goes out in a sample.
[[noreturn]] void echo_status() {
  HalStatusRecord status;
  for (std::uint64_t n = 0;; ++n) {
    put(record_number(n));
    if (read(STDIN_FILENO, &status, sizeof(status)) != sizeof(status)) std::_Exit(kHalExitTrouble);
    HalSampleRecord record = record_number(++n);
    record.joint[0] = status.collision_seconds;
    record.joint[1] = status.off_path_mm;
    record.joint[2] = status.collision_ahead * 100 + status.off_path * 10 + status.stale;
    record.program_line = !head_fault(status) ? status.finding_line : -1;
    put(record);
  }
}

int end_saying(const std::string& text, int status) {
  std::fprintf(stderr, "kerf-hal: %s\n", text.c_str());
  return status;
}

int faulty_records(std::string_view mode) {
  HalSampleRecord record = record_number(3);
  put_first_three();
  if (mode == "torn") {
    put(&record, 100);
    return 0;
  }
  if (mode == "version") record.version = kHalStreamVersion + 1;
  if (mode == "length") record.bytes = 280;
  if (mode == "garbage") record.magic = 0x5A5A5A5A;
  if (mode == "back") record = record_number(1);
  if (mode == "clock-back") record.monotonic_ns -= 10'000'000;
  if (mode == "gap") record = record_number(9);
  put(record);
  stay();
}

int strange_values() {
  HalSampleRecord record = record_number(0);
  record.joint[1] = std::numeric_limits<double>::infinity();
  record.tool_number = -1;
  record.known &= ~static_cast<std::uint32_t>(kHalProgramLine);
  record.tool_offset[2] = kHalAbsent;
  record.spindle_rpm = kHalAbsent;
  put(record);
  stay();
}

int play(std::string_view mode, std::uintmax_t earlier_starts) {
  if (mode == "good") be_good(milliseconds(1));
  if (mode == "flood") be_good(milliseconds(0));
  if (mode == "slow") be_slow();
  if (mode == "echo") echo_status();
  if (mode == "silent") stay();
  if (mode == "strange") return strange_values();
  if (mode == "none") return end_saying(filled_in(HalMessage::kNoLinuxCnc), kHalExitNoLinuxCnc);
  if (mode == "refused") return end_saying(filled_in(HalMessage::kHalFull), kHalExitTrouble);
  if (mode == "usage") return end_saying("unknown argument --rate", kHalExitUsage);
  if (mode == "old-kerf") {
    const char* const fault = text_of(HalMessage::kOtherVersion);
    put(record_number(0));  // what was said before it is forgotten with it
    pause_for(milliseconds(50));
    end_saying(filled_in(HalMessage::kBadStatus, fault), 0);
    stay();
  }
  if (mode == "mute") {
    close(STDERR_FILENO);
    be_good(milliseconds(20));
  }
  if (mode == "stubborn") {
    signal(SIGTERM, SIG_IGN);
    put_first_three();
    stay();
  }
  if (mode == "killed") {
    put_first_three();
    raise(SIGKILL);
  }
  if (mode == "linuxcnc-restarts") {
    if (earlier_starts == 1) return end_saying("no LinuxCNC runs on this computer", 4);
    if (earlier_starts >= 2) be_good(milliseconds(1));
    put_first_three();
    return kHalExitAsked;
  }
  if (mode == "taken") {
    std::fputs("kerf-hal: the pins kerf.* are those of another component\n", stderr);
    HalSampleRecord record = record_number(0);
    record.on |= kHalPinsTaken;
    put(record);
    stay();
  }
  return faulty_records(mode);
}

}  // namespace
}  // namespace kerf

int main() {
  const char* mode = std::getenv("FAKE_KERF_HAL_MODE");
  const char* starts = std::getenv("FAKE_KERF_HAL_STARTS");
  if (mode == nullptr || starts == nullptr) return kerf::kHalExitUsage;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(starts, error);
  if (std::FILE* file = std::fopen(starts, "a")) {
    std::fputc('.', file);
    std::fclose(file);
  }
  return kerf::play(mode, error ? 0 : size);
}
