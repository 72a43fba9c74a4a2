// interp_bridge/motion_fold.h - canonical commands in, motions out: units, offsets, rotation, tool,
// spindle, feed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/block_words.h"
#include "interp_bridge/canonical.h"
#include "interp_bridge/filter_modes.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/tool_lengths.h"
#include "interp_bridge/unknown_sum.h"

namespace kerf {

/// What a command means that no Motion can say.
enum class FoldRemark : std::uint8_t {
  kNone,
  kSplineLost,  ///< G5, G5.2, G6: the listing holds no control points; where the tip is now is not
                ///< known
  kArcPlaneUnknown,  ///< an arc in a plane of U, V, W; its end is not known
};

/// What QtPlasmaC's filter does to a program before LinuxCNC sees it, as far as the motions show
/// it:
///  - full circles (with FilterModes::arcs, arcs too) of small diameter run at a part of their
///  feed,
///    by M67 E3, up to the next step that is none
///  - such a full circle is run on for 4 mm with the torch out (M62 P3), up to the next M5
///  - of a program in pierce-only mode the pierces are left: a feed of no length where M3 $0 is
///  - a program without a G64 gets G64 P0.1 (mm; 0.004 in on inch machines)
/// Not while cutter compensation is on. The filter reads text and these are made of commands, so
/// that circles of computed numbers count too (the filter calls them errors). Not done: the filter
/// takes Z words out of the program (unless it has #<keep-z-motion>=1), moves Z up first, and turns
/// lines that it holds for illegal into comments.
struct FilterSetup {
  bool on = false;
  bool inch_machine = false;
};

/// A NURBS of G5, G5.1 or G5.2 in the XY plane, as LinuxCNC hands it over: program coordinates and
/// units, clamped uniform knots, degree order - 1.
struct Spline {
  struct Point {
    double x = 0;
    double y = 0;
    double weight = 1;
  };
  unsigned order = 0;             ///< 2 to points.size()
  std::span<const Point> points;  ///< the first is where the tip stands
};

/// Farthest that the chords of a spline may lie from it.
inline constexpr double kSplineChord_mm = 1e-3;

/// Folds the modal state of a listing into motions.
///
/// A printed point p (program coordinates, unit u = 25.4 or 1 mm in force) is, as LinuxCNC computes
/// it,
///
///     tip in the machine frame   = R(rotation) * (p * u + g92) + g5x        R turns about Z; a, b,
///     c only add offsets machine position           = tip + tool length offset
///
/// and the workpiece frame is the frame (g5x, g92, rotation) in force at the first motion: while it
/// stays in force, Motion positions are the printed numbers in mm, bit for bit. It stands still in
/// the machine, so an offset that changes later moves the program's numbers, not the tip. A tool
/// length offset that changes under a standing machine moves the tip (the new tool's, or the newly
/// measured one) by the difference; that is the only case in which a step does not begin where the
/// one before ended.
///
/// U, V and W add their offsets as a, b and c do, in mm.
///
/// Feed: in mm/min, or mm per revolution with `feed_per_rev`; degrees/min where a step only turns
/// A, B or C. A thread's feed is its pitch, per revolution. Rpm under G96 (constant surface speed)
/// is that at the end of the step. Steps before the first motion have start_known = false and stand
/// at the origin; the first motion has it too, with from_mm = to_mm, unless stand_at() has said
/// where the machine is. Its unnamed axes count as known afterwards, at 0, as the listing says;
/// unless start_unknown() has been called: then each of X, Y and Z is unknown until a block of the
/// program places it.
class MotionFold {
 public:
  /// `tool_by_index`: tool number of each row of the interpreter's tool table, [0] = none, for
  /// CHANGE_TOOL_NUMBER (M61), which prints the row. Empty: the printed number is taken for the
  /// tool's.
  explicit MotionFold(std::vector<int> tool_by_index = {});

  /// Before the first command: the machine stands at `machine_position` (X Y Z A B C U V W of the
  /// machine frame, mm and degrees), so that the first motion has a start.
  void stand_at(const std::array<double, 9>& machine_position) { stands_at_ = machine_position; }

  /// Before the first motion: the workpiece frame, where it is not that of the first motion, since
  /// others came before it.
  void state_work(const WorkpieceFrame& work) { stated_work_ = work; }

