// The recorder, and that a replay is what was recorded.
#include "machine_io/recorder.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include "machine_io/recording_format.h"
#include "tests/machine_io/logs/log_test_support.h"

namespace kerf {
namespace {

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

RecordingHead head_of(std::uint16_t axes) {
  RecordingHead head;
  head.source = "test source";
  head.axes = axes;
  return head;
}

/// Any double that is finite: all exponents, denormals, both zeros.
double any_double(std::mt19937_64& random) {
  while (true) {
    const double value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
    if (std::isfinite(value)) return value;
  }
}

std::vector<AxisSample> any_samples(std::size_t count, std::uint16_t axes, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<AxisSample> samples;
  AxisSample sample;
  std::int64_t host_ns = 1'772'357'400'000'000'123;
  std::int64_t device_ns = -5'000'000'001;
  for (std::size_t n = 0; n < count; ++n) {
    host_ns += 1 + static_cast<std::int64_t>(random() % 2'000'000);
    device_ns += 1 + static_cast<std::int64_t>(random() % 2'000'000);
    sample.host_ns = host_ns;
    sample.device_ns = random() % 10 == 0 ? AxisSample::kNoTime : device_ns;
    sample.fresh = 0;
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if ((axes >> i & 1U) == 0) continue;
      switch (random() % 6) {
        case 0:
          sample.known = static_cast<std::uint16_t>(sample.known & ~(1U << i));
          break;
        case 1:  // known and not fresh, as it was or not
          break;
        case 2:
          sample.position[i] = any_double(random);
          break;
        case 3:
          sample.set(i, -0.0);
          break;
        default:
          sample.set(i, any_double(random));
      }
    }
    sample.tool = static_cast<std::int32_t>(random() % 4) - 1;
    sample.line = static_cast<std::int32_t>(random() % 100000) - 1;
    sample.tool_offset_z_mm = random() % 3 == 0 ? std::nan("") : any_double(random);
    sample.spindle_rpm = random() % 3 == 0 ? std::nan("") : any_double(random);
    samples.push_back(sample);
  }
  return samples;
}

TEST(Recorder, ReplaysBitForBit) {
  for (const std::uint16_t axes : {0b000000111, 0b111111111, 0b100000001}) {
    const TestFolder folder;
    const std::string path = folder.file("run.csv");
    RecordingHead head = head_of(axes);
    head.kind = CoordinateKind::kAxes;
    head.frame = CoordinateFrame::kWorkpiece;
    head.start_ns = 1'772'357'400'000'000'123;
    head.extra = {{"program", "part 1.ngc"}, {"map", "X: 0x381\nY: 0x382"}};
    auto recorder = Recorder::create(path, head);
    ASSERT_TRUE(recorder) << recorder.error();
    const auto samples = any_samples(5000, axes, 17 + axes);
    for (const AxisSample& sample : samples) (*recorder)->record(sample);
    const RecorderStatus done = (*recorder)->finish();
    EXPECT_EQ(done.trouble, "");
    EXPECT_EQ(done.samples, samples.size());
    EXPECT_EQ(done.lost, 0U);

    const ReadLog log = read_file(path);
    ASSERT_TRUE(log.is_open) << all_text(log.errors);
    ASSERT_EQ(log.samples.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ASSERT_EQ(difference(log.samples[i], samples[i]), "") << "sample " << i;
    }
    EXPECT_EQ(log.status.trouble, "");
    EXPECT_EQ(all_text(log.notes), "");
    ASSERT_TRUE(log.contents.recording);
    EXPECT_EQ(log.contents.recording->source, "test source");
    EXPECT_EQ(log.contents.recording->kind, CoordinateKind::kAxes);
    EXPECT_EQ(log.contents.recording->frame, CoordinateFrame::kWorkpiece);
    EXPECT_EQ(log.contents.recording->axes, axes);
    EXPECT_EQ(log.contents.recording->start_ns, head.start_ns);
    ASSERT_EQ(log.contents.recording->extra.size(), 2U);
    EXPECT_EQ(log.contents.recording->extra[1].second, "X: 0x381 Y: 0x382");
    EXPECT_EQ(log.contents.positions, axes);
  }
}

TEST(Recorder, WritesWhatTheFormatSays) {
  const TestFolder folder;
  RecordingHead head = head_of(0b101);
  head.start_ns = 1'772'357'400'000'000'123;
  auto recorder = Recorder::create(folder.file("run.csv"), head);
  ASSERT_TRUE(recorder) << recorder.error();
  AxisSample sample;
  sample.host_ns = 1'772'357'400'000'481'204;
  sample.set(0, 12.5);
  sample.set(2, 40.000000000000014);
  sample.tool = 1;
  (*recorder)->record(sample);
  sample.device_ns = -1;
  sample.fresh = 0b001;
  sample.position[0] = -0.0;
  sample.position[2] = 41.0;
  sample.line = 8;
  sample.tool_offset_z_mm = 55.25;
  sample.spindle_rpm = -8000;
  (*recorder)->record(sample);
  sample.fresh = 0;
  sample.known = 0b100;
  (*recorder)->record(sample);
  (*recorder)->finish();
  EXPECT_EQ(read_text(folder.file("run.csv")),
            "# kerf-recording/1\n"
            "# source: test source\n"
            "# units: mm\n"
            "# coordinates: joints machine\n"
            "# start: 2026-03-01T09:30:00.000000123Z\n"
            "# sums: crc32\n"
            "t_host,t_device,j0,j2,tool,line,tool_offset_z,spindle_rpm\n"
            "# sum 4b5e6420\n"
            "1772357400.000481204,,12.5,40.000000000000014,1,-,-,-\n"
            "1772357400.000481204,-0.000000001,-0,~41,1,8,55.25,-8000\n"
            "1772357400.000481204,-0.000000001,-,,1,8,55.25,-8000\n"
            "# sum 679b56ad\n"
            "# end samples=3\n");
}

TEST(Recorder, IsCutAtEveryByte) {
  const TestFolder folder;
  const auto samples = any_samples(12, 0b111, 3);
  {
    auto recorder = Recorder::create(folder.file("run.csv"), head_of(0b111));
    ASSERT_TRUE(recorder) << recorder.error();
    for (const AxisSample& sample : samples) (*recorder)->record(sample);
  }
  const std::string whole = read_text(folder.file("run.csv"));
  const std::size_t first = whole.find("spindle_rpm\n# sum ") + 12 + 15;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const ReadLog log = read_file(folder.write("cut.csv", whole.substr(0, size)));
    ASSERT_EQ(log.is_open, size >= first) << size;
    if (!log.is_open) {
      ASSERT_EQ(log.errors.size(), 1U);
      continue;
    }
    // As many samples as there are whole lines.
    const std::string rows = whole.substr(first, size - first);
    const auto lines = std::min(
        samples.size(), static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')));
    ASSERT_EQ(log.samples.size(), lines) << size;
    for (std::size_t i = 0; i < lines; ++i) {
      ASSERT_EQ(difference(log.samples[i], samples[i]), "") << size;
    }
    ASSERT_NE(log.status.trouble.find("cut off after " + std::to_string(lines) + " samples"),
              std::string::npos)
        << log.status.trouble;
    // What came behind is missing: the replay is lossy.
    ASSERT_EQ(log.status.errors, 1U) << size;
  }
  EXPECT_EQ(read_file(folder.file("run.csv")).status.trouble, "");
}

/// A file with three parts: a sum every second.
std::string three_parts(const TestFolder& folder, std::vector<AxisSample>& samples) {
  const std::string path = folder.file("run.csv");
  auto recorder = Recorder::create(path, head_of(0b111));
  EXPECT_TRUE(recorder);
  samples = any_samples(12, 0b111, 3);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % 4 == 3) std::this_thread::sleep_for(std::chrono::milliseconds(1150));
    (*recorder)->record(samples[i]);
  }
  (*recorder)->finish();
  return read_text(path);
}

