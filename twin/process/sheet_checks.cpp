#include "twin/process/sheet_checks.h"

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/sheet/sheet.h"

namespace kerf {

std::vector<FreedPiece> freed_before(const Sheet& sheet) {
  std::vector<FreedPiece> freed(sheet.piece_numbers() - sheet.blank_piece_numbers());
  for (std::size_t i = 0; i < freed.size(); ++i) {
    freed[i].number = static_cast<std::uint32_t>(sheet.blank_piece_numbers() + i);
    freed[i].before = PieceOrigin();
  }
  for (SheetPiece& piece : sheet.pieces()) {
    if (piece.origin) freed[piece.number - sheet.blank_piece_numbers()].before = piece.origin;
  }
  return freed;
}

std::string free_since(const FreedPiece& piece) {
  // A machine without a program is on no line.
  const std::uint32_t line = piece.before ? piece.before->line : piece.source.line;
  if (line == 0) return tr("free");
  if (!piece.before || piece.before->file.empty()) return trf("free since line {}", line);
  return trf("free since line {} of {}", line, shown(piece.before->file));
}

void note_freed(const Sheet& sheet, std::size_t uncut_pieces, const Motion& m,
                const TimedStep& step, std::vector<FreedPiece>& freed) {
  const std::size_t numbers = sheet.piece_numbers();
  while (uncut_pieces + freed.size() < numbers) {
    const auto number = static_cast<std::uint32_t>(uncut_pieces + freed.size());
    freed.push_back({number, m.source, step.start_s + step.duration_s, std::nullopt});
  }
}

}  // namespace kerf
