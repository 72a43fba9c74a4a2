#include "twin/cli/outputs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/mesh_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/sheet/sheet.h"
#include "stock/turning/turned_drawing.h"
#include "stock/turning/turning_stock.h"
#include "twin/program/session_parts.h"
#include "twin/scene/deviation_picture.h"
#include "twin/scene/fixture_bodies.h"
#include "twin/scene/frame_tool.h"
#include "twin/scene/held_bodies.h"
#include "twin/scene/map_picture.h"
#include "twin/scene/part_patches.h"
#include "twin/scene/turned_look.h"
#include "viewer/deviation_colors.h"
#include "viewer/picture.h"
#include "viewer/raycast/height_picture.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;
using NamedPath = std::pair<const char*, const std::string*>;

constexpr std::array<std::pair<const char*, std::string OutputPaths::*>, 15> kPaths{
    {{"--json", &OutputPaths::json},
     {"--png", &OutputPaths::png},
     {"--stl", &OutputPaths::stl},
     {"--ply", &OutputPaths::ply},
     {"--state", &OutputPaths::state},
     {"--dxf", &OutputPaths::dxf},
     {"--svg", &OutputPaths::svg},
     {"--compare-png", &OutputPaths::compare_png},
     {"--junit", &OutputPaths::junit},
     {"--sarif", &OutputPaths::sarif},
     {"--csv", &OutputPaths::csv},
     {"--html", &OutputPaths::html},
     {"--pdf", &OutputPaths::pdf},
     {"--rest-png", &OutputPaths::rest_png},
     {"--engagement-png", &OutputPaths::engagement_png}}};

void fault(Diagnostics& diagnostics, std::string message) {
  Diagnostic d;
  d.message = std::move(message);
  diagnostics.push_back(std::move(d));
}

void note_failure(const Done& done, Diagnostics& diagnostics) {
  if (!done) fault(diagnostics, done.error());
}

/// What has come off a workpiece that turns, each piece beside `path` (part_path()).
template <class Write>
void write_pieces(const StockModel& stock, const std::string& path, Diagnostics& diagnostics,
                  Write&& write) {
  const TurningStock* const turned = stock.turned();
  if (!turned || path.empty() || written_as_it_comes(path)) return;
  std::uint32_t number = 0;
  for (const TurnedPiece& piece : turned->part().freed()) {
    ++number;
    if (piece.part && piece.volume_mm3 >= kLeastPiece_mm3)
      note_failure(write(*piece.part, part_path(path, number)), diagnostics);
  }
}

/// Of more cells OpenGL makes a smaller model first, and needs less memory.
constexpr double kMostRayCells = 8e6;

double cells_of(const HeightGrid& heights) {
  return static_cast<double>(heights.nx()) * static_cast<double>(heights.ny());
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// Of heights by rays, which need less time and memory than OpenGL takes to begin; else by OpenGL,
/// and by rays after all where there is none, which is said.
Done write_picture(const OutputPaths& paths, const StockModel& stock, const CollisionWishes& around,
                   const std::string& name, Diagnostics& diagnostics) {
  const std::string& path = paths.png;
  PictureOptions options;
  options.blank_mm = stock.bounds_mm();
  options.caption = fmt::format("{}  {}", file_name(name), stock.name());
  const bool has_cells = stock.sheet() == nullptr && stock.turned() == nullptr;
  if (has_cells) options.caption += fmt::format(" {:.3g} mm", stock.cell_mm());
  if (const TurningStock* const turned = stock.turned()) {
    options.standing = Standing::kInLathe;
    options.blank_outline = turned_outline(*turned);
  }
  options.section = paths.section;
  options.bodies = picture_bodies(around.held_by);
  if (around.fixtures) {
    for (PictureBody& body : picture_bodies(*around.fixtures))
      options.bodies.push_back(std::move(body));
  }
  const std::shared_ptr<const HeightGrid> heights = stock.height_grid();
  const bool is_plain = options.section == SectionKind::kNone && options.bodies.empty();
  const bool by_rays = heights && is_plain && cells_of(*heights) <= kMostRayCells;
  Result<Picture> picture = by_rays ? draw_heights(heights, options, ray_threads())
                                    : draw_part(part_patches(stock), options);
  if (picture) return write_png(path, *picture);
  const std::string reason = picture.error();
  if (by_rays) return Error{trf("drawing {}: {}", path, reason)};
  if (!heights) {
    return Error{
        trf("drawing {}: {} (without OpenGL only workpieces without undercuts)", path, reason)};
  }
  if (options.section != SectionKind::kNone)
    return Error{trf("drawing {}: {} (--section is drawn by OpenGL alone)", path, reason)};
  picture = draw_heights(heights, options, ray_threads());
  if (!picture) return Error{trf("drawing {}: {}", path, picture.error())};
  Diagnostic note;
  note.severity = Severity::kNote;
  note.message = trf("{}: drawn by rays on the CPU, not by OpenGL: {}", path, reason);
  if (!options.bodies.empty()) note.hint = tr("fixtures are drawn by OpenGL alone");
  diagnostics.push_back(std::move(note));
  return write_png(path, *picture);
}

/// Of each corner of the mesh.
VertexMarks vertex_deviations(const TriangleMesh& mesh, const DesignPart& design,
                              const Comparison& comparison) {
  VertexMarks marks;
  marks.name = "deviation_mm";
  marks.values.reserve(mesh.positions_mm.size());
  marks.rgb.reserve(mesh.positions_mm.size());
  DesignProbe probe(design);
  for (const glm::vec3& p : mesh.positions_mm) {
    const double mm = probe.distance_mm(Vec3(p), std::numeric_limits<double>::infinity());
    marks.values.push_back(static_cast<float>(mm));
    marks.rgb.push_back(deviation_rgb(mm, comparison.tolerance_mm));
  }
  return marks;
}

}  // namespace

