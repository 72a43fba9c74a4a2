#include "stock/octree/octree.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "base/worker_pool.h"
#include "stock/move_reach.h"
#include "stock/octree/blank_bricks.h"
#include "stock/octree/blank_contact.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/dual_contour_mesh.h"
#include "stock/octree/dual_contour_patch.h"
#include "stock/octree/hermite_gather.h"
#include "stock/octree/mesh_bricks.h"
#include "stock/octree/octree_state.h"
#include "stock/octree/part_bodies.h"
#include "stock/octree/part_contact.h"
#include "stock/octree/solid_point.h"
#include "stock/octree/thin_films.h"
#include "stock/octree/tool_bodies.h"
#include "stock/octree/tree_columns.h"
#include "stock/octree/tree_cut.h"
#include "stock/octree/turned_tree.h"
#include "stock/state_bytes.h"

namespace kerf {
namespace {

using namespace octree;  // NOLINT: the parts of this very model

/// Moves are worked off in portions of about so many; each brick is opened once a portion.
constexpr std::size_t kMovesAtOnce = 512, kSweepsAtOnce = 2048;
/// Memory of a brick with surface, with room for slanting ones: where the surface is flat and along
/// the axes it is a head of 200 and 64 crossings of 6 bytes (10 with ids).
constexpr double kBrickBytes = 900;
/// Of a column, beside its own bytes: two blocks of the heap.
constexpr std::size_t kMallocBytes = 64;
/// A tool has no upper end that a program would say, so an upright one cuts from its tip to the top
/// of the blank, layer by layer.
constexpr int kMostLayers = 20'000;
/// A part has so many times the surface of its blank's box.
constexpr double kPartSurface = 2;
constexpr int kContactSteps = 24;
/// A search for contacts takes so many moves at once.
constexpr std::size_t kContactMoves = 32;
/// Of ways of more moves depths are good for the tolerance only.
constexpr std::size_t kExactDepthMoves = 256;
/// Of longer ones so many count for the depth, evenly taken from all: they are turns that lie
/// close together.
constexpr std::size_t kMostDepthMoves = 4096;

double needed_bytes(const Lattice& lattice) {
  const double nx = lattice.cells[0], ny = lattice.cells[1], nz = lattice.cells[2];
  const double surface = 2 * (nx * ny + ny * nz + nz * nx) / (kBrick * kBrick);
  const double columns = static_cast<double>(lattice.tiles[0]) * lattice.tiles[1];
  const double tiles = columns * lattice.tiles[2];
  // Of each brick it is known what sweeps came near (BrickTree::note_reach()).
  return kPartSurface * surface * kBrickBytes + columns * (sizeof(Column) + kMallocBytes) +
         tiles * (sizeof(TileRef) + kBricksInTile);
}

std::string size_text(double bytes) {
  const double mb = bytes / 1e6;
  return mb < 1000 ? fmt::format("{:.0f} MB", std::ceil(mb)) : fmt::format("{:.1f} GB", mb / 1000);
}

bool is_lowest_at_axis(const Cutter& cutter) {
  const std::span<const ProfilePiece> profile = cutter.profile();
  if (profile.empty() || profile.front().r0 != 0) return false;
  const double tip = profile.front().z0;
  return std::all_of(profile.begin(), profile.end(), [tip](const ProfilePiece& piece) {
    return std::min(piece.z0, piece.z1) >= tip;
  });
}

/// What a value's second digit counts: 0.01 of 0.37. By logarithms it would go by the processor at
/// powers of ten, and the cell with it.
double second_digit(double value) {
  constexpr double kMost = 1e20;  // an exact number, as is each power of ten below
  double power = 1;
  if (value >= 1) {
    while (power < kMost && power * 10 <= value) power *= 10;
    return power / 10;
  }
  while (power < kMost && 1 / power > value) power *= 10;
  return 1 / (power * 10);
}

/// The smallest cell, rounded up to two digits, that keeps within the limit.
double fitting_cell(const Box& box, double cell, double limit) {
  while (needed_bytes(Lattice::over(box, cell)) > limit) {
    const double digit = second_digit(cell);
    cell = (std::floor(cell / digit + 1e-9) + 1) * digit;
  }
  return cell;
}

/// The smallest cell, rounded up to two digits, of which no more than kMostLayers lie on each
/// other.
double layers_cell(double height_mm) {
  const double cell = height_mm / kMostLayers;
  const double digit = second_digit(cell);
  return std::ceil(cell / digit - 1e-9) * digit;
}

/// A box's bytes are counted before it is made: the numbers of nodes alone must fit in an int.
bool countable(const Box& box, double cell) {
  for (int a = 0; a < 3; ++a)
    if (box.size()[a] / cell > 1e6) return false;
  return true;
}

Done check(const OctreeOptions& options, const Box& box) {
  const double cell = options.cell_mm;
  const bool has_mesh = options.blank.mesh && options.blank.mesh->body;
  if (box.empty() || (options.blank.bodies.empty() && !has_mesh))
    return Error{tr("the blank is empty")};
  if (const std::string need = need_to_turn(options.blank); !need.empty())
    return Error{trf("{} cannot hold it: {}", "octree", need)};
  if (!std::isfinite(cell) || cell <= 0)
    return Error{trf("cell size {} mm is not allowed; must be above 0", cell)};
  const Vec3 size = box.size();
  if (cell > std::min({size.x, size.y, size.z})) {
    return Error{
        trf("cell size {} mm exceeds the blank, which is {} x {} x {} mm; 0.05 to 0.5 mm "
            "suits most parts",
            cell, size.x, size.y, size.z)};
  }
  if (!countable(box, cell)) {
    return Error{
        trf("cell size {} mm is not allowed; the blank must not have more than a "
            "million cells along an edge: at least {:.2g} mm",
            cell, std::max({size.x, size.y, size.z}) / 1e6)};
  }
  if (size.z / cell > kMostLayers) {
    return Error{
        trf("cell size {} mm makes {:.0f} layers of cells between the blank's floor and "
            "its top; {} are allowed, for which {:.2g} mm fits",
            cell, std::ceil(size.z / cell), kMostLayers, layers_cell(size.z))};
  }
  const double needed = needed_bytes(Lattice::over(box, cell));
  const double limit = static_cast<double>(options.memory_limit_bytes);
  if (needed > limit) {
    const double fits = fitting_cell(box, cell, limit);
    return Error{trf(
        "cell size {} mm would need about {} of memory; {} are allowed, for which {:.2g} mm fits",
        cell, size_text(needed), size_text(limit), fits)};
  }
  return std::monostate{};
}

}  // namespace

struct Octree::Impl {
  BrickTree tree;
  bool additive = false;
  double blank_mm3 = 0;
  std::int64_t removed = 0;  ///< in kNodeVolume; added counts as removed air
  SweepKernel kernel = pick_kernel(KernelChoice::kAuto);
  std::shared_ptr<WorkerPool> pool;
  ThinFilms films;
  std::optional<BrickTree> seen;  ///< as take_dirty_tiles() saw it last

