#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/canonical_reader.h"
#include "interp_bridge/child_listener.h"
#include "interp_bridge/interpreter_process.h"
#include "interp_bridge/parameter_file.h"
#include "interp_bridge/private_folder.h"
#include "interp_bridge/program_kinds.h"
#include "interp_bridge/program_prepare.h"
#include "interp_bridge/rs274_messages.h"
#include "interp_bridge/tool_table.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

/// The second run of a program that fell silent need not wait as long to call it so.
constexpr double kSilenceAgain_s = 2.0;
/// rs274 2.9 reads tables and parameters in inches, whatever the machine.
constexpr double kTableUnit_mm = kMmPerInch;

class NcProgram final : public Program {
 public:
  NcProgram(const ProgramOptions& options, std::string rs274, std::vector<ToolTableRow> tools,
            TextSurvey survey, TorchRun torch)
      : options_(options),
        rs274_(std::move(rs274)),
        tools_(std::move(tools)),
        survey_(std::move(survey)),
        torch_(std::move(torch)) {}

  const std::vector<ProgramComment>& comments() const override { return survey_.comments; }
  ProgramSummary run(const MotionSink& sink, std::stop_token stop,
                     Diagnostics& diagnostics) override;
  double progress() const override { return progress_; }

 private:
  /// A child that can be listened to, and what it needs while it runs.
  struct Session {
    PrivateFolder folder;  // first: removed after the child is gone
    PreparedProgram prepared;
    InterpreterToolTable table;
    InterpreterProcessOptions child;
    InterpreterProcess process;

    std::string copy_path() const { return folder.path() + "/nc/" + prepared.main_name; }
  };
  Result<Session> start_session() const;
  /// rs274 is given the machine's work offsets.
  bool has_parameters() const {
    return options_.machine.work_offset || !options_.machine.parameter_path.empty();
  }
  std::vector<std::string> rs274_arguments(const PreparedProgram& prepared, const std::string& home,
                                           const std::string& table_path) const;
  CanonicalReaderOptions reader_options(const Session& session) const;
  void report(Severity severity, SourceRef place, std::string message, std::string hint,
              const ProgramSummary& summary, Diagnostics& diagnostics) const;
  void report_ending(ChildEnding ending, Session& session, CanonicalReader& reader,
                     const std::string& stderr_text, const std::stop_token& stop,
                     ProgramSummary& summary, Diagnostics& diagnostics) const;
  void report_exit(InterpreterProcess::Exit exit, CanonicalReader& reader,
                   const std::string& stderr_text, ProgramSummary& summary,
                   Diagnostics& diagnostics) const;
  std::string silence_message(const Session& session) const;
  SourceRef source_before_silence(const Session& session, const std::stop_token& stop) const;

  ProgramOptions options_;
  std::string rs274_;
  std::vector<ToolTableRow> tools_;
  TextSurvey survey_;
  TorchRun torch_;
  ToolDiameters told_diameters_;
  std::atomic<double> progress_{0};
};

Result<NcProgram::Session> NcProgram::start_session() const {
  auto folder = PrivateFolder::create();
  if (!folder) return Error{folder.error()};
  const std::string nc = folder->path() + "/nc";
  const std::string home = folder->path() + "/home";
  for (const std::string& path : {nc, home}) {
    if (mkdir(path.c_str(), 0700) != 0) {
      return Error{trf("cannot make the folder {}: {}", path, std::strerror(errno))};
    }
  }
  auto prepared = prepare_program(options_.path, nc);
  if (!prepared) return Error{prepared.error()};
  InterpreterToolTable table = interpreter_tool_table(tools_, prepared->tools);
  const std::string table_path = folder->path() + "/tool.tbl";
  std::ofstream table_file(table_path);
  if (!(table_file << table.text << std::flush)) {
    return Error{trf("cannot write {}: {}", table_path, std::strerror(errno))};
  }
  if (has_parameters()) {
    const double unit_mm = options_.machine.inch_machine ? kTableUnit_mm : 1.0;
    Diagnostics ignored;  // LinuxCNC reads what it can, too
    Result<ParameterFile> values = parameters_of(options_.machine, unit_mm, ignored);
    if (!values) return Error{values.error()};
    values->scale_lengths(unit_mm / kTableUnit_mm);
    const std::string path = home + "/x.var";
    std::ofstream file(path);
    if (!(file << values->text() << std::flush)) {
      return Error{trf("cannot write {}: {}", path, std::strerror(errno))};
    }
  }
  InterpreterProcessOptions child;
  child.executable = rs274_;
  child.arguments = rs274_arguments(*prepared, home, table_path);
  child.arguments.emplace_back(kListingPath);
  child.folder = nc;
  child.home = home;
  auto process = InterpreterProcess::start(child);
  if (!process) return Error{process.error()};
  return Session{std::move(*folder), std::move(*prepared), std::move(table), std::move(child),
                 std::move(*process)};
}

