#include "twin/live/live_session.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "tests/twin/live/listed_source.h"
#include "tests/twin/live/live_shop.h"
#include "twin/live/live_json.h"

namespace kerf {
namespace {

using namespace std::chrono_literals;

LiveOptions with_block() {
  LiveOptions options;
  options.blank = parse_blank("box:0,0,-10:40,40,0").value();
  options.stock.cell_mm = 0.1;
  options.tools.push_back(std::move(parse_tool_argument("1=flat:4").value()));
  options.speed = std::numeric_limits<double>::infinity();
  options.cutting.frame.tool_length = ToolLengthFrom::kNone;
  return options;
}

AxisSample at(double x, double y, double z, double t_s) {
  AxisSample sample;
  sample.set(0, x);
  sample.set(1, y);
  sample.set(2, z);
  sample.tool = 1;
  sample.device_ns = static_cast<std::int64_t>(std::llround(t_s * 1e9));
  return sample;
}

struct Told : LiveObserver {
  void on_status(const LiveStatus& status) override {
    if (states.empty() || states.back() != status.state) states.push_back(status.state);
    last = status;
    if (on_state) on_state(status);
  }
  void on_finding(const Finding& finding, const std::vector<std::string>&) override {
    findings.push_back(finding.id);
  }
  void on_warning(const AheadWarning&, const std::vector<std::string>&) override { ++warnings; }
  std::vector<LiveState> states;
  std::vector<FindingId> findings;
  int warnings = 0;
  LiveStatus last;
  std::function<void(const LiveStatus&)> on_state;
};

struct Watched {
  Outcome outcome = Outcome::kFailed;
  Diagnostics diagnostics;
  Told told;
  std::unique_ptr<LiveSession> session;

