#include "twin/cli/optimize_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/command_line.h"
#include "twin/cli/console.h"
#include "twin/cli/cutting_options.h"
#include "twin/cli/outputs.h"
#include "twin/cli/progress_bar.h"
#include "twin/cli/run_ends.h"
#include "twin/cli/run_options.h"
#include "twin/cli/stop_signals.h"
#include "twin/cli/view_load.h"
#include "twin/diff/part_diff.h"
#include "twin/optimize/block_split.h"
#include "twin/optimize/feed_placer.h"
#include "twin/optimize/optimize_report.h"
#include "twin/optimize/unroll.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

struct OptimizeRequest {
  RunRequest run;
  FeedAims aims;
  std::string out;  ///< PROGRAM itself, if in_place
  bool in_place = false;
  std::string json;
};

void ask_for(OptionReader& reader, std::string_view option, std::optional<double>& value) {
  const double number =
      setting_of(option, kOptimize).is_length() ? reader.length_mm(option) : reader.number(option);
  if (number > 0) value = number;
}

/// The machine's own spindle limits what nobody has limited more.
void take_spindle(const CuttingWish& wish, double max_rpm, FeedAims& aims) {
  aims.spindle_max_rpm = max_rpm;
  if (!wish.material) return;
  aims.spindle_torque_nm = wish.spindle_torque_nm;
  std::optional<double>& power = aims.most[CutLimit::kPower];
  if (wish.spindle_power_kw > 0)
    power = std::min(power.value_or(wish.spindle_power_kw), wish.spindle_power_kw);
}

void understand_aims(OptionReader& reader, FeedAims& aims) {
  ask_for(reader, "--chip", aims.most[CutLimit::kChip]);
  ask_for(reader, "--max-rate", aims.most[CutLimit::kRate]);
  ask_for(reader, "--max-force", aims.most[CutLimit::kForce]);
  ask_for(reader, "--max-power", aims.most[CutLimit::kPower]);
  const CuttingWish wish = understand_cutting(reader);
  aims.material = wish.material;
  take_spindle(wish, reader.number("--spindle-max"), aims);
  if (wish.most_bend_mm > 0) aims.most[CutLimit::kDeflection] = wish.most_bend_mm;
  for (const char* option : {"--max-force", "--max-power"}) {
    if (!reader.text(option).empty() && reader.text("--material").empty())
      reader.fault(option, tr("is held against forces: --material says of what"));
  }
  ask_for(reader, "--max-feed", aims.most_feed_mm_per_min);
  ask_for(reader, "--air-feed", aims.air_feed_mm_per_min);
  aims.splits = reader.is_yes("--split");
  aims.unrolls = reader.is_yes("--unroll");
  if (aims.limits_cutting() || aims.most_feed_mm_per_min || aims.air_feed_mm_per_min) return;
  if (has_error(reader.diagnostics())) return;  // one of them may be among the faults
  reader.fault("--chip", tr("nothing says how fast it may be"),
               tr("--chip LENGTH, --max-rate MM3/S, --max-force N, --max-power KW, "
                  "--max-deflection LENGTH, --max-feed MM/MIN or --air-feed MM/MIN"));
}

/// Where the new program goes.
void understand_out(OptionReader& reader, const std::string& program, OptimizeRequest& request) {
  request.in_place = reader.is_yes("--in-place");
  request.out = reader.text("--out");
  if (request.in_place && !request.out.empty()) {
    reader.fault("--in-place", trf("--out {} says another place", request.out));
  } else if (request.in_place) {
    request.out = program;
  } else if (request.out.empty()) {
    reader.fault("--out", tr("nothing says where the new program goes"),
                 tr("--out FILE, or --in-place, which keeps a copy"));
  } else if (written_as_it_comes(request.out)) {
    reader.fault("--out", trf("{} cannot be read again, and the new program is", request.out),
                 tr("a file can"));
  } else {
    std::error_code ignored;
    if (fs::equivalent(request.out, program, ignored))
      reader.fault("--out", trf("{} is the program itself", request.out),
                   tr("--in-place does that, and keeps a copy"));
  }
}

