#include "viewer/csg/csg_store.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/mesh_patch.h"

namespace kerf {
namespace {

constexpr std::size_t kFirstCapacity_bytes = 64u << 10;

/// Of the buffer bound as GL_ARRAY_BUFFER, for the vertex array bound.
void set_attributes() {
  constexpr auto kStride = static_cast<GLsizei>(sizeof(SolidVertex));
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(SolidVertex, position_mm)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, kStride,
                        at(offsetof(SolidVertex, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, at(offsetof(SolidVertex, color)));
}

template <class T>
void append_bytes(const std::vector<T>& values, std::vector<std::byte>* bytes) {
  const std::span<const std::byte> added = std::as_bytes(std::span(values));
  bytes->insert(bytes->end(), added.begin(), added.end());
}

}  // namespace

SolidStore::SolidStore() { connect(); }

void SolidStore::connect() const {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name.name());
  set_attributes();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name.name());
  glBindVertexArray(0);
}

StoredSolid SolidStore::add(const SolidMesh& mesh) {
  const std::size_t vertex_bytes = vertices_.used + vertices_.waiting.size();
  StoredSolid solid;
  solid.first_vertex = static_cast<GLint>(vertex_bytes / sizeof(SolidVertex));
  solid.first_index = indices_.used + indices_.waiting.size();
  solid.index_count = static_cast<GLsizei>(mesh.indices.size());
  append_bytes(mesh.vertices, &vertices_.waiting);
  append_bytes(mesh.indices, &indices_.waiting);
  return solid;
}

void SolidStore::clear() {
  for (Buffer* buffer : {&vertices_, &indices_}) {
    buffer->used = 0;
    buffer->waiting.clear();
  }
}

/// True if the buffer object is another one now.
bool SolidStore::Buffer::send() {
  const bool is_small = used + waiting.size() > capacity;
  glBindBuffer(GL_COPY_WRITE_BUFFER, name.name());
  if (is_small) {
    capacity = std::max({2 * capacity, used + waiting.size(), kFirstCapacity_bytes});
    GlBuffer larger;
    glBindBuffer(GL_COPY_READ_BUFFER, name.name());
    glBindBuffer(GL_COPY_WRITE_BUFFER, larger.name());
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(capacity), nullptr, GL_DYNAMIC_DRAW);
    if (used > 0) {
      glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0,
                          static_cast<GLsizeiptr>(used));
    }
    name = std::move(larger);
  }
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(used),
                  static_cast<GLsizeiptr>(waiting.size()), waiting.data());
  used += waiting.size();
  waiting.clear();
  return is_small;
}

void SolidStore::upload() {
  if (vertices_.waiting.empty()) return;
  const bool has_new_vertices = vertices_.send();
  const bool has_new_indices = indices_.send();
  if (has_new_vertices || has_new_indices) connect();
}

void SolidStore::draw(std::span<const StoredSolid> solids) {
  counts_.clear();
  offsets_.clear();
  first_vertices_.clear();
  for (const StoredSolid& solid : solids) {
    counts_.push_back(solid.index_count);
    offsets_.push_back(reinterpret_cast<const void*>(solid.first_index));
    first_vertices_.push_back(solid.first_vertex);
  }
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_SHORT, offsets_.data(),
                                static_cast<GLsizei>(solids.size()), first_vertices_.data());
}

BlankStore::BlankStore() {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  set_attributes();
  glBindVertexArray(0);
}

void BlankStore::set(const CsgBlank& blank) {
  std::vector<SolidVertex> vertices;
  vertices.reserve(3 * blank.mesh.triangles.size());
  for (const auto& triangle : blank.mesh.triangles) {
    const glm::vec3& a = blank.mesh.positions_mm[triangle[0]];
    const glm::vec3& b = blank.mesh.positions_mm[triangle[1]];
    const glm::vec3& c = blank.mesh.positions_mm[triangle[2]];
    const glm::vec3 area = glm::cross(b - a, c - a);
    const float size = glm::length(area);
    const std::uint32_t normal = pack_normal(size > 0.0f ? area / size : glm::vec3(0, 0, 1));
    for (const glm::vec3& p : {a, b, c}) vertices.push_back({p, normal, blank.color});
  }
  count_ = static_cast<GLsizei>(vertices.size());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(SolidVertex)),
               vertices.data(), GL_STATIC_DRAW);
}

void BlankStore::draw() const {
  glBindVertexArray(array_.name());
  glDrawArrays(GL_TRIANGLES, 0, count_);
}

}  // namespace kerf
