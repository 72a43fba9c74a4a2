#include "interp_bridge/motion_feeder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/probe_branches.h"
#include "interp_bridge/source_text.h"
#include "interp_bridge/wild_motion.h"

namespace kerf {
namespace {

constexpr std::size_t kBatchMotions = 512;
/// A circle with overburn behind another gives three motions; no command but a spline gives more.
constexpr std::size_t kMotionsPerCommand = 3;
constexpr std::chrono::milliseconds kOldBatch{40};
constexpr std::size_t kMaxForeignLines = 100;
constexpr std::size_t kMaxForeignBytes = 500;
constexpr std::size_t kMaxUnknownNames = 100;
constexpr std::size_t kRecordExcerptBytes = 200;
constexpr int kMaxMaterialRemarks = 20;
constexpr unsigned kAllAxes = 7;
/// Blocks with G41 or G42 that are read again for their D.
constexpr int kMaxCompensationLooks = 100;

std::string values_of(const TorchMaterial& material) {
  return trf("{:g} mm/min, kerf {:g} mm, cut at {:g} mm, pierced at {:g} mm for {:g} s",
             material.feed_mm_per_min, material.kerf_width_mm, material.cut_height_mm,
             material.pierce_height_mm, material.pierce_delay_s);
}

/// Whose diameter the block of a G41 or G42 names by D; none: that of the tool in the spindle. -1:
/// it says the diameter itself (G41.1), or the number is computed.
std::optional<int> compensating_tool(std::string block) {
  block.resize(std::min(block.size(), block.find_first_of(";(")));
  if (block.find("41.1") != block.npos || block.find("42.1") != block.npos) return -1;
  const std::size_t word = block.find_first_of("dD");
  if (word == block.npos) return std::nullopt;
  const std::size_t digits = block.find_first_not_of(" \t", word + 1);
  if (digits == block.npos || block[digits] < '0' || block[digits] > '9') return -1;
  return std::atoi(block.c_str() + digits);
}

/// What is taken for the block of a place where the machine stands.
constexpr BlockWords kNamesAll{.named = 7};

}  // namespace

MotionFeeder::MotionFeeder(MotionFeederOptions options, const MotionSink& sink,
                           ProgramSummary& summary, Diagnostics& diagnostics)
    : options_(std::move(options)),
      sink_(sink),
      summary_(summary),
      diagnostics_(diagnostics),
      fold_(options_.tool_by_index),
      materials_(options_.torch.materials) {
  fold_.set_lengths(options_.lengths);
  if (options_.work) fold_.state_work(*options_.work);
  start_fold();
  const TorchRun& torch = options_.torch;
  fold_.set_filter({torch.qtplasmac && !torch.text.is_filtered, torch.inch_machine});
  fold_.set_signals(options_.signals.wanted);
  material_changed();
  batch_.reserve(kBatchMotions + kMotionsPerCommand);
}

void MotionFeeder::start_fold() {
  if (options_.start) {
    fold_.stand_at(*options_.start);
    return;
  }
  const MotionFeederOptions::Places& places = options_.places;
  if (!places.followed || summary_.files.empty()) return;
  constexpr std::uint8_t kAll = 7;
  constexpr std::uint8_t kButZ = 3;
  constexpr std::uint8_t kButY = 5;
  const std::uint8_t named = blocks_.named_in(summary_.files[0]);
  const auto matters = static_cast<std::uint8_t>((places.z_matters ? kAll : kButZ) &
                                                 (places.y_matters ? kAll : kButY));
  fold_.start_unknown(places.interpreter_start, named & matters, places.zero_known ? kAll : 0,
                      matters);
}

/// Of what moves or shifts the words of its block are looked up.
void MotionFeeder::follow_block(CanonicalName name) {
  switch (name) {
    case CanonicalName::kStraightTraverse:
    case CanonicalName::kStraightFeed:
    case CanonicalName::kStraightProbe:
    case CanonicalName::kArcFeed:
    case CanonicalName::kRigidTap:
    case CanonicalName::kNurbsFeed:
    case CanonicalName::kSetG5xOffset:
    case CanonicalName::kSetG92Offset:
      fold_.set_block(blocks_.at(source_, summary_.files, fold_.unplaced()));
      return;
    default:
      return;
  }
}

void MotionFeeder::take_store(SourceRef source) {
  if (!options_.places.has_blocks) return;
  const BlockWords* const block = blocks_.at(source, summary_.files, fold_.unplaced());
  if (block != nullptr && stores(*block)) fold_.store(*block);
}

bool MotionFeeder::take(const CanonicalCommand& command, SourceRef source) {
  source_ = source;
  if (options_.places.followed || (options_.places.has_blocks && fold_.needs_offset_blocks())) {
    follow_block(command.name);
    if (std::exchange(stands_there_, false)) fold_.set_block(&kNamesAll);
  }
  if (command.spelling.empty() ||
      command.spelling.size() == canonical_spelling(command.name).size()) {
    ++counts_[static_cast<std::size_t>(command.name)];
  } else {
    ++summary_.canonical_commands[std::string(command.spelling)];
  }
  if (!command.text.empty()) remark_on_text(command);
  if (!options_.torch.text.changes.empty()) follow_modes();
  const std::size_t before = batch_.size();
  const FoldRemark said = fold_.fold(command, source_, batch_);
  if (said != FoldRemark::kNone) remark(said);
  if (options_.follows_probes) follow_probing(command, before);
  if (options_.places.has_blocks && fold_.follows_places()) options_.places.followed = true;
  return took(before);
}

bool MotionFeeder::ask_probe(const CanonicalCommand& command, bool away, SourceRef source,
                             ProbeAnswer& answer) {
  source_ = source;
  ++commands_;  // a sign of life: the interpreter waits for us now
  if (!hand_over()) return false;
  if (options_.places.followed) follow_block(CanonicalName::kStraightProbe);
  MotionFold ahead = fold_;
  std::vector<Motion> motions;
  ahead.fold(command, source, motions);
  answer = {};
  if (motions.size() != 1 || !motions[0].start_known ||
      (!options_.start && (moved_axes(motions[0]) & ~probe_.said) != 0)) {
    answer.why = tr("where it begins is not known");
  } else if (options_.answer_probe) {
    answer = options_.answer_probe({motions[0], away});
  }
  probe_.answered = answer.kind != ProbeAnswer::Kind::kUnknown;
  if (answer.kind == ProbeAnswer::Kind::kMet && !away) {
    const Vec3 way = motions[0].to_mm - motions[0].from_mm;
    probe_.met_below = way.z < 0 && way.x == 0 && way.y == 0;
  }
  probe_.why = answer.why;
  return true;
}

/// Bits of X, Y, Z. Of a first motion, which has no start: what is not at 0, where the interpreter
/// takes all axes to stand.
unsigned MotionFeeder::moved_axes(const Motion& m) const {
  constexpr double kMoved_mm = 1e-6;
  unsigned axes = 0;
  for (unsigned i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    const double from_mm = m.start_known ? m.from_mm[axis] : 0;
    if (std::abs(m.to_mm[axis] - from_mm) > kMoved_mm) axes |= 1U << i;
  }
  return axes;
}

/// A program that touches a plate of known thickness.
void MotionFeeder::note_plate() {
  if (fold_.plate_mm() == 0 || std::exchange(probe_.plate_told, true)) return;
  ProgramNote note;
  note.source = source_;
  note.is_sentence = true;
  note.count = 1;
  note.text = trf(
      "the program calls the top of the workpiece, where the probe has met it, Z{:.2f}: a touch "
      "plate of that thickness is taken to lie on it, and Z0 to be the top",
      fold_.plate_mm());
  summary_.notes.push_back(std::move(note));
}

/// Of a probing move that nobody could answer for: what comes behind it, from batch_[first] on, is
/// not known.
void MotionFeeder::follow_probing(const CanonicalCommand& command, std::size_t first) {
  for (std::size_t i = first; i < batch_.size(); ++i) probe_.said |= moved_axes(batch_[i]);
  if (command.name == CanonicalName::kStraightProbe && std::exchange(probe_.met_below, false)) {
    fold_.stand_on_workpiece();
  }
  note_plate();
  if (command.name == CanonicalName::kStraightProbe && !std::exchange(probe_.answered, false)) {
    probe_.all_unknown = probe_.all_unknown || !options_.places.has_blocks;
    while (probe_.files_looked_at < summary_.files.size() && !probe_.all_unknown) {
      probe_.all_unknown = file_branches_on_probe(summary_.files[probe_.files_looked_at++]);
    }
    note_unknown_probe();
    unsigned axes = 0;
    for (std::size_t i = first; i < batch_.size(); ++i) {
      const unsigned named = named_axes();
      axes |= batch_[i].start_known ? moved_axes(batch_[i]) : named != 0 ? named : kAllAxes;
    }
    if (options_.places.has_blocks) {
      options_.places.followed = true;
      fold_.lose(static_cast<std::uint8_t>(axes));
    }
    return;
  }
  if (!probe_.all_unknown) return;
  for (std::size_t i = first; i < batch_.size(); ++i) {
    Motion& m = batch_[i];
    if (!m.start_known) continue;
    m.start_known = false;
    m.from_mm = m.to_mm;
    m.from_abc_deg = m.to_abc_deg;
    m.from_uvw_mm = m.to_uvw_mm;
    m.arc.sweep_rad = 0;
  }
}

/// Bits of X Y Z that the present block names; 0: it is not known.
unsigned MotionFeeder::named_axes() {
  if (!options_.places.followed) return 0;
  const BlockWords* const block = blocks_.at(source_, summary_.files, kAllAxes);
  return block != nullptr ? block->named : 0U;
}

void MotionFeeder::note_unknown_probe() {
  if (probe_.note != 0) {
    ++summary_.notes[probe_.note - 1].count;
    return;
  }
  const std::string& why = probe_.why.empty() ? options_.no_answer : probe_.why;
  ProgramNote note;
  note.source = source_;
  note.is_sentence = true;
  note.count = 1;
  note.text = trf("what the probe meets is not known ({}); ", why);
  note.text +=
      !probe_.all_unknown
          ? tr("tool lengths that the program makes of it are taken for true, and nothing is "
               "cut or checked until a block says in plain numbers where the tool is")
          : tr("from here on nothing is cut or checked, since what the program does hangs "
               "on it");
  summary_.notes.push_back(std::move(note));
  probe_.note = summary_.notes.size();
}

bool MotionFeeder::take_spline(const Spline& spline, SourceRef source) {
  source_ = source;
  if (options_.places.followed) follow_block(CanonicalName::kNurbsFeed);
  ++counts_[static_cast<std::size_t>(CanonicalName::kNurbsFeed)];
  const std::size_t before = batch_.size();
  const FoldRemark said = fold_.fold_spline(spline, source_, batch_);
  if (said != FoldRemark::kNone) remark(said);
  if (options_.follows_probes) follow_probing({}, before);
  return took(before);
}

/// What the last command has made, from batch_[first] on.
void MotionFeeder::refuse_wild(std::size_t first) {
  for (std::size_t i = first; i < batch_.size(); ++i) {
    const std::string fault = wild_number_of(batch_[i]);
    if (fault.empty()) continue;
    batch_.resize(i);
    refused_ = true;
    Diagnostic wild = at_source(Severity::kError, fault + tr(": no machine has such a number"));
    wild.hint = tr("a slip of the pen, or an offset or a unit (G20, G21) that is not meant?");
    diagnostics_.push_back(std::move(wild));
    return;
  }
}

bool MotionFeeder::took(std::size_t batch_before) {
  if (refused_) {
    batch_.resize(std::min(batch_before, batch_.size()));
    return false;
  }
  refuse_wild(batch_before);
  repeats_.take(source_,
                std::span<const Motion>(batch_).subspan(std::min(batch_before, batch_.size())));
  if (batch_before == 0 && !batch_.empty()) batch_since_ = std::chrono::steady_clock::now();
  ++commands_;
  if (options_.max_commands != 0 && commands_ > options_.max_commands) too_many_ = true;
  return (batch_.size() < kBatchMotions || hand_over()) && !too_many_ && !refused_;
}

bool MotionFeeder::take_unknown(std::string_view name) {
  ++commands_;
  auto& counts = summary_.canonical_commands;
  const auto found = counts.find(std::string(name));
  if (found != counts.end()) {
    ++found->second;
    return false;
  }
  if (counts.size() >= kMaxUnknownNames) {
    ++counts["(other)"];
    return false;
  }
  counts.emplace(name, 1);
  return true;
}

Diagnostic MotionFeeder::at_source(Severity severity, std::string message) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  if (source_.file < summary_.files.size()) diagnostic.file = summary_.files[source_.file];
  diagnostic.line = static_cast<int>(source_.line);
  diagnostic.message = std::move(message);
  return diagnostic;
}

