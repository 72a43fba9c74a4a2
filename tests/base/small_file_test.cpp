#include "base/small_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

class SmallFile : public ::testing::Test {
 protected:
  std::string write(const std::string& bytes) const {
    const std::string path = folder_.path() + "/file";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  TemporaryFolder folder_;
};

TEST_F(SmallFile, IsReadAsItIs) {
  std::string bytes = "a\r\n\n";
  bytes += '\0';
  bytes += "\xff";
  EXPECT_EQ(*read_small_file(write(bytes), 100), bytes);
  EXPECT_EQ(*read_small_file(write(""), 100), "");
  const std::string pieces(600'000, 'x');
  EXPECT_EQ(*read_small_file(write(pieces), pieces.size()), pieces);
}

TEST_F(SmallFile, ALargerOneIsRefused) {
  const std::string path = write(std::string((1 << 20) + 1, 'x'));
  const auto refused = read_small_file(path, 1 << 20);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), "cannot read " + path + ": larger than 1 MB");
  EXPECT_EQ(read_small_file(path, 1 << 20, "no table is so long").error(), "no table is so long");
}

TEST_F(SmallFile, WhatIsNoFileIsRefused) {
  EXPECT_EQ(read_small_file(folder_.path(), 100).error(),
            "cannot read " + folder_.path() + ": it is not a regular file");
  const std::string none = folder_.path() + "/none";
  EXPECT_EQ(read_small_file(none, 100).error(),
            "cannot read " + none + ": No such file or directory");
}

TEST_F(SmallFile, AStreamIsReadUpToWhatIsAllowed) {
  std::istringstream in("abcdef");
  EXPECT_EQ(read_up_to(in, 4), "abcd");
  EXPECT_EQ(read_up_to(in, 4), "ef");
  EXPECT_EQ(read_up_to(in, 4), "");
  std::ifstream none(folder_.path() + "/none");
  EXPECT_EQ(read_up_to(none, 4), "");
}

}  // namespace
}  // namespace kerf
