// stock/turning/contour.h - a closed chain of corners in shared runs, so that copies and changes
// cost what changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "stock/turning/grid.h"

namespace kerf::turning {

/// Some corners that follow each other. Never changed once it is made.
struct Run {
  std::vector<Point> points;
  /// Of a marked run one a corner: what made the edge that begins there. Empty in others.
  std::vector<std::uint32_t> marks;
  Rect box;
  // Over the edges between its own corners:
  std::uint64_t area2 = 0;  ///< may wrap round; the sum of a contour is right again
  Wide moment6 = 0;
};
using RunPointer = std::shared_ptr<const Run>;
RunPointer make_run(std::vector<Point> points, std::vector<std::uint32_t> marks = {});

/// Counter-clockwise round material, clockwise round a hole. No corner is on the line of its
/// neighbours, unless it is marked and another mark begins there. All runs are marked or none is.
class Contour {
 public:
  Contour() = default;
  /// Closed by the edge from the last corner of the last run to the first of the first.
  explicit Contour(std::vector<RunPointer> runs);

  const std::vector<RunPointer>& runs() const { return runs_; }
  const Rect& box() const { return box_; }
  std::int64_t area2() const { return area2_; }  ///< twice the area; negative for a hole
  Wide moment6() const { return moment6_; }
  bool is_outer() const { return area2_ > 0; }
  std::size_t corner_count() const;
  Ring ring() const;
  /// Whether area over half the way round, which is the thickness of what is long and thin, is less
  /// than this. O(runs) for most that are not.
  bool is_thinner(double units) const;

 private:
  std::vector<RunPointer> runs_;
  Rect box_;
  std::int64_t area2_ = 0;
  Wide moment6_ = 0;
};

/// Calls each(from, to, mark) for every edge; mark is 0 where there are none.
template <class Each>
void each_edge(const Contour& contour, Each&& each) {
  const std::vector<RunPointer>& runs = contour.runs();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Run& run = *runs[r];
    const Point& next = runs[r + 1 == runs.size() ? 0 : r + 1]->points.front();
    for (std::size_t i = 0; i < run.points.size(); ++i) {
      each(run.points[i], i + 1 == run.points.size() ? next : run.points[i + 1],
           run.marks.empty() ? 0 : run.marks[i]);
    }
  }
}

/// Makes a contour of corners and of runs of others, which it shares where they are whole. Of one
/// contour either all are marked or none is.
class ContourBuilder {
 public:
  /// Corners on the line of their neighbours are left out, and so is a way there and back.
  void append(const Point& p);
  /// The same of a corner where an edge with this mark begins.
  void append(const Point& p, std::uint32_t mark);
  /// The whole run.
  void append(const RunPointer& run);
  /// Begins anew. A contour of less than three corners has no runs.
  Contour close();

 private:
  static constexpr std::size_t kRun = 64;

  struct Place {
    const Run* run;  // null: in open_
    std::size_t index;
  };
  Place place_from_end(std::size_t back) const;
  const Point& from_end(std::size_t back) const;
  std::uint32_t mark_from_end(std::size_t back) const;
  bool is_passed(const Point& before, const Point& corner, const Point& after,
                 std::size_t before_from_end, std::size_t corner_from_end) const;
  bool push(const Point& p);
  void pop_back();
  void pop_front();
  void open_last();
  void flush();

  std::vector<RunPointer> runs_;
  std::vector<Point> open_;  // behind them
  std::vector<std::uint32_t> open_marks_;
  bool is_marked_ = false;
  std::size_t count_ = 0;
};

}  // namespace kerf::turning
