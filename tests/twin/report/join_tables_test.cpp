// Tables of several setups as one.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/base/temporary_folder.h"
#include "twin/report/motion_table.h"

namespace kerf {
namespace {

TEST(JoinTables, RowsGetTheNumberOfTheirSetupAndTheHeadingComesOnce) {
  const TemporaryFolder folder;
  const auto write = [&folder](const char* name, const char* text) {
    const std::string path = folder.path() + "/" + name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  };
  // A name with a line's end and quotes within it is one cell.
  const std::string first = write("1.csv", "line,file\r\n1,\"a\r\n\"\"b\"\".ngc\"\r\n2,c.ngc\r\n");
  const std::string third = write("3.csv", "line,file\r\n9,d.ngc\r\n");
  const std::string path = folder.path() + "/all.csv";
  const Done joined = join_motion_tables(path, {first, "", third});
  ASSERT_TRUE(joined) << joined.error();
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text, "line,file,setup\r\n1,\"a\r\n\"\"b\"\".ngc\",1\r\n2,c.ngc,1\r\n9,d.ngc,3\r\n");
  EXPECT_FALSE(join_motion_tables(path, {folder.path() + "/none.csv"}));
  std::ifstream again(path, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(again), {}), text) << "it was there before";
}

}  // namespace
}  // namespace kerf
