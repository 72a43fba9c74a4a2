#include "viewer/window/marker_store.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "viewer/shaders/shaders.h"
#include "viewer/window/screen_rect.h"

namespace kerf {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

struct MarkerVertex {
  glm::vec3 position_mm;
  Rgba rgba;
};

constexpr Rgba kBlankColor{70, 96, 150, 190};
constexpr std::array<Rgba, 3> kAxisColors{Rgba{214, 48, 42, 255}, Rgba{44, 148, 56, 255},
                                          Rgba{40, 84, 214, 255}};
constexpr Rgba kErrorColor{222, 32, 32, 255};
constexpr Rgba kWarningColor{245, 158, 24, 255};
constexpr Rgba kNoteColor{60, 130, 220, 255};
constexpr float kMarker_px = 11.0f;
/// As those of the path (path_store.cpp), and a little more: markers win over the path.
constexpr double kNearer_px = 3.0;
/// Frames win over the outline of the blank, along which they often lie.
constexpr double kFramesNearer_px = 4.0;
/// Length of the arrows of a frame that names none, as a share of the largest side of the blank.
constexpr double kFrameShare = 0.22;
constexpr double kFrameWithoutBlank_mm = 20.0;
/// Barbs of an arrow, as a share of its length.
constexpr float kBarb = 0.12f;

const Rgba& color_of(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return kErrorColor;
    case Severity::kWarning:
      return kWarningColor;
    case Severity::kNote:
      break;
  }
  return kNoteColor;
}

void add_line(std::vector<MarkerVertex>* vertices, const glm::vec3& from, const glm::vec3& to,
              const Rgba& rgba) {
  vertices->push_back({from, rgba});
  vertices->push_back({to, rgba});
}

void add_frame(const SceneFrame& frame, double length_mm, std::vector<MarkerVertex>* vertices) {
  const std::array<glm::vec3, 3> axes{glm::vec3(frame.x_axis), glm::vec3(frame.y_axis),
                                      glm::vec3(glm::cross(frame.x_axis, frame.y_axis))};
  const glm::vec3 origin(frame.origin_mm);
  const auto length = static_cast<float>(length_mm);
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 tip = origin + length * axes[k];
    add_line(vertices, origin, tip, kAxisColors[k]);
    for (const std::size_t side : {(k + 1) % 3, (k + 2) % 3}) {
      for (const float sign : {-0.4f, 0.4f}) {
        const glm::vec3 barb = tip + kBarb * length * (sign * axes[side] - axes[k]);
        add_line(vertices, tip, barb, kAxisColors[k]);
      }
    }
  }
}

GLsizei load(GLuint array, GLuint buffer, const std::vector<MarkerVertex>& vertices) {
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(MarkerVertex)),
               vertices.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(MarkerVertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(MarkerVertex),
                        reinterpret_cast<const void*>(offsetof(MarkerVertex, rgba)));
  return static_cast<GLsizei>(vertices.size());
}

}  // namespace

Result<MarkerStore> MarkerStore::create() {
  Result<GlProgram> program = GlProgram::create(shaders::marker_vert, shaders::marker_frag);
  if (!program) return Error{program.error()};
  return MarkerStore(std::move(*program));
}

void MarkerStore::set_setup(const SceneSetup& setup) {
  std::vector<MarkerVertex> vertices;
  for (const LineSegment& line : setup.blank_outline) {
    add_line(&vertices, line.from_mm, line.to_mm, kBlankColor);
  }
  blank_.count = load(blank_.array.name(), blank_.vertices.name(), vertices);
  vertices.clear();
  const Vec3 size = setup.bounds_mm.size();
  const double usual_mm = setup.bounds_mm.empty()
                              ? kFrameWithoutBlank_mm
                              : kFrameShare * std::max({size.x, size.y, size.z});
  for (const SceneFrame& frame : setup.frames) {
    add_frame(frame, frame.length_mm > 0.0 ? frame.length_mm : usual_mm, &vertices);
  }
  frames_.count = load(frames_.array.name(), frames_.vertices.name(), vertices);
}

void MarkerStore::set_findings(std::span<const SceneFinding> findings) {
  std::vector<MarkerVertex> vertices;
  for (const SceneFinding& finding : findings) {
    if (finding.position_mm) {
      vertices.push_back({glm::vec3(*finding.position_mm), color_of(finding.severity)});
    }
  }
  findings_.count = load(findings_.array.name(), findings_.vertices.name(), vertices);
}

void MarkerStore::draw(const Projection& projection, const Opacities& opacities,
                       bool may_smooth) const {
  draw_lines(blank_, projection, kNearer_px, opacities.blank, may_smooth);
  draw_lines(frames_, projection, kFramesNearer_px, opacities.frames, may_smooth);
  program_.use();
  program_.set("clip_from_world", projection.clip_from_world);
  program_.set("towards_eye", towards_eye(projection, kFramesNearer_px));
  program_.set("size_px", kMarker_px * projection.line_px);
  glEnable(GL_PROGRAM_POINT_SIZE);
  // Seen through the workpiece: what was found mostly lies on it or in it.
  glDisable(GL_DEPTH_TEST);
  draw_batch(findings_, GL_POINTS, opacities.findings);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_PROGRAM_POINT_SIZE);
}

void MarkerStore::draw_lines(const Batch& batch, const Projection& projection, double nearer_px,
                             float opacity, bool may_smooth) const {
  if (batch.count == 0 || opacity <= 0.0f) return;
  const float nearer = towards_eye(projection, nearer_px);
  if (WideLines::are_needed(projection)) {
    wide_.use(projection, nearer);
    wide_.set_own_colors(opacity);
    wide_.set_smooth(may_smooth);
    glBindVertexArray(batch.array.name());
    wide_.bind(batch.texture, batch.vertices);
    wide_.draw_pairs(batch.count);
    return;
  }
  program_.use();
  program_.set("clip_from_world", projection.clip_from_world);
  program_.set("towards_eye", nearer);
  if (may_smooth) glEnable(GL_LINE_SMOOTH);
  draw_batch(batch, GL_LINES, opacity);
  glDisable(GL_LINE_SMOOTH);
}

void MarkerStore::draw_batch(const Batch& batch, GLenum shape, float opacity) const {
  if (batch.count == 0 || opacity <= 0.0f) return;
  program_.set("opacity", opacity);
  program_.set("is_round", shape == GL_POINTS ? 1 : 0);
  glBindVertexArray(batch.array.name());
  glDrawArrays(shape, 0, batch.count);
}

}  // namespace kerf
