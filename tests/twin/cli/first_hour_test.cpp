// What a new user meets first: programs of which nothing is known, several of them, one on standard
// input, tools that nobody uses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

constexpr const char* kSlot =
    "G21 G90 G17\n"
    "T1 M6\n"
    "S8000 M3\n"
    "G0 X10 Y10 Z5\n"
    "G1 Z-3 F200\n"
    "G1 X40\n"
    "G0 Z5\n"
    "M30\n";

class FirstHour : public ::testing::Test {
 protected:
  FirstHour() {
    folder_.write("slot.ngc", kSlot);
    folder_.write("deep.ngc", std::string(kSlot).replace(std::string(kSlot).find("Z-3"), 3, "Z-9"));
  }
  KerfResult kerf(std::vector<std::string> arguments, std::string input = {}) const {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    call.input = std::move(input);
    return run_kerf(call);
  }
  Json json(const std::string& name) const {
    std::ifstream in(folder_.file(name));
    return Json::parse(in, nullptr, false);
  }
  TestFolder folder_;
};

/// The last line of the summary, less kerf itself.
std::vector<std::string> command_in(const std::string& summary) {
  const std::size_t begin = summary.find(" run slot.ngc");
  std::string line = summary.substr(begin + 1);
  line.pop_back();
  std::vector<std::string> words{""};
  for (const char c : line) {
    if (c == ' ') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

TEST_F(FirstHour, TheCommandOfTheSummaryCutsTheSameWithoutAGuess) {
  const KerfResult guessed = kerf({"run", "slot.ngc", "--json", "guessed.json"});
  ASSERT_EQ(guessed.exit_code, 0) << guessed.err;
  std::vector<std::string> command = command_in(guessed.out);
  ASSERT_EQ(command.size(), 8U) << guessed.out;
  EXPECT_EQ(command.back(), "guessed.json");
  command.back() = "given.json";
  command.push_back("--no-guess");
  const KerfResult given = kerf(command);
  EXPECT_EQ(given.exit_code, 0) << given.err;
  EXPECT_EQ(given.err.find("guess"), std::string::npos) << given.err;
  EXPECT_EQ(json("guessed.json")["stock"]["digest"], json("given.json")["stock"]["digest"]);
  EXPECT_GT(json("given.json")["stock"]["removed_mm3"], 90.0);
  EXPECT_TRUE(json("guessed.json").contains("guessed"));
  EXPECT_FALSE(json("given.json").contains("guessed"));
}

TEST_F(FirstHour, ViewSaysWhatItGuessesAndRefusesToByWish) {
  const KerfResult result = kerf({"view", "slot.ngc", "--png", "view.png", "--size", "64x48"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("guessed   blank   box:4,4,-8:46,16,0"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("kerf view slot.ngc --stock box:4,4,-8:46,16,0 --tool 1=flat:1 --png"),
            std::string::npos);
  const KerfResult refused = kerf({"view", "slot.ngc", "--png", "view.png", "--no-guess"});
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find("--no-guess: nothing is known of tool 1"), std::string::npos)
      << refused.err;
}

TEST_F(FirstHour, NcTextOnStandardInputIsTheProgram) {
  const std::vector<std::string> common{"--stock", "box:0,0,-10:50,30,0", "--tool", "1=flat:6"};
  std::vector<std::string> file{"run", "slot.ngc", "--json", "file.json"};
  std::vector<std::string> input{"run", "-", "--json", "stdin.json"};
  file.insert(file.end(), common.begin(), common.end());
  input.insert(input.end(), common.begin(), common.end());
  EXPECT_EQ(kerf(file).exit_code, 0);
  const KerfResult result = kerf(input, kSlot);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.rfind("verdict   stdin: no findings", 0), 0U) << result.out;
  EXPECT_EQ(json("file.json")["stock"]["digest"], json("stdin.json")["stock"]["digest"]);
  EXPECT_EQ(json("stdin.json")["program"]["path"], "stdin");
}

TEST_F(FirstHour, FaultsOfStandardInputHaveItsName) {
  const KerfResult result =
      kerf({"run", "-", "--stock", "box:0,0,-10:50,30,0", "--tool", "1=flat:6"},
           "G21 G90\nT1 M6 S8000 M3\nG0 X10 Y10 Z5\nG1 Z-1 F100\nG1 XX\nM30\n");
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("stdin:5: error: interpreter-error"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("kerf-"), std::string::npos)
      << "the file it was kept in: " << result.err;
}

TEST_F(FirstHour, CanonTakesBothKindsOfStandardInput) {
  const KerfResult file = kerf({"canon", "slot.ngc"});
  const KerfResult input = kerf({"canon", "-"}, kSlot);
  EXPECT_EQ(input.exit_code, 0) << input.err;
  EXPECT_EQ(std::count(file.out.begin(), file.out.end(), '\n'),
            std::count(input.out.begin(), input.out.end(), '\n'));
  EXPECT_NE(input.out.find("\"file\":\"stdin\""), std::string::npos) << input.out;
}

TEST_F(FirstHour, SeveralProgramsEachHaveASummaryAndTheWorstExitCodeCounts) {
  const std::vector<std::string> common{"--stock", "box:0,0,-5:50,30,0", "--tool", "1=flat:6"};
  std::vector<std::string> sound{"run", "slot.ngc", "slot.ngc"};
  std::vector<std::string> mixed{"run", "deep.ngc", "slot.ngc"};
  sound.insert(sound.end(), common.begin(), common.end());
  mixed.insert(mixed.end(), common.begin(), common.end());
  const KerfResult good = kerf(sound);
  EXPECT_EQ(good.exit_code, 0) << good.err;
  const KerfResult result = kerf(mixed);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.out.find("verdict   deep.ngc: 1 error"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("verdict   slot.ngc: no findings"), std::string::npos) << result.out;
  mixed[1] = "missing.ngc";
  const KerfResult missing = kerf(mixed);
  EXPECT_EQ(missing.exit_code, 4);
  EXPECT_NE(missing.out.find("verdict   slot.ngc: no findings"), std::string::npos) << missing.out;
}

TEST_F(FirstHour, SeveralProgramsHaveNoOneOutputFile) {
  const KerfResult result =
      kerf({"run", "slot.ngc", "deep.ngc", "--json", "r.json", "--png", "p.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "kerf: error: --json: r.json: one file, and there are 2 programs\n"
            "   hint: run them one by one, each with a file of its own\n"
            "kerf: error: --png: p.png: one file, and there are 2 programs\n"
            "   hint: run them one by one, each with a file of its own\n");
}

TEST_F(FirstHour, AToolThatIsNotUsedIsTold) {
  const std::vector<std::string> given{"run",    "slot.ngc", "--stock", "box:0,0,-10:50,30,0",
                                       "--tool", "1=flat:6", "--tool",  "7=ball:3"};
  const KerfResult result = kerf(given);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("slot.ngc: note: tool-unused: --tool 7=ball:3: the program never uses "
                            "tool 7; it uses 1\n"),
            std::string::npos)
      << result.err;
  std::vector<std::string> part = given;
  part.insert(part.end(), {"--until-line", "6"});
  EXPECT_EQ(kerf(part).err.find("tool-unused"), std::string::npos) << "it may come later";
}

TEST_F(FirstHour, VerboseSaysWhatTheSummaryLeavesOut) {
  const KerfResult brief = kerf({"run", "slot.ngc"});
  EXPECT_EQ(brief.out.find("servo period"), std::string::npos) << brief.out;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = brief.out.find('\n', at);
    const std::string line = brief.out.substr(at, end - at);
    if (line.find(" run ") != std::string::npos) continue;  // the command, as long as it is
    EXPECT_LE(line.size(), 120U) << line;
  }
  EXPECT_NE(kerf({"run", "slot.ngc", "--verbose"}).out.find("servo period"), std::string::npos);
  EXPECT_EQ(kerf({"run", "slot.ngc", "--verbose", "--quiet"}).exit_code, 2);
}

TEST_F(FirstHour, EveryHelpOfAStockNamesTheAxisOfRoundBlanks) {
  for (const char* command : {"run", "view", "shadow", "replay"}) {
    std::string help = kerf({command, "--help"}).out;
    std::erase(help, ' ');
    std::erase(help, '\n');
    EXPECT_NE(help.find("cylinder:x,y,z0:z1:d[:axis]"), std::string::npos) << command;
    EXPECT_NE(help.find("tube:x,y,z0:z1:d:inner[:axis]"), std::string::npos) << command;
  }
}

}  // namespace
}  // namespace kerf