OptimizeRequest understand_optimize(const Arguments& arguments, Diagnostics& diagnostics) {
  const std::optional<LiveConfig> read = read_config(arguments.options, diagnostics);
  const LiveConfig* const config = read ? &*read : nullptr;
  OptionReader reader(diagnostics, layers_of(arguments, config));
  OptimizeRequest request;
  request.run = understand_cut(config, reader);
  const std::string& program = request.run.session.program.path;
  if (program == "-") {
    reader.fault("PROGRAM", tr("standard input cannot be read more than once"),
                 tr("keep the program in a file"));
  } else if (view_kind_of(program) != ViewKind::kProgram) {
    reader.fault("PROGRAM", trf("{} is no NC program", program));
  }
  understand_aims(reader, request.aims);
  understand_out(reader, program, request);
  request.json = reader.text("--json");
  return request;
}

/// A program that has been cut.
struct CutRun {
  std::unique_ptr<Session> session;
  int code = kExitGood;

  const Report& report() const { return session->report(); }
};

/// In messages `path` is called `name`.
void rename(Diagnostics& diagnostics, const std::string& path, const std::string& name) {
  for (Diagnostic& d : diagnostics) {
    for (std::string* const text : {&d.file, &d.message}) {
      const std::size_t at = text->find(path);
      if (at != text->npos) text->replace(at, path.size(), name);
    }
  }
}

/// The name that a program has until it is known to be right, and the one it is to have.
struct NamedProgram {
  std::string path, name;
};

CutRun cut(const OptimizeRequest& request, const NamedProgram& program, FeedSurvey& survey,
           const std::stop_token& stop) {
  CutRun run;
  SessionOptions options = request.run.session;
  options.program.path = program.path;
  options.stock.keeps_cut_ids = true;
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  const auto tell = [&] {
    rename(diagnostics, program.path, program.name);
    print_diagnostics(diagnostics, request.run.quiet);
  };
  run.session = Session::open(std::move(options), diagnostics, outcome);
  if (!run.session) {
    tell();
    run.code = end_code(outcome, diagnostics);
    return run;
  }
  run.session->record_by(survey);
  run.session->log_engagement(survey);
  {
    const ProgressBar bar([&] { return run.session->progress(); }, !request.run.quiet);
    outcome = run.session->run(stop, diagnostics);
  }
  tell();
  print_stops(run.report());
  run.code = end_code(outcome, diagnostics);
  if (!run.report().partial_reason.empty()) run.code = kExitFailure;
  if (run.code == kExitGood) survey.settle();
  return run;
}

Diagnostic error_of(std::string message, std::string hint = {}) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

/// What cannot be made better, of a program that has been cut.
void check_subject(const OptimizeRequest& request, const CutRun& run, const FeedSurvey& survey,
                   Diagnostics& diagnostics) {
  const StockModel* const stock = run.session->stock();
  if (stock->sheet() || stock->turned())
    diagnostics.push_back(
        error_of(tr("feeds are worked out for milling: not for sheets, nor for what is turned")));
  if (run.report().program.interpreter == "canon")
    diagnostics.push_back(
        error_of(trf("{} is a listing, without F words to change", run.report().program_path)));
  if (!request.aims.needs_teeth()) return;
  for (const auto& [tool, shape] : survey.toothless()) {
    diagnostics.push_back(error_of(
        trf("how many teeth tool {} ({}) has is not known: chips and forces need it", tool, shape),
        trf("--tool {}={}:teeth=2, or a tool library that says it", tool, shape)));
  }
  if (!request.aims.most[CutLimit::kDeflection]) return;
  for (const auto& [tool, shape] : survey.unheld()) {
    diagnostics.push_back(error_of(
        trf("how far tool {} ({}) sticks out is not known: --max-deflection needs it", tool, shape),
        trf("--tool {}={}:holder=40x60:stickout=35", tool, shape)));
  }
}

