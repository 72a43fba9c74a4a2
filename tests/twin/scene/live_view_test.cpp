#include "twin/scene/live_view.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <thread>

#include "tests/twin/playback/tracks.h"
#include "tests/twin/scene/machine_with_arm.h"

namespace kerf {
namespace {

/// What is behind the view: a console, mostly.
struct Behind : LiveObserver {
  void on_status(const LiveStatus&) override { ++statuses; }
  void on_finding(const Finding&, const std::vector<std::string>&) override { ++findings; }
  void on_warning(const AheadWarning&, const std::vector<std::string>&) override { ++warnings; }
  int statuses = 0, findings = 0, warnings = 0;
};

/// The test is the session, and a window without a screen.
class LiveViewTest : public testing::Test {
 protected:
  LiveViewOptions options() {
    LiveViewOptions options;
    options.title = "bench";
    options.source_name = "a script";
    options.blank_mm = stock_->bounds_mm();
    options.tools = test::two_tools();
    options.on_close = [this] { closed_ = true; };
    options.on_speed = [this](double speed) { speed_ = speed; };
    return options;
  }
  void open(LiveViewOptions options) {
    view_ = std::make_unique<LiveView>(std::move(options), behind_, mailbox_, commands_);
  }

  static LiveStatus at(const Vec3& tip_mm, double t_s = 0) {
    LiveStatus status;
    status.state = LiveState::kLive;
    status.t_s = t_s;
    status.place.known = true;
    status.place.tip_mm = tip_mm;
    status.place.machine_mm = tip_mm + Vec3(100, 0, 0);
    status.place.tool = 1;
    return status;
  }
  void frame(const LiveStatus& status, const std::vector<Vec3>& trail = {}) {
    view_->on_frame(*stock_, nullptr, status, trail, labels_.all());
  }
  static Finding finding(const std::string& text, std::uint32_t line) {
    Finding found;
    found.severity = Severity::kError;
    found.source.line = line;
    found.text = text;
    return found;
  }

