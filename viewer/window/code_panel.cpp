#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "viewer/window/code_words.h"
#include "viewer/window/panels.h"

namespace kerf {
namespace {

constexpr float kScrollBar_px = 12.0f;
constexpr float kSmallestThumb_px = 18.0f;
constexpr float kDotRoom_px = 16.0f;
constexpr double kWheelLines = 3.0;
/// Where the running line is put after a jump, and after it left at the lower end; shares of the
/// height.
constexpr double kJumpShare = 0.4;
constexpr double kPageShare = 0.2;

/// One file in its child window. Lines are drawn by their number alone, not by a position in a long
/// page: pixels of a page of millions of lines are beyond what a float can tell apart.
class FileView {
 public:
  FileView(const PanelContext& context, const SourceFile& file, int index)
      : context_(context),
        file_(file),
        lines_(file),
        moment_(*context.shown.moment),
        scroll_(context.state->code),
        index_(index),
        corner_(ImGui::GetCursorScreenPos()),
        size_(ImGui::GetContentRegionAvail()),
        row_px_(height_px(*context.fonts.mono) + std::round(2.0f * context.scale)),
        digit_px_(
            context.fonts.mono->CalcTextSizeA(height_px(*context.fonts.mono), 1e6f, 0.0f, "0").x) {
    const auto digits = static_cast<float>(std::to_string(file.line_count()).size());
    gutter_px_ = kDotRoom_px * context.scale + digits * digit_px_ + 0.5f * digit_px_;
    text_px_ = gutter_px_ + digit_px_;
    rows_ = static_cast<double>(size_.y / row_px_);
    current_ = index == moment_.file ? moment_.line : 0;
  }

  /// Goes to the line that was looked for, if it is one of this file.
  void show_found() {
    if (scroll_.shows_found && scroll_.found_file == index_) {
      scroll_.shows_found = false;
      scroll_.top_of_file[index_] = std::floor(scroll_.found_line - 1 - rows_ * kJumpShare);
    }
  }

  void draw() {
    if (size_.x < kScrollBar_px * context_.scale + 1.0f || size_.y < 1.0f) return;
    follow();
    show_found();
    take_input();
    double& top = scroll_.top_of_file[index_];
    top = std::clamp(top, 0.0, std::max(0.0, file_.line_count() - rows_));
    draw_lines(top);
    draw_scroll_bar(&top);
    draw_menu();
  }

 private:
  bool is_main() const { return index_ == 0; }
  bool has_breakpoint(int line) const {
    return std::binary_search(moment_.breakpoints.begin(), moment_.breakpoints.end(),
                              CodeLine{index_, line});
  }
  void toggle_breakpoint(int line) const {
    context_.commands->push(BreakpointCommand{file_.path(), line, !has_breakpoint(line)});
  }
  void seek(int line) const {
    scroll_.follows = true;
    context_.commands->push(SeekLineCommand{is_main() ? "" : file_.path(), line});
  }

  void follow() {
    if (index_ != moment_.file) return;
    if (scroll_.seen_file == moment_.file && scroll_.seen_line == moment_.line) return;
    scroll_.seen_file = moment_.file;
    scroll_.seen_line = moment_.line;
    if (scroll_.follows) bring_in_sight();
  }

  void bring_in_sight() const {
    double& top = scroll_.top_of_file[index_];
    const double line = current_ - 1;
    if (line >= top + 1.0 && line <= top + rows_ - 3.0) return;
    // Playing goes down page by page: text that stands still can be read.
    const bool left_below = line > top && line < top + 2.0 * rows_;
    top = std::floor(line - rows_ * (left_below ? kPageShare : kJumpShare));
  }

