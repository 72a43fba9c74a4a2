#include "stock/zmap/mmap/column_editor.h"

#include <algorithm>

namespace kerf {
namespace {

/// Of the gaps, mm: in double precision, where sums of a few single-precision lengths are exact
/// enough to tell whether anything was removed.
double hollow(std::span<const Gap> gaps) {
  double sum = 0;
  for (const Gap& gap : gaps) sum += static_cast<double>(gap.high) - static_cast<double>(gap.low);
  return sum;
}

}  // namespace

void ColumnEditor::set_height(std::size_t cell, float height, std::uint32_t id) {
  if (own_heights_ == nullptr) heights_ = own_heights_ = grid_.make_writable(tile_);
  own_heights_[cell] = height;
  if (grid_.keeps_cut_ids()) cut_ids_of(own_heights_)[cell] = id;
}

void ColumnEditor::set_gaps(std::size_t cell, std::span<const Gap> gaps) {
  // The heights' version counts for the gaps too.
  if (own_heights_ == nullptr) heights_ = own_heights_ = grid_.make_writable(tile_);
  if (own_gaps_ == nullptr) gaps_ = own_gaps_ = &gap_grid_.make_writable(tile_);
  own_gaps_->write(cell, gaps);
}

float ColumnEditor::remove_inside(std::size_t cell, float low, float high, std::uint32_t id) {
  const float top = heights_[cell];
  column_.clear();
  if (gaps_ != nullptr) gaps_->read(cell, column_);
  Gap gap{low, std::min(high, top), id, id};
  const double hollow_before = hollow(column_);
  // From the top downward: gaps above stay, those that meet the new one become part of it.
  auto first = column_.begin();
  while (first != column_.end() && first->low > gap.high + kThinnest_mm) ++first;
  auto last = first;
  for (; last != column_.end() && last->high >= gap.low - kThinnest_mm; ++last) {
    if (last->low <= gap.low) {
      gap.low = last->low;
      gap.low_id = last->low_id;
    }
    if (last->high >= gap.high) {
      gap.high = last->high;
      gap.high_id = last->high_id;
    }
  }
  first = column_.erase(first, last);
  if (gap.low - floor_ <= kThinnest_mm) gap.low = floor_;
  float new_top = top;
  if (top - gap.high <= kThinnest_mm) {
    new_top = gap.low;
    set_height(cell, gap.low, gap.low_id);
  } else {
    column_.insert(first, gap);
  }
  set_gaps(cell, column_);
  return static_cast<float>((static_cast<double>(top) - hollow_before) -
                            (static_cast<double>(new_top) - hollow(column_)));
}

}  // namespace kerf
