// Files that hold a library, and such that hold none.
#include <gtest/gtest.h>

#include <fstream>

#include "base/small_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/base/zip_writer.h"
#include "tests/twin/tool_library/library_support.h"

namespace kerf {
namespace {

std::string one_zipped(const char* name, const std::string& text) { return zipped({{name, text}}); }

constexpr const char* kTool =
    R"({"data": [{"type": "flat end mill", "geometry": {"DC": 6}, "post-process": {"number": 1}}]})";

TEST(LibraryFiles, ZippedOnesOfFusion) {
  const ReadLibrary read(one_zipped("tools.json", kTool));
  EXPECT_EQ(text_of(read), "1: flat:6\n");
  EXPECT_EQ(read.library->format, "Fusion");
}

TEST(LibraryFiles, ZipFilesThatAreNone) {
  EXPECT_EQ(text_of(ReadLibrary(one_zipped("readme.txt", kTool))),
            "is a zip file without a .json in it; tools.json is needed\n");
  const std::string whole = one_zipped("tools.json", kTool);
  for (std::size_t size = 4; size < whole.size(); ++size) {
    ASSERT_FALSE(ReadLibrary(std::string_view(whole).substr(0, size)).library) << size;
  }
  std::string wrong = whole;
  wrong[whole.find("tools.json") + 14] ^= 0x55;
  EXPECT_EQ(text_of(ReadLibrary(wrong)), "its .json cannot be unpacked\n");
}

/// A few hundred kilobytes that would be more than is taken.
TEST(LibraryFiles, AZipFileThatUnpacksToFarMore) {
  const std::string bomb = one_zipped("tools.json", std::string(kMaxToolLibrary_bytes + 1, ' '));
  EXPECT_LT(bomb.size(), 1U << 20U);
  EXPECT_EQ(text_of(ReadLibrary(bomb)), "its .json is larger than 64 MB\n");
}

TEST(LibraryFiles, WhatIsNoLibrary) {
  EXPECT_EQ(text_of(ReadLibrary("")), "is empty\n");
  EXPECT_EQ(text_of(ReadLibrary(" \n")), "is empty\n");
  EXPECT_EQ(text_of(ReadLibrary("hello\n")), "is no tool library\n");
  EXPECT_EQ(text_of(ReadLibrary("<?xml version='1.0'?>")), "is XML, which is not read\n");
  EXPECT_EQ(text_of(ReadLibrary("; a table\nT1 P1 D6.0 ;6 mm\n")),
            "is a tool table of LinuxCNC, not a tool library\n");
  EXPECT_EQ(text_of(ReadLibrary(R"({"a": 1})")), "is JSON, but no tool library\n");
  EXPECT_EQ(text_of(ReadLibrary("[1, 2]")), "is JSON, but no tool library\n");
  EXPECT_EQ(text_of(ReadLibrary("{\"data\": [\n {\"type\": \"flat\",]}")),
            "2:18: is no JSON from here on\n");
  EXPECT_EQ(text_of(ReadLibrary("{\"data\": [\n {\"type\": \"flat")),
            "2:16: the file ends within its JSON; it is not whole\n");
  EXPECT_EQ(text_of(ReadLibrary(R"({"data": [{"geometry": {"DC": NaN}}]})")),
            "1:31: is no JSON from here on\n");
  EXPECT_EQ(text_of(ReadLibrary(R"({"data": [{"geometry": {"DC": 1e999}}]})")),
            "is JSON with a number that is too large\n");
  EXPECT_FALSE(ReadLibrary(std::string(100'000, '[')).library);
}

TEST(LibraryFiles, OddValuesWithinOne) {
  const ReadLibrary read(R"({"data": [1, "x", null, [], {"type": 3}, {"type": "drill"},
      {"type": "drill", "geometry": []}, {"type": "drill", "geometry": {"DC": {}}},
      {"type": "flat end mill", "unit": 5, "post-process": 7, "holder": [],
       "geometry": {"DC": 6, "NOF": 1e300, "LCF": "12,5"}}]})");
  ASSERT_TRUE(read.library);
  ASSERT_EQ(read.library->tools.size(), 9u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_FALSE(read.library->tools[i].cutter) << i;
  EXPECT_EQ(text_of(read.library->tools[8]), "-: flat:6:flute=12.5");
}

TEST(LibraryFiles, FilesThatCannotBeRead) {
  const TemporaryFolder folder;
  Diagnostics diagnostics;
  EXPECT_FALSE(read_tool_library(folder / "none.json", diagnostics));
  EXPECT_FALSE(read_tool_library(folder.path(), diagnostics));
  std::ofstream(folder / "large.json").close();
  std::filesystem::resize_file(folder / "large.json", kMaxToolLibrary_bytes + 1);
  EXPECT_FALSE(read_tool_library(folder / "large.json", diagnostics));
  ASSERT_EQ(diagnostics.size(), 3u);
  EXPECT_NE(diagnostics[0].message.find("No such file"), std::string::npos);
  EXPECT_NE(diagnostics[1].message.find("not a regular file"), std::string::npos);
  EXPECT_NE(diagnostics[2].message.find("larger than 64 MB"), std::string::npos);
}

}  // namespace
}  // namespace kerf