  /// Before the first command, instead: where the machine stands is not known in X, Y, Z (bits 0 to
  /// 2 of `axes`). The interpreter takes it to be at `machine_position`, so that its numbers can be
  /// compared. An axis is known again after a block in G90 that names it, or moves it all the same
  /// (cycles), and after a G92 or G10 L20 that names it. In G91 it stays as it was. After G53, G28
  /// and G30 the axes that they move are unknown, unless the axis is of `zero_known`, which says
  /// that the work offset of the listing is the true one, or the program has set it by G10 L2.
  /// G91 is known by the interpreter's comments, the rest by set_block(). An axis that is not of
  /// `matters` counts as known wherever the machine goes: it has none, or nothing is cut by it.
  void start_unknown(const std::array<double, 9>& machine_position, std::uint8_t axes,
                     std::uint8_t zero_known, std::uint8_t matters = 7);
  /// The block of the commands that follow; null: not known, as that of a listing. Outlives them.
  void set_block(const BlockWords* block) { block_ = block; }
  /// Ahead of a block of which no command may come (stores()): G28.1 and G30.1 keep the place where
  /// the machine stands, so that G28 and G30 lead to a known one; G10 L2 and L20 may set a system
  /// that is in force later.
  void store(const BlockWords& block);
  /// Some axes may be unknown from here on (lose(), a lost feed).
  bool follows_places() const { return follows_places_; }
  /// Axes of which it matters whether a block names them, and how.
  std::uint8_t unplaced() const { return unknown_ | probed_ | unrelated_; }
  /// A probing move along these axes has ended nobody knows where. They are unknown until a block
  /// says in plain numbers where the tool is, as after start_unknown(); what the program computes
  /// may come from the probe, and says nothing any more. Tool lengths that it states are taken for
  /// true. By set_block().
  void lose(std::uint8_t axes);
  /// Behind a probing move that has come down on the workpiece.
  void stand_on_workpiece() { on_workpiece_ = true; }
  /// Blocks that set offsets are to be told (set_block()).
  bool needs_offset_blocks() const { return on_workpiece_ || has_plate_; }
  /// Thickness of the touch plate that the probe stands on instead; 0: of none.
  double plate_mm() const { return plate_mm_; }

  /// Before the first command: QtPlasmaC's filter has its share.
  void set_filter(FilterSetup setup) { filter_ = setup; }
  /// Before the first command: lengths are checked (ToolLengths), and motions are those of the real
  /// tip.
  void set_lengths(ToolLengthSetup setup) {
    start_z_mm_ = setup.start_z_mm;
    coded_lengths_ = setup.calls == ToolLengthSetup::Calls::kCoded;
    lengths_.set_up(std::move(setup));
  }
  /// For the commands that follow: steps of MotionKind::kSignal are made.
  void set_signals(bool wanted) { signals_ = wanted; }
  /// The machine has to stand before the next step: what no canonical command says, as M66.
  void halt();
  /// Appends the step of a user M-code.
  void signal(std::uint8_t user_m, SourceRef source, std::vector<Motion>& out);
  /// For the commands that follow. No effect without the filter.
  void set_filter_modes(const FilterModes& modes) { modes_ = modes; }
  /// For the steps that follow: TorchState::material, and its kerf.
  void set_material(std::uint16_t index, double kerf_width_mm) {
    torch_.material = index;
    material_kerf_mm_ = kerf_width_mm;
  }
  /// mm in one unit of the program: 1 or 25.4.
  double unit_mm() const { return unit_mm_; }

  /// Appends the steps of `command` (0, 1, 2 for a rigid tap, 3 for a circle with overburn) to
  /// `out`.
  FoldRemark fold(const CanonicalCommand& command, SourceRef source, std::vector<Motion>& out);

  /// Appends the spline as straight feeds within kSplineChord_mm of it. kSplineLost if order and
  /// number of points do not fit, or the start is not known.
  FoldRemark fold_spline(const Spline& spline, SourceRef source, std::vector<Motion>& out);

  /// Fixed by the first motion.
  WorkpieceFrame workpiece_frame() const;
  bool workpiece_frame_fixed() const { return work_fixed_; }

  int tool() const { return tool_; }
  bool has_rotary_motion() const { return has_rotary_motion_; }
  bool has_program_end() const { return has_program_end_; }