  /// Takes news until `wanted` holds of what is known by then.
  template <class Wanted>
  bool until(Wanted wanted) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < end) {
      if (auto update = mailbox_.take()) {
        for (const auto& patch : update->patches) versions_[patch->tile] = patch->version;
        for (const auto& chunk : update->path) path_[chunk->index] = chunk;
        merge(&known_, std::move(*update));
      }
      if (wanted()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  template <class Wanted>
  bool moment(Wanted wanted) {
    return until([&] { return known_.moment && wanted(*known_.moment); });
  }
  /// What moves leave that come over a tile and remove nothing is not shown anew: its version is
  /// taken back.
  void settle() { stock_->take_dirty_tiles(); }
  /// All tiles are as they are in the stock.
  bool is_shown() {
    if (versions_.size() != stock_->tile_count()) return false;
    for (const auto& [tile, version] : versions_) {
      if (version != stock_->patch_version(tile)) return false;
    }
    return true;
  }

  std::unique_ptr<ZMap> stock_ = test::block_40(0.2);
  CutLabels labels_;
  Behind behind_;
  SceneMailbox mailbox_;
  CommandQueue commands_;
  SceneUpdate known_;
  std::map<std::uint32_t, std::uint64_t> versions_;
  std::map<std::uint32_t, std::shared_ptr<const PathChunk>> path_;
  std::atomic<bool> closed_{false};
  std::atomic<double> speed_{-1};
  std::unique_ptr<LiveView> view_;
};

TEST_F(LiveViewTest, ShowsFixturesAndHowNearTheToolIs) {
  const FixtureSpec post[] = {parse_fixture("post=box:41,0,-10:50,20,10").value()};
  Diagnostics diagnostics;
  LiveViewOptions with_post = options();
  with_post.collisions.fixtures = load_fixtures(post, diagnostics);
  open(std::move(with_post));
  ASSERT_TRUE(until([&] { return known_.fixtures && known_.moment; }));
  ASSERT_EQ(known_.fixtures->links.size(), 1u);
  EXPECT_EQ(known_.moment->fixture_poses.size(), 1u) << "before the first position";
  frame(at({33, 10, 3}));
  ASSERT_TRUE(moment([](const Moment& m) { return m.clearance.has_value(); }));
  EXPECT_NEAR(known_.moment->clearance->mm, 5, 0.003) << "the ball of 6 mm reaches to X36";
  EXPECT_TRUE(known_.moment->contacts.empty());
  Finding told = finding("holder touches the workpiece", 7);
  told.bodies = {"holder", kWorkpieceBody};
  view_->on_finding(told, {"part.ngc"});
  frame(at({33, 10, 3}));
  ASSERT_TRUE(moment([](const Moment& m) { return !m.contacts.empty(); }));
  EXPECT_EQ(known_.moment->contacts[0].piece, ToolPiece::kHolder);
  frame(at({39, 10, 3}));
  ASSERT_TRUE(moment([](const Moment& m) {
    return !m.contacts.empty() && m.contacts[0].fixture == std::size_t{0};
  })) << "it is in the post now";
}

TEST_F(LiveViewTest, AFixtureOnALinkGoesWithIt) {
  const FixtureSpec post[] = {parse_fixture("post=box:0,0,0:1,1,1:at=100,0,0:on=frame").value()};
  Diagnostics diagnostics;
  LiveViewOptions with_post = options();
  with_post.collisions.fixtures = load_fixtures(post, diagnostics);
  with_post.machine = test::drawn_with_arm({0, 0, 0});
  open(std::move(with_post));
  ASSERT_TRUE(until([&] { return known_.fixtures && known_.moment; }));
  EXPECT_EQ(known_.moment->fixture_poses, std::vector<glm::mat4>{kNotDrawn})
      << "before the first position";
  frame(at({33, 10, 30}));
  EXPECT_TRUE(moment([](const Moment& m) {
    return std::abs(static_cast<double>(m.fixture_poses[0][3].x) - 133) < 1e-4;
  })) << "the table has gone to -33";
  // The workpiece lies elsewhere in the machine than this one was built for.
  LiveStatus moved = at({34, 10, 30});
  moved.work.g5x_mm = {5, 0, 0};
  frame(moved);
  EXPECT_TRUE(moment([](const Moment& m) {
    return m.fixture_poses == std::vector<glm::mat4>{kNotDrawn} && !m.clearance;
  }));
}

TEST_F(LiveViewTest, ShowsTheWorkpieceToolAndPlace) {
  open(options());
  ASSERT_TRUE(view_->wants_frames());
  frame(at({5, 20, 3}, 1.5));
  ASSERT_TRUE(until([&] { return known_.setup && known_.tool_shape && is_shown(); }));
  EXPECT_EQ(known_.setup->title, "bench");
  ASSERT_TRUE(moment([](const Moment& m) { return m.tool_pose.has_value(); }));
  const Moment& m = *known_.moment;
  EXPECT_EQ(m.state, PlayState::kFollowing);
  EXPECT_EQ(m.tool_pose->tip_mm, Vec3(5, 20, 3));
  EXPECT_EQ(m.time_s, 1.5);
  EXPECT_EQ(m.tool, 1);
  EXPECT_EQ(m.tool_name, "ball 6");
  EXPECT_EQ(m.source_name, "a script");
  ASSERT_EQ(m.axes.size(), 3u);
  EXPECT_EQ(m.axes[0].machine, 105);
  EXPECT_EQ(m.axes[0].work, 5);

  const Cutter cutter = parse_tool_argument("1=ball:6").value().cutter;
  CutMove move;
  move.from_mm = {5, 20, -2};
  move.to_mm = {35, 20, -2};
  std::vector<CutReport> reports(1);
  stock_->cut(cutter, {&move, 1}, reports);
  stock_->finish(reports);
  settle();
  frame(at({35, 20, -2}, 2));
  EXPECT_TRUE(until([&] { return is_shown(); })) << "what was cut";
}

TEST_F(LiveViewTest, WhatIsToldStaysInTheStatusLine) {
  open(options());
  view_->tell("shop.ini has changed");
  EXPECT_TRUE(moment([](const Moment& m) { return m.notice == "shop.ini has changed"; }));
  frame(at({0, 0, 2}, 1));
  EXPECT_TRUE(
      moment([](const Moment& m) { return m.time_s == 1 && m.notice == "shop.ini has changed"; }));
  // What is told of the machine comes before it.
  LiveStatus off = at({0, 0, 2}, 2);
  off.off_path_mm = 0.5;
  frame(off);
  EXPECT_TRUE(moment([](const Moment& m) { return m.notice == "off the path by 0.50 mm"; }));
}

TEST_F(LiveViewTest, OpeningIsAskedForWhereItCanBe) {
  LiveViewOptions with = options();
  std::string asked;
  std::atomic<bool> is_asked{false};
  with.on_open = [&](const std::string& path) {
    asked = path;
    is_asked = true;
  };
  auto job = std::make_shared<ViewedJob>();
  job->command = "kerf replay run.csv";
  with.job = job;
  open(std::move(with));
  EXPECT_TRUE(until([&] { return known_.job && known_.job->command == "kerf replay run.csv"; }));
  commands_.push(OpenCommand{"other.csv"});
  EXPECT_TRUE(until([&] { return is_asked.load(); }));
  EXPECT_EQ(asked, "other.csv");
}

TEST_F(LiveViewTest, AStartIsAskedAboutFromWhereTheMachineStandsNow) {
  LiveViewOptions with = options();
  LiveScene told;
  std::atomic<int> line{0};
  with.on_entry = [&](int asked, const LiveScene& now) {
    told = now;
    line = asked;
  };
  open(std::move(with));
  frame(at({1, 2, 3}, 2));
  ASSERT_TRUE(moment([](const Moment& m) { return m.time_s == 2; }));
  commands_.push(EntryCommand{28});
  ASSERT_TRUE(until([&] { return line == 28; }));
  EXPECT_TRUE(told.stock);
  ASSERT_TRUE(told.status);
  EXPECT_EQ(told.status->place.tip_mm, Vec3(1, 2, 3));
  const double age_s = told.status->age_s;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  commands_.push(EntryCommand{29});
  ASSERT_TRUE(until([&] { return line == 29; }));
  EXPECT_GE(told.status->age_s, age_s + 0.03) << "as old as it is when it is asked for";
}

TEST_F(LiveViewTest, TheWayGrowsAcrossChunks) {
  open(options());
  const std::size_t points = 2 * kPathChunkSegments + 100;
  std::size_t sent = 0;
  while (sent < points) {
    std::vector<Vec3> trail;
    for (int i = 0; i < 700 && sent < points; ++i) trail.emplace_back(0.1 * ++sent, 20, 3);
    frame(at({1, 20, 3}), trail);
  }
  ASSERT_TRUE(moment([&](const Moment& m) { return m.past_vertices == points; }));
  ASSERT_EQ(path_.size(), 3u);
  EXPECT_EQ(path_[0]->vertices.size(), kPathChunkSegments + 1);
  EXPECT_EQ(path_[1]->vertices.front().position_mm, path_[0]->vertices.back().position_mm);
  EXPECT_FLOAT_EQ(path_[2]->vertices.back().position_mm.x, 0.1F * static_cast<float>(points));
}

TEST_F(LiveViewTest, StatesReachTheMomentInWords) {
  open(options());
  const std::pair<LiveState, SourceFreshness> kStates[] = {
      {LiveState::kWaiting, SourceFreshness::kStale},
      {LiveState::kLive, SourceFreshness::kLive},
      {LiveState::kStale, SourceFreshness::kStale},
      {LiveState::kLost, SourceFreshness::kLost}};
  for (const auto& [state, shown] : kStates) {
    LiveStatus status = at({1, 2, 3});
    status.state = state;
    status.age_s = 0.75;
    view_->on_status(status);
    ASSERT_TRUE(moment([&, shown = shown](const Moment& m) {
      return m.source == shown && m.source_age_s >= 0.75;
    }));
    known_.moment.reset();
  }
  EXPECT_EQ(behind_.statuses, 4) << "all are passed on";
  LiveStatus status = at({1, 2, 3});
  status.off_path_mm = 0.75;
  view_->on_status(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.notice == "off the path by 0.75 mm"; }));
  status.collision_in_s = 2.5;
  status.collision_line = 7;
  view_->on_status(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.notice == "collision in 2.5 s, line 7"; }));
  status = LiveStatus{};
  view_->on_status(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.notice == "waiting for positions"; }));
  status.state = LiveState::kLive;
  status.place.missing_axes = "YZ";
  view_->on_status(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.notice == "no position of YZ"; }));
  EXPECT_FALSE(known_.moment->tool_pose) << "it is not known where";
}