TEST(Recorder, WhatIsDamagedIsToldAndNotReplayed) {
  const TestFolder folder;
  std::vector<AxisSample> samples;
  const std::string whole = three_parts(folder, samples);
  std::size_t sums = 0;
  for (std::size_t at = 0; (at = whole.find("\n# sum ", at)) != std::string::npos; ++at) ++sums;
  ASSERT_GE(sums, 4U) << whole;
  const std::size_t sums_line = whole.find("# sums: ");
  for (std::size_t at = 0; at < whole.size(); ++at) {
    // Without this line the file is one without sums.
    if (at >= sums_line && at < sums_line + 14) continue;
    for (const bool is_lost : {true, false}) {
      std::string damaged = whole;
      if (is_lost) {
        damaged.erase(at, 1);
      } else {
        damaged[at] = static_cast<char>(damaged[at] ^ 1);
      }
      const ReadLog log = read_file(folder.write("damaged.csv", damaged));
      // Without its first line it is a CSV file.
      if (!log.is_open || log.contents.format != LogFormat::kRecording) continue;
      ASSERT_NE(log.status.trouble, "") << "byte " << at;
      // What is handed out was recorded, in its order.
      std::size_t next = 0;
      for (const AxisSample& sample : log.samples) {
        while (next < samples.size() && !difference(sample, samples[next]).empty()) ++next;
        ASSERT_LT(next, samples.size()) << "byte " << at;
        ++next;
      }
      // A line end that is missing between two parts damages both.
      ASSERT_GE(log.samples.size() + 8, samples.size()) << "byte " << at;
    }
  }
}

