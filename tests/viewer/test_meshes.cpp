#include "tests/viewer/test_meshes.h"

#include <png.h>

#include <cmath>
#include <utility>

#include "viewer/shaded_mesh.h"

namespace kerf {

TriangleMesh box_mesh(const Box& box) {
  TriangleMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.positions_mm.push_back(Vec3((corner & 1u) ? box.max.x : box.min.x,
                                     (corner & 2u) ? box.max.y : box.min.y,
                                     (corner & 4u) ? box.max.z : box.min.z));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh prism_mesh(int sides, float radius_mm, float height_mm) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    const float angle =
        2.0f * static_cast<float>(kPi) * static_cast<float>(i) / static_cast<float>(n);
    const glm::vec3 p(radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0.0f);
    mesh.positions_mm.push_back(p);
    mesh.positions_mm.push_back(p + glm::vec3(0, 0, height_mm));
  }
  mesh.positions_mm.push_back({0, 0, 0});
  mesh.positions_mm.push_back({0, 0, height_mm});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t low = 2 * i, high = low + 1;
    const std::uint32_t next_low = 2 * ((i + 1) % n), next_high = next_low + 1;
    mesh.triangles.push_back({low, next_low, next_high});
    mesh.triangles.push_back({low, next_high, high});
    mesh.triangles.push_back({2 * n, next_low, low});
    mesh.triangles.push_back({2 * n + 1, high, next_high});
  }
  return mesh;
}

namespace {

template <class Height>
TriangleMesh grid_mesh(int cells, const Height& height_mm) {
  TriangleMesh mesh;
  const double cell_mm = 100.0 / cells;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = i * cell_mm;
      const double y = j * cell_mm;
      mesh.positions_mm.push_back(Vec3(x, y, height_mm(x, y)));
    }
  }
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      mesh.triangles.push_back({a, a + 1, a + row + 1});
      mesh.triangles.push_back({a, a + row + 1, a + row});
    }
  }
  return mesh;
}

}  // namespace

TriangleMesh relief_mesh(int cells) {
  return grid_mesh(cells, [](double x, double y) {
    if (std::hypot(x - 30.0, y - 65.0) < 18.0) return -22.0;
    if (std::fabs(x - y - 30.0) < 5.0) return 0.0;
    return -5.0 + 1.8 * std::sin(0.14 * x) * std::cos(0.11 * y);
  });
}

TriangleMesh terrace_mesh(int cells, double period_mm) {
  return grid_mesh(cells, [period_mm](double x, double y) {
    return -1.0 - 0.4 * std::floor(std::hypot(x - 100.0, y - 100.0) / period_mm);
  });
}

PartPatches part_of(const TriangleMesh& mesh) {
  ShadedMesh shaded = shade_mesh(mesh, {});
  MeshPatch patch;
  patch.vertices = std::move(shaded.vertices);
  patch.indices = std::move(shaded.indices);
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  PartPatches part;
  for (const glm::vec3& position : mesh.positions_mm) part.bounds_mm.extend(Vec3(position));
  part.count = mesh.triangles.empty() ? 0 : 1;
  part.make = [patch = std::move(patch)](std::size_t, double) { return patch; };
  return part;
}

Picture read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return {};
  image.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0) return {};
  return picture;
}

}  // namespace kerf
