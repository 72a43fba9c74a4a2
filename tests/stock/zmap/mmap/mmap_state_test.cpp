// Saved M-maps: round trip, every way a file can be damaged.
#include "stock/zmap/mmap/mmap_state.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "stock/zmap/state_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/zmap/mmap/mmap_samples.h"

namespace kerf::test {
namespace {

class MMapState : public testing::Test {
 protected:
  std::string bytes() const { return *read_state_bytes(path_); }
  /// What the file's bytes but for the checksum say.
  Result<SavedColumns> checked(const std::string& text) const {
    Result<StateWriter> file = StateWriter::create(path_);
    EXPECT_TRUE(file);
    file->put(text.data(), text.size());
    EXPECT_TRUE(file->commit());
    return parse_columns(bytes(), "part.state");
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "part.state";
};

/// A slot under a slot, across it a third.
void cut_slots(MMap& map, double y) {
  removed_mm3(map, shape("tslot:3:1:1"), {line({-3, y, -2.5}, {9, y, -2.5})});
  removed_mm3(map, shape("tslot:4:0.5:1"), {line({2, -3, -1.5}, {2, 9, -1.5})});
}

TEST_F(MMapState, ComesBackTheSameAndCanBeCutFurther) {
  const auto map = make_mmap("box:-1,0,-4:5.03,6,0.5", 0.13);
  cut_slots(*map, 3);
  ASSERT_TRUE(map->has_gaps());
  ASSERT_TRUE(map->save(path_));
  auto loaded = MMap::load(path_, 2);
  ASSERT_TRUE(loaded) << loaded.error();
  MMap& copy = **loaded;
  EXPECT_EQ(copy.digest(), map->digest());
  EXPECT_EQ(copy.blank_mm3(), map->blank_mm3());
  EXPECT_EQ(copy.remaining_mm3(), map->remaining_mm3());
  EXPECT_EQ(copy.bounds_mm(), map->bounds_mm());
  for (MMap* m : {map.get(), &copy}) cut_slots(*m, 1);
  EXPECT_EQ(copy.digest(), map->digest());
  EXPECT_EQ(copy.mesh(0).triangles, map->mesh(0).triangles);
  EXPECT_EQ(parse_state(bytes(), "part.state").error(),
            "part.state: a workpiece of the model mmap, not of zmap");
}

TEST_F(MMapState, CutOrChangedAtAnyByteItIsRefused) {
  const auto map = make_mmap("box:0,0,-4:6,6,0", 0.8);
  cut_slots(*map, 3);
  ASSERT_TRUE(map->save(path_));
  const std::string whole = bytes();
  ASSERT_TRUE(parse_columns(whole, "part.state"));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_FALSE(parse_columns(whole.substr(0, n), "part.state")) << n;
    std::string damaged = whole;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x10);
    EXPECT_FALSE(parse_columns(damaged, "part.state")) << n;
  }
}

// A file that was made up.
TEST_F(MMapState, GapsLieInTheirColumns) {
  const auto map = make_mmap("box:0,0,-4:2,2,0", 1);
  ASSERT_TRUE(map->save(path_));
  std::string start = bytes();
  start.resize(start.size() - kStateHashBytes);
  const auto with = [&](std::initializer_list<std::array<float, 3>> gaps) {
    std::string text = start;
    for (const std::array<float, 3>& gap : gaps) {
      const auto cell = static_cast<std::uint32_t>(gap[0]);
      text.append(reinterpret_cast<const char*>(&cell), sizeof cell);
      text.append(reinterpret_cast<const char*>(&gap[1]), 2 * sizeof(float));
    }
    const Result<SavedColumns> saved = checked(text);
    return saved ? std::string() : saved.error();
  };
  EXPECT_EQ(with({}), "");
  EXPECT_EQ(with({{1, -3, -2}, {3, -2, -1}, {3, -4, -3}}), "");
  const std::string first = "part.state: gap 0 does not lie in its column";
  EXPECT_EQ(with({{4, -3, -2}}), first);               // no such cell
  EXPECT_EQ(with({{0, -2, -3}}), first);               // upside down
  EXPECT_EQ(with({{0, -3, 0}}), first);                // open at the top
  EXPECT_EQ(with({{0, -5, -2}}), first);               // below the floor
  EXPECT_EQ(with({{0, -2, -1}, {0, -3, -2}}), first);  // nothing between them
  EXPECT_EQ(with({{0, std::numeric_limits<float>::quiet_NaN(), -1}}), first);
  EXPECT_EQ(with({{0, -3, -2}, {1, -3, -2}, {0, -2, -1}}),
            "part.state: gap 2 does not lie in its column");
  EXPECT_EQ(checked(start + "x").error(),
            "part.state: 1 bytes of gaps are no whole number of them");
}

}  // namespace
}  // namespace kerf::test
