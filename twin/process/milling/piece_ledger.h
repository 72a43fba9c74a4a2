// twin/process/milling/piece_ledger.h - pieces that have come free: what is told of them.
//
// A piece is told once, as a warning, with the line that parted it. It becomes an error with the
// first motion that cuts on in it: that takes more than kLeastPiece_mm3 off it after the tool has
// gone on by more than its diameter. Until then a tool that has just cut it off takes away the
// points that are left of the last bridge, as each does.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/process/loose_piece.h"

namespace kerf {

/// What is smaller is a crumb, that nobody hears of.
inline constexpr double kLeastPiece_mm3 = 1;

/// A motion that cuts.
struct PieceCutter {
  SourceRef source;
  double start_s = 0, duration_s = 0;
  int tool = 0;
  double radius_mm = 0;
  bool guessed = false;  ///< the tool
};

class PieceLedger {
 public:
  explicit PieceLedger(FindingLog& log) : log_(log) {}
  void set_blank_guessed(bool guessed) { blank_guessed_ = guessed; }

  /// `tip_mm`: where the tool is as it comes free. Gives its number.
  std::size_t add(const LoosePiece& piece, const PieceCutter& by, const Vec3& tip_mm);
  /// By so much has a motion made it smaller.
  void note_cut(std::size_t number, double mm3, const PieceCutter& by);
  bool is_cut(std::size_t number) const { return rows_[number].piece.cut_by.has_value(); }
  void add_left(std::size_t number, const PieceBody& body) {
    rows_[number].piece.left.push_back(body);
  }

  bool empty() const { return rows_.empty(); }
  std::size_t size() const { return rows_.size(); }
  const LoosePiece& piece(std::size_t number) const { return rows_[number].piece; }
  /// What was told is forgotten: what goes on is told anew.
  void forget();

 private:
  struct Row {
    LoosePiece piece;
    Finding finding;
    FindingLog::Handle handle = FindingLog::kMaxKept;
    double cut_mm3 = 0;
    bool reported = true;  ///< it came free where the report looks
  };
  std::string text_of(const Row& row) const;
  FindingLog& log_;
  bool blank_guessed_ = false;
  std::vector<Row> rows_;
};

}  // namespace kerf
