// HalSource against a kerf-hal with faults. The live test has the real one.
#include "machine_io/hal/hal_source.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/translate.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Next = PositionSource::Next;

/// Long enough for any loaded computer; what is waited for comes much sooner.
constexpr milliseconds kLong{20000};

class HalSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "hal_source.XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    setenv("FAKE_KERF_HAL_STARTS", (folder_ / "starts").c_str(), 1);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  HalSource make(const char* mode, HalSettings settings = {}) {
    setenv("FAKE_KERF_HAL_MODE", mode, 1);
    settings.kerf_hal_path = FAKE_KERF_HAL;
    return HalSource(settings);
  }

  std::uintmax_t starts() const {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(folder_ / "starts", error);
    return error ? 0 : size;
  }

  /// Samples until `until` holds of the source; their number.
  template <class Until>
  int read_until(HalSource& source, Until until) {
    const auto deadline = steady_clock::now() + kLong;
    AxisSample sample;
    int samples = 0;
    while (!until() && steady_clock::now() < deadline) {
      const Next next = source.next(sample, milliseconds(20));
      if (next == Next::kEnd) break;
      if (next == Next::kSample) ++samples;
    }
    EXPECT_TRUE(until()) << source.status().trouble;
    return samples;
  }

  /// The first three records are good, then something makes the source start kerf-hal again.
  void expect_error_after_three(const char* mode, const std::string& trouble) {
    HalSource source = make(mode);
    EXPECT_EQ(read_until(source, [&] { return source.status().errors == 1; }), 3);
    EXPECT_EQ(source.status().trouble, trouble);
    EXPECT_EQ(source.status().state, SourceState::kConnecting);
    read_until(source, [&] { return source.status().reconnects == 1; });
    EXPECT_EQ(starts(), 2u);
  }

  std::filesystem::path folder_;
};

TEST(HalSettings, AreValidated) {
  EXPECT_EQ(validate(HalSettings{}), std::vector<std::string>{});
  HalSettings settings;
  settings.rate_hz = 0;
  settings.kerf_hal_path = "/nowhere/kerf-hal";
  settings.mm_per_unit = 10;
  settings.rotary_joints = 0x208;
  EXPECT_EQ(validate(settings),
            (std::vector<std::string>{
                "source.rate_hz: 0 found, 1 to 1000 allowed (readings per second)",
                "source.mm_per_unit: 10 found, 1 (mm) or 25.4 (inch) allowed",
                "source.rotary_joints: bits 0x208 found, joints 0 to 8 allowed",
                "source.kerf_hal_path: /nowhere/kerf-hal found, the path of an executable "
                "kerf-hal allowed"}));
  settings = {};
  settings.rate_hz = std::nan("");
  EXPECT_EQ(validate(settings).size(), 1u);
}

