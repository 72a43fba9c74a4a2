// A part in several setups in the window's work: played through, to and fro, without a window.
#include "twin/cli/view_setups.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/base/temporary_folder.h"
#include "twin/cli/view_work.h"

namespace kerf {
namespace {

/// A plunge of tool 1 at X Y down to Z.
std::string plunge(double x, double y, double z) {
  return fmt::format("G21 G90\nT1 M6 S8000 M3\nG0 X{} Y{} Z2\nG1 Z{} F6000\nG0 Z5\nM2\n", x, y, z);
}

class ViewSetupsTest : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() + "/" + name) << text;
  }
  void SetUp() override {
    write("top.ngc", plunge(10, 10, -5));
    write("bottom.ngc", plunge(30, 10, -8));
    write("end.ngc", plunge(20, 15, -3));
    write("job.yaml",
          "setups:\n"
          "  - {program: top.ngc, stock: 'box:0,0,-20:40,30,0', tools: 1=flat:8, cell_mm: 0.5,\n"
          "     name: top}\n"
          "  - {program: bottom.ngc, tools: 1=flat:6, flip: x, zero: top}\n"
          "  - {program: end.ngc, tools: 1=flat:4}\n");
  }
  void start(std::optional<double> speed, std::size_t first = 0) {
    Arguments arguments;
    arguments.command = kView;
    arguments.options.set("PROGRAM", folder_.path() + "/job.yaml");
    if (speed) arguments.options.set("--speed", fmt::format("{}", *speed));
    Diagnostics diagnostics;
    auto setups = ViewSetups::open(arguments, diagnostics);
    ASSERT_TRUE(setups) << (diagnostics.empty() ? "" : diagnostics[0].message);
    ASSERT_FALSE(setups->begin(first));
    const Arguments own = setups->arguments();
    ViewRequest request = understand_view(own, diagnostics);
    ASSERT_FALSE(has_error(diagnostics)) << diagnostics[0].message;
    request.run.quiet = true;
    request.run.session.blank_words = setups->blank_words(own);
    work_ = std::make_unique<ViewWork>(own, std::move(request), mailbox_, commands_, stop_,
                                       ViewWork::Replay{}, std::move(setups));
    thread_ = std::thread([this] { work_->run(); });
  }
  void TearDown() override {
    commands_.push(CloseCommand{});
    if (thread_.joinable()) thread_.join();
  }
  template <class Condition>
  bool waits(const Condition& is_there) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
      if (const auto update = mailbox_.take()) {
        if (update->job) {
          job_ = update->job;
          ++jobs_;
        }
        if (update->moment) moment_ = update->moment;
        if (update->setup) title_ = update->setup->title;
        if (update->program) program_ = update->program;
      }
      if (is_there()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  bool shows(std::size_t setup) {
    return waits([&] { return job_ && job_->setup == setup && job_->faults.empty(); });
  }
  bool ends(const std::string& program) {
    return waits([&] {
      return moment_ && moment_->state == PlayState::kEnded && program_ &&
             program_name() == program;
    });
  }
  /// What the program that is shown takes from where it begins, mm3.
  double removed_by(const std::string& program) {
    EXPECT_TRUE(waits([&] { return program_ && program_name() == program; }));
    moment_.reset();
    commands_.push(SeekEndCommand{});
    EXPECT_TRUE(ends(program));
    settle();
    const double after_mm3 = moment_ ? moment_->removed_mm3 : 0;
    commands_.push(StopCommand{});
    EXPECT_TRUE(waits([&] { return moment_ && moment_->state == PlayState::kPaused; }));
    settle();
    return moment_ ? after_mm3 - moment_->removed_mm3 : 0;
  }
  /// The volume is told half a second later, where nothing else wants the processor.
  void settle() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
    waits([&] { return std::chrono::steady_clock::now() > end; });
  }
  std::string program_name() const {
    return std::filesystem::path(program_->files[0].path()).filename().string();
  }

  TemporaryFolder folder_;
  SceneMailbox mailbox_{[] {}};
  CommandQueue commands_;
  std::stop_source stop_;
  std::unique_ptr<ViewWork> work_;
  std::thread thread_;
  std::shared_ptr<const ViewedJob> job_;
  std::shared_ptr<const Moment> moment_;
  std::shared_ptr<const ProgramText> program_;
  std::string title_;
  int jobs_ = 0;  ///< how often it was told
};

