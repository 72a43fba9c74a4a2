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

  /// Where the workpiece's colours come from.
  enum class Paint { kOne, kCutOrNot, kMove, kMeasure };
  /// Of what is closed and drawn without backs, or, with a section, cut open.
  const GlProgram& workpiece(Paint paint, bool has_section) const {
    return programs_[kWorkpiece + 2 * static_cast<unsigned>(paint) + (has_section ? 1u : 0u)];
  }
  /// Tool and machine, in one colour.
  const GlProgram& moving() const { return programs_[kMoving]; }
  /// The same beside a transparent workpiece: what lies behind its surface, or before it.
  const GlProgram& moving_beside_glass() const { return programs_[kBesideGlass]; }
  const GlProgram& background() const { return programs_[kBackground]; }
  const GlProgram& section_face() const { return programs_[kSectionFace]; }
  const GlProgram& glass() const { return programs_[kGlass]; }

 private:
  enum Name { kWorkpiece, kMoving = 8, kBesideGlass, kBackground, kSectionFace, kGlass };

  explicit ScenePrograms(std::vector<GlProgram> programs) : programs_(std::move(programs)) {}
  std::vector<GlProgram> programs_;
};

}  // namespace kerf
