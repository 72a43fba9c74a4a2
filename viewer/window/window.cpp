#include "viewer/window/window.h"

// epoxy first: GLFW would bring the system's GL header otherwise.
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <mutex>
#include <thread>
#include <utility>

#include "viewer/window/panels.h"
#include "viewer/window/platform.h"
#include "viewer/window/shortcuts.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

/// Frames drawn after an input: Dear ImGui settles hovering and sizes over several.
constexpr int kSettlingFrames = 3;
/// A picture that shows an age is drawn again at least so often.
constexpr double kAgeInterval_s = 0.2;
constexpr double kWheelZoom = 1.15;
constexpr double kSpeedStep = 2.0;
/// DetailCommand when the scale has changed by this factor.
constexpr double kDetailStep = 2.0;
constexpr float kClearOpacity = 0.35f;
constexpr float kFontSize_px = 13.0f;

}  // namespace

class Window::Impl {
 public:
  Impl(const WindowOptions& options, SceneMailbox* mailbox, CommandQueue* commands)
      : options_(options), mailbox_(*mailbox), commands_(*commands) {
    settings_ = load_settings(options.settings_file, &settings_faults_);
    if (!options.is_local) settings_.drawing.is_local = false;
    if (!settings_faults_.empty()) notice_ = to_string(settings_faults_.front());
    notice_ = notice_.substr(0, notice_.find('\n'));
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  Done open();
  Result<bool> frame(double longest_wait_s);
  void close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
  Picture read() const;
  Picture read_scene() const { return renderer_->read(); }
  const DrawCounters& counters() const { return renderer_->counters(); }
  const ViewSettings& settings() const { return settings_; }
  const Diagnostics& settings_faults() const { return settings_faults_; }

 private:
  void start_panels();
  void install_callbacks();
  void touched() { frames_to_draw_ = kSettlingFrames; }
  void wait(double longest_s);
  bool take_news();
  void apply(const SceneUpdate& update);
  Done draw();
  void draw_panels(const PanelRoom& room);
  void move_camera(glm::ivec2 area_px, glm::vec2 area_corner_px);
  void tell_detail(glm::ivec2 area_px);
  void act(Action action);
  void act_on_player(Action action);
  void act_on_view(Action action);
  void toggle_workpiece();
  void save_picture();
  ObjectLook& look(SceneObject object) {
    return settings_.drawing.looks[static_cast<std::size_t>(object)];
  }

  WindowOptions options_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  ViewSettings settings_;
  Diagnostics settings_faults_;
  std::string notice_;

  Platform platform_;
  GLFWwindow* window_ = nullptr;
  bool has_panels_ = false;
  std::optional<SceneRenderer> renderer_;
  ShownValues shown_;
  OrbitCamera camera_;
  glm::ivec2 area_px_{1, 1};         // of the picture between the panels
  glm::ivec2 area_corner_px_{0, 0};  // lower left
  float scale_ = 1.0f;
  bool wants_fit_ = true;
  bool shows_help_ = false;
  bool asks_for_line_ = false;
  int followed_line_ = -1;
  int followed_file_ = -1;
  int running_file_ = 0;
  double told_pixel_mm_ = 0.0;
  int frames_to_draw_ = kSettlingFrames;
  Clock::time_point last_frame_{};
  bool was_closed_ = false;
};

Window::Impl::~Impl() {
  if (window_ != nullptr) {
    if (!options_.settings_file.empty() && renderer_) {
      int width = 0, height = 0;
      glfwGetWindowSize(window_, &width, &height);
      settings_.width_px = std::clamp(width, 320, 16384);
      settings_.height_px = std::clamp(height, 320, 16384);
      // Nobody is left to be told; the next start has the settings of this one.
      static_cast<void>(save_settings(options_.settings_file, settings_));
    }
    renderer_.reset();
    if (has_panels_) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
      ImGui::DestroyContext();
    }
    glfwDestroyWindow(window_);
  }
}

