#include "twin/app/canon_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <stop_token>

#include "base/atomic_file.h"
#include "twin/app/console.h"
#include "twin/app/exit_code.h"
#include "twin/app/progress_bar.h"
#include "twin/app/stdin_program.h"
#include "twin/app/stop_signals.h"
#include "twin/motion_json.h"

namespace kerf {
namespace {

void print(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& d : diagnostics) {
    if (!quiet || d.severity == Severity::kError) print_diagnostic(stderr, d);
  }
}

/// Motions to text to the file, a batch at a time.
class LineWriter : private StepSink {
 public:
  LineWriter(AtomicFile& file, const TimelineOptions& options)
      : file_(file), timeline_(options, *this) {}

  /// False: nobody takes the text any more.
  bool write(const std::vector<std::string>& files, std::span<const Motion> motions) {
    json_.set_files(files);
    for (const Motion& m : motions) timeline_.push(m);
    return hand_over();
  }
  void finish() {
    timeline_.finish();
    hand_over();
  }

 private:
  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece>) override {
    json_.append(motion, timed, text_);
  }
  bool hand_over() {
    file_.write(text_.data(), text_.size());
    text_.clear();
    return !file_.failed();
  }

  AtomicFile& file_;
  Timeline timeline_;
  MotionJson json_;
  std::string text_;
};

}  // namespace

int canon_command(const CanonArguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics,
                      understand_units(arguments.source.units, std::nullopt, diagnostics));
  show_lengths_in(reader.unit());
  ProgramRequest request = understand_program(arguments.source, reader);
  if (has_error(diagnostics)) {
    print(diagnostics, arguments.quiet);
    return kExitUsage;
  }
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  StdinProgram kept;
  kept.take(request.program.path, StdinProgram::Listings::kStreamed, stop.get_token(), diagnostics);
  const auto program =
      has_error(diagnostics) ? nullptr : Program::open(request.program, diagnostics);
  if (!program) {
    for (Diagnostic& d : diagnostics) d.file = kept.renamed(std::move(d.file));
    print(diagnostics, arguments.quiet);
    return kExitFailure;
  }
  Result<AtomicFile> file = AtomicFile::create(arguments.out);
  if (!file) {
    kerf::print(stderr, "kerf: error: {}\n", file.error());
    return kExitFailure;
  }
  LineWriter writer(*file, request.timeline);
  ProgramSummary summary;
  {
    const bool shown = !arguments.quiet && arguments.out != "-";
    const ProgressBar bar([&] { return program->progress(); }, shown);
    summary = program->run(
        [&](std::span<const Motion> motions) {
          std::vector<std::string> files = program->files();
          for (std::string& name : files) name = kept.renamed(std::move(name));
          return writer.write(files, motions);
        },
        stop.get_token(), diagnostics);
  }
  for (Diagnostic& d : diagnostics) d.file = kept.renamed(std::move(d.file));
  writer.finish();
  const Done written = file->commit();
  print(diagnostics, arguments.quiet);
  if (!written) kerf::print(stderr, "kerf: error: {}\n", written.error());
  if (!written || has_error(diagnostics) || summary.stopped_early) return kExitFailure;
  return summary.lost_splines > 0 ? kExitLossy : kExitGood;
}

}  // namespace kerf