/// Before a minute of cutting: whether the new program can be written.
void check_out(const OptimizeRequest& request, Diagnostics& diagnostics) {
  std::error_code ignored;
  const fs::file_status there = fs::status(request.out, ignored);
  const bool is_sealed =
      fs::exists(there) && (there.permissions() & fs::perms::owner_write) == fs::perms::none;
  if (is_sealed) {
    diagnostics.push_back(error_of(trf("{} is there, and read-only", request.out)));
    return;
  }
  const Result<AtomicFile> file = AtomicFile::create(request.out);
  if (!file) diagnostics.push_back(error_of(file.error()));
}

/// Feeds are limited by nothing that a thin cut has.
void doubt_aims(const FeedAims& aims, Diagnostics& diagnostics) {
  if (!aims.limits_cutting() || aims.most[CutLimit::kChip] || aims.most_feed_mm_per_min) return;
  Diagnostic d;
  d.severity = Severity::kWarning;
  d.message =
      tr("thin cuts may get any feed that the machine can do: --chip or --max-feed limits "
         "it");
  diagnostics.push_back(std::move(d));
}

OptimizedRun optimized_run(const CutRun& run, const FeedSurvey& survey) {
  return {run.report().motion.duration_s, survey.seconds_by_tool(), survey.peaks()};
}

/// Kept beside the program, under the first name that is free.
Result<std::string> keep_copy(const std::string& program, const std::string& text) {
  std::string name = program + ".bak";
  std::error_code ignored;
  for (int n = 2; fs::exists(fs::symlink_status(name, ignored)); ++n)
    name = fmt::format("{}.bak{}", program, n);
  if (const Done written = write_text(name, text); !written) return Error{written.error()};
  return name;
}

/// One run of the command, from a program that has been measured.
class Optimizer {
 public:
  Optimizer(OptimizeRequest request, const std::stop_token& stop)
      : request_(std::move(request)), stop_(stop) {}

  /// False: what is wrong has been told, and there is no new program.
  bool run(const CutRun& before, const FeedSurvey& survey, OptimizeReport& report) {
    const std::string& program = request_.run.session.program.path;
    Result<NcText> text = NcText::read(program, is_inch());
    if (!text) return fail(text.error());
    Result<FeedTrace> trace = read(program);
    if (!trace) return fail(trace.error());
    report.before = report.after = optimized_run(before, survey);
    report.digest = before.report().stock->digest;
    if (!request_.aims.unrolls)
      return shape(before, {*text, *trace, survey}, false, report) && commit(*text);
    Result<UnrolledText> unrolled = unroll(*text);
    if (!unrolled) return fail(unrolled.error(), tr("without --unroll loops stay as they are"));
    FeedTrace ways;
    FeedSurvey looks(request_.aims);
    if (!write_out(*trace, *unrolled, ways, looks, report)) return false;
    const NcText written(unrolled->text, is_inch());
    return shape(before, {written, ways, looks}, true, report) && commit(*text);
  }

  const std::string& copy() const { return copy_; }

 private:
  bool fail(const std::string& why, const std::string& hint = {}) const {
    Diagnostic d = error_of(why, hint);
    print_diagnostic(stderr, d);
    return false;
  }

  Result<FeedTrace> read(const std::string& path) {
    SessionOptions options = request_.run.session;
    options.program.path = path;
    Diagnostics diagnostics;
    FeedTrace trace = read_trace(options, stop_, diagnostics);
    if (trace.is_whole) return trace;
    rename(diagnostics, path, request_.out);
    print_diagnostics(diagnostics, true);
    return Error{trf("{} cannot be read again: nothing is written", request_.out)};
  }

  /// A program whose F words are to be others.
  struct Subject {
    const NcText& text;
    const FeedTrace& trace;
    const FeedSurvey& survey;
  };

  /// Blocks are divided, if that is wanted, and get their feeds. `is_other`: the text is not that
  /// of PROGRAM any more.
  bool shape(const CutRun& before, const Subject& subject, bool is_other, OptimizeReport& report) {
    if (!request_.aims.splits) return optimize(subject, is_other, report);
    const SplitText split =
        split_blocks(subject.text, subject.survey.motions(), subject.survey.parts(), request_.aims);
    if (split.blocks == 0) return optimize(subject, is_other, report);
    const NcText divided(split.text, is_inch());
    FeedTrace ways;
    FeedSurvey looks(request_.aims);
    if (!divide(before, subject.trace, split, ways, looks, report)) return false;
    return optimize({divided, ways, looks}, true, report);
  }

