// viewer/window/patch_store.h - the workpiece on the graphics card, tile by tile. For the sources
// of viewer/ only.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/mesh_patch.h"
#include "viewer/gl_objects.h"
#include "viewer/window/screen_rect.h"
#include "viewer/window/surface_colors.h"

namespace kerf {

/// Patches wait here until upload() takes them within its budget, the tile that has waited longest
/// first. Tiles are drawn in the order of their numbers, so that equal scenes give equal pictures,
/// with their skirts where one beside them is of another level.
class PatchStore {
 public:
  /// Replaces what the tile shows, and what waits for it; costs nothing if it is shown already.
  void offer(std::shared_ptr<const MeshPatch> patch);
  void clear();

  /// Uploads whole patches until `budget_bytes` are used up, but at least one. Appends the boxes in
  /// which the surface changed: not of whole tiles, but of the triangles that are not the same.
  /// Returns the bytes.
  std::size_t upload(std::size_t budget_bytes, std::vector<Box>* changed_mm);
  std::size_t waiting_bytes() const { return waiting_bytes_; }

  /// Where each tile lies on the screen; once per new camera.
  void project(const Projection& projection);
  /// Draws the tiles that touch the rectangle, with the program in use now: those whose patches
  /// have the data, or those that do not. Returns the triangles.
  std::size_t draw(const ScreenRect& rect, VertexData data, bool having) const;

  std::size_t gpu_bytes() const { return gpu_bytes_; }
  /// Of what is uploaded; never shrinks until clear(), so that the depth range of the camera stays.
  const Box& bounds_mm() const { return bounds_mm_; }

 private:
  /// Triangles that follow each other in a patch lie near each other: of a tile that a rectangle
  /// cuts, only those runs are drawn whose boxes it meets.
  struct Run {
    std::size_t begin, end;  // of the indices
    Box box_mm;
  };
  struct Tile {
    std::shared_ptr<const MeshPatch> patch;
    GlVertexArray array;
    GlBuffer vertices;
    GlBuffer indices;
    std::optional<GlBuffer> cut_by;
    std::optional<GlBuffer> deviations;
    std::size_t gpu_bytes = 0;
    GLenum index_type = GL_UNSIGNED_INT;
    Box box_mm;
    std::vector<Run> runs;
    bool draws_skirts = false;  // a tile beside it is of another level
    ScreenRect rect;
  };

  void load(Tile* tile, std::shared_ptr<const MeshPatch> patch);
  static std::vector<Run> runs_of(const MeshPatch& patch);
  /// Calls `with(tile)` for the tiles that share a border with this one.
  template <class With>
  void for_tiles_beside(const MeshPatch& patch, const With& with);
  bool meets_other_level(const MeshPatch& patch);
  /// Returns the triangles drawn.
  std::size_t draw_runs(const Tile& tile, const ScreenRect& rect) const;

  std::map<std::uint32_t, Tile> tiles_;
  std::map<std::uint32_t, std::shared_ptr<const MeshPatch>> waiting_;
  std::deque<std::uint32_t> waiting_order_;
  std::size_t waiting_bytes_ = 0;
  std::size_t gpu_bytes_ = 0;
  Box bounds_mm_;
  Projection projection_;
};

}  // namespace kerf
