// What `kerf view` does beside its window, without one.
#include "twin/cli/view_work.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/base/temporary_folder.h"
#include "twin/cli/command_line.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

constexpr const char* kProgram =
    "G21 G90\nT1 M6 S8000 M3\nG0 X0 Y0 Z2\nG1 Z-2 F1200\nG1 X20\nG1 X30\nG0 Z5\nM2\n";

std::string write_file(const TemporaryFolder& folder, const std::string& name,
                       const std::string& text) {
  const std::string path = folder.path() + "/" + name;
  std::ofstream(path) << text;
  return path;
}

TEST(FileWatch, TellsAChangeOnceNobodyWritesAnyMore) {
  const TemporaryFolder folder;
  const std::string path = write_file(folder, "a.ngc", "G0 X1\n");
  FileWatch watch;
  watch.add(path);
  watch.add(folder.path() + "/none.tbl");
  watch.add("-");
  const auto is_told = [&watch] {
    for (int looks = 0; looks < 8; ++looks) {
      if (watch.has_changed()) return true;
      std::this_thread::sleep_for(FileWatch::kPeriod / 2);
    }
    return false;
  };
  EXPECT_FALSE(is_told());
  write_file(folder, "a.ngc", "G0 X1\nG0 X2\n");
  EXPECT_TRUE(is_told());
  watch.clear();
  watch.add(path);
  std::filesystem::remove(path);
  EXPECT_FALSE(is_told()) << "an editor may be about to write it anew";
  write_file(folder, "a.ngc", "G0 X3\n");
  EXPECT_TRUE(is_told());
}

TEST(CommandLine, SaysWhatTheArgumentsSay) {
  Arguments a;
  a.command = kView;
  EXPECT_EQ(command_line(a), "kerf view");
  a.options.set("PROGRAM", "my part's.ngc");
  a.options.set("--ini", "mill.ini");
  a.options.set("--stock", "box:0,0,-5:10,10,0");
  a.options.set_all("--tool", {"1=flat:6", "2=drill:5:118"});
  a.options.set_flag("--additive");
  a.options.set("--beam", "!m62:3");
  EXPECT_EQ(command_line(a),
            "kerf view 'my part'\\''s.ngc' --ini mill.ini --stock box:0,0,-5:10,10,0 "
            "--additive --tool 1=flat:6 --tool 2=drill:5:118 --beam '!m62:3'");
}

TEST(CommandLine, OfARunSaysWhatWasGuessed) {
  Arguments a;
  a.words = {"build/kerf", "run"};
  a.options.set("PROGRAM", "-");
  a.options.set("--units", "inch");
  a.options.set("--json", "r.json");
  a.options.set("--from-line", "7");
  a.options.set_flag("--verbose");
  EXPECT_EQ(command_line(a), "build/kerf run - --units inch --from-line 7 --json r.json --verbose");
  a.options.set("--below", "0.25");
  const std::vector<GuessRow> rows{{"blank", "--stock", "box:0,0,-5:10,10,0", "by its moves"},
                                   {"beam", "--beam", "m62:0", ""},
                                   {"tool 1", "--tool", "1=flat:6", ""},
                                   {"tool", "", "flat:3", "before the first tool change"}};
  EXPECT_EQ(command_line(with_guesses(a, rows)),
            "build/kerf run - --units inch --stock box:0,0,-5:10,10,0 --below 0.25 "
            "--tool 1=flat:6 --beam m62:0 --from-line 7 --json r.json --verbose");
}

/// Of several programs each is one's own.
TEST(CommandLine, HasTheProgramThatIsSet) {
  Arguments a;
  a.options.set_all("PROGRAM", {"a.ngc", "b.ngc"});
  EXPECT_EQ(command_line(a), "kerf run a.ngc b.ngc");
  a.options.set("PROGRAM", "-b.ngc");
  EXPECT_EQ(command_line(a), "kerf run ./-b.ngc");
}

class ViewWorkTest : public testing::Test {
 protected:
  void start(const Arguments& arguments) {
    Diagnostics diagnostics;
    ViewRequest request = understand_view(arguments, diagnostics);
    ASSERT_FALSE(has_error(diagnostics));
    work_ = std::make_unique<ViewWork>(arguments, std::move(request), mailbox_, commands_, stop_);
    thread_ = std::thread([this] { work_->run(); });
  }
  void TearDown() override {
    commands_.push(CloseCommand{});
    if (thread_.joinable()) thread_.join();
  }
  /// Takes news as a window does, until `is_there` or ten seconds have gone by.
  template <class Condition>
  bool waits(const Condition& is_there) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < end) {
      if (const auto update = mailbox_.take()) {
        if (update->job) job_ = update->job;
        if (update->moment) moment_ = update->moment;
        if (update->setup) setup_ = update->setup;
        if (update->program) program_ = update->program;
      }
      if (is_there()) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
  }

  TemporaryFolder folder_;
  SceneMailbox mailbox_{[] {}};
  CommandQueue commands_;
  std::stop_source stop_;
  std::unique_ptr<ViewWork> work_;
  std::thread thread_;
  std::shared_ptr<const ViewedJob> job_;
  std::shared_ptr<const Moment> moment_;
  std::shared_ptr<const SceneSetup> setup_;
  std::shared_ptr<const ProgramText> program_;
};

