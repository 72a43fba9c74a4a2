#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "stock/pieces/piece_map.h"
#include "stock/pieces/through_map.h"
#include "twin/process/milling/grip_points.h"
#include "twin/process/milling/piece_watch.h"

namespace kerf {
namespace {

/// Of a piece that nobody has cut into so far less has changed by rounding.
constexpr double kUntouched_mm3 = 0.01;

const ColumnSource* columns_of(const StockModel& stock) {
  return dynamic_cast<const ColumnSource*>(&stock.bare());
}

double turned_way_mm(const CutMove& move) {
  if (!move.arc) return glm::length(move.to_mm - move.from_mm);
  return std::abs(move.arc->sweep_rad) * glm::length(move.from_mm - move.arc->center_mm);
}

class ColumnPieces final : public PieceFinder {
 public:
  ColumnPieces(const PieceSite& site, const ColumnSource& source)
      : site_(site), source_(source), floor_mm_(site.stock.bounds_mm().min.z) {}

  void before(const Cutter& cutter, const CutMove& move, const PieceCutter& by) override {
    may_part_ = may_part_ || cutter.undercuts() || !move.is_vertical();
    // What comes between moves that are to be looked at is cut once more with them.
    if (!may_part_ && moves_.empty() && !ThroughMap::reaches(move, floor_mm_)) return;
    if (!base_) begin();
    if (cutters_.empty() || cutters_.back().spec() != cutter.spec()) cutters_.push_back(cutter);
    moves_.push_back({move, by, cutters_.size() - 1});
  }

  void after(const CutMove&, const PieceCutter&) override {
    if (moves_.size() >= kMovesBetweenLooks) look();
  }

  void finish() override {
    look();
    for (const PieceMap::Piece& piece : map_.pieces()) {
      if (piece.mm3 < kLeastPiece_mm3 || !piece.thick) continue;
      const PieceBody body{piece.mm3, piece.box_mm};
      if (const std::optional<std::size_t> number = number_of(piece.id)) {
        site_.ledger.add_left(*number, body);
      } else {
        held_.push_back(body);
      }
    }
  }

  const std::vector<PieceBody>& held() const override { return held_; }

 private:
  struct Made {
    CutMove move;
    PieceCutter by;
    std::size_t cutter = 0;
  };
  struct Loose {
    std::vector<std::uint32_t> ids;  ///< what it is now
    double mm3 = 0;                  ///< when it was looked at last
    double way_mm = 0;               ///< the tool has gone since
  };
  /// Has come free since the last look: when, is to be found out.
  struct Found {
    std::uint32_t id = 0;
    Vec3 inside_mm{0};
    std::vector<Vec3> held_mm;  ///< inside what is held of all that it was one with
  };

  /// All that there is now is held.
  void begin() {
    site_.complete();
    if (map_.pieces().empty()) {
      map_.update(source_);
      grips_mm_ = grip_points(site_.stock, site_.fixtures);
    }
    base_ = site_.stock.bare().snapshot();
  }

  double volume_of(const Loose& loose) const {
    double sum = 0;
    for (const std::uint32_t id : loose.ids) {
      if (const PieceMap::Piece* const piece = map_.find(id)) sum += piece->mm3;
    }
    return sum;
  }
  std::optional<std::size_t> number_of(std::uint32_t id) const {
    for (const auto& [number, loose] : loose_) {
      if (std::ranges::find(loose.ids, id) != loose.ids.end()) return number;
    }
    return std::nullopt;
  }

  void look() {
    if (moves_.empty()) return;
    site_.complete();
    std::vector<Found> found;
    for (const PieceMap::Parting& parting : map_.update(source_)) take(parting, found);
    bool cut = false;
    for (auto& [number, loose] : loose_) {
      if (site_.ledger.is_cut(number)) continue;
      cut = cut || volume_of(loose) < loose.mm3 - kUntouched_mm3;
    }
    if (cut || !found.empty()) {
      replay(found);
    } else {
      for (auto& [number, loose] : loose_) {
        for (const Made& made : moves_) loose.way_mm += turned_way_mm(made.move);
      }
    }
    moves_.clear();
    cutters_.clear();
    base_.reset();
  }

