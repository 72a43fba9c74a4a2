// viewer/picture.h - an offscreen picture of a finished part. Needs no display and no GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/mesh_patch.h"
#include "base/result.h"
#include "base/triangle_mesh.h"
#include "viewer/scene.h"
#include "viewer/section.h"
#include "viewer/standing.h"

namespace kerf {

/// What stands around a part: a fixture.
struct PictureBody {
  std::shared_ptr<const TriangleMesh> mesh;  ///< in its own frame
  glm::mat4 pose{1.0f};                      ///< from there to that of the part
  std::uint32_t color = 0xffa0a0a0;          ///< 0xAABBGGRR; alpha is not looked at
};

struct PictureOptions {
  int width_px = 1600;  ///< 64 to 8192, both
  int height_px = 1200;
  Box blank_mm;  ///< drawn as a thin outline with its sizes written on it
  /// Drawn instead of the edges of the box.
  std::vector<LineSegment> blank_outline{};
  /// In a lathe the sizes are diameter and length.
  Standing standing = Standing::kOnTable;
  SectionKind section = SectionKind::kNone;  ///< the part is cut open through the blank's middle
  std::vector<PictureBody> bodies{};  ///< seen through; those far away may lie outside the picture
  std::string caption;  ///< small text at the lower left ("3D_Chips.ngc  zmap 0.05 mm")
};

/// 8-bit RGB, rows from the top.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;
};

/// A part's surface as a picture draws it: in patches, of which only one exists at a time.
struct PartPatches {
  Box bounds_mm;  ///< in which all of them lie; empty if there are none
  std::size_t count = 0;
  /// Patch `number`, 0 .. count - 1; `pixel_mm`: what a pixel shows where the part is nearest to
  /// the eye. Its surface_indices() are drawn; those of all patches together are closed.
  std::function<MeshPatch(std::size_t number, double pixel_mm)> make;
};

/// The part with the normals of its patches from a three-quarter view (from front right above),
/// sharp edges drawn, X/Y/Z axes at the origin of the workpiece frame (in a corner of the picture
/// if the origin is far away), blank outline, sizes in mm as labels. Antialiased. No patches show
/// the outline alone; an empty blank is not drawn. Same pixels for the same input on the same
/// driver. About 0.6 s and 0.2 us a triangle on one core without a GPU. Calls from several threads
/// wait for each other.
/// Error if no renderer can be had, with the reason; if the size is not allowed; if part and blank
/// are both empty.
Result<Picture> draw_part(const PartPatches& part, const PictureOptions& options);

/// PNG; written under a temporary name and renamed. "-" is stdout.
Done write_png(const std::string& path, const Picture& picture);

}  // namespace kerf
