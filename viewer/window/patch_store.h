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
/// first. Tiles are drawn in the order of their numbers, so that equal scenes give equal pictures.
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

  /// Tiles of several levels meet: their skirts are drawn too. When this changes, so may any pixel.
  bool draws_skirts() const { return tiles_by_level_.size() > 1; }

  std::size_t gpu_bytes() const { return gpu_bytes_; }
  /// Of what is uploaded; never shrinks until clear(), so that the depth range of the camera stays.
  const Box& bounds_mm() const { return bounds_mm_; }

 private:
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
    std::vector<Box> run_boxes_mm;  // of kRunIndices indices each
    ScreenRect rect;
  };

  void load(Tile* tile, std::shared_ptr<const MeshPatch> patch);
  /// Returns the triangles drawn.
  std::size_t draw_runs(const Tile& tile, const ScreenRect& rect) const;

  std::map<std::uint32_t, Tile> tiles_;
  std::map<std::uint32_t, std::shared_ptr<const MeshPatch>> waiting_;
  std::deque<std::uint32_t> waiting_order_;
  std::size_t waiting_bytes_ = 0;
  std::size_t gpu_bytes_ = 0;
  std::map<int, std::size_t> tiles_by_level_;
  Box bounds_mm_;
  Projection projection_;
};

}  // namespace kerf
