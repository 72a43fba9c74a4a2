// Saved workpieces: round trip, every way a file can be damaged.
#include "stock/zmap/state_file.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

class StateFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "kerf-state-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<ZMap> cut_map(double cell) {
    ZMapOptions options;
    options.blank = *parse_blank("box:-1,0,-3:5.03,4,0.5");
    options.cell_mm = cell;
    auto map = ZMap::create(options);
    const auto cutter = parse_shape("ball:2");
    CutMove move;
    move.from_mm = Vec3(0, 1, -0.3);
    move.to_mm = Vec3(4, 3, -1.2);
    std::vector<CutReport> reports;
    (*map)->cut(*cutter, std::span(&move, 1), reports);
    (*map)->finish(reports);
    return std::move(*map);
  }
  std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  fs::path folder_;
};

TEST_F(StateFile, ComesBackTheSameAndCanBeCutFurther) {
  const auto map = cut_map(0.1);
  const std::string path = (folder_ / "part.state").string();
  ASSERT_TRUE(map->save(path));
  auto loaded = ZMap::load(path, 2);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ((*loaded)->digest(), map->digest());
  EXPECT_EQ((*loaded)->blank_mm3(), map->blank_mm3());
  EXPECT_EQ((*loaded)->bounds_mm(), map->bounds_mm());
  const auto cutter = parse_shape("flat:1");
  CutMove move;
  move.from_mm = Vec3(4, 1, -1);
  move.to_mm = Vec3(0, 3, -1);
  std::vector<CutReport> reports;
  for (ZMap* m : {map.get(), loaded->get()}) {
    m->cut(*cutter, std::span(&move, 1), reports);
    m->finish(reports);
  }
  EXPECT_EQ((*loaded)->digest(), map->digest());
}

TEST_F(StateFile, CutAtAnyByteItIsRefused) {
  const std::string path = (folder_ / "part.state").string();
  ASSERT_TRUE(cut_map(0.5)->save(path));
  const std::string bytes = bytes_of(path);
  ASSERT_TRUE(parse_state(bytes, "part.state"));
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(parse_state(bytes.substr(0, n), "part.state")) << n;
  EXPECT_FALSE(parse_state(bytes + "x", "part.state"));
}

TEST_F(StateFile, AnyChangedByteIsNoticed) {
  const std::string path = (folder_ / "part.state").string();
  ASSERT_TRUE(cut_map(0.5)->save(path));
  const std::string bytes = bytes_of(path);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    std::string damaged = bytes;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x10);
    EXPECT_FALSE(parse_state(damaged, "part.state")) << n;
  }
}

TEST_F(StateFile, SaysWhatIsWrong) {
  const std::string path = (folder_ / "part.state").string();
  ASSERT_TRUE(cut_map(1.0)->save(path));
  const std::string bytes = bytes_of(path);
  const auto fault = [](const std::string& text) {
    return parse_state(text, "part.state").error();
  };
  EXPECT_EQ(fault(""), "part.state: not a saved workpiece (it must begin with \"kerf-state/1\")");
  EXPECT_EQ(fault("kerf-state/1\nmodel zmap\nx"), "part.state: the head is damaged near byte 24");
  EXPECT_EQ(fault("kerf-state/1\nmodel octree\n"),
            "part.state: a workpiece of the model octree, not of zmap");
  const std::size_t heights = bytes.find("\ndata\n") + 6 + 7 * 4 * sizeof(float) + 16;
  ASSERT_GT(bytes.size(), heights);  // walls follow
  EXPECT_EQ(fault(bytes.substr(0, heights - 1)), "part.state: " + std::to_string(heights - 1) +
                                                     " bytes long, but 7 x 4 cells need at least " +
                                                     std::to_string(heights) +
                                                     ": the file is cut short");
  EXPECT_EQ(fault(bytes.substr(0, bytes.size() - 1)),
            "part.state: the checksum does not match: the file is damaged or cut short");
  std::string damaged = bytes;
  damaged[bytes.size() - 20] ^= 1;
  EXPECT_EQ(fault(damaged),
            "part.state: the checksum does not match: the file is damaged or cut short");
  EXPECT_EQ(ZMap::load((folder_ / "none").string()).error(),
            (folder_ / "none").string() + ": No such file or directory");
}

}  // namespace
}  // namespace kerf
