#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

const std::string kListing =
    "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
    "    2 N..... COMMENT(\"T1 D=6. - flat end mill\")\n"
    "printed text\n"
    "    3 N20    STRAIGHT_TRAVERSE(1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)\n"
    "    4 N..... STRAIGHT_FEED(2.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)\n"
    "    5 N..... PROGRAM_END()\n";

/// Makes stdin a pipe that holds `text`, for as long as it lives.
class StdinText {
 public:
  explicit StdinText(const std::string& text) : saved_(dup(STDIN_FILENO)) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    EXPECT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    dup2(ends[0], STDIN_FILENO);
    close(ends[0]);
    writer_ = ends[1];
  }
  void close_writer() { close(std::exchange(writer_, -1)); }
  int writer() const { return writer_; }
  ~StdinText() {
    if (writer_ >= 0) close(writer_);
    if (saved_ >= 0) dup2(saved_, STDIN_FILENO);
    if (saved_ >= 0) close(saved_);
  }

 private:
  int saved_;
  int writer_ = -1;
};

TEST(ListingProgram, IsToldByItsContent) {
  TestFolder folder;
  for (const char* name : {"part.canon", "part.txt"}) {
    const std::string path = folder.write(name, kListing);
    const ProgramRun run = run_program(path);
    EXPECT_EQ(run.messages(), "");
    EXPECT_EQ(run.summary.interpreter, "canon");
    EXPECT_EQ(run.summary.files, std::vector<std::string>{path});
    EXPECT_EQ(run.summary.program_lines, 6u);
    EXPECT_EQ(run.summary.foreign_lines, std::vector<std::string>{"printed text"});
    EXPECT_TRUE(run.summary.has_program_end);
    EXPECT_EQ(run.summary.canonical_commands.at("STRAIGHT_FEED"), 1u);
    EXPECT_EQ(run.summary.canonical_commands.size(), 5u);
    ASSERT_EQ(run.motions.size(), 3u);
    EXPECT_EQ(run.motions[0].source, (SourceRef{0, 20})) << "the N column";
    EXPECT_EQ(run.motions[1].source, (SourceRef{0, 5})) << "else the listing's own line";
    ASSERT_EQ(run.comments.size(), 1u);
    EXPECT_EQ(run.comments[0].text, "T1 D=6. - flat end mill");
  }
}

TEST(ListingProgram, ForeignLinesMayComeFirst) {
  TestFolder folder;
  const std::string path =
      folder.write("a.txt", "File: t.tbl Unrecognized line skipped:\nT6 D11\n" + kListing);
  EXPECT_EQ(run_program(path).summary.interpreter, "canon");
}

TEST(ListingProgram, Stdin) {
  StdinText input(kListing);
  input.close_writer();
  const ProgramRun run = run_program("-");
  EXPECT_EQ(run.messages(), "");
  EXPECT_EQ(run.motions.size(), 3u);
  EXPECT_EQ(run.summary.files, std::vector<std::string>{"stdin"});
  EXPECT_TRUE(run.comments.empty());
}

TEST(ListingProgram, EmptyStdinIsAnError) {
  StdinText input("");
  input.close_writer();
  EXPECT_EQ(run_program("-").messages(),
            "stdin: error: is empty; canonical text of rs274 is expected\n"
            "   hint: rs274 -v /nonexistent/x.var -g part.ngc | kerf run -\n");
}

TEST(ListingProgram, StdinThatIsNotCanonicalIsAnError) {
  StdinText input("G0 X1\nM2\n");
  input.close_writer();
  const ProgramRun run = run_program("-");
  EXPECT_EQ(run.diagnostics.at(0).message, "no line of it is a canonical command of rs274");
  EXPECT_EQ(run.summary.foreign_line_count, 2u);
}

