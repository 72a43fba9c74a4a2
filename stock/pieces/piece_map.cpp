#include "stock/pieces/piece_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace kerf {
namespace {

constexpr int kSteps[5][3] = {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};

/// Sets that become one.
class Unions {
 public:
  explicit Unions(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t root(std::uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t first = root(a), second = root(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Calls see(run of a, run of b) for those of two columns that are side by side.
template <class See>
void each_beside(const ColumnRuns& a, std::size_t column_a, const ColumnRuns& b,
                 std::size_t column_b, const See& see) {
  std::uint32_t n = a.first[column_a], m = b.first[column_b];
  while (n < a.first[column_a + 1] && m < b.first[column_b + 1]) {
    const SolidRun &p = a.runs[n], &q = b.runs[m];
    if (std::min(p.high_mm, q.high_mm) > std::max(p.low_mm, q.low_mm)) see(n, m);
    (p.high_mm < q.high_mm ? n : m) += 1;
  }
}

}  // namespace

void PieceMap::label(std::uint32_t number, Tile& tile) const {
  const ColumnRuns& c = tile.columns;
  Unions unions(c.runs.size());
  const auto join = [&](std::uint32_t a, std::uint32_t b) { unions.join(a, b); };
  for (int j = 0; j < c.ny; ++j) {
    for (int i = 0; i < c.nx; ++i) {
      const std::size_t here = c.column(i, j);
      if (i > 0) each_beside(c, here, c, c.column(i - 1, j), join);
      if (j == 0) continue;
      for (int k = std::max(0, i - 1); k <= std::min(c.nx - 1, i + 1); ++k)
        each_beside(c, here, c, c.column(k, j - 1), join);
    }
  }
  tile.part_of.assign(c.runs.size(), kNone);
  tile.parts.clear();
  const std::uint32_t tx = number % static_cast<std::uint32_t>(layout_.tiles[0]);
  const std::uint32_t ty = number / static_cast<std::uint32_t>(layout_.tiles[0]) %
                           static_cast<std::uint32_t>(layout_.tiles[1]);
  const double area = layout_.cell_mm.x * layout_.cell_mm.y;
  for (int j = 0; j < c.ny; ++j) {
    for (int i = 0; i < c.nx; ++i) {
      const std::size_t here = c.column(i, j);
      for (std::uint32_t n = c.first[here]; n < c.first[here + 1]; ++n) {
        // The root is the least of its set: it comes first.
        const std::uint32_t root = unions.root(n);
        if (root == n) {
          tile.part_of[n] = static_cast<std::uint32_t>(tile.parts.size());
          tile.parts.emplace_back();
        } else {
          tile.part_of[n] = tile.part_of[root];
        }
        Part& part = tile.parts[tile.part_of[n]];
        const SolidRun& run = c.runs[n];
        const double length = static_cast<double>(run.high_mm) - static_cast<double>(run.low_mm);
        part.mm3 += area * length;
        const double x = static_cast<double>(tx) * layout_.columns[0] + i;
        const double y = static_cast<double>(ty) * layout_.columns[1] + j;
        const Vec2 low = layout_.low_mm + Vec2(x, y) * layout_.cell_mm;
        part.box_mm.extend(Vec3(low, run.low_mm));
        part.box_mm.extend(Vec3(low + layout_.cell_mm, run.high_mm));
        if (length <= part.longest_mm) continue;
        part.longest_mm = length;
        part.inside_mm = Vec3(low + layout_.cell_mm / 2.0, run.low_mm + length / 2);
      }
    }
  }
  mark_thick(tile);
}

void PieceMap::mark_thick(Tile& tile) const {
  const ColumnRuns& c = tile.columns;
  const auto thick = static_cast<float>(layout_.thick_mm);
  for (int j = 1; j < c.ny; ++j) {
    for (int i = 1; i < c.nx; ++i) {
      const std::size_t here = c.column(i, j);
      for (std::uint32_t n = c.first[here]; n < c.first[here + 1]; ++n) {
        Part& part = tile.parts[tile.part_of[n]];
        if (part.thick) continue;
        float low = c.runs[n].low_mm, high = c.runs[n].high_mm;
        // The run of each of the three others that has the most in common with what is left.
        for (const std::size_t other :
             {c.column(i - 1, j), c.column(i, j - 1), c.column(i - 1, j - 1)}) {
          float best_low = high, best_high = low;
          for (std::uint32_t m = c.first[other]; m < c.first[other + 1]; ++m) {
            const float a = std::max(low, c.runs[m].low_mm), b = std::min(high, c.runs[m].high_mm);
            if (b - a > best_high - best_low) {
              best_low = a;
              best_high = b;
            }
          }
          low = best_low;
          high = best_high;
          if (high - low < thick) break;
        }
        part.thick = high - low >= thick;
      }
    }
  }
}

/// Each part was of the piece that its first run was of.
void PieceMap::inherit(const Tile& before, Tile& tile) const {
  if (before.columns.first.empty()) return;
  const ColumnRuns& c = tile.columns;
  for (std::size_t column = 0; column + 1 < c.first.size(); ++column) {
    each_beside(c, column, before.columns, column, [&](std::uint32_t n, std::uint32_t m) {
      Part& part = tile.parts[tile.part_of[n]];
      if (part.piece == kNone) part.piece = before.parts[before.part_of[m]].piece;
    });
  }
}

std::optional<std::uint32_t> PieceMap::beside(std::uint32_t tile, std::size_t side,
                                              int sign) const {
  int at[3];
  int rest = static_cast<int>(tile);
  std::uint32_t number = 0, scale = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    at[a] = rest % layout_.tiles[a] + sign * kSteps[side][a];
    rest /= layout_.tiles[a];
    if (at[a] < 0 || at[a] >= layout_.tiles[a]) return std::nullopt;
    number += static_cast<std::uint32_t>(at[a]) * scale;
    scale *= static_cast<std::uint32_t>(layout_.tiles[a]);
  }
  return number;
}

void PieceMap::join(std::uint32_t number, std::size_t side) {
  Tile& tile = tiles_[number];
  auto& joints = tile.joints[side];
  joints.clear();
  const std::optional<std::uint32_t> next = beside(number, side, 1);
  if (!next) return;
  Tile& other = tiles_[*next];
  const ColumnRuns &a = tile.columns, &b = other.columns;
  if (a.runs.empty() || b.runs.empty()) return;
  const auto meet = [&](std::uint32_t n, std::uint32_t m) {
    const std::pair<std::uint32_t, std::uint32_t> joint{tile.part_of[n], other.part_of[m]};
    if (joints.empty() || joints.back() != joint) joints.push_back(joint);
  };
  const auto columns = [&](int i, int j, int k, int l) {
    if (k < 0 || l < 0 || k >= b.nx || l >= b.ny) return;
    each_beside(a, a.column(i, j), b, b.column(k, l), meet);
  };
  if (side == 0) {
    for (int j = 0; j < a.ny; ++j)
      for (int l = j - 1; l <= j + 1; ++l) columns(a.nx - 1, j, 0, l);
  } else if (side == 1) {
    for (int i = 0; i < a.nx; ++i)
      for (int k = i - 1; k <= i + 1; ++k) columns(i, a.ny - 1, k, 0);
  } else if (side == 2) {
    columns(a.nx - 1, a.ny - 1, 0, 0);
  } else if (side == 3) {
    columns(0, a.ny - 1, b.nx - 1, 0);
  } else {
    for (std::size_t column = 0; column + 1 < a.first.size(); ++column) {
      if (a.first[column] == a.first[column + 1] || b.first[column] == b.first[column + 1])
        continue;
      const std::uint32_t n = a.first[column + 1] - 1, m = b.first[column];
      if (a.runs[n].high_mm == b.runs[m].low_mm) meet(n, m);
    }
  }
  std::ranges::sort(joints);
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
}

std::vector<PieceMap::Parting> PieceMap::update(const ColumnSource& source) {
  if (tiles_.empty()) {
    layout_ = source.column_layout();
    tiles_.resize(static_cast<std::size_t>(layout_.tiles[0]) *
                  static_cast<std::size_t>(layout_.tiles[1]) *
                  static_cast<std::size_t>(layout_.tiles[2]));
  }
  std::vector<std::uint32_t> changed;
  for (std::uint32_t n = 0; n < tiles_.size(); ++n) {
    Tile& tile = tiles_[n];
    const std::uint64_t version = source.column_version(n);
    if (!tile.columns.first.empty() && tile.version == version) continue;
    Tile fresh;
    fresh.version = version;
    source.read_columns(n, fresh.columns);
    label(n, fresh);
    inherit(tile, fresh);
    fresh.joints = std::move(tile.joints);
    tile = std::move(fresh);
    changed.push_back(n);
  }
  if (changed.empty()) return {};
  for (const std::uint32_t n : changed) {
    for (std::size_t side = 0; side < kSides; ++side) {
      join(n, side);
      if (const std::optional<std::uint32_t> before = beside(n, side, -1)) join(*before, side);
    }
  }
  return gather();
}

std::vector<PieceMap::Parting> PieceMap::gather() {
  std::vector<std::uint32_t> first(tiles_.size() + 1, 0);
  for (std::size_t n = 0; n < tiles_.size(); ++n)
    first[n + 1] = first[n] + static_cast<std::uint32_t>(tiles_[n].parts.size());
  Unions unions(first.back());
  for (std::uint32_t n = 0; n < tiles_.size(); ++n) {
    for (std::size_t side = 0; side < kSides; ++side) {
      if (tiles_[n].joints[side].empty()) continue;
      const std::uint32_t other = *beside(n, side, 1);
      for (const auto& [a, b] : tiles_[n].joints[side]) unions.join(first[n] + a, first[other] + b);
    }
  }
  // By root: what it is, and what it was part of.
  std::vector<Piece> found;
  std::vector<std::uint32_t> parents, index(first.back(), kNone);
  for (std::size_t n = 0; n < tiles_.size(); ++n) {
    for (std::uint32_t p = 0; p < tiles_[n].parts.size(); ++p) {
      const Part& part = tiles_[n].parts[p];
      const std::uint32_t root = unions.root(first[n] + p);
      if (index[root] == kNone) {
        index[root] = static_cast<std::uint32_t>(found.size());
        found.emplace_back();
        parents.push_back(kNone);
      }
      Piece& piece = found[index[root]];
      piece.mm3 += part.mm3;
      piece.box_mm.extend(part.box_mm);
      piece.thick = piece.thick || part.thick;
      if (part.longest_mm > piece.longest_mm) {
        piece.longest_mm = part.longest_mm;
        piece.inside_mm = part.inside_mm;
      }
      std::uint32_t& parent = parents[index[root]];
      if (parent == kNone) parent = part.piece;
    }
  }
  std::map<std::uint32_t, std::vector<std::size_t>> children;
  for (std::size_t n = 0; n < found.size(); ++n) children[parents[n]].push_back(n);
  std::vector<Parting> out;
  for (const auto& [parent, those] : children) {
    if (parent != kNone && those.size() == 1) {
      found[those[0]].id = parent;
      continue;
    }
    Parting parting;
    parting.parent = parent;
    for (const std::size_t n : those) {
      found[n].id = next_id_++;
      parting.pieces.push_back(found[n].id);
    }
    if (parent != kNone) out.push_back(std::move(parting));
  }
  for (std::size_t n = 0; n < tiles_.size(); ++n) {
    for (std::uint32_t p = 0; p < tiles_[n].parts.size(); ++p)
      tiles_[n].parts[p].piece = found[index[unions.root(first[n] + p)]].id;
  }
  std::ranges::sort(found, {}, &Piece::id);
  pieces_ = std::move(found);
  return out;
}

const PieceMap::Piece* PieceMap::find(std::uint32_t id) const {
  const auto at = std::ranges::lower_bound(pieces_, id, {}, &Piece::id);
  return at != pieces_.end() && at->id == id ? &*at : nullptr;
}

std::optional<std::uint32_t> PieceMap::piece_at(const Vec3& point) const {
  if (tiles_.empty()) return std::nullopt;
  const Vec2 at = (Vec2(point) - layout_.low_mm) / layout_.cell_mm;
  const int i = static_cast<int>(std::floor(at.x)), j = static_cast<int>(std::floor(at.y));
  if (i < 0 || j < 0) return std::nullopt;
  const int tx = i / layout_.columns[0], ty = j / layout_.columns[1];
  if (tx >= layout_.tiles[0] || ty >= layout_.tiles[1]) return std::nullopt;
  for (int tz = 0; tz < layout_.tiles[2]; ++tz) {
    const Tile& tile =
        tiles_[static_cast<std::size_t>((tz * layout_.tiles[1] + ty) * layout_.tiles[0] + tx)];
    const int x = i % layout_.columns[0], y = j % layout_.columns[1];
    if (x >= tile.columns.nx || y >= tile.columns.ny) continue;
    const std::size_t column = tile.columns.column(x, y);
    for (std::uint32_t n = tile.columns.first[column]; n < tile.columns.first[column + 1]; ++n) {
      const SolidRun& run = tile.columns.runs[n];
      if (point.z >= static_cast<double>(run.low_mm) && point.z <= static_cast<double>(run.high_mm))
        return tile.parts[tile.part_of[n]].piece;
    }
  }
  return std::nullopt;
}

}  // namespace kerf