TEST_F(LiveViewTest, FindingsAddUp) {
  open(options());
  view_->on_finding(finding("too fast", 3), {"/nc/part.ngc"});
  AheadWarning warning;
  warning.finding = finding("hits the vise", 9);
  view_->on_warning(warning, {"/nc/part.ngc"});
  ASSERT_TRUE(until([&] { return known_.findings && known_.findings->findings.size() == 2; }));
  view_->on_finding(finding("too deep", 12), {"/nc/part.ngc"});
  ASSERT_TRUE(until([&] { return known_.findings->findings.size() == 3; }));
  const std::vector<SceneFinding>& shown = known_.findings->findings;
  EXPECT_NE(shown[0].text.find("too fast"), std::string::npos) << shown[0].text;
  EXPECT_EQ(shown[1].text.rfind("ahead: ", 0), 0u) << shown[1].text;
  EXPECT_EQ(shown[1].line, 9);
  EXPECT_EQ(shown[2].line, 12);
  EXPECT_EQ(behind_.findings, 2);
  EXPECT_EQ(behind_.warnings, 1);
}

TEST_F(LiveViewTest, TheProgramsPathTakesThePlaceOfTheTrail) {
  std::atomic<bool> may_load{false};
  LiveViewOptions wanted = options();
  wanted.load_program = [&](const std::stop_token&) {
    while (!may_load) std::this_thread::yield();
    MotionList program;
    program.at({-5, 10, 5}).tool(1).spindle(true);
    program.feed({-5, 10, -2}).feed({45, 10, -2}).traverse({45, 10, 5});
    auto loaded = std::make_unique<LiveProgram>();
    loaded->track = test::track_of(program.list());
    loaded->files = {"/nc/part.ngc"};
    return loaded;
  };
  open(std::move(wanted));
  frame(at({1, 2, 3}), {{1, 2, 3}, {2, 2, 3}, {3, 2, 3}});
  ASSERT_TRUE(moment([](const Moment& m) { return m.past_vertices == 3; }));
  may_load = true;
  ASSERT_TRUE(until([&] { return known_.timeline && known_.program && path_.size() == 1; }));
  EXPECT_GT(known_.timeline->duration_s, 0);
  ASSERT_TRUE(until([&] { return path_[0]->vertices.size() == 4; }));
  LiveStatus home = at({0, 0, 80});
  home.t_s = 6.2;
  home.removed_mm3 = 7;
  frame(home);
  ASSERT_TRUE(moment([](const Moment& m) { return m.removed_mm3 == 7; }));
  EXPECT_EQ(known_.moment->time_s, 0) << "watched for 6.2 s, and the program has not begun";
  LiveStatus status = at({20, 10, -2});
  status.place.followed = true;
  status.place.program_s = known_.timeline->duration_s + 1;
  status.place.source.line = 4;
  frame(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.line == 4; }));
  EXPECT_EQ(known_.moment->past_vertices, 4u);
  EXPECT_EQ(known_.moment->time_s, known_.timeline->duration_s + 1);
}

