// Mesh files from arbitrary bytes, of each format; what is a mesh becomes a body.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mesh/mesh_reader.h"
#include "twin/collision/solid.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const kerf::MeshFormat format :
       {kerf::MeshFormat::kStl, kerf::MeshFormat::kObj, kerf::MeshFormat::k3mf}) {
    const auto read = kerf::parse_mesh(bytes, "a", format, 1, 10'000);
    if (!read) {
      if (read.error().empty()) std::abort();
      continue;
    }
    const auto corners = read->mesh.positions_mm.size();
    for (const auto& triangle : read->mesh.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= corners) std::abort();
    kerf::Solid::of_mesh(read->mesh)->encloses({1, 2, 3});
  }
  return 0;
}
