#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/window/window_impl.h"

namespace kerf {
namespace {

constexpr double kWheelZoom = 1.15;
constexpr double kSpeedStep = 2.0;
/// DetailCommand when the scale has changed by this factor.
constexpr double kDetailStep = 2.0;
constexpr float kClearOpacity = 0.35f;
/// A button that moved less than this while it was down has clicked, not dragged.
constexpr float kClickSlack_px = 4.0f;

/// At one of the corners of what is shown a pixel shows half as much or twice as much.
bool is_other_detail(const ViewDetail& before, const ViewDetail& now, const Box& box) {
  // A place beside the eye is as near as one can be.
  const double least = std::max(0.01 * now.largest_in(box), std::numeric_limits<double>::min());
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at{(corner & 1) != 0 ? box.max.x : box.min.x,
                  (corner & 2) != 0 ? box.max.y : box.min.y,
                  (corner & 4) != 0 ? box.max.z : box.min.z};
    const double was = std::max(before.at(at), least), is = std::max(now.at(at), least);
    if (is >= was * kDetailStep || was >= is * kDetailStep) return true;
  }
  return false;
}

}  // namespace

void Window::Impl::move_camera() {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 unit(io.DisplayFramebufferScale.x, io.DisplayFramebufferScale.y);
  const glm::vec2 cursor = (glm::vec2(io.MousePos.x, io.MousePos.y) - area_top_px_) * unit;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) pressed_in_picture_ = !io.WantCaptureMouse;
  if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) && pressed_in_picture_) {
    pressed_in_picture_ = false;
    const float slack = kClickSlack_px * scale_;
    if (io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] <= slack * slack) click(cursor);
  }
  if (io.WantCaptureMouse) return;
  const glm::vec2 drag = glm::vec2(io.MouseDelta.x, io.MouseDelta.y) * unit;
  const bool pans = ImGui::IsMouseDown(ImGuiMouseButton_Right) ||
                    ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                    (ImGui::IsMouseDown(ImGuiMouseButton_Left) &&
                     (io.KeyShift || settings_.flat != FlatView::kNone));
  const bool is_dragged = pans || ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if ((is_dragged && drag != glm::vec2(0.0f)) || io.MouseWheel != 0.0f) is_fitted_ = false;
  if (pans) {
    camera_.pan(drag, area_px_);
  } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    camera_.orbit(drag, area_px_);
  }
  if (io.MouseWheel != 0.0f) {
    camera_.zoom(std::pow(kWheelZoom, static_cast<double>(io.MouseWheel)), cursor, area_px_);
  }
}

void Window::Impl::click(glm::vec2 cursor_px) {
  const std::optional<Vec3> point = renderer_->pick(glm::ivec2(glm::floor(cursor_px)));
  Inspection& inspection = state_.inspection;
  if (inspection.measures) {
    if (!point) return;
    if (inspection.ends_mm.size() >= 2) inspection.ends_mm.clear();
    inspection.ends_mm.push_back(*point);
    inspection.comes_to_front = true;
    return;
  }
  inspection.asked_mm = point;
  if (!point) return;
  inspection.comes_to_front = true;
  commands_.push(PickCommand{*point});
}

void Window::Impl::tell_detail() {
  const ViewDetail detail = camera_.detail(area_px_).times(detail_px_);
  Box box = renderer_->fit_box();
  if (box.empty()) box.extend(Vec3(0.0));
  if (told_detail_ && !is_other_detail(*told_detail_, detail, box)) return;
  told_detail_ = detail;
  commands_.push(DetailCommand{detail, easy_triangles_});
}

void Window::Impl::act(Action action) {
  touched();
  act_on_player(action);
  act_on_view(action);
  act_on_panels(action);
}

