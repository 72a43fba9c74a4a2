// stock/turning/engagement.h - how a tool was in the material that it removed on a straight way.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stock/turning/convex_cut.h"
#include "stock/turning/insert_sweep.h"

namespace kerf::turning {

/// Over pieces that a straight way removes. All mm.
///
///     ------------.               Seen along the way, the tool's leading edges lie one beside the
///      material   |  \            other. A piece of material meets those beside which it lies, and
///     ............|   > tool      how wide it is across the way, where the tool's front is in it,
///     -------.....|  /            says how deep the tool cuts.
///             <-- |
struct Engagement {
  bool any = false;
  double across_mm = 0;  ///< greatest width of material before the front at once
  double way_mm = 0;     ///< how long the front was in material
  double first = 0;      ///< share of the way after which it first was
  std::array<double, kInsertSides> side_mm{};  ///< width of material that edges of that side met
  /// Edges that met material over the way: how long they are, and how wide across the way.
  double edge_mm = 0, edge_across_mm = 0;
  /// Of ways one after the other: the width that front and back flank met at once, the lesser of
  /// the two.
  double flanks_mm = 0;

  /// With another part of the tool on the same way: all is the greatest, `first` the least; edges
  /// are those of the longer one.
  void join(const Engagement& other);
  /// Of a way that goes on: widths are the greatest, lengths add up.
  void extend(const Engagement& other);
};

/// How much of a region there is along each of many parallel lines, from its edges: a chain of
/// straight pieces over the lines' places.
class Sections {
 public:
  struct Span {
    double low = 0, high = 0;
  };

  void clear() { events_.clear(); }
  /// Part of a ring round the region (counter-clockwise as lines and what is along them are x and
  /// y): from one place and height to another.
  void add_edge(double from, double from_height, double to, double to_height);
  /// Sums up; before anything is asked.
  void finish();

  /// Where at least this much is there, without stretches shorter than `shortest`.
  void spans_above(double least, double shortest, std::vector<Span>& spans) const;
  /// The greatest mean over a window of this width; over all if it is narrower.
  double greatest_mean(double window) const;

 private:
  struct Event {
    double place = 0, jump = 0, slope = 0;
  };
  struct Piece {
    double place = 0, height = 0, slope = 0;  ///< from there on
    double area = 0;                          ///< before
  };
  double area_before(std::size_t piece, double place) const;

  std::vector<Event> events_;
  std::vector<Piece> pieces_;
};

/// What is less than ConvexCut::kFilm wide or long does not count: rounding makes such. Nor do
/// pieces thinner than 0.4 um on the average: noses are chains of chords.
class EngagementGauge {
 public:
  /// `way` is the tool's, to - from, in units.
  Engagement measure(const ConvexCut& cut, const GridPart::Lead& lead, const Point& way);

  /// Depths of cut are those of this much of the way, 10 um, on the average: where walls begin or
  /// end side by side, rounding says which is first.
  static constexpr double kSteady = 1000;

 private:
  void add_piece(std::span<const Point> ring, const GridPart::Lead& lead, const Vec2& way);

  Sections ahead_;   // material before the front, by how far the front is on its way
  Sections across_;  // material on the way, by where it lies across it
  std::vector<Sections::Span> spans_;
};

}  // namespace kerf::turning
