// epoxy first: GLFW would bring the system's GL header otherwise.
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "base/translate.h"
#include "viewer/window/desktop_theme.h"
#include "viewer/window/window_impl.h"

namespace kerf {
namespace {

using Seconds = std::chrono::duration<double>;

/// Frames drawn after an input.
constexpr int kSettlingFrames = 3;
/// While news alone come, panels are drawn again at most so often: nobody reads figures faster, and
/// the picture is not held up.
constexpr Seconds kPanelInterval{0.05};
/// After this long without a frame what was needed for drawing alone is given back. Shorter, and a
/// hand that pauses at the mouse would have it taken anew.
constexpr Seconds kRest{2.0};
/// Pictures and cutting share the processor. While it is cut as fast as can be, cutting has so many
/// times as long as the last picture took, but a picture comes at least so often.
constexpr int kCutsPerDrawn = 6;
constexpr std::chrono::milliseconds kLongestHold{250};
/// How often it is looked whether a film is over.
constexpr Seconds kFilmInterval{0.1};
/// How often it is looked whether an age that is shown reads differently by now.
constexpr Seconds kAgeInterval{0.1};

// From Dear ImGui 1.92 on letters are made as they are needed, and go into their texture when a
// frame is drawn; here before, since what is drawn is looked at first.
#if IMGUI_VERSION_NUM >= 19200
/// Graphics memory of the letters.
std::size_t letter_bytes() {
  const ImTextureData* const letters = ImGui::GetIO().Fonts->TexData;
  return letters == nullptr ? 0 : static_cast<std::size_t>(letters->GetSizeInBytes());
}

void renew_letters() {}

void send_letters() {
  for (ImTextureData* const texture : *ImGui::GetDrawData()->Textures) {
    if (texture->Status != ImTextureStatus_OK) ImGui_ImplOpenGL3_UpdateTexture(texture);
  }
}
#else
/// Graphics memory of the letters.
std::size_t letter_bytes() {
  constexpr std::size_t kBytesPerPixel = 4;  // RGBA8, as Dear ImGui's OpenGL part makes it
  const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  return kBytesPerPixel * static_cast<std::size_t>(atlas.TexWidth) *
         static_cast<std::size_t>(atlas.TexHeight);
}

void renew_letters() {
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void send_letters() {}
#endif

}  // namespace

void FrameCounter::count(Clock::time_point now) {
  ++frames_;
  const Seconds passed = now - begin_;
  if (passed < Seconds(1.0)) return;
  // After a rest the count starts anew: a frame a minute is no rate.
  frames_per_s_ = passed < Seconds(2.0) ? frames_ / passed.count() : 0.0;
  begin_ = now;
  frames_ = 0;
}

void Window::Impl::touched() {
  frames_to_draw_ = kSettlingFrames;
  panels_are_due_ = true;
}

void Window::Impl::uncovered() {
  is_window_old_ = true;
  touched();
}

double Window::Impl::longest_sleep_s() const {
  if (is_hidden_) return 1.0;
  if (frames_to_draw_ > 0 || renderer_->has_waiting()) return 0.0;
  double longest_s = 1e9;
  if (film_) longest_s = kFilmInterval.count();
  if (waits_with_news())
    longest_s = std::min(longest_s, Seconds(next_news_ - Clock::now()).count());
  if (panels_are_old_) {
    longest_s = std::min(longest_s, Seconds(last_panels_ + kPanelInterval - Clock::now()).count());
  }
  if (shown_.moment->source != SourceFreshness::kNone) {
    longest_s = std::min(longest_s, kAgeInterval.count());
  }
  return longest_s;
}

void Window::Impl::wait(double longest_s) {
  longest_s = std::min(longest_s, longest_sleep_s());
  if (longest_s > 0.0) {
    glfwWaitEventsTimeout(longest_s);
  } else {
    glfwPollEvents();
  }
}

void Window::Impl::follow_embedding() {
  if (!embedding_ || Platform::is_lost()) return;
  // GLFW may have set Xlib's own way of failing again.
  Platform::survive_destroyed(window_);
  embedding_->follow();
  if (std::exchange(is_hidden_, embedding_->is_covered()) && !is_hidden_) uncovered();
}

/// While it goes as fast as it can be cut, and nobody touches the window.
bool Window::Impl::waits_with_news() const {
  return shown_.moment->is_behind && !film_ && frames_to_draw_ == 0 && Clock::now() < next_news_;
}

void Window::Impl::find_reasons_to_draw() {
  end_saving();
  watch_film();
  if (!waits_with_news() && take_news()) {
    frames_to_draw_ = std::max(frames_to_draw_, 1);
    panels_are_old_ = true;
  }
  if (renderer_->has_waiting()) frames_to_draw_ = std::max(frames_to_draw_, 1);
  if (shown_.moment->source != SourceFreshness::kNone &&
      age_text(shown_.source_age_s()) != shown_age_) {
    panels_are_old_ = true;
  }
  if (panels_are_old_ && Clock::now() - last_panels_ >= kPanelInterval) {
    panels_are_due_ = true;
    frames_to_draw_ = std::max(frames_to_draw_, 1);
  }
}

bool Window::Impl::take_news() {
  const std::unique_ptr<SceneUpdate> update = mailbox_.take();
  if (!update) return false;
  apply(*update);
  return true;
}

void Window::Impl::apply(const SceneUpdate& update) {
  renderer_->apply(update);
  if (update.clears) {
    shown_.findings = std::make_shared<FindingList>();
    tell_choices();  // it may be another one who shows it
  }
  if (update.draw_mode) shown_.draw_mode = update.draw_mode;
  if (update.job) {
    shown_.job = update.job;
    state_.job = edit_of(*update.job);
    const bool is_shown =
        update.job->can_open && !update.job->program.empty() && update.job->faults.empty();
    if (is_shown) remember_program(update.job->program, &settings_);
    touched();
  }
  if (update.setup) take_setup(update.setup);
  if (update.findings) shown_.findings = update.findings;
  if (update.program) {
    shown_.program = update.program;
    state_.code = CodeScroll{};
    const auto& files = update.program->files;
    state_.first_line = 1;
    state_.last_line = files.empty() ? 1 : files.front().line_count();
  }
  if (update.timeline) shown_.timeline = update.timeline;
  if (update.clears) shown_.curves.reset();
  if (update.curves) shown_.curves = update.curves;
  if (update.colors) touched();  // their legend
  if (update.picked) shown_.picked = update.picked;
  if (update.entry) {
    shown_.entry = update.entry;
    state_.shows_entry = update.entry->line > 0;
    touched();
  }
  if (update.moment) {
    // Another file comes to the front, which takes Dear ImGui more than one frame.
    if (update.moment->file != shown_.moment->file) touched();
    if (update.moment->state != PlayState::kFollowing && state_.notice.is(Text::kMachineLeads)) {
      state_.notice.clear();
    }
    shown_.moment = update.moment;
    shown_.moment_came = Clock::now();
  }
}

void Window::Impl::take_setup(const std::shared_ptr<const SceneSetup>& setup) {
  if (!(setup->bounds_mm == shown_.setup->bounds_mm) && !setup->keeps_eye) wants_fit_ = true;
  shown_.setup = setup;
  if (setup->tolerance_mm) {
    settings_.drawing.color_by = ColorBy::kDeviation;
    settings_.drawing.tolerance_mm =
        std::clamp(*setup->tolerance_mm, kMinTolerance_mm, kMaxTolerance_mm);
  } else if (settings_.drawing.color_by == ColorBy::kDeviation) {
    settings_.drawing.color_by = ColorBy::kPlain;
  }
  // A drawing in 2D was of what was shown before.
  if (!setup->keeps_eye && setup->title != title_) settings_.flat = FlatView::kNone;
  if (setup->standing != standing_) {
    standing_ = setup->standing;
    camera_.set_standing(standing_);
    // A turned part is looked at as on the lathe's own screen.
    camera_.look_from(standing_ == Standing::kInLathe ? StandardView::kFront
                                                      : StandardView::kIsometric);
    settings_.section.offset_mm = 0.0;  // for a part that turns this is its axis
    wants_fit_ = true;
  }
  title_ = setup->title;
  const std::string& title = setup->title;
  glfwSetWindowTitle(window_, title.empty() ? "kerf" : fmt::format("kerf - {}", title).c_str());
  const Box& bounds = setup->bounds_mm;
  SectionChoice& section = settings_.section;
  if (!bounds.empty() && !(section.offset_mm > bounds.min[section.axis] &&
                           section.offset_mm < bounds.max[section.axis])) {
    section.offset_mm = 0.5 * (bounds.min[section.axis] + bounds.max[section.axis]);
  }
}

/// A software renderer keeps every triangle of a frame for a while, and patches come and go: what
/// is free in between stays with the process otherwise, tens of megabytes.
void Window::Impl::rest() {
  if (is_rested_ || !has_drawn() || Clock::now() - last_frame_ < kRest) return;
  is_rested_ = true;
  malloc_trim(0);
}

Result<bool> Window::Impl::frame(double longest_wait_s) {
  if (was_closed_) return false;
  wait(longest_wait_s);
  follow_embedding();
  if (Done done = platform_.check(); !done) return give_up(done.error());
  if (glfwWindowShouldClose(window_) || Platform::is_gone(window_)) return end();
  find_reasons_to_draw();
  if (is_hidden_ || frames_to_draw_ == 0) {
    rest();
    return true;
  }
  is_rested_ = false;
  const Clock::duration shortest =
      std::chrono::nanoseconds(1'000'000'000 / std::max(1, options_.max_frames_per_s));
  if (const auto next = last_frame_ + shortest; next > Clock::now()) {
    std::this_thread::sleep_until(next);
    find_reasons_to_draw();
  }
  last_frame_ = Clock::now();
  frame_counter_.count(last_frame_);
  --frames_to_draw_;
  if (Done done = draw(); !done) {
    // What failed may be that it was destroyed meanwhile.
    if (!Platform::is_lost() && Platform::is_gone(window_)) return end();
    return give_up(done.error());
  }
  const Clock::time_point end = Clock::now();
  next_news_ = end + std::min<Clock::duration>(kCutsPerDrawn * (end - last_frame_), kLongestHold);
  return true;
}

bool Window::Impl::end() {
  was_closed_ = true;
  commands_.push(CloseCommand{});
  return false;
}

Error Window::Impl::give_up(const std::string& reason) {
  was_closed_ = true;
  commands_.push(CloseCommand{});
  return Error{reason};
}

bool Window::Impl::wants_light() {
  if (settings_.theme != ThemeChoice::kSystem) return settings_.theme == ThemeChoice::kLight;
  if (!desktop_is_light_) desktop_is_light_ = !desktop_is_dark().value_or(true);
  return *desktop_is_light_;
}

void Window::Impl::set_looks() {
  const float scale = display_scale_ * static_cast<float>(settings_.text_scale);
  const bool is_light = wants_light();
  const std::string spoken = language();
  if (scale == scale_ && is_light == is_light_ && spoken == fonts_language_) return;
  if (scale != scale_ || spoken != fonts_language_) {
    scale_ = scale;
    fonts_language_ = spoken;
    // Letters are drawn for their size, not blown up.
    fonts_ = load_fonts(scale_, fonts_language_);
    renew_letters();
  }
  is_light_ = is_light;
  set_style(scale_, is_light_);
  is_window_old_ = true;
  touched();
}

void Window::Impl::lay_out(const PanelRoom& room, glm::vec2 display, glm::ivec2 window_px) {
  // Screen coordinates are not pixels everywhere.
  const glm::vec2 px_per_unit = glm::vec2(window_px) / glm::max(display, glm::vec2(1.0f));
  const glm::ivec2 low(glm::vec2(room.left, room.bottom) * px_per_unit);
  const glm::ivec2 high = window_px - glm::ivec2(glm::vec2(room.right, room.top) * px_per_unit);
  const glm::ivec2 size = glm::max(high - low, glm::ivec2(1));
  if (size != area_px_ || low != area_corner_px_) is_window_old_ = true;
  // All is seen still, if nobody has chosen otherwise.
  if (size != area_px_ && is_fitted_) wants_fit_ = true;
  area_px_ = size;
  area_corner_px_ = low;
  area_top_px_ = {room.left, room.top};
}

Done Window::Impl::draw() {
  glm::ivec2 window_px(0);
  glfwGetFramebufferSize(window_, &window_px.x, &window_px.y);
  if (!Platform::is_there(window_)) return platform_.check();
  if (window_px.x < 1 || window_px.y < 1) return std::monostate{};
  if (window_px != layer_->size_px()) {
    is_window_old_ = true;
    platform_.take_new_size(window_);
  }
  if (Done done = layer_->resize(window_px); !done) return done;
  std::vector<ScreenRect> changed;
  const bool draws_panels = panels_are_due_;
  if (draws_panels) {
    set_looks();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    // It has asked for the size.
    if (!Platform::is_there(window_)) return platform_.check();
    feed_mouse();
    ImGui::NewFrame();
    const glm::vec2 display(ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y);
    const PanelRoom room = panel_room(display, settings_, scale_, shown_.timeline->has_curves);
    lay_out(room, display, window_px);
    move_camera();
    draw_panels(room, display);
    ImGui::Render();
    send_letters();
    panel_change_.find(*ImGui::GetDrawData(), window_px, &changed);
  }
  camera_.set_perspective(settings_.is_perspective);
  camera_.set_flat(settings_.flat);
  if (wants_fit_ && !renderer_->fit_box().empty()) {
    camera_.fit(renderer_->fit_box(), area_px_);
    wants_fit_ = false;
    is_fitted_ = true;
    if (draws_panels) touched();  // marks over the picture go with the camera
  }
  tell_detail();
  choose_section(settings_.section, renderer_->fit_box(), shown_.setup->turns, &settings_.drawing);
  Projection wanted = camera_.projection(renderer_->depth_box(), area_px_);
  wanted.line_px = display_scale_;
  DrawOptions drawing = settings_.drawing;
  // Among light panels a dark picture would be a hole.
  drawing.is_dark = drawing.is_dark && !is_light_;
  if (Done done = renderer_->draw(wanted, drawing); !done) return done;
  if (wants_picture_ && renderer_->is_full()) take_picture();
  if (film_) film_->show(renderer_->read());
  // Marks over a picture that came late go with it.
  if (renderer_->projection() != projection_ && !draws_panels) panels_are_old_ = true;
  projection_ = renderer_->projection();
  add_apart(renderer_->take_changed().moved(area_corner_px_), &changed);
  // Where a unit of Dear ImGui is not a pixel, its rectangles are no pixels either.
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  if (std::exchange(is_window_old_, false) || scale.x != 1.0f || scale.y != 1.0f) {
    changed = {ScreenRect::whole(window_px)};
  }
  show(std::move(changed));
  return platform_.check();
}

/// Brings the rectangles up to date and to the screen. Tooltips, questions and marks lie over the
/// picture: it cannot be changed without them.
void Window::Impl::show(std::vector<ScreenRect> changed) {
  if (changed.empty()) return;
  const ScreenRect area = ScreenRect::whole(area_px_);
  for (const ScreenRect& rect : changed) {
    const ScreenRect seen = rect.moved(-area_corner_px_).common(area);
    if (!seen.empty()) renderer_->show_in(layer_->framebuffer(), area_corner_px_, seen);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, layer_->framebuffer());
  draw_panels_in(changed, layer_->size_px(), ImGui::GetDrawData());
  if (!platform_.can_show_parts()) changed = {ScreenRect::whole(layer_->size_px())};
  for (const ScreenRect& rect : changed) layer_->show(rect);
  platform_.show(window_, changed);
}

void Window::Impl::draw_panels(const PanelRoom& room, glm::vec2 display) {
  panels_are_due_ = frames_to_draw_ > 0;  // settling
  panels_are_old_ = false;
  last_panels_ = Clock::now();
  shown_age_ = age_text(shown_.source_age_s());
  state_.frames_per_s = frame_counter_.frames_per_s();
  state_.action.reset();
  const Measures measures(settings_.units);
  legend_ = renderer_->legend(measures);
  DrawCounters counters = renderer_->counters();
  counters.gpu_bytes += layer_->gpu_bytes() + letter_bytes();
  const PanelContext context{.shown = shown_,
                             .counters = counters,
                             .legend = legend_,
                             .drawn_mode = renderer_->drawn_mode(),
                             .bounds_mm = renderer_->fit_box(),
                             .fonts = fonts_,
                             .scale = scale_,
                             .is_light = is_light_,
                             .settings = &settings_,
                             .state = &state_,
                             .commands = &commands_,
                             .measures = measures,
                             .has_keyboard = !embedding_};
  draw_scene_legend(context, area_top_px_, projection_.size_px);
  draw_inspection(context, projection_, area_top_px_);
  if (state_.shows_entry) draw_entry_way(context, projection_, area_top_px_);
  draw_code_panel(context, display, room);
  draw_info_panel(context, display, room);
  draw_toolbar(context, display, room);
  draw_player_bar(context, display, room);
  draw_edges(context, display, room);
  draw_empty_hint(context, display, room);
  if (state_.shows_first_keys) draw_first_keys(context, display, room);
  if (state_.shows_help) draw_help(context, display);
  if (state_.files.is_open) draw_file_choice(context, display);
  if (state_.shows_entry) draw_entry(context, display, room);
  if (state_.asks_for_line) draw_line_question(context, display);
  if (state_.picture.is_open) draw_picture_choice(context, display);
  if (state_.picture.is_accepted) accept_picture();
  if (state_.action) act(*state_.action);
  state_.search_is_new = false;  // also if there is no room for the panel
  frames_without_text_ = std::max(0, frames_without_text_ - 1);
  // Dear ImGui has seen these keys go down now.
  fresh_keys_.clear();
  for (const auto& [key, scancode] : late_releases_) {
    ImGui_ImplGlfw_KeyCallback(window_, key, scancode, GLFW_RELEASE, 0);
  }
  late_releases_.clear();
}

}  // namespace kerf
