#include "twin/session/entry_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/translate.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

/// The machine stands where the program has it: nobody jogs nearer than that.
constexpr double kSamePlace_mm = 0.01;
/// Over the workpiece, and over what stands higher: how far up it is looked for a clear way.
constexpr double kClearance_mm = 2;
constexpr std::array<double, 4> kRises_mm{0, 25, 50, 100};
/// Of a drive that has not found back to the program by then nothing more is tried.
constexpr std::size_t kMostOfDrive = 200;

void fault(std::string message, std::string hint, Diagnostics& diagnostics) {
  diagnostics.push_back(general_error(std::move(message), std::move(hint)));
}

bool moves(const Motion& m) {
  switch (m.kind) {
    case MotionKind::kTraverse:
    case MotionKind::kFeed:
    case MotionKind::kArc:
    case MotionKind::kThread:
    case MotionKind::kProbe:
      return true;
    default:
      return false;
  }
}

/// The program from a line on, as LinuxCNC runs it from there.
struct BegunAt {
  std::vector<Motion> motions;  ///< the first is the place where it begins
  ActiveModes modes;            ///< in force there
  WorkpieceFrame work;          ///< of the motions
};
BegunAt begun_at(const SessionOptions& options, std::uint32_t line,
                 const std::optional<std::array<double, 9>>& there,
                 const std::optional<WorkpieceFrame>& work,
                 const std::function<bool(const std::vector<Motion>&)>& is_enough,
                 std::stop_token stop, Diagnostics& diagnostics) {
  ProgramOptions from = options.program;
  from.machine.first_line = line;
  from.machine.there = there;
  from.machine.work = work;
  const std::unique_ptr<Program> program = Program::open(from, diagnostics);
  BegunAt begun;
  std::vector<Motion>& motions = begun.motions;
  if (!program) return begun;
  Diagnostics said;  // what is behind what is looked for is told by the run
  const ProgramSummary summary = program->run(
      [&](std::span<const Motion> batch) {
        for (const Motion& motion : batch) {
          if (moves(motion)) motions.push_back(motion);
          if (is_enough(motions)) return false;
        }
        return true;
      },
      stop, said);
  if (motions.size() < 2 && has_error(said)) {
    diagnostics.insert(diagnostics.end(), said.begin(), said.end());
  }
  begun.modes = summary.modes;
  begun.work = program->workpiece_frame();
  return begun;
}

/// The frame in which workpiece and program are the same: that of the program's first motions,
/// whatever offset is in force later.
WorkpieceFrame first_frame(const SessionOptions& options, std::stop_token stop) {
  Diagnostics said;  // by the run
  const std::unique_ptr<Program> program = Program::open(options.program, said);
  if (!program) return {};
  program->run(
      [](std::span<const Motion> batch) {
        return std::none_of(batch.begin(), batch.end(),
                            [](const Motion& m) { return moves(m) && m.unknown_to == 0; });
      },
      stop, said);
  return program->workpiece_frame();
}