Done Window::Impl::open() {
  const int width = options_.width_px > 0 ? options_.width_px : settings_.width_px;
  const int height = options_.height_px > 0 ? options_.height_px : settings_.height_px;
  if (Done done = platform_.start(); !done) return done;
  Result<GLFWwindow*> window = platform_.open_window(width, height, "kerf");
  if (!window) return Error{window.error()};
  window_ = *window;
  Result<SceneRenderer> renderer = SceneRenderer::create();
  if (!renderer) return Error{renderer.error()};
  renderer_ = std::move(*renderer);
  install_callbacks();
  start_panels();
  return std::monostate{};
}

void Window::Impl::install_callbacks() {
  // Before those of Dear ImGui, which calls them in its turn.
  glfwSetWindowUserPointer(window_, this);
  static const auto self = [](GLFWwindow* window) {
    return static_cast<Impl*>(glfwGetWindowUserPointer(window));
  };
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    self(window)->touched();
    if (action == GLFW_RELEASE || ImGui::GetIO().WantTextInput) return;
    if (key == GLFW_KEY_ESCAPE) {
      self(window)->shows_help_ = false;
      self(window)->notice_.clear();
    }
    if (const std::optional<Action> wanted = action_of_key(key)) self(window)->act(*wanted);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
    self(window)->touched();
    if (ImGui::GetIO().WantTextInput) return;
    if (const std::optional<Action> wanted = action_of_character(character)) {
      self(window)->act(*wanted);
    }
  });
  glfwSetMouseButtonCallback(window_,
                             [](GLFWwindow* window, int, int, int) { self(window)->touched(); });
  glfwSetScrollCallback(window_,
                        [](GLFWwindow* window, double, double) { self(window)->touched(); });
  glfwSetCursorPosCallback(window_,
                           [](GLFWwindow* window, double, double) { self(window)->touched(); });
  glfwSetFramebufferSizeCallback(window_,
                                 [](GLFWwindow* window, int, int) { self(window)->touched(); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { self(window)->touched(); });
}

