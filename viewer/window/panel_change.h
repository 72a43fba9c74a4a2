// viewer/window/panel_change.h - which pixels of the panels changed. For the sources of viewer/
// only: includes the header of Dear ImGui.
#pragma once

#include <imgui.h>

#include <glm/vec2.hpp>
#include <vector>

#include "viewer/window/screen_rect.h"

namespace kerf {

/// Compares what Dear ImGui wants to have drawn with what it wanted last. A software renderer
/// spends most of a frame on panels otherwise, of which a few figures have changed.
class PanelChange {
 public:
  /// Forgets what was drawn last: everything counts as changed then.
  void forget() { lists_.clear(); }

  /// Adds the rectangles in which `data` draws other triangles than that of the last call did.
  /// `window_px` is the size of the framebuffer. O(triangles).
  void find(const ImDrawData& data, glm::ivec2 window_px, std::vector<ScreenRect>* changed);

 private:
  /// A triangle as it is drawn; what is equal here looks equal.
  struct Triangle {
    ImDrawVert corners[3];
    ImVec4 clip;
    ImTextureID texture;
    bool operator==(const Triangle& other) const;
    ScreenRect rect(glm::ivec2 window_px) const;
  };
  using Triangles = std::vector<Triangle>;

  static Triangles triangles_of(const ImDrawList& list);

  std::vector<Triangles> lists_;
};

/// Draws `data`, changing nothing outside of the rectangles, which must not overlap, and within
/// them the same pixels as if it were drawn as a whole. Into the framebuffer that is bound, which
/// has `window_px` pixels.
void draw_panels_in(const std::vector<ScreenRect>& rects, glm::ivec2 window_px, ImDrawData* data);

}  // namespace kerf