 private:
  /// What turns program coordinates into machine coordinates. mm, degrees.
  struct Frame {
    Vec3 g5x_mm{0};
    Vec3 g92_mm{0};
    std::array<double, 3> g5x_abc_deg{};
    std::array<double, 3> g92_abc_deg{};
    Vec3 g5x_uvw_mm{0};  ///< 0 in listings, which do not hold them
    Vec3 g92_uvw_mm{0};
    double rotation_deg = 0;
    bool operator==(const Frame&) const = default;
  };
  struct Spindle {
    SpindleState state = SpindleState::kStopped;
    double speed = 0;            ///< rpm; under G96 m/min or ft/min
    double surface_max_rpm = 0;  ///< > 0: G96
    double surface_unit_mm = 0;  ///< mm in one unit of surface speed: 1000 or 304.8
    /// How it turned when it was last told to stop ..
    SpindleState stopped_from = SpindleState::kStopped;
    /// .. and when the program's end stopped it.
    SpindleState ended_from = SpindleState::kStopped;

    void start(SpindleState direction) {
      state = direction;
      stopped_from = ended_from = SpindleState::kStopped;
    }
    void stop() {
      stopped_from = state;
      state = ended_from = SpindleState::kStopped;
    }
  };
  static constexpr std::size_t kMaxSpindles = 8;  ///< EMCMOT_MAX_SPINDLES

  Vec3 work_from_program(const Vec3& p_mm) const;
  Vec3 program_from_work(const Vec3& w_mm) const;
  std::array<double, 3> work_abc(const double* program_abc_deg) const;
  Vec3 work_uvw(const CanonicalCommand& command, std::size_t first) const;
  Vec3 scaled(const CanonicalCommand& command, std::size_t first) const;
  Vec3 scaled_if_there(const CanonicalCommand& command, std::size_t first) const;
  void frame_changed();
  void fix_workpiece_frame();
  Motion& append(MotionKind kind, SourceRef source, std::vector<Motion>& out);
  void note_waits(const CanonicalCommand& command);
  void move_to(Motion& motion, Vec3 to_mm, const std::array<double, 3>& to_abc_deg,
               const Vec3& to_uvw_mm);
  void set_feed(Motion& motion) const;
  SurfaceSpeed surface_speed() const;
  void update_rpm();
  FoldRemark fold_straight(MotionKind kind, const CanonicalCommand& command, SourceRef source,
                           std::vector<Motion>& out);
  FoldRemark fold_arc(const CanonicalCommand& command, SourceRef source, std::vector<Motion>& out);
  void fold_rigid_tap(const CanonicalCommand& command, SourceRef source, std::vector<Motion>& out);
  bool fold_frame(const CanonicalCommand& command);
  bool fold_spindle(const CanonicalCommand& command);
  void choose_spindle();
  void append_program_end(SourceRef source, std::vector<Motion>& out);
  bool fold_feed(const CanonicalCommand& command);
  bool fold_event(const CanonicalCommand& command, SourceRef source, std::vector<Motion>& out);
  void fold_switch(const CanonicalCommand& command, SourceRef source, std::vector<Motion>& out);
  void change_tool_length(const CanonicalCommand& command);
  // motion_fold_places.cpp
  std::uint8_t unknown_after(Motion& motion, Vec3& to_mm);
  void store_reference(bool second);
  void store_system(const BlockWords& block);
  void store_plate(const BlockWords& block);
  void go_to_stored(std::uint8_t axes, Vec3& to_mm);
  void go_to_machine(std::uint8_t axes);
  void follow_offset_words(bool is_shift);
  void touch_off(std::uint8_t axes, std::uint8_t doubtful, bool by_shift);
  void stand_on_plate(std::uint8_t axes, bool plate);
  UnknownSum unsaid(bool doubtful) { return UnknownSum::of(++unsaid_, doubtful); }
  void lose_place(std::uint8_t axes);
  void hold_back(const Motion& feed, std::uint8_t held_before);
  void lose_held_feed(std::uint8_t axes);
  void place_in(const UnknownSum& place, int axis);
  void settle();
  std::uint8_t changed_axes(const Vec3& to_mm) const;
  bool is_at_machine_place(const Motion& motion);
  void follow_offset(CanonicalName name, int system);
  double said_height_mm() const;
  void look_for_plate(bool is_shift);
  void adopt_frame();
  void note_distance_mode(std::string_view comment);
  FoldRemark fold_command(const CanonicalCommand& command, SourceRef source,
                          std::vector<Motion>& out);
  FoldRemark fold_points(const Spline& spline, SourceRef source, std::vector<Motion>& out);
  // motion_fold_length.cpp
  void follow_lengths(const CanonicalCommand& command, SourceRef source);
  Vec3 along_work(const Vec3& v_mm) const;
  void note_height(const CanonicalCommand& command, bool known, double z_mm);
  void hold_height(const CanonicalCommand& command, SourceRef source, Vec3& to_mm);
  void place_tips(std::size_t first, std::vector<Motion>& out) const;
  // motion_fold_torch.cpp
  bool fold_torch(const CanonicalCommand& command);
  void take_synchronised_outputs();
  void use_filters_path_mode();
  void note_spindles();
  double hole_limit_mm() const;
  void end_hole();
  void begin_arc(double diameter_mm, bool full_circle);
  void return_from_overburn(SourceRef source, std::vector<Motion>& out);
  void append_overburn(const Motion& hole, std::vector<Motion>& out);
  bool only_pierces(SourceRef source, std::vector<Motion>& out);