void Window::Impl::start_panels() {
  ImGui::CreateContext();
  has_panels_ = true;
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // what is remembered is in ViewSettings
  float scale_x = 1.0f, scale_y = 1.0f;
  glfwGetWindowContentScale(window_, &scale_x, &scale_y);
  scale_ = std::clamp(scale_x, 1.0f, 4.0f);
  ImFontConfig font;
  font.SizePixels = std::round(kFontSize_px * scale_);
  io.Fonts->AddFontDefault(&font);
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowRounding = 0.0f;
  ImGui::GetStyle().ScaleAllSizes(scale_);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

void Window::Impl::wait(double longest_s) {
  const bool is_busy = frames_to_draw_ > 0 || renderer_->has_waiting();
  if (is_busy) {
    glfwPollEvents();
  } else {
    const bool shows_age = shown_.moment->source != SourceFreshness::kNone;
    const double most_s = shows_age ? std::min(longest_s, kAgeInterval_s) : longest_s;
    if (most_s > 0.0) {
      glfwWaitEventsTimeout(most_s);
    } else {
      glfwPollEvents();
    }
    if (shows_age && Clock::now() - last_frame_ > std::chrono::duration<double>(kAgeInterval_s)) {
      frames_to_draw_ = 1;
    }
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
    wants_fit_ = true;
  }
  if (update.setup) {
    shown_.setup = update.setup;
    const std::string& title = update.setup->title;
    glfwSetWindowTitle(window_, title.empty() ? "kerf" : fmt::format("kerf - {}", title).c_str());
  }
  if (update.findings) shown_.findings = update.findings;
  if (update.program) shown_.program = update.program;
  if (update.timeline) shown_.timeline = update.timeline;
  if (update.moment) {
    shown_.moment = update.moment;
    shown_.moment_came = Clock::now();
  }
}

Result<bool> Window::Impl::frame(double longest_wait_s) {
  if (was_closed_) return false;
  wait(longest_wait_s);
  if (glfwWindowShouldClose(window_)) {
    was_closed_ = true;
    commands_.push(CloseCommand{});
    return false;
  }
  if (take_news()) frames_to_draw_ = std::max(frames_to_draw_, 1);
  if (renderer_->has_waiting()) frames_to_draw_ = std::max(frames_to_draw_, 1);
  if (frames_to_draw_ == 0) return true;
  const Clock::duration shortest =
      std::chrono::nanoseconds(1'000'000'000 / std::max(1, options_.max_frames_per_s));
  if (const auto next = last_frame_ + shortest; next > Clock::now()) {
    std::this_thread::sleep_until(next);
    if (take_news()) frames_to_draw_ = std::max(frames_to_draw_, 1);
  }
  last_frame_ = Clock::now();
  --frames_to_draw_;
  if (Done done = draw(); !done) return Error{done.error()};
  return true;
}

Done Window::Impl::draw() {
  glm::ivec2 window_px(0);
  glfwGetFramebufferSize(window_, &window_px.x, &window_px.y);
  if (window_px.x < 1 || window_px.y < 1) return std::monostate{};  // minimized
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 display(io.DisplaySize.x, io.DisplaySize.y);
  const PanelRoom room = panel_room(display, settings_, scale_);
  draw_panels(room);
  ImGui::Render();

  // Screen coordinates are not pixels everywhere.
  const glm::vec2 px_per_unit = glm::vec2(window_px) / glm::max(display, glm::vec2(1.0f));
  const glm::ivec2 low(static_cast<int>(room.left * px_per_unit.x),
                       static_cast<int>(room.bottom * px_per_unit.y));
  const glm::ivec2 high(window_px.x - static_cast<int>(room.right * px_per_unit.x), window_px.y);
  area_px_ = glm::max(high - low, glm::ivec2(1));
  area_corner_px_ = low;
  if (wants_fit_ && !renderer_->fit_box().empty()) {
    camera_.fit(renderer_->fit_box(), area_px_);
    wants_fit_ = false;
  }
  move_camera(area_px_, {static_cast<float>(low.x), 0.0f});
  camera_.set_perspective(settings_.is_perspective);
  tell_detail(area_px_);
  const Projection projection = camera_.projection(renderer_->depth_box(), area_px_);
  if (Done done = renderer_->draw(projection, settings_.drawing); !done) return done;
  renderer_->show_in(0, area_corner_px_);
  glViewport(0, 0, window_px.x, window_px.y);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window_);
  return std::monostate{};
}

void Window::Impl::draw_panels(const PanelRoom& room) {
  Action action = Action::kHelp;
  bool has_action = false;
  const PanelContext context{.shown = shown_,
                             .counters = renderer_->counters(),
                             .settings = &settings_,
                             .commands = &commands_,
                             .notice = &notice_,
                             .shows_help = &shows_help_,
                             .asks_for_line = &asks_for_line_,
                             .followed_line = &followed_line_,
                             .followed_file = &followed_file_,
                             .running_file = &running_file_,
                             .scale = scale_,
                             .action = &action,
                             .has_action = &has_action};
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 window(io.DisplaySize.x, io.DisplaySize.y);
  draw_code_panel(context, window, room);
  draw_info_panel(context, window, room);
  draw_player_bar(context, window, room);
  if (shows_help_) draw_help(context, window);
  if (asks_for_line_) draw_line_question(context, window);
  if (has_action) act(action);
}

void Window::Impl::move_camera(glm::ivec2 area_px, glm::vec2 area_corner_px) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const glm::vec2 unit(io.DisplayFramebufferScale.x, io.DisplayFramebufferScale.y);
  const glm::vec2 drag = glm::vec2(io.MouseDelta.x, io.MouseDelta.y) * unit;
  const glm::vec2 cursor = glm::vec2(io.MousePos.x, io.MousePos.y) * unit - area_corner_px;
  const bool moves = ImGui::IsMouseDown(ImGuiMouseButton_Right) ||
                     ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                     (ImGui::IsMouseDown(ImGuiMouseButton_Left) && io.KeyShift);
  if (moves) {
    camera_.pan(drag, area_px);
  } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    camera_.orbit(drag, area_px);
  }
  if (io.MouseWheel != 0.0f) {
    camera_.zoom(std::pow(kWheelZoom, static_cast<double>(io.MouseWheel)), cursor, area_px);
  }
}

void Window::Impl::tell_detail(glm::ivec2 area_px) {
  const double pixel_mm = camera_.pixel_mm(area_px);
  if (pixel_mm < told_pixel_mm_ * kDetailStep && pixel_mm > told_pixel_mm_ / kDetailStep) return;
  told_pixel_mm_ = pixel_mm;
  commands_.push(DetailCommand{pixel_mm});
}

