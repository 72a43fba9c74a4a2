// twin/report/line_window.h - the part of a program between two of its lines (--from-line,
// --until-line).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "interp_bridge/motion.h"

namespace kerf {

/// Lines of the program itself (SourceRef::file 0), 1-based; 0 = from the start, to the end.
struct LineRange {
  std::uint32_t from = 0;
  std::uint32_t until = 0;
  bool operator==(const LineRange&) const = default;
};

/// Divides a stream of motions in the order in which they are run:
///
///     before | within | after
///
/// `within` begins with the first motion of a line at or beyond `from`, and ends before the first
/// one of a line beyond `until`. A program that runs straight down is cut at these lines;
/// subroutines in the same file belong to the line that calls them only if they stand above it, as
/// LinuxCNC wants them to. Motions of other files and of unknown lines belong to what came before
/// them.
class LineWindow {
 public:
  explicit LineWindow(const LineRange& range) : range_(range), begun_(range.from == 0) {}

  /// How many motions of a batch lie before and within; the rest are after the end, and so is all
  /// that follows.
  struct Split {
    std::size_t before = 0;
    std::size_t within = 0;
  };
  Split split(std::span<const Motion> motions);

  const LineRange& range() const { return range_; }
  bool begun() const { return begun_; }  ///< a motion within has come
  bool over() const { return over_; }    ///< one after the end has come

 private:
  LineRange range_;
  bool begun_;
  bool over_ = false;
};

}  // namespace kerf
