// viewer/scene.h - what the window shows, as values: it knows no stock model and no interpreter.
//
// Whoever owns the workpiece (or watches a machine) makes these values and hands them over through
// a SceneMailbox (scene_mailbox.h). All are immutable once handed over, so they cross threads
// without locks. Lengths in mm in the workpiece frame, times in seconds of the program.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/geometry.h"
#include "base/length_unit.h"
#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "surface/height_grid.h"
#include "viewer/source_file.h"
#include "viewer/standing.h"

namespace kerf {

/// One point of an outline that is turned around the tool's axis.
struct ProfilePoint {
  float radius_mm = 0.0f;
  float height_mm = 0.0f;  ///< Above the tip, along the axis.
  bool operator==(const ProfilePoint&) const = default;
};

/// A flat piece of a tool that does not turn, an insert or what holds it: a convex outline in the
/// plane of the tool's axis and its x, counter-clockwise with z to the right and x up, as thick as
/// from `low_y_mm` to `high_y_mm`.
struct ToolPlate {
  struct Corner {
    glm::vec2 zx_mm{0.0f};
    bool cuts = false;  ///< the edge that begins here
  };
  std::vector<Corner> corners;
  float low_y_mm = 0.0f, high_y_mm = 0.0f;
  bool is_holder = false;
};

/// Outlines from below to above. Corners between segments are drawn sharp, so arcs come as short
/// segments of a few degrees. Open ends are closed with a disc. Any of the four may be empty.
struct ToolShape {
  std::vector<ProfilePoint> cutter;
  std::vector<ProfilePoint> shank;
  std::vector<ProfilePoint> holder;
  std::vector<ProfilePoint> spindle;
  std::vector<ToolPlate> plates;  ///< Beside them, or instead of all.
};

/// One of these four.
enum class ToolPiece : std::uint8_t { kCutter, kShank, kHolder, kSpindle };
inline constexpr std::size_t kToolPieceCount = 4;

struct ToolPose {
  Vec3 tip_mm{0.0};
  Vec3 axis{0.0, 0.0, 1.0};  ///< Unit length, from the tip to the spindle.
  bool operator==(const ToolPose&) const = default;
};

enum class PathKind : std::uint32_t { kTraverse, kFeed, kPlanned };

/// The segment that ends at the vertex is of its `kind`, and a part of that move (CutColors).
struct PathVertex {
  static constexpr std::uint32_t kNoMove = (1u << 30) - 1;
  glm::vec3 position_mm{0.0f};
  PathKind kind : 2 = PathKind::kFeed;
  std::uint32_t move : 30 = kNoMove;
};
static_assert(sizeof(PathVertex) == 16);

/// Segments of a full chunk of the toolpath. The last vertex of a chunk is the first of the next.
inline constexpr std::size_t kPathChunkSegments = 4096;

/// Part of the toolpath: vertices [index * kPathChunkSegments, ... + vertices.size()). All chunks
/// but the last have kPathChunkSegments + 1 vertices; a path that grows sends its last one again.
struct PathChunk {
  std::uint32_t index = 0;
  std::vector<PathVertex> vertices;
};

struct LineSegment {
  glm::vec3 from_mm{0.0f};
  glm::vec3 to_mm{0.0f};
};

/// The twelve edges; none if the box is empty.
std::vector<LineSegment> box_outline(const Box& box);

/// A frame drawn as three arrows: machine zero, a work offset.
struct SceneFrame {
  std::string name;  ///< "machine", "G54"
  Vec3 origin_mm{0.0};
  Vec3 x_axis{1.0, 0.0, 0.0};  ///< Unit vectors; z is their cross product.
  Vec3 y_axis{0.0, 1.0, 0.0};
  double length_mm = 0.0;  ///< Of the arrows; 0: chosen by the size of the blank.
};

/// What stays as long as the workpiece is clamped.
struct SceneSetup {
  Standing standing = Standing::kOnTable;
  /// The workpiece turns about Z: distances from there are read as diameters.
  bool turns = false;
  std::string title;  ///< Of the window: the program, the machine.
  Box bounds_mm;      ///< Room that "fit" shows: the blank, mostly. Parts outside are drawn too.
  std::vector<LineSegment> blank_outline;
  std::vector<SceneFrame> frames;
  /// The workpiece is compared with a design part: it is coloured by MeshPatch::deviation_mm at
  /// once, against this tolerance.
  std::optional<double> tolerance_mm;
  /// It is what was shown before, changed: the eye stays where it is.
  bool keeps_eye = false;
};

struct SceneFinding {
  Severity severity = Severity::kWarning;
  std::string file;  ///< As in ProgramText.
  int line = 0;      ///< 1-based; 0 = none.
  double time_s = 0.0;
  std::optional<Vec3> position_mm;  ///< Where a marker is drawn.
  std::string text;                 ///< One line, already in the user's language; mm.
  std::string inch_text = {};       ///< The same in inches; empty: as `text`.

