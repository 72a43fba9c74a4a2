// viewer/raycast/body_rays.h - bodies that are seen through, by rays on the CPU: fixtures, a chuck.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "viewer/mesh_rays.h"
#include "viewer/orbit_camera.h"
#include "viewer/picture.h"
#include "viewer/scene.h"

namespace kerf {

/// Lays the nearest outer surface of each body over a picture, as clear as its colour says, and
/// clearer where it hides the workpiece (sight_lines.h): as the window draws what stands around a
/// workpiece. Nothing is marked red.
class BodyRays {
 public:
  /// Shades the meshes: about 1.5 us a triangle.
  void set_bodies(const SceneMachine& bodies);
  bool has_bodies() const { return !bodies_.empty(); }

  /// `poses`: one a body, from its frame to that of the workpiece, or kNotDrawn. `part_mm`: the box
  /// that is to be seen; may be empty. `depths`: window depths of the picture, rows from the top;
  /// bodies have none. About 1 us a pixel that a body may cover, on `threads` threads.
  void draw(const Projection& projection, std::span<const glm::mat4> poses, const Box& part_mm,
            std::span<const float> depths, int threads, Picture* picture) const;

 private:
  struct Body {
    std::shared_ptr<const TriangleMesh> mesh;  ///< corners as `normals` has them
    std::vector<glm::vec3> normals;
    MeshRays rays;
    Box box_mm;
    glm::vec4 rgba{1.0f};
  };
  /// One that is drawn.
  struct Placed {
    const Body* body = nullptr;
    glm::dmat4 body_from_world{1.0};
    glm::mat3 view_from_body{1.0f};
    glm::vec4 rgba{1.0f};
  };
  std::vector<Placed> placed(const Projection& projection, std::span<const glm::mat4> poses,
                             const Box& part_mm) const;

  std::vector<Body> bodies_;
};

}  // namespace kerf
