#include "twin/cli/view_options.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "base/translate.h"
#include "twin/cli/cutting_options.h"
#include "twin/cli/draw_option.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/outputs.h"
#include "twin/cli/serve_option.h"

namespace kerf {
namespace {

constexpr int kMostPixels = 16384;

/// "1280x720".
std::optional<glm::ivec2> size_from(const std::string& text) {
  glm::ivec2 size{0};
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.x);
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
  const auto height = std::from_chars(width.ptr + 1, end, size.y);
  if (height.ec != std::errc() || height.ptr != end) return std::nullopt;
  if (size.x < 1 || size.y < 1 || size.x > kMostPixels || size.y > kMostPixels) return std::nullopt;
  return size;
}

void read_size(OptionReader& reader, ViewRequest& request) {
  const std::string text = reader.text("--size");
  if (const auto size = size_from(text)) {
    request.frame.size_px = *size;
  } else {
    reader.fault("--size", trf("'{}' is not allowed; must be WIDTHxHEIGHT, each from 1 to "
                               "{} (pixels), as 1280x720",
                               text, kMostPixels));
  }
}

void read_pictures(OptionReader& reader, ViewRequest& request) {
  const auto is_said = [&](const char* option) { return reader.choose(option).is_said(); };
  request.png = reader.text("--png");
  check_picture_name("--png", request.png, reader.diagnostics());
  request.film.folder = reader.text("--frames");
  request.film.fps = reader.number("--fps");
  if (is_said("--fps") && !is_said("--frames")) {
    reader.fault("--fps", tr("there is no --frames DIR"));
  }
  if (is_said("--png") && is_said("--frames")) {
    reader.fault("--png", tr("there is --frames already: one of the two"));
  }
  read_size(reader, request);
  if (request.wants_window() && (is_said("--size") || is_said("--view"))) {
    reader.fault(is_said("--size") ? "--size" : "--view", tr("is for --png and --frames"));
  }
  if (!request.wants_window() && !request.local) {
    reader.fault("--full-redraw", tr("is for the window; files get the whole picture every time"));
  }
  if (is_said("--png") && is_said("--speed")) {
    reader.fault("--speed", tr("is for the window and for --frames; a picture stands still"));
  }
  request.frame.draw.is_local = false;
  request.frame.units = request.run.units;
  reader.word(
      "--view",
      {StandardView::kIsometric, StandardView::kTop, StandardView::kBottom, StandardView::kFront,
       StandardView::kBack, StandardView::kLeft, StandardView::kRight},
      request.frame.view);
}

void read_section(OptionReader& reader, ViewRequest& request) {
  request.frame.section = understand_section(reader);
  if (request.frame.section != SectionKind::kNone && request.frame.draw_mode != DrawMode::kMesh) {
    reader.fault("--section", trf("{} shows no section; --draw mesh does", reader.text("--draw")));
  }
}

void read_comparison(OptionReader& reader, ViewRequest& request) {
  request.compare = understand_compare(reader);
  if (!request.compare.is_wanted()) return;
  request.frame.draw.color_by = ColorBy::kDeviation;
  request.frame.draw.tolerance_mm = request.compare.tolerance_mm;
}

void read_mode(OptionReader& reader, ViewRequest& request) {
  const std::optional<DrawMode> draw_mode = understand_draw(reader);
  if (!draw_mode) return;
  request.frame.draw_mode = *draw_mode;
  if (request.wants_window()) request.window_mode = *draw_mode;
  if (*draw_mode != DrawMode::kMesh && request.compare.is_wanted()) {
    reader.fault("--draw",
                 trf("{} shows no deviations; --compare is for mesh alone", reader.text("--draw")));
  }
}

/// What a colour needs to be known.
void check_color(OptionReader& reader, const ViewRequest& request) {
  const auto load = load_of(*request.color_by);
  const std::string name = reader.text("--color");
  if (load && needs_material(*load) && !request.run.session.cutting.material)
    reader.fault("--color", trf("{} is worked out of the material, which nobody has said", name),
                 tr("--material NAME says it; docs/cutting-forces.md lists them"));
  else if (load && !request.run.engagement)
    reader.fault("--color", trf("{} is not measured", name),
                 tr("--engagement or --material NAME measures it"));
  if (request.compare.is_wanted())
    reader.fault("--color", tr("--compare has colours of its own: deviations"));
}

void read_colors(OptionReader& reader, ViewRequest& request) {
  constexpr std::array kColors{ColorBy::kPlain,       ColorBy::kHeight, ColorBy::kTool,
                               ColorBy::kRemovalRate, ColorBy::kFeed,   ColorBy::kFeedPerTooth,
                               ColorBy::kAngle,       ColorBy::kChip,   ColorBy::kForce,
                               ColorBy::kTorque,      ColorBy::kPower,  ColorBy::kBend};
  const int color = reader.word("--color");
  if (color >= 0) {
    request.color_by = kColors[static_cast<std::size_t>(color)];
    check_color(reader, request);
    request.frame.draw.color_by = *request.color_by;
    if (request.frame.draw_mode != DrawMode::kMesh && *request.color_by != ColorBy::kPlain)
      reader.fault("--color", trf("{} shows no colours; --draw mesh does", reader.text("--draw")));
  }
  const int target = reader.word("--color-on");
  if (target < 0) return;
  request.color_on = static_cast<ColorTarget>(target);
  request.frame.draw.color_on = *request.color_on;
  if (!request.wants_window() && !(request.color_by && is_by_move(*request.color_by)))
    reader.fault("--color-on", tr("is about colours that go by moves: --color tool, force .."));
}

std::optional<double> read_speed(OptionReader& reader) {
  const ChosenValue speed = reader.choose("--speed");
  if (!speed.is_said()) return std::nullopt;
  if (speed.text == "max") return std::numeric_limits<double>::infinity();
  return reader.number("--speed", 1);
}

}  // namespace