/// All but the file for the listing. To a file rs274 writes 4 KB at a time, to stdout line by line,
/// which takes twice the time.
std::vector<std::string> NcProgram::rs274_arguments(const PreparedProgram& prepared,
                                                    const std::string& home,
                                                    const std::string& table_path) const {
  std::vector<std::string> arguments;
  if (options_.block_delete) arguments.emplace_back("-b");
  // A name that begins with a dash would be an option; others go as they are, since messages repeat
  // them.
  const std::string& name = prepared.main_name;
  const std::string program = name.front() == '-' ? "./" + name : name;
  // No var file: a path that cannot exist is not written either. (rs274 replaces its var file, even
  // /dev/null.)
  const std::string parameters = home + (has_parameters() ? "/x.var" : "/none/x.var");
  arguments.insert(arguments.end(), {"-t", table_path, "-v", parameters, "-g", program});
  return arguments;
}

CanonicalReaderOptions NcProgram::reader_options(const Session& session) const {
  CanonicalReaderOptions reading;
  reading.listing_name = "rs274's output";
  reading.numbered_source = true;
  reading.unnumbered = session.prepared.unnumbered;
  reading.feeder.tool_by_index = session.table.tool_by_index;
  reading.feeder.has_tool_table = !options_.tool_table_path.empty();
  reading.feeder.diameters = told_diameters_;
  reading.feeder.max_commands = command_limit(options_, survey_.lines);
  reading.feeder.lengths.axes = static_cast<unsigned>(options_.machine.length_axes);
  reading.feeder.lengths.lengths = known_lengths(tools_, reading.feeder.lengths.axes);
  reading.feeder.lengths.calls = ToolLengthSetup::Calls::kCoded;
  reading.feeder.lengths.table_unit_mm = kTableUnit_mm;
  reading.feeder.lengths.displaces = options_.machine.straight_axes;
  reading.feeder.torch = torch_;
  reading.feeder.signals = options_.signals;
  const InterpreterSetup& machine = options_.machine;
  reading.feeder.places = {
      machine.unknown_places, {}, has_parameters(), machine.z_matters, !known_tools_.turning};
  reading.feeder.follows_probes = follows_probes_;
  reading.feeder.no_answer = tr("rs274 cannot ask, --interp bridge can");
  return reading;
}

void NcProgram::report(Severity severity, SourceRef place, std::string message, std::string hint,
                       const ProgramSummary& summary, Diagnostics& diagnostics) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  if (place.file < summary.files.size()) diagnostic.file = summary.files[place.file];
  diagnostic.line = static_cast<int>(place.line);
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  diagnostics.push_back(std::move(diagnostic));
}

std::string NcProgram::silence_message(const Session& session) const {
  std::string message = trf("no motion or other command for {} s; the program counts as endless",
                            options_.max_silent_s);
  std::uint64_t left = session.process.read_offset(session.copy_path());
  std::size_t line = 1;
  TextPieces pieces(session.copy_path());
  std::string_view piece;
  while (left > 0 && pieces.next(piece)) {
    const std::string_view read = piece.substr(0, static_cast<std::size_t>(left));
    line += static_cast<std::size_t>(std::count(read.begin(), read.end(), '\n'));
    left -= read.size();
  }
  if (line > 1 && line < session.prepared.lines) {
    message += trf(" (rs274 has read up to line {} at most)", line);
  }
  return message;
}

/// rs274 keeps up to 4 KB of its listing to itself, so that the last line that we saw is not the
/// last one before the silence. A second run without that buffer tells; whatever else it says is
/// known already.
SourceRef NcProgram::source_before_silence(const Session& session,
                                           const std::stop_token& stop) const {
  InterpreterProcessOptions child = session.child;
  child.arguments.pop_back();  // without a file it prints to stdout, every command at once
  child.listing_is_stdout = true;
  auto process = InterpreterProcess::start(child);
  if (!process) return {};
  ProgramSummary scratch;
  Diagnostics ignored;
  const MotionSink sink = [](std::span<const Motion>) { return true; };
  CanonicalReader reader(reader_options(session), sink, scratch, ignored);
  ProgramOptions limits = options_;
  limits.max_silent_s = std::min(kSilenceAgain_s, options_.max_silent_s);
  ChildListener listener(*process, reader, reader.feeder(), limits);
  listener.listen(stop, [] {});
  return reader.feeder().last_source();
}