  Watched(LiveOptions options, std::unique_ptr<PositionSource> source, std::stop_token stop = {},
          std::function<void(const LiveStatus&)> on_state = {}) {
    told.on_state = std::move(on_state);
    session = LiveSession::open(std::move(options), std::move(source), diagnostics, outcome);
    if (!session) return;
    session->set_observer(&told);
    outcome = session->run(stop, diagnostics);
  }
  Report& report() { return session->report(); }
};

/// Where each point of a row along X was cut by.
std::vector<std::optional<CutLabel>> labels_along(const LiveSession& session, double y, double z) {
  std::vector<std::optional<CutLabel>> out;
  for (const double x : {12.0, 20.0, 28.0}) {
    const auto id = session.stock()->cut_id_at({x, y, z});
    out.push_back(id ? std::optional(session.cut_labels()[*id]) : std::nullopt);
  }
  return out;
}

TEST(LiveSession, FeedIsThatOfThePositionsWhileTheyAreFresh) {
  // 20 mm/s along X for a second, then 5 mm/s, a hundred samples a second; the tool table's length
  // does not matter.
  std::vector<AxisSample> samples;
  for (int i = 0; i <= 200; ++i) {
    const double t_s = 0.01 * i;
    samples.push_back(at(t_s <= 1 ? 5 + 20 * t_s : 25 + 5 * (t_s - 1), 20, 1, t_s));
  }
  double most = 0, last = 0;
  LiveOptions options = with_block();
  options.speed = 2;  // a status in a tenth of a second
  const Watched watched(std::move(options), std::make_unique<ListedSource>(samples), {},
                        [&](const LiveStatus& status) {
                          if (!status.feed_mm_per_min) return;
                          most = std::max(most, *status.feed_mm_per_min);
                          last = *status.feed_mm_per_min;
                        });
  ASSERT_EQ(watched.outcome, Outcome::kFinished);
  EXPECT_NEAR(most, 1200, 1e-6);
  EXPECT_NEAR(last, 300, 1e-6);
  EXPECT_FALSE(watched.told.last.feed_mm_per_min) << "it has ended: nothing goes on";
}

TEST(LiveSession, TheWorkpieceKnowsWhoCutIt) {
  // The way there by tool 1 in lines 4 and 5, back lower in line 5 again, and by nobody's line.
  std::vector<AxisSample> samples = {at(10, 20, 1, 0),    at(10, 20, -1, 0.1), at(16, 20, -1, 0.2),
                                     at(24, 20, -1, 0.3), at(30, 20, -1, 0.4), at(30, 20, -2, 0.5),
                                     at(24, 20, -2, 0.6)};
  const std::array<std::int32_t, 7> lines = {0, 4, 4, 5, 5, 0, 0};
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].line = lines[i];
  std::string digest;
  for (const bool keeps : {false, true}) {
    Diagnostics diagnostics;
    Outcome outcome = Outcome::kFailed;
    const auto session = LiveSession::open(with_block(), std::make_unique<ListedSource>(samples),
                                           diagnostics, outcome);
    ASSERT_TRUE(session);
    if (keeps) session->keep_cut_ids();
    ASSERT_EQ(session->run({}, diagnostics), Outcome::kFinished);
    if (!keeps) {
      digest = session->stock()->digest();
      EXPECT_TRUE(session->cut_labels().empty());
      continue;
    }
    EXPECT_EQ(session->stock()->digest(), digest) << "the workpiece is the same";
    const auto labels = labels_along(*session, 20, -1);
    EXPECT_EQ(labels[0], (CutLabel{1, {0, 4}}));
    EXPECT_EQ(labels[1], (CutLabel{1, {0, 5}}));
    EXPECT_EQ(labels_along(*session, 20, -2)[2], (CutLabel{1, {0, 0}})) << "with no line";
    EXPECT_EQ(session->cut_labels().size(), 3U) << "as many as lines, not as moves";
  }
}

TEST(LiveSession, ALogIsReplayedAndReported) {
  Watched run(with_block(), std::make_unique<ListedSource>(std::vector{
                                at(10, 20, 1, 0), at(10, 20, -1, 0.1), at(30, 20, -1, 0.2)}));
  EXPECT_EQ(run.outcome, Outcome::kFinished);
  ASSERT_TRUE(run.report().live);
  EXPECT_EQ(run.report().live->facts.samples, 3U);
  EXPECT_NEAR(run.report().live->duration_s, 0.2, 1e-9);
  EXPECT_NEAR(run.report().live->rate_hz, 10, 1e-6);
  const StockReport& stock = *run.report().stock;
  EXPECT_NEAR(stock.blank_mm3 - stock.remaining_mm3, kPi * 4 + 80, 0.3);
  EXPECT_EQ(run.told.states.back(), LiveState::kEnded);
  const auto json = nlohmann::json::parse(json_text(run.report()));
  EXPECT_EQ(json["live"]["samples"], 3);
  EXPECT_NE(summary_text(run.report()).find("source    a list: 3 samples"), std::string::npos);
}

TEST(LiveSession, TheSameLogGivesTheSameWorkpieceAtAnySpeed) {
  std::vector<AxisSample> samples;
  for (int i = 0; i < 300; ++i) {
    samples.push_back(
        at(20 + 10 * std::cos(0.1 * i), 20 + 10 * std::sin(0.1 * i), -0.01 * i, 0.001 * i));
  }
  std::string digest;
  for (const double speed : {std::numeric_limits<double>::infinity(), 1.0, 20.0}) {
    LiveOptions options = with_block();
    options.speed = speed;
    const auto start = std::chrono::steady_clock::now();
    Watched run(std::move(options), std::make_unique<ListedSource>(samples));
    const double wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (speed == 1.0) {
      EXPECT_GE(wall_s, 0.298);
    }
    if (digest.empty()) digest = run.report().stock->digest;
    EXPECT_EQ(run.report().stock->digest, digest);
  }
}

TEST(LiveSession, WhatTheSourceHasLostMakesTheResultLossy) {
  auto source = std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0), at(10, 20, 2, 0.1)});
  source->status_.lost = 3;
  Watched run(with_block(), std::move(source));
  EXPECT_EQ(run.outcome, Outcome::kLossy);
  EXPECT_EQ(run.report().live->status.lost, 3U);
}