TEST(ListingProgram, MotionsOfASlowWriterDoNotWait) {
  StdinText input(kListing.substr(0, kListing.size() - 1));  // the last line is not complete yet
  ProgramOptions options;
  options.path = "-";
  Diagnostics diagnostics;
  const auto program = Program::open(options, diagnostics);
  std::size_t motions = 0;
  // The writer never closes: the test ends only because the motions are handed over meanwhile.
  const ProgramSummary summary = program->run(
      [&](std::span<const Motion> batch) {
        motions += batch.size();
        return false;
      },
      {}, diagnostics);
  EXPECT_EQ(motions, 2u);
  EXPECT_TRUE(summary.stopped_early);
}

TEST(ListingProgram, StopTokenEndsAWaitForStdin) {
  StdinText input("");
  ProgramOptions options;
  options.path = "-";
  Diagnostics diagnostics;
  const auto program = Program::open(options, diagnostics);
  std::stop_source stop;
  stop.request_stop();
  const ProgramSummary summary =
      program->run([](std::span<const Motion>) { return true; }, stop.get_token(), diagnostics);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_TRUE(diagnostics.empty());
}

TEST(ListingProgram, MalformedAndUnknownLines) {
  TestFolder folder;
  const std::string path = folder.write("bad.canon",
                                        "    1 N..... WARP(1)\n    2 N..... DWELL(x)\n"
                                        "    3 N..... WARP(2)\n    4 N..... PROGRAM_END()\n");
  const ProgramRun run = run_program(path);
  EXPECT_EQ(run.messages(),
            path + ":1: warning: unknown canonical command WARP; it is counted and passed over\n" +
                path + ":2:20: error: DWELL: expected a number\n" +
                "     2 |     2 N..... DWELL(x)\n       |                    ^\n");
  EXPECT_EQ(run.summary.canonical_commands.at("WARP"), 2u);
}

TEST(ListingProgram, ManyFaultsAreSummedUp) {
  TestFolder folder;
  std::string text;
  for (int i = 0; i < 500; ++i) text += "    2 N..... DWELL(x)\n";
  const ProgramRun run =
      run_program(folder.write("bad.canon", text + "    4 N..... PROGRAM_END()\n"));
  ASSERT_EQ(run.diagnostics.size(), 21u);
  EXPECT_EQ(run.diagnostics.back().message, "480 more lines could not be read");
}

TEST(ListingProgram, AListingCutAtAnyByteEndsWell) {
  TestFolder folder;
  for (std::size_t bytes = 1; bytes < kListing.size(); ++bytes) {
    const ProgramRun run = run_program(folder.write("cut.canon", kListing.substr(0, bytes)));
    // Without its newline the last line is complete all the same.
    const bool complete = bytes + 1 == kListing.size();
    EXPECT_EQ(run.summary.has_program_end, complete) << bytes;
    EXPECT_EQ(run.diagnostics.empty(), complete) << bytes;
    EXPECT_LE(run.motions.size(), 3u);
  }
}

TEST(ListingProgram, NoEndIsAWarning) {
  TestFolder folder;
  const ProgramRun run =
      run_program(folder.write("a.canon", kListing.substr(0, kListing.rfind("    5 N"))));
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_EQ(run.diagnostics[0].severity, Severity::kWarning);
  EXPECT_EQ(run.motions.size(), 2u);
}

TEST(ListingProgram, CommandLimit) {
  TestFolder folder;
  ProgramOptions options;
  options.path = folder.write("a.canon", kListing);
  options.max_commands = 3;
  const ProgramRun run = run_program(options);
  EXPECT_EQ(run.diagnostics.at(0).message,
            "more than 3 canonical commands; the program counts as endless");
  EXPECT_TRUE(run.summary.stopped_early);
}