  /// Written out it is the same program, bit for bit.
  bool write_out(const FeedTrace& trace, const UnrolledText& unrolled, FeedTrace& ways,
                 FeedSurvey& survey, OptimizeReport& report) {
    Result<FeedTrace> after = attempt(unrolled.text);
    if (!after) return fail(after.error());
    const std::string hint = tr("without --unroll loops stay as they are");
    const std::size_t both = std::min(trace.motions.size(), after->motions.size());
    for (std::size_t i = 0; i < both; ++i) {
      const TracedMotion &was = trace.motions[i], &is = after->motions[i];
      if (was.print != is.print || was.feed_mm_per_min != is.feed_mm_per_min)
        return fail(trf("--unroll: written out, line {} makes another motion", was.source.line),
                    hint);
    }
    if (trace.motions.size() != after->motions.size())
      return fail(trf("--unroll: written out, the program makes {} motions, not {}",
                      after->motions.size(), trace.motions.size()),
                  hint);
    const CutRun cut = cut_again(survey);
    if (cut.code != kExitGood)
      return fail(trf("{} cannot be cut again: nothing is written", request_.out));
    if (cut.report().stock->digest != report.digest)
      return fail(tr("--unroll: written out, it leaves another workpiece"));
    ways = std::move(*after);
    report.unrolled_passes = unrolled.passes;
    report.unrolled_calls = unrolled.calls;
    report.unrolled_lines = unrolled.line_before;
    return true;
  }

  /// Blocks in pieces go the same way, and leave the same part; how the tool is engaged on them is
  /// looked at anew.
  bool divide(const CutRun& before, const FeedTrace& trace, const SplitText& split, FeedTrace& ways,
              FeedSurvey& survey, OptimizeReport& report) {
    Result<FeedTrace> after = attempt(split.text);
    if (!after) return fail(after.error());
    if (const std::string other = way_difference(trace, *after, split); !other.empty())
      return fail(trf("--split: divided, {}", other), tr("without --split blocks stay whole"));
    const CutRun cut = cut_again(survey);
    if (cut.code != kExitGood)
      return fail(trf("{} cannot be cut again: nothing is written", request_.out));
    const PartDiff parts = diff_parts({before.session->stock(), nullptr},
                                      {cut.session->stock(), nullptr}, kSplitTolerance_mm, false);
    if (!parts.same) return fail(tr("--split: divided, it leaves another workpiece"));
    ways = std::move(*after);
    report.split_blocks = split.blocks;
    report.split_pieces = split.pieces;
    report.digest = cut.report().stock->digest;
    return true;
  }

  bool optimize(const Subject& subject, bool is_divided, OptimizeReport& report) {
    const FeedBlocks blocks = feed_blocks(subject.text, subject.survey.motions());
    Result<PlacedFeeds> placed = place_feeds(subject.text, blocks, request_.aims, subject.trace,
                                             [&](const std::string& now) { return attempt(now); });
    if (!placed) return fail(placed.error());
    add_plan(blocks, placed->plan, report);
    const bool is_as_before = placed->plan.edits.empty() && !is_divided;
    if (is_as_before && request_.in_place) return true;
    if (placed->plan.edits.empty()) {
      const Result<FeedTrace> same = attempt(placed->text);
      if (!same) return fail(same.error());
      if (is_as_before) return true;
    }
    return prove(*placed, report);
  }

  /// As it would be read in its place.
  Result<FeedTrace> attempt(const std::string& text) {
    file_.reset();
    Result<AtomicFile> file = AtomicFile::create(request_.out);
    if (!file) return Error{file.error()};
    file_.emplace(std::move(*file));
    file_->write(text.data(), text.size());
    Result<std::string> path = file_->readable_path();
    if (!path) return Error{path.error()};
    attempt_path_ = *path;
    return read(attempt_path_);
  }

  CutRun cut_again(FeedSurvey& survey) {
    return cut(request_, {attempt_path_, request_.out}, survey, stop_);
  }

