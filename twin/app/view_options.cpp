#include "twin/app/view_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "twin/app/draw_option.h"
#include "twin/app/live_options.h"
#include "twin/app/option_reader.h"
#include "twin/app/outputs.h"
#include "viewer/window/settings.h"

namespace kerf {
namespace {

constexpr OptionRange kSpeed{0.1, 1000, false, "program seconds a second"};
constexpr OptionRange kFps{0.1, 1000, false, "frames a second"};
constexpr OptionRange kLine{1, 4e9, false, "lines"};
constexpr OptionRange kTolerance{kMinTolerance_mm, kMaxTolerance_mm, false, "mm"};
constexpr OptionRange kKeyframes{1, 1e6, false, "MB"};
constexpr int kMostPixels = 16384;

struct NamedView {
  const char* name;
  StandardView view;
};
constexpr std::array<NamedView, 7> kViews{{{"iso", StandardView::kIsometric},
                                           {"top", StandardView::kTop},
                                           {"bottom", StandardView::kBottom},
                                           {"front", StandardView::kFront},
                                           {"back", StandardView::kBack},
                                           {"left", StandardView::kLeft},
                                           {"right", StandardView::kRight}}};

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

void read_pictures(const ViewArguments& a, OptionReader& reader, ViewRequest& request) {
  request.png = a.png;
  check_picture_name("--png", a.png, reader.diagnostics());
  request.film.folder = a.frames;
  request.film.fps = reader.number("--fps", a.fps, kFps, request.film.fps);
  if (!a.fps.empty() && a.frames.empty()) reader.fault("--fps", "there is no --frames DIR");
  if (!a.png.empty() && !a.frames.empty()) {
    reader.fault("--png", "there is --frames already: one of the two");
  }
  if (!a.size.empty()) {
    if (const auto size = size_from(a.size)) {
      request.frame.size_px = *size;
    } else {
      reader.fault("--size",
                   fmt::format("'{}' is not allowed; must be WIDTHxHEIGHT, each from 1 to "
                               "{} (pixels), as 1280x720",
                               a.size, kMostPixels));
    }
  }
  if (request.wants_window() && !(a.size.empty() && a.view.empty())) {
    reader.fault(a.size.empty() ? "--view" : "--size", "is for --png and --frames");
  }
  if (!request.wants_window() && a.no_local) {
    reader.fault("--full-redraw", "is for the window; files get the whole picture every time");
  }
  if (!a.png.empty() && !a.speed.empty()) {
    reader.fault("--speed", "is for the window and for --frames; a picture stands still");
  }
  request.frame.draw.is_local = false;
  if (a.view.empty()) return;
  std::string names;
  for (const NamedView& view : kViews) {
    if (a.view == view.name) {
      request.frame.view = view.view;
      return;
    }
    names += fmt::format("{}{}", names.empty() ? "" : " | ", view.name);
  }
  reader.fault("--view", fmt::format("'{}' is not allowed; must be {}", a.view, names));
}

void read_comparison(const ViewArguments& a, OptionReader& reader, ViewRequest& request) {
  request.compare = a.compare;
  request.tolerance_mm =
      reader.length_mm("--tolerance", a.tolerance, kTolerance, request.tolerance_mm);
  if (a.compare.empty() && !a.tolerance.empty()) {
    reader.fault("--tolerance", "there is no --compare DESIGN.stl");
  }
  if (a.compare.empty()) return;
  request.frame.draw.color_by = ColorBy::kDeviation;
  request.frame.draw.tolerance_mm = request.tolerance_mm;
}

void read_road(const ViewArguments& a, OptionReader& reader, ViewRequest& request) {
  const std::optional<DrawRoad> road = understand_draw(a.draw, reader);
  if (!road) return;
  request.frame.road = *road;
  if (request.wants_window()) request.window_road = *road;
  if (*road != DrawRoad::kMesh && !a.compare.empty()) {
    reader.fault("--draw",
                 fmt::format("{} shows no deviations; --compare is for mesh alone", a.draw));
  }
}

}  // namespace

ViewRequest understand_view(const ViewArguments& a, Diagnostics& diagnostics) {
  ViewRequest request;
  const std::optional<LiveConfig> config = read_config(a.config, a.sets, diagnostics);
  RunArguments run = a.run;
  const LengthUnit units =
      understand_units(a.run.source.units, config ? config->units : std::nullopt, diagnostics);
  // What the configuration says of it is said now; a fault of the option comes once.
  run.source.units = units == LengthUnit::kInch ? "inch" : "mm";
  if (config) complete_arguments(*config, units, run);
  request.run = understand(run, diagnostics);
  request.written = a;
  if (config) {
    complete_session(*config, run, request.run.session);
    if (config->machine.drawn.is_chosen()) request.run.machine = config->machine.drawn;
  }
  OptionReader reader(diagnostics, units);
  if (a.speed == "max") {
    request.speed = std::numeric_limits<double>::infinity();
  } else if (!a.speed.empty()) {
    request.speed = reader.number("--speed", a.speed, kSpeed, 1);
  }
  request.at_line =
      static_cast<std::uint32_t>(reader.whole_number("--at-line", a.at_line, kLine, 0));
  const double keyframes_mb =
      reader.number("--keyframes", a.keyframes, kKeyframes,
                    config ? config->view.keyframes_mb : ConfigView{}.keyframes_mb);
  request.player.keyframe_bytes = static_cast<std::size_t>(keyframes_mb * 1048576.0);
  request.local = !a.no_local;
  read_pictures(a, reader, request);
  if (a.run.source.program.empty() && !request.wants_window()) {
    Diagnostic d;
    d.message = "PROGRAM is required: --png and --frames draw one";
    d.hint = "kerf view --help lists what there is";
    diagnostics.push_back(std::move(d));
  }
  read_comparison(a, reader, request);
  read_road(a, reader, request);
  const std::optional<Blank>& blank = request.run.session.blank;
  // The window says so itself, and draws by mesh.
  if (request.frame.road != DrawRoad::kMesh && !request.wants_window() && blank &&
      is_sheet(*blank)) {
    reader.fault("--draw", "a sheet is drawn by mesh alone");
  }
  request.film.speed = request.speed.value_or(1);
  if (!request.film.folder.empty() && !std::isfinite(request.film.speed)) {
    reader.fault("--speed", "max has no frames a second; --frames wants a number");
  }
  return request;
}

}  // namespace kerf