TEST(Recorder, TheRestOfADamagedRecordingIsReplayed) {
  const TestFolder folder;
  std::vector<AxisSample> samples;
  std::string text = three_parts(folder, samples);
  // The decimal point of a position in the middle part.
  const std::size_t sum = text.find("# sum ", text.find("# sum ", text.find("# sum ") + 1) + 1);
  text.erase(text.rfind('.', sum), 1);
  const ReadLog log = read_file(folder.write("damaged.csv", text));
  ASSERT_TRUE(log.is_open);
  EXPECT_GT(log.status.damaged, 0U);
  EXPECT_EQ(log.status.damaged, log.status.lost);
  EXPECT_EQ(log.samples.size() + log.status.damaged, samples.size());
  EXPECT_EQ(log.status.errors, 1U);
  ASSERT_EQ(log.notes.size(), 1U);
  EXPECT_EQ(log.notes[0].message,
            "the " + std::to_string(log.status.damaged) +
                " samples before this line are damaged: their sum is wrong; they are dropped");
}

TEST(RecordingFormat, TheSumIsThatOfEthernet) {
  EXPECT_EQ(crc32(0, "123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32(crc32(0, "12345"), "6789"), 0xCBF43926U);
  EXPECT_EQ(crc32(0, ""), 0U);
}

TEST(Recorder, CountsWhatAFullQueueDrops) {
  const TestFolder folder;
  // A queue that a burst fills long before the writer looks.
  auto recorder = Recorder::create(folder.file("run.csv"), head_of(1), 1);
  ASSERT_TRUE(recorder) << recorder.error();
  AxisSample sample;
  constexpr std::int64_t kBurst = 2'000'000;
  for (std::int64_t i = 0; i < kBurst; ++i) {
    sample.host_ns = i;
    sample.set(0, static_cast<double>(i));
    (*recorder)->record(sample);
  }
  const RecorderStatus done = (*recorder)->finish();
  EXPECT_EQ(done.samples + done.lost, static_cast<std::uint64_t>(kBurst));
  ASSERT_GT(done.lost, 0U);
  const ReadLog log = read_file(folder.file("run.csv"));
  EXPECT_EQ(log.status.lost, done.lost);
  ASSERT_EQ(log.samples.size(), done.samples);
  EXPECT_EQ(log.status.trouble, "");
  // Each gap in the samples is told where it is.
  std::int64_t expected = 0;
  std::int64_t gaps = 0;
  for (const AxisSample& one : log.samples) {
    gaps += one.host_ns - expected;
    expected = one.host_ns + 1;
  }
  EXPECT_EQ(gaps + kBurst - expected, static_cast<std::int64_t>(done.lost));
}

TEST(Recorder, WhatTheSourceLostAndASetClockAreInTheRecording) {
  const TestFolder folder;
  RecordingHead head = head_of(1);
  head.program = true;
  auto recorder = Recorder::create(folder.file("run.csv"), head);
  ASSERT_TRUE(recorder) << recorder.error();
  const std::int64_t begin_ns = 1'772'357'400'000'000'000;
  const std::array<ProgramState, 5> states{ProgramState::kUnknown, ProgramState::kIdle,
                                           ProgramState::kRunning, ProgramState::kPaused,
                                           ProgramState::kIdle};
  // An hour forward before the third one, and 90 minutes back before the fifth.
  const std::array<std::int64_t, 5> set_s{0, 0, 3600, 0, -5400};
  std::int64_t ahead_ns = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    AxisSample sample;
    ahead_ns += set_s[i] * 1'000'000'000;
    sample.host_ns = begin_ns + static_cast<std::int64_t>(i) * 10'000'000 + ahead_ns;
    sample.set(0, static_cast<double>(i));
    sample.program = states[i];
    sample.restarted = i == 3;
    if (i == 1) (*recorder)->note_lost(21);
    if (set_s[i] != 0) (*recorder)->note_clock_set(set_s[i] * 1'000'000'000);
    (*recorder)->record(sample);
  }
  EXPECT_EQ((*recorder)->finish().lost, 0U) << "these the recorder has not lost itself";
  const ReadLog log = read_file(folder.file("run.csv"));
  EXPECT_EQ(log.status.lost, 21U);
  EXPECT_EQ(log.status.errors, 0U);
  EXPECT_EQ(log.status.disordered, 0U);
  ASSERT_EQ(log.samples.size(), states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(log.samples[i].host_ns, begin_ns + static_cast<std::int64_t>(i) * 10'000'000) << i;
    EXPECT_EQ(log.samples[i].program, states[i]) << i;
    EXPECT_EQ(log.samples[i].restarted, i == 3) << i;
  }
}

TEST(Recorder, DoesNotOverwrite) {
  const TestFolder folder;
  const std::string path = folder.write("run.csv", "precious");
  const auto recorder = Recorder::create(path, head_of(1));
  ASSERT_FALSE(recorder);
  EXPECT_EQ(recorder.error(),
            "recording " + path +
                ": the file is there already (8 bytes), and a recording is never overwritten; name "
                "another file or remove this one");
  EXPECT_EQ(read_text(path), "precious");
  // An empty one is nobody's work.
  EXPECT_TRUE(Recorder::create(folder.write("empty.csv", ""), head_of(1)));
}

TEST(Recorder, SaysWhyItCannotBegin) {
  const TestFolder folder;
  const auto nowhere = Recorder::create(folder.file("no/run.csv"), head_of(1));
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error(),
            "recording " + folder.file("no/run.csv") + ": No such file or directory");
  const auto full = Recorder::create("/dev/full", head_of(1));
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error(), "recording /dev/full: No space left on device");
  RecordingHead head = head_of(0);
  EXPECT_EQ(validate(head).size(), 1U);
  EXPECT_FALSE(Recorder::create(folder.file("run.csv"), head));
  head = head_of(1);
  head.extra = {{"units", "inch"}, {"a b", "c"}, {"good-key_1.x", ""}};
  EXPECT_EQ(validate(head).size(), 2U);
}