  std::vector<int> tool_by_index_;
  Frame frame_;
  Frame work_;  ///< the workpiece frame, once fixed
  bool work_fixed_ = false;
  std::optional<WorkpieceFrame> stated_work_;
  bool same_frame_ = true;  ///< frame_ == work_: numbers pass unchanged
  double turn_cos_ = 1;     ///< of frame_.rotation - work_.rotation
  double turn_sin_ = 0;
  Vec3 shift_mm_{0};  ///< w = turn * p + shift
  Vec3 tool_offset_mm_{0};
  std::array<double, 3> tool_offset_abc_deg_{};
  Vec3 tool_offset_uvw_mm_{0};
  ToolLengths lengths_;
  bool coded_lengths_ = false;  ///< U and W of the offset are no lengths
  bool height_said_ = false;    ///< the program has said where Z is, or the machine has
  double start_z_mm_ = 0;       ///< where the interpreter has it before
  /// The interpreter does not know that the offset has changed: as long as the program does not
  /// name Z, it goes on to say this one (program coordinates, mm), and the tip stays as high as it
  /// is.
  std::optional<double> held_z_mm_;
  SourceRef held_at_;
  Vec3 call_offset_mm_{0};  ///< tool_offset_mm_ at the last call
  double unit_mm_ = 1;
  CanonicalPlane plane_ = CanonicalPlane::kXy;

  Vec3 position_mm_{0};  ///< tip, workpiece frame
  std::array<double, 3> abc_deg_{};
  Vec3 uvw_mm_{0};  ///< listings do not hold them
  bool position_known_ = false;
  std::optional<std::array<double, 9>> stands_at_;  ///< until the workpiece frame is fixed
  bool position_as_printed_ =
      true;  ///< no change of frame or unit since: equal digits mean equal points

  // Where start_unknown() or lose() was called. Axes as bits.
  /// Of X, Y, Z.
  using Unknowns = std::array<UnknownSum, 3>;
  bool follows_places_ = false;
  bool incremental_ = false;  ///< G91
  const BlockWords* block_ = nullptr;
  int unsaid_ = 0;            ///< amounts that nobody has said, so far
  Unknowns place_{};          ///< where the machine stands
  Unknowns work_place_{};     ///< the workpiece frame, of axes that are placed_
  Unknowns machine_place_{};  ///< the machine's zero, of axes whose zero_known_ is not set
  Unknowns shift_{};          ///< what the last G92 adds
  Unknowns in_force_{};       ///< the offsets in force
  std::uint8_t matters_ = 7;
  std::uint8_t unknown_ = 0;     ///< where the machine stands is not known in the workpiece frame
  std::uint8_t unrelated_ = 0;   ///< nor is it what a number of the program means there
  std::uint8_t placed_ = 0;      ///< at least once
  std::uint8_t zero_known_ = 0;  ///< where the machine's zero is
  std::uint8_t zero_by_program_ = 0;
  std::uint8_t probed_ = 0;               ///< lose()
  std::uint8_t placed_before_probe_ = 0;  ///< how far a probe may go says not where it is
  bool on_workpiece_ = false;             ///< stand_on_workpiece(), and has not moved since
  double plate_mm_ = 0;
  bool has_plate_ = false;  ///< one of systems_ has
  int g5x_index_ = 1;
  bool shifted_ = false;     ///< by G92
  SourceRef reference_;      ///< the block of the last G28 or G30 ..
  int reference_moves_ = 0;  ///< .. and its moves so far
  /// A place of the machine that the program has stored (G28.1, G30.1).
  struct StoredPlace {
    bool is_stored = false;
    Unknowns place{};
    Vec3 applied_mm{0};  ///< offset in force (ToolLengths)
    std::array<double, 11> length_call{};
  };
  std::array<StoredPlace, 2> stored_places_{};
  std::array<double, 11> length_call_{};  ///< the last USE_TOOL_LENGTH_OFFSET
  std::uint8_t held_axes_ = 0;  ///< moved by the last step, a feed that LinuxCNC may hold back
  SourceRef numbered_at_;       ///< the last M61
  /// What G10 has made of a work offset.
  struct System {
    Unknowns place{};     ///< of its zero
    double plate_mm = 0;  ///< its Z0 is so much higher: of a touch plate on the workpiece
  };
  static constexpr std::size_t kSystems = 10;  ///< G54 is 1, G59.3 is 9
  System& system_in_force() { return systems_[static_cast<std::size_t>(g5x_index_) % kSystems]; }
  std::array<System, kSystems> systems_{};
  std::array<System, kSystems> systems_before_{};  ///< a G10 with a computed P

