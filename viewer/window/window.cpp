#include "viewer/window/window.h"

// epoxy first: GLFW would bring the system's GL header otherwise.
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "viewer/window/letters.h"
#include "viewer/window/window_impl.h"

namespace kerf {
namespace {

constexpr int kLeastSize_px = 320;
constexpr int kMostSize_px = 16384;
constexpr float kMostScale = 4.0f;

/// The first line of what there is to say, without the excerpt.
std::string first_line(const Diagnostics& faults) {
  if (faults.empty()) return "";
  std::string text = to_string(faults.front());
  text = text.substr(0, text.find('\n'));
  if (faults.size() > 1) text += fmt::format("  (+{})", faults.size() - 1);
  return text;
}

}  // namespace

Window::Impl::Impl(const WindowOptions& options, SceneMailbox* mailbox, CommandQueue* commands)
    : options_(options), mailbox_(*mailbox), commands_(*commands) {
  settings_ = load_settings(options.settings_file, &settings_faults_);
  const bool can_speak = can_show(settings_.language);
  use_language(can_speak ? settings_.language : "en");
  if (!options.is_local) settings_.drawing.is_local = false;
  remembered_mode_ = settings_.drawing.draw_mode;
  settings_.drawing.draw_mode = options.draw_mode.value_or(remembered_mode_);
  remembered_units_ = settings_.units;
  settings_.units = options.units.value_or(remembered_units_);
  remembered_color_ = settings_.drawing.color_by;
  settings_.drawing.color_by = options.color_by.value_or(remembered_color_);
  remembered_color_on_ = settings_.drawing.color_on;
  settings_.drawing.color_on = options.color_on.value_or(remembered_color_on_);
  settings_.section.is_on = options.section != SectionKind::kNone;
  settings_.section.is_quarter = options.section == SectionKind::kQuarter;
  // Where nothing is remembered they would come every time.
  state_.shows_first_keys = !settings_.knows_keys && !options.settings_file.empty();
  state_.notice = first_line(settings_faults_);
  if (!can_speak && settings_faults_.empty()) {
    state_.notice = missing_letters_text(settings_.language);
  }
}

Window::Impl::~Impl() {
  if (film_) static_cast<void>(film_->finish());  // nobody is left to be told
  if (saving_.valid()) saving_.wait();
  if (window_ == nullptr) return;
  // A display that is gone takes no farewell: whoever talks to it waits for ever.
  if (!Platform::is_lost()) {
    if (renderer_) remember_settings();
    renderer_.reset();
    layer_.reset();
    if (has_panels_) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
      ImGui::DestroyContext();
    }
    glfwDestroyWindow(window_);
  }
}

void Window::Impl::remember_settings() {
  if (options_.settings_file.empty()) return;
  if (!settings_faults_.empty() && !set_aside(options_.settings_file)) return;
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  // A window that was shrunk to nothing is not worth remembering.
  if (!embedding_ && Platform::is_there(window_) && width >= kLeastSize_px &&
      height >= kLeastSize_px) {
    const auto unscaled = [this](int px) {
      const auto size = static_cast<int>(std::lround(static_cast<float>(px) / display_scale_));
      return std::clamp(size, kLeastSize_px, kMostSize_px);
    };
    settings_.width_px = unscaled(width);
    settings_.height_px = unscaled(height);
  }
  // What was asked for this time alone; another choice since is to be remembered.
  if (options_.draw_mode == settings_.drawing.draw_mode)
    settings_.drawing.draw_mode = remembered_mode_;
  if (options_.units == settings_.units) settings_.units = remembered_units_;
  if (options_.color_by == settings_.drawing.color_by)
    settings_.drawing.color_by = remembered_color_;
  if (options_.color_on == settings_.drawing.color_on)
    settings_.drawing.color_on = remembered_color_on_;
  // Nobody is left to be told; the next start has the settings of this one.
  static_cast<void>(save_settings(options_.settings_file, settings_));
}