void MotionFeeder::remark(FoldRemark said) {
  if (said == FoldRemark::kSplineLost && splines_lost_++ == 0) {
    Diagnostic lost = at_source(
        Severity::kWarning, tr("a spline (G5, G5.1, G5.2) is not cut: LinuxCNC's listing holds its "
                               "number of points only"));
    lost.hint = tr("the move after a spline is not cut either, since its start is not known");
    diagnostics_.push_back(std::move(lost));
  }
  if (said == FoldRemark::kArcPlaneUnknown && !std::exchange(plane_reported_, true)) {
    diagnostics_.push_back(
        at_source(Severity::kWarning,
                  tr("an arc in a plane other than XY, YZ and XZ (G17, G19, G18) is not cut")));
  }
}

void MotionFeeder::remark_on_text(const CanonicalCommand& command) {
  if (options_.torch.qtplasmac && command.name == CanonicalName::kComment) edit_material(command);
  if (command.name == CanonicalName::kCanonError) {
    diagnostics_.push_back(
        at_source(Severity::kError, std::string(command.text.substr(0, kRecordExcerptBytes))));
    return;
  }
  constexpr std::string_view kCompensation = "interpreter: cutter radius compensation on";
  if (command.name == CanonicalName::kComment &&
      command.text.substr(0, kCompensation.size()) == kCompensation) {
    remark_on_compensation();
  }
}

