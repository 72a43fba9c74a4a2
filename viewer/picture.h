// viewer/picture.h - an offscreen picture of a finished part. Needs no display and no GPU.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

struct PictureOptions {
  int width_px = 1600;  ///< 64 to 8192, both
  int height_px = 1200;
  Box blank_mm;         ///< drawn as a thin outline with its sizes written on it
  std::string caption;  ///< small text at the lower left ("3D_Chips.ngc  zmap 0.05 mm")
};

/// 8-bit RGB, rows from the top.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;
};

/// The mesh shaded from a three-quarter view (from front right above), sharp edges drawn, X/Y/Z
/// axes at the origin of the workpiece frame (in a corner of the picture if the origin is far
/// away), blank outline, sizes in mm as labels. Antialiased. An empty mesh shows the outline alone;
/// an empty blank is not drawn. Same pixels for the same input on the same driver. About 0.6 s for
/// 400 000 triangles on one core without a GPU. Calls from several threads wait for each other.
/// Error if no renderer can be had, with the reason; if the size is not allowed; if mesh and blank
/// are both empty.
Result<Picture> draw_part(const TriangleMesh& mesh, const PictureOptions& options);

/// PNG; written under a temporary name and renamed. "-" is stdout.
Done write_png(const std::string& path, const Picture& picture);

}  // namespace kerf
