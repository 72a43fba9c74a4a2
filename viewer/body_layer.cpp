#include "viewer/body_layer.h"

#include <cstddef>

#include "base/translate.h"
#include "viewer/shaded_mesh.h"
#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

constexpr int kSamples = 2;  // along one edge of a pixel; both shaders count on it
/// The part is to be seen through what stands before it.
constexpr float kOpacity = 0.6f;

glm::vec4 rgba_of(std::uint32_t color) {
  return glm::vec4(color & 0xffu, color >> 8 & 0xffu, color >> 16 & 0xffu, color >> 24) / 255.0f;
}

}  // namespace

Result<BodyLayer> BodyLayer::create() {
  Result<GlProgram> body = GlProgram::create(shaders::scene_vert, shaders::body_frag);
  if (!body) return Error{body.error()};
  Result<GlProgram> overlay = GlProgram::create(shaders::screen_vert, shaders::overlay_frag);
  if (!overlay) return Error{overlay.error()};
  return BodyLayer(std::move(*body), std::move(*overlay));
}

Done BodyLayer::draw(std::span<const PictureBody> bodies, const Camera& camera,
                     const GlTexture& part_depths, glm::ivec2 picture_px, GLuint target) const {
  const glm::ivec2 sampled_px = kSamples * picture_px;
  GlFramebuffer framebuffer;
  GlTexture colors;
  GlRenderbuffer depths;
  allocate_texture(colors, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, sampled_px, GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colors.name(), 0);
  glBindRenderbuffer(GL_RENDERBUFFER, depths.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, sampled_px.x, sampled_px.y);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depths.name());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Error{trf("this OpenGL ({}) cannot make the buffers for a picture of {} x {} pixels",
                     reinterpret_cast<const char*>(glGetString(GL_RENDERER)), picture_px.x,
                     picture_px.y)};
  }
  glViewport(0, 0, sampled_px.x, sampled_px.y);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  draw_bodies(bodies, camera, part_depths);

  GlVertexArray no_vertices;
  glBindVertexArray(no_vertices.name());
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glViewport(0, 0, picture_px.x, picture_px.y);
  overlay_.use();
  bind_texture(0, colors);
  overlay_.set("layer", 0);
  overlay_.set("opacity", kOpacity);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  return std::monostate{};
}

void BodyLayer::draw_bodies(std::span<const PictureBody> bodies, const Camera& camera,
                            const GlTexture& part_depths) const {
  glClearColor(0, 0, 0, 0);
  glClearDepth(1.0);
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_LESS);
  body_.use();
  bind_texture(0, part_depths);
  body_.set("part_depths", 0);
  body_.set("up_view", camera.up_view());
  for (const PictureBody& body : bodies) {
    if (!body.mesh) continue;
    const ShadedMesh shaded = shade_mesh(*body.mesh, {});
    GlVertexArray array;
    GlBuffer vertices, indices;
    glBindVertexArray(array.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertices.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 4, GL_INT_2_10_10_10_REV, GL_TRUE, sizeof(MeshVertex),
                          reinterpret_cast<const void*>(offsetof(MeshVertex, normal)));
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(shaded.vertices.size() * sizeof(MeshVertex)),
                 shaded.vertices.data(), GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(shaded.indices.size() * sizeof(std::uint32_t)),
                 shaded.indices.data(), GL_STREAM_DRAW);
    body_.set("clip_from_model", camera.clip_from_world() * body.pose);
    body_.set("view_from_model", camera.view_from_world() * body.pose);
    body_.set("rgba", rgba_of(body.color));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(shaded.indices.size()), GL_UNSIGNED_INT,
                   nullptr);
  }
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace kerf
