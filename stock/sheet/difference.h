// stock/sheet/difference.h - a region without a kerf, where no corner lies on an edge.
//
//        S  .---------.              Where the contours of S and K cross, one of them goes on along
//           |    .----+----.         the result: S forward where it leaves K, K backward where S
//           |    |    |    | K       enters it. Contours that cross nothing stay, vanish or become
//           '----+----'    |         holes as a whole.
//                '---------'
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "stock/sheet/polygon.h"

namespace kerf::sheet {

/// Takes kerfs away from regions several times faster than a general polygon library: it sorts
/// nothing but the crossings. It does so only where these are plain. Decisions are exact;
/// crossings are rounded to units.
///
/// Source of the idea: K. Weiler, P. Atherton, "Hidden surface removal using polygon area
/// sorting", SIGGRAPH 1977.
class Difference {
 public:
  /// subject \ kerf. `subject`: rings of a region. `kerf`: rings that wind once or not at all round
  /// each point near the subject, none crossing itself or another there; only its edges that meet
  /// `window` are looked at, and all of the subject that comes near them lies within the window.
  ///
  /// False, and nothing is to be read, where a corner of one lies on an edge of the other, edges
  /// lie on each other, crossings are too close to be told in order, coordinates exceed 100 m, or
  /// the subject crosses itself in a way that shows. O(n + m + n' m' / kChunk) for n', m' edges
  /// near each other.
  bool subtract(std::span<const Ring* const> subject, const Rings& kerf, const Rect& window);

  /// Rings that are new. No corner of theirs is on the line of its neighbours.
  std::vector<Ring>& fresh() { return fresh_; }
  /// Of each subject ring whether it is in the result as it was.
  const std::vector<char>& untouched() const { return untouched_; }
  /// One of the new rings bounds material: it may be a piece out of a ring that is untouched.
  bool has_fresh_outer() const { return has_fresh_outer_; }

 private:
  struct Edge {
    Point a, b;
    std::uint32_t ring, index;
  };
  struct Crossing {
    Point at;
    std::uint32_t subject_ring, subject_edge, kerf_ring, kerf_edge;
    double along_subject, along_kerf;
    bool subject_enters;  ///< the kerf, and there the kerf's contour leaves the subject
    bool done = false;
    std::uint32_t next = 0;      ///< on the subject's ring
    std::uint32_t previous = 0;  ///< on the kerf's
  };
  static constexpr std::size_t kChunk = 8;

  bool gather_kerf(const Rings& kerf, const Rect& window);
  bool cross_ring(const Ring& ring, std::uint32_t number);
  bool cross_edge(const Point& a, const Point& b, const Edge& edge, std::uint32_t ring,
                  std::uint32_t index);
  bool link();
  void trace(std::span<const Ring* const> subject, const Rings& kerf);
  void add_whole_rings(std::span<const Ring* const> subject, const Rings& kerf);
  void emit();

  std::vector<Edge> edges_;   // of the kerf, near the window
  std::vector<Rect> chunks_;  // boxes of kChunk of them each
  Rect reach_;                // of all
  std::vector<Crossing> crossings_;
  std::vector<std::uint32_t> order_;
  std::vector<char> crossed_subject_, crossed_kerf_;
  Ring ring_;  // being traced
  std::vector<Ring> fresh_;
  std::vector<char> untouched_;
  bool has_fresh_outer_ = false;
};

}  // namespace kerf::sheet