/// Once a tool: its radius is not known, or not the table's.
void MotionFeeder::remark_on_compensation() {
  const ToolDiameters& diameters = options_.diameters;
  if (diameters.all || ++compensation_looks_ > kMaxCompensationLooks) return;
  const std::string file = source_.file < summary_.files.size() ? summary_.files[source_.file] : "";
  const std::optional<int> named = compensating_tool(line_of_file(file, source_.line));
  const int tool = named.value_or(fold_.tool());
  // D0 is no radius on purpose.
  if (tool < 0 || named == 0 || compensation_reported_.count(tool) != 0) return;
  const auto doubt = diameters.doubts.find(tool);
  if (doubt == diameters.doubts.end() && diameters.known.count(tool) != 0) return;
  compensation_reported_.insert(tool);
  if (doubt != diameters.doubts.end()) {
    diagnostics_.push_back(at_source(Severity::kWarning, doubt->second));
    return;
  }
  Diagnostic unknown =
      at_source(Severity::kWarning,
                trf("cutter radius compensation (G41, G42) {}: the radius counts as 0",
                    options_.has_tool_table
                        ? trf("with tool {}, whose diameter the tool table does not have", tool)
                        : tr("without a tool table")));
  unknown.hint = trf("give the machine's table with --tool-table{}",
                     tool > 0 ? trf(", or the tool with --tool {}=SHAPE", tool) : std::string());
  diagnostics_.push_back(std::move(unknown));
}

