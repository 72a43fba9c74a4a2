// stock/turning/convex_cut.h - what a region and a convex polygon have in common, and the region
// without it.
//
//        S  .---------.              Where the contours of S and K cross, one of them goes on along
//           |    .----+----.         the result: of what stays S forward where it leaves K, then K
//           |    |    |    | K       backward where S enters it; of what is removed S forward where
//           '----+----'    |         it enters K, then K forward where S leaves it.
//                '---------'
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stock/turning/contour.h"
#include "stock/turning/convex_region.h"

namespace kerf::turning {

/// Decisions are exact, and never "on": ConvexRegion says how. Crossings are rounded to units.
/// Where that has made contours cross that should not, a general polygon library is asked.
///
/// Source of the idea: K. Weiler, P. Atherton, "Hidden surface removal using polygon area
/// sorting", SIGGRAPH 1977.
class ConvexCut {
 public:
  /// False: nothing in common but lines and points. O(runs + edges near the tool).
  bool look(std::span<const Contour> region, const ConvexRegion& tool);

  /// What is common: rings round it, without those of holes in it.
  std::size_t removed_count() const { return removed_ends_.size(); }
  std::span<const Point> removed(std::size_t i) const;

  /// Round all that changes with it: what is removed, and edges that are cut off somewhere and do
  /// not run along an axis (the rest of them turns by a fraction of a unit).
  const Rect& changed() const { return changed_; }

  /// Takes it out of the region that was looked at. Shreds thinner than kFilm on the average go
  /// with it.
  void apply(std::vector<Contour>& region);
  /// The same of a marked region: edges that the tool has left have this mark, but where they are
  /// edges that were there before (nearer than kSame all along): these keep theirs.
  void apply(std::vector<Contour>& region, std::uint32_t mark);

  /// How often the library was asked so far: for measurements.
  std::uint64_t library_calls() const { return library_calls_; }

  /// 0.1 um, how exactly outlines are kept: what is thinner is no shape.
  static constexpr double kFilm = 10;
  /// Rounding of corners moves an edge by less, 20 nm.
  static constexpr double kSame = 2;

 private:
  struct MarkedEdge {
    Point from, to;
    std::uint32_t mark = 0;
  };
  class PlainSink;
  class MarkedSink;
  struct Crossing {
    Point at;
    std::uint32_t contour = 0, run = 0, index = 0;  ///< the edge of S that begins there
    std::uint32_t edge = 0;                         ///< of K
    bool enters = false;
    std::int64_t share = 0, whole = 1;      ///< how far along K's edge: share / whole
    std::int64_t sideways = 0, across = 1;  ///< how S runs there, relative to K's edge
    std::uint32_t rank = 0;                 ///< its place in order_
    bool done = false;
  };

  void look_at(const Contour& contour, std::uint32_t number, const ConvexRegion& tool);
  void cross(const Point& a, const Point& b, const ConvexRegion& tool, const Crossing& place);
  bool sort_along_tool();
  bool removes_area() const;
  bool swallow(std::span<const Contour> region, const ConvexRegion& tool);
  void trace_removed(std::span<const Contour> region, const ConvexRegion& tool);
  template <class Sink>
  void trace_rest(std::span<const Contour> region, Sink& sink, std::vector<Contour>& fresh);
  template <class Sink>
  void apply_by(std::vector<Contour>& region, Sink& sink);
  void gather_edges(std::span<const Contour> region);
  void append_marked(const Point& from, const Point& to, std::uint32_t mark);
  void look_by_library(std::span<const Contour> region, const ConvexRegion& tool);
  void add_removed(std::span<const Point> ring);
  template <class Sink>
  void follow(const Contour& contour, const Crossing& from, const Crossing& to, Sink& sink) const;

  std::uint32_t next_on_region(std::uint32_t crossing) const;
  std::uint32_t next_on_tool(std::uint32_t crossing) const;
  std::uint32_t previous_on_tool(std::uint32_t crossing) const;

  std::size_t lower_hint_ = 0, upper_hint_ = 0;  // edges of K near the last edge of S
  std::vector<Crossing> crossings_;
  std::vector<std::uint32_t> first_;  // of each contour, and the end
  std::vector<std::uint32_t> order_;  // along K
  std::vector<char> swallowed_;       // contours in K
  std::vector<Point> tool_;
  Rect changed_;
  std::vector<Point> removed_;
  std::vector<std::size_t> removed_ends_;
  bool drowned_ = false;     // K lies in material
  bool by_library_ = false;  // rest_ is what is left
  Rings rest_;
  ContourBuilder builder_;
  // Of marked regions: edges that a tool's may be, of those of one tool's edge pieces of its
  // length.
  struct KeptPiece {
    double low = 0, high = 0;
    std::uint32_t mark = 0;
  };
  std::vector<MarkedEdge> edges_before_;
  std::vector<KeptPiece> kept_;
  std::uint64_t library_calls_ = 0;
};

}  // namespace kerf::turning