  void take_input() {
    ImGui::SetCursorScreenPos(corner_);
    ImGui::InvisibleButton("text", {size_.x - kScrollBar_px * context_.scale, size_.y},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsItemHovered()) return;
    double& top = scroll_.top_of_file[index_];
    const float sideways = io.MouseWheelH + (io.KeyShift ? io.MouseWheel : 0.0f);
    if (sideways != 0.0f) {
      scroll_.left_px = std::max(0.0f, scroll_.left_px - 4.0f * digit_px_ * sideways);
    } else if (io.MouseWheel != 0.0f) {
      top -= kWheelLines * static_cast<double>(io.MouseWheel);
      top = std::clamp(top, 0.0, std::max(0.0, file_.line_count() - rows_));
      scroll_.follows = false;
    }
    hovered_ =
        static_cast<int>(top + static_cast<double>((io.MousePos.y - corner_.y) / row_px_)) + 1;
    if (hovered_ > file_.line_count()) hovered_ = 0;
    if (hovered_ == 0) return;
    in_gutter_ = io.MousePos.x < corner_.x + gutter_px_;
    if (ImGui::IsItemClicked(ImGuiMouseButton_Left)) {
      if (in_gutter_) {
        toggle_breakpoint(hovered_);
      } else {
        seek(hovered_);
      }
    } else if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
      scroll_.menu_line = hovered_;
      ImGui::OpenPopup("line menu");
    }
  }

  void draw_lines(double top) const {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 end(corner_.x + size_.x - kScrollBar_px * context_.scale, corner_.y + size_.y);
    list->AddRectFilled(corner_, {corner_.x + gutter_px_, end.y}, theme::kGutter);
    const int first = static_cast<int>(top) + 1;
    const int last = std::min(file_.line_count(), static_cast<int>(top + rows_) + 2);
    float y = std::round(corner_.y - static_cast<float>(top - std::floor(top)) * row_px_);
    ImGui::PushFont(context_.fonts.mono);
    for (int number = first; number <= last; ++number, y += row_px_) {
      const bool is_found = scroll_.found_line == number && scroll_.found_file == index_;
      if (number == current_ || number == hovered_ || is_found) {
        list->AddRectFilled({corner_.x, y}, {end.x, y + row_px_},
                            is_found             ? theme::kFoundLine
                            : number == current_ ? theme::kCurrentLine
                                                 : theme::kHoveredLine);
      }
      draw_gutter(list, number, y);
      list->PushClipRect({corner_.x + gutter_px_, corner_.y}, end, true);
      draw_text(list, lines_.line(number), y);
      list->PopClipRect();
    }
    ImGui::PopFont();
  }

  void draw_gutter(ImDrawList* list, int number, float y) const {
    const float middle = y + 0.5f * row_px_;
    const float x = corner_.x + 0.5f * kDotRoom_px * context_.scale;
    if (has_breakpoint(number)) {
      list->AddCircleFilled({x, middle}, 0.30f * row_px_, theme::kBreakpoint);
    } else if (in_gutter_ && number == hovered_) {
      list->AddCircle({x, middle}, 0.28f * row_px_, theme::kBreakpoint);
    }
    const std::string label = std::to_string(number);
    const float width = static_cast<float>(label.size()) * digit_px_;
    list->AddText({corner_.x + gutter_px_ - 0.5f * digit_px_ - width, y + context_.scale},
                  ImGui::GetColorU32(number == current_ ? theme::kGood : theme::kDim),
                  label.c_str());
  }

  static const ImVec4& color_of(CodeKind kind) {
    switch (kind) {
      case CodeKind::kMotion:
        return theme::kMotionWord;
      case CodeKind::kMachine:
        return theme::kMachineWord;
      case CodeKind::kFeed:
        return theme::kFeedWord;
      case CodeKind::kControl:
        return theme::kControlWord;
      case CodeKind::kNumber:
        return theme::kDim;
      case CodeKind::kComment:
        return theme::kComment;
      case CodeKind::kPlace:
      case CodeKind::kOther:
        break;
    }
    return theme::kText;
  }

  void draw_text(ImDrawList* list, std::string_view line, float y) const {
    ImVec2 at(std::floor(corner_.x + text_px_ - scroll_.left_px), y + context_.scale);
    const auto piece = [&](std::string_view part, const ImVec4& color) {
      if (part.empty()) return;
      const char* begin = part.data();
      const char* end = begin + part.size();
      list->AddText(at, ImGui::GetColorU32(color), begin, end);
      at.x += ImGui::CalcTextSize(begin, end).x;
    };
    // What lies beyond the panel need not be measured.
    line = line.substr(0, kLongestShown);
    for (const CodeWord& word : code_words(line)) {
      piece(line.substr(word.begin, word.length), color_of(word.kind));
    }
  }

