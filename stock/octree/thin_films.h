// stock/octree/thin_films.h - films that the octree loses, added up until they are areas.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include "stock/octree/tree_cut.h"
#include "stock/stock_model.h"

namespace kerf::octree {

/// A film lies between the surface of before and that of the last move, with no node inside. It
/// counts once a brick has kLeastFaces of it, whichever moves made them: a knife's edge between two
/// grooves has less, and a film that is some cells wide both ways is often cut by short moves. The
/// move that makes it so much is the one that is told, with all the area so far.
///
/// Memory for bricks that have lost a film, 40 bytes each. Looking for films takes 3.9 % of the
/// instructions of cutting with an upright ball, 2.7 % with one that tilts (callgrind).
class ThinFilms {
 public:
  static constexpr double kLeastFaces = 24;  ///< of a brick's 64 across

  /// `spots` as cut_tree() gives them; adds to films[spot.report], whose place and thickness become
  /// those of the brick with most of it.
  void add(std::span<const FilmSpot> spots, double face_mm2, std::span<CutFilm> films);

 private:
  std::unordered_map<std::uint64_t, double> faces_;  ///< so far, by brick
};

}  // namespace kerf::octree
