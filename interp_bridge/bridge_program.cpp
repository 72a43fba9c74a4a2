// A program read by kerf-interp, where it stands.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/child_listener.h"
#include "interp_bridge/interpreter_process.h"
#include "interp_bridge/parameter_file.h"
#include "interp_bridge/private_folder.h"
#include "interp_bridge/program_kinds.h"
#include "interp_bridge/record_cache.h"
#include "interp_bridge/record_reader.h"
#include "interp_bridge/record_replay.h"
#include "interp_bridge/rs274_messages.h"
#include "interp_bridge/source_text.h"
#include "interp_bridge/tool_table.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostIniBytes = std::size_t{16} << 20;
using Clock = std::chrono::steady_clock;

/// A row as `kerf-interp --tools` takes it: machine units, all digits.
/// A B C stay 0: they are no lengths of a tip (ToolLengths).
std::string tool_row(const ToolTableRow& row, double unit_mm, const InterpreterSetup& machine) {
  const Vec3 offset = machine.tool_lengths ? row.offset_mm / unit_mm : Vec3(0);
  Vec3 slides = machine.tool_lengths ? row.offset_uvw_mm / unit_mm : Vec3(0);
  for (int i = 0; i < 3; ++i) slides[i] *= (machine.length_axes >> (6 + i) & 1) != 0 ? 1 : 0;
  return fmt::format("{} {} {} {} {} 0 0 0 {} {} {} {} {} {} {}\n", row.tool, row.pocket, offset.x,
                     offset.y, offset.z, slides.x, slides.y, slides.z, row.diameter_mm / unit_mm,
                     row.front_angle_deg, row.back_angle_deg, row.orientation);
}

/// The INI of a machine that has none: subroutines may also stand where kerf was started, as on the
/// text interpreter. A QtPlasmaC machine has three spindles: torch, scribe and spotting.
std::string makeshift_ini(const std::string& folder, bool random_toolchanger, bool qtplasmac) {
  return fmt::format(
      "[RS274NGC]\nSUBROUTINE_PATH = {}\n[EMCIO]\nRANDOM_TOOLCHANGER = {}\n[TRAJ]\nSPINDLES = {}\n",
      folder, random_toolchanger ? 1 : 0, qtplasmac ? 3 : 1);
}

/// Size and time of a file's contents, to see whether they changed while they were read.
class Contents {
 public:
  explicit Contents(std::string path)
      : path_(std::move(path)), fd_(open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
    known_ = fd_ >= 0 && fstat(fd_, &begin_) == 0;
  }
  Contents(const Contents&) = delete;
  Contents& operator=(const Contents&) = delete;
  ~Contents() {
    if (fd_ >= 0) close(fd_);
  }
  /// A file that was replaced under its name has not changed: it is read as it was.
  bool changed() const {
    struct stat now {};
    if (!known_ || fstat(fd_, &now) != 0) return false;
    return now.st_size != begin_.st_size || now.st_mtim.tv_sec != begin_.st_mtim.tv_sec ||
           now.st_mtim.tv_nsec != begin_.st_mtim.tv_nsec;
  }
  /// The very file is still under its name, and has not changed.
  bool is_still() const {
    struct stat now {};
    return known_ && !changed() && stat(path_.c_str(), &now) == 0 && now.st_ino == begin_.st_ino &&
           now.st_dev == begin_.st_dev;
  }

 private:
  std::string path_;
  int fd_;
  struct stat begin_ {};
  bool known_ = false;
};

class BridgeProgram final : public Program {
 public:
  BridgeProgram(const ProgramOptions& options, std::string kerf_interp,
                std::vector<ToolTableRow> tools, TextSurvey survey, TorchRun torch)
      : options_(options),
        kerf_interp_(std::move(kerf_interp)),
        tools_(std::move(tools)),
        survey_(std::move(survey)),
        torch_(std::move(torch)) {}

  const std::vector<ProgramComment>& comments() const override { return survey_.comments; }
  ProgramSummary run(const MotionSink& sink, std::stop_token stop,
                     Diagnostics& diagnostics) override;
  double progress() const override { return progress_; }

