// `kerf canon` from the outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

const char* const kListing =
    "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
    "    2 N1     SELECT_TOOL(1)\n"
    "    3 N1     CHANGE_TOOL(1)\n"
    "    4 N3     STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
    "    5 N4     SET_FEED_RATE(300.0000)\n"
    "    6 N4     STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
    "    7 N5     ARC_FEED(10.0000, 0.0000, 5.0000, 0.0000, -1, -1.0000, 0.0000, 0.0000, 0.0000)\n"
    "    8 N8     PROGRAM_END()\n";

class CanonCommand : public testing::Test {
 protected:
  KerfResult run(std::vector<std::string> arguments, const std::string& input = "") {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.arguments.insert(call.arguments.begin(), "canon");
    call.folder = folder_.path();
    call.input = input;
    return run_kerf(call);
  }
  static std::vector<Json> lines_of(const std::string& text) {
    std::vector<Json> out;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      out.push_back(Json::parse(line, nullptr, false));
      EXPECT_FALSE(out.back().is_discarded()) << line;
    }
    return out;
  }
  TestFolder folder_;
};

TEST_F(CanonCommand, OneObjectAMotion) {
  folder_.write("part.canon", kListing);
  const KerfResult result = run({"part.canon"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const std::vector<Json> lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 5U);
  const char* const kinds[] = {"tool-change", "traverse", "feed", "arc", "program-end"};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i]["kind"], kinds[i]);
    EXPECT_EQ(lines[i]["file"], "part.canon");
  }
  EXPECT_EQ(lines[2]["line"], 4);
  EXPECT_EQ(lines[2]["from"], Json({0, 0, 5}));
  EXPECT_EQ(lines[2]["to"], Json({0, 0, -1}));
  EXPECT_EQ(lines[2]["feed"], 300);
  EXPECT_NEAR(lines[3]["sweep_deg"].get<double>(), -180, 1e-9);
}

TEST_F(CanonCommand, ToAFileAndFromStandardInput) {
  const KerfResult result = run({"-", "--out", "part.jsonl"}, kListing);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(lines_of(read_file(folder_.file("part.jsonl"))).size(), 5U);
}

TEST_F(CanonCommand, FaultsAreThoseOfRun) {
  EXPECT_EQ(run({"nix.ngc"}).exit_code, 4);
  EXPECT_EQ(run({"nix.ngc"}).err, "nix.ngc: error: cannot be read: No such file or directory\n");
  const KerfResult option = run({"part.ngc", "--quite"});
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_EQ(
      option.err,
      "kerf: error: unknown option --quite; did you mean --quiet?\n   hint: kerf canon --help "
      "lists what there is\n");
  EXPECT_EQ(run({"part.ngc", "--block-delete", "maybe"}).err,
            "kerf: error: --block-delete: 'maybe' is not allowed; must be on or off\n");
  folder_.write("part.canon", kListing);
  const KerfResult full = run({"part.canon", "--out", "/dev/full"});
  EXPECT_EQ(full.exit_code, 4);
  EXPECT_EQ(full.err, "kerf: error: writing /dev/full: No space left on device\n");
}

TEST_F(CanonCommand, AListingWithoutAnEndIsAWarning) {
  const std::string text(kListing);
  const KerfResult result = run({"-"}, text.substr(0, text.rfind("    8")));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("no program end"), std::string::npos) << result.err;
  EXPECT_EQ(lines_of(result.out).size(), 4U);
}

}  // namespace
}  // namespace kerf
