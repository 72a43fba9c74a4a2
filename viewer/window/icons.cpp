#include "viewer/window/icons.h"

#include "viewer/window/theme.h"

namespace kerf {
namespace {

/// Draws in units of the button's height, from its upper left corner.
class Pen {
 public:
  Pen(ImVec2 corner, float size) : corner_(corner), size_(size) {}

  void right_triangle(float x, float width) const {
    triangle({x, 0.26f}, {x, 0.74f}, {x + width, 0.5f});
  }
  void left_triangle(float x, float width) const {
    triangle({x + width, 0.26f}, {x + width, 0.74f}, {x, 0.5f});
  }
  void bar(float x, float width) const {
    list()->AddRectFilled(at({x, 0.27f}), at({x + width, 0.73f}), color());
  }
  void square() const { list()->AddRectFilled(at({0.29f, 0.29f}), at({0.71f, 0.71f}), color()); }
  /// An end mill: shank above, flutes below.
  void tool(float x) const {
    list()->AddRectFilled(at({x, 0.22f}), at({x + 0.20f, 0.44f}), color());
    list()->AddRectFilled(at({x - 0.04f, 0.44f}), at({x + 0.24f, 0.78f}), theme::kToolMark);
  }
  /// An exclamation mark.
  void finding(float x) const {
    const ImU32 red = ImGui::GetColorU32(theme::kError);
    list()->AddRectFilled(at({x, 0.22f}), at({x + 0.12f, 0.58f}), red);
    list()->AddRectFilled(at({x, 0.66f}), at({x + 0.12f, 0.78f}), red);
  }

 private:
  static ImDrawList* list() { return ImGui::GetWindowDrawList(); }
  static ImU32 color() { return ImGui::GetColorU32(ImGuiCol_Text); }
  ImVec2 at(ImVec2 p) const { return {corner_.x + p.x * size_, corner_.y + p.y * size_}; }
  void triangle(ImVec2 a, ImVec2 b, ImVec2 c) const {
    list()->AddTriangleFilled(at(a), at(b), at(c), color());
  }

  ImVec2 corner_;
  float size_;
};

void draw(Icon icon, const Pen& pen) {
  switch (icon) {
    case Icon::kPlay:
      pen.right_triangle(0.32f, 0.42f);
      break;
    case Icon::kPause:
      pen.bar(0.30f, 0.14f);
      pen.bar(0.56f, 0.14f);
      break;
    case Icon::kStop:
      pen.square();
      break;
    case Icon::kToStart:
      pen.bar(0.22f, 0.09f);
      pen.left_triangle(0.32f, 0.22f);
      pen.left_triangle(0.54f, 0.22f);
      break;
    case Icon::kToEnd:
      pen.right_triangle(0.24f, 0.22f);
      pen.right_triangle(0.46f, 0.22f);
      pen.bar(0.69f, 0.09f);
      break;
    case Icon::kStepBack:
      pen.left_triangle(0.24f, 0.30f);
      pen.bar(0.62f, 0.11f);
      break;
    case Icon::kStepForward:
      pen.bar(0.27f, 0.11f);
      pen.right_triangle(0.46f, 0.30f);
      break;
    case Icon::kPreviousTool:
      pen.left_triangle(0.16f, 0.26f);
      pen.tool(0.56f);
      break;
    case Icon::kNextTool:
      pen.tool(0.22f);
      pen.right_triangle(0.58f, 0.26f);
      break;
    case Icon::kPreviousFinding:
      pen.left_triangle(0.20f, 0.26f);
      pen.finding(0.60f);
      break;
    case Icon::kNextFinding:
      pen.finding(0.26f);
      pen.right_triangle(0.52f, 0.26f);
      break;
  }
}

}  // namespace

bool icon_button(const char* id, Icon icon) {
  const float size = ImGui::GetFrameHeight();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::PushID(id);
  const bool is_clicked = ImGui::Button("##icon", {size * 1.15f, size});
  ImGui::PopID();
  draw(icon, Pen({corner.x + 0.075f * size, corner.y}, size));
  return is_clicked;
}

}  // namespace kerf
