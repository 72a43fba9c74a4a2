#include "twin/program/shared_reading.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "tests/twin/process/motions.h"
#include "twin/program/motion_archive.h"

namespace kerf {
namespace {

/// `count` motions of many kinds.
std::vector<Motion> many(std::size_t count) {
  MotionList list;
  list.at({0, 0, 5}).tool(1).spindle(true).feed_rate(600);
  for (std::size_t i = 0; list.list().size() < count; ++i) {
    const double x = 0.1 * static_cast<double>(i);
    list.feed({x, -x, -1});
    if (i % 7 == 3) list.arc({x + 2, -x, -1}, {x + 1, -x, -1}, {0, 0, 1}, kPi);
    if (i % 50 == 9) list.tool(1 + static_cast<int>(i % 3)).dwell(0.5);
  }
  std::vector<Motion> motions = list.list();
  motions.resize(count);
  motions[1].start_known = false;
  motions[count / 2].torch.analog[1] = 0.25F;
  motions[count / 2].to_abc_deg = {-0.0, 90, 1e-300};
  return motions;
}

bool same(const std::vector<Motion>& a, const std::vector<Motion>& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(Motion)) != 0) return false;
  }
  return a.size() == b.size();
}

/// Hands out motions, thirty at a time, and counts how often it is run.
class CountedProgram final : public Program {
 public:
  CountedProgram(std::vector<Motion> motions, std::atomic<int>& starts)
      : motions_(std::move(motions)), starts_(starts) {}
  const std::vector<ProgramComment>& comments() const override { return comments_; }
  double progress() const override { return -1; }
  ProgramSummary run(const MotionSink& sink, std::stop_token stop, Diagnostics& said) override {
    ++starts_;
    ProgramSummary summary;
    for (std::size_t at = 0; at < motions_.size(); at += 30) {
      const std::size_t count = std::min<std::size_t>(30, motions_.size() - at);
      files_.resize(1 + at / 3000, "part.ngc");
      frame_.g5x_mm.x = static_cast<double>(at / 600);
      if (stop.stop_requested() || !sink(std::span<const Motion>(motions_).subspan(at, count))) {
        summary.stopped_early = true;
        break;
      }
    }
    summary.files = files_;
    summary.program_lines = 17;
    said.push_back({});
    return summary;
  }

 private:
  std::vector<Motion> motions_;
  std::atomic<int>& starts_;
  std::vector<ProgramComment> comments_;
};

struct Read {
  std::vector<Motion> motions;
  std::vector<double> frames;  ///< of each batch
  std::size_t files = 0;
  ProgramSummary summary;
  Diagnostics said;
};

/// All of it, or until there are `most` motions.
Read read(Program& program, std::size_t most = SIZE_MAX) {
  Read out;
  out.summary = program.run(
      [&](std::span<const Motion> motions) {
        out.motions.insert(out.motions.end(), motions.begin(), motions.end());
        out.frames.push_back(program.workpiece_frame().g5x_mm.x);
        out.files = program.files().size();
        return out.motions.size() < most;
      },
      {}, out.said);
  return out;
}

TEST(MotionArchive, AMotionComesOutBitForBitAsItWentIn) {
  const std::vector<Motion> motions = many(3000);
  MotionArchive archive;
  archive.append(std::span(motions).first(1000));
  archive.append(std::span(motions).subspan(1000));
  ASSERT_EQ(archive.size(), motions.size());
  MotionArchive::Reader reader(archive);
  std::vector<Motion> out;
  for (const std::size_t count : {1, 999, 0, 2000}) reader.take(count, out);
  EXPECT_TRUE(same(out, motions));
  EXPECT_LT(archive.bytes(), 150 * motions.size());
}

TEST(SharedReading, AllReadersHaveTheWholeProgramAndItIsReadOnce) {
  const std::vector<Motion> motions = many(20'000);
  std::atomic<int> starts = 0;
  CountedProgram alone(motions, starts);
  const Read wanted = read(alone);
  starts = 0;
  const auto reading =
      SharedReading::of(std::make_unique<CountedProgram>(motions, starts), nullptr);
  const auto first = reading->reader(), second = reading->reader();
  Read one, two;
  std::thread beside([&] { two = read(*second); });
  one = read(*first);
  beside.join();
  const auto later = reading->reader();
  const Read three = read(*later);
  for (const Read* got : std::array<const Read*, 3>{&one, &two, &three}) {
    EXPECT_TRUE(same(got->motions, motions));
    EXPECT_EQ(got->frames, wanted.frames) << "batch by batch";
    EXPECT_EQ(got->files, wanted.files);
    EXPECT_EQ(got->summary.program_lines, 17U);
    EXPECT_FALSE(got->summary.stopped_early);
    EXPECT_EQ(got->said.size(), 1U);
  }
  EXPECT_EQ(starts, 1);
}

TEST(SharedReading, TheInterpreterWaitsWhereNobodyReads) {
  const std::vector<Motion> motions = many(SharedReading::kAhead * 3);
  std::atomic<int> starts = 0;
  const auto reading =
      SharedReading::of(std::make_unique<CountedProgram>(motions, starts), nullptr);
  const auto waits = reading->reader();
  {
    const auto soon_done = reading->reader();
    EXPECT_TRUE(read(*soon_done, 100).summary.stopped_early);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  // A file more for each 3000 motions that it has given.
  EXPECT_LT(reading->files().size(), (SharedReading::kAhead + 10'000) / 3000 + 1);
  EXPECT_TRUE(same(read(*waits).motions, motions));
  EXPECT_EQ(starts, 1);
}

TEST(SharedReading, WhoIsTheLastToWantItEndsIt) {
  const std::vector<Motion> motions = many(SharedReading::kAhead * 3);
  std::atomic<int> starts = 0;
  const auto reading =
      SharedReading::of(std::make_unique<CountedProgram>(motions, starts), nullptr);
  const auto only = reading->reader();
  const Read part = read(*only, 100);
  EXPECT_TRUE(part.summary.stopped_early);
  EXPECT_EQ(part.summary.program_lines, 17U) << "what it has to say of the part";
  EXPECT_EQ(reading->reader(), nullptr) << "to be opened anew";
}

TEST(SharedReading, OfWhatIsTooLongEachReadsTheRestItself) {
  const std::vector<Motion> motions = many(10'000);
  std::atomic<int> starts = 0;
  const auto again = [&] { return std::make_unique<CountedProgram>(motions, starts); };
  const auto reading = SharedReading::of(again(), again, 4000);
  const auto first = reading->reader(), second = reading->reader();
  EXPECT_TRUE(same(read(*first).motions, motions));
  EXPECT_EQ(starts, 2);
  EXPECT_TRUE(same(read(*second).motions, motions));
  EXPECT_EQ(starts, 3);
}

}  // namespace
}  // namespace kerf