  std::vector<BlankBody> bodies_of_blank;  ///< none: nobody knows

  std::string cutter_spec;
  std::vector<ToolBody> bodies;
  bool lowest_at_axis = false;  ///< the cutter's tip is

  explicit Impl(BrickTree t) : tree(std::move(t)) {}

  double mm3(std::int64_t volume) const {
    return static_cast<double>(volume) / kNodeVolume * tree.lattice().node_mm3();
  }
  /// Of a cell, in the mean.
  double face_mm2() const {
    const Vec3& c = tree.lattice().cell_mm;
    return (c.x * c.y + c.y * c.z + c.z * c.x) / 3;
  }
  double height_mm(std::int32_t height) const {
    return static_cast<double>(height) / kEdgeParts * tree.lattice().cell_mm.z;
  }
  double cell() const {
    const Vec3& c = tree.lattice().cell_mm;
    return std::max({c.x, c.y, c.z});
  }
  /// Where sweeps can find nodes: one layer lies outside of the blank.
  Box reach() const {
    Box box = tree.lattice().bounds_mm;
    box.min -= tree.lattice().cell_mm;
    box.max += tree.lattice().cell_mm;
    return box;
  }
  SweepTarget target(double shrink_mm) const { return {reach(), chord_mm(cell()), shrink_mm}; }
  std::vector<Sweep> sweeps_of(const std::vector<ToolBody>& tool, std::span<const CutMove> moves,
                               double shrink_mm) const {
    std::vector<Sweep> sweeps;
    for (const CutMove& move : moves)
      if (const std::optional<CutMove> near = within_reach(move, tree.lattice().bounds_mm))
        append_sweeps(tool, *near, 0, target(shrink_mm), sweeps);
    return sweeps;
  }
  bool touches(const std::vector<ToolBody>& tool, std::span<const CutMove> moves,
               double shrink_mm) const {
    return touches_tree(tree, bodies_of_blank, sweeps_of(tool, moves, shrink_mm), kernel);
  }
  /// A copy less what the tool, drawn in by `shrink_mm`, takes (kMostDepthMoves); nothing if it is
  /// stopped.
  std::optional<BrickTree> loss_of(const std::vector<ToolBody>& tool,
                                   std::span<const CutMove> moves, double shrink_mm,
                                   const WayWatch& watch) const {
    BrickTree copy = tree;
    WorkerPool alone(1);
    MoveTotals totals;
    const std::size_t each = kContactMoves * (1 + (moves.size() - 1) / kMostDepthMoves);
    for (std::size_t next = 0; next < moves.size(); next += each) {
      if (watch.stop.stop_requested()) return std::nullopt;
      watch.tell(static_cast<double>(next) / static_cast<double>(moves.size()));
      const auto some = moves.subspan(next, std::min(kContactMoves, moves.size() - next));
      cut_tree(copy, sweeps_of(tool, some, shrink_mm), kernel, false, alone, std::span(&totals, 1),
               nullptr);
    }
    return copy;
  }
  /// A plunge whose depth the tip tells (plunge_mm()).
  bool is_plunge(const CutMove& move) const {
    return bodies_of_blank.size() == 1 && !additive && lowest_at_axis && move.is_vertical() &&
           !move.arc && move.to_mm.x == move.from_mm.x && move.to_mm.y == move.from_mm.y &&
           move.to_mm.z < move.from_mm.z && move.to_mm.z < tree.lattice().bounds_mm.max.z;
  }
  /// Before the move is cut, and after all that come before.
  double plunge_mm(const CutMove& move) const {
    if (!is_plunge(move)) return 0;
    return BlankContact(tree.lattice(), kernel, bodies_of_blank).plunge_depth_mm(tree, move.to_mm);
  }
  PartField parts_field() const { return {tree, kernel, bodies_of_blank}; }
  DualField field() const {
    return {tree.lattice().origin_mm, tree.lattice().cell_mm,
            [this](const std::array<int, 3>& first, const std::array<int, 3>& nodes,
                   HermiteGrid* grid) { octree::gather(tree, additive, first, nodes, grid); }};
  }
};

Octree::Octree(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Octree::~Octree() = default;

Result<std::unique_ptr<Octree>> Octree::create(const OctreeOptions& options) {
  const Box box = options.blank.bounds_mm();
  const Done checked = check(options, box);
  if (!checked) return Error{checked.error()};
  const auto pool = std::make_shared<WorkerPool>(std::max(1, options.threads));
  const Lattice lattice = Lattice::over(box, options.cell_mm);
  auto impl = std::make_unique<Impl>(options.additive ? solid_tree(lattice)
                                                      : blank_tree(lattice, options.blank, *pool));
  impl->pool = pool;
  impl->kernel = pick_kernel(options.kernel);
  impl->additive = options.additive;
  if (!options.additive) {
    impl->tree.follow_reach();
    impl->bodies_of_blank = options.blank.bodies;
  }
  const std::vector<BlankBody>& bodies = options.blank.bodies;
  if (!options.additive)
    impl->blank_mm3 = bodies.size() == 1 && bodies[0].kind == BlankBody::Kind::kBox
                          ? box.volume_mm3()
                          : impl->mm3(volume_of(impl->tree));
  return std::unique_ptr<Octree>(new Octree(std::move(impl)));
}

Done Octree::save(const std::string& path) const { return save_with(path, {}); }

Done Octree::save_with(const std::string& path, std::string beside) const {
  return write_tree(
      path, {impl_->tree, impl_->additive, impl_->blank_mm3, impl_->removed, std::move(beside)});
}

Result<std::unique_ptr<Octree>> Octree::load(const std::string& path, int threads,
                                             octree::KernelChoice kernel) {
  std::string beside;
  return load_with(path, threads, kernel, beside);
}

Result<std::unique_ptr<Octree>> Octree::load_with(const std::string& path, int threads,
                                                  octree::KernelChoice kernel,
                                                  std::string& beside) {
  const Result<std::string> bytes = read_state_bytes(path);
  if (!bytes) return Error{bytes.error()};
  Result<SavedTree> saved = parse_tree(*bytes, path);
  if (!saved) return Error{saved.error()};
  auto impl = std::make_unique<Impl>(std::move(saved->tree));
  impl->kernel = pick_kernel(kernel);
  impl->additive = saved->additive;
  impl->blank_mm3 = saved->blank_mm3;
  impl->removed = saved->removed;
  beside = std::move(saved->beside);
  impl->pool = std::make_shared<WorkerPool>(std::max(1, threads));
  return std::unique_ptr<Octree>(new Octree(std::move(impl)));
}

bool Octree::is_additive() const { return impl_->additive; }

std::unique_ptr<Octree> Octree::placed(const AxisTurn& turn, const Vec3& at_mm) const {
  assert(!impl_->additive);
  auto impl = std::make_unique<Impl>(turned_tree(impl_->tree, turn, at_mm, *impl_->pool));
  impl->kernel = impl_->kernel;
  impl->blank_mm3 = impl_->blank_mm3;
  impl->removed = impl_->removed;
  impl->pool = impl_->pool;
  return std::unique_ptr<Octree>(new Octree(std::move(impl)));
}

Result<std::unique_ptr<Octree>> Octree::of_surface(const TriangleMesh& surface,
                                                   const Placement& placement, double cell_mm,
                                                   int threads, double blank_mm3) {
  TriangleMesh placed = surface;
  OctreeOptions options;
  BlankBody box;
  for (glm::vec3& p : placed.positions_mm) {
    const Vec3 lies = placement.placed(Vec3(p));
    box.bounds_mm.extend(lies);
    p = glm::vec3(lies);
  }
  options.blank.bodies.push_back(box);
  options.cell_mm = cell_mm;
  const Done checked = check(options, box.bounds_mm);
  if (!checked) return Error{checked.error()};
  const auto pool = std::make_shared<WorkerPool>(std::max(1, threads));
  BrickTree tree(Lattice::over(box.bounds_mm, cell_mm));
  fill_mesh(tree, placed, *pool);
  auto impl = std::make_unique<Impl>(std::move(tree));
  impl->pool = pool;
  impl->blank_mm3 = blank_mm3;
  const double gone_mm3 = blank_mm3 - impl->mm3(volume_of(impl->tree));
  impl->removed = std::llround(gone_mm3 / impl->tree.lattice().node_mm3() * kNodeVolume);
  return std::unique_ptr<Octree>(new Octree(std::move(impl)));
}

double Octree::surface_bound_mm(double cell_mm) { return std::sqrt(3.0) * cell_mm; }

Done Octree::can_cut(const Cutter& cutter) {
  const Result<std::vector<ToolBody>> bodies = tool_bodies(cutter);
  if (!bodies) return Error{bodies.error()};
  return std::monostate{};
}

void Octree::cut(const Cutter& cutter, std::span<const CutMove> moves,
                 std::vector<CutReport>& reports) {
  Impl& m = *impl_;
  if (m.cutter_spec != cutter.spec() || m.bodies.empty()) {
    Result<std::vector<ToolBody>> bodies = tool_bodies(cutter);
    assert(bodies);
    m.bodies = std::move(*bodies);
    m.cutter_spec = cutter.spec();
    m.lowest_at_axis = is_lowest_at_axis(cutter);
  }
  const double sign = m.additive ? -1 : 1;
  std::vector<Sweep> sweeps;
  std::vector<MoveTotals> totals;
  std::vector<FilmSpot> spots;
  std::vector<CutFilm> films;
  for (std::size_t first = 0; first < moves.size();) {
    sweeps.clear();
    std::size_t last = first;
    const double plunge_mm = m.plunge_mm(moves[first]);
    for (; last < moves.size() && last - first < kMovesAtOnce && sweeps.size() < kSweepsAtOnce;
         ++last) {
      if (last > first && m.is_plunge(moves[last])) break;
      const std::optional<CutMove> near = within_reach(moves[last], m.tree.lattice().bounds_mm);
      if (!near) continue;
      append_sweeps(m.bodies, *near, static_cast<std::uint32_t>(last - first), m.target(0), sweeps);
    }
    totals.assign(last - first, MoveTotals{});
    spots.clear();
    cut_tree(m.tree, sweeps, m.kernel, m.additive, *m.pool, totals, &spots);
    films.assign(totals.size(), CutFilm{});
    m.films.add(spots, m.face_mm2(), films);
    for (std::size_t i = 0; i < totals.size(); ++i) {
      m.removed += totals[i].volume;
      double depth_mm = m.height_mm(totals[i].height);
      if (i == 0) depth_mm = std::max(depth_mm, plunge_mm);
      reports.push_back({moves[first + i].id, sign * m.mm3(totals[i].volume), depth_mm, films[i]});
    }
    first = last;
  }
}

double Octree::keep_within(const RevolvedBody& body, const ZRange& range) {
  assert(!impl_->additive);
  impl_->bodies_of_blank.clear();
  const std::int64_t gone = cut_to_revolved(impl_->tree, body, range, *impl_->pool);
  impl_->removed += gone;
  return impl_->mm3(gone);
}

std::optional<Contact> Octree::first_contact(const Cutter& cutter, const CutMove& move,
                                             double tolerance_mm) const {
  const std::optional<WayContact> found =
      first_contact_of(cutter, std::span(&move, 1), tolerance_mm, {});
  return found ? std::optional(found->contact) : std::nullopt;
}

std::optional<WayContact> Octree::first_contact_of(const Cutter& cutter,
                                                   std::span<const CutMove> moves,
                                                   double tolerance_mm,
                                                   const WayWatch& watch) const {
  const Impl& m = *impl_;
  if (m.additive) return std::nullopt;
  const Result<std::vector<ToolBody>> tool = tool_bodies(cutter);
  assert(tool);
  // Until the first contact each move is looked at once, from there on cut once or twice.
  const double count = static_cast<double>(moves.size());
  std::size_t first = 0;
  while (first < moves.size()) {
    if (watch.stop.stop_requested()) return std::nullopt;
    watch.tell(static_cast<double>(first) / count);
    const std::span<const CutMove> some =
        moves.subspan(first, std::min(kContactMoves, moves.size() - first));
    if (m.touches(*tool, some, tolerance_mm)) break;
    first += some.size();
  }
  while (first < moves.size() && !m.touches(*tool, moves.subspan(first, 1), tolerance_mm)) {
    if (watch.stop.stop_requested()) return std::nullopt;
    ++first;
  }
  if (first == moves.size()) return std::nullopt;
  double clear = 0, meets = 1;
  const auto touches_by = [&](double part) {
    const CutMove so_far = first_part(moves[first], part);
    return m.touches(*tool, std::span(&so_far, 1), tolerance_mm);
  };
  if (touches_by(0)) meets = 0;
  for (int step = 0; step < kContactSteps && meets > clear; ++step) {
    const double middle = 0.5 * (clear + meets);
    (touches_by(middle) ? meets : clear) = middle;
  }
  // What the rest would remove, on copies.
  const std::span<const CutMove> rest = moves.subspan(first);
  const auto looked = [&](double done) {
    watch.tell((static_cast<double>(first) + done * static_cast<double>(rest.size())) / count);
  };
  std::optional<BrickTree> drawn_in = m.loss_of(*tool, rest, tolerance_mm, {watch.stop, looked});
  std::optional<BrickTree> exact;
  if (drawn_in && rest.size() <= kExactDepthMoves) {
    exact = m.loss_of(*tool, rest, 0, {watch.stop, {}});
  }
  if (!drawn_in || watch.stop.stop_requested()) return std::nullopt;
  const std::int32_t slack = static_cast<std::int32_t>(
      std::lround(tolerance_mm / m.tree.lattice().cell_mm.z * kEdgeParts));
  const double cells_depth_mm =
      m.height_mm(greatest_loss(m.tree, *drawn_in, exact ? &*exact : nullptr, slack));
  BlankContact blank(m.tree.lattice(), m.kernel, m.bodies_of_blank);
  const double blank_depth_mm = blank.depth_mm(
      m.tree, m.sweeps_of(*tool, rest.first(std::min(kContactMoves, rest.size())), tolerance_mm));
  const double depth_mm = std::max({cells_depth_mm, blank_depth_mm, tolerance_mm});
  return WayContact{first, {first_part(moves[first], meets).to_mm, depth_mm}};
}

bool Octree::checks_parts() const { return !impl_->additive; }

double Octree::part_spare_mm(const CarriedPart& part, const CutMove& move, double enough_mm,
                             double most_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near || impl_->additive) return most_mm;
  return octree::part_spare_mm(impl_->parts_field(), part, *near, enough_mm, most_mm);
}

std::optional<PartContact> Octree::part_contact(const Cutter& cutter, const CarriedPart& part,
                                                const CutMove& move, double tolerance_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near || impl_->additive) return std::nullopt;
  const Result<std::vector<ToolBody>> bodies = tool_bodies(cutter);
  assert(bodies);
  return find_part_contact(impl_->parts_field(), flute_bodies(cutter, *bodies), part, *near,
                           tolerance_mm);
}