 private:
  /// A child that can be started.
  struct Prepared {
    PrivateFolder folder;  // first: removed after the child is gone
    InterpreterProcessOptions child;
  };
  /// What a run collects.
  struct Reading {
    const RecordReader& records;
    const MotionFeeder& feeder;
    const std::string& stderr_text;
    ProgramSummary& summary;
    Diagnostics& diagnostics;
  };
  Result<Prepared> prepare_child() const;
  Done place_references(Prepared& prepared) const;
  std::string cache_key(const Prepared& prepared) const;
  bool can_be_kept(const RecordReader& records, ChildEnding ending, const std::string& stderr_text,
                   const ProgramSummary& summary) const;
  std::vector<FileRead> reads_outside(const RecordReader& records, const Prepared& prepared) const;
  Result<std::string> parameters_for(const std::string& home) const;
  Result<std::vector<std::string>> arguments(const std::string& home) const;
  std::string shown_name(const std::string& raw) const;
  void report(Severity severity, SourceRef place, std::string message, std::string hint,
              const Reading& reading) const;
  void report_ending(ChildEnding ending, InterpreterProcess* process, const Reading& reading) const;
  void report_exit(InterpreterProcess::Exit exit, const Reading& reading) const;
  void report_fault(const InterpreterFault& fault, const Reading& reading) const;

  ProgramOptions options_;
  std::string kerf_interp_;
  std::vector<ToolTableRow> tools_;
  TextSurvey survey_;
  TorchRun torch_;
  std::atomic<double> progress_{0};
};

/// A probe is sent off from G28 or G30, whose places nobody has said. At the interpreter's 0 it may
/// stand where it is sent to, which the interpreter refuses.
bool probes_from_reference(const std::string& path) {
  TextPieces pieces(path);
  bool probes = false, goes = false;
  for (std::string_view text; pieces.next(text) && !(probes && goes);) {
    while (!text.empty()) {
      const std::string_view line = take_line(text);
      const auto has = [&](std::string_view word) {
        return std::search(line.begin(), line.end(), word.begin(), word.end(),
                           [](char a, char b) { return (a | 0x20) == (b | 0x20); }) != line.end();
      };
      probes = probes || has("g38.");
      goes = goes || has("g28") || has("g30");
    }
  }
  return probes && goes;
}

/// The interpreter rewrites its parameters; a path that cannot exist is not written.
Result<std::string> BridgeProgram::parameters_for(const std::string& home) const {
  const InterpreterSetup& machine = options_.machine;
  std::string path = home + "/parameters";
  if (machine.parameter_path.empty() && !machine.work_offset) return home + "/none/parameters";
  if (!machine.work_offset) {
    std::error_code error;
    fs::copy_file(machine.parameter_path, path, error);
    if (!error) return path;
    return Error{trf("cannot read {}: {}", machine.parameter_path, error.message())};
  }
  // The interpreter itself tells the faults of the file.
  Diagnostics ignored;
  const Result<ParameterFile> values =
      parameters_of(machine, mm_of_unit(machine.inch_machine), ignored);
  if (!values) return Error{values.error()};
  std::ofstream file(path);
  if (file << values->text() << std::flush) return path;
  return Error{trf("cannot write {}: {}", path, std::strerror(errno))};
}

/// Places for G28 and G30 where nobody has said any. It hangs on the program's text alone, which
/// takes time to look through; records that are kept do not need it.
Done BridgeProgram::place_references(Prepared& prepared) const {
  const InterpreterSetup& machine = options_.machine;
  if (!machine.parameter_path.empty() || machine.work_offset) return std::monostate{};
  if (!probes_from_reference(options_.path)) return std::monostate{};
  constexpr double kAway_mm = 1;
  const double away = kAway_mm / mm_of_unit(machine.inch_machine);
  ParameterFile references;
  for (const int z : {5163, 5183}) references.values[z] = away;
  const std::string path = prepared.child.home + "/parameters";
  std::ofstream file(path);
  if (!(file << references.text() << std::flush)) {
    return Error{trf("cannot write {}: {}", path, std::strerror(errno))};
  }
  std::vector<std::string>& arguments = prepared.child.arguments;
  *(std::find(arguments.begin(), arguments.end(), "--parameters") + 1) = path;
  return std::monostate{};
}

