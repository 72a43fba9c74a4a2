// Saved turned parts: round trip, every way a file can be damaged.
#include "stock/turning/turning_state.h"

#define XXH_INLINE_ALL
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "stock/state_bytes.h"
#include "stock/turning/turning_stock.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/turning/turning_samples.h"

namespace kerf {
namespace {

using namespace turning_test;

Cutter finisher() { return Cutter::from_insert("turn:0.4:2:85:30", right_hand(0.4)); }

CutMove straight(double z0, double x0, double z1, double x1) {
  CutMove move;
  move.from_mm = {x0, 0, z0};
  move.to_mm = {x1, 0, z1};
  return move;
}

/// A shaft with a taper and a neck; from the tenth on with a groove.
std::vector<CutMove> shaft_moves(std::size_t from, std::size_t to) {
  std::vector<CutMove> moves;
  for (int i = 0; i < 9; ++i) {
    const double x = 19 - i;
    moves.push_back(straight(2, x, -30 + i, x));
  }
  for (int i = 0; i < 9; ++i) moves.push_back(straight(-10 - i, 15, -12 - i, 8));
  return {moves.begin() + static_cast<long>(from), moves.begin() + static_cast<long>(to)};
}

class TurningState : public testing::Test {
 protected:
  static TurningStock stock(const std::optional<BarFlats>& flats = std::nullopt) {
    return TurningStock(*TurnedPart::create(bar_profile(-64, 0, 40), ChuckSide::kLowZ, flats));
  }
  static void cut(TurningStock& stock, const std::vector<CutMove>& moves) {
    std::vector<CutReport> reports;
    stock.cut(finisher(), moves, reports);
  }
  /// A bar with a hollow inside, which is a hole of its contour.
  static TurningStock hollow() {
    TurnedProfile profile = bar_profile(-64, 0, 40);
    profile.push_back({{-30, 5}, {-20, 5}, {-20, 9}, {-30, 9}});
    TurningStock made(*TurnedPart::create(profile, ChuckSide::kHighZ));
    cut(made, shaft_moves(0, 4));
    return made;
  }
  std::string bytes_of(const TurningStock& stock) {
    EXPECT_TRUE(stock.save(path_));
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string with_checksum(std::string bytes) {
    bytes.resize(bytes.size() - kStateHashBytes);
    return with_sum_added(bytes);
  }
  static std::string with_sum_added(std::string bytes) {
    XXH128_canonical_t sum;
    XXH128_canonicalFromHash(&sum, XXH3_128bits(bytes.data(), bytes.size()));
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    return bytes;
  }
  static std::string with_line(const std::string& bytes, const std::string& key,
                               const std::string& value) {
    const std::size_t at = bytes.find('\n' + key + ' ') + 1;
    std::string other = bytes;
    other.replace(at, bytes.find('\n', at) - at, key + ' ' + value);
    return with_checksum(other);
  }
  static std::string error_of(const std::string& bytes) {
    const auto parsed = turning::parse_part(bytes, "part.state");
    return parsed ? "none" : parsed.error();
  }

  TemporaryFolder folder_;
  std::string path_ = folder_ / "part.state";
};

TEST_F(TurningState, comes_back_the_same_and_is_cut_on_as_if_never_saved) {
  for (const auto& flats : {std::optional<BarFlats>(), std::optional(BarFlats{6, 17.5})}) {
    TurningStock whole = stock(flats), first = stock(flats);
    cut(whole, shaft_moves(0, 18));
    cut(first, shaft_moves(0, 7));
    ASSERT_TRUE(first.save(path_));
    const auto loaded = TurningStock::load(path_);
    ASSERT_TRUE(loaded) << loaded.error();
    EXPECT_EQ((*loaded)->digest(), first.digest());
    EXPECT_EQ((*loaded)->blank_mm3(), first.blank_mm3());
    EXPECT_EQ((*loaded)->remaining_mm3(), first.remaining_mm3());
    EXPECT_EQ((*loaded)->bounds_mm(), first.bounds_mm());
    EXPECT_EQ((*loaded)->part().flats(), flats);
    cut(**loaded, shaft_moves(7, 18));
    EXPECT_EQ((*loaded)->digest(), whole.digest());
    EXPECT_EQ((*loaded)->remaining_mm3(), whole.remaining_mm3());
  }
}

TEST_F(TurningState, holes_and_the_side_of_the_chuck_come_back) {
  const TurningStock first = hollow();
  ASSERT_EQ(first.part().contours().size(), 2u);
  ASSERT_TRUE(first.save(path_));
  const auto loaded = TurningStock::load(path_);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ((*loaded)->digest(), first.digest());
  EXPECT_EQ((*loaded)->part().contours().size(), 2u);
  // Parted off: what is held at high z stays.
  std::vector<CutReport> reports;
  const CutMove part_off = straight(-45, 25, -45, -1);
  (*loaded)->cut(Cutter::from_insert("part:2", *groove_insert({2, 0, 40, 2})), {&part_off, 1},
                 reports);
  ASSERT_EQ((*loaded)->part().freed().size(), 1u);
  EXPECT_NEAR((*loaded)->part().freed()[0].low_z_mm, -64, 1e-9);
}

TEST_F(TurningState, threads_come_back_and_lie_the_same_when_turned_about) {
  TurningStock first = stock();
  const Cutter tool = Cutter::from_insert("thread:60", *thread_insert({radians(60), 0.2, 3, 6}));
  std::vector<CutReport> reports;
  std::vector<CutMove> moves{straight(4, 19, -30, 19), straight(-30, 19, -32, 21),
                             straight(-32, 21, -32, 30)};
  moves[0].lead_mm = moves[1].lead_mm = 2.5;
  first.cut(tool, moves, reports);
  ASSERT_EQ(first.part().threads().passes().size(), 2u);
  const std::string bytes = bytes_of(first);
  const auto loaded = TurningStock::load(path_);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ((*loaded)->digest(), first.digest());
  EXPECT_EQ((*loaded)->remaining_mm3(), first.remaining_mm3());
  const CutMove along = straight(2, 19.4, -20, 19.4);
  first.cut(finisher(), {&along, 1}, reports);
  (*loaded)->cut(finisher(), {&along, 1}, reports);
  EXPECT_EQ((*loaded)->digest(), first.digest());
  EXPECT_EQ((*loaded)->remaining_mm3(), first.remaining_mm3());
  // About a place: the same material at the opposite angle, and about it again as it was.
  const std::optional<TurnedPart> about = first.part().turned_about(-5);
  ASSERT_TRUE(about);
  EXPECT_NEAR(about->remaining_mm3(), first.remaining_mm3(), 1e-6);
  const double angle = 1.234;
  const TurnedProfile there = first.part().section(angle), here = about->section(-angle);
  ASSERT_EQ(there.size(), here.size());
  double off = 0;
  for (const Vec2& p : here[0]) {
    double least = 1e300;
    for (const Vec2& q : there[0]) least = std::min(least, std::hypot(-5 - p.x - q.x, p.y - q.y));
    off = std::max(off, least);
  }
  EXPECT_LT(off, 5e-5);
  // Not one number of it that is wrong comes through.
  const std::size_t section = bytes.find("THRD");
  ASSERT_NE(section, std::string::npos);
  const std::size_t lead = section + 4 + 4 + 8 + 4 + 8 + 4 * 8;
  for (const double wrong : {0.0, std::nan(""), 1e-4, std::numeric_limits<double>::infinity()}) {
    std::string other = bytes;
    std::memcpy(other.data() + lead, &wrong, sizeof wrong);
    EXPECT_EQ(error_of(with_checksum(other)), "part.state: the threads are damaged");
  }
  for (std::size_t end = section + 1; end < bytes.size() - kStateHashBytes; ++end)
    EXPECT_NE(error_of(with_sum_added(bytes.substr(0, end))), "none") << end;
}

TEST_F(TurningState, pieces_that_came_off_come_back) {
  for (const auto& flats : {std::optional<BarFlats>(), std::optional(BarFlats{6, 17.5})}) {
    TurningStock first = stock(flats);
    EXPECT_EQ(bytes_of(first).find("FREE"), std::string::npos) << "as files always were";
    const Cutter blade = Cutter::from_insert("part:2", *groove_insert({2, 0, 40, 2}));
    const Cutter sharp = Cutter::from_insert("thread:60", *thread_insert({radians(60), 0.2, 3, 6}));
    std::vector<CutReport> reports;
    cut(first, shaft_moves(0, 4));
    // A thread on what is parted off first, and a second piece behind it.
    std::vector<CutMove> thread{straight(4, 15, -4, 15), straight(-4, 15, -6, 25)};
    thread[0].lead_mm = thread[1].lead_mm = 2.5;
    first.cut(sharp, thread, reports);
    first.cut(blade, std::vector<CutMove>{straight(-12, 25, -12, -1)}, reports);
    first.cut(blade, std::vector<CutMove>{straight(-40, 25, -40, -1)}, reports);
    const std::vector<TurnedPiece>& fell = first.part().freed();
    ASSERT_EQ(fell.size(), 2u);
    ASSERT_TRUE(first.save(path_));
    const auto loaded = TurningStock::load(path_);
    ASSERT_TRUE(loaded) << loaded.error();
    const std::vector<TurnedPiece>& back = (*loaded)->part().freed();
    ASSERT_EQ(back.size(), 2u);
    for (std::size_t i = 0; i < back.size(); ++i) {
      EXPECT_EQ(back[i].freed_by, fell[i].freed_by);
      EXPECT_NEAR(back[i].volume_mm3, fell[i].volume_mm3, 1e-9);
      EXPECT_GT(back[i].volume_mm3, 1000);
      EXPECT_EQ(back[i].low_z_mm, fell[i].low_z_mm);
      EXPECT_EQ(back[i].high_z_mm, fell[i].high_z_mm);
      EXPECT_EQ(back[i].low_r_mm, fell[i].low_r_mm);
      EXPECT_EQ(back[i].high_r_mm, fell[i].high_r_mm);
      EXPECT_EQ(back[i].part->digest(), fell[i].part->digest());
      EXPECT_EQ(back[i].part->threads().passes().size(), fell[i].part->threads().passes().size());
    }
    EXPECT_FALSE(back[0].part->threads().empty());
    EXPECT_EQ((*loaded)->digest(), first.digest());
    EXPECT_EQ((*loaded)->remaining_mm3(), first.remaining_mm3());
    // Turned about or moved on they are left behind.
    EXPECT_TRUE(first.part().turned_about(-5)->freed().empty());
    EXPECT_TRUE(first.part().moved(5)->freed().empty());
  }
}

TEST_F(TurningState, damaged_pieces_are_refused) {
  TurningStock first = stock();
  const CutMove off = straight(-20, 25, -20, -1);
  std::vector<CutReport> reports;
  first.cut(Cutter::from_insert("part:2", *groove_insert({2, 0, 40, 2})), {&off, 1}, reports);
  const std::string bytes = bytes_of(first);
  ASSERT_EQ(error_of(bytes), "none");
  const std::size_t section = bytes.find("FREE");
  ASSERT_NE(section, std::string::npos);
  for (std::size_t end = section + 1; end < bytes.size() - kStateHashBytes; ++end)
    EXPECT_NE(error_of(with_sum_added(bytes.substr(0, end))), "none") << end;
  const auto changed = [&](std::size_t at, auto value) {
    std::string other = bytes;
    std::memcpy(other.data() + section + 16 + at, &value, sizeof value);
    return error_of(with_checksum(other));
  };
  const std::string damaged = "part.state: the pieces that have come off are damaged";
  EXPECT_EQ(changed(0, std::uint32_t{0}), damaged) << "none";
  EXPECT_EQ(changed(0, std::uint32_t{2}), damaged) << "more than bytes";
  EXPECT_EQ(changed(12, ~std::uint64_t{0}), damaged) << "of more bytes than there are";
  EXPECT_EQ(changed(20, std::uint32_t{0}), damaged) << "no contour";
  EXPECT_EQ(changed(28, std::int32_t{1}), damaged) << "beyond the blank";
  // The part alone would fit into it, but not with what has come off.
  EXPECT_EQ(error_of(with_line(bytes, "blank_mm3", "60000")),
            "part.state: the contours are damaged");
}

TEST_F(TurningState, nothing_left_is_a_state_too) {
  TurningStock gone(*TurnedPart::create(bar_profile(-1, 0, 4)));
  std::vector<CutReport> reports;
  const CutMove away = straight(-3, 5, -3, -5);
  gone.cut(Cutter::from_insert("groove:6", *groove_insert({6, 0, 40, 2})), {&away, 1}, reports);
  ASSERT_EQ(gone.remaining_mm3(), 0);
  ASSERT_TRUE(gone.save(path_));
  const auto loaded = TurningStock::load(path_);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ((*loaded)->remaining_mm3(), 0);
}

TEST_F(TurningState, turned_about_and_back_it_is_the_same) {
  const TurningStock first = hollow();
  const std::optional<TurnedPart> about = first.part().turned_about(-10);
  ASSERT_TRUE(about);
  EXPECT_NEAR(about->remaining_mm3(), first.remaining_mm3(), 1e-9);
  EXPECT_EQ(about->bounds_mm(), (Box{{-20, -20, -10}, {20, 20, 54}}));
  EXPECT_NE(about->digest(), first.digest());
  EXPECT_EQ(about->turned_about(-10)->digest(), first.digest());
  // It is cut as what it is: the mirrored move leaves the mirrored part.
  TurnedPart a = *about, b = first.part();
  const TurningTool disc(round_insert(1));
  a.cut(disc, line({-30, 25}, {-30, 15}));
  b.cut(disc, line({20, 25}, {20, 15}));
  EXPECT_NEAR(a.remaining_mm3(), b.remaining_mm3(), 1e-9);
  EXPECT_FALSE(first.part().turned_about(2000.5));
  const std::optional<TurnedPart> moved = first.part().moved(25.5);
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->bounds_mm(), (Box{{-20, -20, -38.5}, {20, 20, 25.5}}));
  EXPECT_EQ(moved->moved(-25.5)->digest(), first.digest());
  EXPECT_FALSE(first.part().moved(-1936.5));
  EXPECT_FALSE(first.part().turned_about(std::nan("")));
}

TEST_F(TurningState, a_file_that_ends_anywhere_or_has_a_wrong_byte_is_refused) {
  const std::string bytes = bytes_of(hollow());
  ASSERT_EQ(error_of(bytes), "none");
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_NE(error_of(bytes.substr(0, n)), "none") << n;
    std::string wrong = bytes;
    wrong[n] ^= 1;
    EXPECT_NE(error_of(wrong), "none") << n;
  }
  EXPECT_NE(error_of(bytes + "x"), "none");
  // Also if the checksum says that it is whole.
  const std::size_t data = bytes.find("data\n") + 5;
  for (std::size_t n = data; n + kStateHashBytes < bytes.size(); ++n)
    EXPECT_EQ(error_of(with_sum_added(bytes.substr(0, n))), "part.state: the contours are damaged")
        << n;
}

TEST_F(TurningState, says_what_is_wrong) {
  const std::string bytes = bytes_of(hollow());
  EXPECT_EQ(error_of("kerf-state/1\nmodel zmap\n"),
            "part.state: a workpiece of the model zmap, not of turning");
  EXPECT_EQ(error_of(with_line(bytes, "layout", "2")),
            "part.state: a turned part of layout 2; layout 1 can be read");
  const std::string head = "part.state: the head is damaged near byte";
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, std::string>>{{"layout", "0"},
                                                        {"layout", "two"},
                                                        {"chuck", "2"},
                                                        {"blank", "-6400000 0 0"},
                                                        {"blank", "-6400000 0 -6400000 2000000"},
                                                        {"blank", "-6400000 -1 0 2000000"},
                                                        {"blank", "-6400000 0 0 100000001"},
                                                        {"blank", "-200000001 0 0 2000000"},
                                                        {"blank_mm3", "0"},
                                                        {"blank_mm3", "nan"},
                                                        {"blank_mm3", "80425"},
                                                        {"flats", "5 10"},
                                                        {"flats", "6 0"},
                                                        {"flats", "6 nan"}}) {
    EXPECT_EQ(error_of(with_line(bytes, key, value)).substr(0, head.size()), head)
        << key << ' ' << value;
  }
  const std::string damaged = "part.state: the contours are damaged";
  EXPECT_EQ(error_of(with_line(bytes, "blank", "-6300000 0 0 2100000")), damaged) << "beyond it";
  EXPECT_EQ(error_of(with_line(bytes, "blank_mm3", "60000")), damaged) << "more than there was";
  const std::size_t data = bytes.find("data\n") + 5;
  const auto changed = [&](std::size_t at, std::uint32_t value) {
    std::string other = bytes;
    std::memcpy(other.data() + data + at, &value, sizeof value);
    return error_of(with_checksum(other));
  };
  EXPECT_EQ(changed(4, 2),
            "part.state: has a section 'PART' of version 2, which this kerf cannot read");
  EXPECT_EQ(changed(0, 0x41525458),
            "part.state: has a section 'XTRA' of version 1, which this kerf cannot read");
  EXPECT_EQ(changed(8, 12), damaged) << "another size";
  EXPECT_EQ(changed(16, 0xffff'ffff), damaged) << "more contours than bytes";
  EXPECT_EQ(changed(20, 0xffff'ffff), damaged) << "more corners than bytes";
  EXPECT_EQ(changed(28, 0xffff'ffff), damaged) << "below the axis";
  const auto missing = TurningStock::load(folder_ / "none.state");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("No such file or directory"), std::string::npos);
}

// What passes can be cut and drawn, though its contours may cross.
TEST_F(TurningState, made_up_contours_do_no_harm) {
  const std::string bytes = bytes_of(hollow());
  const std::size_t data = bytes.find("data\n") + 5;
  std::mt19937 random(11);
  int loaded = 0;
  for (int i = 0; i < 300; ++i) {
    std::string other = bytes;
    for (int k = 0; k < 2; ++k) {
      const std::size_t at = data + 24 + random() % (bytes.size() - data - 24 - kStateHashBytes);
      other[at] = static_cast<char>(random());
    }
    std::ofstream(path_, std::ios::binary) << with_checksum(other);
    const auto made_up = TurningStock::load(path_);
    if (!made_up) continue;
    ++loaded;
    cut(**made_up, shaft_moves(3, 18));
    EXPECT_TRUE(std::isfinite((*made_up)->remaining_mm3()));
    (void)(*made_up)->mesh(0.1);
    (void)(*made_up)->digest();
    for (std::uint32_t t = 0; t < (*made_up)->tile_count(); ++t) (void)(*made_up)->patch(t, 0);
  }
  EXPECT_GT(loaded, 50);
}

}  // namespace
}  // namespace kerf
