#include "viewer/part_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "base/translate.h"
#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

/// Samples along one edge of a pixel; resolve.frag counts on it.
constexpr int kSamples = 2;
/// Reach of ambient occlusion as a share of the distance to the part, hence about of its size in
/// the picture.
constexpr float kOcclusionReach = 0.05f;
/// The edge detector reaches one pixel in a picture of this height.
constexpr float kReferenceHeight_px = 1200.0f;
/// So far around a pixel it is counted how many edges there are, in a picture of that height.
constexpr float kDensityReach_px = 24.0f;
/// Of the largest picture: levels of the mipmap by which it is counted.
constexpr int kDensityLevels = 8;
/// Darkness of edges in a picture of that height and above; smaller pictures have finer features
/// and get paler lines.
constexpr float kEdgeStrength = 0.70f;
constexpr float kSmallestEdgeStrength = 0.45f;
/// A software renderer keeps the triangles that it was given until it draws them, some 200 bytes
/// each; of more than these it waits for them.
constexpr std::size_t kMostWaiting = 60'000;
/// From line to line of a section's faces, in a picture of the reference height; and at least.
constexpr float kHatch_px = 14, kLeastHatch_px = 7;
/// Around the part, for the antialiased border and the edge detector.
constexpr int kBorder_px = 4;

bool complete() { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }

void attach(GLenum attachment, const GlTexture& texture) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.name(), 0);
}

/// Part of the picture that the surface may cover, as x, y from the lower left, width, height.
/// Software renderers shade every pixel they are given, so the passes are confined to it.
glm::ivec4 covered_px(const Box& box, const Camera& camera, glm::ivec2 picture_px) {
  if (box.empty()) return glm::ivec4(0);
  glm::vec2 low(1e9f);
  glm::vec2 high(-1e9f);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::vec2 p(camera.project({(corner & 1u) ? box.max.x : box.min.x,
                                      (corner & 2u) ? box.max.y : box.min.y,
                                      (corner & 4u) ? box.max.z : box.min.z}));
    low = glm::vec2(std::min(low.x, p.x), std::min(low.y, p.y));
    high = glm::vec2(std::max(high.x, p.x), std::max(high.y, p.y));
  }
  const auto inside = [](float v, int offset, int limit) {
    return std::clamp(static_cast<int>(std::floor(v)) + offset, 0, limit);
  };
  const int x0 = inside(low.x, -kBorder_px, picture_px.x);
  const int x1 = inside(high.x, kBorder_px, picture_px.x);
  const int y0 = inside(low.y, -kBorder_px, picture_px.y);
  const int y1 = inside(high.y, kBorder_px, picture_px.y);
  return {x0, picture_px.y - y1, x1 - x0, y1 - y0};
}

void set_scissor(const glm::ivec4& rectangle) {
  glScissor(rectangle.x, rectangle.y, rectangle.z, rectangle.w);
}

}  // namespace

PartRenderer::PartRenderer(Programs programs, const std::optional<Section>& section)
    : programs_(std::move(programs)) {
  if (!section) return;
  for (const SectionPlane& plane : {section->plane, section->beside.value_or(section->plane)}) {
    const std::optional<glm::dvec4> kept = kept_side(plane);
    if (kept && (kept_.empty() || kept_.back() != *kept)) kept_.push_back(*kept);
  }
}

Result<PartRenderer> PartRenderer::create(glm::ivec2 picture_px,
                                          const std::optional<Section>& section) {
  Result<GlProgram> part = GlProgram::create(shaders::part_vert, shaders::part_frag);
  Result<GlProgram> resolve = GlProgram::create(shaders::screen_vert, shaders::resolve_frag);
  Result<GlProgram> background = GlProgram::create(shaders::screen_vert, shaders::background_frag);
  Result<GlProgram> occlusion = GlProgram::create(shaders::screen_vert, shaders::occlusion_frag);
  Result<GlProgram> edges = GlProgram::create(shaders::screen_vert, shaders::edges_frag);
  Result<GlProgram> composite = GlProgram::create(shaders::screen_vert, shaders::composite_frag);
  Result<GlProgram> face = GlProgram::create(shaders::screen_vert, shaders::part_face_frag);
  for (const auto* program :
       {&part, &resolve, &background, &occlusion, &edges, &composite, &face}) {
    if (!*program) return Error{program->error()};
  }
  PartRenderer renderer(
      Programs{std::move(*part), std::move(*resolve), std::move(*background), std::move(*occlusion),
               std::move(*edges), std::move(*composite), std::move(*face)},
      section);
  if (Done done = renderer.allocate(picture_px); !done) return Error{done.error()};
  return renderer;
}