TEST_F(LiveViewTest, ShowsTheFeedThatIsBesideTheOneThatWasProgrammed) {
  open(options());
  LiveStatus status = at({1, 2, 3});
  frame(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.tool_pose.has_value(); }));
  EXPECT_FALSE(known_.moment->measured_mm_per_min) << "too little is known";
  status.feed_mm_per_min = 1480;
  frame(status);
  ASSERT_TRUE(moment([](const Moment& m) { return m.measured_mm_per_min == 1480; }));
  EXPECT_EQ(known_.moment->feed_mm_per_min, 0) << "nobody has given a program";
  EXPECT_FALSE(known_.moment->is_traverse);
}

TEST_F(LiveViewTest, ProgrammedFeedIsThatOfTheMotionUnderWay) {
  MotionList program;
  program.at({-5, 10, 5}).tool(1).spindle(true);
  program.feed_rate(600).feed({5, 10, -2}).feed_rate(1500).feed({35, 10, -2}).traverse({35, 10, 5});
  const std::shared_ptr<const ProgramTrack> track = test::track_of(program.list());
  LiveViewOptions wanted = options();
  wanted.load_program = [&track](const std::stop_token&) {
    auto loaded = std::make_unique<LiveProgram>();
    loaded->track = track;
    return loaded;
  };
  open(std::move(wanted));
  ASSERT_TRUE(until([&] { return static_cast<bool>(known_.timeline); }));
  LiveStatus status = at({20, 10, -2});
  status.feed_mm_per_min = 1410;
  status.place.followed = true;
  const auto shows = [&](std::size_t motion, double feed_mm_per_min, bool is_traverse) {
    status.place.program_s = 0.5 * (track->start_s(motion) + track->end_s(motion));
    frame(status);
    return moment([&](const Moment& m) {
      return m.measured_mm_per_min == 1410 && m.is_traverse == is_traverse &&
             m.feed_mm_per_min == feed_mm_per_min;
    });
  };
  EXPECT_TRUE(shows(1, 600, false));
  EXPECT_TRUE(shows(2, 1500, false));
  EXPECT_TRUE(shows(3, 0, true));
  status.place.followed = false;
  frame(status);
  EXPECT_TRUE(moment([](const Moment& m) { return m.feed_mm_per_min == 0 && !m.is_traverse; }))
      << "off the path nobody knows what was wanted";
}

