// viewer/raycast/scene_lines.h - toolpath, outline of the blank, frames and marks of findings over
// a picture, on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "viewer/orbit_camera.h"
#include "viewer/picture.h"
#include "viewer/scene.h"

namespace kerf {

/// How far lines come towards the eye, as towards_eye() (viewer/window/screen_rect.h) gives it for
/// a projection: those that lie in a surface are seen on it.
struct LineNearness {
  static constexpr double kPath_px = 2.5;
  static constexpr double kMarkers_px = 3.0;
  float path = 0.0f;
  float markers = 0.0f;
};

/// The lines and marks that the scene renderer of the window draws into the kept scene, with the
/// same colours, Projection::line_px wide and antialiased by coverage, for pictures that are made
/// without it. Knows no OpenGL.
class SceneLines {
 public:
  /// Outline of the blank, frames.
  void set_setup(const SceneSetup& setup);
  /// Round marks, seen through everything. Those without a place have none.
  void set_findings(std::span<const SceneFinding> findings);
  /// Of traverses, feeds and planned segments; all are unless this says otherwise.
  void show_path(const std::array<bool, 3>& is_shown) { is_shown_ = is_shown; }
  /// The next chunk of the path.
  void add(std::shared_ptr<const PathChunk> chunk) { path_.push_back(std::move(chunk)); }

  /// Over a picture with its window depths, rows from the top: what lies before a line hides it,
  /// and lines hide what is drawn later. Segments of the path that are shorter than a pixel are
  /// drawn several as one. About 50 ns a vertex and 10 ns a pixel of a line.
  void draw(const Projection& projection, const LineNearness& nearness, std::uint64_t past_vertices,
            Picture* picture, std::vector<float>* depths) const;

 private:
  struct Line {
    glm::vec3 from_mm{0.0f};
    glm::vec3 to_mm{0.0f};
    glm::vec4 rgba{1.0f};
  };
  std::array<bool, 3> is_shown_{true, true, true};
  struct Mark {
    glm::vec3 at_mm{0.0f};
    glm::vec4 rgba{1.0f};
  };
  std::vector<Line> markers_;
  std::vector<Mark> marks_;
  std::vector<std::shared_ptr<const PathChunk>> path_;
};

}  // namespace kerf