Vec3 turned(const Vec3& v, double degrees) {
  const double angle = degrees * (std::numbers::pi / 180);
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// A place of the workpiece (X Y Z A B C U V W) in the coordinates of a program whose offsets are
/// `here`.
std::array<double, 9> program_place(const std::array<double, 9>& place, const WorkpieceFrame& work,
                                    const WorkpieceFrame& here) {
  if (work == here) return place;
  const Vec3 at{place[0], place[1], place[2]};
  const Vec3 machine = turned(at + work.g92_mm, work.rotation_deg) + work.g5x_mm;
  const Vec3 p = turned(machine - here.g5x_mm, -here.rotation_deg) - here.g92_mm;
  std::array<double, 9> out{p.x, p.y, p.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    out[3 + i] = place[3 + i] + work.offset_abc_deg[i] - here.offset_abc_deg[i];
    out[6 + i] = place[6 + i] + work.offset_uvw_mm[axis] - here.offset_uvw_mm[axis];
  }
  return out;
}

/// What comes before the line: where what is in force was said, and where it could be begun.
class BeforeLine final : public MotionRecorder {
 public:
  void restart() override { *this = BeforeLine(); }
  void name_files(const std::vector<std::string>&) override {}
  void on_cut(std::uint64_t, double, double) override {}
  void on_step(std::uint64_t, const Motion& m, const TimedStep& step) override {
    const std::uint32_t line = m.source.file == 0 ? m.source.line : 0;
    const bool changes = m.kind == MotionKind::kToolChange;
    if (line != 0 && line != last_line_ && (changes || m.kind == MotionKind::kTraverse)) {
      starts_.push_back({line, step.start_s, m.from_mm.z, changes});
    }
    if (line != 0) last_line_ = line;
    end_s_ = step.start_s + step.duration_s;
  }

  void tell(EntryReport& report, double top_mm) const {
    report.before_s = end_s_;
    for (const bool changes : {false, true}) {
      const auto found = std::find_if(starts_.rbegin(), starts_.rend(), [&](const Start& start) {
        return start.line < report.line && start.changes_tool == changes &&
               (changes || start.z_mm >= top_mm);
      });
      if (found == starts_.rend()) continue;
      report.earlier.push_back({found->line, end_s_ - found->at_s, changes});
    }
    std::sort(report.earlier.begin(), report.earlier.end(),
              [](const auto& a, const auto& b) { return a.line > b.line; });
  }

 private:
  struct Start {
    std::uint32_t line;
    double at_s;
    double z_mm;
    bool changes_tool;
  };
  std::vector<Start> starts_;
  std::uint32_t last_line_ = 0;
  double end_s_ = 0;
};

/// A rapid with everything else as the program has it there.
Motion rapid(const Motion& like, const Vec3& from, const Vec3& to) {
  Motion m = like;
  m.kind = MotionKind::kTraverse;
  m.from_mm = from;
  m.to_mm = to;
  m.to_abc_deg = m.from_abc_deg;
  m.to_uvw_mm = m.from_uvw_mm;
  m.feed_mm_per_min = 0;
  m.start_known = true;
  return m;
}

/// As LinuxCNC goes from where it stands, until each axis is where the program has it: an axis that
/// no line names stays where it is. Judged as rapid, since nothing is meant to be cut.
std::vector<Motion> drive_of(const std::vector<Motion>& motions, const Vec3& program_place) {
  std::vector<Motion> drive;
  const Vec3 at = motions.front().to_mm;
  std::array<bool, 3> placed{};
  for (int i = 0; i < 3; ++i) placed[i] = std::abs(at[i] - program_place[i]) <= kSamePlace_mm;
  for (std::size_t k = 1; k < motions.size(); ++k) {
    if (placed[0] && placed[1] && placed[2]) break;
    drive.push_back(motions[k]);
    for (int i = 0; i < 3; ++i) placed[i] = placed[i] || motions[k].to_mm[i] != at[i];
  }
  return drive;
}

/// What these moves would meet. None of them is a traverse of the program, whatever it counts as.
std::vector<Finding> met_by(const Session& session, const std::vector<Motion>& moves) {
  std::vector<Finding> findings = session.try_moves(moves);
  for (Finding& finding : findings) {
    if (finding.id == FindingId::kRapidContact) finding.text = tr("the cutter meets the workpiece");
  }
  return findings;
}

EntryWay judged_drive(const Session& session, const std::vector<Motion>& drive) {
  std::vector<Motion> tried = drive;
  for (Motion& m : tried) {
    m.rapid = m.kind == MotionKind::kArc;
    if (m.kind != MotionKind::kArc) m.kind = MotionKind::kTraverse;
  }
  EntryWay way;
  way.points_mm.push_back(drive.front().from_mm);
  for (const Motion& m : drive) way.points_mm.push_back(m.to_mm);
  way.findings = met_by(session, tried);
  return way;
}

/// Up, over, down; from `at`, or down alone.
EntryWay safe_way(const Session& session, const Motion& first, const std::optional<Vec3>& at,
                  double top_mm) {
  const Vec3 place = first.from_mm;
  EntryWay way;
  for (const double rise_mm : kRises_mm) {
    const double z = std::max({place.z, at ? at->z : place.z, top_mm + kClearance_mm + rise_mm});
    way = EntryWay{};
    if (at) way.points_mm = {*at, {at->x, at->y, z}};
    way.points_mm.push_back({place.x, place.y, z});
    way.points_mm.push_back(place);
    const auto same = std::unique(way.points_mm.begin(), way.points_mm.end());
    way.points_mm.erase(same, way.points_mm.end());
    std::vector<Motion> tried;
    for (std::size_t i = 1; i < way.points_mm.size(); ++i) {
      tried.push_back(rapid(first, way.points_mm[i - 1], way.points_mm[i]));
    }
    way.findings = met_by(session, tried);
    if (way.clear()) break;
  }
  return way;
}

Finding contact_of(const EntryReport& report) {
  const Finding& met = report.drive->findings.front();
  Finding finding = met;
  finding.id = FindingId::kEntryContact;
  finding.severity = Severity::kError;
  finding.source = report.first.source;
  finding.text =
      met.id == FindingId::kRapidContact
          ? trf("a start here goes through the workpiece at feed, in line {}", met.source.line)
          : trf("a start here: {}, in line {}", met.text, met.source.line);
  return finding;
}

/// Before anything is cut: a machine that does not answer is told of at once.
bool ask_machine(const BegunAt& begun, const EntryWish& wish, std::stop_token stop,
                 EntryReport& report, Diagnostics& diagnostics) {
  if (!wish.find_place) return true;
  const EntryFrame frame{begun.work, begun.motions.front().tool_offset_mm.z};
  report.live = wish.find_place(frame, stop, diagnostics);
  if (!report.live) return false;
  report.at_mm = report.live->at_mm;
  for (EntryMode& mode : report.modes) {
    const bool is_tool = std::string_view(mode.name) == "tool";
    if (is_tool && report.live->tool == report.first.tool) mode.is_kept = true;
  }
  return true;
}

}  // namespace