void MotionFeeder::add_foreign(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (line.find_first_not_of(" \t") == line.npos) return;
  ++summary_.foreign_line_count;
  if (summary_.foreign_lines.size() < kMaxForeignLines) {
    summary_.foreign_lines.emplace_back(line.substr(0, kMaxForeignBytes));
  }
}

/// The filter reads the program's own file, once and in the order of its lines.
void MotionFeeder::follow_modes() {
  if (source_.file == 0) fold_.set_filter_modes(options_.torch.text.modes_at(source_.line));
}

void MotionFeeder::material_changed() {
  fold_.set_material(static_cast<std::uint16_t>(materials_.current_index()),
                     materials_.current().kerf_width_mm);
}

void MotionFeeder::edit_material(const CanonicalCommand& comment) {
  const MaterialTable::Edit done = materials_.edit(comment.text, fold_.unit_mm());
  if (done == MaterialTable::Edit::kNone) return;
  material_changed();
  if (done == MaterialTable::Edit::kDone || ++material_remarks_ > kMaxMaterialRemarks) return;
  const bool malformed = done == MaterialTable::Edit::kMalformed;
  Diagnostic remark = at_source(
      malformed ? Severity::kWarning : Severity::kNote,
      malformed ? trf("the material comment is not understood{}{}",
                      materials_.complaint().empty() ? "" : ": ", materials_.complaint())
                : trf("the material comment has no {}; what it does not say is the default "
                      "material's ({})",
                      materials_.complaint(), values_of(materials_.rows()[0])));
  remark.hint = tr("as in (o=0, na=Steel 3mm, ph=3.0, pd=0.1, ch=1.5, fr=3000, kw=1.2)");
  diagnostics_.push_back(std::move(remark));
}

