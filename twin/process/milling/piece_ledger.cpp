#include "twin/process/milling/piece_ledger.h"

#include <utility>

#include "base/translate.h"
#include "twin/process/contact_grounds.h"

namespace kerf {

std::string PieceLedger::text_of(const Row& row) const {
  const Vec3 size = row.piece.body.box_mm.size();
  std::string out = trf("a piece of {:.1f} mm3 comes free, {:.2f} x {:.2f} x {:.2f} mm",
                        row.piece.body.volume_mm3, size.x, size.y, size.z);
  if (!row.piece.cut_by) return out;
  if (*row.piece.cut_by == row.piece.source) return out + tr(", and the tool goes on in it");
  const std::uint32_t line = row.piece.cut_by->line;
  if (line == 0) return out + tr(", and is cut into after that");
  return out + trf(", and line {} cuts into it after that", line);
}

std::size_t PieceLedger::add(const LoosePiece& piece, const PieceCutter& by, const Vec3& tip_mm) {
  Row row;
  row.piece = piece;
  row.finding.id = FindingId::kPieceFree;
  row.finding.severity = Severity::kWarning;
  row.finding.source = piece.source;
  row.finding.time_s = piece.time_s;
  row.finding.position_mm = tip_mm;
  row.finding.tool = by.tool;
  row.finding.text = text_of(row) + doubt_of(FindingId::kPieceFree, {blank_guessed_, by.guessed});
  row.finding.hint =
      tr("tabs or a skin left below hold it; a pocket is cleared from its middle outward");
  row.handle = log_.add(row.finding);
  rows_.push_back(std::move(row));
  return rows_.size() - 1;
}

void PieceLedger::note_cut(std::size_t number, double mm3, const PieceCutter& by) {
  Row& row = rows_[number];
  if (row.piece.cut_by) return;
  row.cut_mm3 += mm3;
  if (row.cut_mm3 <= kLeastPiece_mm3) return;
  row.piece.cut_by = by.source;
  const Grounds grounds{blank_guessed_, by.guessed};
  const Severity severity = severity_of(FindingId::kPieceFree, grounds);
  std::string text = text_of(row) + doubt_of(FindingId::kPieceFree, grounds);
  if (row.reported) {
    log_.reword(row.handle, std::move(text));
    log_.raise(row.handle, severity);
    return;
  }
  // It came free before the lines that are reported on: told where it is cut.
  row.finding.text = std::move(text);
  row.finding.severity = severity;
  row.finding.source = by.source;
  row.finding.time_s = by.start_s;
  row.finding.position_mm.reset();
  row.finding.tool = by.tool;
  row.handle = log_.add(row.finding);
}

void PieceLedger::forget() {
  for (Row& row : rows_) row.reported = false;
}

}  // namespace kerf