Done Window::Impl::open() {
  const int width = options_.width_px > 0 ? options_.width_px : settings_.width_px;
  const int height = options_.height_px > 0 ? options_.height_px : settings_.height_px;
  const bool is_inside = options_.embed_in.has_value();
  if (Done done = platform_.start(is_inside); !done) return done;
  Result<GLFWwindow*> window = platform_.open_window(width, height, "kerf", is_inside);
  if (!window) return Error{window.error()};
  window_ = *window;
  if (is_inside) {
    Result<Embedding> embedding = Embedding::into(*options_.embed_in, window_);
    if (!embedding) return Error{embedding.error()};
    embedding_ = std::move(*embedding);
    // The keys are those of the program around it.
    state_.shows_first_keys = false;
  }
  Result<SceneRenderer> renderer = SceneRenderer::create(Platform::wake);
  if (!renderer) return Error{renderer.error()};
  renderer_ = std::move(*renderer);
  renderer_->keep_pace();
  detail_px_ = SceneRenderer::detail_px();
  easy_triangles_ = SceneRenderer::easy_triangles();
  layer_.emplace();
  start_panels();
  install_callbacks();
  tell_choices();
  return std::monostate{};
}

/// How the workpiece is looked at, where that is not as it is by itself.
void Window::Impl::tell_choices() {
  told_detail_.reset();
  if (settings_.drawing.color_by != ColorBy::kPlain) {
    commands_.push(color_command(settings_, state_));
  }
  if (settings_.drawing.draw_mode != DrawMode::kMesh) {
    commands_.push(DrawModeCommand{settings_.drawing.draw_mode});
  }
}

void Window::Impl::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::Impl::start_panels() {
  ImGui::CreateContext();
  has_panels_ = true;
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // what is remembered is in ViewSettings
  // A cursor that blinks would have to be drawn while nothing happens.
  io.ConfigInputTextCursorBlink = false;
  float scale_x = 1.0f, scale_y = 1.0f;
  glfwGetWindowContentScale(window_, &scale_x, &scale_y);
  display_scale_ = std::clamp(options_.scale > 0.0f ? options_.scale : scale_x, 1.0f, kMostScale);
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  set_looks();
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window_, &x, &y);
  mouse_at_ = {static_cast<float>(x), static_cast<float>(y)};
}

void Window::Impl::install_callbacks() {
  glfwSetWindowUserPointer(window_, this);
  static const auto self = [](GLFWwindow* window) {
    return static_cast<Impl*>(glfwGetWindowUserPointer(window));
  };
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int scancode, int action, int mods) {
    self(window)->on_key(key, scancode, action, mods);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
    self(window)->on_character(character);
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
    self(window)->on_mouse_button(button, action == GLFW_PRESS);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
    self(window)->touched();
    ImGui_ImplGlfw_ScrollCallback(window, x, y);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    self(window)->on_mouse_move({static_cast<float>(x), static_cast<float>(y)});
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int entered) {
    self(window)->touched();
    ImGui_ImplGlfw_CursorEnterCallback(window, entered);
  });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int focused) {
    self(window)->touched();
    ImGui_ImplGlfw_WindowFocusCallback(window, focused);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    if (count > 0) self(window)->on_drop(paths[0]);
  });
  glfwSetFramebufferSizeCallback(window_,
                                 [](GLFWwindow* window, int, int) { self(window)->uncovered(); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { self(window)->uncovered(); });
  glfwSetWindowIconifyCallback(window_, [](GLFWwindow* window, int is_hidden) {
    self(window)->is_hidden_ = is_hidden == GLFW_TRUE;
    self(window)->uncovered();
  });
  glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* window, float scale, float) {
    Impl& impl = *self(window);
    if (impl.options_.scale <= 0.0f) impl.display_scale_ = std::clamp(scale, 1.0f, kMostScale);
    impl.touched();
  });
}

