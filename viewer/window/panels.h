// viewer/window/panels.h - what stands around the picture. For the sources of viewer/ only.
#pragma once

#include <chrono>
#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "viewer/scene.h"
#include "viewer/viewer_command.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/settings.h"
#include "viewer/window/shortcuts.h"

namespace kerf {

/// The values shown now; never null.
struct ShownValues {
  std::shared_ptr<const SceneSetup> setup = std::make_shared<SceneSetup>();
  std::shared_ptr<const FindingList> findings = std::make_shared<FindingList>();
  std::shared_ptr<const ProgramText> program = std::make_shared<ProgramText>();
  std::shared_ptr<const ProgramTimeline> timeline = std::make_shared<ProgramTimeline>();
  std::shared_ptr<const Moment> moment = std::make_shared<Moment>();
  std::chrono::steady_clock::time_point moment_came{};

  /// Age of the newest sample now, also when no news come any more.
  double source_age_s() const;
};

/// What the panels read and change.
struct PanelContext {
  const ShownValues& shown;
  const DrawCounters& counters;
  ViewSettings* settings;
  CommandQueue* commands;
  std::string* notice;  ///< Of the window itself, in the status line.
  bool* shows_help;
  bool* asks_for_line;
  int* followed_line;  ///< To which the program panel was scrolled last.
  int* followed_file;
  int* running_file;  ///< Whose tab was brought to the front last.
  float scale;        ///< Of the display: 1, 2
  Action* action;     ///< Set when a button asks for one, else untouched.
  bool* has_action;
};

/// Pixels that the panels take from each side of the window.
struct PanelRoom {
  float left = 0, right = 0, bottom = 0;
};
/// Panels go where the picture would become too small.
PanelRoom panel_room(glm::vec2 window_px, const ViewSettings& settings, float scale);

void draw_player_bar(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_info_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_code_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_help(const PanelContext& context, glm::vec2 window_px);
void draw_line_question(const PanelContext& context, glm::vec2 window_px);

/// "1:02:03", "2:03.4"
std::string clock_text(double seconds);
/// "0.3 s", "12 s", "4 min", "2 h"
std::string age_text(double seconds);

}  // namespace kerf