Done PartRenderer::allocate(glm::ivec2 picture_px) {
  picture_px_ = picture_px;
  const glm::ivec2 sampled_px = kSamples * picture_px;
  GLint largest_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest_px);
  if (std::max(sampled_px.x, sampled_px.y) > largest_px) {
    return Error{
        trf("a picture of {} x {} pixels is too large for this OpenGL; each side may be {}",
            picture_px.x, picture_px.y, largest_px / kSamples)};
  }
  allocate_texture(sampled_normals_, GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV,
                   sampled_px, GL_NEAREST);
  const bool needs_stencil = !kept_.empty();
  if (needs_stencil) {
    allocate_texture(sampled_depths_, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                     sampled_px, GL_NEAREST);
  } else {
    allocate_texture(sampled_depths_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
                     sampled_px, GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, sampled_.name());
  attach(GL_COLOR_ATTACHMENT0, sampled_normals_);
  attach(needs_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, sampled_depths_);
  bool all_complete = complete();

  allocate_texture(normals_, GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, picture_px, GL_NEAREST);
  allocate_texture(depths_, GL_R32F, GL_RED, GL_FLOAT, picture_px, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  attach(GL_COLOR_ATTACHMENT0, normals_);
  attach(GL_COLOR_ATTACHMENT1, depths_);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, both);
  all_complete = complete() && all_complete;

  allocate_texture(occluded_, GL_R8, GL_RED, GL_UNSIGNED_BYTE, (picture_px + 1) / 2, GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, occlusion_.name());
  attach(GL_COLOR_ATTACHMENT0, occluded_);
  all_complete = complete() && all_complete;

  allocate_texture(edge_strengths_, GL_R8, GL_RED, GL_UNSIGNED_BYTE, picture_px, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kDensityLevels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glGenerateMipmap(GL_TEXTURE_2D);
  glBindFramebuffer(GL_FRAMEBUFFER, edges_.name());
  attach(GL_COLOR_ATTACHMENT0, edge_strengths_);
  all_complete = complete() && all_complete;
  if (!all_complete || glGetError() != GL_NO_ERROR) {
    return Error{trf("this OpenGL ({}) cannot make the buffers for a picture of {} x {} pixels",
                     reinterpret_cast<const char*>(glGetString(GL_RENDERER)), picture_px.x,
                     picture_px.y)};
  }
  return std::monostate{};
}

void PartRenderer::draw(const PartSurface& part, const Camera& camera, GLuint target) const {
  const glm::ivec4 covered = covered_px(part.bounds_mm, camera, picture_px_);
  glEnable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  set_scissor(kSamples * covered);
  draw_surface(part, camera);

  glBindVertexArray(no_vertices_.name());
  glViewport(0, 0, picture_px_.x, picture_px_.y);
  set_scissor(covered);
  draw_resolved();
  draw_edges(camera);

  glBindFramebuffer(GL_FRAMEBUFFER, occlusion_.name());
  glViewport(0, 0, (picture_px_.x + 1) / 2, (picture_px_.y + 1) / 2);
  set_scissor({covered.x / 2, covered.y / 2, covered.z / 2 + 1, covered.w / 2 + 1});
  draw_occlusion(camera);

  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glViewport(0, 0, picture_px_.x, picture_px_.y);
  glDisable(GL_SCISSOR_TEST);
  draw_background();
  glEnable(GL_SCISSOR_TEST);
  set_scissor(covered);
  draw_composite(camera);
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
}

void PartRenderer::draw_surface(const PartSurface& part, const Camera& camera) const {
  glBindFramebuffer(GL_FRAMEBUFFER, sampled_.name());
  glViewport(0, 0, kSamples * picture_px_.x, kSamples * picture_px_.y);
  glClearColor(0, 0, 0, 0);
  glClearDepth(1.0);
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  if (!part.bounds_mm.empty() && !kept_.empty()) {
    draw_cut_open(part, camera);
  } else if (!part.bounds_mm.empty()) {
    glEnable(GL_CULL_FACE);  // The surface is closed; half the work.
    draw_pieces(part, camera, glm::vec4(0));
    glDisable(GL_CULL_FACE);
  }
  glDisable(GL_DEPTH_TEST);
}

/// A ray is in material where it meets a plane if it meets an odd number of surfaces behind it. All
/// of them are counted, hidden or not: which of two is the nearer one cannot be told where the
/// surface folds.
void PartRenderer::draw_cut_open(const PartSurface& part, const Camera& camera) const {
  glClearStencil(0);
  glClear(GL_STENCIL_BUFFER_BIT);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 0, 0xff);
  glStencilOp(GL_KEEP, GL_INVERT, GL_INVERT);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    glStencilMask(1u << i);
    draw_pieces(part, camera, glm::vec4(kept_[i]));
  }
  glDisable(GL_CLIP_DISTANCE0);
  glStencilMask(0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    glStencilFunc(GL_EQUAL, static_cast<GLint>(1u << i), 1u << i);
    draw_face(i, camera);
  }
  glDisable(GL_STENCIL_TEST);
}

