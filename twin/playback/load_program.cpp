#include "twin/playback/load_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/parameter_file.h"
#include "twin/guess/guess_rows.h"
#include "twin/guess/program_survey.h"
#include "twin/machine/kinematics/switched_motions.h"
#include "twin/playback/planned_steps.h"
#include "twin/playback/probed_workpiece.h"
#include "twin/process/process.h"

namespace kerf {
namespace {

std::vector<std::string> absolute(const std::vector<std::string>& files) {
  std::vector<std::string> out;
  for (const std::string& file : files) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::absolute(file, error);
    out.push_back(file == "-" || error ? file : path.lexically_normal().string());
  }
  return out;
}

ProgramTool described(const ResolvedTool& tool, const std::vector<ToolTableRow>& table) {
  ProgramTool out;
  out.number = tool.number;
  out.origin = tool.origin;
  out.trouble = tool.trouble;
  out.guessed = tool.guessed;
  if (tool.cutter) out.shape = tool.cutter->spec();
  const auto row = std::find_if(table.begin(), table.end(), [&](const ToolTableRow& entry) {
    return entry.tool == tool.number;
  });
  if (row != table.end()) out.remark = row->remark;
  return out;
}

TimelineOptions timing_of(const SessionOptions& options, const ProcessPlan& process) {
  TimelineOptions timing = options.timeline;
  timing.holds = process.holds();
  return timing;
}

/// The tools of a program, each once.
class ToolList {
 public:
  ToolList(const ToolSources& sources, ToolResolver::CutterCheck can_cut,
           const ProcessPlan& process)
      : motion_tools_(process.tools(sources, can_cut)), table_(sources.table) {}

  /// `materials`: all that the motions so far name.
  void add(const Motion& m, std::span<const TorchMaterial> materials) {
    const auto [tool, name] = motion_tools_->of(m, materials);
    if (!tool || tool == last_) return;
    last_ = tool;
    ProgramTool fresh = described(*tool, table_);
    if (name) fresh.remark = *name;
    const bool by_shape = motion_tools_->by_shape();
    const bool known = std::any_of(tools_.begin(), tools_.end(), [&](const ProgramTool& listed) {
      return listed.number == fresh.number && (!by_shape || listed.shape == fresh.shape);
    });
    if (!known) tools_.push_back(std::move(fresh));
  }

  std::vector<ProgramTool> take() { return std::move(tools_); }

 private:
  std::unique_ptr<MotionTools> motion_tools_;
  std::vector<ToolTableRow> table_;
  std::vector<ProgramTool> tools_;
  const ResolvedTool* last_ = nullptr;
};

/// One reading of a program.
class Loading {
 public:
  /// `cuts`: what its probes meet is looked for.
  Loading(const SessionOptions& options, const ProgramFront& front, const ProcessPlan& process,
          const LoadControl& control, bool cuts)
      : control_(control),
        program_(*front.program),
        window_(options.lines),
        planned_(builder_, options.timeline.planner.with_path && process.traits().follows_path),
        timeline_(timing_of(options, process), planned_),
        tools_(front.tools, stock_model(front.choice.kind).can_cut, process),
        tilt_(options.timeline.kinematics),
        switched_(options.timeline.kinematics) {
    blank_wanted_ = !front.stock.stock;
    if (front.is_sheet()) return;
    survey_.emplace(SurveyWishes::of(options, front), front.tools);
    if (cuts) workpiece_.emplace(options, front, control.stop);
    if (front.stock.stock) {
      program_.follow_probes([this](const ProbeQuestion& question) { return answer(question); });
    } else {
      program_.follow_probes(nullptr);
    }
  }

  ProgramSummary read(Diagnostics& said) {
    const MotionSink sink = [this](std::span<const Motion> motions) { return take(motions); };
    ProgramSummary summary = program_.run(sink, control_.stop, said);
    timeline_.finish();
    return summary;
  }

  /// It probes, and was read without `cuts`: no further than there.
  bool wants_to_cut() const { return wants_to_cut_; }
  const std::optional<ProgramSurvey>& survey() const { return survey_; }
  const LineWindow& window() const { return window_; }
  const std::string& tilt() const { return tilt_.found(); }
  std::size_t report_from() const {
    return planned_.first_of(window_.begun() ? before_window_ : motions_);
  }
  std::string time_model() const { return timeline_.time_model(); }
  std::vector<ProgramTool> tools() { return tools_.take(); }
  std::shared_ptr<const ProgramTrack> build(const std::vector<std::string>& files) {
    return builder_.build(files, program_.workpiece_frame());
  }
  ProgrammedSteps programmed(const std::vector<std::string>& files) {
    return planned_.take_programmed(files, program_.workpiece_frame());
  }

