// viewer/window/mesh_buffers.h - triangles on the graphics card. For the sources of viewer/ only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "viewer/gl_objects.h"

namespace kerf {

/// Attributes 0 and 1 of the vertex array bound now: position and normal as MeshVertex has them,
/// from the array buffer bound now.
void point_to_mesh_vertices();

/// A mesh that is drawn whole or in ranges of its indices.
class MeshBuffers {
 public:
  /// `vertex_bytes` of 16 bytes a vertex, as above.
  void load(const void* vertices, std::size_t vertex_bytes, std::span<const std::uint32_t> indices);
  void draw(std::size_t first_index, std::size_t index_count) const;
  void draw_all() const { draw(0, index_count_); }
  std::size_t gpu_bytes() const { return gpu_bytes_; }

 private:
  GlVertexArray array_;
  GlBuffer vertices_;
  GlBuffer indices_;
  std::size_t index_count_ = 0;
  std::size_t gpu_bytes_ = 0;
};

}  // namespace kerf