void Window::Impl::act_on_panels(Action action) {
  switch (action) {
    case Action::kWorkpiece:
      toggle_workpiece();
      break;
    case Action::kHolder:
      toggle(SceneObject::kHolder);
      break;
    case Action::kFixtures:
      toggle(SceneObject::kFixtures);
      break;
    case Action::kFeeds:
      toggle(SceneObject::kFeeds);
      break;
    case Action::kTraverses:
      toggle(SceneObject::kTraverses);
      break;
    case Action::kPathTail:
      settings_.drawing.path_tail = settings_.drawing.path_tail > 0 ? 0 : kTailMoves;
      break;
    case Action::kCodePanel:
      settings_.shows_code = !settings_.shows_code;
      break;
    case Action::kInfoPanel:
      if (is_narrow_for_info(ImGui::GetIO().DisplaySize.x, scale_))
        settings_.shows_info_alone = !settings_.shows_info_alone;
      else
        settings_.shows_info = !settings_.shows_info;
      break;
    case Action::kCounters:
      settings_.shows_counters = !settings_.shows_counters;
      break;
    case Action::kNextCurve:
      do {
        settings_.curve =
            static_cast<CurveChoice>((static_cast<int>(settings_.curve) + 1) % kCurveChoices);
      } while (!is_offered(settings_.curve, *shown_.timeline));
      break;
    case Action::kLocalDrawing:
      settings_.drawing.is_local = !settings_.drawing.is_local;
      renderer_->reset_counters();
      break;
    case Action::kMeasure: {
      Inspection& inspection = state_.inspection;
      inspection.measures = !inspection.measures;
      inspection.ends_mm.clear();
      inspection.comes_to_front = inspection.measures;
      break;
    }
    case Action::kScreenshot:
    case Action::kWindowPicture:
      if (has_drawn()) ask_for_picture(action == Action::kWindowPicture);
      break;
    case Action::kFilm:
      if (has_drawn()) begin_or_end_film();
      break;
    case Action::kHelp:
      state_.shows_help = !state_.shows_help;
      break;
    case Action::kFirstKeys:
      if (state_.shows_first_keys) {
        dismiss_first_keys();
      } else {
        state_.shows_first_keys = true;
      }
      break;
    case Action::kUnits:
      settings_.units = settings_.units == LengthUnit::kMm ? LengthUnit::kInch : LengthUnit::kMm;
      break;
    case Action::kGoToLine:
      state_.asks_for_line = true;
      break;
    case Action::kSearch:
      settings_.shows_code = true;
      state_.searches = true;
      state_.search_is_new = true;
      break;
    case Action::kOpen:
      if (shown_.job && shown_.job->can_open) {
        open_file_choice(shown_, settings_, &state_.files);
      } else {
        state_.notice = Text::kCannotOpen;
      }
      break;
    case Action::kClose:
      close();
      break;
    default:
      break;
  }
}

void Window::Impl::act_on_player(Action action) {
  const Moment& moment = *shown_.moment;
  if (moment.state == PlayState::kFollowing) {
    if (is_for_player(action)) state_.notice = Text::kMachineLeads;
    return;
  }
  const auto speed = [&](double factor) {
    const double present = std::isfinite(moment.speed) ? moment.speed : kMaxSpeed;
    commands_.push(SpeedCommand{std::clamp(present * factor, kMinSpeed, kMaxSpeed)});
  };
  switch (action) {
    case Action::kPlayPause:
      if (moment.state == PlayState::kPlaying || moment.state == PlayState::kHurrying) {
        commands_.push(PauseCommand{});
      } else {
        state_.code.follows = true;
        commands_.push(PlayCommand{});
      }
      break;
    case Action::kStop:
      commands_.push(StopCommand{});
      break;
    case Action::kToStart:
      commands_.push(SeekTimeCommand{0.0});
      break;
    case Action::kToEnd:
      commands_.push(SeekEndCommand{});
      break;
    case Action::kStepForward:
      commands_.push(StepBlockCommand{1});
      break;
    case Action::kStepBack:
      commands_.push(StepBlockCommand{-1});
      break;
    case Action::kFaster:
      speed(kSpeedStep);
      break;
    case Action::kSlower:
      speed(1.0 / kSpeedStep);
      break;
    case Action::kFullSpeed:
      commands_.push(SpeedCommand{
          std::isfinite(moment.speed) ? std::numeric_limits<double>::infinity() : 1.0});
      break;
    case Action::kNextFinding:
      commands_.push(NextFindingCommand{1});
      break;
    case Action::kPreviousFinding:
      commands_.push(NextFindingCommand{-1});
      break;
    case Action::kNextTool:
      commands_.push(NextToolCommand{1});
      break;
    case Action::kPreviousTool:
      commands_.push(NextToolCommand{-1});
      break;
    case Action::kBreakpoint:
      set_breakpoint();
      break;
    case Action::kNextSetup:
      go_to_setup(1);
      break;
    case Action::kPreviousSetup:
      go_to_setup(-1);
      break;
    default:
      break;
  }
}

