// viewer/window/panels.h - what stands around the picture. For the sources of viewer/ only.
//
//     +---------+----------------------------+---------+
//     | code    | toolbar                    | info    |
//     |         +----------------------------+         |
//     |         | the picture                |         |
//     +---------+----------------------------+---------+
//     | player bar                                     |
//     +------------------------------------------------+
#pragma once

#include <chrono>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/scene.h"
#include "viewer/viewer_command.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/settings.h"
#include "viewer/window/shortcuts.h"
#include "viewer/window/texts.h"
#include "viewer/window/theme.h"

namespace kerf {

/// The values shown now; never null but `curves`, `picked`, `entry`, `draw_mode` and `job`.
struct ShownValues {
  std::shared_ptr<const SceneSetup> setup = std::make_shared<SceneSetup>();
  std::shared_ptr<const FindingList> findings = std::make_shared<FindingList>();
  std::shared_ptr<const ProgramText> program = std::make_shared<ProgramText>();
  std::shared_ptr<const ProgramTimeline> timeline = std::make_shared<ProgramTimeline>();
  std::shared_ptr<const ProgramCurves> curves;
  std::shared_ptr<const Moment> moment = std::make_shared<Moment>();
  std::shared_ptr<const PickedPoint> picked;
  std::shared_ptr<const EntryAnswer> entry;  ///< Never null while PanelState::shows_entry.
  std::shared_ptr<const DrawAnswer> draw_mode;
  std::shared_ptr<const ViewedJob> job;  ///< Null: nothing else can be shown here.
  std::chrono::steady_clock::time_point moment_came{};

  /// Age of the newest sample now, also when no news come any more.
  double source_age_s() const;
};

/// How far the program panel is scrolled. Lines count from 0 here.
struct CodeScroll {
  std::map<int, double> top_of_file;  ///< first line that is seen, in lines
  float left_px = 0.0f;
  bool follows = true;  ///< The running line is kept in sight.
  int seen_file = -1;   ///< What it followed last.
  int seen_line = -1;
  int running_file = 0;      ///< Whose tab was brought to the front last.
  int menu_line = 0;         ///< 1-based, of the context menu
  int found_file = 0;        ///< Where the text is that was looked for.
  int found_line = 0;        ///< 1-based; 0: none was found
  bool shows_found = false;  ///< It is still to be brought in sight.
};

/// Clicks on the workpiece.
struct Inspection {
  std::optional<Vec3> asked_mm;  ///< The last point that was clicked; a PickCommand went out.
  bool measures = false;
  std::vector<Vec3> ends_mm;    ///< none, one or both
  bool comes_to_front = false;  ///< Its tab has to be shown.
};

/// The list of files from which a program is opened.
struct FileChoice {
  struct Entry {
    std::string name;
    bool is_folder = false;
  };
  bool is_open = false;
  std::string folder;          ///< Absolute.
  std::vector<Entry> entries;  ///< Folders first, by name.
  std::string name;            ///< Being typed: a name in the folder, or a path.
  std::string fault;           ///< Why the folder or what was typed cannot be opened.
  bool shows_all = false;      ///< Else files whose names end as those of programs do.
};

/// Where a picture or a film is to go.
struct PictureChoice {
  enum class Kind { kScene, kWindow, kFilm };
  bool is_open = false;
  bool is_new =
      false;  ///< Not drawn yet, or not since it was refused: the field is to be typed in.
  bool is_accepted = false;
  Kind kind = Kind::kScene;
  std::string folder;  ///< Absolute.
  std::string name;    ///< Being typed: a name in the folder, or a path.
  std::string fault;   ///< Why it cannot be written there.
};

/// What is being written into the job's fields.
struct JobEdit {
  std::string stock, cell, model;
  std::map<int, std::string> tools;  ///< SHAPE text by number; empty: not given
  std::vector<std::string> fixtures;
  int new_tool = 1;
  bool is_upper = false;  ///< of those keys
  std::string typed_id;   ///< of the field whose keys are on the screen; empty: of none
};

/// A sentence in the status line. A text of the window itself is shown in the language in use,
/// also when that changes while it stands there.
class Notice {
 public:
  Notice& operator=(Text which) {
    text_ = which;
    words_.clear();
    return *this;
  }
  Notice& operator=(std::string words) {
    text_.reset();
    words_ = std::move(words);
    return *this;
  }
  void clear() { *this = std::string(); }
  bool is(Text which) const { return text_ == which; }
  std::string shown() const { return text_ ? text(*text_) : words_; }

 private:
  std::optional<Text> text_;
  std::string words_;
};

/// What the panels remember while the window is open.
struct PanelState {
  Notice notice;  ///< Of the window itself, in the status line.
  bool shows_help = false;
  bool shows_first_keys = false;
  bool asks_for_line = false;
  bool shows_entry = false;  ///< What a start in the middle would miss.
  int asked_line = 1;
  int first_line = 1;  ///< For ColorBy::kLineRange.
  int last_line = 1;
  CodeScroll code;
  Inspection inspection;
  FileChoice files;
  PictureChoice picture;
  bool searches = false;  ///< The field for it is there.
  bool search_is_new = false;
  std::string search;
  JobEdit job;
  double frames_per_s = 0.0;
  std::optional<Action> action;  ///< Asked for by a button.
};

/// What the panels read and change.
struct PanelContext {
  const ShownValues& shown;
  const DrawCounters& counters;
  const std::vector<ColorLegendEntry>& legend;
  DrawMode drawn_mode;  ///< May be the mesh although another one was asked for.
  Box bounds_mm;        ///< Of the workpiece; may be empty.
  const Fonts& fonts;
  float scale;    ///< Of everything: 1, 2
  bool is_light;  ///< The theme that is shown.
  ViewSettings* settings;
  PanelState* state;
  CommandQueue* commands;
  Measures measures;
  bool has_keyboard;  ///< In a tab of another program there is the mouse alone.