TEST(OpenProgram, WhatIsNotAProgram) {
  TestFolder folder;
  const auto said = [&](const std::string& path) {
    const ProgramRun run = run_program(path);
    EXPECT_FALSE(run.opened);
    return run.messages();
  };
  EXPECT_EQ(said(folder.path("none.ngc")),
            folder.path("none.ngc") + ": error: cannot be read: No such file or directory\n");
  EXPECT_EQ(said(folder.path("tmp")),
            folder.path("tmp") +
                ": error: is a folder; a program is an NC file or a canonical listing\n");
  EXPECT_EQ(said("/dev/null"),
            "/dev/null: error: is not a regular file\n"
            "   hint: canonical text from a pipe is read from stdin: -\n");
  const std::string empty = folder.write("empty.ngc", "");
  EXPECT_EQ(said(empty), empty + ": error: is empty\n");
  const std::string blank = folder.write("blank.ngc", " \r\n\n\t\n");
  EXPECT_EQ(said(blank), blank + ": error: is empty: it holds only white space\n");
  const std::string binary = folder.write("binary.ngc", std::string("G0\nX\0Y\n", 7));
  EXPECT_EQ(
      said(binary),
      binary + ":2: error: is not text: it holds a NUL byte\n   hint: a program is plain text\n");
  const std::string zipped = folder.write("part.canon.gz", "\x1f\x8b\x08");
  EXPECT_EQ(said(zipped),
            zipped +
                ": error: is compressed (gzip); a program is plain text\n"
                "   hint: gunzip it first, or pipe a listing: zcat part.canon.gz | kerf run -\n");
  EXPECT_EQ(said(""), "kerf: error: no program is named\n");
}

TEST(OpenProgram, UnreadableFile) {
  TestFolder folder;
  const std::string path = folder.write("secret.ngc", "M2\n");
  std::filesystem::permissions(std::filesystem::path(path).parent_path(),
                               std::filesystem::perms::others_exec,
                               std::filesystem::perm_options::add);
  std::filesystem::permissions(path, std::filesystem::perms::none);
  const bool was_root = geteuid() == 0;  // whom permissions do not stop
  if (was_root) {
    ASSERT_EQ(seteuid(65534), 0);
  }
  const ProgramRun run = run_program(path);
  if (was_root) {
    ASSERT_EQ(seteuid(0), 0);
  }
  EXPECT_EQ(run.messages(), path + ": error: cannot be read: Permission denied\n");
}

TEST(OpenProgram, InterpreterThatIsNotInstalled) {
  TestFolder folder;
  ProgramOptions options;
  options.path = folder.write("a.ngc", "M2\n");
  options.rs274_path = "rs274-of-nowhere";
  EXPECT_EQ(
      run_program(options).messages(),
      "kerf: error: LinuxCNC's interpreter was not found: no executable rs274-of-nowhere in PATH\n"
      "   hint: sudo apt install --no-remove linuxcnc-uspace\n");
  options.path = folder.write("a.canon", kListing);
  EXPECT_TRUE(run_program(options).opened) << "a listing needs no interpreter";
}

TEST(OpenProgram, CommentsOfNcText) {
  TestFolder folder;
  std::string text = "%\n(T1 D=6. - flat end mill) G0 X1 (second)\nG1 X1 ; with a semicolon\n( )\n";
  for (int i = 0; i < 3000; ++i) text += "G1 X1\n";
  text += "(far away)\nT2 M6 (6 mm ball)\n(STOCK 10 20 30)\nM2\n";
  ProgramOptions options;
  options.path = folder.write("a.ngc", text);
  options.rs274_path = "/bin/true";
  Diagnostics diagnostics;
  const auto program = Program::open(options, diagnostics);
  ASSERT_NE(program, nullptr);
  std::string found;
  for (const ProgramComment& comment : program->comments()) {
    found += std::to_string(comment.source.line) + " " + comment.text + "\n";
  }
  EXPECT_EQ(found,
            "2 T1 D=6. - flat end mill\n2 second\n3 with a semicolon\n3006 6 mm ball\n"
            "3007 STOCK 10 20 30\n");
}

}  // namespace
}  // namespace kerf
