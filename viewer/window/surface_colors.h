// viewer/window/surface_colors.h - what the workpiece's colours come from. For the sources of
// viewer/ only.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/move_paint.h"
#include "viewer/window/scene_programs.h"
#include "viewer/window/units.h"

namespace kerf {

/// Which per-vertex values a colouring needs. kNone: what every patch has.
enum class VertexData { kNone, kCutBy, kDeviation };

/// How heights and deviations become colours.
struct ColorScale {
  double lowest_mm = 0.0;
  double highest_mm = 0.0;
  double tolerance_mm = 0.05;
  bool operator==(const ColorScale&) const = default;
};

/// Colours of moves lie in a texture, as many to a row as any OpenGL 3.3 allows: buffer textures
/// hold no more than 65536 on some.
class SurfaceColors {
 public:
  /// Without other colours: what was cut, or where nobody knows; and what is left of the blank.
  static constexpr glm::vec3 kCut{0.72f, 0.74f, 0.77f};
  static constexpr glm::vec3 kNotCut{0.60f, 0.61f, 0.62f};

  /// Takes the colours to the card at once, 4 bytes a move; moves that do not fit in the largest
  /// texture get the colour `other`.
  void set(std::shared_ptr<const CutColors> colors);

  /// `wanted`, or kPlain if that goes by moves and there are no colours for it.
  ColorBy available(ColorBy wanted) const;
  static VertexData needs(ColorBy mode);
  /// What programs for an available mode go by.
  static ScenePrograms::Paint paint(ColorBy mode);
  /// Sets what the program of paint(mode), in use now, takes its colours from.
  void bind(const GlProgram& program, ColorBy mode, const ColorScale& scale) const;
  /// Of an available mode; from low to high for scales. Empty for kPlain.
  std::vector<ColorLegendEntry> legend(ColorBy mode, const ColorScale& scale,
                                       const Measures& measures) const;

  /// They are for the path as well, and go by this mode.
  bool has_path(ColorBy mode) const {
    return is_by_move(mode) && colors_ && colors_->mode == mode && colors_->is_of_path;
  }
  /// Where has_path(); until the next set().
  MovePaint path_paint() const;

  std::size_t gpu_bytes() const { return gpu_bytes_; }

 private:
  std::shared_ptr<const CutColors> colors_;
  GlTexture texture_;
  int move_count_ = 0;  // in the texture
  std::size_t gpu_bytes_ = 0;
};

}  // namespace kerf
