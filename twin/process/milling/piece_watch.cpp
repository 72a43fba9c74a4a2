#include "twin/process/milling/piece_watch.h"

namespace kerf {

void PieceWatch::before(const Cutter& cutter, const CutMove& move, const PieceCutter& by) {
  if (!begun_) {
    begun_ = true;
    const PieceSite site{stock_, ledger_, complete_, fixtures_};
    finder_ = find_height_pieces(site);
    if (!finder_) finder_ = find_column_pieces(site);
  }
  if (finder_) finder_->before(cutter, move, by);
}

std::vector<LoosePiece> PieceWatch::pieces() const {
  std::vector<LoosePiece> out;
  if (ledger_.empty()) return out;
  for (const PieceBody& body : finder_->held()) out.push_back({body, true});
  for (std::size_t n = 0; n < ledger_.size(); ++n) out.push_back(ledger_.piece(n));
  return out;
}

}  // namespace kerf