  const std::string& text_in(LengthUnit unit) const {
    return unit == LengthUnit::kInch && !inch_text.empty() ? inch_text : text;
  }
};

struct FindingList {
  std::vector<SceneFinding> findings;  ///< In the order of time.
};

/// The program and the subroutine files that it calls. The first is the main program.
struct ProgramText {
  std::vector<SourceFile> files;
};

/// A line of one of ProgramText::files.
struct CodeLine {
  int file = 0;
  int line = 1;
  auto operator<=>(const CodeLine&) const = default;
};

/// Where tools change, for the time slider.
struct ToolMark {
  double time_s = 0.0;
  int tool = 0;
  std::string name;
};

struct ProgramTimeline {
  double duration_s = 0.0;  ///< 0: not known (a machine is watched).
  std::vector<ToolMark> tools;
  bool has_curves = false;  ///< ProgramCurves come: there is to be room for them.
  /// What of CutLoadKind there may be: how tools are engaged is measured, and the material is
  /// known.
  bool has_loads = false, has_forces = false;
};

/// What the cuts of milling tools are like.
enum class CutLoadKind : std::uint8_t {
  kAngle,   ///< of the edge that is in material, degrees; beyond 180: straight down
  kChip,    ///< its greatest thickness, mm
  kForce,   ///< N
  kTorque,  ///< Nm
  kPower,   ///< kW
  kBend,    ///< of the tool's tip, mm
};
inline constexpr std::size_t kCutLoadKinds = 6;
/// The others need no material.
inline constexpr bool needs_material(CutLoadKind kind) { return kind > CutLoadKind::kChip; }

/// The greatest of each column, 0 where there is none; empty: nothing is known.
struct SceneLoadCurve {
  std::vector<float> nominal;
  std::vector<float> high;  ///< End of the range that it is in.
  double limit = 0.0;       ///< 0: none is known.
};

/// What a program does over its time, in columns of `step_s` from its start on; each vector has one
/// value a column, 0 where there is nothing.
struct ProgramCurves {
  double step_s = 1.0;
  double known_until_s = 0.0;            ///< Of what comes later nothing is known yet.
  std::vector<float> mm3_per_s;          ///< Removal rate, over the column.
  std::vector<float> feed_mm_per_min;    ///< Of feed moves.
  std::vector<float> feed_per_tooth_mm;  ///< Where material was removed; empty: no teeth are known.
  std::vector<std::uint32_t> color;      ///< Of the tool, as CutColors has it: 0xAABBGGRR.
  std::array<SceneLoadCurve, kCutLoadKinds> loads;  ///< By CutLoadKind.
};

enum class PlayState {
  kPaused,
  kPlaying,
  kHurrying,   ///< As fast as possible to a point asked for.
  kFollowing,  ///< A machine leads; there is nothing to play.
  kEnded,
};

enum class SourceFreshness {
  kNone,   ///< A program is run, no machine is watched.
  kLive,   ///< The newest sample is fresh.
  kStale,  ///< It is older than the source promises; the picture is old.
  kLost,   ///< The connection is gone.
};

struct AxisReadout {
  char name = 'X';
  bool is_rotary = false;    ///< degrees instead of mm
  bool is_diameter = false;  ///< the figures are diameters (G7)
  double machine = 0.0;
  double work = 0.0;
  std::optional<double> to_go;  ///< Of the present block; none where it is not known.
};

/// What the colour of the workpiece's surface says.
enum class ColorBy {
  kPlain,         ///< cut or not
  kHeight,        ///< along z, from the lowest to the highest point of the blank
  kTool,          ///< that cut there last
  kRemovalRate,   ///< of the move that cut there last, as all down to kBend
  kFeed,          ///< planned
  kFeedPerTooth,  ///< of tools of known teeth
  kAngle,         ///< from here to kBend: CutLoadKind
  kChip,
  kForce,
  kTorque,
  kPower,
  kBend,
  kLineRange,  ///< whether lines first .. last of the program cut there last
  kDeviation,  ///< MeshPatch::deviation_mm against a tolerance
};
inline constexpr std::size_t kColorModes = 14;
/// It goes by the moves of a program: its CutColors are for the path as well.
inline constexpr bool is_by_move(ColorBy mode) {
  return mode >= ColorBy::kTool && mode <= ColorBy::kLineRange;
}
inline constexpr std::optional<CutLoadKind> load_of(ColorBy mode) {
  if (mode < ColorBy::kAngle || mode > ColorBy::kBend) return std::nullopt;
  return static_cast<CutLoadKind>(static_cast<int>(mode) - static_cast<int>(ColorBy::kAngle));
}

/// What a colour of CutColors stands for, where that is a number: above `from`, up to `to`, in the
/// unit of the mode; mm, mm/min.
struct LegendRange {
  enum class Kind : std::uint8_t { kWithin, kBeyondLimit, kStraightDown };
  double from = 0.0, to = 0.0;
  Kind kind = Kind::kWithin;
};

/// Colours as 0xAABBGGRR, the order of bytes that OpenGL's RGBA8 has.
struct ColorLegendEntry {
  std::uint32_t color = 0;
  std::string text;  ///< "T3 flat 10", "120 mm3/s"
  /// The text says this upper bound; a window that shows inches says it anew.
  std::optional<double> mm3_per_s = std::nullopt;
  /// Who shows it makes the text of it.
  std::optional<LegendRange> range = std::nullopt;
};

/// For the modes that go by MeshPatch::cut_by (is_by_move()): a colour for each move.
struct CutColors {
  ColorBy mode = ColorBy::kTool;
  std::vector<std::uint32_t> of_move;  ///< by the number of the move; those beyond are `other`
  bool is_of_path = false;             ///< by PathVertex::move as well
  std::uint32_t other = 0xff9a9a9a;
  std::uint32_t not_cut = 0xffb8b0a8;
  std::vector<ColorLegendEntry> legend;
};

/// How the workpiece gets into the picture. All three draw it at the same place; tool, path, marks
/// and machine are drawn over and into each in the same way.
enum class DrawMode {
  kMesh,     ///< SceneUpdate::patches: with colours, section and deviations.
  kRaycast,  ///< SceneUpdate::heights, by rays on the CPU.
  kCsg,      ///< SceneUpdate::cut_moves, subtracted from the blank in the picture.
};

/// What a draw mode cannot do with the workpiece there is.
enum class DrawLimit {
  kNone,
  kNoHeights,  ///< Rays need one height a cell; DrawAnswer::detail names the model.
  kCompared,   ///< Deviations from a design part are drawn by mesh alone.
  kNoBox,      ///< CSG begins with a full Z-map; DrawAnswer::detail says what the blank is.
  kTilted,     ///< CSG cuts with upright tools, and here tools or workpiece turn.
  kTool,       ///< A tool cannot be subtracted; DrawAnswer::detail says which and why.
  kWatched,    ///< CSG has no moves of a machine that is watched.
  kNewest,     ///< CSG shows the newest moves: those since DrawAnswer::line, and what it has kept.
};

/// The answer to a DrawModeCommand, and again whenever it becomes another one.
struct DrawAnswer {
  DrawMode draw_mode = DrawMode::kMesh;  ///< That was asked for.
  DrawLimit limit = DrawLimit::kNone;
  std::string detail;
  int line = 0;
  /// Else the values for this draw mode do not come, those for the mesh do.
  bool is_drawn() const { return limit == DrawLimit::kNone || limit == DrawLimit::kNewest; }
  bool operator==(const DrawAnswer&) const = default;
};

/// The blank and the moves that cut it (viewer/csg/cut_moves.h).
struct CutMoves;

/// Part of a machine that moves as one: table, saddle, head.
struct MachineLink {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;  ///< In the link's own frame.
  std::uint32_t color = 0xffa0a0a0;
};

/// In the place of a pose: nobody knows where that body is, and it is not drawn.
inline constexpr glm::mat4 kNotDrawn{0.0f};

/// The machine around the workpiece. Where its links are: Moment::link_poses.
struct SceneMachine {
  std::string name;  ///< "knee mill"
  std::vector<MachineLink> links;
};

/// Two bodies that touch each other, or that come near: a piece of the tool, a fixture, links of
/// the machine, the workpiece. Those that are not drawn may be left out.
struct SceneContact {
  std::optional<ToolPiece> piece;
  std::optional<std::size_t> fixture;  ///< Of SceneUpdate::fixtures.
  std::vector<std::size_t> links;      ///< Of SceneUpdate::machine.
  bool has_workpiece = false;
  std::optional<Vec3> point_mm;  ///< Where; none: not known.
  double mark_mm = 1.0;          ///< Radius of the mark there.
  bool is_near = false;          ///< They do not touch.
  bool operator==(const SceneContact&) const = default;
};

/// How near the tool is to what stands around the workpiece.
struct SceneClearance {
  double mm = 0.0;         ///< 0: they touch.
  bool is_beyond = false;  ///< It is more than `mm`, and of whom is not said.
  std::string piece;       ///< "holder", in the user's language.
  std::string fixture;     ///< Its name.
};

/// What is known of a point of the surface that was asked for.
struct PickedPoint {
  Vec3 point_mm{0.0};
  bool is_known = true;     ///< False: nobody knows who cut there.
  std::optional<int> tool;  ///< That cut there last; none: not cut.
  std::string tool_name;
  int file = 0;  ///< Into ProgramText::files.
  int line = 0;  ///< Whose move cut there last; 0: not cut, or not known.
  double time_s = 0.0;
  std::optional<double> deviation_mm;
};

/// A way of the tool before a start in the middle of the program.
struct EntryWayShown {
  std::vector<Vec3> points_mm;
  bool is_clear = true;
};

/// A line before, at which it may be begun instead.
struct EntryStartShown {
  int line = 0;
  double costs_s = 0.0;
  bool changes_tool = false;  ///< Else the tool is above the workpiece there.
};

/// What a start at a line misses and meets.
struct EntryAnswer {
  int line = 0;          ///< 0: nothing is asked any more.
  bool is_busy = false;  ///< It is being worked out.
  std::string trouble;   ///< Why it cannot be told; else empty.
  std::vector<std::string> text;
  EntryWayShown safe, drive;  ///< By hand; as the machine would go by itself. May be empty.
  std::vector<EntryStartShown> earlier;  ///< The nearest first.
};

/// Of a tool that the program uses, or that somebody described.
struct JobTool {
  int number = 0;
  std::string given;   ///< SHAPE text of the command line or of the window; empty: none
  std::string in_use;  ///< by which it cuts; empty: not known
  std::string origin;  ///< where that comes from: "--tool", "comment in line 3"
};

/// What is cut out of what, in the words of the command line; for the window to show and to change.
struct ViewedJob {
  std::string program;                ///< Its file; empty: none is open.
  std::string stock, cell, model;     ///< As given; empty: chosen by itself.
  LengthUnit unit = LengthUnit::kMm;  ///< Of the lengths in all of these.
  std::string stock_in_use, cell_in_use, model_in_use;
  std::vector<JobTool> tools;         ///< By number.
  std::vector<std::string> fixtures;  ///< As given.
  std::vector<std::string> models;    ///< That can be given.
  std::string command;                ///< The equal command line.
  /// Why what was asked for last is not shown; empty: it is.
  std::vector<std::string> faults;
  bool is_fixed = false;   ///< A log or a machine: the command is there, the fields are not.
  bool can_open = true;    ///< OpenCommand is obeyed.
  bool can_enter = false;  ///< EntryCommand is obeyed.
  /// Of a part that is made in several setups: their names, in order. Empty: it is one program.
  std::vector<std::string> setups;
  std::size_t setup = 0;  ///< The one that is shown, from 0.
};

/// Everything that changes from frame to frame, other than the workpiece.
struct Moment {
  PlayState state = PlayState::kPaused;
  double speed = 1.0;      ///< Of playing, times real time.
  bool is_behind = false;  ///< Cutting takes longer than this speed leaves it.
  double time_s = 0.0;
  int file = 0;                     ///< Into ProgramText::files.
  int line = 0;                     ///< 0: before the program.
  std::uint64_t past_vertices = 0;  ///< Path vertices that the tool has left behind.
  std::optional<ToolPose> tool_pose;
  std::vector<glm::mat4> link_poses;     ///< Of SceneMachine::links, from link to workpiece frame.
  std::vector<glm::mat4> fixture_poses;  ///< Of SceneUpdate::fixtures, so too; or kNotDrawn.
  std::vector<SceneContact> contacts;    ///< Of this moment: both bodies are red.
  std::optional<SceneClearance> clearance;  ///< None: there are no fixtures, or no tool is known.
  int tool = 0;
  std::string tool_name;       ///< "flat 10", "" if no tool.
  double spindle_rpm = 0.0;    ///< Negative: counter-clockwise.
  double feed_mm_per_min = 0;  ///< Programmed; 0 while traversing, or where nobody knows it.
  /// Of a machine that is watched: from its positions of the last moments.
  std::optional<double> measured_mm_per_min;
  std::string spindle_load;  ///< "23.1 % (18 to 41)", measured and expected; "": not known.
  bool is_traverse = false;
  std::string coolant;      ///< "mist", "flood", "".
  std::string work_offset;  ///< "G54"
  std::vector<AxisReadout> axes;
  double removed_mm3 = 0.0;
  SourceFreshness source = SourceFreshness::kNone;
  std::string source_name;            ///< "modbus 192.168.0.10", "" without a source.
  double source_age_s = 0.0;          ///< Of the newest sample when this value was made.
  std::vector<CodeLine> breakpoints;  ///< Ascending.
  std::string notice;  ///< A sentence for the status line: why it stopped, what is missing.
};

/// News for the window. Null and empty members: unchanged since the last update.
struct SceneUpdate {
  bool clears = false;  ///< Forget all patches, path and findings before applying the rest.
  /// Of a tile the last one that comes counts, whatever its version: after a jump back it may be a
  /// version that was shown before. A patch without triangles empties its tile.
  std::vector<std::shared_ptr<const MeshPatch>> patches;
  std::shared_ptr<const HeightGrid> heights;      ///< Of the whole workpiece.
  std::shared_ptr<const CutMoves> cut_moves;      ///< All that are shown.
  std::shared_ptr<const DrawAnswer> draw_mode;    ///< The answer to a DrawModeCommand.
  std::optional<std::uint32_t> path_chunk_count;  ///< Chunks from this number on are dropped.
  std::vector<std::shared_ptr<const PathChunk>> path;
  std::shared_ptr<const SceneSetup> setup;
  std::shared_ptr<const ViewedJob> job;
  std::shared_ptr<const ToolShape> tool_shape;
  std::shared_ptr<const FindingList> findings;
  std::shared_ptr<const ProgramText> program;
  std::shared_ptr<const ProgramTimeline> timeline;
  std::shared_ptr<const ProgramCurves> curves;
  std::shared_ptr<const SceneMachine> machine;
  /// What holds the workpiece: a link each. Where they are: Moment::fixture_poses.
  std::shared_ptr<const SceneMachine> fixtures;
  std::shared_ptr<const CutColors> colors;    ///< The answer to a ColorCommand.
  std::shared_ptr<const PickedPoint> picked;  ///< The answer to a PickCommand.
  std::shared_ptr<const EntryAnswer> entry;   ///< The answer to an EntryCommand.
  std::shared_ptr<const Moment> moment;
};

/// Applies `newer` to `older`, as if the window had taken one after the other: per tile and chunk
/// only the newest stays. O(size of both).
void merge(SceneUpdate* older, SceneUpdate newer);

}  // namespace kerf
