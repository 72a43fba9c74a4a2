// twin/cli/outputs.h - the files that a run leaves: report, picture, meshes, saved workpiece.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "base/diagnostic.h"
#include "base/result.h"
#include "stock/stock_model.h"
#include "twin/cli/compare_option.h"
#include "twin/cli/option_reader.h"
#include "twin/process/check_options.h"
#include "twin/report/finding_lists.h"
#include "twin/report/report.h"
#include "viewer/section.h"

namespace kerf {

/// Paths as the user wrote them; empty = not wanted, "-" = standard output.
struct OutputPaths {
  std::string json;
  std::string png;
  std::string stl;
  std::string ply;
  std::string state;
  /// What is left of a sheet, and parts beside it (write_outlines); the contour of a turned part.
  std::string dxf;
  std::string svg;
  std::string compare_png;     ///< coloured by deviations; of a comparison alone
  std::string junit;           ///< findings, as build servers read them: write_finding_lists()
  std::string sarif;           ///< and as code hosts and editors do
  std::string csv;             ///< motions, written as they are cut: MotionTable
  std::string html;            ///< the report as a page: write_pages()
  std::string pdf;             ///< and printed
  std::string rest_png;        ///< Report::rest from above
  std::string engagement_png;  ///< Report::engagement from above
  bool wants_page() const { return !html.empty() || !pdf.empty(); }
  SectionKind section = SectionKind::kNone;  ///< of `png`

  /// With the options that give them.
  std::array<std::pair<const char*, const std::string*>, 15> named() const;
  /// Of one of them (`path` is a member of this), its bit where what is done is noted.
  unsigned bit_of(const std::string& path) const;
  bool uses_stdout() const {
    for (const auto& [option, path] : named()) {
      if (*path == "-" || *path == "/dev/stdout") return true;
    }
    return false;
  }
};

/// What the options of named() say.
OutputPaths understand_outputs(const OptionReader& reader);

/// A picture's name that says another format than PNG.
void check_picture_name(const char* option, const std::string& path, Diagnostics& diagnostics);

/// Faults of the arguments themselves: two outputs to one place, a picture's name.
void check_output_arguments(const OutputPaths& paths, Diagnostics& diagnostics);

/// Faults of the file system that can be seen before a minute of cutting: folder missing or not
/// writable, path is a folder.
void check_output_places(const OutputPaths& paths, Diagnostics& diagnostics);

/// Writes what is wanted, each under a temporary name that is renamed when it is whole. One that
/// fails is a diagnostic and does not keep the others from being written. Fills in the report's
/// mesh time, adds it to the total, and brings the peak memory up to date before the JSON is
/// written, which comes last.
/// `stock`: null if there was none. `around`: its fixtures, chuck and tailstock are drawn in
/// pictures. `dealt_with`, if given, gets the bit_of() each of paths.named() that is there, or has
/// failed; another thread may look at it. `compared`: what report.comparison was made of.
void write_outputs(const OutputPaths& paths, double mesh_tolerance_mm, const StockModel* stock,
                   const CollisionWishes& around, Report& report, Diagnostics& diagnostics,
                   std::atomic<unsigned>* dealt_with = nullptr, const Compared& compared = {});

/// `junit` and `sarif` of these programs, where they are wanted, under the same rules.
void write_finding_lists(const OutputPaths& paths, std::span<const ListedProgram> programs,
                         Diagnostics& diagnostics);

/// The files of those that are not dealt with, but for the report: "part.png, part.stl".
std::string names_left(const OutputPaths& paths, unsigned dealt_with);

}  // namespace kerf
