// bench_logs [SAMPLES]: how fast a recording is written and logs are read; the results are checked
// first. Best and median of five.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "machine_io/logs/log_source.h"
#include "machine_io/recorder.h"

namespace {

constexpr int kRuns = 5;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

kerf::AxisSample sample_at(std::int64_t n) {
  kerf::AxisSample sample;
  sample.host_ns = 1'772'357'400'000'000'123 + n * 1'000'017;
  sample.device_ns = n * 1'000'000;
  const double t = static_cast<double>(n) * 1e-3;
  for (std::size_t i = 0; i < 6; ++i) {
    sample.set(i, 50.0 * std::sin(t * (0.3 + 0.1 * static_cast<double>(i))));
  }
  sample.tool = 3;
  sample.line = static_cast<std::int32_t>(n % 5000);
  sample.tool_offset_z_mm = 55.25;
  sample.spindle_rpm = 8000.0;
  return sample;
}

[[noreturn]] void fail(const std::string& text) {
  fmt::print(stderr, "bench_logs: {}\n", text);
  std::exit(1);
}

/// Seconds. The queue holds all samples, so that none is lost and the writer is what is measured.
double write_recording(const std::string& path, std::int64_t samples) {
  std::filesystem::remove(path);
  kerf::RecordingHead head;
  head.source = "bench";
  head.axes = 0b111111;
  const auto start = std::chrono::steady_clock::now();
  auto recorder =
      kerf::Recorder::create(path, head, static_cast<std::size_t>(samples) * 512U + 65536U);
  if (!recorder) fail(recorder.error());
  for (std::int64_t n = 0; n < samples; ++n) (*recorder)->record(sample_at(n));
  const kerf::RecorderStatus done = (*recorder)->finish();
  if (done.samples != static_cast<std::uint64_t>(samples)) fail("not all samples were written");
  return seconds_since(start);
}

/// CSV of 12 columns: what other programs write.
void write_csv(const std::string& path, std::int64_t samples) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) fail("cannot write " + path);
  fmt::print(file, "t,x,y,z,a,b,c,tool,line,tloz,rpm,load\n");
  for (std::int64_t n = 0; n < samples; ++n) {
    const kerf::AxisSample s = sample_at(n);
    fmt::print(file, "{}.{:03}", n / 1000, n % 1000);
    for (std::size_t i = 0; i < 6; ++i) fmt::print(file, ",{:.6f}", s.position[i]);
    fmt::print(file, ",{},{},{},{},0.5\n", s.tool, s.line, s.tool_offset_z_mm, s.spindle_rpm);
  }
  std::fclose(file);
}

void write_halsampler(const std::string& path, std::int64_t samples) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) fail("cannot write " + path);
  for (std::int64_t n = 0; n < samples; ++n) {
    const kerf::AxisSample s = sample_at(n);
    fmt::print(file, "{} ", n);
    for (std::size_t i = 0; i < 6; ++i) fmt::print(file, "{:.6f} ", s.position[i]);
    fmt::print(file, "{:.6f} {:.6f} 1 {} {} \n", s.tool_offset_z_mm, s.spindle_rpm, s.tool, s.line);
  }
  std::fclose(file);
}

double read_log(const kerf::LogSettings& settings, std::int64_t samples) {
  const auto start = std::chrono::steady_clock::now();
  kerf::Diagnostics diagnostics;
  const auto source = kerf::LogSource::open(settings, diagnostics);
  if (source == nullptr) fail(to_string(diagnostics.front()));
  kerf::AxisSample sample;
  std::int64_t count = 0;
  while (source->next(sample, std::chrono::milliseconds{0}) ==
         kerf::PositionSource::Next::kSample) {
    if (count % 997 == 0 && std::abs(sample.position[1] - sample_at(count).position[1]) > 1e-6) {
      fail("a sample is not what was written");
    }
    ++count;
  }
  if (count != samples) fail("not all samples were read");
  return seconds_since(start);
}

template <class Run>
void report(const char* what, std::int64_t samples, const Run& run) {
  std::vector<double> seconds;
  for (int i = 0; i < kRuns; ++i) seconds.push_back(run());
  std::sort(seconds.begin(), seconds.end());
  const double count = static_cast<double>(samples) / 1e6;
  fmt::print("{:<22} best {:6.2f}, median {:6.2f} million samples/s\n", what, count / seconds[0],
             count / seconds[kRuns / 2]);
}

}  // namespace

int main(int argc, char** argv) {
  const std::int64_t samples = argc > 1 ? std::atoll(argv[1]) : 1'000'000;
  if (samples <= 0) fail("SAMPLES must be above 0");
  std::string folder = std::filesystem::temp_directory_path() / "kerf-bench-logs.XXXXXX";
  if (mkdtemp(folder.data()) == nullptr) fail("cannot make " + folder);
  const std::string path = folder + "/log";

  report("recording, written", samples, [&] { return write_recording(path, samples); });
  kerf::LogSettings settings;
  settings.path = path;
  report("recording, read", samples, [&] { return read_log(settings, samples); });
  write_csv(path, samples);
  report("CSV, read", samples, [&] { return read_log(settings, samples); });
  write_halsampler(path, samples);
  settings.pins = {"joint.0.pos-fb",          "joint.1.pos-fb",      "joint.2.pos-fb",
                   "joint.3.pos-fb",          "joint.4.pos-fb",      "joint.5.pos-fb",
                   "motion.tooloffset.z",     "spindle.0.speed-out", "spindle.0.on",
                   "iocontrol.0.tool-number", "motion.program-line"};
  report("halsampler, read", samples, [&] { return read_log(settings, samples); });
  std::filesystem::remove_all(folder);
  return 0;
}