std::optional<PartGap> Octree::part_gap(const Cutter& cutter, const CarriedPart& part,
                                        const CutMove& move, double below_mm) const {
  const std::optional<CutMove> near = within_reach(move, bounds_mm());
  if (!near || impl_->additive) return std::nullopt;
  const Result<std::vector<ToolBody>> bodies = tool_bodies(cutter);
  assert(bodies);
  return find_part_gap(impl_->parts_field(), *bodies, part, *near, below_mm);
}

bool Octree::solid_at(const Vec3& point_mm, double within_mm) const {
  return octree::solid_at(impl_->tree, impl_->additive, point_mm, within_mm);
}

std::unique_ptr<StockModel> Octree::snapshot() const {
  auto copy = std::make_unique<Impl>(impl_->tree);
  copy->kernel = impl_->kernel;
  copy->additive = impl_->additive;
  copy->bodies_of_blank = impl_->bodies_of_blank;
  copy->blank_mm3 = impl_->blank_mm3;
  copy->removed = impl_->removed;
  copy->pool = std::make_shared<WorkerPool>(1);
  return std::unique_ptr<StockModel>(new Octree(std::move(copy)));
}

std::size_t Octree::unique_bytes() const { return impl_->tree.unique_bytes(); }
void Octree::keep_cut_ids(bool keep) { impl_->tree.keep_ids(keep); }
bool Octree::keeps_cut_ids() const { return impl_->tree.keeps_ids(); }