TEST_F(ViewSetupsTest, AllSetupsPlayOneAfterTheOther) {
  start(1000);
  ASSERT_TRUE(shows(2));
  // Holes of 8, 6 and 4 mm, of all that has been taken; in cells of 0.5 mm.
  const double all_mm3 = kPi * (16 * 5 + 9 * 8 + 4 * 3);
  ASSERT_TRUE(waits([&] {
    return moment_ && moment_->state == PlayState::kEnded && moment_->removed_mm3 > all_mm3 - 15;
  }));
  EXPECT_LT(moment_->removed_mm3, all_mm3 + 15);
  EXPECT_EQ(program_name(), "end.ngc");
  EXPECT_EQ(title_, "job.yaml, setup 3 of 3");
  EXPECT_EQ(job_->setups, (std::vector<std::string>{"1  top", "setup 2", "setup 3"}));
  EXPECT_EQ(job_->stock, "");
  EXPECT_EQ(job_->stock_in_use, "what setup 2 has left (the job)");
  EXPECT_EQ(job_->model_in_use, "mmap");
  EXPECT_EQ(job_->command, "kerf view " + folder_.path() + "/job.yaml --setup 3 --speed 1000");
  // It is the last, and does not begin anew.
  settle();
  EXPECT_EQ(job_->setup, 2u);
  EXPECT_EQ(moment_->state, PlayState::kEnded);
  // Whoever goes back from there looks at it.
  commands_.push(SetupCommand{1});
  ASSERT_TRUE(shows(1));
  settle();
  EXPECT_EQ(job_->setup, 1u);
  EXPECT_EQ(moment_->state, PlayState::kPaused);
}

TEST_F(ViewSetupsTest, WhereItIsSentToTheEndItStays) {
  start({});
  ASSERT_TRUE(shows(0));
  commands_.push(SeekEndCommand{});
  ASSERT_TRUE(ends("top.ngc"));
  settle();
  EXPECT_EQ(job_->setup, 0u);
  commands_.push(PlayCommand{});
  ASSERT_TRUE(shows(1)) << "there is no more of it to be played";
}

TEST_F(ViewSetupsTest, OneIsChosenAndWhatIsBeforeItIsCutFirst) {
  start({});
  ASSERT_TRUE(shows(0));
  ASSERT_TRUE(waits([&] { return !title_.empty(); }));
  EXPECT_EQ(title_, "job.yaml, setup 1 of 3: top");
  commands_.push(SetupCommand{2});
  ASSERT_TRUE(shows(2));
  ASSERT_TRUE(waits([&] { return program_ && program_name() == "end.ngc"; }));
  ASSERT_TRUE(waits([&] { return moment_ && moment_->state == PlayState::kPaused; }));
  commands_.push(SetupCommand{0});
  ASSERT_TRUE(shows(0));
  EXPECT_EQ(job_->stock, "box:0,0,-20:40,30,0");
  ASSERT_TRUE(waits([&] { return program_name() == "top.ngc"; }));
  commands_.push(SetupCommand{1});
  ASSERT_TRUE(shows(1));
  EXPECT_NEAR(removed_by("bottom.ngc"), 9 * kPi * 8, 8);
}

TEST_F(ViewSetupsTest, WhatIsCutOtherwiseGoesOnToTheNext) {
  start({}, 1);
  ASSERT_TRUE(shows(1));
  const std::string left = "what setup 1 (top) has left, flipped about X, Z0 on top (the job)";
  EXPECT_EQ(job_->stock_in_use, left);
  commands_.push(JobCommand{"", "", "", {{1, "flat:20"}}});
  ASSERT_TRUE(waits([&] { return !job_->tools.empty() && job_->tools[0].given == "flat:20"; }));
  EXPECT_EQ(job_->stock_in_use, left);
  EXPECT_EQ(job_->command, "kerf view " + folder_.path() + "/job.yaml --tool 1=flat:20 --setup 2");
  commands_.push(SetupCommand{2});
  ASSERT_TRUE(shows(2));
  // X20 Y15 is 11.2 mm from where 20 mm have been bored now: of a circle of radius 2 the part
  // beyond one of radius 10.
  const double d = std::sqrt(125.0), r = 2, big = 10;
  const double a = r * r * std::acos((d * d + r * r - big * big) / (2 * d * r)),
               b = big * big * std::acos((d * d + big * big - r * r) / (2 * d * big)),
               c = 0.5 * std::sqrt((-d + r + big) * (d + r - big) * (d - r + big) * (d + r + big));
  EXPECT_NEAR(removed_by("end.ngc"), 3 * (4 * kPi - (a + b - c)), 2.5);
}