TEST_F(LiveViewTest, ALogIsHeldAndHurried) {
  LiveViewOptions wanted = options();
  wanted.log = true;
  wanted.speed = 2;
  open(std::move(wanted));
  frame(at({1, 2, 3}));
  ASSERT_TRUE(moment([](const Moment& m) { return m.state == PlayState::kPlaying; }));
  EXPECT_EQ(known_.moment->speed, 2);
  commands_.push(PauseCommand{});
  ASSERT_TRUE(moment([](const Moment& m) { return m.state == PlayState::kPaused; }));
  EXPECT_EQ(speed_, 0);
  commands_.push(SpeedCommand{8});
  ASSERT_TRUE(moment([](const Moment& m) { return m.speed == 8; }));
  EXPECT_EQ(speed_, 0) << "it stays held";
  commands_.push(PlayCommand{});
  ASSERT_TRUE(moment([](const Moment& m) { return m.state == PlayState::kPlaying; }));
  EXPECT_EQ(speed_, 8);
  commands_.push(SpeedCommand{2000});
  ASSERT_TRUE(moment([](const Moment& m) { return std::isinf(m.speed); }));
  EXPECT_TRUE(std::isinf(speed_));
}

TEST_F(LiveViewTest, AMachineIsNotHeld) {
  open(options());
  commands_.push(PauseCommand{});
  commands_.push(PickCommand{Vec3(1, 2, 0)});
  ASSERT_TRUE(until([&] { return static_cast<bool>(known_.picked); }));
  EXPECT_EQ(known_.picked->point_mm, Vec3(1, 2, 0));
  EXPECT_EQ(speed_, -1);
}