std::optional<std::uint32_t> Octree::cut_id_at(const Vec3& point_mm) const {
  if (!keeps_cut_ids()) return std::nullopt;
  const Lattice& lattice = impl_->tree.lattice();
  const Vec3 at = (point_mm - lattice.origin_mm) / lattice.cell_mm;
  std::array<int, 3> first{};
  for (int a = 0; a < 3; ++a) {
    if (!(at[a] > -1 && at[a] < lattice.cells[static_cast<std::size_t>(a)] + 2))
      return std::nullopt;
    first[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(at[a])) - 1;
  }
  // The nearest crossing of the cell and its neighbours.
  constexpr std::array<int, 3> kNodes{4, 4, 4};
  const HermiteGrid grid = gather(first, kNodes);
  double nearest = std::numeric_limits<double>::infinity();
  std::uint32_t id = MeshPatch::kNotCut;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<std::int32_t>& edges = grid.edges[static_cast<std::size_t>(axis)];
    for (std::size_t n = 0; n < edges.size(); ++n) {
      if (edges[n] < 0) continue;
      const HermiteCrossing& c = grid.crossings[static_cast<std::size_t>(edges[n])];
      Vec3 place(static_cast<double>(n % 4), static_cast<double>(n / 4 % 4),
                 static_cast<double>(n / 16));
      place[axis] += static_cast<double>(c.t);
      const double distance = glm::length(grid.origin_mm + place * grid.cell_mm - point_mm);
      if (distance >= nearest) continue;
      nearest = distance;
      id = c.cut_by;
    }
  }
  return id == MeshPatch::kNotCut ? std::nullopt : std::optional(id);
}