/// Of a plane, if it faces the eye, which is at the origin.
void PartRenderer::draw_face(std::size_t which, const Camera& camera) const {
  const glm::dmat4 world_from_view = glm::inverse(glm::dmat4(camera.view_from_world()));
  const glm::dmat4 view_from_clip = glm::inverse(glm::dmat4(camera.clip_from_view()));
  const auto in_view = [&](const glm::dvec4& kept) {
    return glm::transpose(world_from_view) * kept;
  };
  const auto in_clip = [&](const glm::dvec4& plane) {
    return glm::transpose(view_from_clip) * plane;
  };
  const glm::dvec4 face = -in_view(kept_[which]);
  if (!(face.w > 0)) return;
  const glm::dvec4 plane = in_clip(face);
  const glm::dvec2 half_px = 0.5 * kSamples * glm::dvec2(picture_px_);
  glm::dvec3 beside(0.0);
  if (kept_.size() > 1) beside = kept_beside(plane, in_clip(in_view(kept_[1 - which])));
  glBindVertexArray(no_vertices_.name());
  programs_.face.use();
  programs_.face.set("middle_px", glm::vec2(half_px));
  programs_.face.set("normal_view", glm::vec3(face));
  // On the plane the window depth is affine in the picture.
  programs_.face.set("depth_plane", glm::vec3(-0.5 * plane.x / (plane.z * half_px.x),
                                              -0.5 * plane.y / (plane.z * half_px.y),
                                              0.5 - 0.5 * plane.w / plane.z));
  programs_.face.set("kept_beside",
                     glm::vec3(beside.x / half_px.x, beside.y / half_px.y, beside.z));
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Those that face the eye, which is at the origin: normals towards it.
std::vector<glm::dvec4> PartRenderer::faces_in_view(const Camera& camera) const {
  std::vector<glm::dvec4> faces;
  const glm::dmat4 world_from_view = glm::inverse(glm::dmat4(camera.view_from_world()));
  for (const glm::dvec4& kept : kept_) {
    const glm::dvec4 face = -(glm::transpose(world_from_view) * kept);
    if (face.w > 0) faces.push_back(face);
  }
  return faces;
}

void PartRenderer::draw_pieces(const PartSurface& part, const Camera& camera,
                               const glm::vec4& kept) const {
  GlVertexArray array;
  GlBuffer vertices;
  GlBuffer indices;
  glBindVertexArray(array.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, sizeof(MeshVertex),
                        reinterpret_cast<const void*>(offsetof(MeshVertex, normal)));
  programs_.part.use();
  programs_.part.set("clip_from_world", camera.clip_from_world());
  programs_.part.set("view_from_world", camera.view_from_world());
  programs_.part.set("section", kept);
  std::size_t waiting = 0;  // triangles that may not have been drawn yet
  part.each_piece([&waiting](const SurfacePiece& piece) {
    if (piece.indices.empty()) return;
    if (waiting > kMostWaiting) {
      glFinish();
      waiting = 0;
    }
    waiting += piece.indices.size() / 3;
    // Fresh memory for each: what is drawn of the last one need not be waited for.
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(piece.vertices.size_bytes()),
                 piece.vertices.data(), GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(piece.indices.size_bytes()),
                 piece.indices.data(), GL_STREAM_DRAW);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.indices.size()), GL_UNSIGNED_INT,
                   nullptr);
  });
}