Result<std::vector<std::string>> BridgeProgram::arguments(const std::string& home) const {
  const InterpreterSetup& machine = options_.machine;
  const auto cannot_write = [](const std::string& path) {
    return Error{trf("cannot write {}: {}", path, std::strerror(errno))};
  };
  const std::string tool_path = home + "/tools";
  std::ofstream tool_file(tool_path);
  const double unit_mm = mm_of_unit(machine.inch_machine);
  for (const ToolTableRow& row : tools_) tool_file << tool_row(row, unit_mm, machine);
  if (!tool_file.flush()) return cannot_write(tool_path);
  const std::string torch_path = home + "/torch";
  std::ofstream torch_file(torch_path);
  if (!(torch_file << torch_run_text(torch_) << std::flush)) return cannot_write(torch_path);
  const Result<std::string> parameters = parameters_for(home);
  if (!parameters) return Error{parameters.error()};
  std::vector<std::string> out = {"--records",      std::to_string(kListingFd),
                                  "--units",        machine.inch_machine ? "inch" : "mm",
                                  "--axes",         std::to_string(machine.axis_mask),
                                  "--tools",        tool_path,
                                  "--torch",        torch_path,
                                  "--parameters",   *parameters,
                                  "--block-delete", options_.block_delete ? "on" : "off"};
  if (machine.start != std::array<double, 9>{}) {
    out.insert(out.end(), {"--start", fmt::format("{}", fmt::join(machine.start, " "))});
  }
  if (machine.first_line > 0) {
    out.insert(out.end(), {"--first-line", std::to_string(machine.first_line)});
  }
  if (machine.there) {
    out.insert(out.end(), {"--there", fmt::format("{}", fmt::join(*machine.there, " "))});
  }
  if (!options_.interp_fast) out.insert(out.end(), {"--fast", "off"});
  if (answer_probe_) out.insert(out.end(), {"--answers", std::to_string(kAnswerFd)});
  if (machine.random_toolchanger) out.emplace_back("--random-toolchanger");
  if (!machine.tool_change_position.empty()) {
    out.insert(out.end(),
               {"--tool-change", fmt::format("{}", fmt::join(machine.tool_change_position, " "))});
  }
  if (!machine.startup_code.empty()) {
    out.insert(out.end(), {"--startup", machine.startup_code});
  }
  out.insert(out.end(), {"--", fs::absolute(options_.path).string()});
  return out;
}

Result<BridgeProgram::Prepared> BridgeProgram::prepare_child() const {
  auto folder = PrivateFolder::create();
  if (!folder) return Error{folder.error()};
  const std::string home = folder->path() + "/home";
  if (mkdir(home.c_str(), 0700) != 0) {
    return Error{trf("cannot make the folder {}: {}", home, std::strerror(errno))};
  }
  auto given = arguments(home);
  if (!given) return Error{given.error()};
  InterpreterProcessOptions child;
  child.executable = kerf_interp_;
  child.arguments = std::move(*given);
  child.home = home;
  child.answers = answer_probe_ != nullptr;
  child.folder = options_.machine.working_folder.empty()
                     ? fs::absolute(options_.path).parent_path().string()
                     : options_.machine.working_folder;
  child.ini = options_.machine.ini_path;
  if (child.ini.empty() || !options_.machine.ini_text.empty()) {
    // LinuxCNC's own start script puts the includes in place; the interpreter does not know them.
    child.ini = home + "/kerf.ini";
    const std::string text =
        options_.machine.ini_path.empty()
            ? makeshift_ini(fs::current_path().string(), options_.machine.random_toolchanger,
                            torch_.qtplasmac)
            : options_.machine.ini_text;
    std::ofstream ini(child.ini);
    if (!(ini << text << std::flush)) {
      return Error{trf("cannot write {}: {}", child.ini, std::strerror(errno))};
    }
  }
  return Prepared{std::move(*folder), std::move(child)};
}

