// Saved sheets: round trip, every way a file can be damaged.
#include "stock/sheet/sheet_state.h"

#define XXH_INLINE_ALL
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "stock/cutter/shape_spec.h"
#include "stock/sheet/sheet.h"
#include "stock/state_bytes.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

std::vector<CutMove> some_moves(int from, int to) {
  std::vector<CutMove> moves;
  for (int i = from; i < to; ++i) {
    CutMove move;
    move.id = static_cast<std::uint64_t>(i);
    move.from_mm = {5.0 + 7 * (i % 9), 8.0 + 5 * (i / 9), 0};
    move.to_mm = move.from_mm;
    if (i % 3 == 0) {
      move.to_mm.x += 9;
      move.to_mm.y += 4;
    } else {
      move.arc = CutArc{move.from_mm + Vec3(2.5, 0, 0), {0, 0, 1}, 2 * kPi};
    }
    moves.push_back(move);
  }
  return moves;
}

class SheetState : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "kerf-sheet-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    path_ = (folder_ / "part.state").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::unique_ptr<Sheet> uncut(int tiles) {
    SheetOptions options;
    options.outline = rectangle_outline({0, 0}, {80, 60});
    options.outline.rings.push_back({{70, 40}, {75, 50}, {65, 50}});
    options.bottom_mm = -3;
    options.top_mm = 0.5;
    options.tiles_each_way = tiles;
    return std::move(*Sheet::create(options));
  }
  static void cut(Sheet& sheet, const std::vector<CutMove>& moves) {
    std::vector<CutReport> reports;
    sheet.cut(*parse_shape("flat:0.8"), moves, reports);
  }
  std::string saved_bytes(const Sheet& sheet) {
    EXPECT_TRUE(sheet.save(path_));
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  static std::string with_checksum(std::string bytes) {
    bytes.resize(bytes.size() - kStateHashBytes);
    XXH128_canonical_t sum;
    XXH128_canonicalFromHash(&sum, XXH3_128bits(bytes.data(), bytes.size()));
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    return bytes;
  }
  /// The head with one line of it another.
  std::string with_line(const std::string& bytes, const std::string& key,
                        const std::string& value) {
    const std::size_t at = bytes.find("\n" + key + " ") + 1;
    std::string other = bytes;
    other.replace(at, bytes.find('\n', at) - at, key + " " + value);
    return with_checksum(other);
  }
  /// As layout 1 has it: tiles alone.
  static std::string without_pieces(std::string bytes, std::size_t numbers) {
    const std::string layout = "layout 2\n";
    bytes.erase(bytes.find(layout), layout.size());
    const std::size_t pieces = (3 + 10 * numbers) * sizeof(std::uint32_t);  // no names
    bytes.erase(bytes.size() - kStateHashBytes - pieces, pieces);
    return with_checksum(bytes);
  }
  static void expect_same_pieces(const Sheet& a, const Sheet& b) {
    EXPECT_EQ(a.piece_numbers(), b.piece_numbers());
    EXPECT_EQ(a.blank_piece_numbers(), b.blank_piece_numbers());
    const std::vector<SheetPiece> of_a = a.pieces(), of_b = b.pieces();
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      EXPECT_EQ(of_a[i].number, of_b[i].number);
      EXPECT_EQ(of_a[i].freed_by, of_b[i].freed_by);
      EXPECT_EQ(of_a[i].area_mm2, of_b[i].area_mm2);
      EXPECT_EQ(of_a[i].min_mm, of_b[i].min_mm);
    }
  }
  std::string error_of(const std::string& bytes) {
    const Result<sheet::SavedSheet> parsed = sheet::parse_sheet(bytes, "part.state");
    return parsed ? "none" : parsed.error();
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(SheetState, comes_back_the_same_and_is_cut_on_as_if_never_saved) {
  for (const int tiles : {1, 7}) {
    const std::unique_ptr<Sheet> whole = uncut(tiles), first = uncut(tiles);
    cut(*whole, some_moves(0, 60));
    cut(*first, some_moves(0, 31));
    ASSERT_TRUE(first->save(path_));
    Result<std::unique_ptr<Sheet>> loaded = Sheet::load(path_);
    ASSERT_TRUE(loaded) << loaded.error();
    EXPECT_EQ((*loaded)->digest(), first->digest());
    EXPECT_EQ((*loaded)->blank_mm3(), first->blank_mm3());
    EXPECT_EQ((*loaded)->remaining_mm3(), first->remaining_mm3());
    EXPECT_EQ((*loaded)->bounds_mm(), first->bounds_mm());
    EXPECT_GT(first->pieces().size(), 15u);
    expect_same_pieces(**loaded, *first);
    cut(**loaded, some_moves(31, 60));
    EXPECT_EQ((*loaded)->digest(), whole->digest());
    expect_same_pieces(**loaded, *whole);
  }
}

TEST_F(SheetState, the_lines_that_freed_pieces_come_back) {
  const std::unique_ptr<Sheet> first = uncut(3);
  cut(*first, some_moves(0, 3));
  ASSERT_EQ(first->piece_numbers(), 3u);
  ASSERT_TRUE(first->save(path_, {{1, {"a.ngc", 12}}, {2, {"sub/b.ngc", 7}}}));
  Result<std::unique_ptr<Sheet>> second = Sheet::load(path_);
  ASSERT_TRUE(second) << second.error();
  cut(**second, some_moves(4, 5));
  ASSERT_EQ((*second)->piece_numbers(), 4u);
  // Saved again, with what has been freed since.
  ASSERT_TRUE((*second)->snapshot()->save(path_));
  ASSERT_TRUE((*second)->save(path_, {{3, {"", 99}}}));
  const Result<std::unique_ptr<Sheet>> third = Sheet::load(path_);
  ASSERT_TRUE(third) << third.error();
  const std::vector<SheetPiece> pieces = (*third)->pieces();
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_TRUE(pieces[0].is_main());
  EXPECT_EQ(pieces[0].origin, std::nullopt);
  EXPECT_EQ(pieces[1].origin, (PieceOrigin{"a.ngc", 12}));
  EXPECT_EQ(pieces[2].origin, (PieceOrigin{"sub/b.ngc", 7}));
  EXPECT_EQ(pieces[3].origin, (PieceOrigin{"", 99}));
}

TEST_F(SheetState, in_files_of_layout_1_every_piece_is_of_the_blank) {
  const std::unique_ptr<Sheet> sheet = uncut(2);
  cut(*sheet, some_moves(0, 5));
  const std::string bytes = saved_bytes(*sheet);
  std::ofstream(path_, std::ios::binary) << without_pieces(bytes, sheet->piece_numbers());
  const Result<std::unique_ptr<Sheet>> loaded = Sheet::load(path_);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ((*loaded)->digest(), sheet->digest());
  EXPECT_EQ((*loaded)->pieces().size(), sheet->pieces().size());
  EXPECT_EQ((*loaded)->blank_piece_numbers(), sheet->pieces().size());
  for (const SheetPiece& piece : (*loaded)->pieces()) EXPECT_TRUE(piece.is_main());
}

// A number for a piece that there is not, two for one, none, names beyond the list.
TEST_F(SheetState, pieces_that_do_not_fit_the_tiles_are_refused) {
  const std::unique_ptr<Sheet> sheet = uncut(2);
  cut(*sheet, some_moves(0, 3));
  ASSERT_EQ(sheet->piece_numbers(), 3u);
  const std::string bytes = saved_bytes(*sheet);
  constexpr std::size_t kEntry = 40;
  const std::size_t first = bytes.size() - kStateHashBytes - 3 * kEntry;
  const auto changed = [&](std::size_t at, std::uint32_t value) {
    std::string other = bytes;
    other.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
    return error_of(with_checksum(other));
  };
  ASSERT_EQ(changed(first - 4, 3), "none");
  const std::string damaged = "part.state: the pieces are damaged";
  EXPECT_EQ(changed(first - 4, 2), damaged) << "fewer numbers than there are";
  EXPECT_EQ(changed(first - 8, 4), damaged) << "more pieces of the blank than numbers";
  EXPECT_EQ(changed(first + 8, 4), damaged) << "a tile beyond the last";
  EXPECT_EQ(changed(first + 12, 1000), damaged) << "a ring beyond the last";
  EXPECT_EQ(changed(first + kEntry + 8, 0xffff'ffff), damaged) << "a piece without a number";
  EXPECT_EQ(changed(first + kEntry + 16, 0x7fff'ffff), damaged) << "a box beside its piece";
  EXPECT_EQ(changed(first + 32, 1), damaged) << "a name beyond the last";
  std::string twice = bytes;
  twice.replace(first + kEntry, kEntry, bytes.substr(first + 2 * kEntry, kEntry));
  EXPECT_EQ(error_of(with_checksum(twice)), damaged);
}

TEST_F(SheetState, a_file_that_ends_anywhere_is_refused) {
  const std::unique_ptr<Sheet> sheet = uncut(2);
  cut(*sheet, some_moves(0, 5));
  const std::string bytes = saved_bytes(*sheet);
  ASSERT_EQ(error_of(bytes), "none");
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_NE(error_of(bytes.substr(0, n)), "none") << n;
  EXPECT_NE(error_of(bytes + "x"), "none");
  // Also if the checksum says that it is whole.
  const std::size_t data = bytes.find("data\n") + 5;
  const std::size_t pieces = bytes.size() - (3 + 10 * sheet->piece_numbers()) * 4;
  for (std::size_t n = data + kStateHashBytes; n < bytes.size(); ++n)
    EXPECT_EQ(
        error_of(with_checksum(bytes.substr(0, n))),
        n < pieces ? "part.state: the tiles are damaged" : "part.state: the pieces are damaged");
}

TEST_F(SheetState, says_what_is_wrong) {
  const std::unique_ptr<Sheet> sheet = uncut(2);
  cut(*sheet, some_moves(0, 5));
  const std::string bytes = saved_bytes(*sheet);
  EXPECT_EQ(error_of("G1 X1"),
            "part.state: not a saved workpiece (it must begin with \"kerf-state/1\")");
  EXPECT_EQ(error_of("kerf-state/1\nmodel zmap\n"),
            "part.state: a workpiece of the model zmap, not of sheet");
  std::string flipped = bytes;
  flipped[bytes.size() - 40] ^= 1;
  EXPECT_EQ(error_of(flipped),
            "part.state: the checksum does not match: the file is damaged or cut short");
  EXPECT_EQ(error_of(with_line(bytes, "layout", "3")),
            "part.state: a sheet of layout 3; layouts 1 to 2 can be read");
  const std::string damaged_head = "part.state: the head is damaged near byte";
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, std::string>>{{"layout", "0"},
                                                        {"layout", "two"},
                                                        {"bounds", "0 0 800000"},
                                                        {"bounds", "0 0 0 600000"},
                                                        {"bounds", "0 0 800000 1600000000000"},
                                                        {"tiles", "0 2"},
                                                        {"tiles", "2 1000000"},
                                                        {"z_mm", "0 -1"},
                                                        {"z_mm", "nan 1"},
                                                        {"arc_tolerance_mm", "0"},
                                                        {"blank_area2", "-1"},
                                                        {"blank_area2", "9000000000000000000"}}) {
    EXPECT_EQ(error_of(with_line(bytes, key, value)).substr(0, damaged_head.size()), damaged_head)
        << key << ' ' << value;
  }
  // Rings of other tiles, and more material than there was.
  EXPECT_EQ(error_of(with_line(bytes, "bounds", "100000 0 900000 600000")),
            "part.state: the tiles are damaged");
  EXPECT_EQ(error_of(with_line(bytes, "blank_area2", "10000")),
            "part.state: the tiles are damaged");
  EXPECT_EQ(error_of(with_line(bytes, "tiles", "60000 60000")),
            "part.state: the tiles are damaged");
  const auto missing = Sheet::load((folder_ / "none.state").string());
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("No such file or directory"), std::string::npos);
}

// What passes can be cut and drawn, though its rings may cross.
TEST_F(SheetState, made_up_rings_do_no_harm) {
  const std::unique_ptr<Sheet> sheet = uncut(2);
  cut(*sheet, some_moves(0, 12));
  const std::string bytes = saved_bytes(*sheet);
  const std::size_t data = bytes.find("data\n") + 5;
  std::mt19937 random(11);
  int loaded = 0;
  for (int i = 0; i < 60; ++i) {
    std::string other = bytes;
    for (int k = 0; k < 2; ++k) {
      const std::size_t at = data + random() % (bytes.size() - data - kStateHashBytes);
      other[at] = static_cast<char>(random());
    }
    std::ofstream(path_, std::ios::binary) << with_checksum(other);
    Result<std::unique_ptr<Sheet>> made_up = Sheet::load(path_);
    if (!made_up) continue;
    ++loaded;
    cut(**made_up, some_moves(3, 40));
    EXPECT_FALSE((*made_up)->mesh(0.1).triangles.empty());
    (void)(*made_up)->outline();
    (void)(*made_up)->pieces();
  }
  EXPECT_GT(loaded, 5);
}

}  // namespace
}  // namespace kerf