void PartRenderer::draw_resolved() const {
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  glDisable(GL_SCISSOR_TEST);
  const float no_part[] = {0, 0, 0, 0};
  const float far_depth[] = {1, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, no_part);
  glClearBufferfv(GL_COLOR, 1, far_depth);
  glEnable(GL_SCISSOR_TEST);
  bind_texture(0, sampled_normals_);
  bind_texture(1, sampled_depths_);
  programs_.resolve.use();
  programs_.resolve.set("normals", 0);
  programs_.resolve.set("depths", 1);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PartRenderer::draw_edges(const Camera& camera) const {
  const float reach_px = std::round(static_cast<float>(picture_px_.y) / kReferenceHeight_px);
  glBindFramebuffer(GL_FRAMEBUFFER, edges_.name());
  bind_texture(0, normals_);
  bind_texture(1, depths_);
  programs_.edges.use();
  programs_.edges.set("normals", 0);
  programs_.edges.set("depths", 1);
  programs_.edges.set("unproject", camera.unproject());
  programs_.edges.set("px_mm_at_1mm", camera.px_mm_at_1mm());
  programs_.edges.set("reach_px", std::max(1.0f, reach_px));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  bind_texture(0, edge_strengths_);
  glGenerateMipmap(GL_TEXTURE_2D);  // how dense they are: composite.frag
}

void PartRenderer::draw_occlusion(const Camera& camera) const {
  const float radius_mm = kOcclusionReach * camera.distance_mm();
  bind_texture(0, normals_);
  bind_texture(1, depths_);
  programs_.occlusion.use();
  programs_.occlusion.set("normals", 0);
  programs_.occlusion.set("depths", 1);
  programs_.occlusion.set("unproject", camera.unproject());
  programs_.occlusion.set("radius_mm", radius_mm);
  programs_.occlusion.set("radius_px_at_1mm", radius_mm / camera.px_mm_at_1mm());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PartRenderer::draw_background() const {
  programs_.background.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PartRenderer::set_faces(const Camera& camera) const {
  const std::vector<glm::dvec4> faces = faces_in_view(camera);
  bind_texture(3, depths_);
  programs_.composite.set("depths", 3);
  programs_.composite.set("face_count", static_cast<int>(faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i)
    programs_.composite.set(i == 0 ? "faces[0]" : "faces[1]", glm::vec4(faces[i]));
  programs_.composite.set("px_mm_at_1mm", camera.px_mm_at_1mm());
  const float height = static_cast<float>(picture_px_.y) / kReferenceHeight_px;
  programs_.composite.set("hatch_px", std::max(kLeastHatch_px, kHatch_px * height));
}

void PartRenderer::draw_composite(const Camera& camera) const {
  bind_texture(0, normals_);
  bind_texture(1, occluded_);
  bind_texture(2, edge_strengths_);
  programs_.composite.use();
  programs_.composite.set("normals", 0);
  programs_.composite.set("occlusion", 1);
  programs_.composite.set("edges", 2);
  set_faces(camera);
  programs_.composite.set("unproject", camera.unproject());
  programs_.composite.set("up_view", camera.up_view());
  const float relative_height = static_cast<float>(picture_px_.y) / kReferenceHeight_px;
  programs_.composite.set("dense_level",
                          std::max(0.0f, std::log2(kDensityReach_px * relative_height)));
  programs_.composite.set("edge_strength", std::clamp(kEdgeStrength * relative_height,
                                                      kSmallestEdgeStrength, kEdgeStrength));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

}  // namespace kerf