Box Octree::bounds_mm() const { return impl_->tree.lattice().bounds_mm; }
double Octree::cell_mm() const { return impl_->cell(); }
std::size_t Octree::cell_count() const {
  const std::array<int, 3>& n = impl_->tree.lattice().cells;
  return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
         static_cast<std::size_t>(n[2]);
}
double Octree::blank_mm3() const { return impl_->blank_mm3; }
double Octree::remaining_mm3() const {
  const double changed = impl_->mm3(impl_->removed);
  return impl_->additive ? changed : impl_->blank_mm3 - changed;
}
std::string Octree::digest() const { return impl_->tree.digest(); }

TriangleMesh Octree::mesh(double tolerance_mm) const {
  std::vector<std::array<int, 3>> tiles;
  for (std::uint32_t n = 0; n < tile_count(); ++n)
    if (impl_->tree.tile(n).get()) tiles.push_back(impl_->tree.lattice().tile_at(n));
  return mesh_dual_field(impl_->field(), {kTileNodes, tiles}, tolerance_mm, impl_->pool->threads());
}

std::size_t Octree::tile_count() const { return impl_->tree.tile_count(); }

Box Octree::tile_box(std::uint32_t tile) const {
  const Lattice& lattice = impl_->tree.lattice();
  const std::array<int, 3> at = lattice.tile_at(tile);
  Box box;
  for (int a = 0; a < 3; ++a) {
    const int first = at[static_cast<std::size_t>(a)] * kTileNodes;
    box.min[a] = std::max(lattice.bounds_mm.min[a], lattice.place_mm(a, first));
    box.max[a] = std::min(lattice.bounds_mm.max[a], lattice.place_mm(a, first + kTileNodes));
    box.max[a] = std::max(box.min[a], box.max[a]);
  }
  return box;
}