 private:
  ProbeAnswer answer(const ProbeQuestion& question) {
    ProbeAnswer unknown;
    wants_to_cut_ = !workpiece_;
    if (wants_to_cut_) return unknown;
    if (tilt_.found().empty() || workpiece_->takes_tilted_tools()) {
      return workpiece_->answer(question);
    }
    unknown.why =
        tr("tool or workpiece have turned before, and the blank was not of --model octree");
    return unknown;
  }

  /// False: no more motions are wanted.
  bool take(std::span<const Motion> motions) {
    if (wants_to_cut_) return false;
    motions = switched_.follow(motions, program_.workpiece_frame());
    tilt_.look_at(motions, program_.workpiece_frame());
    if (workpiece_) workpiece_->take(motions, program_.workpiece_frame());
    if (const auto& materials = program_.materials(); materials.size() != materials_) {
      materials_ = materials.size();
      timeline_.set_materials(materials);
    }
    if (survey_) survey_->add(motions, tilt_.moves());
    if (!window_.over()) {
      const LineWindow::Split split = window_.split(motions);
      for (const Motion& m : motions.first(split.before + split.within)) {
        tools_.add(m, program_.materials());
        timeline_.push(m);
      }
      before_window_ += split.before;
      motions_ += split.before + split.within;
    }
    if (control_.on_progress) control_.on_progress({program_.progress(), motions_});
    return blank_wanted_ || !window_.over();
  }

  const LoadControl& control_;
  Program& program_;
  LineWindow window_;
  ProgramTrackBuilder builder_;
  PlannedSteps planned_;
  Timeline timeline_;
  ToolList tools_;
  TiltWatch tilt_;
  SwitchedMotions switched_;
  std::optional<ProgramSurvey> survey_;  ///< none of a sheet that is known
  bool blank_wanted_ = false;            ///< where a program works does not end with a window
  std::optional<ProbedWorkpiece> workpiece_;
  bool wants_to_cut_ = false;
  std::size_t motions_ = 0;
  std::size_t before_window_ = 0;
  std::size_t materials_ = 0;  ///< that the timeline knows
};

/// Faults of the file are those of the interpreter, which reads it too: they are told once.
std::vector<NamedOffset> read_work_offsets(const InterpreterSetup& machine) {
  constexpr std::array<const char*, 9> kNames = {"G54", "G55",   "G56",   "G57",  "G58",
                                                 "G59", "G59.1", "G59.2", "G59.3"};
  std::vector<NamedOffset> offsets;
  if (machine.parameter_path.empty()) return offsets;
  Diagnostics faults;
  const double unit_mm = mm_of_unit(machine.inch_machine);
  const Result<ParameterFile> file = parameters_of(machine, unit_mm, faults);
  if (!file) return offsets;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    offsets.push_back({kNames[i], file->frame(static_cast<int>(i) + 1, unit_mm)});
  }
  return offsets;
}

/// The blank and the tools that nobody has described. False: no guesses are wanted, and something
/// is missing.
bool take_guesses(const SessionOptions& options, const ProgramSurvey& survey, ProgramFront& front,
                  FindingLog& remarks, Diagnostics& diagnostics) {
  if (!options.guess) {
    const Diagnostics missing = survey.missing();
    diagnostics.insert(diagnostics.end(), missing.begin(), missing.end());
    return missing.empty();
  }
  if (!front.blank) {
    front.blank = survey.blank();
    front.blank_origin = tr("guessed");
    front.blank_guessed = true;
    front.is_drawn = survey.is_drawn();
    if (survey.has_moves()) front.guess_reason = survey.blank_reason();
    if (auto warning = survey.warning(*front.blank, front.guess_reason)) {
      remarks.add(std::move(*warning));
    }
  }
  const Box bounds = front.stock.stock ? front.stock.stock->bounds_mm() : front.blank->bounds_mm();
  front.tools.guesses = survey.tools(bounds.max.z);
  if (front.tools.guesses.empty()) return true;
  front.choice = choose_stock(options.stock, stock_needs(front.tools));
  front.stock = {};
  return true;
}