void NcProgram::report_exit(InterpreterProcess::Exit exit, CanonicalReader& reader,
                            const std::string& stderr_text, ProgramSummary& summary,
                            Diagnostics& diagnostics) const {
  if (exit.signal != 0) {
    report(Severity::kError, reader.feeder().last_source(),
           trf("rs274 was ended by signal {} ({})", exit.signal, strsignal(exit.signal)), {},
           summary, diagnostics);
    return;
  }
  if (exit.status != 0) {
    diagnostics.push_back(interpreter_diagnostic(
        stderr_text, summary.files, reader.feeder().last_source(), summary.program_lines));
    summary.end_remarked = is_missing_end(parse_interpreter_message(stderr_text).message);
    return;
  }
  if (!summary.has_program_end) {
    summary.end_remarked = true;
    report(Severity::kWarning, reader.feeder().last_source(),
           tr("the program ended without M2, M30 or %"), {}, summary, diagnostics);
  }
}

void NcProgram::report_ending(ChildEnding ending, Session& session, CanonicalReader& reader,
                              const std::string& stderr_text, const std::stop_token& stop,
                              ProgramSummary& summary, Diagnostics& diagnostics) const {
  summary.stopped_early = ending != ChildEnding::kComplete;
  const SourceRef place = reader.feeder().last_source();
  switch (ending) {
    case ChildEnding::kComplete:
      report_exit(session.process.wait(), reader, stderr_text, summary, diagnostics);
      break;
    case ChildEnding::kStopped:
      break;
    case ChildEnding::kTooMany:
      report(Severity::kError, place,
             trf("more than {} canonical commands; the program counts as endless",
                 command_limit(options_, survey_.lines)),
             tr("a loop whose condition stays true?"), summary, diagnostics);
      break;
    case ChildEnding::kRepeating:
      session.process.kill();
      report(Severity::kError, place, repeat_message(reader.feeder().repeats()),
             tr("a loop whose condition stays true? --max-seconds allows more"), summary,
             diagnostics);
      break;
    case ChildEnding::kTooLong:
      session.process.kill();
      report(Severity::kError, place, cpu_message(options_), {}, summary, diagnostics);
      break;
    case ChildEnding::kSilent: {
      const std::string message = silence_message(session);
      session.process.kill();
      report(Severity::kError, source_before_silence(session, stop), message,
             tr("this line did something last; a loop behind it whose condition stays true?"),
             summary, diagnostics);
      break;
    }
  }
}

ProgramSummary NcProgram::run(const MotionSink& sink, std::stop_token stop,
                              Diagnostics& diagnostics) {
  const auto begin = Clock::now();
  ProgramSummary summary;
  summary.files = {options_.path};
  summary.program_lines = survey_.lines;
  summary.interpreter = "text";
  tools_ = with_known_diameters(std::move(tools_), !options_.tool_table_path.empty(),
                                known_tools_.diameters, told_diameters_);
  auto session = start_session();
  if (!session) {
    report(Severity::kError, {}, session.error(), {}, summary, diagnostics);
    return summary;
  }
  summary.files = files_ = session->prepared.files;
  CanonicalReaderOptions reading = reader_options(*session);
  reading.feeder.frame = &frame_;
  reading.feeder.materials = &materials_;
  if (!options_.machine.startup_code.empty()) {
    summary.notes.push_back(
        {{},
         trf("rs274 does not run the machine's startup code (RS274NGC_STARTUP_CODE = {}): the "
             "program begins as if there were none; --interp bridge runs it",
             options_.machine.startup_code),
         1,
         true});
  }
  const InputWaits& waits = session->prepared.waits;
  if (waits.count > 0 && !reading.feeder.torch.qtplasmac) {
    summary.notes.push_back(
        {waits.first,
         trf("rs274's text tells nothing of M66 ({} in the program): that the machine stops "
             "for it is not reckoned with; --interp bridge does",
             waits.count),
         1, true});
  }
  CanonicalReader reader(std::move(reading), sink, summary, diagnostics);
  ChildListener listener(session->process, reader, reader.feeder(), options_);
  const double lines = static_cast<double>(std::max<std::size_t>(1, survey_.lines));
  const ChildEnding ending = listener.listen(stop, [&] {
    const SourceRef source = reader.feeder().last_source();
    if (source.file == 0) progress_ = std::min(1.0, static_cast<double>(source.line) / lines);
  });
  reader.finish();
  report_ending(ending, *session, reader, listener.stderr_text(), stop, summary, diagnostics);
  if (ending == ChildEnding::kComplete) progress_ = 1;
  summary.interpret_s = std::chrono::duration<double>(Clock::now() - begin).count();
  return summary;
}

}  // namespace

std::unique_ptr<Program> make_nc_program(const ProgramOptions& options, std::string rs274,
                                         std::vector<ToolTableRow> tools, TextSurvey survey,
                                         TorchRun torch) {
  return std::make_unique<NcProgram>(options, std::move(rs274), std::move(tools), std::move(survey),
                                     std::move(torch));
}

}  // namespace kerf
