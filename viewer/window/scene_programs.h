// viewer/window/scene_programs.h - the shader programs of the scene. For the sources of viewer/
// only.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "viewer/gl_objects.h"

namespace kerf {

/// Compiled when they are asked for first: each takes a megabyte of a processor that draws, and
/// most pictures need three.
class ScenePrograms {
 public:
  /// Error: the GL compiler's log.
  static Result<ScenePrograms> create();

  /// The log of the first one that could not be compiled since then; a stand-in is in its place.
  /// Mostly empty.
  const std::string& trouble() const { return trouble_; }

  /// Where the workpiece's colours come from.
  enum class Paint { kOne, kCutOrNot, kMove, kMeasure };
  /// Of what is closed and drawn without backs, or, with a section, cut open.
  const GlProgram& workpiece(Paint paint, bool has_section) const {
    return program(kWorkpiece + 2 * static_cast<unsigned>(paint) + (has_section ? 1u : 0u));
  }
  /// Tool and machine, in one colour.
  const GlProgram& moving() const { return program(kMoving); }
  /// The same beside a transparent workpiece: what lies behind its surface, or before it.
  const GlProgram& moving_beside_glass() const { return program(kBesideGlass); }
  const GlProgram& background() const { return program(kBackground); }
  const GlProgram& section_face() const { return program(kSectionFace); }
  const GlProgram& glass() const { return program(kGlass); }

 private:
  enum Name : unsigned {
    kWorkpiece,
    kMoving = 8,
    kBesideGlass,
    kBackground,
    kSectionFace,
    kGlass,
    kCount
  };

  ScenePrograms() = default;
  static Result<GlProgram> compiled(unsigned name);
  const GlProgram& program(unsigned name) const;

  mutable std::array<std::optional<GlProgram>, kCount> programs_;
  mutable std::string trouble_;
};

}  // namespace kerf