void Window::Impl::act(Action action) {
  touched();
  act_on_player(action);
  act_on_view(action);
  switch (action) {
    case Action::kWorkpiece:
      toggle_workpiece();
      break;
    case Action::kHolder: {
      bool& is_visible = look(SceneObject::kHolder).is_visible;
      is_visible = !is_visible;
      break;
    }
    case Action::kCodePanel:
      settings_.shows_code = !settings_.shows_code;
      break;
    case Action::kInfoPanel:
      settings_.shows_info = !settings_.shows_info;
      break;
    case Action::kCounters:
      settings_.shows_counters = !settings_.shows_counters;
      break;
    case Action::kLocalDrawing:
      settings_.drawing.is_local = !settings_.drawing.is_local;
      renderer_->reset_counters();
      break;
    case Action::kScreenshot:
      save_picture();
      break;
    case Action::kHelp:
      shows_help_ = !shows_help_;
      break;
    case Action::kGoToLine:
      asks_for_line_ = true;
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
  const auto speed = [&](double factor) {
    commands_.push(SpeedCommand{std::clamp(moment.speed * factor, kMinSpeed, kMaxSpeed)});
  };
  switch (action) {
    case Action::kPlayPause:
      if (moment.state == PlayState::kPlaying || moment.state == PlayState::kHurrying) {
        commands_.push(PauseCommand{});
      } else {
        commands_.push(PlayCommand{});
      }
      break;
    case Action::kStop:
      commands_.push(StopCommand{});
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
    case Action::kBreakpoint: {
      const auto& files = shown_.program->files;
      const auto index = static_cast<std::size_t>(std::max(0, moment.file));
      if (moment.line < 1 || index >= files.size()) break;
      const auto& set = moment.breakpoints;
      const bool is_set = index == 0 && std::binary_search(set.begin(), set.end(), moment.line);
      commands_.push(BreakpointCommand{files[index].path(), moment.line, !is_set});
      break;
    }
    default:
      break;
  }
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
    default:
      break;
  }
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

void Window::Impl::save_picture() {
  const std::string path =
      fmt::format("kerf-{:%Y%m%d-%H%M%S}.png", fmt::localtime(std::time(nullptr)));
  const Done done = write_png(path, renderer_->read());
  notice_ =
      done ? fmt::format("{} {}", text(Text::kSaved, settings_.language), path) : done.error();
}

Picture Window::Impl::read() const {
  glm::ivec2 size_px(0);
  glfwGetFramebufferSize(window_, &size_px.x, &size_px.y);
  // The back buffer has no content after a swap: draw what was drawn last once more.
  renderer_->show_in(0, area_corner_px_);
  glViewport(0, 0, size_px.x, size_px.y);
  if (ImDrawData* panels = ImGui::GetDrawData()) ImGui_ImplOpenGL3_RenderDrawData(panels);
  return read_framebuffer(0, size_px);
}

Window::Window(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;
Window::~Window() = default;

Result<Window> Window::create(const WindowOptions& options, SceneMailbox* mailbox,
                              CommandQueue* commands) {
  auto impl = std::make_unique<Impl>(options, mailbox, commands);
  if (Done done = impl->open(); !done) return Error{done.error()};
  return Window(std::move(impl));
}

Done Window::run() {
  constexpr double kLongestWait_s = 1.0;
  while (true) {
    Result<bool> is_open = impl_->frame(kLongestWait_s);
    if (!is_open) return Error{is_open.error()};
    if (!*is_open) return std::monostate{};
  }
}

Result<bool> Window::frame(double longest_wait_s) { return impl_->frame(longest_wait_s); }
void Window::close() { impl_->close(); }
void Window::wake() { Platform::wake(); }
Picture Window::read() const { return impl_->read(); }
Picture Window::read_scene() const { return impl_->read_scene(); }
const DrawCounters& Window::counters() const { return impl_->counters(); }
const ViewSettings& Window::settings() const { return impl_->settings(); }
const Diagnostics& Window::settings_faults() const { return impl_->settings_faults(); }

}  // namespace kerf