/// In a process of its own: limits cannot be taken back. 0 if all is as it should be.
int record_onto_full_disk(const std::string& path) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{10'000, 10'000};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
  auto recorder = Recorder::create(path, head_of(0b111));
  if (!recorder) return 3;
  AxisSample sample;
  for (std::int64_t i = 0; i < 1000; ++i) {
    sample.host_ns = i * 1'000'000;
    sample.set(0, static_cast<double>(i) * 0.1);
    sample.set(1, 1.0);
    sample.set(2, 2.0);
    (*recorder)->record(sample);
  }
  const RecorderStatus done = (*recorder)->finish();
  const std::string expected = "recording " + path + ": File too large; " +
                               std::to_string(done.samples) + " samples are kept";
  if (done.trouble != expected) return 4;
  (*recorder)->record(sample);  // and nothing happens
  return (*recorder)->finish().samples == done.samples ? 0 : 5;
}

TEST(Recorder, KeepsWhatWasThereWhenTheDiskIsFull) {
  const TestFolder folder;
  const std::string path = folder.file("run.csv");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(record_onto_full_disk(path));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 0);
  const std::string text = read_text(path);
  EXPECT_GT(text.size(), 9'800U);
  EXPECT_EQ(text.back(), '\n');
  const ReadLog log = read_file(path);
  EXPECT_GT(log.samples.size(), 200U);
  EXPECT_EQ(log.status.errors, 1U) << "cut off";
  for (std::size_t i = 0; i < log.samples.size(); ++i) {
    ASSERT_EQ(log.samples[i].position[0], static_cast<double>(i) * 0.1);
  }
}

