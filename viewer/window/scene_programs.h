// viewer/window/scene_programs.h - the shader programs of the scene. For the sources of viewer/
// only.
#pragma once

#include <utility>
#include <vector>

#include "viewer/gl_objects.h"

namespace kerf {

class ScenePrograms {
 public:
  /// Error: the GL compiler's log.
  static Result<ScenePrograms> create();

  /// Of viewer/shaders/scene. With glass neither of the others.
  struct Variant {
    bool has_section = false;
    bool is_colored = false;
    int beside_glass = 0;  ///< -1: only what lies behind it, 1: only what lies before it
  };
  const GlProgram& scene(Variant variant) const;
  const GlProgram& background() const { return programs_[kBackground]; }
  const GlProgram& section_face() const { return programs_[kSectionFace]; }
  const GlProgram& glass() const { return programs_[kGlass]; }

 private:
  /// The variants of the scene: bit 0 for a section, bit 1 for colours.
  enum Name { kScene, kBesideGlass = 4, kBackground, kSectionFace, kGlass };

  explicit ScenePrograms(std::vector<GlProgram> programs) : programs_(std::move(programs)) {}
  std::vector<GlProgram> programs_;
};

}  // namespace kerf