/// All that the records hang on, but for what the interpreter itself finds and reads. Empty: they
/// are not to be kept.
std::string BridgeProgram::cache_key(const Prepared& prepared) const {
  if (options_.cache_folder.empty()) return {};
  const InterpreterProcessOptions& child = prepared.child;
  const std::optional<FileContents> program = contents_of(options_.path);
  const Result<std::string> ini = read_small_file(child.ini, kMostIniBytes);
  // What Python does for a remap is its own affair.
  if (!program || !ini || to_lower(*ini).find("[python]") != ini->npos) return {};
  std::string key;
  const auto add = [&key](std::string_view part) {
    key += fmt::format("{}:{}\n", part.size(), part);
  };
  add(fmt::format("{} {:016x}{:016x}", program->size, program->hash[0], program->hash[1]));
  add(child.executable);
  add(fs::current_path().string());
  add(child.folder);
  add(child.ini.starts_with(child.home) ? "" : child.ini);
  add(*ini);
  // The private folder has another name in each run; what is in it counts.
  for (const std::string& argument : child.arguments) {
    add(argument.starts_with(child.home) ? argument.substr(child.home.size()) : argument);
  }
  for (const char* name : {"/tools", "/torch", "/parameters"}) {
    const Result<std::string> text = read_small_file(child.home + name, kMostIniBytes);
    add(text ? *text : "");
  }
  for (const char* name : {"LD_LIBRARY_PATH", "LD_PRELOAD", "PYTHONPATH", "PYTHONHOME", "PATH"}) {
    const char* const value = std::getenv(name);
    add(value != nullptr ? value : "");
  }
  return key;
}

bool BridgeProgram::can_be_kept(const RecordReader& records, ChildEnding ending,
                                const std::string& stderr_text,
                                const ProgramSummary& summary) const {
  return ending == ChildEnding::kComplete && records.damage().empty() && records.can_be_kept() &&
         stderr_text.empty() && summary.foreign_line_count == 0;
}

std::vector<FileRead> BridgeProgram::reads_outside(const RecordReader& records,
                                                   const Prepared& prepared) const {
  std::vector<FileRead> out;
  const std::string program = fs::absolute(options_.path).string();
  for (const FileRead& read : records.reads()) {
    if (read.path != program && !read.path.starts_with(prepared.child.home)) out.push_back(read);
  }
  return out;
}

/// A file as the user would name it: relative to where kerf was started, if it is beneath.
std::string BridgeProgram::shown_name(const std::string& raw) const {
  if (raw.empty()) return options_.path;
  const fs::path program = fs::absolute(options_.path).lexically_normal();
  const fs::path base = options_.machine.working_folder.empty()
                            ? program.parent_path()
                            : fs::path(options_.machine.working_folder);
  const fs::path path = (base / raw).lexically_normal();  // an absolute one stays as it is
  if (path == program) return options_.path;
  if (path.parent_path() == program.parent_path()) {
    // Beside the program: as the program was named.
    return (fs::path(options_.path).parent_path() / path.filename()).string();
  }
  const fs::path here = path.lexically_relative(fs::current_path());
  return here.empty() || *here.begin() == ".." ? path.string() : here.string();
}

void BridgeProgram::report(Severity severity, SourceRef place, std::string message,
                           std::string hint, const Reading& reading) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.file = place.file < files_.size() ? files_[place.file] : options_.path;
  diagnostic.line = static_cast<int>(place.line);
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  reading.diagnostics.push_back(std::move(diagnostic));
}

void BridgeProgram::report_fault(const InterpreterFault& fault, const Reading& reading) const {
  SourceRef place = fault.place;
  // Within a call the line of a block that could not even be read is the next one, or a later one.
  if (!fault.callers.empty() && place.file < files_.size()) {
    place.line = find_line(files_[place.file], fault.echo, place.line);
  }
  // Before the first block the fault is of the INI or of the parameters, and the interpreter rather
  // prints than returns it.
  const bool of_setup = place.line == 0 && fault.callers.empty();
  std::string message = one_line(of_setup ? reading.stderr_text : fault.message);
  if (message.empty()) message = one_line(fault.message);
  // An error of the code that serves a remap comes without a line; that of the call is the nearest.
  if (place.line == 0 && !of_setup) place = fault.callers.front();
  Diagnostic diagnostic = placed_diagnostic(message, place, files_, reading.summary.program_lines);
  const InterpreterSetup& machine = options_.machine;
  if (of_setup && fault.message.rfind("Parameter file", 0) == 0) {
    diagnostic.file = machine.parameter_path;
  } else if (of_setup && !reading.stderr_text.empty() && !machine.ini_path.empty()) {
    diagnostic.file = machine.ini_path;
  }
  if (diagnostic.excerpt.empty() && diagnostic.severity == Severity::kError) {
    diagnostic.excerpt = fault.echo;
  }
  std::string callers;
  for (const SourceRef& caller : fault.callers) {
    // A call that fails is its own caller.
    if (caller.file >= files_.size() || (callers.empty() && caller == fault.place)) continue;
    callers += fmt::format("{}{}:{}", callers.empty() ? tr("called from ") : tr(", from "),
                           files_[caller.file], caller.line);
  }
  if (!callers.empty()) {
    diagnostic.hint += diagnostic.hint.empty() ? callers : "; " + callers;
  }
  reading.diagnostics.push_back(std::move(diagnostic));
  reading.summary.end_remarked = is_missing_end(message);
}

