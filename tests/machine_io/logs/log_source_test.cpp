// Every format of log, and what becomes of lines that are not as they should be.
#include "machine_io/logs/log_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "machine_io/logs/number_text.h"
#include "tests/machine_io/logs/log_test_support.h"

namespace kerf {
namespace {

ReadLog read_as(const TestFolder& folder, const std::string& text, LogSettings settings = {}) {
  settings.path = folder.write("log", text);
  return read_log(std::move(settings));
}

std::string only_error(const ReadLog& log) {
  EXPECT_FALSE(log.is_open);
  EXPECT_EQ(log.errors.size(), 1U) << all_text(log.errors);
  if (log.errors.empty()) return {};
  const Diagnostic& error = log.errors.front();
  return fmt::format("{}:{}: {}", error.line, error.column, error.message);
}

// ---- CSV

TEST(CsvLog, ReadsAllThatASampleHas) {
  const TestFolder folder;
  const ReadLog log = read_as(folder,
                              "# a comment\n"
                              "\n"
                              "t,x,y,z,a,tool,line,tool_offset_z,rpm\n"
                              "0.001,1.5,-2.25,+3e1,90,2,17,55.25,-8000\n"
                              "# another\n"
                              "0.0020000005,,-,4,,-1,0,-,nan\n");
  ASSERT_TRUE(log.is_open) << all_text(log.errors);
  ASSERT_EQ(log.samples.size(), 2U);
  const AxisSample& first = log.samples[0];
  EXPECT_EQ(first.device_ns, 1'000'000);
  EXPECT_GT(first.host_ns, 1'700'000'000'000'000'000);
  EXPECT_EQ(first.known, 0b1111);
  EXPECT_EQ(first.fresh, 0b1111);
  EXPECT_EQ(first.position[0], 1.5);
  EXPECT_EQ(first.position[1], -2.25);
  EXPECT_EQ(first.position[2], 30.0);
  EXPECT_EQ(first.position[3], 90.0);
  EXPECT_EQ(first.tool, 2);
  EXPECT_EQ(first.line, 17);
  EXPECT_EQ(first.tool_offset_z_mm, 55.25);
  EXPECT_EQ(first.spindle_rpm, -8000.0);
  const AxisSample& second = log.samples[1];
  EXPECT_EQ(second.device_ns, 2'000'001);
  EXPECT_EQ(second.known, 0b1101);
  EXPECT_EQ(second.fresh, 0b0100);
  EXPECT_EQ(second.position[0], 1.5);
  EXPECT_EQ(second.tool, AxisSample::kUnknown);
  EXPECT_EQ(second.line, 0);
  EXPECT_TRUE(std::isnan(second.tool_offset_z_mm));
  EXPECT_TRUE(std::isnan(second.spindle_rpm));
  EXPECT_EQ(log.contents.kind, CoordinateKind::kAxes);
  EXPECT_EQ(log.contents.positions, 0b1111);
  EXPECT_EQ(log.status.state, SourceState::kEnded);
  EXPECT_EQ(all_text(log.notes), "");
}

TEST(CsvLog, KnowsUnitsByTheNamesOfColumns) {
  const TestFolder folder;
  struct Case {
    const char* header;
    double expected;  // of "2" in the column x
    std::int64_t time_ns;
  };
  for (const Case& one :
       {Case{"t,x", 2.0, 3'000'000'000}, Case{"t_s,x_mm", 2.0, 3'000'000'000},
        Case{"t_ms,x_in", 50.8, 3'000'000}, Case{"T [us], X [Inch]", 50.8, 3'000},
        Case{"time(ns),x (um)", 0.002, 3}, Case{"timestamp,x[m]", 2000.0, 3'000'000'000}}) {
    const ReadLog log = read_as(folder, fmt::format("{}\n3,2\n", one.header));
    ASSERT_TRUE(log.is_open) << all_text(log.errors);
    ASSERT_EQ(log.samples.size(), 1U) << one.header;
    EXPECT_DOUBLE_EQ(log.samples[0].position[0], one.expected) << one.header;
    EXPECT_EQ(log.samples[0].device_ns, one.time_ns) << one.header;
  }
}

TEST(CsvLog, TakesTheUnitOfTheSettingsForLengthsWithoutOne) {
  const TestFolder folder;
  LogSettings settings;
  settings.unit = LogUnit::kInch;
  const ReadLog axes = read_as(folder, "t,x,y_mm,a,tloz\n0,1,1,1,2\n", settings);
  ASSERT_EQ(axes.samples.size(), 1U);
  EXPECT_EQ(axes.samples[0].position[0], 25.4);
  EXPECT_EQ(axes.samples[0].position[1], 1.0);
  EXPECT_EQ(axes.samples[0].position[3], 1.0);
  EXPECT_EQ(axes.samples[0].tool_offset_z_mm, 50.8);
  settings.rotary_joints = 0b10;
  const ReadLog joints = read_as(folder, "t,j0,joint1,joint.2.pos-fb\n0,1,1,1\n", settings);
  ASSERT_EQ(joints.samples.size(), 1U);
  EXPECT_EQ(joints.contents.kind, CoordinateKind::kJoints);
  EXPECT_EQ(joints.samples[0].position[0], 25.4);
  EXPECT_EQ(joints.samples[0].position[1], 1.0);
  EXPECT_EQ(joints.samples[0].position[2], 25.4);
}

TEST(CsvLog, ReadsTheShapesOfManyPrograms) {
  const TestFolder folder;
  for (const char* text : {
           "t;x;y\r\n1;2;3\r\n",
           "t\tx\ty\n1\t2\t3\n",
           "\xEF\xBB\xBFt,x,y\n1,2,3\n",
           "\"t\",\"x\",\"note, with \"\"comma\"\"\",\"y\"\n1,\"2\",\"a, \"\"b\"\"\",3\n",
           " t , x , y \n 1 , 2 , 3 \n",
           "t,x,y,\n1,2,3,\n",
           "t,x,y\n1,2,3,\n",
           "t,x,y\n1,2,3",
       }) {
    const ReadLog log = read_as(folder, text);
    ASSERT_TRUE(log.is_open) << all_text(log.errors);
    ASSERT_EQ(log.samples.size(), 1U) << text << log.status.trouble;
    EXPECT_EQ(log.samples[0].device_ns, 1'000'000'000);
    EXPECT_EQ(log.samples[0].position[0], 2.0) << text;
    EXPECT_EQ(log.samples[0].position[1], 3.0) << text;
  }
}

TEST(CsvLog, ReadsTheLoadOfTheSpindle) {
  const TestFolder folder;
  const ReadLog log =
      read_log(log_at(folder.write("a.csv", "t,x,load_nm\n0,1,2.5\n1,1,\n2,1,-\n3,1,1e6\n")));
  ASSERT_EQ(log.samples.size(), 3U);
  EXPECT_EQ(log.samples[0].load, 2.5);
  EXPECT_EQ(log.samples[0].load_unit, LoadUnit::kNewtonMetres);
  EXPECT_EQ(log.samples[1].load, 2.5);
  EXPECT_TRUE(std::isnan(log.samples[2].load));
  EXPECT_EQ(log.status.errors, 1U);  // no spindle has 1e6 Nm
}

TEST(CsvLog, ReadsTheLoadFromTheColumnThatIsChosen) {
  const TestFolder folder;
  LogSettings settings;
  settings.path = folder.write("a.csv", "t,x,Spindle Load,load_kw\n0,1,50,9\n");
  settings.load = LogLoad{"spindle load", LoadUnit::kPercentOfPower, 0.1, 1};
  const ReadLog log = read_log(settings);
  ASSERT_EQ(log.samples.size(), 1U);
  EXPECT_EQ(log.samples[0].load, 6);
  EXPECT_EQ(log.samples[0].load_unit, LoadUnit::kPercentOfPower);
  settings.load->column = "Spindel";
  const ReadLog none = read_log(settings);
  ASSERT_EQ(none.errors.size(), 1U);
  EXPECT_EQ(
      none.errors[0].message,
      "source.map.load.pin: no column is called 'Spindel'; found: t, x, Spindle Load, load_kw");
}

TEST(CsvLog, TwoLoadsAreNotClear) {
  const TestFolder folder;
  const ReadLog log = read_log(log_at(folder.write("a.csv", "t,x,load_kw,load_nm\n0,1,50,9\n")));
  EXPECT_FALSE(log.is_open);
}

TEST(CsvLog, ListsTheColumnsThatItDoesNotRead) {
  const TestFolder folder;
  const ReadLog log = read_as(folder,
                              "t,motor_x,joint.0.pos-cmd,joint.0.pos-fb,axis.y.pos-cmd,vel\n"
                              "0,1,2,3,4,hello\n");
  ASSERT_EQ(log.samples.size(), 1U) << all_text(log.errors);
  EXPECT_EQ(log.samples[0].position[0], 3.0);
  EXPECT_EQ(log.contents.positions, 1);
  ASSERT_EQ(log.notes.size(), 1U);
  EXPECT_EQ(log.notes[0].message,
            "columns not read: motor_x, joint.0.pos-cmd, axis.y.pos-cmd, vel");
}

TEST(CsvLog, SaysWhatIsWrongWithItsHeader) {
  const TestFolder folder;
  const ReadLog none = read_as(folder, "# log\nt,pressure,heat\n1,2,3\n");
  EXPECT_EQ(only_error(none), "2:1: none of the columns is a position; found: t, pressure, heat");
  EXPECT_NE(none.errors[0].hint.find("joint.N.pos-fb"), std::string::npos);
  EXPECT_NE(to_string(none.errors[0]).find("t,pressure,heat"), std::string::npos);
  EXPECT_EQ(only_error(read_as(folder, "x,y\n1,2\n")), "1:1: none of the columns is a time");
  EXPECT_EQ(only_error(read_as(folder, "t,x,y,x_mm\n")),
            "1:7: columns 'x' and 'x_mm' are the same thing: which is meant is not clear");
  EXPECT_EQ(only_error(read_as(folder, "t,x,j0\n")),
            "1:0: there are columns for joints and for axes: which are meant is not clear");
  EXPECT_EQ(
      only_error(read_as(folder, "t,x [furlong]\n")),
      "1:3: column 'x [furlong]': the unit is not one that fits; allowed are mm, um, m, in or "
      "inch for lengths, deg for angles, s, ms, us or ns for times");
  EXPECT_EQ(only_error(read_as(folder, "t [mm],x\n")).substr(0, 22), "1:1: column 't [mm]': ");
  EXPECT_EQ(only_error(read_as(folder, "")), "0:0: the file is empty");
  EXPECT_EQ(only_error(read_as(folder, "# only\n\n")),
            "2:0: the file holds no samples, only comments");
}

TEST(CsvLog, CountsAndDescribesDamagedLines) {
  const TestFolder folder;
  const ReadLog log = read_as(folder,
                              "t,x,line\n"
                              "1,1,1\n"
                              "2,one,1\n"
                              "3,2\n"
                              "4,4,1,9\n"
                              "five,4,1\n"
                              "6,inf,1\n"
                              "7,1e999,1\n"
                              "8,4,1.5\n"
                              "9,4,-2\n"
                              ",4,1\n"
                              "11,\"4,1\n"
                              "12,0x10,1\n"
                              "13,4,\n");
  ASSERT_EQ(log.samples.size(), 2U);
  EXPECT_EQ(log.samples[1].device_ns, 13'000'000'000);
  EXPECT_EQ(log.samples[1].line, 1);
  EXPECT_EQ(log.status.errors, 11U);
  const std::string text = all_text(log.notes);
  const std::string path = folder.file("log");
  for (const char* expected :
       {":3:3: warning: 'one' is not a number", ":4:4: warning: 2 cells found, 3 expected",
        ":5:7: warning: more cells than the 3 of the header", ":6:1: warning: 'five' is not a time",
        ":7:3: warning: 'inf' is not a number", ":8:3: warning: '1e999' is not a number",
        ":9:5: warning: '1.5' is not a line number", ":10:5: warning: '-2' is not a line number",
        ":11:1: warning: the line has no time", ":12:4: warning: the quotation mark is not closed",
        ":13:4: warning: '0x10' is not a number"}) {
    EXPECT_NE(text.find(path + expected), std::string::npos) << expected << "\n" << text;
  }
  EXPECT_EQ(log.status.trouble, path + ":13: '0x10' is not a number");
}

TEST(CsvLog, DescribesOnlyTheFirstDamagedLines) {
  const TestFolder folder;
  std::string text = "t,x\n";
  for (int i = 0; i < 1000; ++i) text += "bad line\n";
  const ReadLog log = read_as(folder, text + "1,1\n");
  EXPECT_EQ(log.status.errors, 1000U);
  EXPECT_EQ(log.samples.size(), 1U);
  ASSERT_EQ(log.notes.size(), LogSource::kMostDescribed + 1);
  EXPECT_EQ(log.notes.back().message, "further lines that could not be used are only counted");
}

TEST(CsvLog, CountsDuplicateAndDisorderedLines) {
  const TestFolder folder;
  const ReadLog log = read_as(folder,
                              "t,x\n"
                              "1,1\n2,2\n2,2\n1.5,3\n3,4\n2.5,5\n4,6\n");
  ASSERT_EQ(log.samples.size(), 4U);
  EXPECT_EQ(log.samples[2].position[0], 4.0);
  EXPECT_EQ(log.status.duplicates, 1U);
  EXPECT_EQ(log.status.disordered, 2U);
  EXPECT_EQ(log.status.errors, 0U);
}

TEST(CsvLog, GoesOnAfterTheClockWasSetBack) {
  const TestFolder folder;
  std::string text = "t,x\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{},{}\n", 1000 + i, i);
  for (int i = 0; i < 100; ++i) text += fmt::format("{},{}\n", 10 + i, i);
  const ReadLog log = read_as(folder, text);
  EXPECT_EQ(log.status.disordered, static_cast<std::uint64_t>(LogSource::kClockSet));
  EXPECT_EQ(log.samples.size(), 200U - LogSource::kClockSet);
  ASSERT_EQ(log.notes.size(), 1U);
  EXPECT_EQ(log.notes[0].line, 1 + 100 + LogSource::kClockSet + 1);
}

TEST(CsvLog, BearsLongLinesAndBytesThatAreNoText) {
  const TestFolder folder;
  std::string text = "t,x,note\n1,1,";
  text.append(700'000, 'n');
  text += "\n2,2,";
  text.append(3'000'000, 'n');
  text += "\n3,3,z\n4,";
  text += std::string("4\0004", 3);
  text += ",z\n";
  text.append(500, '\0').append("\n5,5,z\n");
  const ReadLog log = read_as(folder, text);
  ASSERT_EQ(log.samples.size(), 3U);
  EXPECT_EQ(log.samples[1].position[0], 3.0);
  EXPECT_EQ(log.samples[2].position[0], 5.0);
  EXPECT_EQ(log.status.errors, 3U);
}

TEST(CsvLog, RefusesWhatIsNoText) {
  const TestFolder folder;
  EXPECT_EQ(only_error(read_as(folder, std::string("\xFD"
                                                   "7zXZ\0\0\4",
                                                   8))),
            "1:0: the file is compressed (xz), not text");
  EXPECT_EQ(only_error(read_as(folder, "\x1F\x8B\x08 abc")),
            "1:0: the file is compressed (gzip), not text");
  EXPECT_EQ(only_error(read_as(folder, std::string("\xFF\xFEt\0,\0x\0", 8))),
            "1:0: the file is UTF-16 text, not text");
  EXPECT_EQ(only_error(read_as(folder, std::string("ab\0\1\2", 5))),
            "1:0: the file is not text: there are control characters in its first line");
  EXPECT_EQ(only_error(read_as(folder, std::string(2'000'000, 'x'))),
            "1:0: a line of more than 1048576 bytes; this is no log that kerf reads");
  EXPECT_EQ(only_error(read_file(folder.file(""))), "0:0: Is a directory");
  EXPECT_EQ(only_error(read_file(folder.file("no"))), "0:0: No such file or directory");
}

TEST(CsvLog, IsCutAtEveryByte) {
  const TestFolder folder;
  const std::string whole = "t,x,y\n1.5,-2.25,3\n2.5,1e2,4\n3.5,5,6\n";
  const std::size_t first = whole.find('\n');
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const std::string text = whole.substr(0, size);
    const ReadLog log = read_as(folder, text);
    if (size < 3) {
      EXPECT_FALSE(log.is_open) << size;
      continue;
    }
    ASSERT_TRUE(log.is_open) << size << all_text(log.errors);
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    const std::size_t rows = size <= first ? 0 : lines - 1;
    EXPECT_GE(log.samples.size(), rows);
    EXPECT_LE(log.samples.size(), rows + 1);
    for (std::size_t i = 0; i < rows; ++i) {
      EXPECT_EQ(log.samples[i].position[1], 3.0 + static_cast<double>(i) + (i == 2 ? 1.0 : 0.0));
    }
  }
}

// ---- recordings

const char* const kHead =
    "# kerf-recording/1\n# source: s\n# units: mm\n# coordinates: joints machine\n"
    "# start: 2026-03-01T09:30:00.000000000Z\n";
const char* const kColumns = "t_host,t_device,j0,tool,line,tool_offset_z,spindle_rpm\n";

TEST(RecordingLog, SaysWhatIsWrongWithItsHead) {
  const TestFolder folder;
  const std::string head = kHead;
  EXPECT_EQ(only_error(read_as(folder, "# kerf-recording/2\n")),
            "1:1: the first line has to be '# kerf-recording/1'");
  EXPECT_EQ(only_error(read_as(folder, head)), "5:0: the recording is cut off in its head");
  EXPECT_EQ(only_error(read_as(folder, "# kerf-recording/1\n# units: inch\n")).substr(0, 21),
            "2:1: this is no line ");
  EXPECT_EQ(only_error(read_as(folder, head + "t_host,t_device,x,tool\n")),
            "6:1: the columns are axes, but the head says joints");
  EXPECT_EQ(only_error(read_as(folder, "# kerf-recording/1\n" + std::string(kColumns))),
            "2:0: the head has no line '# coordinates: '");
  LogSettings settings;
  settings.format = LogFormat::kRecording;
  EXPECT_EQ(only_error(read_as(folder, "t,x\n", settings)),
            "1:1: the first line has to be '# kerf-recording/1'");
}

/// Twenty rows, 10 ms apart as received; the device's clock is `device_ms`.
std::string recording_of(const std::vector<int>& device_ms) {
  std::string text = std::string(kHead) + kColumns;
  for (std::size_t i = 0; i < device_ms.size(); ++i) {
    text += fmt::format("1772357400.{:03}000000,{}.{:03}000000,{},1,1,-,-\n", 10 * i,
                        device_ms[i] / 1000, device_ms[i] % 1000, i);
  }
  return text + fmt::format("# end samples={}\n", device_ms.size());
}

TEST(RecordingLog, GoesOnWhereTheDevicesClockStands) {
  const TestFolder folder;
  // It stands from the 21st row on, goes on at the 41st as if it had not stood, or from there.
  for (const int behind_ms : {0, 200}) {
    std::vector<int> device_ms;
    for (int i = 0; i < 60; ++i) {
      device_ms.push_back(i < 20 ? 10 * i : i < 40 ? 190 : 10 * i - behind_ms);
    }
    const ReadLog log = read_as(folder, recording_of(device_ms));
    ASSERT_EQ(log.samples.size(), 60U);
    for (std::size_t i = 0; i < 60; ++i) {
      EXPECT_EQ(log.samples[i].device_ns, static_cast<std::int64_t>(i) * 10'000'000) << i;
      EXPECT_EQ(log.samples[i].position[0], static_cast<double>(i));
    }
    EXPECT_EQ(log.status.standing, 20U);
    EXPECT_EQ(log.status.duplicates, 0U);
    EXPECT_EQ(all_text(log.notes).find("the device's clock stands still") != std::string::npos,
              true);
  }
}

TEST(RecordingLog, ABurstWithOneStampIsNoClockThatStands) {
  const TestFolder folder;
  // Held up and stamped at once, five and five; and a clock of 50 ms.
  std::vector<int> device_ms;
  for (int i = 0; i < 60; ++i) device_ms.push_back(50 * (i / 5));
  const ReadLog log = read_as(folder, recording_of(device_ms));
  ASSERT_EQ(log.samples.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(log.samples[i].device_ns, static_cast<std::int64_t>(i) * 10'000'000) << i;
  }
  EXPECT_EQ(log.status.standing, 0U);
  EXPECT_EQ(all_text(log.notes), "");
  EXPECT_EQ(log.status.trouble, "");
}

TEST(CsvLog, GoesOnWhereItsClockStandsAndSaysSo) {
  const TestFolder folder;
  std::string text = "t,x\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{},{}\n", std::min(i, 49), i);
  const ReadLog log = read_as(folder, text);
  EXPECT_EQ(log.samples.size(), 100U) << "positions are known, if not their times";
  EXPECT_EQ(log.status.standing, 50U);
  // A machine that stands, logged twice.
  const ReadLog twice = read_as(folder, "t,x\n1,1\n1,1\n2,2\n2,2\n");
  EXPECT_EQ(twice.samples.size(), 2U);
  EXPECT_EQ(twice.status.duplicates, 2U);
  EXPECT_EQ(twice.status.standing, 0U);
}

TEST(RecordingLog, HasItsTimesAsRecorded) {
  const TestFolder folder;
  const ReadLog log = read_as(folder, std::string(kHead) + kColumns +
                                          "1772357400.000000001,-0.000000001,1,1,1,-,-\n"
                                          ",0.000000001,2,1,1,-,-\n"
                                          "# lost 7\n"
                                          "1772357401.000000000,,3,1,1,-,-\n"
                                          "# end samples=3\n");
  ASSERT_EQ(log.samples.size(), 3U) << all_text(log.errors) << all_text(log.notes);
  EXPECT_EQ(log.samples[0].host_ns, 1'772'357'400'000'000'001);
  EXPECT_EQ(log.samples[0].device_ns, -1);
  EXPECT_EQ(log.samples[1].host_ns, AxisSample::kNoTime);
  EXPECT_EQ(log.samples[2].device_ns, AxisSample::kNoTime);
  EXPECT_EQ(log.status.lost, 7U);
  EXPECT_EQ(log.status.trouble, "");
}

TEST(RecordingLog, NoticesWhatItsEndLineDoesNotTell) {
  const TestFolder folder;
  const std::string row = "1.000000000,,1,1,1,-,-\n";
  const ReadLog less = read_as(folder, kHead + (kColumns + row) + "# end samples=2\n");
  EXPECT_NE(less.status.trouble.find("the end line says 2 samples, 1 could be read"),
            std::string::npos);
  const ReadLog more =
      read_as(folder, kHead + (kColumns + row) + "# end samples=1\n2.000000000,,1,1,1,-,-\n");
  EXPECT_EQ(more.samples.size(), 1U);
  EXPECT_EQ(more.status.errors, 1U);
}

// ---- halsampler

LogSettings sampler_settings(std::vector<std::string> pins) {
  LogSettings settings;
  settings.pins = std::move(pins);
  return settings;
}

const std::vector<std::string> kSomePins{"joint.0.pos-fb", "spindle.0.on",
                                         "iocontrol.0.tool-number", "motion.program-line"};

TEST(HalsamplerLog, ReadsNumberedLines) {
  const TestFolder folder;
  const ReadLog log = read_as(folder,
                              "5 1.500000 1 2 17 \n"
                              "6 2.500000 1 2 17 \n"
                              "overrun\n"
                              "10 3.500000 0 2 18 \n"
                              "10 3.500000 0 2 18 \n"
                              "9 3.500000 0 2 18 \n"
                              "11 4.5 0 2 18 \n",
                              sampler_settings(kSomePins));
  ASSERT_EQ(log.samples.size(), 4U) << all_text(log.errors) << all_text(log.notes);
  EXPECT_EQ(log.samples[0].device_ns, 5'000'000);
  EXPECT_EQ(log.samples[0].position[0], 1.5);
  EXPECT_EQ(log.samples[0].tool, 2);
  EXPECT_EQ(log.samples[2].line, 18);
  EXPECT_EQ(log.samples[2].device_ns, 10'000'000);
  EXPECT_EQ(log.status.lost, 3U);
  EXPECT_EQ(log.status.duplicates, 1U);
  EXPECT_EQ(log.status.disordered, 1U);
  EXPECT_EQ(log.contents.format, LogFormat::kHalsampler);
  EXPECT_EQ(log.contents.kind, CoordinateKind::kJoints);
  ASSERT_EQ(log.notes.size(), 1U);
  EXPECT_EQ(log.notes[0].message, "pins not read: spindle.0.on");
}

TEST(HalsamplerLog, CountsLinesWithoutNumbers) {
  const TestFolder folder;
  LogSettings settings = sampler_settings(kSomePins);
  settings.period_s = 0.01;
  const ReadLog log = read_as(folder, "1 0 2 3 \n2 0 2 3 \noverrun\n3 0 2 3 \n", settings);
  ASSERT_EQ(log.samples.size(), 3U);
  EXPECT_EQ(log.samples[2].device_ns, 20'000'000);
  EXPECT_EQ(log.samples[2].position[0], 3.0);
  EXPECT_EQ(log.status.lost, 1U);
}

TEST(HalsamplerLog, SaysWhatIsMissing) {
  const TestFolder folder;
  EXPECT_EQ(only_error(read_as(folder, "0 1.0 2.0 3.0 \n")),
            "1:1: these are halsampler's numbers, and which pins they are is not said");
  EXPECT_EQ(only_error(read_as(folder, "0 1.0 2.0 \n", sampler_settings(kSomePins))),
            "1:1: 3 values found; 4 pins are given, so 4 are allowed, or 5 with the sample number "
            "of halsampler -t");
  const ReadLog useless = read_as(folder, "0 1.0\n", sampler_settings({"motion.current-vel"}));
  EXPECT_EQ(only_error(useless),
            "0:0: source.pins: none of the columns is a position; found: motion.current-vel");
  const ReadLog damaged = read_as(folder,
                                  "0 1 1 2 3 \n1 1 1 2 \nx 1 1 2 3 \n2 1 1 2 3 4\n"
                                  "3 y 1 2 3\n4 1 1 2 3 \n",
                                  sampler_settings(kSomePins));
  EXPECT_EQ(damaged.samples.size(), 2U);
  EXPECT_EQ(damaged.status.errors, 4U);
}

TEST(HalFile, NamesThePinsOfASampler) {
  Diagnostics diagnostics;
  const auto pins = pins_from_hal_text(
      "# net no no.pin => sampler.0.pin.9\n"
      "loadrt sampler depth=1000,1000 cfg=fffffffb,ff\n"
      "addf sampler.0 servo-thread\n"
      "net a joint.0.pos-fb => sampler.0.pin.0\n"
      "net b => sampler.0.pin.1\n"
      "net b <= joint.1.pos-fb\n"
      "net c sampler.0.pin.2 <= joint.2.pos-fb  # words\n"
      "net d other.in sampler.0.pin.3\r\n"
      "net d spindle.0.speed-out => \\\n"
      "   something.in\n"
      "linksp e sampler.0.pin.4\n"
      "linkps motion.program-line e\n"
      "linkps motion.tooloffset.z => f\n"
      "linksp f => sampler.0.pin.5\n"
      "net Xpos => sampler.0.pin.6\n"
      "net other joint.3.pos-fb => sampler.1.pin.0\n",
      "s.hal", 0, diagnostics);
  EXPECT_EQ(all_text(diagnostics), "");
  EXPECT_EQ(pins, (std::vector<std::string>{"joint.0.pos-fb", "joint.1.pos-fb", "joint.2.pos-fb",
                                            "spindle.0.speed-out", "motion.program-line",
                                            "motion.tooloffset.z", "signal Xpos", ""}));
}

TEST(HalFile, TellsChannelsApart) {
  Diagnostics diagnostics;
  const auto pins = pins_from_hal_text(
      "loadrt sampler cfg=f,ff\nnet a joint.0.pos-fb => sampler.0.pin.0 sampler.1.pin.1\n", "s.hal",
      1, diagnostics);
  EXPECT_EQ(all_text(diagnostics), "");
  EXPECT_EQ(pins, (std::vector<std::string>{"", "joint.0.pos-fb"}));
}

TEST(HalFile, SaysWhatIsWrong) {
  Diagnostics diagnostics;
  EXPECT_TRUE(pins_from_hal_text("net a b => c\n", "s.hal", 0, diagnostics).empty());
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].message, "nothing is connected to sampler.0.pin.N here");
  diagnostics.clear();
  EXPECT_TRUE(pins_from_hal_text("loadrt sampler cfg=f\nnet a b => sampler.0.pin.1\n", "s.hal", 0,
                                 diagnostics)
                  .empty());
  EXPECT_EQ(to_string(diagnostics.at(0)),
            "s.hal:2:12: error: sampler.0.pin.1: cfg= gives channel 0 only 1 pins\n");
  diagnostics.clear();
  EXPECT_TRUE(pins_from_hal_text("net a b => sampler.0.pin.x\n", "s.hal", 0, diagnostics).empty());
  EXPECT_EQ(diagnostics.at(0).line, 1);
  diagnostics.clear();
  EXPECT_TRUE(pins_from_hal_file("/nowhere/s.hal", 0, diagnostics).empty());
  EXPECT_EQ(diagnostics.size(), 1U);
}

// ---- candump

LogSettings can_settings() {
  LogSettings settings;
  settings.can_map.emplace();
  settings.can_map->axes[0] = cia402_position(1, 0.001);
  settings.can_map->axes[1] = cia402_position(2, 0.001);
  return settings;
}

TEST(CandumpLog, GathersFramesToSamples) {
  const TestFolder folder;
  const ReadLog log = read_as(folder,
                              "(100.000100) can0 080#\n"
                              "(100.000200) can0 381#3706E8030000\n"
                              "(100.000300) can0 382#37060000FFFF R\n"
                              "(100.010200) can0 381#3706D0070000\n"
                              "(100.010300) can0 20000004#0000000000000000\n"
                              "(100.010300) can0 382#3706\n"
                              "rubbish\n"
                              "(100.010400) can0 382#370600000000\n"
                              "(100.010400) can0 382#R4\n"
                              "(100.005000) can0 382#370600000000\n"
                              "(100.020200) can0 381#3706B80B0000",
                              can_settings());
  ASSERT_TRUE(log.is_open) << all_text(log.errors);
  ASSERT_EQ(log.samples.size(), 3U) << all_text(log.notes);
  EXPECT_EQ(log.samples[0].device_ns, 100'000'300'000);
  EXPECT_EQ(log.samples[0].position[0], 1.0);
  EXPECT_EQ(log.samples[0].position[1], -65.536);
  EXPECT_EQ(log.samples[1].position[0], 2.0);
  EXPECT_EQ(log.samples[1].position[1], 0.0);
  EXPECT_EQ(log.samples[2].position[0], 3.0);
  EXPECT_EQ(log.samples[2].fresh, 0b01);
  EXPECT_EQ(log.samples[2].known, 0b11);
  EXPECT_EQ(log.status.errors, 2U);
  EXPECT_EQ(log.status.disordered, 1U);
  EXPECT_EQ(log.contents.format, LogFormat::kCandump);
  EXPECT_FALSE(log.contents.kind);
  EXPECT_EQ(log.contents.positions, 0b11);
}

TEST(CandumpLog, SaysThatTheMapIsOfAnotherBus) {
  const TestFolder folder;
  std::string text;
  for (int i = 0; i < 3; ++i) text += fmt::format("(1.{:06}) can0 181#0000\n", i);
  text += "(2.0) can0 00000381#370600000000\n";
  const ReadLog log = read_as(folder, text, can_settings());
  EXPECT_TRUE(log.samples.empty());
  EXPECT_EQ(log.status.trouble,
            folder.file("log") +
                ": none of the 4 frames has an id of the map (0x381, 0x382); the log has 0x181 "
                "(3x), 0x00000381 (extended) (1x)");
  // A long log says so before its end.
  text.clear();
  for (int i = 0; i < 10'000; ++i) text += fmt::format("(1.{:06}) can0 181#0000\n", i);
  text += "(2.0) can0 381#370600000000\n";
  const ReadLog late = read_as(folder, text, can_settings());
  EXPECT_NE(late.status.trouble.find("none of the 10000 frames"), std::string::npos);
  EXPECT_EQ(late.samples.size(), 1U);
}

TEST(CandumpLog, KeepsInterfacesApart) {
  const TestFolder folder;
  const std::string text =
      "(1.0) can0 381#3706E8030000\n(1.001) can0 382#370600000000\n"
      "(1.5) can1 381#3706D0070000\n(1.501) can1 382#370600000000\n";
  const ReadLog both = read_as(folder, text, can_settings());
  EXPECT_EQ(both.samples.size(), 2U);
  EXPECT_EQ(both.status.trouble,
            folder.file("log") +
                ": frames of the map come from can0 and from can1; source.interface chooses one");
  LogSettings settings = can_settings();
  settings.can_interface = "can1";
  const ReadLog one = read_as(folder, text, settings);
  ASSERT_EQ(one.samples.size(), 1U);
  EXPECT_EQ(one.samples[0].position[0], 2.0);
  EXPECT_EQ(one.status.trouble, "");
}

TEST(CandumpLog, SaysWhatIsMissing) {
  const TestFolder folder;
  EXPECT_EQ(only_error(read_as(folder, "(1.0) can0 381#00\n")),
            "1:1: this is a log of candump, and what its frames mean is not said");
  LogSettings settings = can_settings();
  settings.format = LogFormat::kCandump;
  const ReadLog screen = read_as(folder, " (1.0)  can0  381   [2]  37 06\n", settings);
  EXPECT_EQ(only_error(screen).substr(0, 5), "1:15:");
  EXPECT_NE(screen.errors[0].hint.find("candump -L"), std::string::npos);
}

// ---- settings, pipes

TEST(LogSettings, SayAllTheirFaults) {
  LogSettings settings;
  settings.path = "a";
  EXPECT_TRUE(validate(settings).empty());
  settings.path = "";
  settings.period_s = std::nan("");
  settings.rotary_joints = 0x200;
  settings.format = LogFormat::kCsv;
  settings.pins = {"x"};
  settings.can_map.emplace();
  settings.can_map->gather_ms = -1;
  const auto faults = validate(settings);
  EXPECT_GE(faults.size(), 6U);
  Diagnostics diagnostics;
  EXPECT_EQ(LogSource::open(settings, diagnostics), nullptr);
  EXPECT_EQ(diagnostics.size(), faults.size());
  settings = {};
  settings.path = "a";
  settings.format = LogFormat::kHalsampler;
  EXPECT_EQ(validate(settings).size(), 1U);
  settings.format = LogFormat::kCandump;
  EXPECT_EQ(validate(settings).size(), 1U);
}

TEST(NumberText, TimesAreExact) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  struct Case {
    const char* text;
    std::int64_t unit_ns;
    std::int64_t expected_ns;
  };
  for (const Case& one : {Case{"1772357400.000000123", kSecond, 1'772'357'400'000'000'123},
                          Case{"-0.000000001", kSecond, -1}, Case{".5", kSecond, 500'000'000},
                          Case{"5.", kSecond, 5'000'000'000}, Case{"+7", 1, 7},
                          Case{"1.0000000015", kSecond, 1'000'000'002},
                          Case{"1.00000000149999", kSecond, 1'000'000'001},
                          Case{"12.3456", 1000, 12'346}, Case{"1.5e3", 1'000'000, 1'500'000'000},
                          Case{"9223372036.854775807", kSecond, 9'223'372'036'854'775'807}}) {
    std::int64_t time_ns = 0;
    ASSERT_TRUE(parse_stamp(one.text, one.unit_ns, time_ns)) << one.text;
    EXPECT_EQ(time_ns, one.expected_ns) << one.text;
  }
  std::int64_t time_ns = 0;
  for (const char* text : {"", "-", ".", "+-1", "--1", "1 2", "1.2.3", "1x", "nan", "1e300",
                           "9223372036.854775808", "99999999999999999999", "0x10"}) {
    EXPECT_FALSE(parse_stamp(text, kSecond, time_ns)) << text;
  }
}

TEST(LogSource, ReadsStandardInput) {
  const TestFolder folder;
  const int before = ::dup(STDIN_FILENO);
  const int file = ::open(folder.write("log", "t,x\n1,5\n").c_str(), O_RDONLY);
  ASSERT_EQ(::dup2(file, STDIN_FILENO), STDIN_FILENO);
  const ReadLog log = read_file("-");
  if (before >= 0) ::dup2(before, STDIN_FILENO);
  ::close(before);
  ::close(file);
  ASSERT_EQ(log.samples.size(), 1U) << all_text(log.errors);
  EXPECT_EQ(log.samples[0].position[0], 5.0);
}

TEST(LogSource, WaitsForAPipe) {
  const TestFolder folder;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const auto say = [&](const std::string& text) {
    ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  };
  say("t,x\n1,");
  LogSettings settings;
  settings.path = fmt::format("/proc/self/fd/{}", ends[0]);
  Diagnostics diagnostics;
  const auto source = LogSource::open(settings, diagnostics);
  ASSERT_NE(source, nullptr) << all_text(diagnostics);
  AxisSample sample;
  EXPECT_EQ(source->next(sample, std::chrono::milliseconds{1}), PositionSource::Next::kNothing);
  say("5\n2,6\n");
  EXPECT_EQ(source->next(sample, std::chrono::seconds{10}), PositionSource::Next::kSample);
  EXPECT_EQ(sample.position[0], 5.0);
  EXPECT_EQ(source->next(sample, std::chrono::milliseconds{0}), PositionSource::Next::kSample);
  EXPECT_EQ(source->next(sample, std::chrono::milliseconds{0}), PositionSource::Next::kNothing);
  ::close(ends[1]);
  EXPECT_EQ(source->next(sample, std::chrono::seconds{10}), PositionSource::Next::kEnd);
  EXPECT_EQ(source->status().state, SourceState::kEnded);
  ::close(ends[0]);
}

}  // namespace
}  // namespace kerf
