// viewer/window/layer.h - a picture with depth, drawn and copied by rectangles. For the sources of
// viewer/ only.
#pragma once

#include "viewer/render_target.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// See RenderTarget.
class Layer : public RenderTarget {
 public:
  /// Gives the memory back.
  void release();
  bool is_allocated() const { return size_px().x > 0; }

  /// What is drawn from now on goes into this rectangle of the layer.
  void bind(const ScreenRect& rect) const;
  /// Makes the rectangle that of `from`, depth included. Both have the same size. Ends bind().
  void copy(const Layer& from, const ScreenRect& rect);
};

}  // namespace kerf