TEST_F(ViewWorkTest, BlankAndToolsAreChangedAndTheCommandLineSaysSo) {
  Arguments arguments;
  arguments.command = kView;
  arguments.options.set("PROGRAM", write_file(folder_, "a.ngc", kProgram));
  arguments.options.set("--stock", "box:-5,-5,-5:40,5,0");
  arguments.options.set("--cell", "0.5");
  start(arguments);
  ASSERT_TRUE(waits([&] { return job_ && setup_; }));
  EXPECT_EQ(setup_->bounds_mm.max.x, 40.0);
  ASSERT_EQ(job_->tools.size(), 1u);
  EXPECT_EQ(job_->tools[0].given, "");
  EXPECT_EQ(job_->cell_in_use, "0.5");
  job_.reset();
  commands_.push(JobCommand{"box:-5,-5,-5:60,5,0", "0.25", "octree", {{1, "ball:4"}}});
  ASSERT_TRUE(waits([&] { return job_ && setup_->bounds_mm.max.x == 60.0; }));
  EXPECT_EQ(job_->model_in_use, "octree");
  EXPECT_EQ(job_->tools[0].in_use, "ball:4");
  EXPECT_EQ(job_->command, "kerf view " + arguments.options.text("PROGRAM") +
                               " --stock box:-5,-5,-5:60,5,0 --model octree --cell 0.25 "
                               "--tool 1=ball:4");
  EXPECT_TRUE(setup_->keeps_eye);
  // What is wrong is said, and what was there stays.
  job_.reset();
  setup_.reset();
  commands_.push(JobCommand{"bax:1", "0.25", "", {{1, "ball:4"}}});
  ASSERT_TRUE(waits([&] { return job_ != nullptr; }));
  ASSERT_FALSE(job_->faults.empty());
  EXPECT_NE(job_->faults[0].find("--stock"), std::string::npos) << job_->faults[0];
  EXPECT_EQ(job_->stock, "bax:1");
  EXPECT_FALSE(setup_);
}

/// What is typed into the window's fields has the units of the command line.
TEST_F(ViewWorkTest, TheJobIsInTheUnitsOfTheCommandLine) {
  Arguments arguments;
  arguments.command = kView;
  arguments.options.set("PROGRAM", write_file(folder_, "a.ngc", kProgram));
  arguments.options.set("--units", "inch");
  arguments.options.set("--stock", "box:-1,-1,-1:2,1,0");
  arguments.options.set("--cell", "0.02");
  start(arguments);
  ASSERT_TRUE(waits([&] { return job_ && setup_; }));
  EXPECT_EQ(job_->unit, LengthUnit::kInch);
  EXPECT_EQ(job_->cell_in_use, "0.02");
  job_.reset();
  commands_.push(JobCommand{"box:-1,-1,-1:3,1,0", "0.01", "", {}});
  ASSERT_TRUE(waits([&] { return job_ && setup_->bounds_mm.max.x > 60.0; }));
  EXPECT_DOUBLE_EQ(setup_->bounds_mm.max.x, 3 * 25.4);
  EXPECT_EQ(job_->cell_in_use, "0.01");
  EXPECT_EQ(job_->unit, LengthUnit::kInch);
}

TEST_F(ViewWorkTest, AChangedProgramStandsWhereItStoodWithItsBreakpoints) {
  Arguments arguments;
  arguments.command = kView;
  arguments.options.set("PROGRAM", write_file(folder_, "a.ngc", kProgram));
  arguments.options.set("--cell", "0.5");
  start(arguments);
  ASSERT_TRUE(waits([&] { return job_ && moment_ && program_; }));
  commands_.push(BreakpointCommand{program_->files[0].path(), 6, true});
  commands_.push(SeekLineCommand{"", 5});
  ASSERT_TRUE(waits([&] { return moment_->line == 5 && moment_->breakpoints.size() == 1; }));
  program_.reset();
  moment_.reset();
  std::string longer = kProgram;
  longer.replace(longer.find("G0 Z5"), 5, "G1 X35\nG0 Z5");
  const auto begin = std::chrono::steady_clock::now();
  write_file(folder_, "a.ngc", longer);
  ASSERT_TRUE(waits([&] { return program_ && moment_ && moment_->line == 5; }));
  ASSERT_TRUE(waits([&] { return moment_->breakpoints.size() == 1; }));
  EXPECT_EQ(moment_->breakpoints[0].line, 6);
  EXPECT_EQ(program_->files[0].line_count(), 9);
  // A second is what was promised; a computer that does other work takes longer.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST_F(ViewWorkTest, WithoutAProgramItWaitsForOne) {
  Arguments arguments;
  arguments.command = kView;
  start(arguments);
  ASSERT_TRUE(waits([&] { return job_ != nullptr; }));
  EXPECT_EQ(job_->program, "");
  EXPECT_EQ(job_->command, "kerf view");
  job_.reset();
  commands_.push(OpenCommand{folder_.path() + "/none.ngc"});
  ASSERT_TRUE(waits([&] { return job_ && !job_->faults.empty(); }));
  job_.reset();
  const std::string path = write_file(folder_, "a.ngc", kProgram);
  commands_.push(OpenCommand{path});
  ASSERT_TRUE(waits([&] { return job_ && program_; }));
  EXPECT_EQ(job_->program, path);
  EXPECT_TRUE(job_->faults.empty());
  EXPECT_EQ(setup_->title, "a.ngc");
}

}  // namespace
}  // namespace kerf
