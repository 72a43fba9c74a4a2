// twin/compare/design_file.h - the part as designed, from its file to where it lies.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "twin/compare/design_part.h"

namespace kerf {

/// How a design is put into the workpiece frame: turned about X, then Y, then Z of its own zero,
/// then shifted.
struct DesignPlacement {
  Vec3 shift_mm{0};
  Vec3 turn_deg{0};
  bool is_plain() const { return shift_mm == Vec3(0) && turn_deg == Vec3(0); }
  Vec3 placed(const Vec3& p) const;
  /// "shifted by X1 Y2 Z3 mm, turned by .."; empty if it is as in its file.
  std::string text() const;
};

/// A mesh with at least one triangle, as it was read.
struct DesignFile {
  std::string path;
  TriangleMesh mesh;  ///< mm
  Box box_mm;

  DesignPart placed(const DesignPlacement& placement, Diagnostics& diagnostics) const;
};

/// More triangles are refused: some 250 bytes each are needed.
inline constexpr std::size_t kMostDesignTriangles = 8'000'000;

/// Reads STL, OBJ or 3MF, by the ending of the name. `mm_per_unit`: of STL and OBJ, which do not
/// say. Null with an error in `diagnostics`: "--compare: part.stl: ..".
std::shared_ptr<const DesignFile> read_design(const std::string& path, double mm_per_unit,
                                              Diagnostics& diagnostics);

/// What is odd about where a design lies, as warnings about its file: beside or partly beside the
/// blank, with the shift that puts it inside; so small or large that it is of another unit.
void doubt_place(const DesignPart& design, const std::string& path, const Box& blank_mm,
                 double tolerance_mm, Diagnostics& diagnostics);

}  // namespace kerf