  bool prove(const PlacedFeeds& placed, OptimizeReport& report) {
    FeedSurvey survey(request_.aims);
    const CutRun after = cut_again(survey);
    if (after.code != kExitGood)
      return fail(trf("{} cannot be cut again: nothing is written", request_.out));
    if (after.report().stock->digest != report.digest)
      return fail(trf("{} makes another workpiece: nothing is written", request_.out));
    const NcText text(placed.text, is_inch());
    const FeedBlocks blocks = feed_blocks(text, survey.motions());
    const ExceededFeed over = exceeded_feed(blocks, request_.aims, placed.plan.left);
    if (over.line > 0)
      return fail(trf("{}:{}: {:.0f} mm/min, where {:.0f} mm/min are allowed: nothing is written",
                      request_.out, over.line, over.feed_mm_per_min, over.most_mm_per_min));
    report.after = optimized_run(after, survey);
    return true;
  }

  bool commit(const NcText& was) {
    if (!file_) return true;  // in its own place, and as it was
    if (request_.in_place) {
      const Result<std::string> kept = keep_copy(request_.out, was.text());
      if (!kept) return fail(kept.error());
      copy_ = *kept;
    }
    const Done written = file_->commit();
    return written ? true : fail(written.error());
  }

  bool is_inch() const { return request_.run.session.program.machine.inch_machine; }

  OptimizeRequest request_;
  std::stop_token stop_;
  std::optional<AtomicFile> file_;
  std::string attempt_path_, copy_;
};

int tell(const OptimizeRequest& request, const OptimizeReport& report, const std::string& copy) {
  const bool to_stdout = request.json == "-" || request.json == "/dev/stdout";
  if (!request.run.quiet) {
    std::string text = optimize_text(report);
    const bool is_written = !request.in_place || !copy.empty();
    if (is_written) text += trf("written   {}\n", request.out);
    if (!copy.empty()) text += std::string(10, ' ') + trf("what it was is in {}\n", copy);
    print_lengths(to_stdout ? stderr : stdout, text);
  }
  if (request.json.empty()) return kExitGood;
  const Done written = write_text(request.json, optimize_json(report, KERF_VERSION));
  if (written) return kExitGood;
  print_diagnostic(stderr, error_of(written.error()));
  return kExitFailure;
}

/// What of it was guessed counts when it is cut again.
OptimizeRequest with_same_guesses(const Arguments& arguments, const OptimizeRequest& request,
                                  const Report& report) {
  const std::vector<GuessRow> rows = rows_in(report.guesses, request.run.units);
  const Arguments all = with_guesses(arguments, rows);
  if (!request.run.quiet && !rows.empty()) print_text(stderr, guess_text(rows, command_line(all)));
  Diagnostics told_already;
  return understand_optimize(all, told_already);
}

}  // namespace

int optimize_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  const OptimizeRequest request = understand_optimize(arguments, diagnostics);
  const bool is_usage = has_error(diagnostics);
  OutputPaths places;
  places.json = request.json;
  check_output_places(places, diagnostics);
  if (!is_usage) check_out(request, diagnostics);
  doubt_aims(request.aims, diagnostics);
  print_diagnostics(diagnostics, request.run.quiet);
  if (has_error(diagnostics)) return is_usage ? kExitUsage : kExitFailure;
  show_lengths_in(request.run.units);
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  FeedSurvey survey(request.aims);
  const std::string& program = request.run.session.program.path;
  const CutRun before = cut(request, {program, program}, survey, stop.get_token());
  if (before.code != kExitGood) return before.code;
  diagnostics.clear();
  check_subject(request, before, survey, diagnostics);
  print_diagnostics(diagnostics, request.run.quiet);
  if (has_error(diagnostics)) return kExitUsage;
  OptimizeReport report;
  report.program = program;
  report.out = request.out;
  report.aims = request.aims;
  report.time_model = before.report().time_model;
  for (const ToolUse& use : before.report().tools) report.shapes.emplace(use.number, use.shape);
  Optimizer optimizer(with_same_guesses(arguments, request, before.report()), stop.get_token());
  if (!optimizer.run(before, survey, report)) return kExitFailure;
  return tell(request, report, optimizer.copy());
}

}  // namespace kerf
