// What `kerf view` does beside its window, without one.
#include "twin/app/view_work.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/base/temporary_folder.h"
#include "twin/app/command_line.h"

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
  ViewArguments a;
  EXPECT_EQ(command_line(a), "kerf view");
  a.run.source.program = "my part's.ngc";
  a.run.source.ini = "mill.ini";
  a.run.work.stock = "box:0,0,-5:10,10,0";
  a.run.work.tools = {"1=flat:6", "2=drill:5:118"};
  a.run.work.additive = true;
  a.run.torch.beam = "!m62:3";
  EXPECT_EQ(command_line(a),
            "kerf view 'my part'\\''s.ngc' --ini mill.ini --stock box:0,0,-5:10,10,0 "
            "--tool 1=flat:6 --tool 2=drill:5:118 --additive --beam '!m62:3'");
}

TEST(CommandLine, OfARunSaysWhatWasGuessed) {
  RunArguments a;
  a.kerf = "build/kerf";
  a.source.program = "-";
  a.source.units = "inch";
  a.outputs.json = "r.json";
  a.from_line = "7";
  a.verbose = true;
  EXPECT_EQ(command_line(a), "build/kerf run - --units inch --from-line 7 --json r.json --verbose");
  a.work.below = "0.25";
  const std::vector<GuessRow> rows{{"blank", "--stock", "box:0,0,-5:10,10,0", "by its moves"},
                                   {"beam", "--beam", "m62:0", ""},
                                   {"tool 1", "--tool", "1=flat:6", ""},
                                   {"tool", "", "flat:3", "before the first tool change"}};
  EXPECT_EQ(command_line(with_guesses(a, rows)),
            "build/kerf run - --units inch --stock box:0,0,-5:10,10,0 --tool 1=flat:6 --below 0.25 "
            "--beam m62:0 --from-line 7 --json r.json --verbose");
}

class ViewWorkTest : public testing::Test {
 protected:
  void start(const ViewArguments& arguments) {
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
  ViewArguments arguments;
  arguments.run.source.program = write_file(folder_, "a.ngc", kProgram);
  arguments.run.work.stock = "box:-5,-5,-5:40,5,0";
  arguments.run.work.cell = "0.5";
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
  EXPECT_EQ(job_->command, "kerf view " + arguments.run.source.program +
                               " --stock box:-5,-5,-5:60,5,0 --tool 1=ball:4 --cell 0.25 --model "
                               "octree");
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

TEST_F(ViewWorkTest, AChangedProgramStandsWhereItStoodWithItsBreakpoints) {
  ViewArguments arguments;
  arguments.run.source.program = write_file(folder_, "a.ngc", kProgram);
  arguments.run.work.cell = "0.5";
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
  start(ViewArguments{});
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
