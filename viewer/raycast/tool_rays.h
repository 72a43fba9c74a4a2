// viewer/raycast/tool_rays.h - where rays meet a tool.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "viewer/raycast/ray_frame.h"
#include "viewer/scene.h"

namespace kerf {

enum class ToolPart { kCutter, kShank, kHolder };

struct ToolHit {
  double t = 0.0;
  ToolPart part = ToolPart::kCutter;
  glm::vec3 normal{0, 0, 1};  ///< unit length, outward
};

/// The outlines of a tool turned around its axis: exactly round, where the mesh has a prism.
/// Each segment of an outline is a cone, a cylinder or a ring and is met in closed form; open ends
/// are closed with a disc. Normals are smooth where the outline bends by less than 20 degrees.
class ToolRays {
 public:
  ToolRays(const ToolShape& shape, const ToolPose& pose);

  /// Around the pieces of the tool; together they leave out more than one box around it all.
  const std::vector<Box>& boxes_mm() const { return boxes_mm_; }
  /// The first point at t < before_t. O(segments) if the ray comes near the tool.
  std::optional<ToolHit> trace(const Ray& ray, double before_t) const;

 private:
  struct Segment {
    double r0, z0, r1, z1;       ///< from below to above, or across
    glm::vec2 normal0, normal1;  ///< (radius, height) at the two ends
    ToolPart part;
  };
  void add(std::span<const ProfilePoint> outline, ToolPart part);

  std::vector<Segment> segments_;
  double radius_mm_ = 0.0;  ///< greatest
  Vec3 tip_mm_, x_{1, 0, 0}, y_{0, 1, 0}, z_{0, 0, 1};
  std::vector<Box> boxes_mm_;
};

}  // namespace kerf