void BridgeProgram::report_exit(InterpreterProcess::Exit exit, const Reading& reading) const {
  for (const InterpreterFault& fault : reading.records.faults()) report_fault(fault, reading);
  if (exit.signal != 0) {
    report(Severity::kError, reading.records.place(),
           trf("kerf-interp was ended by signal {} ({})", exit.signal, strsignal(exit.signal)),
           tr("--interp text uses rs274 instead"), reading);
    return;
  }
  if (!reading.records.ended()) {
    std::string said = reading.stderr_text.substr(0, reading.stderr_text.find('\n'));
    if (said.find("error while loading shared libraries") != said.npos) {
      report(Severity::kError, reading.records.place(),
             trf("LinuxCNC's interpreter is not installed, or not all of it: {}", said),
             tr("sudo apt install --no-remove linuxcnc-uspace"), reading);
      return;
    }
    report(Severity::kError, reading.records.place(),
           said.empty() ? trf("kerf-interp ended with status {} in the middle", exit.status)
                        : trf("kerf-interp ended in the middle: {}", said),
           tr("--interp text uses rs274 instead"), reading);
    return;
  }
  if (reading.records.faults().empty() && !reading.summary.has_program_end) {
    reading.summary.end_remarked = true;
    report(Severity::kWarning, reading.records.place(),
           tr("the program ended without M2, M30 or %"), {}, reading);
  }
}

void BridgeProgram::report_ending(ChildEnding ending, InterpreterProcess* process,
                                  const Reading& reading) const {
  const auto end_it = [process] {
    if (process != nullptr) process->kill();
  };
  const RecordReader& records = reading.records;
  reading.summary.stopped_early = ending != ChildEnding::kComplete;
  if (!records.damage().empty()) {
    end_it();
    report(Severity::kError, records.place(),
           trf("the records of {} cannot be read: {}", kerf_interp_, records.damage()),
           tr("kerf and kerf-interp must be of one version"), reading);
    return;
  }
  constexpr const char* kLoop = tr_noop("a loop whose condition stays true?");
  switch (ending) {
    case ChildEnding::kComplete:
      report_exit(process != nullptr ? process->wait() : InterpreterProcess::Exit{}, reading);
      break;
    case ChildEnding::kStopped:
      break;
    case ChildEnding::kTooMany:
      report(Severity::kError, records.place(),
             trf("more than {} canonical commands; the program counts as endless",
                 command_limit(options_, survey_.lines)),
             tr(kLoop), reading);
      break;
    case ChildEnding::kSilent:
      end_it();
      report(Severity::kError, records.place(),
             trf("no motion or other command for {} s; the program counts as endless",
                 options_.max_silent_s),
             std::string(tr("the interpreter is here; ")) + tr(kLoop), reading);
      break;
    case ChildEnding::kRepeating:
      end_it();
      report(Severity::kError, records.place(), repeat_message(reading.feeder.repeats()),
             std::string(tr(kLoop)) + tr(" --max-seconds allows more"), reading);
      break;
    case ChildEnding::kTooLong:
      end_it();
      report(Severity::kError, records.place(), cpu_message(options_), {}, reading);
      break;
  }
}

