// Saved octrees: round trip, every way a file can be damaged.
#include "stock/octree/octree_state.h"

#include <fstream>

#include "stock/state_bytes.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/octree/dual_contour/mesh_checks.h"
#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

class OctreeState : public testing::Test {
 protected:
  std::string bytes() const { return *read_state_bytes(path_); }
  void write(std::string_view text) const { std::ofstream(path_, std::ios::binary) << text; }
  /// With the checksum that belongs to it in place of its last bytes.
  void write_checked(const std::string& text) const {
    Result<StateWriter> file = StateWriter::create(path_);
    ASSERT_TRUE(file);
    file->put(text.data(), text.size() - kStateHashBytes);
    ASSERT_TRUE(file->commit());
  }
  static std::string fault(const std::string& text) {
    return octree::parse_tree(text, "part.state").error();
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "part.state";
};

std::vector<CutMove> tilted_moves(double from) {
  std::vector<CutMove> moves{line({from, 2, -1.5}, {from + 9, 6, -2}, 1, {0.6, 0, 0.8}),
                             line({from, 8, -1}, {from + 8, 7, -3}, 2)};
  moves[1].axis_to = glm::normalize(Vec3(0.3, -0.2, 1));
  return moves;
}

TEST_F(OctreeState, ComesBackTheSameAndCanBeCutFurther) {
  struct Case {
    const char* blank;
    bool additive;
  };
  for (const Case& c : {Case{"box:0,0,-6:20,10,0", false}, Case{"tube:0,5,-3:20:16:5:x", false},
                        Case{"box:0,0,-6:20,10,0", true}}) {
    const auto tree = make_octree(c.blank, 0.37, 1, c.additive);
    const Cutter cutter = make_cutter("bull:3:0.5");
    cut(*tree, cutter, tilted_moves(1));
    ASSERT_TRUE(tree->save(path_));
    const auto loaded = Octree::load(path_, 2);
    ASSERT_TRUE(loaded) << loaded.error();
    Octree& copy = **loaded;
    EXPECT_EQ(copy.digest(), tree->digest()) << c.blank;
    EXPECT_EQ(copy.bounds_mm(), tree->bounds_mm());
    EXPECT_EQ(copy.blank_mm3(), tree->blank_mm3());
    EXPECT_EQ(copy.remaining_mm3(), tree->remaining_mm3());
    EXPECT_TRUE(tree->differing_tiles(copy).empty());
    for (Octree* t : {tree.get(), &copy}) cut(*t, cutter, tilted_moves(8));
    EXPECT_EQ(copy.digest(), tree->digest()) << c.blank;
    EXPECT_EQ(copy.remaining_mm3(), tree->remaining_mm3());
    EXPECT_EQ(copy.mesh(0).triangles, tree->mesh(0).triangles);
  }
}

TEST_F(OctreeState, CutAtAnyByteItIsRefused) {
  const auto tree = make_octree("box:0,0,-4:6,5,0", 1);
  cut(*tree, make_cutter("ball:3"), {line({1, 1, -1}, {5, 4, -2})});
  ASSERT_TRUE(tree->save(path_));
  const std::string whole = bytes();
  ASSERT_TRUE(octree::parse_tree(whole, "part.state"));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_FALSE(octree::parse_tree(whole.substr(0, n), "part.state")) << n;
    std::string damaged = whole;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x10);
    EXPECT_FALSE(octree::parse_tree(damaged, "part.state")) << n;
  }
  EXPECT_FALSE(octree::parse_tree(whole + "x", "part.state"));
}

// A file that was made up, or damaged before its checksum was made: refused, or as good as any.
TEST_F(OctreeState, WhateverIsLoadedCanBeCutAndMeshed) {
  const auto tree = make_octree("box:0,0,-4:9,5,0", 1);
  cut(*tree, make_cutter("ball:3"), {line({1, 1, -1}, {5, 4, -2})});
  ASSERT_TRUE(tree->save(path_));
  const std::string whole = bytes();
  std::mt19937 engine(4);
  int taken = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string damaged = whole;
    const std::size_t at = engine() % (whole.size() - kStateHashBytes);
    damaged[at] = static_cast<char>(engine());
    if (trial % 5 == 0) damaged.erase(at, engine() % 5);
    write_checked(damaged);
    const auto loaded = Octree::load(path_);
    if (!loaded) {
      ++refused;
      continue;
    }
    ++taken;
    EXPECT_EQ(manifold_fault((*loaded)->mesh(0)), "");
    cut(**loaded, make_cutter("flat:2"), {line({-2, 2, -1}, {12, 3, -3})});
    EXPECT_EQ(manifold_fault((*loaded)->mesh(0)), "");
  }
  EXPECT_GT(taken, 50);
  EXPECT_GT(refused, 50);
}

TEST_F(OctreeState, SaysWhatIsWrong) {
  const auto tree = make_octree("box:0,0,-4:6,5,0", 1);
  ASSERT_TRUE(tree->save(path_));
  const std::string whole = bytes();
  EXPECT_EQ(fault(""), "part.state: not a saved workpiece (it must begin with \"kerf-state/1\")");
  EXPECT_EQ(fault("kerf-state/1\nmodel zmap\n"),
            "part.state: a workpiece of the model zmap, not of octree");
  EXPECT_EQ(fault("kerf-state/1\nmodel octree\nbounds_mm 1 2 3"),
            "part.state: the head is damaged near byte 26");
  EXPECT_EQ(fault(whole.substr(0, whole.size() - 1)),
            "part.state: the checksum does not match: the file is damaged or cut short");
  const std::size_t data = whole.find("data\n") + 5;
  std::string solid = whole.substr(0, data) + "\1" + whole.substr(whole.size() - kStateHashBytes);
  write_checked(solid);  // solid beyond the blank as well
  EXPECT_EQ(Octree::load(path_).error(), path_ + ": the tiles are damaged");
  const std::string none = folder_ / "none";
  EXPECT_EQ(Octree::load(none).error(), none + ": No such file or directory");
  EXPECT_FALSE(tree->save(folder_ / "no/part.state"));
}

}  // namespace
}  // namespace kerf::test
