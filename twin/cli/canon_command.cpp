#include "twin/cli/canon_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <stop_token>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/program_options.h"
#include "twin/cli/progress_bar.h"
#include "twin/cli/stdin_program.h"
#include "twin/cli/stop_signals.h"
#include "twin/machine/motion_json.h"

namespace kerf {
namespace {

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

int canon_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics, {arguments.command, &arguments.options, nullptr, {}});
  ProgramRequest request = understand_program("PROGRAM", {}, reader);
  const bool quiet = reader.is_yes("--quiet");
  const std::string out = reader.text("--out");
  if (has_error(diagnostics)) {
    print_diagnostics(diagnostics, quiet);
    return kExitUsage;
  }
  show_lengths_in(reader.unit());
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  StdinProgram kept;
  kept.take(request.program.path, StdinProgram::Listings::kStreamed, stop.get_token(), diagnostics);
  const auto program =
      has_error(diagnostics) ? nullptr : Program::open(request.program, diagnostics);
  if (!program) {
    for (Diagnostic& d : diagnostics) d.file = kept.renamed(std::move(d.file));
    print_diagnostics(diagnostics, quiet);
    return kExitFailure;
  }
  Result<AtomicFile> file = AtomicFile::create(out);
  if (!file) {
    print_text(stderr, trf("kerf: error: {}\n", file.error()));
    return kExitFailure;
  }
  LineWriter writer(*file, request.timeline);
  ProgramSummary summary;
  {
    const bool shown = !quiet && out != "-";
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
  print_diagnostics(diagnostics, quiet);
  if (!written) print_text(stderr, trf("kerf: error: {}\n", written.error()));
  if (!written || has_error(diagnostics) || summary.stopped_early) return kExitFailure;
  return summary.lost_splines > 0 ? kExitLossy : kExitGood;
}

}  // namespace kerf
