#include "base/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"

namespace kerf {
namespace {

constexpr std::size_t kStlHeadBytes = 80;
constexpr std::size_t kStlTriangleBytes = 50;
/// Must not begin with "solid": readers take such a file for the text form.
constexpr std::string_view kStlHead = "kerf: binary STL, unit mm";
constexpr std::size_t kPlyVertexBytes = 12;
constexpr std::size_t kPlyMarkBytes = 7;  // a colour and a value
constexpr std::size_t kPlyFaceBytes = 13;
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Stores little endian whatever the host; one plain store on the usual ones.
char* put(char* to, std::uint32_t value) {
  if constexpr (std::endian::native == std::endian::big) value = __builtin_bswap32(value);
  std::memcpy(to, &value, sizeof value);
  return to + sizeof value;
}

char* put(char* to, const glm::vec3& v) {
  for (int axis = 0; axis < 3; ++axis) to = put(to, std::bit_cast<std::uint32_t>(v[axis]));
  return to;
}

/// In double, because the square of a small triangle's area would vanish in single precision.
glm::vec3 facet_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double square = glm::dot(n, n);
  return square > 0.0 ? glm::vec3(n / std::sqrt(square)) : glm::vec3(0.0f);
}

/// Writes `count` records of `record_bytes` in chunks; put_record(to, i) stores record i.
template <class PutRecord>
void write_records(AtomicFile& file, std::size_t count, std::size_t record_bytes,
                   const PutRecord& put_record) {
  const std::size_t records_per_chunk = kChunkBytes / record_bytes;
  std::vector<char> chunk(records_per_chunk * record_bytes);
  for (std::size_t first = 0; first < count; first += records_per_chunk) {
    const std::size_t last = std::min(count, first + records_per_chunk);
    char* to = chunk.data();
    for (std::size_t i = first; i < last; ++i, to += record_bytes) put_record(to, i);
    file.write(chunk.data(), static_cast<std::size_t>(to - chunk.data()));
  }
}

Error too_large(const std::string& path, std::size_t count, const char* what, std::size_t limit) {
  return Error{fmt::format("writing {}: {} {} are more than the format can hold ({})", path, count,
                           what, limit)};
}

}  // namespace

Done write_stl(const std::string& path, const TriangleMesh& mesh) {
  constexpr std::size_t kLimit = std::numeric_limits<std::uint32_t>::max();
  if (mesh.triangles.size() > kLimit) {
    return too_large(path, mesh.triangles.size(), "triangles", kLimit);
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};

  char head[kStlHeadBytes + 4] = {};
  std::memcpy(head, kStlHead.data(), kStlHead.size());
  put(head + kStlHeadBytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  file->write(head, sizeof head);

  const auto put_triangle = [&mesh](char* to, std::size_t i) {
    const auto& corners = mesh.triangles[i];
    assert(corners[0] < mesh.positions_mm.size() && corners[1] < mesh.positions_mm.size() &&
           corners[2] < mesh.positions_mm.size());
    const glm::vec3& a = mesh.positions_mm[corners[0]];
    const glm::vec3& b = mesh.positions_mm[corners[1]];
    const glm::vec3& c = mesh.positions_mm[corners[2]];
    to = put(put(put(put(to, facet_normal(a, b, c)), a), b), c);
    to[0] = to[1] = 0;  // attribute byte count
  };
  write_records(*file, mesh.triangles.size(), kStlTriangleBytes, put_triangle);
  return file->commit();
}

namespace {

Done write_ply(const std::string& path, const TriangleMesh& mesh, const VertexMarks* marks) {
  // Corners are written as "int", the one type of index that every reader knows.
  constexpr std::size_t kLimit = std::numeric_limits<std::int32_t>::max();
  if (mesh.positions_mm.size() > kLimit) {
    return too_large(path, mesh.positions_mm.size(), "vertices", kLimit);
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};

  const std::string marked = marks == nullptr ? ""
                                              : fmt::format(
                                                    "property uchar red\nproperty uchar green\n"
                                                    "property uchar blue\nproperty float {}\n",
                                                    marks->name);
  const std::string head = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment kerf, unit mm\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.positions_mm.size(), marked, mesh.triangles.size());
  file->write(head.data(), head.size());

  const auto put_vertex = [&](char* to, std::size_t i) {
    to = put(to, mesh.positions_mm[i]);
    if (marks == nullptr) return;
    for (const std::uint8_t part : marks->rgb[i]) *to++ = static_cast<char>(part);
    put(to, std::bit_cast<std::uint32_t>(marks->values[i]));
  };
  const std::size_t vertex_bytes = kPlyVertexBytes + (marks == nullptr ? 0 : kPlyMarkBytes);
  write_records(*file, mesh.positions_mm.size(), vertex_bytes, put_vertex);
  const auto put_face = [&mesh](char* to, std::size_t i) {
    *to++ = 3;
    for (const std::uint32_t corner : mesh.triangles[i]) to = put(to, corner);
  };
  write_records(*file, mesh.triangles.size(), kPlyFaceBytes, put_face);
  return file->commit();
}

}  // namespace

Done write_ply(const std::string& path, const TriangleMesh& mesh) {
  return write_ply(path, mesh, nullptr);
}

Done write_ply(const std::string& path, const TriangleMesh& mesh, const VertexMarks& marks) {
  assert(marks.rgb.size() == mesh.positions_mm.size());
  assert(marks.values.size() == mesh.positions_mm.size());
  return write_ply(path, mesh, &marks);
}

}  // namespace kerf
