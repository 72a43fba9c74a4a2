// twin/process/kept_moves.h - the moves that have cut a workpiece, to ask exactly what they left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/cutter.h"
#include "stock/stock_model.h"

namespace kerf {

/// A grid of heights has one height a cell. Where a wall stands between two cells, and how deep a
/// point between four of them is, only the moves know. These are kept here as they were given to
/// the model, about 100 bytes each, and asked by boxes about 64 and 4096 of them that follow each
/// other. One thread adds; asking is thread-safe afterwards.
class KeptMoves {
 public:
  /// Of more than these nothing is kept.
  static constexpr std::size_t kMost = std::size_t{2} << 20;

  /// What StockModel::cut() is given; CutMove::id is the label.
  void add(const Cutter& cutter, std::span<const CutMove> moves);

  /// All moves are here, by upright tools without an undercut: what is asked below is exact, to
  /// 0.0001 mm.
  bool is_exact() const { return is_exact_ && !moves_.empty(); }
  std::size_t size() const { return moves_.size(); }
  const Cutter& cutter_of(std::size_t move) const { return mounts_[moves_[move].mount].cutter; }
  std::uint32_t label_of(std::size_t move) const { return moves_[move].label; }
  /// The way of the tip, its ends and points no farther from each other than `step_mm`.
  void tips_of(std::size_t move, double step_mm, std::vector<Vec3>& tips) const;

  /// Height of the lowest envelope over a point, and whose it is; infinite where none comes over
  /// it.
  struct Lowest {
    double z_mm;
    std::uint32_t label = MeshPatch::kNotCut;
  };
  Lowest lowest(const Vec2& xy_mm) const;
  /// The label of a move that removes what is at the point; the first one. None: none does.
  std::optional<std::uint32_t> cut_by(const Vec3& point_mm) const;

  /// The same as cut_by() for points near each other, all within a box: what cannot reach it is
  /// looked at once.
  /// How far along a way from a place that has been cut all is cut.
  struct Far {
    bool is_cut = false;                       ///< the place itself
    double share = 0;                          ///< of the way
    std::uint32_t label = MeshPatch::kNotCut;  ///< who has come so far
    std::size_t tried = 0;                     ///< moves that had to be looked at closely
  };

  class Near {
   public:
    /// What cuts below `box_mm.min.z` is looked at as well: heights are endless upward.
    Near(const KeptMoves& kept, const Box& box_mm);
    std::optional<std::uint32_t> cut_by(const Vec3& point_mm) const;
    Lowest lowest(const Vec2& xy_mm) const;
    /// At a height from one point to another, to `fine` of the way. Of moves that come as far (to
    /// `fine`) the first.
    Far farthest(const Vec2& from_mm, const Vec2& to_mm, double z_mm, double fine) const;
    std::size_t size() const { return moves_.size(); }

   private:
    const KeptMoves& kept_;
    std::vector<std::uint32_t> moves_;
    mutable std::size_t last_ = 0;  ///< of moves_: it cut the point before
    mutable std::vector<std::uint32_t> tried_;
  };

  /// Which move's cutter comes nearest to a point on its way, and how near (0: it touches). By
  /// spheres about the tip as wide as the cutter: for telling, not for measuring. Of no moves none.
  struct Pass {
    std::uint32_t label = MeshPatch::kNotCut;
    double distance_mm = 0;
  };
  std::optional<Pass> nearest_pass(const Vec3& point_mm) const;

 private:
  static constexpr std::size_t kChunk = 64;
  static constexpr std::uint32_t kStraight = 0xffff'ffff;
  struct Move {
    Vec3 from_mm, to_mm;
    std::uint32_t label = 0;
    std::uint32_t arc = kStraight;  ///< index into arcs_
    std::uint32_t mount = 0;        ///< index into mounts_
  };
  struct Mount {
    Cutter cutter;
    bool is_convex;
  };
  /// All that the cutters of some moves can reach, endless upward.
  struct Reach {
    Vec2 min{std::numeric_limits<double>::infinity()};
    Vec2 max{-std::numeric_limits<double>::infinity()};
    double low = std::numeric_limits<double>::infinity();
    void extend(const Reach& other);
    bool meets(const Vec3& low_corner, const Vec3& high_corner) const {
      return min.x <= high_corner.x && max.x >= low_corner.x && min.y <= high_corner.y &&
             max.y >= low_corner.y && low <= high_corner.z;
    }
  };
  template <class Take>
  void each_meeting(const Vec3& low, const Vec3& high, const Take& take) const;
  double least_over(std::uint32_t move, const Vec2& xy_mm) const;
  bool cuts(std::uint32_t move, const Vec3& point_mm) const;

  std::vector<Move> moves_;
  std::vector<Reach> reach_, chunks_, groups_;  ///< of each move, of 64, of 4096
  std::vector<CutArc> arcs_;
  std::vector<Mount> mounts_;
  const Cutter* last_cutter_ = nullptr;
  bool is_exact_ = true;
};

}  // namespace kerf
