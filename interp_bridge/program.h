// interp_bridge/program.h - from an NC program (file, saved listing or stdin) to a stream of
// motions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "base/result.h"
#include "interp_bridge/active_modes.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/torch_materials.h"
#include "interp_bridge/turning_text.h"

namespace kerf {

/// A comment of the program, for tool and stock hints (CAM headers). Text without its parentheses
/// or semicolon.
struct ProgramComment {
  SourceRef source;
  std::string text;
};

/// Which interpreter reads an NC file: kerf-interp (LinuxCNC's librs274 in a process of its own:
/// exact lines and numbers, splines, U V W), or the text of rs274; kAuto takes the first that is
/// there.
enum class InterpreterChoice : std::uint8_t { kAuto, kBridge, kText };

/// What the interpreter is told of the machine. The defaults are those of a mm machine without an
/// INI. kerf-interp only; rs274 takes none of it.
struct InterpreterSetup {
  bool inch_machine = false;  ///< unit of parameter file and tool table
  int axis_mask = 0x1ff;      ///< bit 0 is X .. bit 8 is W
  /// Axes along which the tool table's offsets are lengths: those that the machine is known to
  /// have.
  int length_axes = 7;
  bool random_toolchanger = false;
  /// [EMCIO]TOOL_CHANGE_POSITION: X Y Z, X Y Z A B C or all nine, machine coordinates, mm and
  /// degrees. Empty: tools are changed where the machine stands. kerf-interp only.
  std::vector<double> tool_change_position;
  /// The lengths of the tool table count (G43). Without a known place of the machine they must not:
  /// a program that begins with G43 and G0 X Y would find its tool a tool's length below Z0.
  bool tool_lengths = false;
  /// X Y Z are slides, and no controller follows the tip where the tool tilts: a tool longer than
  /// its offset has its tip lower by the difference. Of other machines lengths are compared, and
  /// what is cut is what the program says.
  bool straight_axes = true;
  /// Where the machine stands at the start, machine coordinates: X Y Z A B C U V W, mm and degrees.
  std::array<double, 9> start{};
  /// That is where it stands, and the work offsets are known too: the first move has a start.
  bool start_known = false;
  /// Without start_known: each of X, Y and Z is unknown until a block of the program places it, and
  /// again after G53, G28 or G30 without a known work offset. Else they count as known after the
  /// first move. An axis that the program never names counts as standing at 0.
  bool unknown_places = false;
  /// Of them Z does not matter, and counts as standing at 0: what is cut is a sheet.
  bool z_matters = true;
  /// Machine coordinates of the work zero (mm, degrees): of the offset in force at the start, or
  /// without a parameter file of all of them. It comes before that of the parameter file.
  std::optional<WorkpieceFrame> work_offset;
  std::string ini_path;        ///< read by the interpreter itself: remaps, paths, features
  std::string ini_text;        ///< of ini_path with its #INCLUDEs in place; empty: it has none
  std::string working_folder;  ///< relative paths of the INI; empty: the program's folder
  std::string parameter_path;  ///< var file, copied before it is used; empty: none
  std::string startup_code;    ///< run before the program
  /// The program is begun at this line, as LinuxCNC's "run from here" does it: what comes before is
  /// read, and not done. kerf-interp only. 0: it is run from its beginning.
  std::uint32_t first_line = 0;
  /// With first_line: the workpiece frame, which the motions before that line have fixed. Nothing:
  /// it is that of the first motion from there on.
  std::optional<WorkpieceFrame> work;
  /// Where the machine stands then: X Y Z A B C U V W of the program there, mm and degrees. Axes
  /// that the line does not name stay there. Nothing: where the program would be.
  std::optional<std::array<double, 9>> there;
};

/// Whether a program is read as a QtPlasmaC machine would: its materials, what its filter makes of
/// the text (FilterSetup in motion_fold.h), its pins. kAuto: if the INI is of such a machine, or
/// the program asks for its pins (#<_hal[plasmac.cut-feed-rate]>), has a material comment (o=0, ..)
/// or one of the filter's parameters (#<holes>=4).
enum class QtPlasmacChoice : std::uint8_t { kAuto, kOn, kOff };

/// What is known of a torch's machine beyond its INI.
struct TorchOptions {
  QtPlasmacChoice qtplasmac = QtPlasmacChoice::kAuto;
  /// QtPlasmaC's *_material.cfg, in the machine's unit. Empty: that beside InterpreterSetup's INI,
  /// if it is there.
  std::string materials_path;
  /// Values of HAL pins that the program reads by #<_hal[name]>, names in lower case, in the
  /// machine's unit. They come before all others. kerf-interp only.
  std::map<std::string, double> hal_values;
};

/// What a machine does where nothing moves: of a punch, a stroke may be that alone.
struct SignalOptions {
  bool wanted = false;  ///< steps of MotionKind::kSignal come
  /// User M-codes, 100 to 199, that the machine knows: a signal each. The others stay remarks.
  std::vector<int> user_codes;
};

/// The diameter of a tool whose shape is known elsewhere than from the tool table.
struct KnownDiameter {
  double mm = 0;
  bool by_argument = false;  ///< --tool; else a comment of the program
  int orientation = 0;       ///< of a turning tool, as ToolTableRow has it
};
/// What is known of a program's tools beforehand.
struct KnownTools {
  std::map<int, KnownDiameter> diameters;  ///< by tool number
  /// They stand still, and the workpiece turns: nothing need say where Y is.
  bool turning = false;
};

/// What comes of a probing move, G38.2 to G38.5.
struct ProbeAnswer {
  enum class Kind : std::uint8_t {
    kUnknown,  ///< nobody can tell: it runs to its end, and what depends on it is not known
    kMet,      ///< it stops where the probe meets the workpiece, or leaves it
    kMissed,   ///< it runs to its end, and neither meets nor leaves it
    kRefused,  ///< the machine would not begin it: the probe is tripped already, or already clear
  };
  Kind kind = Kind::kUnknown;
  double share = 1;  ///< kMet: the part of the move that is run, 0 to 1
  std::string why;   ///< kUnknown: what is not known, as the end of a sentence
};

/// A probing move as programmed, and whether it is to lose contact (G38.4, G38.5).
struct ProbeQuestion {
  Motion motion;
  bool away = false;
};
/// Called where the program probes, from the thread that runs it, when the sink has all motions
/// before. The program waits for the answer.
using ProbeAnswerer = std::function<ProbeAnswer(const ProbeQuestion&)>;

/// What to interpret and how.
struct ProgramOptions {
  /// NC file, canonical listing (.canon, or its text under any name), or "-": canonical text on
  /// stdin.
  std::string path;
  /// LinuxCNC tool.tbl, in mm or in the unit of `machine`. Empty: the tools that the program names,
  /// diameter 0. Faults of single rows are reported by read_tool_table, not here.
  std::string tool_table_path;
  /// What says that the machine is a lathe ("mill.ini:3: [DISPLAY]LATHE = 1"); empty: nothing does.
  std::string lathe;
  bool as_mill = false;      ///< what is for a lathe is milled all the same
  bool block_delete = true;  ///< skip lines that begin with '/', as LinuxCNC does when it starts
  InterpreterChoice interpreter = InterpreterChoice::kAuto;
  InterpreterSetup machine;
  TorchOptions torch;
  SignalOptions signals;
  std::string rs274_path = "rs274";  ///< looked up in PATH
  /// Empty: beside this executable, in ../lib/kerf beside it, else looked up in PATH.
  std::string kerf_interp_path;
  /// kerf-interp reads plain numbers without LinuxCNC's own stream: the same bits, sooner.
  bool interp_fast = true;
  /// Records of programs that were interpreted before (record_cache.h). Empty: none are looked for,
  /// none are kept. kerf-interp only.
  std::string cache_folder;
  std::uint64_t cache_bytes = std::uint64_t{512} << 20;
  /// Canonical commands after which a program counts as endless; 0: any number. Not given: 50
  /// million, and for longer programs 4 a line.
  std::optional<std::uint64_t> max_commands;
  /// Seconds without a canonical command after which it counts as endless.
  /// The same where it gives none but those that it has given before, with a machine that stands
  /// still or runs for days: after half as long, in its processor time.
  double max_silent_s = 20.0;
  double max_cpu_s = 0;  ///< processor time of the interpreter after which it is ended; 0: any
};

/// ProgramOptions::max_commands for a source of so many lines.
std::uint64_t command_limit(const ProgramOptions& options, std::size_t lines);

/// Something that the program does and kerf does not: a user M-code, an M66.
struct ProgramNote {
  SourceRef source;  ///< the first time
  std::string text;
  std::uint64_t count = 0;
  bool is_sentence = false;  ///< `text` says all; else it names what is passed over
};

/// Counts and facts known once the stream has ended (or was stopped).
struct ProgramSummary {
  std::vector<std::string> files;  ///< SourceRef::file indexes this; [0] is the program
  std::size_t program_lines = 0;   ///< physical lines of files[0]
  std::string interpreter;         ///< "bridge" | "text" | "canon"
  std::map<std::string, std::uint64_t> canonical_commands;  ///< by name
  /// Text that was not canonical ((PRINT,..), messages), first 100.
  std::vector<std::string> foreign_lines;
  std::uint64_t foreign_line_count = 0;
  bool has_program_end = false;    ///< M2, M30 or a closing %
  bool end_remarked = false;       ///< the last diagnostic of the run says that it has none
  bool has_rotary_motion = false;  ///< any A, B or C motion
  std::vector<ProgramNote> notes;  ///< first 100 different ones
  std::uint64_t lost_splines = 0;  ///< whose points the listing does not hold
  ActiveModes modes;               ///< at InterpreterSetup::first_line
  bool stopped_early = false;      ///< by the stop token, the consumer, or a limit
  double interpret_s = 0;          ///< wall seconds until the interpreter was done
};

/// Receives motions in program order, a batch at a time; the span is valid during the call only.
/// Return false to stop.
using MotionSink = std::function<bool(std::span<const Motion>)>;

/// One NC program being read. Streams: memory does not grow with the program's length (other than
/// the comments of its first 2000 lines, and at most 1000 later ones).
class Program {
 public:
  /// Looks at the source without interpreting it: exists, is a regular readable file (or stdin), is
  /// text, is not empty, rs274 is installed if it is needed. Errors are Diagnostics with exact
  /// texts (tested).
  /// Null on error.
  static std::unique_ptr<Program> open(const ProgramOptions& options, Diagnostics& diagnostics);
  virtual ~Program() = default;