bool MotionFeeder::take_material_change(double number, SourceRef source) {
  if (!options_.torch.qtplasmac) return false;
  source_ = source;
  // -1 is the default; what is no whole number is cut off, as the machine's own M190 does.
  constexpr double kLargest = 2e9;
  const int wanted = number >= 0 && number <= kLargest ? static_cast<int>(number) : -1;
  const bool known = materials_.select(wanted);
  material_changed();
  if (known || ++material_remarks_ > kMaxMaterialRemarks) return true;
  Diagnostic unknown =
      at_source(Severity::kWarning,
                trf("M190 P{}: there is no material {}; the default's values are taken ({})",
                    wanted, wanted, values_of(materials_.rows()[0])));
  unknown.hint = tr("QtPlasmaC keeps its materials in MACHINE_material.cfg beside the INI");
  diagnostics_.push_back(std::move(unknown));
  return true;
}

bool MotionFeeder::take_user_code(double number, SourceRef source) {
  const std::vector<int>& known = options_.signals.user_codes;
  const auto code =
      std::find_if(known.begin(), known.end(), [&](int one) { return number == one; });
  if (code == known.end()) return false;
  source_ = source;
  const std::size_t before = batch_.size();
  fold_.signal(static_cast<std::uint8_t>(*code), source, batch_);
  took(before);
  return true;
}

void MotionFeeder::remark_on_defaults() {
  const TorchRun& torch = options_.torch;
  if (!torch.qtplasmac || torch.materials_known || materials_.rows().size() > 1) return;
  // An interpreter that knows no pins has ended there.
  if (source_.file == 0 && source_.line <= torch.text.hal_line) return;
  Diagnostic note;
  note.severity = Severity::kNote;
  if (!summary_.files.empty()) note.file = summary_.files[0];
  note.line = static_cast<int>(torch.text.hal_line);
  note.message = trf("no file tells of the material; QtPlasmaC's own default is taken ({})",
                     values_of(materials_.rows()[0]));
  note.hint = tr("QtPlasmaC keeps its materials in MACHINE_material.cfg beside the INI");
  diagnostics_.push_back(std::move(note));
}

bool MotionFeeder::hand_over() {
  if (batch_.empty() || sink_done_) return !sink_done_;
  if (options_.materials != nullptr && materials_told_ != materials_.rows().size()) {
    *options_.materials = materials_.rows();
    materials_told_ = materials_.rows().size();
  }
  if (options_.frame != nullptr && fold_.workpiece_frame_fixed()) {
    *options_.frame = fold_.workpiece_frame();
  }
  sink_done_ = !sink_(batch_);
  batch_.clear();
  return !sink_done_;
}

bool MotionFeeder::flush_if_old() {
  if (batch_.empty()) return true;
  if (std::chrono::steady_clock::now() - batch_since_ < kOldBatch) return true;
  return hand_over();
}

void MotionFeeder::finish() {
  hand_over();
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0) continue;
    summary_.canonical_commands[std::string(canonical_spelling(static_cast<CanonicalName>(i)))] +=
        counts_[i];
  }
  counts_.fill(0);
  summary_.has_program_end = fold_.has_program_end();
  summary_.has_rotary_motion = fold_.has_rotary_motion();
  summary_.lost_splines = splines_lost_;
  remark_on_defaults();
  if (splines_lost_ > 1) {
    Diagnostic more;
    more.severity = Severity::kWarning;
    if (!summary_.files.empty()) more.file = summary_.files[0];
    more.message = trf("{} splines were not cut", splines_lost_);
    diagnostics_.push_back(std::move(more));
  }
}

}  // namespace kerf
