// Holders of turning tools from files.
#include "stock/cutter/turning_holder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

constexpr const char* kHolder =
    "# of T1\n"
    "part\n"
    "point 5 14\n"
    "point 25 14\n"
    "point 25 100   # far end\n"
    "point 5 100\n"
    "\n"
    "part\n"
    "POINT 0.5 6\npoint 5 30\npoint 10 8\n";

TEST(TurningHolder, PartsAreConvexAndCounterClockwise) {
  const auto parts = parse_turning_holder(kHolder, "h.txt");
  ASSERT_TRUE(parts) << (parts ? "" : parts.error());
  ASSERT_EQ(parts->size(), 2u);
  for (const InsertPart& part : *parts) {
    double area = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Vec2 a = part[i].end_mm, b = part[(i + 1) % part.size()].end_mm;
      area += (a.x * b.y - a.y * b.x) / 2;
      EXPECT_EQ(part[i].side, InsertSide::kHolder);
    }
    EXPECT_NEAR(area, part.size() == 4 ? 20.0 * 86 : 109.5, 1e-9);
  }
}

TEST(TurningHolder, FaultsNameTheirLine) {
  const std::string head = "part\n";
  for (const auto& [text, wanted] : std::vector<std::pair<std::string, const char*>>{
           {"", "h.txt:0: no part"},
           {"point 1 2\n", "h.txt:1: a point before the first 'part'"},
           {"line 1 2\n", "h.txt:1: 'line' is not understood"},
           {head + "point 1\n", "h.txt:2: 'point' is not understood"},
           {head + "point 1 x\n", "h.txt:2: Z and X must be numbers from -300 to 300"},
           {head + "point 250 250\n", "h.txt:2: the point is 353.6 mm away"},
           {head + "point 1 1\npoint 1 1\n", "h.txt:3: the point before it is the same one"},
           {head + "point 1 1\npoint 2 2\n", "h.txt:3: a part of 2 points"},
           {head + "point 0 0\npoint 10 0\npoint 2 2\npoint 0 10\n",
            "h.txt:5: the part before is "
            "hollow, or straight, at Z2 X2"},
           {head + "point 0 0\npoint 10 0\npoint 20 0\npoint 0 10\n", "hollow, or straight"},
           // A five-pointed star turns left at each of its corners.
           {head + "point 10 0\npoint -8.09 5.878\npoint 3.09 -9.51\npoint 3.09 9.51\n"
                   "point -8.09 -5.878\n",
            "h.txt:6: the part before crosses itself"}}) {
    const auto parts = parse_turning_holder(text, "h.txt");
    ASSERT_FALSE(parts) << text;
    EXPECT_NE(parts.error().find(wanted), std::string::npos) << text << " -> " << parts.error();
  }
}

TEST(TurningHolder, FilesAreNamedInShapes) {
  const TemporaryFolder folder;
  const std::string path = folder / "holder.txt";
  std::ofstream(path) << kHolder;
  const Result<Cutter> cutter = parse_shape("iso:CNMG120408:holder=profile:" + path);
  ASSERT_TRUE(cutter) << (cutter ? "" : cutter.error());
  EXPECT_EQ(cutter->spec(), "iso:CNMG120408:holder=profile:" + path);
  EXPECT_EQ(cutter->insert()->parts.size(), 3u);
  const Result<Cutter> with = parse_shape("iso:CNMG120408:holder=profile:" + path + ":orient=2");
  ASSERT_TRUE(with);
  EXPECT_EQ(with->spec(), "iso:CNMG120408:orient=2:holder=profile:" + path);
  const Result<Cutter> none = parse_shape("iso:CNMG120408:holder=profile:/nowhere/h.txt");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().find("cannot read /nowhere/h.txt"), std::string::npos) << none.error();
}

}  // namespace
}  // namespace kerf
