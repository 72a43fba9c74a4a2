#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "stock/column_runs.h"
#include "stock/pieces/through_map.h"
#include "stock/present_heights.h"
#include "twin/process/milling/grip_points.h"
#include "twin/process/milling/piece_watch.h"

namespace kerf {
namespace {

constexpr float kNowhere = -std::numeric_limits<float>::infinity();

/// A piece that is loose, with its heights as they were when it was looked at last.
struct LooseCells {
  std::size_t number = 0;  ///< in the ledger
  int i0 = 0, j0 = 0, nx = 0, ny = 0;
  std::vector<float> heights_mm;  ///< of its box; kNowhere where it is not
  double top_mm = 0;
  double way_mm = 0;  ///< the tool has gone since it came free

  bool has(int i, int j) const { return i >= i0 && j >= j0 && i < i0 + nx && j < j0 + ny; }
};

class HeightPieces final : public PieceFinder {
 public:
  HeightPieces(const PieceSite& site, const PresentHeights& model)
      : site_(site), model_(model), bounds_mm_(site.stock.bounds_mm()) {}

  void before(const Cutter& cutter, const CutMove& move, const PieceCutter& by) override {
    may_cut_ = false;
    splits_.clear();
    if (!loose_.empty()) look_at_loose(cutter, move);
    if (is_over_ || !ThroughMap::reaches(move, bounds_mm_.min.z) || !is_near(cutter, move)) return;
    if (cutter.undercuts() || !move.is_vertical()) return;
    if (!map_ && !begin()) return;
    map_->cut(cutter, move, splits_);
    if (splits_.empty()) return;
    site_.complete();
    choose(by);
  }

  void after(const CutMove& move, const PieceCutter& by) override {
    if (!may_cut_ && freed_.empty()) return;
    site_.complete();
    const std::optional<HeightGrid> heights = present();
    if (!heights) return;
    if (may_cut_) note_cuts(*heights, move, by);
    for (Freed& piece : freed_) take(*heights, piece, by);
    freed_.clear();
  }

  void finish() override {
    if (loose_.empty()) return;
    site_.complete();
    const std::optional<HeightGrid> heights = present();
    if (!heights) return;
    for (const CellSet& cells : map_->bodies()) {
      const PieceBody body = measured(*heights, cells);
      if (body.volume_mm3 < kLeastPiece_mm3) continue;
      if (!loose_cells_.meets(cells)) {
        held_.push_back(body);
        continue;
      }
      const int i = 64 * cells[0].word + std::countr_zero(cells[0].bits), j = cells[0].row;
      for (LooseCells& piece : loose_) {
        if (piece.has(i, j) && at(piece, i, j) != kNowhere)
          site_.ledger.add_left(piece.number, body);
      }
    }
  }

  const std::vector<PieceBody>& held() const override { return held_; }

 private:
  /// Has come free on this move.
  struct Freed {
    CellSet cells;
    PieceBody body;  ///< as it was then
    Vec3 tip_mm{0};
    double share = 0;         ///< of the move, until then
    double way_after_mm = 0;  ///< of the same move
    double cut_after_mm3 = 0;
  };

  double cell_mm2() const { return cell_.x * cell_.y; }
  double above_floor(float height) const {
    return std::max(0.0, static_cast<double>(height) - bounds_mm_.min.z);
  }
  std::optional<HeightGrid> present() const { return model_.present_heights(); }

  bool is_near(const Cutter& cutter, const CutMove& move) const {
    const Box way = box_of(cutter, move);
    return way.min.x < bounds_mm_.max.x && way.max.x > bounds_mm_.min.x &&
           way.min.y < bounds_mm_.max.y && way.max.y > bounds_mm_.min.y;
  }

  static Box box_of(const Cutter& cutter, const CutMove& move) {
    Box box;
    box.extend(move.from_mm);
    box.extend(move.to_mm);
    if (move.arc) {
      const double arm = std::max(glm::length(move.from_mm - move.arc->center_mm),
                                  glm::length(move.to_mm - move.arc->center_mm));
      box.extend(move.arc->center_mm - arm);
      box.extend(move.arc->center_mm + arm);
    }
    box.min -= cutter.radius_mm();
    box.max += cutter.radius_mm();
    return box;
  }

  bool begin() {
    site_.complete();
    const std::optional<HeightGrid> heights = present();
    if (!heights) {
      is_over_ = true;
      return false;
    }
    cell_ = {heights->cell_x_mm(), heights->cell_y_mm()};
    map_.emplace(*heights);
    loose_cells_ = BitPlane(heights->nx(), heights->ny());
    grips_ = BitPlane(heights->nx(), heights->ny());
    for (const Vec3& point : grip_points(site_.stock, site_.fixtures)) {
      const int i = static_cast<int>(std::floor((point.x - bounds_mm_.min.x) / cell_.x));
      const int j = static_cast<int>(std::floor((point.y - bounds_mm_.min.y) / cell_.y));
      if (heights->contains(i, j)) grips_.set(i, j);
    }
    return true;
  }