std::optional<EntryPlan> plan_entry(const SessionOptions& options, const EntryWish& wish,
                                    const std::string& folder, std::stop_token stop,
                                    Diagnostics& diagnostics) {
  EntryPlan plan{options, {}, {}};
  EntryReport& report = plan.report;
  report.line = wish.line;
  report.at_mm = wish.at_mm;

  const auto has_moved = [](const std::vector<Motion>& m) { return m.size() >= 2; };
  BegunAt begun =
      begun_at(options, wish.line, std::nullopt, std::nullopt, has_moved, stop, diagnostics);
  const WorkpieceFrame here = begun.work;
  const WorkpieceFrame work = first_frame(options, stop);
  if (!has_error(diagnostics) && here != work) {
    begun = begun_at(options, wish.line, std::nullopt, work, has_moved, stop, diagnostics);
  }
  const std::vector<Motion>& own = begun.motions;
  if (has_error(diagnostics)) return std::nullopt;
  if (own.size() < 2) {
    fault(trf("--enter: the program has no motion at line {} or behind it", wish.line),
          tr("--from-line N is the line to begin at"), diagnostics);
    return std::nullopt;
  }
  report.first = own[1];
  report.first.from_mm = own[0].to_mm;
  report.modes = entry_modes(begun.modes, report.first);

  if (!ask_machine(begun, wish, stop, report, diagnostics)) return std::nullopt;

  // What comes before the line.
  SessionOptions before = options;
  before.lines = {0, wish.line > 1 ? wish.line - 1 : 1};
  Outcome outcome = Outcome::kFailed;
  const bool is_saved = options.blank && !options.blank->state_file.empty();
  const std::unique_ptr<Session> making = Session::open(before, diagnostics, outcome);
  if (!making) return std::nullopt;
  BeforeLine recorder;
  making->record_by(recorder);
  making->run(stop, diagnostics);
  if (has_error(diagnostics) || stop.stop_requested() || making->stock() == nullptr) {
    return std::nullopt;
  }
  if (making->stock()->sheet() != nullptr || making->stock()->turned() != nullptr) {
    fault(tr("--enter is for workpieces that are milled"), {}, diagnostics);
    return std::nullopt;
  }
  const double top_mm = making->stock()->bounds_mm().max.z;
  recorder.tell(report, top_mm);
  if (!is_saved) {
    const std::string path = folder + "/before.kerf";
    if (const Done saved = making->stock()->save(path); !saved) {
      diagnostics.push_back(general_error(saved.error()));
      return std::nullopt;
    }
    Blank blank;
    blank.state_file = path;
    plan.session.blank = blank;
    plan.session.blank_words = trf("as the program leaves it before line {}", wish.line);
    plan.session.stock.kind.reset();
    plan.session.stock.cell_mm = 0;
  }

  // As LinuxCNC goes.
  plan.session.lines = {0, options.lines.until};
  plan.session.program.machine.first_line = wish.line;
  std::array<double, 9> there{};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    there[k] = report.at_mm ? (*report.at_mm)[i] : own[0].to_mm[i];
    there[3 + k] = own[0].to_abc_deg[k];
    there[6 + k] = own[0].to_uvw_mm[i];
  }
  there = program_place(there, work, here);
  plan.session.program.machine.there = there;
  plan.session.program.machine.work = work;
  const std::unique_ptr<Session> judging = Session::open(plan.session, diagnostics, outcome);
  if (!judging) return std::nullopt;
  report.safe = safe_way(*judging, report.first, report.at_mm, top_mm);
  if (!report.at_mm) return plan;
  const auto enough = [](const std::vector<Motion>& m) { return m.size() > kMostOfDrive; };
  // What the interpreter refuses there, an arc for one, the run itself tells.
  Diagnostics refused;
  const std::vector<Motion> driven =
      begun_at(options, wish.line, there, work, enough, stop, refused).motions;
  if (driven.size() < 2) return plan;
  const std::vector<Motion> drive = drive_of(driven, own[0].to_mm);
  if (drive.empty()) return plan;
  report.drive = judged_drive(*judging, drive);
  if (report.drive->clear()) return plan;
  // Of rapids the run itself tells.
  const SourceRef met = report.drive->findings.front().source;
  report.drive_is_feed = std::any_of(drive.begin(), drive.end(), [&](const Motion& m) {
    return m.kind != MotionKind::kTraverse && m.source == met;
  });
  if (report.drive_is_feed) plan.findings.push_back(contact_of(report));
  return plan;
}

}  // namespace kerf
