// viewer/part_renderer.h - draws a part with OpenGL 3.3.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/mesh_patch.h"
#include "viewer/camera.h"
#include "viewer/gl_objects.h"
#include "viewer/section.h"

namespace kerf {

/// Triangles as the card takes them, three indices each; counter-clockwise seen from outside.
struct SurfacePiece {
  std::span<const MeshVertex> vertices;
  std::span<const std::uint32_t> indices;
};

/// A closed surface, one piece after the other.
struct PartSurface {
  Box bounds_mm;  ///< in which it lies; empty: there is none
  /// Calls its argument with each piece, which need not outlive the call.
  std::function<void(const std::function<void(const SurfacePiece&)>& draw)> each_piece;
};

/// For the sources of viewer/ only. Passes:
///   1 normals and depth of the surface, at twice the size of the picture; cut open, the faces of
///     the section after it
///   2 resolve: the mean of 2 x 2 samples
///   3 background
///   4 ambient occlusion from the depth, at half the size
///   5 sharp edges and silhouettes
///   6 light, over the background
/// Passes 2 to 6 cost the same whatever the surface. Why not multisampling: with Mesa's software
/// renderer and triangles of about a pixel it takes 1.6 times as long as the same number of plain
/// samples, and hardware without it is served too.
class PartRenderer {
 public:
  /// Error: the GL compiler's log, or a picture size that this OpenGL cannot do. `section`: the
  /// part is cut open; each piece is drawn once for each of its planes.
  static Result<PartRenderer> create(glm::ivec2 picture_px,
                                     const std::optional<Section>& section = std::nullopt);

  /// Fills framebuffer `target` (of picture size, colour only) with background and part.
  void draw(const PartSurface& part, const Camera& camera, GLuint target) const;

  /// Window depth of the part last drawn, 1 where there is none.
  const GlTexture& depths() const { return depths_; }

 private:
  struct Programs {
    GlProgram part;
    GlProgram resolve;
    GlProgram background;
    GlProgram occlusion;
    GlProgram edges;
    GlProgram composite;
    GlProgram face;
  };

  PartRenderer(Programs programs, const std::optional<Section>& section);
  Done allocate(glm::ivec2 picture_px);
  void draw_pieces(const PartSurface& part, const Camera& camera, const glm::vec4& kept) const;
  void draw_cut_open(const PartSurface& part, const Camera& camera) const;
  void draw_face(std::size_t which, const Camera& camera) const;
  std::vector<glm::dvec4> faces_in_view(const Camera& camera) const;
  void draw_surface(const PartSurface& part, const Camera& camera) const;
  void draw_resolved() const;
  void draw_occlusion(const Camera& camera) const;
  void draw_edges(const Camera& camera) const;
  void draw_background() const;
  void set_faces(const Camera& camera) const;
  void draw_composite(const Camera& camera) const;

  Programs programs_;
  GlVertexArray no_vertices_;  // Core profile wants one bound even for gl_VertexID alone.

  std::vector<glm::dvec4> kept_;  ///< of the section's planes, as kept_side() has them

  glm::ivec2 picture_px_{0};
  GlFramebuffer sampled_;
  GlTexture sampled_normals_;  // twice the size; rgb: half of 1 + the normal in view
                               // space, a: 1 on the part
  GlTexture sampled_depths_;
  GlFramebuffer resolved_;
  GlTexture normals_;  // rgb: mean normal in view space, a: coverage
  GlTexture depths_;
  GlFramebuffer occlusion_;
  GlTexture occluded_;
  GlFramebuffer edges_;
  GlTexture edge_strengths_;
};

}  // namespace kerf