ProgramSummary BridgeProgram::run(const MotionSink& sink, std::stop_token stop,
                                  Diagnostics& diagnostics) {
  const auto begin = Clock::now();
  ProgramSummary summary;
  summary.files = files_ = {options_.path};
  summary.program_lines = survey_.lines;
  summary.interpreter = "bridge";
  const Contents contents(options_.path);
  ToolDiameters diameters;
  tools_ = with_known_diameters(std::move(tools_), !options_.tool_table_path.empty(),
                                known_tools_.diameters, diameters);
  const auto cannot_begin = [&](const std::string& why) {
    Diagnostic diagnostic;
    diagnostic.file = options_.path;
    diagnostic.message = why;
    diagnostics.push_back(std::move(diagnostic));
    return summary;
  };
  auto prepared = prepare_child();
  if (!prepared) return cannot_begin(prepared.error());
  const RecordCache cache(options_.cache_folder, options_.cache_bytes);
  const std::string key = cache_key(*prepared);
  std::optional<CachedRecords> cached;
  if (!key.empty()) cached = cache.find(key);
  std::optional<RecordStore> store;
  if (!key.empty() && !cached) store = cache.begin(key);
  std::optional<InterpreterProcess> process;
  if (!cached) {
    if (const Done placed = place_references(*prepared); !placed) {
      return cannot_begin(placed.error());
    }
    auto started = InterpreterProcess::start(prepared->child);
    if (!started) return cannot_begin(started.error());
    process.emplace(std::move(*started));
  }
  const MotionSink named_sink = [&](std::span<const Motion> motions) {
    if (files_.size() != summary.files.size()) files_ = summary.files;
    return sink(motions);
  };
  MotionFeederOptions feeding;
  feeding.has_tool_table = !options_.tool_table_path.empty();
  feeding.diameters = std::move(diameters);
  feeding.max_commands = command_limit(options_, survey_.lines);
  feeding.frame = &frame_;
  feeding.work = options_.machine.work;
  feeding.lengths.axes = static_cast<unsigned>(options_.machine.length_axes);
  feeding.lengths.lengths = known_lengths(tools_, feeding.lengths.axes);
  feeding.lengths.calls = options_.machine.tool_lengths ? ToolLengthSetup::Calls::kTrue
                                                        : ToolLengthSetup::Calls::kHidden;
  feeding.lengths.table_unit_mm = mm_of_unit(options_.machine.inch_machine);
  feeding.lengths.start_z_mm = options_.machine.start[2];
  feeding.lengths.displaces = options_.machine.straight_axes;
  feeding.torch = torch_;
  feeding.signals = options_.signals;
  feeding.follows_probes = follows_probes_;
  feeding.answer_probe = answer_probe_;
  feeding.no_answer = tr("no blank is given, --stock does");
  feeding.materials = &materials_;
  const InterpreterSetup& machine = options_.machine;
  if (machine.start_known) feeding.start = machine.start;
  feeding.places = {machine.unknown_places && !machine.start_known, machine.start,
                    machine.work_offset || !machine.parameter_path.empty(), machine.z_matters,
                    !known_tools_.turning};
  MotionFeeder feeder(std::move(feeding), named_sink, summary, diagnostics);
  RecordReader records(
      feeder, [&](const std::string& raw) { return shown_name(raw); }, summary);
  if (answer_probe_) {
    records.answer_by([&process](const records::Answer& answer) {
      return process && process->answer(&answer, sizeof answer);
    });
  }
  const double lines = static_cast<double>(std::max<std::size_t>(1, survey_.lines));
  const auto on_progress = [&] {
    const SourceRef place = records.place();
    if (place.file == 0) progress_ = std::min(1.0, static_cast<double>(place.line) / lines);
  };
  std::string stderr_text;
  ChildEnding ending{};
  if (cached) {
    ending = replay(*cached, records, feeder, stop, on_progress);
  } else {
    KeepingReader keeping(records, store);
    ChildListener listener(*process, keeping, feeder, options_);
    ending = listener.listen(stop, on_progress);
    stderr_text = listener.stderr_text();
  }
  feeder.finish();
  if (summary.files.empty()) summary.files.push_back(options_.path);  // it never spoke
  files_ = summary.files;
  const Reading reading{records, feeder, stderr_text, summary, diagnostics};
  report_ending(ending, process ? &*process : nullptr, reading);
  if (store && can_be_kept(records, ending, stderr_text, summary) && contents.is_still()) {
    store->commit(reads_outside(records, *prepared));
  }
  if (contents.changed()) {
    report(Severity::kError, {0, 0},
           tr("the program was changed while it was read: this result is that of no program"),
           tr("run it again"), reading);
  }
  if (ending == ChildEnding::kComplete) progress_ = 1;
  summary.interpret_s = std::chrono::duration<double>(Clock::now() - begin).count();
  return summary;
}

}  // namespace

std::unique_ptr<Program> make_bridge_program(const ProgramOptions& options, std::string kerf_interp,
                                             std::vector<ToolTableRow> tools, TextSurvey survey,
                                             TorchRun torch) {
  return std::make_unique<BridgeProgram>(options, std::move(kerf_interp), std::move(tools),
                                         std::move(survey), std::move(torch));
}

}  // namespace kerf