TEST(LiveSession, WhatIsWrongWithTheSourceIsToldOnceEach) {
  for (const bool is_wrong : {false, true}) {
    auto source = std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0), at(10, 20, 2, 0.1)});
    if (is_wrong) {
      source->status_.incomplete = 1;
      source->status_.standing = 20;
      source->status_.damaged = 300;
    }
    Watched run(with_block(), std::move(source));
    EXPECT_EQ(run.outcome, is_wrong ? Outcome::kLossy : Outcome::kFinished);
    EXPECT_EQ(run.told.findings, std::vector<FindingId>(is_wrong ? 3 : 0, FindingId::kSourceFault));
    const auto json = nlohmann::json::parse(json_text(run.report()));
    EXPECT_EQ(json["live"]["incomplete_cycles"], is_wrong ? 1 : 0);
    EXPECT_EQ(json["live"]["clock_stood"], is_wrong ? 20 : 0);
    EXPECT_EQ(json["live"]["damaged"], is_wrong ? 300 : 0);
  }
}

TEST(LiveSession, AnAnswerThatWasHeldUpIsNoClockThatWasSet) {
  const std::int64_t now_ns = real_time_ns();
  for (const bool is_set : {false, true}) {
    std::vector<AxisSample> samples;
    for (int i = 0; i < 10; ++i) {
      AxisSample sample = at(10, 20, 1, 0);
      sample.device_ns = AxisSample::kNoTime;
      // One is 5 s off, or several; and the clock with these.
      const bool is_off = is_set ? i >= 5 : i == 5 || i == 7 || i == 8;
      sample.host_ns = now_ns - (is_off ? 5'000'000'000 : 0);
      samples.push_back(sample);
    }
    LiveOptions options = with_block();
    options.speed = 0;
    auto asked = std::make_shared<int>(0);
    options.clock_ns = [asked, is_set] {
      return real_time_ns() - (is_set && (*asked)++ >= 5 ? 5'000'000'000 : 0);
    };
    Watched run(std::move(options), std::make_unique<ListedSource>(std::move(samples)));
    EXPECT_EQ(run.report().live->clock_steps, is_set ? 1U : 0U);
  }
}

/// A clock that is set between two samples, of which the second may have been read before.
TEST(ClockWatch, ASampleThatWasReadBeforeIsOfTheTimeBefore) {
  const auto steady_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  for (const std::int64_t by_ns :
       std::array<std::int64_t, 3>{3'600'000'000'000, -7'000'000'000, 300'000'000}) {
    std::int64_t offset_ns = 0;
    const auto clock_ns = [&] { return steady_ns() + offset_ns; };
    ClockWatch watch(clock_ns);
    EXPECT_EQ(watch.set_by(clock_ns(), steady_ns()), 0);
    const std::int64_t read_ns = clock_ns();
    offset_ns = by_ns;
    EXPECT_EQ(watch.set_by(read_ns, steady_ns()), 0);
    // Held up for a tenth of a second.
    EXPECT_NEAR(static_cast<double>(watch.set_by(clock_ns() - 100'000'000, steady_ns())),
                static_cast<double>(by_ns), 2e6);
    EXPECT_EQ(watch.set_by(clock_ns(), steady_ns()), 0);
  }
}

TEST(SourceFaults, AreRewordedAsTheyGoOn) {
  SourceFaults faults;
  FindingLog log;
  SourceStatus status;
  status.incomplete = 1;
  faults.look_at(status, log);
  status.incomplete = 7;
  faults.look_at(status, log);
  ASSERT_EQ(log.kept().size(), 1U);
  EXPECT_EQ(log.kept()[0].text,
            "frames of the bus were lost: 7 cycles were without all axes, and dropped");
}

/// What it has lost comes with its samples.
class LosingSource final : public PositionSource {
 public:
  Next next(AxisSample& sample, std::chrono::milliseconds patience) override {
    if (next_ == 6) {
      std::this_thread::sleep_for(patience);
      return Next::kNothing;
    }
    sample = at(10, 20, 5, 0);
    sample.device_ns = AxisSample::kNoTime;
    set_ = next_ >= 3;
    sample.host_ns = clock_ns();
    if (next_ == 2) status_.lost = 21;
    ++next_;
    status_.state = SourceState::kReading;
    return Next::kSample;
  }
  const SourceStatus& status() const override { return status_; }
  std::string describe() const override { return "a source that loses"; }
  /// An hour forward behind the third one.
  std::int64_t clock_ns() const {
    return real_time_ns() + (set_ ? std::int64_t{3'600'000'000'000} : 0);
  }

 private:
  SourceStatus status_;
  int next_ = 0;
  std::atomic<bool> set_ = false;
};

TEST(LiveSession, WhatIsLostAndWhenTheClockWasSetIsTapped) {
  LiveOptions options = with_block();
  options.speed = 0;
  options.for_s = 0.3;
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  auto source = std::make_unique<LosingSource>();
  options.clock_ns = [&losing = *source] { return losing.clock_ns(); };
  auto session = LiveSession::open(std::move(options), std::move(source), diagnostics, outcome);
  ASSERT_TRUE(session);
  std::vector<std::uint64_t> lost;
  std::vector<double> set_s;
  session->set_tap([&](const TappedSample& tapped) {
    lost.push_back(tapped.lost);
    set_s.push_back(static_cast<double>(tapped.clock_set_ns) * 1e-9);
  });
  EXPECT_EQ(session->run({}, diagnostics), Outcome::kLossy);
  EXPECT_EQ(lost, (std::vector<std::uint64_t>{0, 0, 21, 0, 0, 0}));
  ASSERT_EQ(set_s.size(), 6U);
  EXPECT_NEAR(set_s[3], 3600, 0.2);
  for (const std::size_t i : {0, 1, 2, 4, 5}) EXPECT_EQ(set_s[i], 0) << i;
  EXPECT_EQ(session->report().live->clock_steps, 1U);
}

TEST(LiveSession, AGapIsAFindingAndALossyResult) {
  Watched run(with_block(),
              std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0), at(20, 20, 1, 3)}));
  EXPECT_EQ(run.outcome, Outcome::kLossy);
  EXPECT_EQ(run.told.findings, std::vector<FindingId>{FindingId::kSourceGap});
}