  PieceBody measured(const HeightGrid& heights, const CellSet& cells) const {
    PieceBody piece;
    double sum = 0, top = 0;
    int i0 = heights.nx(), i1 = -1, j0 = heights.ny(), j1 = -1;
    each_cell(cells, [&](int i, int j) {
      const double height = above_floor(heights.height(i, j));
      sum += height;
      top = std::max(top, height);
      i0 = std::min(i0, i);
      i1 = std::max(i1, i);
      j0 = std::min(j0, j);
      j1 = std::max(j1, j);
    });
    piece.volume_mm3 = sum * cell_mm2();
    if (i1 < i0) return piece;
    piece.box_mm.min = bounds_mm_.min + Vec3(i0 * cell_.x, j0 * cell_.y, 0);
    piece.box_mm.max = {bounds_mm_.min.x + (i1 + 1) * cell_.x,
                        bounds_mm_.min.y + (j1 + 1) * cell_.y, bounds_mm_.min.z + top};
    return piece;
  }

  /// Of what each step has parted: which pieces nothing holds. Heights are those before the move.
  void choose(const PieceCutter& by) {
    const std::optional<HeightGrid> heights = present();
    if (!heights) return;
    const double whole_mm = splits_.back().way_mm;
    const std::vector<ThroughMap::Removed>& later = map_->removed_after_split();
    const double move_mm = later.empty() ? whole_mm : std::max(whole_mm, later.back().way_mm);
    for (ThroughSplit& split : splits_) {
      // What was loose is loose in parts as well.
      if (std::ranges::all_of(split.bodies,
                              [&](const CellSet& body) { return loose_cells_.meets(body); }))
        continue;
      std::size_t largest = 0;
      double most = -1;
      bool any_gripped = false;
      std::vector<PieceBody> bodies;
      for (std::size_t n = 0; n < split.bodies.size(); ++n) {
        bodies.push_back(measured(*heights, split.bodies[n]));
        if (bodies[n].volume_mm3 > most) {
          most = bodies[n].volume_mm3;
          largest = n;
        }
        any_gripped = any_gripped || grips_.meets(split.bodies[n]);
      }
      for (std::size_t n = 0; n < split.bodies.size(); ++n) {
        const bool is_held = any_gripped ? grips_.meets(split.bodies[n]) : n == largest;
        if (is_held) continue;
        Freed piece;
        piece.body = bodies[n];
        piece.tip_mm = split.tip_mm;
        piece.share = split.share;
        piece.way_after_mm = move_mm - split.way_mm;
        loose_cells_.add(split.bodies[n]);
        // The rest of the same move may go on in it.
        BitPlane& mine = map_->scratch();
        mine.add(split.bodies[n]);
        for (const ThroughMap::Removed& step : later) {
          if (step.way_mm - split.way_mm <= 2 * by.radius_mm) continue;
          for (CellWord cut : step.cells) {
            cut.bits &= mine.at(cut.row, cut.word);
            each_cell({cut}, [&](int i, int j) {
              piece.cut_after_mm3 += above_floor(heights->height(i, j)) * cell_mm2();
            });
          }
        }
        mine.remove(split.bodies[n]);
        for (CellWord cells : split.bodies[n]) {
          cells.bits &= map_->material().at(cells.row, cells.word);
          if (cells.bits != 0) piece.cells.push_back(cells);
        }
        freed_.push_back(std::move(piece));
      }
    }
  }

  /// After the move.
  void take(const HeightGrid& heights, const Freed& freed, const PieceCutter& by) {
    LoosePiece piece;
    piece.body = measured(heights, freed.cells);
    if (piece.body.volume_mm3 + freed.cut_after_mm3 < kLeastPiece_mm3) return;
    // Of one that the same move has cut up there is nothing to show but what it was.
    if (piece.body.volume_mm3 < kLeastPiece_mm3) piece.body = freed.body;
    piece.source = by.source;
    piece.time_s = by.start_s + freed.share * by.duration_s;
    piece.tool = by.tool;
    LooseCells cells;
    cells.number = site_.ledger.add(piece, by, freed.tip_mm);
    cells.way_mm = freed.way_after_mm;
    cells.top_mm = piece.body.box_mm.max.z;
    if (!piece.body.box_mm.empty()) {
      cells.i0 =
          static_cast<int>(std::lround((piece.body.box_mm.min.x - bounds_mm_.min.x) / cell_.x));
      cells.j0 =
          static_cast<int>(std::lround((piece.body.box_mm.min.y - bounds_mm_.min.y) / cell_.y));
      cells.nx = static_cast<int>(std::lround(piece.body.box_mm.size().x / cell_.x));
      cells.ny = static_cast<int>(std::lround(piece.body.box_mm.size().y / cell_.y));
    }
    cells.heights_mm.assign(static_cast<std::size_t>(cells.nx) * static_cast<std::size_t>(cells.ny),
                            kNowhere);
    each_cell(freed.cells, [&](int i, int j) { at(cells, i, j) = heights.height(i, j); });
    loose_.push_back(std::move(cells));
    if (freed.cut_after_mm3 > 0)
      site_.ledger.note_cut(loose_.back().number, freed.cut_after_mm3, by);
  }