/// Those that were not known while the program was read.
void describe_guessed(const ToolSources& sources, ToolResolver::CutterCheck can_cut,
                      std::vector<ProgramTool>& tools) {
  ToolResolver resolver(sources, can_cut);
  for (ProgramTool& tool : tools) {
    for (const ToolGuess& guess : sources.guesses) {
      if (guess.tool != tool.number || tool.shape.empty() == guess.of_known_size) continue;
      if (guess.of_known_size) {
        tool.shape = guess.shape;
      } else {
        tool = described(resolver.mount(tool.number, 0), sources.table);
      }
    }
  }
}

std::vector<ToolUse> uses_of(const std::vector<ProgramTool>& tools) {
  std::vector<ToolUse> uses;
  for (const ProgramTool& tool : tools) {
    ToolUse& use = uses.emplace_back();
    use.number = tool.number;
    use.shape = tool.shape;
    use.origin = tool.origin;
    use.guessed = tool.guessed;
  }
  return uses;
}

}  // namespace

std::unique_ptr<LoadedProgram> load_program(const SessionOptions& options,
                                            const LoadControl& control, Diagnostics& diagnostics,
                                            Outcome& outcome) {
  std::optional<ProgramFront> front = open_front(options, diagnostics, outcome);
  if (!front) return nullptr;
  auto loaded = std::make_unique<LoadedProgram>();
  std::optional<Loading> reading;
  const ProcessPointer process = process_of(options, *front);
  reading.emplace(options, *front, *process, control, false);
  Diagnostics said;
  loaded->summary = reading->read(said);
  if (reading->wants_to_cut()) {
    said.clear();
    front->program = Program::open(options.program, diagnostics);
    if (!front->program) return nullptr;
    front->program->give_tools(known_tools(front->tools));
    reading.emplace(options, *front, *process, control, true);
    loaded->summary = reading->read(said);
  }
  Loading& loading = *reading;
  const bool stopped = control.stop.stop_requested() && loaded->summary.stopped_early;
  FindingLog remarks;
  if (const auto& survey = loading.survey()) {
    const auto sheet =
        options.guess ? survey->sheet(front->program->is_qtplasmac(), front->program->materials())
                      : std::nullopt;
    // Of a sheet Z does not matter, to the interpreter neither: it is read again.
    if (sheet && !stopped) {
      return load_program(with_sheet(options, *sheet, survey->kerfs(sheet->beam)), control,
                          diagnostics, outcome);
    }
    outcome = Outcome::kUsageError;
    if (!take_guesses(options, *survey, *front, remarks, diagnostics)) return nullptr;
  } else if (front->blank_guessed) {
    remarks.add(guess_warning(*front->blank, front->guess_reason));
  }
  if (!make_room_for_tilt(options, loading.tilt(), *front, diagnostics, outcome)) return nullptr;
  if (!front->stock.stock && !fill_front(options, *front, diagnostics, outcome)) return nullptr;
  const BlankKind blank_kind = judged_blank(options, *front, loaded->summary, !has_error(said));
  const ProgramEnd end =
      conclude_program(loaded->summary, std::move(said), loading.window(), stopped, remarks);
  loaded->outcome = outcome = end.outcome;
  loaded->partial_reason = end.partial_reason;
  loaded->time_model = loading.time_model();
  loaded->files = absolute(loaded->summary.files);
  loaded->tools = loading.tools();
  describe_guessed(front->tools, row_of(*front->stock.stock).can_cut, loaded->tools);
  const std::vector<ToolUse> uses = uses_of(loaded->tools);
  loaded->guesses = guess_rows(options, *front, uses);
  if (end.partial_reason.empty()) add_unused_tools(options, uses, remarks);
  loaded->work_offsets = read_work_offsets(options.program.machine);
  PlayerProgram& player = loaded->player;
  player.report_from = loading.report_from();
  // As Session has it.
  player.checks = checks_of(options, *front);
  player.blank_kind = blank_kind;
  player.whole = !stopped && !(front->is_sheet() && loading.window().over());
  player.track = loading.build(loaded->summary.files);
  player.programmed = loading.programmed(loaded->summary.files);
  loaded->blank = stock_report(*front->stock.stock, front->stock.facts);
  player.blank = std::move(front->stock.stock);
  // A sheet has no height by which a point could be said to be cut or not.
  if (!front->is_sheet()) {
    loaded->cuts =
        std::make_shared<const CutQuery>(player.track, front->tools, row_of(*player.blank).can_cut);
  }
  player.tools = std::move(front->tools);
  player.timeline = options.timeline;
  player.process = process;
  player.materials = front->program->materials();
  player.remarks = remarks.kept();
  return loaded;
}

}  // namespace kerf
