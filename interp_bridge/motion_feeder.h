// interp_bridge/motion_feeder.h - canonical commands with their lines, handed on in batches of
// motions: what a listing and kerf-interp's records have in common.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/motion_fold.h"
#include "interp_bridge/program.h"
#include "interp_bridge/repeat_watch.h"
#include "interp_bridge/tool_table.h"
#include "interp_bridge/torch_setup.h"

namespace kerf {

struct MotionFeederOptions {
  std::vector<int> tool_by_index;  ///< of MotionFold
  ToolLengthSetup lengths;         ///< of MotionFold::set_lengths
  bool has_tool_table = true;      ///< the user's
  /// Of others the interpreter takes the radius of cutter compensation as 0, which is warned of.
  ToolDiameters diameters;
  std::uint64_t max_commands = 0;  ///< 0: any number
  /// Of MotionFold::stand_at.
  std::optional<std::array<double, 9>> start;
  /// Of MotionFold::start_unknown, without `start`.
  struct Places {
    bool followed = false;  ///< InterpreterSetup::unknown_places
    std::array<double, 9> interpreter_start{};
    bool zero_known = false;  ///< the interpreter's work offsets are the machine's
    bool z_matters = true;
    bool y_matters = true;
    bool has_blocks = true;  ///< the text of the program is there; else it is a listing
  };
  Places places;
  /// Written before the first motion that moves is handed over, and again where an axis is placed
  /// under another offset than that. May be null.
  WorkpieceFrame* frame = nullptr;
  std::optional<WorkpieceFrame> work;  ///< of MotionFold::state_work
  /// What is known of a torch machine. Without `torch.qtplasmac` its materials do not count.
  TorchRun torch;
  SignalOptions signals;
  bool follows_probes = false;  ///< Program::follow_probes()
  ProbeAnswerer answer_probe;   ///< null: of no probing move is anything known
  std::string no_answer;        ///< why, as ProbeAnswer::why
  /// What TorchState::material indexes: written before motions with a new index are handed over.
  /// May be null.
  std::vector<TorchMaterial>* materials = nullptr;
};

/// Counts, folds, collects the diagnostics that commands give rise to. One thread.
class MotionFeeder {
 public:
  /// All references must outlive the feeder. Counts and diagnostics are appended as they come.
  MotionFeeder(MotionFeederOptions options, const MotionSink& sink, ProgramSummary& summary,
               Diagnostics& diagnostics);

  /// False: the sink has had enough, there were too many commands, or a number that no machine has
  /// (wild_motion.h): then a diagnostic names its line, and what comes from there on is not handed
  /// over.
  bool take(const CanonicalCommand& command, SourceRef source);
  /// A spline with its control points; counts as one command.
  bool take_spline(const Spline& spline, SourceRef source);
  /// A command that is none of ours: counted. True if it is the first of its name.
  bool take_unknown(std::string_view name);
  void add_foreign(std::string_view line);
  /// M66 or a user M-code: the machine stands before the next step.
  void take_wait() { fold_.halt(); }
  /// M190 P: true if it is QtPlasmaC's, and the material is another now.
  bool take_material_change(double number, SourceRef source);
  /// The traverse that comes next goes to where the machine stands: on all axes, whatever its block
  /// names.
  void take_here() { stands_there_ = true; }
  /// The block is about to be run, and may be one whose effect shows only later (stores()).
  void take_store(SourceRef source);
  /// M100 to M199: true if it is one that SignalOptions names, and a step has been made of it.
  bool take_user_code(double number, SourceRef source);
  /// The program is about to probe: all motions before are handed over, then it is asked for. What
  /// comes next is the STRAIGHT_PROBE as it is run. False as above.
  bool ask_probe(const CanonicalCommand& command, bool away, SourceRef source, ProbeAnswer& answer);
  bool is_qtplasmac() const { return options_.torch.qtplasmac; }

  /// Hands over what has waited for longer than a screen would forgive (about 40 ms). False as
  /// above.
  bool flush_if_old();
  /// Hands over the rest, closes the counts. `file` is named in the remarks about the whole.
  void finish();

  std::uint64_t commands() const { return commands_; }
  const RepeatWatch& repeats() const { return repeats_; }
  bool too_many_commands() const { return too_many_; }
  bool done() const { return sink_done_ || too_many_ || refused_; }
  /// Of the last command.
  SourceRef last_source() const { return source_; }
  /// A diagnostic at the last command's place.
  Diagnostic at_source(Severity severity, std::string message) const;

 private:
  bool took(std::size_t batch_before);
  void refuse_wild(std::size_t first);
  void remark(FoldRemark remark);
  void remark_on_text(const CanonicalCommand& command);
  void remark_on_compensation();
  void follow_probing(const CanonicalCommand& command, std::size_t first);
  unsigned named_axes();
  unsigned moved_axes(const Motion& m) const;
  void note_unknown_probe();
  void note_plate();
  void edit_material(const CanonicalCommand& comment);
  void material_changed();
  void follow_modes();
  void start_fold();
  void follow_block(CanonicalName name);
  void remark_on_defaults();
  bool hand_over();

  MotionFeederOptions options_;
  const MotionSink& sink_;
  ProgramSummary& summary_;
  Diagnostics& diagnostics_;
  MotionFold fold_;
  MaterialTable materials_;
  std::size_t materials_told_ = 0;
  int material_remarks_ = 0;
  std::vector<Motion> batch_;
  std::chrono::steady_clock::time_point batch_since_;
  std::array<std::uint64_t, kCanonicalNameCount> counts_{};
  std::uint64_t commands_ = 0;
  std::uint64_t splines_lost_ = 0;
  bool plane_reported_ = false;
  std::set<int> compensation_reported_;  ///< tools
  int compensation_looks_ = 0;
  bool too_many_ = false;
  bool sink_done_ = false;
  BlockReader blocks_;
  RepeatWatch repeats_;
  bool refused_ = false;  ///< a wild number
  bool stands_there_ = false;
  SourceRef source_;

  /// What hangs on a probing move of which nothing is known.
  struct UnknownProbe {
    unsigned said = 0;      ///< bits of X Y Z: the program has moved them, so that they are known
    bool answered = false;  ///< the STRAIGHT_PROBE to come is the answer's
    std::string why;
    bool met_below = false;  ///< .. and it comes down on the workpiece
    bool plate_told = false;
    std::size_t note = 0;             ///< index of the note, from 1; 0: there is none
    bool all_unknown = false;         ///< from here on, to the end
    std::size_t files_looked_at = 0;  ///< of ProgramSummary::files, for what branches on it
  };
  UnknownProbe probe_;
};

}  // namespace kerf
