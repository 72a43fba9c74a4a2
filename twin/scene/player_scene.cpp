#include "twin/scene/player_scene.h"

#include <algorithm>
#include <utility>

#include "base/translate.h"
#include "stock/cutter/shape_spec.h"
#include "twin/motion/motion_geometry.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/moment_values.h"
#include "twin/scene/program_text.h"
#include "twin/scene/tool_shape.h"
#include "twin/scene/value_colors.h"

namespace kerf {
namespace {

/// What is removed is summed so often, or when so many times as long has passed as that took.
constexpr std::chrono::milliseconds kRemovedPeriod{500};
constexpr int kRemovedShare = 50;

PlayState play_state(const PlayerState& state, std::size_t motions) {
  switch (state.mode) {
    case PlayerMode::kPlaying:
      return PlayState::kPlaying;
    case PlayerMode::kRunning:
    case PlayerMode::kSeeking:
      return PlayState::kHurrying;
    case PlayerMode::kPaused:
      break;
  }
  return motions > 0 && state.place.motion >= motions ? PlayState::kEnded : PlayState::kPaused;
}

/// Of the state's motion, which is the last one where the program is over.
double fraction_of(const ProgramTrack& track, const PlayerState& state) {
  return state.place.motion >= track.size() ? 1 : state.place.fraction;
}

std::string notice_of(const PlayerState& state) {
  if (!state.message.empty()) return state.message;
  if (state.stop == PlayerStop::kBreakpoint) return "breakpoint";
  if (state.behind) return tr("slower than asked: cutting takes its time");
  return {};
}

}  // namespace

ToolPose tool_pose_at(const MotionMoves& moves, const ProgramTrack& track,
                      const PlayerState& state) {
  const ToolPath* const live = state.cutter ? moves.live_path(*state.cutter) : nullptr;
  const ToolPath* const path = live ? live : moves.path();
  if (path == nullptr) return {state.tip_mm, Vec3(0, 0, 1)};
  const Pose pose = path->pose_at(state.motion, fraction_of(track, state));
  return {pose.origin_mm, pose.direction(path->machine().nose_from_tip)};
}

std::shared_ptr<const MachineModel> machine_around(const LoadedProgram& loaded,
                                                   const MachineChoice& choice,
                                                   const std::string& ini,
                                                   Diagnostics& diagnostics) {
  const bool wanted = !ini.empty() || choice.is_chosen();
  if (!wanted || !loaded.player.blank) return nullptr;
  double longest_mm = 0;
  for (const ProgramTool& tool : loaded.tools) {
    if (const auto named = parse_tool_argument("0=" + tool.shape))
      longest_mm = std::max(longest_mm, drawn_height_mm(*tool_shape_of(named->cutter)));
  }
  const TurretPointer turret = loaded.player.process->turret();
  if (turret) {
    for (const auto& [number, station] : turret->stations)
      longest_mm = std::max(longest_mm, drawn_height_mm(*tool_shape_of(station.punch)));
  }
  MachineChoice wished = choice;
  if (loaded.player.blank->turned() && !choice.is_chosen()) wished.kind = MachineKind::kLathe;
  WorkRoom room = work_room(*loaded.player.track, loaded.player.blank->bounds_mm(), longest_mm);
  room.turret = turret;
  room.chuck = chuck_room(loaded.player.checks.collisions.held_by);
  return drawn_machine(wished, ini, room, diagnostics);
}

std::vector<glm::mat4> machine_poses_at(const ViewedProgram& shown, const ProgramTrack& track,
                                        const PlayerState& state, double tool_length_mm) {
  const MachineModel& machine = *shown.machine;
  const ToolPath* const path = shown.moves.path();
  if (path == nullptr) {
    if (shown.turns && state.cutter) {
      const Vec3 held = held_from_tip(*tool_shape_of(*state.cutter));
      const double before_mm = held.z > 0 ? before_turret_mm(machine) : 0;
      return drawn_poses(machine, state.tip_mm + Vec3(0, 0, held.z + before_mm), state.abc_deg,
                         held.x);
    }
    if (!shown.punch) return drawn_poses(machine, state.tip_mm, state.abc_deg, tool_length_mm);
    std::vector<glm::mat4> poses = drawn_poses(machine, state.tip_mm, state.abc_deg, tool_length_mm,
                                               shown.punch->joints(track, state));
    shown.punch->place_punch(machine, track, state, poses);
    return poses;
  }
  const double fraction = fraction_of(track, state);
  const Pose pose = path->pose_at(state.motion, fraction);
  if (!shown.moves.tilts())
    return drawn_poses(machine, pose.origin_mm, state.abc_deg, tool_length_mm);
  const AxisValues axes = path->axes_at(state.motion, fraction);
  return drawn_poses(machine, pose, {axes[3], axes[4], axes[5]}, tool_length_mm);
}

ViewedProgram viewed_program(const LoadedProgram& loaded, std::string title) {
  ViewedProgram shown;
  shown.title = std::move(title);
  shown.files = loaded.files;
  if (loaded.player.blank) {
    shown.blank_outline = blank_outline_of(*loaded.player.blank);
    shown.turns = loaded.player.blank->turned() != nullptr;
    shown.blank = loaded.player.blank->snapshot();
  }
  shown.cuts = loaded.cuts;
  shown.collisions = loaded.player.checks.collisions;
  shown.cutting = loaded.player.checks.cutting;
  shown.measures_loads = loaded.player.measures_loads;
  shown.walls = SheetQuery::of(loaded.player);
  shown.planned = loaded.player.timeline.planner.with_path;
  if (loaded.player.blank) {
    shown.moves = MotionMoves::of(*loaded.player.blank, loaded.player.timeline.kinematics,
                                  loaded.player.track->frame());
  }
  if (const TurretPointer turret = loaded.player.process->turret(); turret && loaded.player.blank) {
    constexpr double kThrough_mm = 1;  // beyond the underside
    shown.punch = std::make_shared<const PunchPose>(
        turret, *loaded.player.track, loaded.player.blank->bounds_mm().min.z - kThrough_mm);
  }
  const WorkpieceFrame& used = loaded.player.track->frame();
  for (const NamedOffset& offset : loaded.work_offsets) {
    if (offset.frame.g5x_mm == used.g5x_mm && offset.frame.g92_mm == used.g92_mm &&
        offset.frame.rotation_deg == used.rotation_deg && shown.work_offset.empty()) {
      shown.work_offset = offset.name;
    }
  }
  for (const ProgramTool& tool : loaded.tools) {
    std::string name = tool.remark;
    if (name.empty()) name = tool.shape.substr(0, tool.shape.find(":flute="));
    std::replace(name.begin(), name.end(), ':', ' ');
    shown.tools.push_back({tool.number, std::move(name)});
  }
  return shown;
}

PlayerScene::PlayerScene(std::shared_ptr<const ProgramTrack> track, ViewedProgram shown)
    : track_(std::move(track)),
      shown_(std::move(shown)),
      draw_modes_({track_, shown_.cuts, shown_.blank, shown_.moves.path() != nullptr,
                   shown_.design != nullptr}),
      bodies_(shown_.collisions),
      path_(track_, shown_.planned, shown_.moves),
      curves_(track_, shown_.tools, shown_.cuts) {
  feeder_.compare_with(shown_.design, shown_.tolerance_mm);
  if (shown_.turns) diameters_ = DiameterMode(*track_, *read_program_text(shown_.files));
  if (shown_.machine)
    bodies_.set_machine(std::make_shared<const SceneMachine>(scene_machine(*shown_.machine)));
}

SceneUpdate PlayerScene::start(const PlayerState& state) const {
  SceneUpdate update;
  update.clears = true;
  auto setup = std::make_shared<SceneSetup>();
  setup->title = shown_.title;
  setup->keeps_eye = shown_.keeps_eye;
  if (state.stock) setup->bounds_mm = state.stock->bounds_mm();
  setup->turns = shown_.turns;
  if (shown_.turns) setup->standing = shown_.machine ? Standing::kOnLatheBed : Standing::kInLathe;
  setup->blank_outline = shown_.blank_outline;
  if (shown_.design) setup->tolerance_mm = shown_.tolerance_mm;
  setup->frames = scene_frames(track_->frame(), shown_.work_offset);
  update.setup = std::move(setup);
  update.program = read_program_text(shown_.files);
  auto timeline = std::make_shared<ProgramTimeline>();
  timeline->duration_s = track_->duration_s();
  timeline->has_curves = timeline->duration_s > 0;
  timeline->has_loads = timeline->has_curves && shown_.measures_loads && !shown_.turns;
  timeline->has_forces = timeline->has_loads && shown_.cutting.material;
  for (const std::uint32_t motion : track_->tool_changes()) {
    ToolMark mark;
    mark.time_s = track_->start_s(motion);
    mark.tool = track_->tool(motion);
    const auto known = std::find_if(shown_.tools.begin(), shown_.tools.end(),
                                    [&](const NamedTool& t) { return t.number == mark.tool; });
    if (known != shown_.tools.end()) mark.name = known->name;
    timeline->tools.push_back(std::move(mark));
  }
  update.timeline = std::move(timeline);
  update.machine = bodies_.drawn_machine();
  update.fixtures = bodies_.scene();
  return update;
}

std::optional<SourceRef> PlayerScene::source_of(const std::string& file, int line) const {
  if (line < 1) return std::nullopt;
  const auto& files = shown_.files;
  const auto found = file.empty() ? files.begin() : std::find(files.begin(), files.end(), file);
  if (found == files.end()) return std::nullopt;
  return SourceRef{static_cast<std::uint32_t>(found - files.begin()),
                   static_cast<std::uint32_t>(line)};
}

void PlayerScene::set_controls(double speed, std::vector<SourceRef> breakpoints) {
  speed_ = speed;
  breakpoints_ = std::move(breakpoints);
  moment_stale_ = true;
}

void PlayerScene::set_colors(const ColorCommand& command, const std::vector<float>& removed_mm3) {
  colors_ = command;
  colored_at_ = Clock::now();
  std::shared_ptr<CutColors> colors;
  if (command.mode >= ColorBy::kFeed && command.mode <= ColorBy::kBend) {
    const MoveFacts facts{removed_mm3, shown_.cuts.get(), loads_.get(), &shown_.cutting};
    colors = value_colors(command.mode, *track_, facts);
  } else {
    colors = cut_colors(command, *track_, shown_.tools, removed_mm3);
  }
  if (colors) colors->is_of_path = true;
  waiting_.colors = std::move(colors);
}

void PlayerScene::show_loads(std::shared_ptr<const LoadRecord> loads) {
  loads_ = loads;
  curves_.show_loads(std::move(loads), shown_.cutting);
}

/// What goes by what has been cut, while more is: no more often than it takes little.
void PlayerScene::color_again(const std::vector<float>& removed_mm3) {
  constexpr std::chrono::seconds kPeriod{2};
  const bool grows = colors_.mode >= ColorBy::kRemovalRate && colors_.mode <= ColorBy::kBend;
  if (grows && (curves_.is_complete() || Clock::now() - colored_at_ >= kPeriod))
    set_colors(ColorCommand(colors_), removed_mm3);
}

void PlayerScene::add_curves(const PlayerState& state, const std::vector<float>& removed_mm3) {
  constexpr std::chrono::milliseconds kSlice{4};
  if (auto made = curves_.make(state.motions_checked, removed_mm3, Clock::now() + kSlice))
    waiting_.curves = std::move(made);
  color_again(removed_mm3);
}

void PlayerScene::pick(const Vec3& point_mm, const PlayerState& state) {
  auto picked = std::make_shared<PickedPoint>();
  picked->point_mm = point_mm;
  if (shown_.design) picked->deviation_mm = shown_.design->distance_mm(point_mm);
  find_cut(point_mm, state, *picked);
  waiting_.picked = std::move(picked);
}

void PlayerScene::find_cut(const Vec3& point_mm, const PlayerState& state,
                           PickedPoint& picked) const {
  const double tolerance_mm = state.stock ? state.stock->cell_mm() : 0.0;
  std::optional<std::size_t> motion;
  if (shown_.walls) {
    if (const auto wall = shown_.walls->wall_at(point_mm, state.place)) {
      motion = wall->motion;
      picked.tool_name = wall->cutter;
    }
  } else if (shown_.turns) {
    // CutQuery looks from above. The model itself may know; its numbers are those of motions.
    picked.is_known = state.stock && state.stock->keeps_cut_ids();
    if (picked.is_known) motion = state.stock->cut_id_at(point_mm);
    if (motion >= track_->size()) motion.reset();
  } else if (shown_.cuts) {
    motion = shown_.cuts->last_cut_at(point_mm, tolerance_mm, state.place);
  }
  if (!motion) return;
  const Cutter* const cutter =
      shown_.cuts && !shown_.walls ? shown_.cuts->cutter_at(*motion) : nullptr;
  if (cutter) picked.tool_name = tool_name_of(*cutter);
  const SourceRef source = track_->source(*motion);
  picked.tool = track_->tool(*motion);
  picked.file = static_cast<int>(source.file);
  picked.line = static_cast<int>(source.line);
  picked.time_s = track_->start_s(*motion);
}

bool PlayerScene::is_empty(const SceneUpdate& update) {
  return !update.moment && update.patches.empty() && update.path.empty() && !update.findings &&
         !update.tool_shape && !update.colors && !update.picked && !update.draw_mode &&
         !update.heights && !update.cut_moves && !update.curves;
}

SceneUpdate PlayerScene::update(const std::shared_ptr<const PlayerState>& state,
                                Clock::time_point deadline) {
  SceneUpdate update = std::exchange(waiting_, {});
  if (state != state_ || moment_stale_ || is_removed_due(*state)) {
    if (!state_ || state->stock_number != shown_stock_) {
      shown_stock_ = state->stock_number;
      feeder_.follow(state->stock);
    }
    if (state->findings != shown_findings_) {
      shown_findings_ = state->findings;
      if (state->findings) {
        update.findings = finding_list(*state->findings, shown_.files);
        bodies_.set_findings(*state->findings);
      }
    }
    if (auto shape = bodies_.mount(state->cutter, state->motion.tool_offset_mm.z)) {
      update.tool_shape = std::move(shape);
      tool_length_mm_ = drawn_height_mm(*update.tool_shape);
      if (shown_.punch && shown_.machine) {
        // The machine has the punch, in its true shape.
        auto holder = std::make_shared<ToolShape>(*update.tool_shape);
        holder->cutter.clear();
        update.tool_shape = std::move(holder);
      }
    }
    state_ = state;
    update.moment = moment_of(*state);
    moment_stale_ = false;
  }
  draw_modes_.update(state->stock, state->place, &update);
  if (draws_mesh()) update.patches = feeder_.make_until(deadline);
  if (!path_.complete()) {
    update.path = path_.next_chunks();
    moment_stale_ = true;  // vertices that are past are counted as far as there are any
  }
  return update;
}

/// Summing over all cells takes milliseconds, over long walls tens of them: not for every frame of
/// one that plays, nor for every one of many steps.
bool PlayerScene::is_removed_due(const PlayerState& state) const {
  return state.stock && state.stock_number != removed_stock_ && Clock::now() > removed_due_;
}

double PlayerScene::removed_mm3(const PlayerState& state) {
  if (is_removed_due(state)) {
    const Clock::time_point begin = Clock::now();
    removed_mm3_ = state.stock->blank_mm3() - state.stock->remaining_mm3();
    removed_stock_ = state.stock_number;
    const Clock::time_point end = Clock::now();
    removed_due_ = end + std::max<Clock::duration>(kRemovedPeriod, kRemovedShare * (end - begin));
  }
  return removed_mm3_;
}

ToolPose PlayerScene::tool_pose(const PlayerState& state) const {
  if (shown_.punch) return {shown_.punch->tip_mm(*track_, state), Vec3(0, 0, 1)};
  return tool_pose_at(shown_.moves, *track_, state);
}

std::shared_ptr<const Moment> PlayerScene::moment_of(const PlayerState& state) {
  auto moment = std::make_shared<Moment>();
  const Motion& motion = state.motion;
  moment->state = play_state(state, track_->size());
  moment->speed = speed_;
  moment->is_behind = state.behind || state.mode == PlayerMode::kRunning;
  moment->time_s = state.elapsed_s;
  moment->file = static_cast<int>(motion.source.file);
  moment->line = track_->empty() ? 0 : static_cast<int>(motion.source.line);
  moment->past_vertices = path_.past_vertices(state.place);
  moment->tool_pose = tool_pose(state);
  moment->tool = motion.tool;
  if (state.cutter) moment->tool_name = tool_name_of(*state.cutter);
  if (motion.spindle != SpindleState::kStopped) {
    const bool clockwise = motion.spindle == SpindleState::kClockwise;
    moment->spindle_rpm = clockwise ? motion.spindle_rpm : -motion.spindle_rpm;
  }
  set_feed(motion, moment.get());
  moment->coolant = coolant_text(motion.mist, motion.flood);
  moment->work_offset = shown_.work_offset;
  if (shown_.machine) {
    moment->link_poses = machine_poses_at(shown_, *track_, state, tool_length_mm_);
    bodies_.set_link_poses(moment->link_poses);
  }
  has_rotary_ = has_rotary_ || state.abc_deg != std::array<double, 3>{};
  has_slides_ = has_slides_ || state.uvw_mm != Vec3(0);
  const bool is_playing = state.mode == PlayerMode::kPlaying;
  moment->fixture_poses = bodies_.poses();
  if (!track_->empty() && motion.start_known) {
    bodies_.look(*moment->tool_pose, state.elapsed_s, is_playing ? speed_ : 0, state.stock.get(),
                 moment.get());
  }
  const SlidePlace slides{state.uvw_mm + track_->frame().offset_uvw_mm + motion.tool_offset_uvw_mm,
                          state.uvw_mm};
  moment->axes = axis_readouts(
      machine_position(track_->frame(), state.tip_mm, motion.tool_offset_mm), state.tip_mm,
      has_rotary_ ? &state.abc_deg : nullptr, has_slides_ ? &slides : nullptr);
  for (std::size_t i = 0; i < 3; ++i) {
    moment->axes[i].to_go = motion.to_mm[static_cast<int>(i)] - state.tip_mm[static_cast<int>(i)];
  }
  if (diameters_.holds_at(std::min(state.place.motion, track_->size() - 1)))
    show_diameter(moment->axes[0]);
  for (const SourceRef& breakpoint : breakpoints_) {
    moment->breakpoints.push_back(
        {static_cast<int>(breakpoint.file), static_cast<int>(breakpoint.line)});
  }
  std::sort(moment->breakpoints.begin(), moment->breakpoints.end());
  moment->removed_mm3 = removed_mm3(state);
  moment->notice = notice_of(state);
  return moment;
}

}  // namespace kerf
