#include "twin/job/stock_choice.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/triple.h"
#include "stock/cutter/shape_spec.h"
#include "stock/millturn/mill_turn.h"
#include "stock/octree/octree.h"
#include "stock/plane/outline_file.h"
#include "stock/sheet/sheet.h"
#include "stock/state_bytes.h"
#include "stock/turning/turned_blank.h"
#include "stock/turning/turning_stock.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "twin/job/blank_choice.h"

namespace kerf {
namespace {

constexpr double kMostOctreeCells = 1e6;

}  // namespace

double octree_cell_mm(const Box& box) {
  const Vec3 size = box.size();
  const double area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  double cell = 0.01;
  for (const double step : {0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (area / (cell * cell) <= kMostOctreeCells) break;
    cell = step;
  }
  return std::min({cell, size.x, size.y, size.z});
}

namespace {

/// Bodies that begin as much above the floor of the blank stand on it all the same.
constexpr double kFloor_mm = 1e-9;
using Created = Result<std::unique_ptr<StockModel>>;

double cell_of(const Blank& blank, const StockSettings& settings) {
  return settings.cell_mm > 0 ? settings.cell_mm : default_cell_mm(blank.bounds_mm());
}

template <class Model>
Created as_model(Result<std::unique_ptr<Model>> made) {
  if (!made) return Error{made.error()};
  return std::unique_ptr<StockModel>(std::move(made.value()));
}

Created create_zmap(const Blank& blank, const StockSettings& settings) {
  ZMapOptions options;
  options.blank = blank;
  options.cell_mm = cell_of(blank, settings);
  options.threads = settings.threads;
  options.kernel = settings.kernel;
  options.keeps_cut_ids = settings.keeps_cut_ids;
  return as_model(ZMap::create(options));
}

Created create_mmap(const Blank& blank, const StockSettings& settings) {
  ZMapOptions options;
  options.blank = blank;
  options.cell_mm = cell_of(blank, settings);
  options.threads = settings.threads;
  options.kernel = settings.kernel;
  options.keeps_cut_ids = settings.keeps_cut_ids;
  return as_model(MMap::create(options));
}

/// What this process may have: the machine's memory, or less (ulimit -v, a container's limit).
std::size_t memory_allowed_bytes() {
  double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  for (const char* const file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    double most = 0;
    if (std::ifstream(file) >> most && most > 0) bytes = std::min(bytes, most);
  }
  return static_cast<std::size_t>(bytes);
}

Created create_octree(const Blank& blank, const StockSettings& settings) {
  OctreeOptions options;
  options.blank = blank;
  options.cell_mm = settings.cell_mm > 0 ? settings.cell_mm : octree_cell_mm(blank.bounds_mm());
  options.threads = settings.threads;
  options.additive = settings.additive;
  options.kernel = octree_kernel(settings.kernel);
  // The rest is for what is made of it: meshes, pictures, copies for a view.
  options.memory_limit_bytes = memory_allowed_bytes() / 3;
  return as_model(Octree::create(options));
}

Created create_sheet(const Blank& blank, const StockSettings&) {
  const BlankSheet& sheet = *blank.sheet;
  SheetOptions options;
  options.bottom_mm = -sheet.thickness_mm;
  options.top_mm = 0;
  if (sheet.file.empty()) {
    options.outline = rectangle_outline(sheet.low_mm, sheet.high_mm);
  } else {
    Result<PlaneOutline> outline =
        read_outline_file(sheet.file, outline_format_of(sheet.file), options.arc_tolerance_mm);
    if (!outline) return Error{outline.error()};
    options.outline = std::move(outline.value());
  }
  return as_model(Sheet::create(options));
}

Created create_turning(const Blank& blank, const StockSettings& settings) {
  return with_milling(turning_stock_of(blank), settings);
}

Done sheet_can_cut(const Cutter& cutter) {
  if (2 * cutter.radius_mm() >= Sheet::kMinKerf_mm) return std::monostate{};
  return Error{trf("a kerf of {:g} mm is too narrow; must be at least {:g} mm",
                   2 * cutter.radius_mm(), Sheet::kMinKerf_mm)};
}

MillTurnOptions milling_options(const StockSettings& settings) {
  MillTurnOptions options;
  options.threads = settings.threads;
  options.kernel = octree_kernel(settings.kernel);
  options.memory_limit_bytes = memory_allowed_bytes() / 3;
  return options;
}

constexpr std::array kModels{
    StockModelRow{
        StockKind::kZmap, "zmap",
        tr_noop("one height a cell: three-axis milling without undercuts; exact sweeps of "
                "straight moves and of arcs in XY"),
        create_zmap, ZMap::can_cut, false},
    StockModelRow{
        StockKind::kMmap, "mmap",
        tr_noop("heights, and gaps below them: three-axis milling with T-slot cutters, lollipops, "
                "dovetails; where nothing is undercut it is the zmap"),
        create_mmap, MMap::can_cut, false},
    StockModelRow{
        StockKind::kOctree, "octree",
        tr_noop("a surface in space: tilted tools, parts that turn, material that is added "
                "(--additive); takes more time and memory"),
        create_octree, Octree::can_cut, true},
    StockModelRow{
        StockKind::kSheet, "sheet",
        tr_noop("polygons: sheet metal under a torch, laser or jet (--stock sheet:..); kerfs, "
                "piercing, parts that come free"),
        create_sheet, sheet_can_cut, false},
    StockModelRow{
        StockKind::kTurning, "turning",
        tr_noop("an exact profile that turns about Z: lathes, with tools that stand still; bores, "
                "grooves, undercuts, part-off; an octree where driven tools mill it"),
        create_turning, MillTurn::can_cut, false},
};

/// Of a tool that has a shape; empty: the Z-map will do.
std::string undercut_of(int tool, const Cutter& cutter) {
  if (ZMap::can_cut(cutter) || !MMap::can_cut(cutter)) return {};
  return trf("tool {} ({}) cuts undercuts", tool, cutter.spec());
}

}  // namespace

std::span<const StockModelRow> stock_models() { return kModels; }

octree::KernelChoice octree_kernel(ZMapKernel kernel) {
  switch (kernel) {
    case ZMapKernel::kScalar:
    case ZMapKernel::kSse2:
    case ZMapKernel::kNeon:
      return octree::KernelChoice::kScalar;
    case ZMapKernel::kAvx2:
      if (octree::has_avx2()) return octree::KernelChoice::kAvx2;
      break;
    default:
      break;
  }
  return octree::KernelChoice::kAuto;
}

const StockModelRow& stock_model(StockKind kind) {
  return *std::find_if(kModels.begin(), kModels.end(),
                       [kind](const StockModelRow& row) { return row.kind == kind; });
}

Result<std::unique_ptr<StockModel>> with_milling(Result<std::unique_ptr<TurningStock>> turned,
                                                 const StockSettings& settings) {
  if (!turned) return Error{turned.error()};
  MillTurnOptions options = milling_options(settings);
  options.cell_mm = octree_cell_mm(turned.value()->bounds_mm());
  return as_model(MillTurn::create(std::move(*turned.value()), options));
}

Result<std::unique_ptr<StockModel>> load_turned(const std::string& path,
                                                const StockSettings& settings) {
  if (is_milled_part(path)) return as_model(MillTurn::load(path, milling_options(settings)));
  return with_milling(TurningStock::load(path), settings);
}

const StockModelRow& row_of(const StockModel& stock) { return *find_stock_model(stock.name()); }

const StockModelRow* find_stock_model(std::string_view name) {
  const auto row = std::find_if(kModels.begin(), kModels.end(),
                                [name](const StockModelRow& r) { return r.name == name; });
  return row == kModels.end() ? nullptr : &*row;
}

Done can_be_cut(std::optional<StockKind> kind, const Cutter& cutter) {
  return stock_model(kind.value_or(StockKind::kOctree)).can_cut(cutter);
}

std::string stock_model_names() {
  std::string names;
  for (const StockModelRow& row : kModels) names.append(row.name).append(", ");
  return names + "auto";
}

void TiltWatch::look_at(std::span<const Motion> motions, const WorkpieceFrame& frame) {
  if (!machine_ || !found_.empty()) return;
  // Any tolerance will do: nothing is divided. A frame that the machine cannot have was refused
  // when the machine was set up.
  if (!moves_.follow(machine_, frame, 1.0)) return;
  constexpr std::array<double, 3> kStraight{};
  const bool one_type = !machine_->is_switchable();
  const bool straight_is_upright = one_type && moves_.path()->stays_upright(Motion{});
  for (const Motion& m : motions) {
    const bool straight = is_equal(m.from_abc_deg, kStraight) && is_equal(m.to_abc_deg, kStraight);
    if (straight && straight_is_upright) continue;
    if (moves_.path()->stays_upright(m)) continue;
    std::string turned;
    for (std::size_t i = 0; i < 3; ++i) {
      if (m.to_abc_deg[i] == 0 && m.from_abc_deg[i] == m.to_abc_deg[i]) continue;
      turned.append(turned.empty() ? "" : " ")
          .append(fmt::format("{}{:g}", "ABC"[i], m.to_abc_deg[i]));
    }
    found_ = trf("line {} turns the tool or the workpiece: {}", m.source.line, turned);
    return;
  }
}

StockNeeds stock_needs(const ToolSources& tools) {
  StockNeeds needs;
  needs.turning = tools.turning_sign;
  for (const ToolShapeArgument& tool : tools.arguments) {
    if (needs.undercut.empty()) needs.undercut = undercut_of(tool.tool, tool.cutter);
  }
  const auto look_at = [&needs](const Cutter& cutter) {
    const double size_mm = half_width_mm(cutter, kShallowCut_mm);
    // Wider ones are no finer than the default's cells, but for very large blanks.
    if (size_mm > kShallowCut_mm * (1 + 1e-9)) return;
    if (needs.finest_mm == 0 || size_mm < needs.finest_mm) needs.finest_mm = size_mm;
  };
  for (const ToolShapeArgument& tool : tools.arguments) look_at(tool.cutter);
  for (const LibraryTool& tool : tools.library) {
    // What else is in a library is not for this program.
    if (!tool.cutter || tools.named_of_library.count(*tool.number) == 0) continue;
    look_at(*tool.cutter);
    if (needs.undercut.empty()) needs.undercut = undercut_of(*tool.number, *tool.cutter);
  }
  for (const ToolHint& hint : tools.hints)
    if (const Result<Cutter> cutter = parse_shape(hint.shape)) look_at(*cutter);
  for (const ToolGuess& guess : tools.guesses)
    if (const Result<Cutter> cutter = parse_shape(guess.shape)) look_at(*cutter);
  const auto add_hint = [&needs](const ToolHint& hint) {
    if (!needs.undercut.empty()) return;
    if (const Result<Cutter> cutter = parse_shape(hint.shape)) {
      needs.undercut = undercut_of(hint.tool, *cutter);
    }
  };
  for (const ToolHint& hint : tools.hints) add_hint(hint);
  for (const ToolTableRow& row : tools.table) {
    if (!(row.diameter_mm > 0)) continue;
    if (const auto hint = shape_from_remark(row.tool, row.diameter_mm, row.remark)) add_hint(*hint);
  }
  return needs;
}

namespace {

std::string head_of_file(const std::string& path) {
  constexpr std::size_t kHeadBytes = 128;
  std::ifstream file(path, std::ios::binary);
  return read_up_to(file, kHeadBytes);
}

}  // namespace

StockKind saved_kind(const std::string& path) {
  const auto model = model_of_state(head_of_file(path), path);
  const StockModelRow* const row = model ? find_stock_model(model.value()) : nullptr;
  return row ? row->kind : StockKind::kZmap;
}

bool is_milled_part(const std::string& path) {
  const auto is_octree = [](StateHead& lines) { return lines.line("beside").has_value(); };
  return static_cast<bool>(head_of_state(head_of_file(path), path, "octree", is_octree));
}

bool is_sheet(const Blank& blank) {
  return blank.sheet ||
         (!blank.state_file.empty() && saved_kind(blank.state_file) == StockKind::kSheet);
}

bool may_be_turned(const Blank& blank) {
  if (!blank.state_file.empty()) {
    return saved_kind(blank.state_file) == StockKind::kTurning || is_milled_part(blank.state_file);
  }
  return !blank.sheet &&
         std::none_of(blank.bodies.begin(), blank.bodies.end(), [](const BlankBody& body) {
           return body.kind == BlankBody::Kind::kBox || body.axis != 'z';
         });
}

std::string misfit(const StockSettings& settings, const Blank& blank) {
  const bool sheet_wanted = settings.kind == StockKind::kSheet;
  if (blank.sheet && settings.additive) {
    return tr("--additive: nothing is added to a sheet; a box can be added to");
  }
  if (blank.mesh && settings.additive) {
    return tr("--additive: nothing is added to a mesh; a box can be added to");
  }
  if (blank.sheet && settings.cell_mm > 0) return tr("--cell: a sheet has no cells; leave it out");
  if (settings.kind == StockKind::kTurning && settings.cell_mm > 0) {
    return tr("--cell: a workpiece that is turned has no cells; leave it out");
  }
  if (!settings.kind || sheet_wanted == is_sheet(blank)) return {};
  if (sheet_wanted) {
    return trf(
        "--model {}: the blank is not a sheet ({}); --stock sheet:x0,y0:x1,y1:THICKNESS is one",
        stock_model(*settings.kind).name, describe(blank));
  }
  return trf("--model {}: the blank is a sheet ({}); allowed for it: sheet, auto",
             stock_model(*settings.kind).name, describe(blank));
}

std::string need_of_blank(const Blank& blank) {
  const double floor_mm = blank.bounds_mm().min.z;
  for (const BlankBody& body : blank.bodies) {
    if (body.kind != BlankBody::Kind::kBox && body.axis != 'z') {
      return trf("the blank has a cylinder along {}", body.axis);
    }
    if (body.bounds_mm.min.z > floor_mm + kFloor_mm) {
      return trf("the blank has a body that begins at Z{:g}, above its floor Z{:g}",
                 body.bounds_mm.min.z, floor_mm);
    }
  }
  return {};
}

StockChoice choose_stock(const StockSettings& settings, const StockNeeds& needs) {
  const double finest = needs.finest_mm;
  if (settings.kind) return {*settings.kind, {}, finest};
  if (!needs.turning.empty()) return {StockKind::kTurning, needs.turning, 0};
  if (settings.additive) return {StockKind::kOctree, tr("material is added"), finest};
  if (!settings.later_need.empty()) return {StockKind::kOctree, settings.later_need, finest};
  if (!needs.tilt.empty()) return {StockKind::kOctree, needs.tilt, finest};
  if (!needs.blank.empty()) return {StockKind::kOctree, needs.blank, finest};
  if (!needs.undercut.empty()) return {StockKind::kMmap, needs.undercut, finest};
  return {StockKind::kZmap, {}, finest};
}

}  // namespace kerf
