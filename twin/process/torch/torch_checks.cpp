#include "twin/process/torch/torch_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "stock/sheet/sheet.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Of a motion that is longer no more points than these are looked at.
constexpr double kMostPoints = 1000;
/// What is left of a kerf's rounding is no part: smaller pieces tip nowhere.
constexpr double kLeastPart_mm = 1;

int points_of(const Motion& m) {
  return static_cast<int>(
      std::clamp(std::ceil(path_length_mm(m) / TorchChecks::kStep_mm), 1.0, kMostPoints));
}

/// QtPlasmaC's other tools, and a torch that the program holds off, are dark on purpose.
bool is_dark_on_purpose(const Motion& m) {
  return m.torch.overburn || !m.torch.torch_enabled() || torch_tool(m.torch) != TorchTool::kNone;
}

/// QtPlasmaC's machine lifts a torch that M5 has put out. One that output 3 holds off stays down,
/// and goes on at cut height.
bool stays_down(const Motion& m) {
  return (m.torch.spindles_on & 1) != 0 && !m.torch.torch_enabled();
}

}  // namespace

TorchChecks::TorchChecks(const Sheet& sheet, FindingLog& log, const TorchCheckOptions& options)
    : sheet_(sheet),
      log_(log),
      options_(options),
      uncut_pieces_(sheet.blank_piece_numbers()),
      freed_(freed_before(sheet)),
      report_from_(freed_.size()) {}

void TorchChecks::go_on_from(const TorchChecks& other) {
  uncut_pieces_ = other.uncut_pieces_;
  freed_ = other.freed_;
  cut_z_mm_ = other.cut_z_mm_;
  crossed_ = other.crossed_;
}

bool TorchChecks::is_low(const Vec3& place) const {
  return cut_z_mm_ && place.z <= *cut_z_mm_ + kLow_mm;
}

const FreedPiece* TorchChecks::freed_at(const Vec3& place) const {
  const std::optional<std::uint32_t> number = sheet_.piece_at(Vec2(place));
  if (!number || *number < uncut_pieces_) return nullptr;
  return &freed_[*number - uncut_pieces_];
}

Finding TorchChecks::finding(FindingId id, const Motion& m, const TimedStep& step,
                             const Vec3& place) const {
  Finding out;
  out.id = id;
  out.severity = Severity::kWarning;
  out.source = m.source;
  out.time_s = step.start_s;
  out.position_mm = place;
  out.tool = m.tool;
  return out;
}

void TorchChecks::pierces(const Motion& m, const TimedStep& step) {
  if (freed_.empty()) return;
  const FreedPiece* const piece = freed_at(m.from_mm);
  if (!piece) return;
  crossed_.insert(piece->number);
  Finding out = finding(FindingId::kPierceInPart, m, step, m.from_mm);
  out.severity = options_.guessed ? Severity::kWarning : Severity::kError;
  out.text = trf("pierces piece {}, which is {} and may have moved{}", piece->number,
                 free_since(*piece), options_.guessed ? tr(" (of a guessed sheet)") : "");
  log_.add(std::move(out));
}

/// Each piece is told once: whoever goes over it goes over it often.
void TorchChecks::check_way(const Motion& m, const TimedStep& step, bool burning) {
  const int points = points_of(m);
  for (int i = 0; i <= points; ++i) {
    const Vec3 place = point_at(m, static_cast<double>(i) / points);
    if (!burning && !is_low(place)) continue;
    const FreedPiece* const piece = freed_at(place);
    if (!piece || !crossed_.insert(piece->number).second) continue;
    Finding out = finding(FindingId::kCrossesPart, m, step, place);
    out.text = trf("{} piece {}, which is {} and may have tipped",
                   burning ? tr("cuts into") : tr("the head travels at cut height over"),
                   piece->number, free_since(*piece));
    if (burning) {
      log_.add(std::move(out));
    } else {
      tell_travel(std::move(out));
    }
  }
}

void TorchChecks::tell_travel(Finding out) {
  if (++travels_ < kTravelsTold) {
    log_.add(std::move(out));
  } else if (travels_ == kTravelsTold) {
    last_travel_text_ = out.text;
    last_travel_ = log_.add(std::move(out));
  } else {
    log_.reword(last_travel_, trf("{}; and later over {} more pieces", last_travel_text_,
                                  travels_ - kTravelsTold));
  }
}

void TorchChecks::burns(const Motion& m, const TimedStep& step) {
  if (!freed_.empty()) check_way(m, step, true);
  if (moves_sideways(m)) {
    const double high = std::max(m.from_mm.z, m.to_mm.z);
    cut_z_mm_ = std::max(cut_z_mm_.value_or(high), high);
  }
}