  void draw_scroll_bar(double* top) const {
    const float width = kScrollBar_px * context_.scale;
    const ImVec2 low(corner_.x + size_.x - width, corner_.y);
    const double lines = file_.line_count();
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton("scroll", {width, size_.y});
    if (lines <= rows_) return;
    const float thumb =
        std::max(kSmallestThumb_px * context_.scale, size_.y * static_cast<float>(rows_ / lines));
    const double most = lines - rows_;
    if (ImGui::IsItemActive()) {
      const float middle = ImGui::GetIO().MousePos.y - corner_.y - 0.5f * thumb;
      *top = std::clamp(static_cast<double>(middle / (size_.y - thumb)), 0.0, 1.0) * most;
      scroll_.follows = false;
    }
    const float y = low.y + (size_.y - thumb) * static_cast<float>(*top / most);
    const bool is_touched = ImGui::IsItemActive() || ImGui::IsItemHovered();
    ImGui::GetWindowDrawList()->AddRectFilled(
        {low.x + 3.0f * context_.scale, y}, {low.x + width - context_.scale, y + thumb},
        ImGui::GetColorU32(is_touched ? ImGuiCol_ScrollbarGrabHovered : ImGuiCol_ScrollbarGrab),
        3.0f * context_.scale);
  }

  void draw_menu() const {
    if (!ImGui::BeginPopup("line menu")) return;
    const int line = scroll_.menu_line;
    ImGui::TextColored(theme::kDim, "%s %d", context_.word(Text::kLine), line);
    const bool is_played = moment_.state != PlayState::kFollowing;
    if (is_played && ImGui::MenuItem(context_.word(Text::kJumpToHere))) seek(line);
    if (is_played && ImGui::MenuItem(context_.word(Text::kRunToHere))) {
      scroll_.follows = true;
      context_.commands->push(RunToLineCommand{is_main() ? "" : file_.path(), line});
    }
    const bool can_enter = context_.shown.job && context_.shown.job->can_enter;
    if (can_enter && is_main() && line > 1 && ImGui::MenuItem(context_.word(Text::kBeginHere))) {
      context_.commands->push(EntryCommand{line});
    }
    const Text text = has_breakpoint(line) ? Text::kClearBreakpoint : Text::kSetBreakpoint;
    if (is_played && ImGui::MenuItem(context_.word(text))) toggle_breakpoint(line);
    ImGui::EndPopup();
  }

  static constexpr std::size_t kLongestShown = 1024;

