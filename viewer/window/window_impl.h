// viewer/window/window_impl.h - the inside of the window. For its own sources only:
//
//     window.cpp          opening and closing, events
//     window_frame.cpp    one turn: waiting, news, drawing
//     window_actions.cpp  what keys, buttons and clicks do
//     window_pictures.cpp pictures and films of it
#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "viewer/film_writer.h"
#include "viewer/window/embedding.h"
#include "viewer/window/panel_change.h"
#include "viewer/window/panel_layer.h"
#include "viewer/window/panels.h"
#include "viewer/window/platform.h"
#include "viewer/window/window.h"

namespace kerf {

/// Of the second that has just passed.
class FrameCounter {
 public:
  using Clock = std::chrono::steady_clock;
  void count(Clock::time_point now);
  double frames_per_s() const { return frames_per_s_; }

 private:
  Clock::time_point begin_{};
  int frames_ = 0;
  double frames_per_s_ = 0.0;
};

class Window::Impl {
 public:
  using Clock = std::chrono::steady_clock;

  Impl(const WindowOptions& options, SceneMailbox* mailbox, CommandQueue* commands);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  Done open();
  Result<bool> frame(double longest_wait_s);
  void close();
  Picture read() const { return layer_->read(); }
  Picture read_scene() const { return renderer_->read(); }
  bool is_full() const { return renderer_->is_full(); }
  DrawMode drawn_mode() const { return renderer_->drawn_mode(); }
  const DrawCounters& counters() const { return renderer_->counters(); }
  const ViewSettings& settings() const { return settings_; }
  const Diagnostics& settings_faults() const { return settings_faults_; }

 private:
  // window.cpp
  void tell_choices();
  void start_panels();
  void install_callbacks();
  void on_key(int key, int scancode, int action, int mods);
  void on_character(unsigned character);
  void on_drop(const std::string& path);
  bool takes_text() const;
  void dismiss_first_keys();
  void on_mouse_move(glm::vec2 at);
  void on_mouse_button(int button, bool is_down);
  void feed_mouse();
  void remember_settings();

  // window_frame.cpp
  /// An input came: everything is drawn again, several times, since Dear ImGui settles sizes and
  /// hovering over some frames.
  void touched();
  /// The window has lost its pixels.
  void uncovered();
  void wait(double longest_s);
  /// Of a window inside another one: its size, and whether it can be seen.
  void follow_embedding();
  double longest_sleep_s() const;
  /// Nothing is drawn: gives back memory, once.
  void rest();
  bool waits_with_news() const;
  void find_reasons_to_draw();
  bool take_news();
  void apply(const SceneUpdate& update);
  void take_setup(const std::shared_ptr<const SceneSetup>& setup);
  Done draw();
  /// It is closed, by its user or by another program; what frame() returns then.
  bool end();
  /// Nothing can be shown any more.
  Error give_up(const std::string& reason);
  /// Fonts, distances and colours, if the settings want others than there are.
  void set_looks();
  bool wants_light();
  void lay_out(const PanelRoom& room, glm::vec2 display, glm::ivec2 window_px);
  void draw_panels(const PanelRoom& room, glm::vec2 display);
  void show(std::vector<ScreenRect> changed);

  // window_pictures.cpp
  std::string picture_folder() const;
  void ask_for_picture(bool of_window);
  void accept_picture();
  void take_picture();
  void save_taken();
  void end_saving();
  void begin_or_end_film();
  void begin_film(const std::string& path);
  void watch_film();
  void end_film();

  // window_actions.cpp
  void move_camera();
  void click(glm::vec2 cursor_px);
  void tell_detail();
  void act(Action action);
  void act_on_player(Action action);
  void act_on_view(Action action);
  void act_on_panels(Action action);
  /// One on (1) or back (-1).
  void go_to_setup(int step);
  void set_breakpoint();
  void open_program(const std::string& path);
  void toggle_workpiece();
  void next_section();
  void toggle(SceneObject object) { look(object).is_visible = !look(object).is_visible; }
  /// A key may come before the first frame.
  bool has_drawn() const { return last_frame_ != Clock::time_point{}; }
  ObjectLook& look(SceneObject object) {
    return settings_.drawing.looks[static_cast<std::size_t>(object)];
  }

  WindowOptions options_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  ViewSettings settings_;
  Diagnostics settings_faults_;
  DrawMode remembered_mode_ = DrawMode::kMesh;  // before WindowOptions::draw_mode
  LengthUnit remembered_units_ = LengthUnit::kMm;
  ColorBy remembered_color_ = ColorBy::kPlain;
  ColorTarget remembered_color_on_ = ColorTarget::kSurface;

  Platform platform_;
  GLFWwindow* window_ = nullptr;
  std::optional<Embedding> embedding_;
  bool has_panels_ = false;
  std::optional<SceneRenderer> renderer_;
  std::optional<PanelLayer> layer_;
  PanelChange panel_change_;
  bool is_window_old_ = true;  // all of its pixels
  ShownValues shown_;
  PanelState state_;
  Fonts fonts_;
  std::string fonts_language_;  // whose letters they have
  std::vector<ColorLegendEntry> legend_;
  OrbitCamera camera_;
  Projection projection_;
  glm::ivec2 area_px_{1, 1};         // of the picture between the panels
  glm::ivec2 area_corner_px_{0, 0};  // lower left
  glm::vec2 area_top_px_{0.0f};      // upper left, from the upper left of the window
  float display_scale_ = 1.0f;
  float scale_ = 0.0f;  // of the panels
  bool is_light_ = false;
  std::optional<bool> desktop_is_light_;  // none: not looked yet
  bool wants_fit_ = true;
  bool is_fitted_ = false;  // nobody has moved the eye since
  bool pressed_in_picture_ = false;
  double detail_px_ = 1.0;
  std::size_t easy_triangles_ = 0;
  std::optional<ViewDetail> told_detail_;

  int frames_to_draw_ = 1;
  bool panels_are_due_ = true;  // in the next frame
  bool panels_are_old_ = true;  // news came that they do not show yet
  Clock::time_point last_panels_{};
  Clock::time_point last_frame_{};
  std::string shown_age_;
  std::string title_;  // of the setup
  Standing standing_ = Standing::kOnTable;
  FrameCounter frame_counter_;
  bool is_hidden_ = false;         // minimized
  bool is_rested_ = false;         // since the last frame
  Clock::time_point next_news_{};  // while much is cut: not before
  bool was_closed_ = false;

  /// A click and the way to the next place may both happen within one slow frame: of what the mouse
  /// did, Dear ImGui gets at most one press or release a frame, with the place where it was.
  struct MouseEvent {
    glm::vec2 at;
    int button;  ///< -1: moved
    bool is_down;
  };
  std::deque<MouseEvent> mouse_events_;
  glm::vec2 mouse_at_{0.0f};
  std::array<bool, 3> mouse_is_down_{};  // left, right, middle

  // Keys that went down since Dear ImGui looked last, and which of them are up again: it would
  // miss those that do both between two frames.
  std::set<int> fresh_keys_;
  std::vector<std::pair<int, int>> late_releases_;  // key, scancode

  int frames_without_text_ = 0;  // Dear ImGui holds a field that is gone for one more
  bool wants_picture_ = false;   // of the scene, when it is there in full
  std::optional<Picture> taken_;
  std::string taken_path_;  // empty: its name is still asked for
  std::string saving_path_;
  std::future<Done> saving_;  // of a picture or a film
  std::unique_ptr<FilmWriter> film_;
  bool film_has_moved_ = false;
  Clock::time_point film_ends_{};  // none: the program goes on, or has not begun
};

}  // namespace kerf