  void take(const PieceMap::Parting& parting, std::vector<Found>& found) {
    if (const std::optional<std::size_t> number = number_of(parting.parent)) {
      std::vector<std::uint32_t>& ids = loose_[*number].ids;
      ids.insert(ids.end(), parting.pieces.begin(), parting.pieces.end());
      return;
    }
    std::vector<const PieceMap::Piece*> real;
    for (const std::uint32_t id : parting.pieces) {
      const PieceMap::Piece* const piece = map_.find(id);
      if (piece->thick && piece->mm3 >= kLeastPiece_mm3) real.push_back(piece);
    }
    if (real.size() < 2) return;
    std::ranges::sort(real, std::greater<>(), &PieceMap::Piece::mm3);
    std::vector<std::uint32_t> gripped;
    for (const Vec3& grip : grips_mm_) {
      const std::optional<std::uint32_t> id = map_.piece_at(grip);
      if (id && std::ranges::find(parting.pieces, *id) != parting.pieces.end())
        gripped.push_back(*id);
    }
    if (gripped.empty()) gripped.push_back(real.front()->id);
    std::vector<Vec3> held_mm;
    for (const std::uint32_t id : gripped) held_mm.push_back(map_.find(id)->inside_mm);
    for (const PieceMap::Piece* const piece : real) {
      if (std::ranges::find(gripped, piece->id) != gripped.end()) continue;
      found.push_back({piece->id, piece->inside_mm, held_mm});
    }
  }

  /// The moves since the last look once more, one by one, on the workpiece as it was then.
  void replay(std::vector<Found>& found) {
    const std::unique_ptr<StockModel> stock = base_->snapshot();
    const ColumnSource& source = *columns_of(*stock);
    PieceMap map;
    map.update(source);
    // What was loose then, by the ids of this map.
    std::map<std::size_t, std::vector<std::uint32_t>> loose;
    for (const auto& [number, row] : loose_) {
      for (const std::uint32_t id : row.ids) {
        const PieceMap::Piece* const piece = map_.find(id);
        const auto at = piece ? map.piece_at(piece->inside_mm) : std::nullopt;
        if (at && std::ranges::find(loose[number], *at) == loose[number].end())
          loose[number].push_back(*at);
      }
    }
    std::map<std::size_t, double> volumes;
    const auto volume = [&](std::size_t number) {
      double sum = 0;
      for (const std::uint32_t id : loose[number]) {
        if (const PieceMap::Piece* const piece = map.find(id)) sum += piece->mm3;
      }
      return sum;
    };
    for (const auto& [number, ids] : loose) volumes[number] = volume(number);
    std::vector<CutReport> reports;
    for (const Made& made : moves_) {
      const Cutter& cutter = cutters_[made.cutter];
      stock->cut(cutter, std::span(&made.move, 1), reports);
      stock->finish(reports);
      for (const PieceMap::Parting& parting : map.update(source)) {
        for (auto& [number, ids] : loose) {
          if (std::ranges::find(ids, parting.parent) == ids.end()) continue;
          ids.insert(ids.end(), parting.pieces.begin(), parting.pieces.end());
        }
      }
      for (auto& [number, before] : volumes) {
        loose_[number].way_mm += turned_way_mm(made.move);
        const double now = volume(number);
        if (now < before && loose_[number].way_mm > 2 * made.by.radius_mm)
          site_.ledger.note_cut(number, before - now, made.by);
        before = now;
      }
      std::erase_if(found, [&](const Found& one) {
        const auto at = map.piece_at(one.inside_mm);
        if (!at) return false;
        for (const Vec3& held : one.held_mm) {
          if (map.piece_at(held) == at) return false;
        }
        // What has come free as one, and was cut up then, is one piece.
        for (const auto& [number, ids] : loose) {
          if (std::ranges::find(ids, *at) == ids.end()) continue;
          loose_[number].ids.push_back(one.id);
          return true;
        }
        const PieceMap::Piece& piece = *map.find(*at);
        LoosePiece row;
        row.body = {piece.mm3, piece.box_mm};
        row.source = made.by.source;
        row.time_s = made.by.start_s + made.by.duration_s;
        row.tool = made.by.tool;
        const std::size_t number = site_.ledger.add(row, made.by, made.move.to_mm);
        loose[number] = {*at};
        volumes[number] = piece.mm3;
        loose_[number].ids = {one.id};
        return true;
      });
    }
    for (auto& [number, row] : loose_) row.mm3 = volume_of(row);
  }

  PieceSite site_;
  const ColumnSource& source_;
  double floor_mm_;
  bool may_part_ = false;
  PieceMap map_;
  std::vector<Vec3> grips_mm_;
  std::unique_ptr<StockModel> base_;  ///< the workpiece before moves_; null: there are none
  std::vector<Made> moves_;
  std::vector<Cutter> cutters_;
  std::map<std::size_t, Loose> loose_;  ///< by number in the ledger
  std::vector<PieceBody> held_;
};

}  // namespace

std::unique_ptr<PieceFinder> find_column_pieces(const PieceSite& site) {
  const ColumnSource* const source = columns_of(site.stock);
  if (source == nullptr) return nullptr;
  return std::make_unique<ColumnPieces>(site, *source);
}

}  // namespace kerf
