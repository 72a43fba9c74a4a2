// viewer/csg/csg_store.h - the solids on the graphics card. For the sources of viewer/ only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/csg/csg_blank.h"
#include "viewer/csg/swept_solid.h"
#include "viewer/gl_objects.h"

namespace kerf {

/// Where a solid lies in the buffers of a SolidStore.
struct StoredSolid {
  GLint first_vertex = 0;
  GLsizei index_count = 0;
  std::size_t first_index = 0;
};

/// Vertex and index buffer that grow by doubling. Uploads in one go, before drawing.
class SolidStore {
 public:
  SolidStore();

  StoredSolid add(const SolidMesh& mesh);
  void clear();
  /// Sends what was added since the last call.
  void upload();
  /// Binds the vertex array; call before draw().
  void bind() const { glBindVertexArray(array_.name()); }
  /// One call, however many solids.
  void draw(std::span<const StoredSolid> solids);
  std::size_t gpu_bytes() const { return vertices_.capacity + indices_.capacity; }

 private:
  struct Buffer {
    GlBuffer name;
    std::size_t capacity = 0;  // bytes, both
    std::size_t used = 0;
    std::vector<std::byte> waiting;
    bool send();
  };
  void connect() const;

  GlVertexArray array_;
  Buffer vertices_;
  Buffer indices_;
  std::vector<GLsizei> counts_;
  std::vector<const void*> offsets_;
  std::vector<GLint> first_vertices_;
};

/// The blank, lit like the solids.
class BlankStore {
 public:
  BlankStore();
  void set(const CsgBlank& blank);
  void draw() const;
  std::size_t gpu_bytes() const { return static_cast<std::size_t>(count_) * sizeof(SolidVertex); }

 private:
  GlVertexArray array_;
  GlBuffer vertices_;
  GLsizei count_ = 0;
};

}  // namespace kerf
