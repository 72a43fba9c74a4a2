// twin/guess/tool_guess.h - a cutter for a tool of which nothing is known, by what the program does
// with it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// A shape that fits, and why it was taken: "drilling cycles, the nearest holes 12 mm apart".
struct ShapeGuess {
  std::string shape;  ///< SHAPE text, parse_shape() accepts it
  std::string reason;
};

/// What a program does with one tool. Keeps the feed moves as chords, as floats: 24 B each, the
/// first kMostChords of them; the later ones count in bounds and lengths alone. One thread.
class ToolTrace {
 public:
  static constexpr std::size_t kMostChords = 200'000;

  /// A feed move that goes somewhere. `upright`: of a tool that nothing tilts.
  void add(const Motion& motion, bool upright);

  /// Of the feed moves, mm; empty: there are none.
  const Box& bounds_mm() const { return bounds_mm_; }

  /// It goes down into the blank, whose top is at `top_mm`, and is never fed sideways in it, as
  /// drills are; over it, it may be.
  bool only_plunges(double top_mm) const;

  /// The cutter, with `top_mm` the top of the blank:
  ///   only up and down           a drill, by how deep and how close the holes are
  ///   tilted, or Z follows the part while it goes sideways, in passes side by side
  ///                              a ball; Z follows in single lines: a V-bit (letters, carvings)
  ///   lines at most kEngraved_mm deep, or of a drawing (many short ones, close together)
  ///                              a V-bit (with a flat of 0.2 mm for etching, at most 0.15 mm
  ///                              deep); a flat end mill that is no wider than they are apart,
  ///                              where they are too deep for that
  ///   else a flat end mill, by the way from pass to pass; where there are single lines only, by
  ///   the size of the part, the depth, and the circles that it bores
  /// Any program gets an answer. O(chords).
  ShapeGuess guess(double top_mm) const;

  /// From one pass to the next where passes lie side by side; 0: they do not. By counting how many
  /// squares of a grid the path comes through, from fine grids to coarse ones: of lines half as
  /// many when they are twice as wide, of an area a quarter.
  double step_over_mm() const;

  static constexpr double kEngraved_mm = 0.6;

 private:
  struct Chord {
    float from_x = 0, from_y = 0, from_z = 0;
    float to_x = 0, to_y = 0, to_z = 0;
  };
  void add_chord(const Vec3& from, const Vec3& to);
  void note_circle(const Motion& motion);
  double hole_spacing_mm() const;
  ShapeGuess drill(double depth_mm) const;
  ShapeGuess follower(double depth_mm, double step_mm) const;
  ShapeGuess end_mill(double depth_mm, double step_mm) const;
  double flat_size_mm() const;
  bool is_drawing() const;

  std::vector<Chord> chords_;
  std::vector<Vec2> holes_mm_;  ///< where it goes down
  Box bounds_mm_;
  Box sideways_mm_;  ///< of the moves that go sideways
  double sideways_length_mm_ = 0;
  double slanted_length_mm_ = 0;  ///< of that, where Z changes on the way
  double least_circle_mm_ = 0;    ///< radius of the smallest full circle; 0: there is none
  std::size_t runs_ = 0;          ///< of feeds that go on where the one before has ended
  Vec3 last_mm_{0};
  bool tilted_ = false;
};

}  // namespace kerf
