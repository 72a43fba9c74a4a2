#include "mesh/mesh_reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "mesh/mesh_joiner.h"
#include "mesh/obj_mesh.h"
#include "mesh/step_file.h"
#include "mesh/stl_mesh.h"
#include "mesh/threemf_mesh.h"

namespace kerf {
namespace {

/// What the head of a binary STL announces; files of other kinds pass.
Done check_head(const std::string& path, std::size_t most_triangles) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  // What cannot be read, read_small_file() has words for.
  if (!file) return Done{std::monostate{}};
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0));
  file.seekg(0);
  const std::string head = read_up_to(file, kStlHead_bytes);
  const std::size_t triangles = triangles_of_stl(head, size);
  return MeshJoiner(most_triangles).announce(triangles, path);
}

Done parse(std::string_view bytes, const std::string& path, MeshFormat format, double mm_per_unit,
           MeshJoiner& joiner) {
  switch (format) {
    case MeshFormat::kStl:
      return parse_stl(bytes, path, mm_per_unit, joiner);
    case MeshFormat::kObj:
      return parse_obj(bytes, path, mm_per_unit, joiner);
    case MeshFormat::k3mf:
    case MeshFormat::kStep:
      break;
  }
  return parse_3mf(bytes, path, joiner);
}

}  // namespace

std::optional<MeshFormat> mesh_format_of(const std::string& path) {
  const std::string ending = to_lower(std::filesystem::path(path).extension().string());
  if (ending == ".stl") return MeshFormat::kStl;
  if (ending == ".obj") return MeshFormat::kObj;
  if (ending == ".3mf") return MeshFormat::k3mf;
  if (ending == ".step" || ending == ".stp") return MeshFormat::kStep;
  return std::nullopt;
}

Result<MeshFromFile> parse_mesh(std::string_view bytes, const std::string& path, MeshFormat format,
                                double mm_per_unit, std::size_t most_triangles) {
  MeshJoiner joiner(most_triangles);
  if (const Done parsed = parse(bytes, path, format, mm_per_unit, joiner); !parsed)
    return Error{parsed.error()};
  MeshFromFile out;
  out.flat = joiner.flat();
  Result<TriangleMesh> mesh = joiner.take(path);
  if (!mesh) return Error{mesh.error()};
  out.mesh = std::move(mesh.value());
  return out;
}

Result<MeshFromFile> read_mesh(const std::string& path, MeshFormat format, double mm_per_unit,
                               std::size_t most_triangles) {
  if (format == MeshFormat::kStl) {
    if (const Done fits = check_head(path, most_triangles); !fits) return Error{fits.error()};
  }
  if (format == MeshFormat::kStep) {
    const Result<std::string> stl = step_as_stl(path, kMaxStl_bytes);
    if (!stl) return Error{stl.error()};
    return parse_mesh(*stl, path, MeshFormat::kStl, 1, most_triangles);
  }
  const Result<std::string> bytes = read_small_file(path, kMaxStl_bytes);
  if (!bytes) return Error{bytes.error()};
  return parse_mesh(*bytes, path, format, mm_per_unit, most_triangles);
}

}  // namespace kerf