void TorchChecks::travels(const Motion& m, const TimedStep& step) {
  const bool feeds = is_feed(m);
  if (!m.start_known || !cut_z_mm_ || !moves_sideways(m)) return;
  if (!feeds && m.kind != MotionKind::kTraverse) return;
  const bool may_be_low = !options_.is_qtplasmac || stays_down(m);
  if (!freed_.empty() && may_be_low) check_way(m, step, false);
  if (!feeds || (options_.is_qtplasmac && is_dark_on_purpose(m))) return;
  const int points = dark_.moves > 0 ? 1 : points_of(m);
  for (int i = 0; i <= points; ++i) {
    const Vec3 place = point_at(m, static_cast<double>(i) / points);
    if (!is_low(place) || !sheet_.has_material(Vec2(place))) continue;
    count(dark_, m, step, place);
    return;
  }
}

void TorchChecks::count(Dark& dark, const Motion& m, const TimedStep& step, const Vec3& place) {
  if (dark.moves++ > 0) return;
  dark.source = m.source;
  dark.time_s = step.start_s;
  dark.place_mm = place;
  dark.tool = m.tool;
}

void TorchChecks::cuts_on_traverse(const Motion& m, const TimedStep& step) {
  if (!is_traverse(m) || !moves_sideways(m)) return;
  count(lit_, m, step, m.from_mm);
  lit_mm_ += step.length_mm;
}

void TorchChecks::stays_on(SourceRef source, double time_s) {
  Finding out;
  out.id = FindingId::kTorchLeftOn;
  out.severity = Severity::kWarning;
  out.source = source;
  out.time_s = time_s;
  out.text = tr("the program ends with the beam on");
  log_.add(std::move(out));
}

void TorchChecks::forget_events() {
  crossed_.clear();
  travels_ = 0;
  dark_ = lit_ = {};
  lit_mm_ = 0;
  report_from_ = freed_.size();
}

void TorchChecks::finish() {
  if (dark_.moves > 0) report_dark_moves();
  if (lit_.moves > 0) report_lit_traverses();
  if (options_.slats_mm > 0) report_small_parts();
}

void TorchChecks::report_dark_moves() {
  Finding out;
  out.id = FindingId::kBeamOff;
  out.severity = Severity::kWarning;
  out.source = dark_.source;
  out.time_s = dark_.time_s;
  out.position_mm = dark_.place_mm;
  out.tool = dark_.tool;
  out.text =
      dark_.moves == 1
          ? tr("a feed move runs over the sheet at cut height with the beam off, the first")
          : trf("{} feed moves run over the sheet at cut height with the beam off, the first",
                dark_.moves);
  log_.add(std::move(out));
}

void TorchChecks::report_lit_traverses() {
  Finding out;
  out.id = FindingId::kBeamOnTraverse;
  out.severity = Severity::kWarning;
  out.source = lit_.source;
  out.time_s = lit_.time_s;
  out.position_mm = lit_.place_mm;
  out.tool = lit_.tool;
  out.text =
      lit_.moves == 1
          ? trf("a traverse cuts the sheet with the beam on, {:.1f} mm in all, the first", lit_mm_)
          : trf("{} traverses cut the sheet with the beam on, {:.1f} mm in all, the first",
                lit_.moves, lit_mm_);
  out.hint = tr(
      "if the machine's beam is off there, --beam says what turns it on: laser (power by S, rapids "
      "dark), m3+feed, m62:N, m67:N, plasmac");
  log_.add(std::move(out));
}

void TorchChecks::report_small_parts() {
  for (const SheetPiece& piece : sheet_.pieces()) {
    if (piece.number < uncut_pieces_ + report_from_) continue;
    const Vec2 size = piece.max_mm - piece.min_mm;
    const double longest = std::max(size.x, size.y);
    if (longest >= options_.slats_mm || longest < kLeastPart_mm) continue;
    const FreedPiece& freed = freed_[piece.number - uncut_pieces_];
    Finding out;
    out.id = FindingId::kSmallPart;
    out.severity = Severity::kWarning;
    out.source = freed.source;
    out.time_s = freed.time_s;
    out.text = trf(
        "piece {} comes free, {:.1f} x {:.1f} mm: it may tilt or fall between slats that are {:g} "
        "mm apart",
        piece.number, size.x, size.y, options_.slats_mm);
    log_.add(std::move(out));
  }
}

}  // namespace kerf
