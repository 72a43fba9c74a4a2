// viewer/csg/layer_composer.h - one picture of what is left of the layers. For the sources of
// viewer/ only.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <utility>

#include "base/result.h"
#include "viewer/csg/csg_schedule.h"
#include "viewer/csg/depth_layer.h"
#include "viewer/gl_objects.h"

namespace kerf {

/// Lays the layers of a blank over a background, the nearest point that is left counts. Points
/// outside of the blank are none: all of it is removed there. Costs some 20 ns a pixel on a
/// software renderer, and as much again and more for every layer but the first.
class LayerComposer {
 public:
  /// Error: the GL compiler's log.
  static Result<LayerComposer> create();

  /// Within the rectangle; no layers: the background alone. `draw_blank` draws all faces of the
  /// blank, lit anyhow. Changes the stencil of the layers. Depth test and depth clamp are on,
  /// before and after. Error: no picture of this size can be drawn; of another size than before the
  /// rectangle has to be all of it.
  Done compose(std::span<const DepthLayer* const> layers, glm::ivec2 size_px, const PixelRect& rect,
               const std::function<void()>& draw_blank);
  /// The picture composed so far.
  const DepthLayer& shown() const { return shown_; }

 private:
  struct Programs {
    GlProgram background;
    GlProgram inside;
    GlProgram layer;
  };
  explicit LayerComposer(Programs programs) : programs_(std::move(programs)) {}

  static void count_inside(const DepthLayer& layer, const std::function<void()>& draw_blank);
  void keep_inside_as_alpha() const;
  void copy(const DepthLayer& layer, const PixelRect& rect) const;
  void fill_background() const;
  void lay_over(const DepthLayer& layer) const;

  Programs programs_;
  GlVertexArray no_vertices_;
  DepthLayer shown_;
};

}  // namespace kerf