TEST_F(LiveViewTest, TellsWhichToolAndLineCutWhere) {
  stock_->keep_cut_ids(true);
  LiveViewOptions wanted = options();
  std::atomic<bool> may_load{false};
  wanted.load_program = [&](const std::stop_token&) {
    while (!may_load) std::this_thread::yield();
    MotionList program;
    program.at({-5, 10, 5}).tool(1).spindle(true);
    program.feed({5, 10, -2}).feed({35, 10, -2});  // lines 2 and 3
    auto loaded = std::make_unique<LiveProgram>();
    loaded->track = test::track_of(program.list());
    loaded->files = {"/nc/part.ngc"};
    loaded->tools = {{1, "the ball"}};
    return loaded;
  };
  // What the window wants from the beginning is there when there is something to be coloured.
  commands_.push(ColorCommand{ColorBy::kTool});
  open(std::move(wanted));
  CutMove move;
  move.from_mm = {5, 10, -2};
  move.to_mm = {35, 10, -2};
  move.id = labels_.number_of({1, {0, 3}});
  std::vector<CutReport> reports;
  stock_->cut(parse_tool_argument("1=ball:6").value().cutter, {&move, 1}, reports);
  stock_->finish(reports);
  settle();
  frame(at({35, 10, -2}));
  ASSERT_TRUE(until([&] {
    return known_.colors && known_.colors->legend.size() == 1 && is_shown();
  })) << "without the program";
  EXPECT_EQ(known_.colors->mode, ColorBy::kTool);
  EXPECT_EQ(known_.colors->legend[0].text, "T1 ball 6");
  const auto pick = [&](const Vec3& point_mm) {
    known_.picked.reset();
    commands_.push(PickCommand{point_mm});
    EXPECT_TRUE(until([&] { return static_cast<bool>(known_.picked); }));
    return *known_.picked;
  };
  const PickedPoint groove = pick({20, 10, -2});
  ASSERT_TRUE(groove.tool);
  EXPECT_EQ(*groove.tool, 1);
  EXPECT_EQ(groove.tool_name, "ball 6");
  EXPECT_EQ(groove.line, 3);
  EXPECT_EQ(groove.time_s, 0) << "nobody knows the program";
  EXPECT_FALSE(pick({20, 30, 0}).tool) << "not cut";

  may_load = true;
  ASSERT_TRUE(until([&] { return known_.colors->legend[0].text == "T1 the ball"; }));
  const PickedPoint timed = pick({20, 10, -2});
  EXPECT_EQ(timed.line, 3);
  EXPECT_GT(timed.time_s, 0) << "when the program's line begins";
}

TEST_F(LiveViewTest, RaysHaveTheHeightsAndCsgSaysWhyNot) {
  settle();
  open(options());
  frame(at({1, 2, 3}));
  ASSERT_TRUE(until([&] { return is_shown(); }));
  commands_.push(DrawModeCommand{DrawMode::kRaycast});
  ASSERT_TRUE(until([&] { return known_.draw_mode && known_.heights; }));
  EXPECT_EQ(*known_.draw_mode, (DrawAnswer{DrawMode::kRaycast, DrawLimit::kNone, "", 0}));
  EXPECT_EQ(known_.heights->height(100, 50), 0.0f);
  CutMove move;
  move.from_mm = move.to_mm = {20, 10, -2};
  std::vector<CutReport> reports;
  stock_->cut(parse_tool_argument("1=flat:6").value().cutter, {&move, 1}, reports);
  stock_->finish(reports);
  frame(at({20, 10, -2}));
  ASSERT_TRUE(until([&] { return known_.heights->height(100, 50) == -2.0f; }));
  EXPECT_FALSE(is_shown()) << "no patches are made for it";
  commands_.push(DrawModeCommand{DrawMode::kCsg});
  ASSERT_TRUE(until([&] { return known_.draw_mode->draw_mode == DrawMode::kCsg; }));
  EXPECT_EQ(known_.draw_mode->limit, DrawLimit::kWatched);
  settle();
  frame(at({20, 10, -2}));
  ASSERT_TRUE(until([&] { return is_shown(); })) << "by mesh";
}

