// viewer/source_file.h - the text of a program, for those who show lines of it.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// One file of a program. Lines are 1-based. A program of a million lines is as large as all that
/// is cut of it, so its text is packed (zlib), kBlockLines at a time: a fourth of it stays. Packing
/// takes 5 ms a megabyte, SourceLines reads it.
class SourceFile {
 public:
  static constexpr int kBlockLines = 256;
  /// More in a block, of lines that no program has, is not packed: it would be unpacked for each
  /// picture of one of them.
  static constexpr std::size_t kMostPacked = std::size_t{1} << 18;

  SourceFile(std::string path, std::string_view text);
  /// What comes from `text` until its end.
  SourceFile(std::string path, std::istream& text);
  const std::string& path() const { return path_; }
  int line_count() const { return line_count_; }
  /// Without its end; empty if there is no such line. Of more than a few SourceLines is quicker.
  std::string line(int number) const;
  std::size_t bytes() const;

 private:
  friend class SourceLines;
  struct Block {
    std::string data;
    std::size_t text_size = 0;  ///< of what is packed; 0: it is not
  };

  /// Appends to the last block, which is not packed, and packs it when it is full.
  void add(std::string_view text);
  void close_block();
  void finish();

  std::string path_;
  int line_count_ = 0;
  std::vector<Block> blocks_;
  std::string open_;  ///< lines of the block that is being filled; empty once built
};

/// Reads lines of a file, which has to outlive it: what it has unpacked last it keeps. One thread.
class SourceLines {
 public:
  explicit SourceLines(const SourceFile& file) : file_(file) {}
  /// As SourceFile::line(); valid until the next call.
  std::string_view line(int number);

 private:
  void unpack(std::size_t block);

  const SourceFile& file_;
  std::size_t block_ = 0;
  std::string unpacked_;
  std::string_view text_;            ///< of the block
  std::vector<std::size_t> starts_;  ///< of its lines; empty: there is none
};

}  // namespace kerf