void Window::Impl::open_program(const std::string& path) {
  if (shown_.job && shown_.job->can_open) {
    commands_.push(OpenCommand{path});
  } else {
    state_.notice = Text::kCannotOpen;
  }
}

void Window::Impl::go_to_setup(int step) {
  const std::size_t count = shown_.job ? shown_.job->setups.size() : 0;
  const std::size_t setup = shown_.job ? shown_.job->setup : 0;
  if (step > 0 ? setup + 1 >= count : setup == 0) {
    state_.notice = Text::kNoOtherSetup;
  } else {
    commands_.push(SetupCommand{step > 0 ? setup + 1 : setup - 1});
  }
}

void Window::Impl::set_breakpoint() {
  const Moment& moment = *shown_.moment;
  const auto& files = shown_.program->files;
  const auto file = static_cast<std::size_t>(moment.file);
  if (moment.line < 1 || file >= files.size()) return;
  const auto& set = moment.breakpoints;
  const CodeLine here{moment.file, moment.line};
  const bool is_set = std::binary_search(set.begin(), set.end(), here);
  commands_.push(BreakpointCommand{files[file].path(), moment.line, !is_set});
}

void Window::Impl::act_on_view(Action action) {
  const auto look_from = [this](StandardView view) {
    camera_.look_from(view);
    wants_fit_ = true;
  };
  switch (action) {
    case Action::kFit:
      wants_fit_ = true;
      break;
    case Action::kFront:
      look_from(StandardView::kFront);
      break;
    case Action::kBack:
      look_from(StandardView::kBack);
      break;
    case Action::kLeft:
      look_from(StandardView::kLeft);
      break;
    case Action::kRight:
      look_from(StandardView::kRight);
      break;
    case Action::kTop:
      look_from(StandardView::kTop);
      break;
    case Action::kBottom:
      look_from(StandardView::kBottom);
      break;
    case Action::kIsometric:
      look_from(StandardView::kIsometric);
      break;
    case Action::kPerspective:
      settings_.is_perspective = !settings_.is_perspective;
      break;
    case Action::kFlat:
      settings_.flat = settings_.flat == FlatView::kNone ? FlatView::kXy
                       : settings_.flat == FlatView::kXy ? FlatView::kZx
                                                         : FlatView::kNone;
      wants_fit_ = true;
      break;
    case Action::kNextColors: {
      ColorBy& mode = settings_.drawing.color_by;
      do {
        mode = static_cast<ColorBy>((static_cast<std::size_t>(mode) + 1) % kColorModes);
      } while (!is_offered(mode, *shown_.timeline, *shown_.setup));
      commands_.push(color_command(settings_, state_));
      break;
    }
    case Action::kNextColorOn: {
      constexpr int kTargets = static_cast<int>(ColorTarget::kPath) + 1;
      ColorTarget& target = settings_.drawing.color_on;
      target = static_cast<ColorTarget>((static_cast<int>(target) + 1) % kTargets);
      break;
    }
    case Action::kNextDrawMode: {
      constexpr int kModes = static_cast<int>(DrawMode::kCsg) + 1;
      DrawMode& draw_mode = settings_.drawing.draw_mode;
      draw_mode = static_cast<DrawMode>((static_cast<int>(draw_mode) + 1) % kModes);
      commands_.push(DrawModeCommand{draw_mode});
      break;
    }
    case Action::kSection:
      next_section();
      break;
    default:
      break;
  }
}

/// On and off; of a part that turns half, quarter, off.
void Window::Impl::next_section() {
  SectionChoice& section = settings_.section;
  if (!shown_.setup->turns) {
    section.is_on = !section.is_on;
    return;
  }
  const bool goes_on = !section.is_on || !section.is_quarter;
  section.is_quarter = section.is_on && !section.is_quarter;
  section.is_on = goes_on;
}

void Window::Impl::toggle_workpiece() {
  ObjectLook& workpiece = look(SceneObject::kWorkpiece);
  if (!workpiece.is_visible) {
    workpiece = {true, 1.0f};
  } else if (workpiece.opacity >= 1.0f) {
    workpiece.opacity = kClearOpacity;
  } else {
    workpiece.is_visible = false;
  }
}

}  // namespace kerf