  /// Comments of the source text, `;` ones included: all that carry a tool or stock hint can be
  /// found here before run(). For stdin: empty.
  virtual const std::vector<ProgramComment>& comments() const = 0;

  /// Interprets to the end, calling `sink` from this thread with batches. Diagnostics of the
  /// interpreter (errors with file:line, a missing program end as a warning, an endless program)
  /// are appended. Returns the summary, complete or partial. Leaves no process, no temporary file.
  /// Call once.
  virtual ProgramSummary run(const MotionSink& sink, std::stop_token stop,
                             Diagnostics& diagnostics) = 0;

  /// Files that SourceRef::file indexes, as far as they are known: within the sink, all that the
  /// motions name. From the thread that runs; afterwards as in the summary.
  const std::vector<std::string>& files() const { return files_; }
  /// Known from the first batch that has a motion on. From the thread that runs.
  const WorkpieceFrame& workpiece_frame() const { return frame_; }

  /// What TorchState::material indexes, [0] the default material: within the sink, all that the
  /// motions name. From the thread that runs. Of a program that is none of QtPlasmaC's: one row,
  /// which says nothing.
  const std::vector<TorchMaterial>& materials() const { return materials_; }
  /// It is read as a QtPlasmaC machine would.
  bool is_qtplasmac() const { return is_qtplasmac_; }
  /// Of the text; of listings empty.
  const TurningWords& turning_words() const { return turning_; }