std::array<std::pair<const char*, const std::string*>, 15> OutputPaths::named() const {
  std::array<NamedPath, 15> all;
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = {kPaths[i].first, &(this->*kPaths[i].second)};
  return all;
}

unsigned OutputPaths::bit_of(const std::string& path) const {
  const auto all = named();
  for (unsigned i = 0; i < all.size(); ++i) {
    if (all[i].second == &path) return 1u << i;
  }
  return 0;
}

OutputPaths understand_outputs(const OptionReader& reader) {
  OutputPaths paths;
  for (const auto& [option, path] : kPaths) paths.*path = reader.text(option);
  return paths;
}

void check_picture_name(const char* option, const std::string& path, Diagnostics& diagnostics) {
  constexpr std::array kOthers{".jpg",  ".jpeg", ".gif", ".bmp", ".tif",
                               ".tiff", ".webp", ".svg", ".pdf"};
  const std::string ending = to_lower(std::filesystem::path(path).extension().string());
  if (std::find(kOthers.begin(), kOthers.end(), ending) == kOthers.end()) return;
  Diagnostic d;
  d.message =
      trf("{} {}: pictures are written as PNG; a name that ends with {} says "
          "something else",
          option, path, ending);
  d.hint =
      fmt::format("{} {}", option, std::filesystem::path(path).replace_extension(".png").string());
  diagnostics.push_back(std::move(d));
}

void check_output_arguments(const OutputPaths& paths, Diagnostics& diagnostics) {
  check_picture_name("--png", paths.png, diagnostics);
  check_picture_name("--compare-png", paths.compare_png, diagnostics);
  check_picture_name("--rest-png", paths.rest_png, diagnostics);
  check_picture_name("--engagement-png", paths.engagement_png, diagnostics);
  const auto all = paths.named();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string& path = *all[i].second;
      if (path.empty() || path != *all[j].second) continue;
      fault(diagnostics, trf("{} and {} both write to {}", all[j].first, all[i].first,
                             path == "-" ? tr("standard output") : path));
    }
  }
}

void check_output_places(const OutputPaths& paths, Diagnostics& diagnostics) {
  for (const auto& [option, path] : paths.named()) {
    // Only files are replaced within their folder.
    if (path->empty() || written_as_it_comes(*path)) continue;
    std::error_code ignored;
    if (std::filesystem::is_directory(*path, ignored)) {
      fault(diagnostics, trf("{}: {} is a folder, not a file", option, *path));
      continue;
    }
    const std::string parent = std::filesystem::path(*path).parent_path().string();
    const std::string folder = parent.empty() ? "." : parent;
    if (access(folder.c_str(), W_OK | X_OK) != 0) {
      fault(diagnostics,
            trf("{}: cannot write {}: folder {}: {}", option, *path, folder, std::strerror(errno)));
    }
  }
}