  const PanelContext& context_;
  const SourceFile& file_;
  mutable SourceLines lines_;
  const Moment& moment_;
  CodeScroll& scroll_;
  int index_;
  ImVec2 corner_;
  ImVec2 size_;
  float row_px_;
  float digit_px_;
  float gutter_px_ = 0.0f;
  float text_px_ = 0.0f;
  double rows_ = 0.0;  // that fit
  int current_ = 0;
  int hovered_ = 0;
  bool in_gutter_ = false;
};

void draw_file(const PanelContext& context, const SourceFile& file, int index) {
  ImGui::PushID(index);
  ImGui::BeginChild("lines", {0.0f, 0.0f}, false,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  FileView(context, file, index).draw();
  ImGui::EndChild();
  ImGui::PopID();
}

/// The next line with the text, forward or back from the one found last, through all files and
/// round; false: there is none.
bool find_next(const std::vector<SourceFile>& files, const std::string& text, int step,
               CodeScroll* scroll) {
  const int count = static_cast<int>(files.size());
  if (count == 0 || text.empty()) return false;
  int file = std::clamp(scroll->found_file, 0, count - 1), line = scroll->found_line;
  // Once through each file, and the one that it begins in once more.
  for (int turns = 0; turns <= count; ++turns) {
    const SourceFile& source = files[static_cast<std::size_t>(file)];
    SourceLines lines(source);
    for (line += step; line >= 1 && line <= source.line_count(); line += step) {
      if (find_text(lines.line(line), text) == std::string_view::npos) continue;
      scroll->found_file = file;
      scroll->found_line = line;
      scroll->shows_found = true;
      scroll->follows = false;
      return true;
    }
    file = (file + step + count) % count;
    line = step > 0 ? 0 : files[static_cast<std::size_t>(file)].line_count() + 1;
  }
  return false;
}

void draw_search(const PanelContext& context) {
  PanelState& state = *context.state;
  CodeScroll& scroll = state.code;
  if (!state.searches) return;
  if (state.search_is_new) ImGui::SetKeyboardFocusHere();
  const float buttons = 2.0f * (ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x);
  ImGui::SetNextItemWidth(-buttons);
  const bool is_entered = ImGui::InputTextWithHint(
      "##search", context.word(Text::kSearch), &state.search,
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const bool is_changed = ImGui::IsItemEdited();
  // Enter takes the field away from who types; the next Enter is for the next place.
  if (is_entered) ImGui::SetKeyboardFocusHere(-1);
  ImGui::SameLine();
  const bool back = ImGui::ArrowButton("##back", ImGuiDir_Up);
  ImGui::SameLine();
  const bool on = ImGui::ArrowButton("##on", ImGuiDir_Down);
  if (is_changed) {
    scroll.found_line = 0;
    scroll.found_file = 0;
  }
  const bool is_back = back || (is_entered && ImGui::GetIO().KeyShift);
  if (!(is_changed || is_entered || back || on) || state.search.empty()) return;
  if (!find_next(context.shown.program->files, state.search, is_back ? -1 : 1, &scroll)) {
    state.notice = fmt::format("{}: {}", state.search, context.word(Text::kNotFound));
  } else {
    state.notice.clear();
  }
}

std::string file_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

void draw_files(const PanelContext& context) {
  const auto& files = context.shown.program->files;
  CodeScroll& scroll = context.state->code;
  if (!ImGui::BeginTabBar("files", ImGuiTabBarFlags_FittingPolicyScroll)) return;
  // The file that runs comes to the front when it begins to run.
  const int running = context.shown.moment->file;
  const bool enters = running != scroll.running_file;
  scroll.running_file = running;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto index = static_cast<int>(i);
    const std::string name = fmt::format("{}##{}", file_name(files[i].path()), index);
    const bool to_front = (enters && scroll.follows && index == running) ||
                          (scroll.shows_found && index == scroll.found_file);
    if (ImGui::BeginTabItem(name.c_str(), nullptr, to_front ? ImGuiTabItemFlags_SetSelected : 0)) {
      draw_file(context, files[i], index);
      ImGui::EndTabItem();
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", files[i].path().c_str());
  }
  ImGui::EndTabBar();
}

/// Those of a part that is made in several; another one is chosen in the list.
void draw_setups(const PanelContext& context) {
  if (!context.shown.job || context.shown.job->setups.empty()) return;
  const ViewedJob& job = *context.shown.job;
  ImGui::SetNextItemWidth(-1.0f);
  if (!ImGui::BeginCombo("##setup", job.setups[job.setup].c_str())) return;
  for (std::size_t i = 0; i < job.setups.size(); ++i) {
    const bool is_shown = i == job.setup;
    if (ImGui::Selectable(fmt::format("{}##{}", job.setups[i], i).c_str(), is_shown) && !is_shown)
      context.commands->push(SetupCommand{i});
  }
  ImGui::EndCombo();
}

void draw_head(const PanelContext& context) {
  const auto& files = context.shown.program->files;
  CodeScroll& scroll = context.state->code;
  const std::string name =
      files.empty() ? std::string(context.word(Text::kProgram)) : file_name(files.front().path());
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(theme::kDim, "%s", name.c_str());
  if (context.shown.job) {
    ImGui::SameLine();
    if (ImGui::SmallButton(context.word(Text::kOpen))) context.state->action = Action::kOpen;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s (Ctrl+O)", context.word(Text::kOpenWhat));
  }
  if (files.empty() || scroll.follows) return;
  const char* label = context.word(Text::kFollowLine);
  const float width = ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine(
      std::max(0.0f, ImGui::GetWindowWidth() - width - ImGui::GetStyle().WindowPadding.x));
  if (ImGui::Button(label)) {
    scroll.follows = true;
    scroll.seen_line = -1;
    scroll.running_file = -1;
  }
}

}  // namespace

void draw_code_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room) {
  if (room.left <= 0.0f) return;
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize({room.left, window_px.y - room.bottom});
  ImGui::Begin("code", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  draw_setups(context);
  draw_head(context);
  draw_search(context);
  const auto& files = context.shown.program->files;
  if (files.empty()) {
    ImGui::TextColored(theme::kDim, "%s", context.word(Text::kNoProgram));
  } else if (files.size() == 1) {
    draw_file(context, files.front(), 0);
  } else {
    draw_files(context);
  }
  ImGui::End();
}

}  // namespace kerf