  static float& at(LooseCells& piece, int i, int j) {
    return piece
        .heights_mm[static_cast<std::size_t>(j - piece.j0) * static_cast<std::size_t>(piece.nx) +
                    static_cast<std::size_t>(i - piece.i0)];
  }
  /// Whether the move may cut one of which that is not known yet.
  void look_at_loose(const Cutter& cutter, const CutMove& move) {
    const Box way = box_of(cutter, move);
    const double length = way_mm(move);
    for (LooseCells& piece : loose_) {
      if (site_.ledger.is_cut(piece.number)) continue;
      piece.way_mm += length;
      const double x0 = bounds_mm_.min.x + piece.i0 * cell_.x;
      const double y0 = bounds_mm_.min.y + piece.j0 * cell_.y;
      if (way.min.x < x0 + piece.nx * cell_.x && way.max.x > x0 &&
          way.min.y < y0 + piece.ny * cell_.y && way.max.y > y0 &&
          way.min.z + cutter.radius_mm() < piece.top_mm)
        may_cut_ = true;
    }
    if (may_cut_) radius_mm_ = cutter.radius_mm();
  }

  static double way_mm(const CutMove& move) {
    if (!move.arc) return glm::length(move.to_mm - move.from_mm);
    return std::abs(move.arc->sweep_rad) * glm::length(move.from_mm - move.arc->center_mm);
  }

  void note_cuts(const HeightGrid& heights, const CutMove& move, const PieceCutter& by) {
    Box way;
    way.extend(move.from_mm);
    way.extend(move.to_mm);
    const double reach =
        radius_mm_ + (move.arc ? 2 * glm::length(move.from_mm - move.arc->center_mm) : 0);
    const auto cell = [](double x, double origin, double edge) {
      return static_cast<int>(std::floor((x - origin) / edge));
    };
    for (LooseCells& piece : loose_) {
      if (site_.ledger.is_cut(piece.number)) continue;
      const int i0 = std::max(piece.i0, cell(way.min.x - reach, bounds_mm_.min.x, cell_.x));
      const int j0 = std::max(piece.j0, cell(way.min.y - reach, bounds_mm_.min.y, cell_.y));
      const int i1 =
          std::min(piece.i0 + piece.nx - 1, cell(way.max.x + reach, bounds_mm_.min.x, cell_.x));
      const int j1 =
          std::min(piece.j0 + piece.ny - 1, cell(way.max.y + reach, bounds_mm_.min.y, cell_.y));
      double sum = 0;
      for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i) {
          float& before = at(piece, i, j);
          if (before == kNowhere) continue;
          const float now = heights.height(i, j);
          if (now >= before) continue;
          sum += static_cast<double>(before - now);
          before = now;
        }
      }
      if (piece.way_mm > 2 * radius_mm_) site_.ledger.note_cut(piece.number, sum * cell_mm2(), by);
    }
  }

  PieceSite site_;
  const PresentHeights& model_;
  Box bounds_mm_;
  Vec2 cell_{1, 1};
  bool is_over_ = false;
  std::optional<ThroughMap> map_;
  BitPlane loose_cells_, grips_;
  std::vector<ThroughSplit> splits_;
  std::vector<Freed> freed_;
  std::vector<LooseCells> loose_;
  std::vector<PieceBody> held_;
  bool may_cut_ = false;
  double radius_mm_ = 0;
};

}  // namespace

std::unique_ptr<PieceFinder> find_height_pieces(const PieceSite& site) {
  const auto* const model = dynamic_cast<const PresentHeights*>(&site.stock.bare());
  const auto* const columns = dynamic_cast<const ColumnSource*>(&site.stock.bare());
  if (model == nullptr || columns == nullptr || !columns->has_heights_only()) return nullptr;
  return std::make_unique<HeightPieces>(site, *model);
}

}  // namespace kerf