TEST(LiveSession, ASourceThatFailsOrSaysNothingIsAFailureWithItsReason) {
  auto failed = std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0)});
  failed->end_state = SourceState::kFailed;
  failed->status_.trouble = "reading run.csv: Input/output error";
  Watched run(with_block(), std::move(failed));
  EXPECT_EQ(run.outcome, Outcome::kFailed);
  ASSERT_EQ(run.diagnostics.size(), 1U);
  EXPECT_EQ(run.diagnostics[0].message, "a list: reading run.csv: Input/output error");

  Watched nothing(with_block(), std::make_unique<ListedSource>(std::vector<AxisSample>{}));
  EXPECT_EQ(nothing.outcome, Outcome::kFailed);
  EXPECT_EQ(nothing.diagnostics[0].message, "a list: no position has come");
}

TEST(LiveSession, AMachineThatFallsSilentIsStaleThenLost) {
  LiveOptions options = with_block();
  options.speed = 0;
  options.stale_after_s = 0.05;
  options.lost_after_s = 0.15;
  options.for_s = 10;
  std::stop_source stop;
  Watched run(
      std::move(options),
      std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0), at(10, 20, 0.5, 0.01)}, false),
      stop.get_token(), [&](const LiveStatus& status) {
        if (status.state == LiveState::kLost) stop.request_stop();
      });
  EXPECT_EQ(run.told.states, (std::vector{LiveState::kLive, LiveState::kStale, LiveState::kLost,
                                          LiveState::kEnded}));
  // It was watched to the end that the user set, but the end was not live.
  EXPECT_EQ(run.outcome, Outcome::kLossy);
}

TEST(LiveSession, EndsAfterTheTimeAskedFor) {
  LiveOptions options = with_block();
  options.speed = 0;
  options.for_s = 0.1;
  const auto start = std::chrono::steady_clock::now();
  Watched run(std::move(options),
              std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0)}, false));
  EXPECT_EQ(run.outcome, Outcome::kFinished);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

TEST(LiveSession, WithoutABlankThereIsNothingToCut) {
  LiveOptions options = with_block();
  options.blank.reset();
  Watched run(std::move(options), std::make_unique<ListedSource>(std::vector{at(10, 20, 1, 0)}));
  EXPECT_EQ(run.session, nullptr);
  EXPECT_EQ(run.outcome, Outcome::kUsageError);
  ASSERT_EQ(run.diagnostics.size(), 1U);
  EXPECT_EQ(run.diagnostics[0].message,
            "no blank is given: without a program there is nothing to guess it from");
}