TEST_F(HalSourceTest, GivesEveryRecordInItsOrder) {
  HalSource source = make("flood");
  AxisSample sample;
  for (int n = 0; n < 5000; ++n) {
    ASSERT_EQ(source.next(sample, kLong), Next::kSample);
    ASSERT_EQ(sample.position[0], n);
  }
  EXPECT_EQ(sample.position[1], 4999.125);
  EXPECT_EQ(sample.position[2], 4999.25);
  EXPECT_EQ(sample.known, 0b111);
  EXPECT_EQ(sample.fresh, 0b111);
  EXPECT_EQ(sample.tool, 3);
  EXPECT_EQ(sample.line, 12);
  EXPECT_EQ(sample.tool_offset_z_mm, 35.0);
  EXPECT_EQ(sample.spindle_rpm, -1200.0);
  EXPECT_EQ(sample.host_ns, 1'700'000'004'999'000'000);
  EXPECT_EQ(sample.device_ns, 9'999'000'000);
  EXPECT_EQ(source.last_record().velocity, 50.0);
  EXPECT_EQ(source.status().samples, 5000u);
  EXPECT_EQ(source.status().lost, 0u);
  EXPECT_EQ(source.status().errors, 0u);
  EXPECT_EQ(source.status().state, SourceState::kReading);
  EXPECT_EQ(source.status().trouble, "");
  EXPECT_EQ(source.describe(), "LinuxCNC's HAL at 100 Hz");
}

TEST_F(HalSourceTest, PutsPiecesTogether) {
  HalSource source = make("slow");
  AxisSample sample;
  for (int n = 0; n < 20; ++n) {
    ASSERT_EQ(source.next(sample, kLong), Next::kSample);
    ASSERT_EQ(sample.position[0], n);
  }
}

TEST_F(HalSourceTest, InchesBecomeMillimetresAndDegreesStay) {
  HalSettings settings;
  settings.mm_per_unit = 25.4;
  settings.rotary_joints = 0b100;
  HalSource source = make("gap", settings);
  AxisSample sample;
  for (int n = 0; n < 2; ++n) ASSERT_EQ(source.next(sample, kLong), Next::kSample);
  EXPECT_DOUBLE_EQ(sample.position[0], 25.4);
  EXPECT_DOUBLE_EQ(sample.position[1], 1.125 * 25.4);
  EXPECT_DOUBLE_EQ(sample.position[2], 1.25);
  EXPECT_DOUBLE_EQ(sample.tool_offset_z_mm, 35 * 25.4);
}

TEST_F(HalSourceTest, WhatIsAbsentIsNotKnown) {
  HalSource source = make("strange");
  AxisSample sample;
  ASSERT_EQ(source.next(sample, kLong), Next::kSample);
  EXPECT_EQ(sample.known, 0b101);
  EXPECT_EQ(sample.tool, AxisSample::kUnknown);
  EXPECT_EQ(sample.line, AxisSample::kUnknown);
  EXPECT_TRUE(std::isnan(sample.tool_offset_z_mm));
  EXPECT_TRUE(std::isnan(sample.spindle_rpm));
}

TEST_F(HalSourceTest, CountsGapsAsLost) {
  HalSource source = make("gap");
  EXPECT_EQ(read_until(source, [&] { return source.status().samples == 4; }), 4);
  EXPECT_EQ(source.status().lost, 6u);
  EXPECT_EQ(source.status().errors, 0u);
}

TEST_F(HalSourceTest, StartsAgainAfterATornRecord) {
  expect_error_after_three("torn", "kerf-hal ended in the middle of a record");
}

TEST_F(HalSourceTest, StartsAgainAfterGarbage) {
  expect_error_after_three("garbage", "kerf-hal sent not a record (wrong first four bytes)");
}

TEST_F(HalSourceTest, StartsAgainWhenTheOrderIsBroken) {
  expect_error_after_three("back", "kerf-hal sent a record older than the one before");
}

TEST_F(HalSourceTest, StartsAgainWhenTimeGoesBack) {
  expect_error_after_three("clock-back", "kerf-hal sent a record older than the one before");
}

TEST_F(HalSourceTest, StartsAgainAfterADeath) {
  expect_error_after_three("killed", "kerf-hal was ended by signal 9 (Killed)");
}

TEST_F(HalSourceTest, AnotherVersionIsTheEnd) {
  for (const auto& [mode, fault] : {std::pair("version", "a record of another version"),
                                    std::pair("length", "a record of another length")}) {
    HalSource source = make(mode);
    EXPECT_EQ(read_until(source, [&] { return source.status().state == SourceState::kFailed; }), 3);
    EXPECT_EQ(source.status().trouble,
              std::string("kerf-hal sent ") + fault + ": kerf and kerf-hal must be of one version");
    AxisSample sample;
    EXPECT_EQ(source.next(sample, milliseconds(0)), Next::kEnd);
  }
}

TEST_F(HalSourceTest, AKerfHalThatKnowsNoRateIsTheEnd) {
  HalSource source = make("usage");
  read_until(source, [&] { return source.status().state == SourceState::kFailed; });
  EXPECT_EQ(source.status().trouble,
            "kerf-hal does not understand kerf (unknown argument --rate): both must be of one "
            "version");
}

TEST_F(HalSourceTest, NoExecutableIsTheEnd) {
  HalSettings settings;
  settings.kerf_hal_path = "/nowhere/kerf-hal";
  HalSource source(settings);
  AxisSample sample;
  EXPECT_EQ(source.next(sample, kLong), Next::kEnd);
  EXPECT_EQ(source.status().state, SourceState::kFailed);
  EXPECT_EQ(source.status().trouble, "/nowhere/kerf-hal is no executable file");
}

TEST_F(HalSourceTest, WaitsForALinuxCnc) {
  HalSource source = make("none");
  read_until(source, [&] { return starts() >= 3; });
  EXPECT_EQ(source.status().state, SourceState::kConnecting);
  EXPECT_EQ(source.status().trouble, "no LinuxCNC runs on this computer");
  EXPECT_EQ(source.status().errors, 0u);
}

TEST_F(HalSourceTest, ComesBackWithLinuxCnc) {
  HalSource source = make("linuxcnc-restarts");
  EXPECT_EQ(read_until(source,
                       [&] {
                         return source.status().state == SourceState::kConnecting &&
                                source.status().samples == 3;
                       }),
            3);
  EXPECT_EQ(source.status().trouble, "LinuxCNC has ended (it asked kerf-hal to end)");
  // The first sample behind it says so, and no other.
  std::vector<bool> restarted;
  AxisSample sample;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (source.status().samples <= 10 && std::chrono::steady_clock::now() < end) {
    if (source.next(sample, std::chrono::milliseconds(50)) != PositionSource::Next::kSample) {
      continue;
    }
    restarted.push_back(sample.restarted);
  }
  ASSERT_GE(restarted.size(), 2U);
  EXPECT_TRUE(restarted[0]);
  EXPECT_EQ(std::count(restarted.begin(), restarted.end(), true), 1);
  EXPECT_EQ(source.status().reconnects, 1u);
  EXPECT_EQ(source.status().errors, 0u);
  EXPECT_EQ(source.status().trouble, "");
  EXPECT_EQ(starts(), 3u);
}

TEST_F(HalSourceTest, ARefusalIsAnErrorAndTriedAgain) {
  HalSource source = make("refused");
  read_until(source, [&] { return source.status().errors == 2; });
  EXPECT_EQ(source.status().trouble, "HAL's shared memory is full");
}

/// kerf-hal speaks English; its words are looked up where they are shown.
TEST_F(HalSourceTest, SaysWhatKerfHalSaysInTheLanguageInUse) {
  setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
  ASSERT_TRUE(use_language("de"));
  {
    HalSource source = make("none");
    read_until(source, [&] { return starts() >= 2; });
    EXPECT_EQ(source.status().trouble, "auf diesem Rechner läuft kein LinuxCNC");
  }
  {
    HalSource source = make("version");
    read_until(source, [&] { return source.status().state == SourceState::kFailed; });
    EXPECT_EQ(source.status().trouble,
              "von kerf-hal kam ein Datensatz einer anderen Version: kerf und kerf-hal müssen "
              "dieselbe Version haben");
  }
  {
    HalSource source = make("old-kerf");
    read_until(source, [&] { return !source.status().trouble.empty(); });
    EXPECT_EQ(source.status().trouble,
              "über stdin kam ein Datensatz einer anderen Version; die Pins kerf.* bleiben "
              "veraltet");
  }
  use_language("en");
}

/// So that kerf finds them again in what comes: no text is the beginning of another one.
TEST(HalMessageTest, TextsAreToldApart) {
  for (int i = 0; i < static_cast<int>(HalMessage::kCount_); ++i) {
    const HalTextParts one = parts_of(static_cast<HalMessage>(i));
    EXPECT_FALSE(one.before.empty());
    for (int j = 0; j < static_cast<int>(HalMessage::kCount_); ++j) {
      if (i == j) continue;
      const HalTextParts other = parts_of(static_cast<HalMessage>(j));
      EXPECT_FALSE(other.before.starts_with(one.before)) << one.before << " / " << other.before;
    }
  }
}

TEST_F(HalSourceTest, PausesGrowBetweenAttempts) {
  HalSource source = make("refused");
  const auto begin = steady_clock::now();
  read_until(source, [&] { return source.status().errors == 3; });
  EXPECT_GE(steady_clock::now() - begin, HalSource::kShortestPause * 3);
}

TEST_F(HalSourceTest, SilenceEndsIt) {
  HalSource source = make("silent");
  read_until(source, [&] { return source.status().errors == 1; });
  EXPECT_EQ(source.status().trouble, "kerf-hal has been silent for 5 s");
}

TEST_F(HalSourceTest, SaysThatThePinsAreAnothers) {
  HalSource source = make("taken");
  read_until(source, [&] { return source.status().samples == 1; });
  read_until(source, [&] { return !source.status().trouble.empty(); });
  EXPECT_EQ(source.status().trouble, "the pins kerf.* are those of another component");
  EXPECT_NE(source.last_record().on & kHalPinsTaken, 0u);
}

TEST_F(HalSourceTest, PassesStatusDown) {
  HalSource source = make("echo");
  AxisSample sample;
  ASSERT_EQ(source.next(sample, kLong), Next::kSample);
  HalStatus status;
  status.collision_seconds = 2.5;
  status.off_path_mm = 0.75;
  status.finding_line = 41;
  status.collision_ahead = true;
  status.stale = true;
  source.show(status);
  ASSERT_EQ(source.next(sample, kLong), Next::kSample);
  EXPECT_EQ(sample.position[0], 2.5);
  EXPECT_EQ(sample.position[1], 0.75);
  EXPECT_EQ(sample.position[2], 101);
  EXPECT_EQ(sample.line, 41);
  ASSERT_EQ(source.next(sample, kLong), Next::kSample);
  // Said once, sent once: the next word must be a new one, or the pins would never be stale.
  EXPECT_EQ(source.next(sample, milliseconds(50)), Next::kNothing);
  source.show(HalStatus{});
  ASSERT_EQ(source.next(sample, kLong), Next::kSample);
  EXPECT_EQ(sample.position[0], kNoCollisionSeconds);
  EXPECT_EQ(sample.position[2], 0);
}

TEST_F(HalSourceTest, NoPatienceStillReads) {
  HalSource source = make("good");
  AxisSample sample;
  const auto deadline = steady_clock::now() + kLong;
  int samples = 0;
  while (samples < 10 && steady_clock::now() < deadline) {
    if (source.next(sample, milliseconds(0)) == Next::kSample) ++samples;
  }
  EXPECT_EQ(samples, 10);
}

TEST_F(HalSourceTest, AClosedStderrCostsNothing) {
  HalSource source = make("mute");
  rusage before{};
  rusage after{};
  getrusage(RUSAGE_SELF, &before);
  read_until(source, [&] { return source.status().samples == 50; });
  getrusage(RUSAGE_SELF, &after);
  const auto used_us = [](const rusage& usage) {
    return (usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) * 1'000'000 + usage.ru_utime.tv_usec +
           usage.ru_stime.tv_usec;
  };
  // 50 samples take one second of waiting; a loop that spins would use most of it.
  EXPECT_LT(used_us(after) - used_us(before), 300'000);
}

TEST_F(HalSourceTest, OneThatDoesNotEndIsKilled) {
  const auto begin = steady_clock::now();
  {
    HalSource source = make("stubborn");
    read_until(source, [&] { return source.status().samples == 3; });
  }
  EXPECT_LT(steady_clock::now() - begin, kLong);
}

}  // namespace
}  // namespace kerf