void Window::Impl::on_mouse_move(glm::vec2 at) {
  touched();
  const bool continues = !mouse_events_.empty() && mouse_events_.back().button < 0;
  if (continues) mouse_events_.pop_back();
  mouse_events_.push_back({at, -1, false});
}

void Window::Impl::on_mouse_button(int button, bool is_down) {
  touched();
  if (is_down) dismiss_first_keys();
  if (button >= static_cast<int>(mouse_is_down_.size())) return;
  // Where the last move led: glfwGetCursorPos() may be ahead of the events.
  const glm::vec2 at = mouse_events_.empty() ? mouse_at_ : mouse_events_.back().at;
  mouse_events_.push_back({at, button, is_down});
}

void Window::Impl::feed_mouse() {
  while (!mouse_events_.empty()) {
    const MouseEvent event = mouse_events_.front();
    mouse_events_.pop_front();
    mouse_at_ = event.at;
    if (event.button < 0) continue;
    mouse_is_down_[static_cast<std::size_t>(event.button)] = event.is_down;
    break;
  }
  if (!mouse_events_.empty()) touched();
  ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsMousePosValid(&io.MousePos)) io.MousePos = {mouse_at_.x, mouse_at_.y};
  for (std::size_t i = 0; i < mouse_is_down_.size(); ++i) io.MouseDown[i] = mouse_is_down_[i];
}

void Window::Impl::on_key(int key, int scancode, int action, int mods) {
  touched();
  if (action == GLFW_RELEASE && fresh_keys_.count(key) > 0) {
    late_releases_.emplace_back(key, scancode);
    return;
  }
  if (action == GLFW_PRESS) fresh_keys_.insert(key);
  ImGui_ImplGlfw_KeyCallback(window_, key, scancode, action, mods);
  if (action == GLFW_RELEASE) return;
  if (key != GLFW_KEY_F1) dismiss_first_keys();
  if (key == GLFW_KEY_ESCAPE) {
    state_.shows_help = false;
    state_.asks_for_line = false;
    state_.shows_entry = false;
    state_.files.is_open = false;
    state_.picture.is_open = false;
    wants_picture_ = false;
    state_.searches = false;
    state_.code.found_line = 0;
    state_.notice.clear();
  }
  // Also before the question is drawn for the first time.
  const bool is_enter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
  if (state_.picture.is_open && is_enter && action == GLFW_PRESS) return accept_picture();
  if (takes_text()) return;
  const bool with_control = (mods & GLFW_MOD_CONTROL) != 0;
  if (const std::optional<Action> wanted = action_of_key(key, with_control)) act(*wanted);
}

void Window::Impl::dismiss_first_keys() {
  if (!state_.shows_first_keys) return;
  state_.shows_first_keys = false;
  settings_.knows_keys = true;
}

/// Questions get what is typed also before they are drawn for the first time.
bool Window::Impl::takes_text() const {
  const bool has_field = ImGui::GetIO().WantTextInput && frames_without_text_ == 0;
  return has_field || state_.asks_for_line || state_.files.is_open || state_.search_is_new ||
         (state_.picture.is_open && state_.picture.is_new);
}

void Window::Impl::on_drop(const std::string& path) {
  touched();
  open_program(path);
}

void Window::Impl::on_character(unsigned character) {
  touched();
  ImGui_ImplGlfw_CharCallback(window_, character);
  if (takes_text()) return;
  if (const std::optional<Action> wanted = action_of_character(character)) act(*wanted);
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
bool Window::is_full() const { return impl_->is_full(); }
DrawMode Window::drawn_mode() const { return impl_->drawn_mode(); }
const DrawCounters& Window::counters() const { return impl_->counters(); }
const ViewSettings& Window::settings() const { return impl_->settings(); }
const Diagnostics& Window::settings_faults() const { return impl_->settings_faults(); }

}  // namespace kerf