TEST(Recorder, LosesAtMostASecondWhenKilled) {
  const TestFolder folder;
  const std::string path = folder.file("run.csv");
  int newest[2];
  ASSERT_EQ(::pipe(newest), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // 1 kHz; says on the pipe what it has recorded.
    auto recorder = Recorder::create(path, head_of(1));
    if (!recorder) ::_exit(1);
    AxisSample sample;
    for (double i = 0;; ++i) {
      sample.host_ns = now_ns();
      sample.set(0, i);
      (*recorder)->record(sample);
      if (::write(newest[1], &sample.host_ns, sizeof sample.host_ns) < 0) ::_exit(2);
      const timespec millisecond{0, 1'000'000};
      ::nanosleep(&millisecond, nullptr);
    }
  }
  ::close(newest[1]);
  std::int64_t last_ns = 0;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_EQ(::read(newest[0], &last_ns, sizeof last_ns), static_cast<ssize_t>(sizeof last_ns));
  }
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  while (::read(newest[0], &last_ns, sizeof last_ns) == static_cast<ssize_t>(sizeof last_ns)) {
  }
  ::close(newest[0]);
  const ReadLog log = read_file(path);
  ASSERT_FALSE(log.samples.empty());
  EXPECT_LE(last_ns - log.samples.back().host_ns, 1'000'000'000);
  EXPECT_EQ(log.status.errors, 1U) << "cut off";
  EXPECT_NE(log.status.trouble.find("cut off after"), std::string::npos);
  for (std::size_t i = 0; i < log.samples.size(); ++i) {
    ASSERT_EQ(log.samples[i].position[0], static_cast<double>(i));
  }
}

TEST(Recorder, WritesALoneSampleSoon) {
  const TestFolder folder;
  const std::string path = folder.file("run.csv");
  auto recorder = Recorder::create(path, head_of(1));
  ASSERT_TRUE(recorder) << recorder.error();
  AxisSample sample;
  sample.host_ns = 1;
  sample.set(0, 7.0);
  (*recorder)->record(sample);
  // No other follows. Ten seconds are for a computer that is very busy.
  const std::int64_t deadline_ns = now_ns() + 10'000'000'000;
  while ((*recorder)->status().samples == 0 && now_ns() < deadline_ns) ::usleep(5000);
  EXPECT_EQ((*recorder)->status().samples, 1U);
  EXPECT_NE(read_text(path).find("\n0.000000001,,7,"), std::string::npos);
}

TEST(RecordingFormat, TimesGoThereAndBack) {
  for (const std::int64_t time_ns :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1'772'357'400'000'000'123},
        std::int64_t{951'782'399'999'999'999}, std::int64_t{-2'208'988'800'000'000'000}}) {
    std::int64_t again_ns = 1;
    ASSERT_TRUE(parse_iso_time(iso_time(time_ns), again_ns)) << iso_time(time_ns);
    EXPECT_EQ(again_ns, time_ns);
  }
  std::int64_t time_ns = 0;
  for (const char* text : {"", "2026-03-01", "2026-02-29T00:00:00.000000000Z",
                           "2026-03-01T24:00:00.000000000Z", "2026-03-01T00:00:00.000000000",
                           "2026-03-01T00:00:00.000000000Z ", "9999-03-01T00:00:00.000000000Z"}) {
    EXPECT_FALSE(parse_iso_time(text, time_ns)) << text;
  }
}

TEST(Recorder, KeepsTheLoadOfTheSpindle) {
  const TestFolder folder;
  RecordingHead head = head_of(0b1);
  head.load = LoadUnit::kKilowatts;
  auto recorder = Recorder::create(folder.file("a.csv"), head);
  ASSERT_TRUE(recorder);
  constexpr double kLoads[] = {1.25, std::numeric_limits<double>::quiet_NaN(), -0.5};
  for (int i = 0; i < 3; ++i) {
    AxisSample sample;
    sample.host_ns = 1'772'357'400'000'000'000 + i;
    sample.set(0, i);
    sample.load = kLoads[i];
    sample.load_unit = LoadUnit::kKilowatts;
    recorder.value()->record(sample);
  }
  EXPECT_EQ(recorder.value()->finish().trouble, "");
  EXPECT_NE(read_text(folder.file("a.csv")).find("spindle_rpm,load_kw\n"), std::string::npos);
  const ReadLog log = read_log(log_at(folder.file("a.csv")));
  ASSERT_EQ(log.samples.size(), 3U);
  EXPECT_EQ(log.contents.load, LoadUnit::kKilowatts);
  EXPECT_EQ(log.contents.recording->load, LoadUnit::kKilowatts);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(log.samples[i].load),
              std::bit_cast<std::uint64_t>(kLoads[i]));
    if (i == 1) continue;
    EXPECT_EQ(log.samples[i].load_unit, LoadUnit::kKilowatts);
  }
}

}  // namespace
}  // namespace kerf