  const char* word(Text which) const { return text(which); }
};

/// Pixels that the panels take from each side of the window.
struct PanelRoom {
  float left = 0, right = 0, bottom = 0, top = 0;
};
/// Panels go where the picture would become too small.
/// `has_curve`: there is a program, whose curve may be shown.
PanelRoom panel_room(glm::vec2 window_px, const ViewSettings& settings, float scale,
                     bool has_curve);
/// The info panel has no room beside the picture: ViewSettings::shows_info_alone.
bool is_narrow_for_info(float window_px, float scale);
/// What of curves and colours there may be for what is shown.
bool is_offered(CurveChoice curve, const ProgramTimeline& timeline);
bool is_offered(ColorBy mode, const ProgramTimeline& timeline, const SceneSetup& setup);
/// The mode that colours by what a curve shows.
ColorBy color_of(CurveChoice curve);
/// Below the time slider, as wide. Clicks go to that time.
void draw_curve(const PanelContext& context);
inline constexpr float kCurveHeight_px = 30.0f;
/// Where the mouse is on a slider from `left` to `right`.
double time_under_mouse(float left, float right, double duration_s);
/// Asks for that time where the item before is being clicked or dragged.
void seek_with_mouse(const PanelContext& context, double time_s);

void draw_player_bar(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_toolbar(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_info_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_code_panel(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_help(const PanelContext& context, glm::vec2 window_px);
/// Over the picture; takes no clicks.
void draw_first_keys(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
void draw_entry(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
/// Over the picture, as draw_inspection().
void draw_entry_way(const PanelContext& context, const Projection& projection, glm::vec2 corner_px);
void draw_line_question(const PanelContext& context, glm::vec2 window_px);
/// Shows the list, beginning in the folder of the program, of the last one, or where kerf runs.
void open_file_choice(const ShownValues& shown, const ViewSettings& settings, FileChoice* files);
void draw_file_choice(const PanelContext& context, glm::vec2 window_px);
/// Shows the question with a name that is free. `ending`: ".png"
void open_picture_choice(PictureChoice::Kind kind, const std::string& folder,
                         const std::string& ending, PictureChoice* choice);
/// Esc is the window's; Enter and the button set is_accepted.
void draw_picture_choice(const PanelContext& context, glm::vec2 window_px);
/// The path that was chosen, its ending added where there is none; nothing, and why, where it
/// cannot be written.
std::optional<std::string> chosen_path(PictureChoice* choice);
/// Where there is no program: that there is none, and how to get one.
void draw_empty_hint(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);
/// Blank, cells, model and tools, to be changed, and the command that is equal to them.
void draw_job_tab(const PanelContext& context);
/// A line of text as wide as its panel, `hint` where it is empty. Without a keyboard a click opens
/// keys to be clicked beneath it. True when Enter ends it.
bool draw_text_field(const PanelContext& context, const std::string& id, const std::string& hint,
                     std::string* value);
/// The fields as the job has them.
JobEdit edit_of(const ViewedJob& job);

/// The edges of the panels, to be dragged.
void draw_edges(const PanelContext& context, glm::vec2 window_px, const PanelRoom& room);

/// Parts of the info panel: objects, colours, section, drawing.
void draw_view_tab(const PanelContext& context);
/// The point that was clicked, and what was measured.
void draw_point_tab(const PanelContext& context);
/// Marks of clicked and measured points over the picture, whose upper left corner is at
/// `corner_px`.
void draw_inspection(const PanelContext& context, const Projection& projection,
                     glm::vec2 corner_px);
/// What the colours of moves mean, in the picture's lower left corner, if there is room.
void draw_scene_legend(const PanelContext& context, glm::vec2 corner_px, glm::vec2 size_px);

/// Asks the owner of the workpiece for the colours that are set.
ColorCommand color_command(const ViewSettings& settings, const PanelState& state);

/// What is to be known of the draw mode in which the workpiece is drawn: why it is not the one that
/// was chosen, what it does not show. Empty if nothing.
std::string draw_note(const PanelContext& context);

/// The planes that hide part of the workpiece, in DrawOptions; none if it is off.
void choose_section(const SectionChoice& choice, const Box& bounds_mm, bool turns,
                    DrawOptions* drawing);

/// Before the figure of a diameter.
inline constexpr const char* kDiameterSign = "\u00d8";

/// "1:02:03", "2:03.4"
std::string clock_text(double seconds);
/// "0.3 s", "12 s", "4 min", "2 h"
std::string age_text(double seconds);

}  // namespace kerf