  int tool_ = 0;
  int selected_tool_ = 0;
  SourceRef selected_at_;  ///< line 0: a change has followed
  bool speed_said_ = false;
  std::array<Spindle, kMaxSpindles> spindles_{};
  bool stop_came_ = false;    ///< STOP_SPINDLE_TURNING is this command ..
  bool stop_before_ = false;  ///< .. and the one before
  std::size_t spindle_ = 0;   ///< the one that motions speak of: the first that turns
  double rpm_ = 0;
  bool flood_ = false;
  bool mist_ = false;
  double feed_ = 0;  ///< as printed: for steps that only turn
  double feed_mm_ = 0;
  bool feed_per_rev_ = false;
  PathMode path_mode_ = PathMode::kContinuous;
  float blend_tolerance_mm_ = 0;
  float merge_tolerance_mm_ = 0;
  bool synchronised_ = false;  ///< between START_ and STOP_SPEED_FEED_SYNC
  bool synchronised_by_speed_ = false;
  double pitch_mm_ = 0;
  bool has_rotary_motion_ = false;
  bool has_program_end_ = false;
  /// Of the next step (Motion).
  std::uint8_t halts_ = 0;
  bool change_begun_ = false;  ///< M6, before its tool change
  std::uint8_t io_halts_ = 0;
  ChainEnd chain_end_ = ChainEnd::kNone;
  ToolPrepare tool_prepare_ = ToolPrepare::kNone;
  bool table_reloaded_ = false;

  TorchState torch_;
  /// M62, M63, M67 that wait for the next step that moves.
  bool outputs_wait_ = false;
  std::uint64_t waiting_outputs_ = 0;
  std::uint64_t waiting_mask_ = 0;
  std::array<std::optional<float>, TorchState::kAnalogs> waiting_analog_;
  FilterSetup filter_;
  FilterModes modes_;
  double material_kerf_mm_ = 0;
  bool path_mode_said_ = false;  ///< by the program
  bool signals_ = false;
  bool compensation_ = false;  ///< G41, G42
  bool hole_active_ = false;   ///< the filter's M67 E3 is in force
  bool torch_off_by_filter_ = false;
  bool pierced_ = false;                  ///< since M3, in pierce-only mode
  std::optional<Vec3> overburn_from_mm_;  ///< end of the circle, while the tip stands beyond it
};

/// Angle from `start` to `end` about the origin as LinuxCNC reads an arc: `turns` > 0
/// counter-clockwise, < 0 clockwise, |turns| = number of turns begun, so that |sweep| lies in
/// ((|turns| - 1) * 2 pi, |turns| * 2 pi]. Ends that coincide are a full turn. `resolution` is the
/// size of the last printed digit; `as_printed`: start and end carry the same rounding, so that a
/// full circle has equal ends.
double arc_sweep_rad(const Vec2& start, const Vec2& end, int turns, double resolution,
                     bool as_printed);

}  // namespace kerf