std::vector<std::uint32_t> Octree::take_dirty_tiles() {
  std::vector<std::uint32_t> dirty;
  if (impl_->seen) {
    dirty = impl_->tree.differing(*impl_->seen);
  } else {
    for (std::uint32_t n = 0; n < tile_count(); ++n) dirty.push_back(n);
  }
  impl_->seen = impl_->tree;
  return dirty;
}

std::vector<std::uint32_t> Octree::differing_tiles(const StockModel& other) const {
  const Octree* const octree = dynamic_cast<const Octree*>(&other);
  if (octree && octree->impl_->additive == impl_->additive)
    return impl_->tree.differing(octree->impl_->tree);
  std::vector<std::uint32_t> all;
  for (std::uint32_t n = 0; n < tile_count(); ++n) all.push_back(n);
  return all;
}

std::uint64_t Octree::patch_version(std::uint32_t tile) const {
  const Lattice& lattice = impl_->tree.lattice();
  const std::array<int, 3> at = lattice.tile_at(tile);
  std::uint64_t versions[27] = {};
  for (int n = 0; n < 27; ++n) {
    const std::array<int, 3> other{at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
    bool within = true;
    for (std::size_t a = 0; a < 3; ++a) within &= other[a] >= 0 && other[a] < lattice.tiles[a];
    if (!within) continue;
    versions[n] = impl_->tree.version(static_cast<std::uint32_t>(
        (other[2] * lattice.tiles[1] + other[1]) * lattice.tiles[0] + other[0]));
  }
  return XXH3_64bits(versions, sizeof versions);
}

MeshPatch Octree::patch(std::uint32_t tile, int level) const {
  thread_local DualContour contour;  // its buffers serve every patch that a thread makes
  MeshPatch patch;
  if (impl_->tree.tile(tile).get()) {
    const CellBox box = DualTiles{kTileNodes, {}}.box(impl_->tree.lattice().tile_at(tile));
    patch = make_dual_patch(impl_->field(), box, level, keeps_cut_ids(), &contour);
  }
  patch.tile = tile;
  patch.level = level;
  patch.version = patch_version(tile);
  return patch;
}

HermiteGrid Octree::gather(const std::array<int, 3>& first_node,
                           const std::array<int, 3>& nodes) const {
  HermiteGrid grid;
  gather(first_node, nodes, &grid);
  return grid;
}

void Octree::gather(const std::array<int, 3>& first_node, const std::array<int, 3>& nodes,
                    HermiteGrid* grid) const {
  octree::gather(impl_->tree, impl_->additive, first_node, nodes, grid);
}

std::array<int, 3> Octree::node_counts() const {
  const std::array<int, 3>& n = impl_->tree.lattice().cells;
  return {n[0] + 2, n[1] + 2, n[2] + 2};
}

std::size_t Octree::brick_count() const { return impl_->tree.brick_count(); }

ColumnLayout Octree::column_layout() const {
  ColumnLayout layout = column_layout_of(impl_->tree.lattice());
  if (impl_->additive) layout.tiles = {0, 0, 0};
  return layout;
}

std::uint64_t Octree::column_version(std::uint32_t tile) const {
  // Runs at its borders end by what the tiles above and below are like.
  constexpr std::uint64_t kSpread = 0x9e3779b97f4a7c15;
  const Lattice& lattice = impl_->tree.lattice();
  const auto layer = static_cast<std::uint32_t>(lattice.column_count());
  std::uint64_t version = impl_->tree.version(tile);
  if (tile >= layer) version = version * kSpread + impl_->tree.version(tile - layer);
  if (tile + layer < tile_count()) version = version * kSpread + impl_->tree.version(tile + layer);
  return version;
}

void Octree::read_columns(std::uint32_t tile, ColumnRuns& out) const {
  octree::read_columns(impl_->tree, tile, out);
}

}  // namespace kerf