TEST_F(LiveViewTest, RatesOfRemovalComeWithTheCuts) {
  stock_->keep_cut_ids(true);
  settle();
  commands_.push(ColorCommand{ColorBy::kRemovalRate});
  open(options());
  frame(at({1, 2, 3}));
  labels_.note(labels_.number_of({1, {0, 7}}), 30.0, 1.0);
  labels_.note(labels_.number_of({1, {0, 8}}), 500.0, 1.0);
  std::stop_source never;
  std::thread asks([&] {
    EXPECT_TRUE(until([&] { return known_.colors && known_.colors->legend.size() == 2; }));
    commands_.push(CloseCommand{});
  });
  view_->end(stock_.get(), labels_.all(), never.get_token());
  asks.join();
  ASSERT_TRUE(known_.colors);
  EXPECT_EQ(known_.colors->legend[0].text, "<= 30 mm\u00b3/s");
  EXPECT_EQ(known_.colors->of_move.at(1), known_.colors->legend[1].color);
}

TEST_F(LiveViewTest, TheLastCutsAreKnownAtTheEnd) {
  stock_->keep_cut_ids(true);
  settle();
  open(options());
  frame(at({1, 2, 3}));
  CutMove move;
  move.from_mm = {5, 10, -2};
  move.to_mm = {35, 10, -2};
  move.id = labels_.number_of({2, {0, 77}});
  std::vector<CutReport> reports;
  stock_->cut(parse_tool_argument("1=ball:6").value().cutter, {&move, 1}, reports);
  stock_->finish(reports);
  settle();
  std::stop_source never;
  std::thread asks([&] {
    EXPECT_TRUE(until([&] { return is_shown(); }));
    commands_.push(PickCommand{Vec3(20, 10, -2)});
    EXPECT_TRUE(until([&] { return static_cast<bool>(known_.picked); }));
    commands_.push(CloseCommand{});
  });
  view_->end(stock_.get(), labels_.all(), never.get_token());
  asks.join();
  ASSERT_TRUE(known_.picked);
  EXPECT_EQ(known_.picked->tool, 2);
  EXPECT_EQ(known_.picked->line, 77);
}

TEST_F(LiveViewTest, StaysAtTheEndUntilItIsClosedOrStopped) {
  open(options());
  frame(at({1, 2, 3}));
  std::stop_source never;
  std::thread closes([&] {
    EXPECT_TRUE(until([&] { return is_shown(); }));
    commands_.push(CloseCommand{});
  });
  view_->end(stock_.get(), {}, never.get_token());
  closes.join();
  EXPECT_TRUE(closed_);

  closed_ = false;
  open(options());
  std::stop_source stop;
  std::thread stops([&] { stop.request_stop(); });
  view_->end(stock_.get(), {}, stop.get_token());
  stops.join();
  EXPECT_FALSE(closed_);
}

TEST_F(LiveViewTest, EndsWhileItsProgramIsStillRead) {
  LiveViewOptions wanted = options();
  wanted.load_program = [](const std::stop_token& stop) -> std::unique_ptr<LiveProgram> {
    while (!stop.stop_requested()) std::this_thread::yield();
    return nullptr;
  };
  open(std::move(wanted));
  frame(at({1, 2, 3}));
  view_.reset();
  EXPECT_FALSE(closed_);
}

}  // namespace
}  // namespace kerf