  /// Before run(): diameters for cutter compensation (G41, G42). A tool whose row
  /// of the table has a diameter keeps that, as on the machine.
  void give_tools(KnownTools tools) { known_tools_ = std::move(tools); }
  /// Before run(): probing moves are asked about (kerf-interp only; rs274 and listings cannot ask,
  /// theirs are not known). Null: of none is anything known. From one of which nothing is known on
  /// the motions come with start_known = false, and a note says so, until the program sets the work
  /// offset of the axes that it has probed by plain numbers (G10 L2). Without this call a probing
  /// move runs to its end, and finds it there if it must find something (G38.2, G38.4).
  void follow_probes(ProbeAnswerer answerer) {
    follows_probes_ = true;
    answer_probe_ = std::move(answerer);
  }

  /// Share of the source already interpreted, for a progress bar; any thread.
  virtual double progress() const = 0;  ///< 0..1, or < 0 if not known

 protected:
  std::vector<std::string> files_;
  WorkpieceFrame frame_;
  std::vector<TorchMaterial> materials_{TorchMaterial{}};
  KnownTools known_tools_;
  bool follows_probes_ = false;
  ProbeAnswerer answer_probe_;

 private:
  bool is_qtplasmac_ = false;
  TurningWords turning_;
};

/// A row of a LinuxCNC tool table, lengths in mm (the caller says what unit the table is in; mm by
/// default).
struct ToolTableRow {
  int tool = 0;
  int pocket = 0;
  double diameter_mm = 0;
  bool has_diameter = false;  ///< there is a D, be it D0
  Vec3 offset_mm{0};
  Vec3 offset_abc_deg{0};
  Vec3 offset_uvw_mm{0};
  double front_angle_deg = 0;  ///< I, lathe
  double back_angle_deg = 0;   ///< J, lathe
  int orientation = 0;         ///< Q, lathe: 0 to 9
  std::string remark;
  int line = 0;
  bool added = false;  ///< not of the table, which does not have the tool: its length is not known
};

/// Reads tool.tbl as LinuxCNC does, but accepts tabs (with a warning). Bad rows are diagnostics
/// with line and column.
/// `unit_mm`: mm in one unit of the table, 1 or 25.4.
Result<std::vector<ToolTableRow>> read_tool_table(const std::string& path, Diagnostics& diagnostics,
                                                  double unit_mm = 1);

}  // namespace kerf
