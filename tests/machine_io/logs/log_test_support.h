// tests/machine_io/logs/log_test_support.h - files for log tests, and all that a log source gives.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <bit>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "machine_io/logs/log_source.h"

namespace kerf {

/// A folder of its own that goes with the test.
class TestFolder {
 public:
  TestFolder() {
    std::string name = std::filesystem::temp_directory_path() / "kerf-logs.XXXXXX";
    if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "no folder " << name;
    path_ = name;
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream out(file(name), std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    return file(name);
  }

 private:
  std::string path_;
};

inline std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline LogSettings log_at(std::string path) {
  LogSettings settings;
  settings.path = std::move(path);
  return settings;
}

/// A log read to its end.
struct ReadLog {
  std::vector<AxisSample> samples;
  SourceStatus status;
  LogContents contents;
  Diagnostics notes;
  Diagnostics errors;  // of open(); nothing else is there then
  bool is_open = false;
};

inline ReadLog read_log(LogSettings settings) {
  ReadLog log;
  const auto source = LogSource::open(std::move(settings), log.errors);
  log.is_open = source != nullptr;
  if (!log.is_open) return log;
  AxisSample sample;
  PositionSource::Next next;
  while ((next = source->next(sample, std::chrono::milliseconds{1000})) !=
         PositionSource::Next::kEnd) {
    if (next == PositionSource::Next::kSample) log.samples.push_back(sample);
  }
  log.status = source->status();
  log.contents = source->contents();
  log.notes = source->notes();
  EXPECT_EQ(log.status.samples, log.samples.size());
  return log;
}

inline ReadLog read_file(const std::string& path) {
  LogSettings settings;
  settings.path = path;
  return read_log(settings);
}

inline std::string all_text(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic);
  return text;
}

/// Empty, or what differs; numbers are compared as bits. Positions that are not known do not count.
inline std::string difference(const AxisSample& a, const AxisSample& b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  if (a.host_ns != b.host_ns) return "host_ns";
  if (a.device_ns != b.device_ns) return "device_ns";
  if (a.known != b.known) return "known";
  if (a.fresh != b.fresh) return "fresh";
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (a.has(i) && bits(a.position[i]) != bits(b.position[i])) {
      return "position " + std::to_string(i);
    }
  }
  if (a.tool != b.tool) return "tool";
  if (a.line != b.line) return "line";
  const auto same = [&](double x, double y) {
    return bits(x) == bits(y) || (std::isnan(x) && std::isnan(y));
  };
  if (!same(a.tool_offset_z_mm, b.tool_offset_z_mm)) return "tool_offset_z_mm";
  if (!same(a.spindle_rpm, b.spindle_rpm)) return "spindle_rpm";
  return {};
}

}  // namespace kerf