ViewRequest understand_view(const Arguments& arguments, Diagnostics& diagnostics) {
  ViewRequest request;
  const std::optional<LiveConfig> read = read_config(arguments.options, diagnostics);
  const LiveConfig* const config = read ? &*read : nullptr;
  OptionReader reader(diagnostics, layers_of(arguments, config));
  request.run = understand_cut(config, reader);
  request.run.session.cutting = understand_cutting(reader);
  request.run.engagement = reader.is_yes("--engagement") ||
                           request.run.session.cutting.is_wanted() ||
                           has_tool_limits(request.run.session);
  request.run.session.stock.keeps_cut_ids = true;
  request.written = arguments;
  request.speed = read_speed(reader);
  request.run.serve = understand_serve(reader);
  request.at_line = static_cast<std::uint32_t>(reader.whole_number("--at-line"));
  const double keyframes_mb = reader.number("--keyframes");
  request.player.keyframe_bytes = static_cast<std::size_t>(keyframes_mb * 1048576.0);
  request.local = !reader.is_yes("--full-redraw");
  read_pictures(reader, request);
  if (request.run.session.program.path.empty() && !request.wants_window()) {
    Diagnostic d;
    d.message = tr("PROGRAM is required: --png and --frames draw one");
    d.hint = tr("kerf view --help lists what there is");
    diagnostics.push_back(std::move(d));
  }
  if (request.run.serve && !request.wants_window())
    reader.fault("--serve", tr("is for the window; --png and --frames end when they are written"));
  read_comparison(reader, request);
  read_mode(reader, request);
  read_colors(reader, request);
  read_section(reader, request);
  const std::optional<Blank>& blank = request.run.session.blank;
  // The window says so itself, and draws by mesh.
  if (request.frame.draw_mode != DrawMode::kMesh && !request.wants_window() && blank &&
      is_sheet(*blank)) {
    reader.fault("--draw", tr("a sheet is drawn by mesh alone"));
  }
  request.film.speed = request.speed.value_or(1);
  if (!request.film.folder.empty() && !std::isfinite(request.film.speed)) {
    reader.fault("--speed", tr("max has no frames a second; --frames wants a number"));
  }
  return request;
}

}  // namespace kerf
