// twin/job/blank_mesh.h - blanks from mesh files: castings, printed parts, earlier parts.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "stock/blank.h"
#include "twin/collision/solid.h"

namespace kerf {

/// Reads what blank.mesh names, places it and lets it grow. True where there is none. False with an
/// error: the file is missing or no mesh, the mesh is open (and where) or encloses nothing. Notes:
/// it was inside out, flat triangles were left out, its size suggests inches. A second or two for a
/// million triangles.
bool read_blank_mesh(Blank& blank, Diagnostics& diagnostics);
/// More triangles are refused.
inline constexpr std::size_t kMostBlankTriangles = 8'000'000;

/// Why a Z-map does not hold what the mesh encloses ("the mesh has undercuts, ..."); empty: it
/// does, or there is no mesh.
std::string need_of_mesh(const Blank& blank);

/// The blank as a body for collisions; null: nobody knows its shape (a saved workpiece, a sheet).
SolidPointer solid_of(const Blank& blank);

/// Whether a blank has material over or under places, seen from above.
class BlankShadow {
 public:
  /// Of what `body` encloses, in cells of at most `cell_mm`.
  BlankShadow(const MeshBody& body, double cell_mm);
  /// Material is over or under the place; good to a cell at the outline.
  bool covers(double x_mm, double y_mm) const;
  double cell_mm() const;

 private:
  Box bounds_mm_;
  int nx_, ny_;
  std::vector<bool> covered_;
};

}  // namespace kerf