TEST_F(ViewSetupsTest, AChangedProgramOfAnEarlierSetupIsToldAndCutAnew) {
  start({});
  ASSERT_TRUE(shows(0));
  commands_.push(SetupCommand{1});
  ASSERT_TRUE(shows(1));
  // Seen from below where bottom.ngc bores 8 mm: 5 are left there.
  write("top.ngc", plunge(30, 20, -15));
  ASSERT_TRUE(waits([&] {
    return moment_ &&
           moment_->notice == "setup 1 has been changed on the disk: go to it to cut it anew";
  }));
  job_.reset();
  commands_.push(SetupCommand{1});
  ASSERT_TRUE(shows(1));
  EXPECT_NEAR(removed_by("bottom.ngc"), 9 * kPi * 5, 5);
}

/// Going to and fro costs no cutting, until something is cut otherwise.
TEST_F(ViewSetupsTest, WhatASetupLeavesIsKept) {
  Arguments arguments;
  arguments.command = kView;
  arguments.options.set("PROGRAM", folder_.path() + "/job.yaml");
  Diagnostics diagnostics;
  const auto setups = ViewSetups::open(arguments, diagnostics);
  ASSERT_TRUE(setups);
  EXPECT_EQ(setups->last_ready(2), 0u);
  ASSERT_FALSE(setups->begin(2));
  EXPECT_EQ(setups->last_ready(2), 2u);
  const auto choose = [&](std::size_t setup) {
    FileWatch files;
    files.add(setups->arguments().options.text("PROGRAM"));
    setups->choose(setup, setups->arguments(), files);
  };
  choose(0);
  EXPECT_EQ(setups->last_ready(2), 2u);
  choose(1);
  EXPECT_EQ(setups->last_ready(2), 2u);
  setups->forget_next();
  EXPECT_EQ(setups->last_ready(2), 1u);
  write("top.ngc", plunge(10, 10, -6.5));
  EXPECT_EQ(setups->last_ready(2), 0u);
  EXPECT_EQ(setups->changed_before(), 0u);
  choose(0);
  EXPECT_EQ(setups->last_ready(1), 0u) << "what it left was of another program";
}

TEST_F(ViewSetupsTest, AProgramThatDoesNotComeToItsEndIsTheLast) {
  write("top.ngc", "G21 G90\nT1 M6\nG1 X10 F100 Q Q\nM2\n");
  start({});
  ASSERT_TRUE(shows(0));
  job_.reset();
  commands_.push(SetupCommand{1});
  ASSERT_TRUE(waits([&] { return job_ && !job_->faults.empty(); }));
  EXPECT_NE(job_->faults[0].find("job.yaml, setup 1 of 3: top does not come to its end"),
            std::string::npos)
      << job_->faults[0];
  EXPECT_EQ(job_->setup, 0u);
  // Played to where it ends, it says so once.
  job_.reset();
  commands_.push(PlayCommand{});
  ASSERT_TRUE(waits([&] { return job_ && !job_->faults.empty(); }));
  jobs_ = 0;
  settle();
  EXPECT_EQ(jobs_, 0);
  EXPECT_EQ(job_->setup, 0u);
}

TEST_F(ViewSetupsTest, AJobIsOpenedInTheWindow) {
  write("other.ngc", plunge(5, 5, -1));
  Arguments arguments;
  arguments.command = kView;
  arguments.options.set("PROGRAM", folder_.path() + "/other.ngc");
  Diagnostics diagnostics;
  ViewRequest request = understand_view(arguments, diagnostics);
  request.run.quiet = true;
  work_ = std::make_unique<ViewWork>(arguments, std::move(request), mailbox_, commands_, stop_);
  thread_ = std::thread([this] { work_->run(); });
  ASSERT_TRUE(waits([&] { return job_ && program_; }));
  EXPECT_TRUE(job_->setups.empty());
  commands_.push(OpenCommand{folder_.path() + "/job.yaml"});
  ASSERT_TRUE(waits([&] { return job_->setups.size() == 3; }));
  EXPECT_EQ(job_->program, folder_.path() + "/job.yaml");
  ASSERT_TRUE(waits([&] { return program_name() == "top.ngc"; }));
  commands_.push(OpenCommand{folder_.path() + "/other.ngc"});
  ASSERT_TRUE(waits([&] { return job_->setups.empty() && program_name() == "other.ngc"; }));
}

}  // namespace
}  // namespace kerf