void write_outputs(const OutputPaths& paths, double mesh_tolerance_mm, const StockModel* stock,
                   const CollisionWishes& around, Report& report, Diagnostics& diagnostics,
                   std::atomic<unsigned>* dealt_with, const Compared& compared) {
  const std::shared_ptr<const DesignPart> design = compared.of_workpiece();
  const auto done_with = [&](const std::string& path) {
    if (dealt_with) *dealt_with |= paths.bit_of(path);
  };
  const Clock::time_point start = Clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const std::string& name =
      report.program_path.empty() && report.live ? report.live->source : report.program_path;
  const bool wants_mesh = !paths.stl.empty() || !paths.ply.empty();
  if (stock && !paths.png.empty()) {
    note_failure(write_picture(paths, *stock, around, name, diagnostics), diagnostics);
    done_with(paths.png);
  }
  if (stock && compared.design && !paths.compare_png.empty()) {
    const Result<Picture> picture =
        deviation_picture(compared.piece ? *compared.piece : *stock, compared.design,
                          *report.comparison, file_name(name));
    note_failure(picture ? write_png(paths.compare_png, *picture)
                         : Done{Error{trf("drawing {}: {}", paths.compare_png, picture.error())}},
                 diagnostics);
    done_with(paths.compare_png);
  }
  if (report.rest && !paths.rest_png.empty()) {
    note_failure(write_png(paths.rest_png, rest_picture(*report.rest, file_name(name))),
                 diagnostics);
    done_with(paths.rest_png);
  }
  if (report.engagement && report.engagement->map && !paths.engagement_png.empty()) {
    const Picture picture = engagement_picture(*report.engagement, file_name(name));
    note_failure(write_png(paths.engagement_png, picture), diagnostics);
    done_with(paths.engagement_png);
  }
  if (stock && wants_mesh) {
    const Clock::time_point mesh_start = Clock::now();
    const TriangleMesh mesh = stock->mesh(mesh_tolerance_mm);
    report.timing.mesh_s = std::chrono::duration<double>(Clock::now() - mesh_start).count();
    if (!paths.stl.empty()) note_failure(write_stl(paths.stl, mesh), diagnostics);
    if (!paths.ply.empty()) {
      note_failure(
          design ? write_ply(paths.ply, mesh, vertex_deviations(mesh, *design, *report.comparison))
                 : write_ply(paths.ply, mesh),
          diagnostics);
    }
    write_pieces(*stock, paths.stl, diagnostics, [&](const TurnedPart& piece, const auto& path) {
      return write_stl(path, piece.mesh(mesh_tolerance_mm));
    });
    write_pieces(*stock, paths.ply, diagnostics, [&](const TurnedPart& piece, const auto& path) {
      return write_ply(path, piece.mesh(mesh_tolerance_mm));
    });
    done_with(paths.stl);
    done_with(paths.ply);
  }
  const Sheet* const sheet = stock && report.sheet ? stock->sheet() : nullptr;
  if (stock && !paths.state.empty()) {
    note_failure(sheet ? save_sheet(*sheet, *report.sheet, report.program.files, paths.state)
                       : stock->save(paths.state),
                 diagnostics);
    done_with(paths.state);
  }
  const bool wants_outline = !paths.dxf.empty() || !paths.svg.empty();
  if (const TurningStock* const turned = stock ? stock->turned() : nullptr) {
    if (!paths.dxf.empty()) note_failure(write_turned_dxf(turned->part(), paths.dxf), diagnostics);
    write_pieces(*stock, paths.dxf, diagnostics, write_turned_dxf);
    done_with(paths.dxf);
    if (!paths.svg.empty()) note_failure(write_turned_svg(turned->part(), paths.svg), diagnostics);
    write_pieces(*stock, paths.svg, diagnostics, write_turned_svg);
    done_with(paths.svg);
  } else if (stock && !stock->sheet() && wants_outline) {
    fault(diagnostics, fmt::format("{}: {}", paths.dxf.empty() ? "--svg" : "--dxf",
                                   tr("only a sheet or a turned part has outlines to write")));
  }
  if (sheet) {
    std::vector<std::string> errors;
    write_outlines(*sheet, *report.sheet, paths.dxf, paths.svg, errors);
    for (std::string& error : errors) fault(diagnostics, std::move(error));
    done_with(paths.dxf);
    done_with(paths.svg);
  }
  if (!stock && (wants_mesh || !paths.png.empty() || !paths.state.empty() ||
                 !paths.rest_png.empty() || !paths.engagement_png.empty())) {
    fault(diagnostics,
          tr("stopped before there was a workpiece; no picture, mesh or state is written"));
  }
  report.timing.total_s += elapsed_s();
  report.peak_rss_mb = peak_rss_mb();
  if (!paths.json.empty()) note_failure(write_text(paths.json, json_text(report)), diagnostics);
}

void write_finding_lists(const OutputPaths& paths, std::span<const ListedProgram> programs,
                         Diagnostics& diagnostics) {
  if (!paths.junit.empty()) {
    note_failure(write_text(paths.junit, junit_text(programs, KERF_VERSION)), diagnostics);
  }
  if (paths.sarif.empty()) return;
  std::error_code unknown;
  const std::string folder = std::filesystem::current_path(unknown).string();
  note_failure(write_text(paths.sarif, sarif_text(programs, KERF_VERSION, folder)), diagnostics);
}

std::string names_left(const OutputPaths& paths, unsigned dealt_with) {
  std::string names;
  const auto all = paths.named();
  for (unsigned i = 0; i < all.size(); ++i) {
    const std::string& path = *all[i].second;
    if (path.empty() || &path == &paths.json || (dealt_with >> i & 1u) != 0) continue;
    names.append(names.empty() ? "" : ", ").append(path);
  }
  return names;
}

}  // namespace kerf