TEST(LiveSession, EverySampleGoesThroughTheTap) {
  std::vector<AxisSample> samples;
  for (int i = 0; i < 50'000; ++i) samples.push_back(at(20, 20, 5 + 1e-5 * i, 0.001 * i));
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  auto session = LiveSession::open(with_block(), std::make_unique<ListedSource>(samples),
                                   diagnostics, outcome);
  std::size_t tapped = 0;
  session->set_tap([&](const TappedSample&) { ++tapped; });
  EXPECT_EQ(session->run({}, diagnostics), Outcome::kFinished);
  EXPECT_EQ(tapped, samples.size());
  EXPECT_EQ(session->report().live->facts.samples, samples.size());
  EXPECT_EQ(session->report().live->dropped, 0U);
}

TEST(SampleQueue, DropsAndCountsWhatIsTooMuch) {
  SampleQueue queue;
  const ArrivedSample sample{};
  for (std::size_t i = 0; i < SampleQueue::kCapacity; ++i) EXPECT_TRUE(queue.push_or_drop(sample));
  EXPECT_FALSE(queue.push_or_drop(sample));
  EXPECT_EQ(queue.dropped(), 1U);
  std::vector<ArrivedSample> out;
  EXPECT_TRUE(queue.pop_all(out, 0ms));
  EXPECT_EQ(out.size(), SampleQueue::kCapacity);
  EXPECT_TRUE(queue.pop_all(out, 0ms));
  EXPECT_TRUE(out.empty());
  queue.close();
  EXPECT_FALSE(queue.pop_all(out, 0ms));
  EXPECT_FALSE(queue.push_waiting(sample));
}

TEST(SampleQueue, ALogWaitsForWhoTakesIt) {
  SampleQueue queue;
  constexpr std::uint64_t kSamples = 5000;
  std::thread log([&queue] {
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      ArrivedSample sample{};
      sample.lost = i;
      queue.push_waiting(sample);
    }
    queue.close();
  });
  std::vector<ArrivedSample> out;
  std::uint64_t taken = 0;
  while (queue.pop_all(out, 10s)) {
    EXPECT_LE(out.size(), SampleQueue::kLogCapacity);
    for (const ArrivedSample& sample : out) EXPECT_EQ(sample.lost, taken++);
    std::this_thread::sleep_for(1ms);
  }
  log.join();
  EXPECT_EQ(taken, kSamples);
}

TEST(LiveJson, EventsAreLinesOfJson) {
  LiveStatus status;
  const EventHead head{1795410000000000, 7, 1772357400000000123};
  status.state = LiveState::kStale;
  status.age_s = 0.7;
  status.place.known = true;
  status.place.tip_mm = {1, 2, 3};
  status.place.tool = 4;
  const std::string line = status_json(status, head);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["event"], "status");
  EXPECT_EQ(json["instance_id"], 1795410000000000);
  EXPECT_EQ(json["sequence"], 7);
  EXPECT_EQ(json["time"], "2026-03-01T09:30:00.000000123Z");
  EXPECT_EQ(json["state"], "stale");
  EXPECT_EQ(json["age_ms"], 700);
  EXPECT_EQ(json["tip_mm"], (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(json["line"].is_null());
  EXPECT_TRUE(json["collision_in_s"].is_null());

  AheadWarning warning;
  warning.finding.id = FindingId::kRapidContact;
  warning.finding.source.line = 7;
  warning.in_s = 2.5;
  warning.t_s = 61.25;
  const auto ahead = nlohmann::json::parse(ahead_json(warning, {"part.ngc"}, head));
  EXPECT_EQ(ahead["event"], "ahead");
  EXPECT_EQ(ahead["in_s"], 2.5);
  EXPECT_EQ(ahead["t_s"], 61.25);
  EXPECT_EQ(ahead["sequence"], 7);
  EXPECT_EQ(ahead["time"], "2026-03-01T09:30:00.000000123Z");
  EXPECT_EQ(ahead["id"], "rapid-contact");
  EXPECT_EQ(ahead["file"], "part.ngc");
  EXPECT_EQ(ahead["line"], 7);
}

}  // namespace
}  // namespace kerf
