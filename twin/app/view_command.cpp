#include "twin/app/view_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "machine_io/logs/log_source.h"
#include "twin/app/exit_code.h"
#include "twin/app/live_command.h"
#include "twin/app/option_reader.h"
#include "twin/app/progress_bar.h"
#include "twin/app/stop_signals.h"
#include "twin/app/window_host.h"
#include "twin/compare/design_part.h"
#include "twin/playback/load_program.h"
#include "twin/suggest.h"
#include "twin/view/drawn_machine.h"
#include "twin/view/frame_writer.h"
#include "twin/view/player_view.h"
#include "twin/view/tool_shape.h"
#include "viewer/window/settings.h"

namespace kerf {
namespace {

constexpr OptionRange kSpeed{0.1, 1000, false, "program seconds a second"};
constexpr OptionRange kFps{0.1, 1000, false, "frames a second"};
constexpr OptionRange kLine{1, 4e9, false, "lines"};
constexpr OptionRange kTolerance{kMinTolerance_mm, kMaxTolerance_mm, false, "mm"};
constexpr OptionRange kKeyframes{1, 1e6, false, "MB"};
constexpr int kMostPixels = 16384;
constexpr std::chrono::milliseconds kPatience{200};

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

struct NamedRoad {
  const char* name;
  DrawRoad road;
};
constexpr std::array<NamedRoad, 3> kRoads{
    {{"mesh", DrawRoad::kMesh}, {"raycast", DrawRoad::kRaycast}, {"csg", DrawRoad::kCsg}}};

/// The arguments, understood.
struct ViewRequest {
  RunRequest run;
  std::optional<double> speed;  ///< play at once; infinity: as fast as it can be cut
  std::uint32_t at_line = 0;
  PlayerOptions player;
  std::string png;
  FilmOptions film;
  FrameOptions frame;
  MachineChoice machine;
  std::string ini;
  std::string compare;  ///< file of the design part
  std::shared_ptr<const DesignPart> design;
  double tolerance_mm = 0.05;
  bool local = true;
  bool at_end = false;
  bool wants_window() const { return png.empty() && film.folder.empty(); }
};

void print(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& d : diagnostics) {
    if (!quiet || d.severity == Severity::kError) fmt::print(stderr, "{}", to_string(d));
  }
}

Diagnostic fault(std::string message, std::string hint = {}) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

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
      reader.number("--tolerance", a.tolerance, kTolerance, request.tolerance_mm);
  if (a.compare.empty() && !a.tolerance.empty()) {
    reader.fault("--tolerance", "there is no --compare DESIGN.stl");
  }
  if (a.compare.empty()) return;
  request.frame.draw.color_by = ColorBy::kDeviation;
  request.frame.draw.tolerance_mm = request.tolerance_mm;
}

void read_road(const ViewArguments& a, OptionReader& reader, ViewRequest& request) {
  if (a.draw.empty()) return;
  const auto named = std::find_if(kRoads.begin(), kRoads.end(),
                                  [&](const NamedRoad& road) { return a.draw == road.name; });
  if (named == kRoads.end()) {
    reader.fault("--draw",
                 fmt::format("'{}' is not allowed; must be mesh | raycast | csg", a.draw));
    return;
  }
  request.frame.road = named->road;
  if (named->road == DrawRoad::kMesh) return;
  if (request.wants_window()) {
    reader.fault("--draw", fmt::format("{} is for --png and --frames; the window draws by mesh",
                                       named->name));
  }
  if (!a.compare.empty()) {
    reader.fault("--draw",
                 fmt::format("{} shows no deviations; --compare is for mesh alone", named->name));
  }
}

/// The command line goes before the configuration.
void complete(const LiveConfig& config, const ViewArguments& a, SessionOptions& session) {
  if (session.tools.empty()) session.tools = config.tools;
  if (!session.blank) session.blank = config.stock.blank;
  if (a.run.work.cell.empty() && config.stock.cell_mm) {
    session.stock.cell_mm = *config.stock.cell_mm;
  }
  if (a.run.work.margin.empty()) session.margin_mm = config.stock.margin_mm;
}

ViewRequest understand_view(const ViewArguments& a, Diagnostics& diagnostics) {
  ViewRequest request;
  const std::optional<LiveConfig> config = read_config(a.config, a.sets, diagnostics);
  RunArguments run = a.run;
  if (config) {
    if (run.source.ini.empty()) run.source.ini = config->machine.ini.value_or("");
    if (run.source.tool_table.empty()) {
      run.source.tool_table = config->machine.tool_table.value_or("");
    }
    request.machine = config->machine.drawn;
  }
  request.ini = run.source.ini;
  request.run = understand(run, diagnostics);
  if (config) complete(*config, a, request.run.session);
  OptionReader reader(diagnostics);
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
  read_comparison(a, reader, request);
  read_road(a, reader, request);
  request.film.speed = request.speed.value_or(1);
  if (!std::isfinite(request.film.speed)) {
    reader.fault("--speed", "max has no frames a second; --frames wants a number");
  }
  return request;
}

enum class Kind { kProgram, kState, kLog };

/// What the file is, by its first bytes; by its name where they do not tell.
Kind kind_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(64, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  const std::string_view begin = head;
  if (begin.starts_with("kerf-state/")) return Kind::kState;
  if (begin.find("kerf-recording/") != std::string_view::npos) return Kind::kLog;
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".csv" || extension == ".log" || extension == ".sam" ? Kind::kLog
                                                                           : Kind::kProgram;
}

std::string title_of(const std::string& path) {
  return fmt::format("kerf - {}", std::filesystem::path(path).filename().string());
}

/// Program, blank, tools; null on error.
std::unique_ptr<LoadedProgram> load(const ViewRequest& request, Kind kind,
                                    const LoadControl& control, Diagnostics& diagnostics,
                                    Outcome& outcome) {
  if (kind == Kind::kProgram) {
    auto loaded = load_program(request.run.session, control, diagnostics, outcome);
    // Who cut where is what colours and the difference between cut and uncut are made of.
    if (loaded && loaded->player.blank) loaded->player.blank->keep_cut_ids(true);
    return loaded;
  }
  const std::string& path = request.run.session.program.path;
  Result<Blank> blank = parse_blank("state:" + path);
  if (!blank) {
    diagnostics.push_back(fault(blank.error()));
    outcome = Outcome::kFailed;
    return nullptr;
  }
  StockSetup setup = make_stock(*blank, request.run.session.stock, path, diagnostics, outcome);
  if (!setup.stock) return nullptr;
  auto loaded = std::make_unique<LoadedProgram>();
  loaded->player.track = ProgramTrackBuilder().build({}, {});
  loaded->player.blank = std::move(setup.stock);
  loaded->blank = setup.facts;
  return loaded;
}

/// The block that the interpreter refused, if there is one, and why the program is not whole.
void print_faults(const LoadedProgram& loaded) {
  for (const Finding& remark : loaded.player.remarks) {
    if (remark.severity != Severity::kError) continue;
    fmt::print(stderr, "{}", to_string(diagnostic_of(remark, loaded.player.track->files())));
  }
  if (!loaded.partial_reason.empty()) fmt::print(stderr, "kerf: {}\n", loaded.partial_reason);
}

int exit_code(Outcome outcome, const Diagnostics& diagnostics) {
  if (outcome == Outcome::kUsageError) return kExitUsage;
  return has_error(diagnostics) || outcome == Outcome::kFailed ? kExitFailure : kExitGood;
}

/// Where the comparison will not say what its user expects.
Diagnostics comparison_doubts(const ViewRequest& request, const StockModel& stock) {
  Diagnostics doubts;
  const auto doubt = [&](std::string message, std::string hint) {
    Diagnostic d = fault(std::move(message), std::move(hint));
    d.severity = Severity::kWarning;
    d.file = request.compare;
    doubts.push_back(std::move(d));
  };
  const Box part = request.design->box_mm(), blank = stock.bounds_mm();
  bool apart = false;
  for (int axis = 0; axis < 3; ++axis) {
    apart = apart || part.min[axis] > blank.max[axis] || part.max[axis] < blank.min[axis];
  }
  if (apart) {
    doubt(fmt::format("lies beside the blank: X {:g} to {:g}, Y {:g} to {:g}, Z {:g} to {:g} mm; "
                      "the blank is X {:g} to {:g}, Y {:g} to {:g}, Z {:g} to {:g}",
                      part.min.x, part.max.x, part.min.y, part.max.y, part.min.z, part.max.z,
                      blank.min.x, blank.max.x, blank.min.y, blank.max.y, blank.min.z, blank.max.z),
          "the design part is taken as mm, in the coordinates that the program writes");
  }
  if (stock.cell_mm() > request.tolerance_mm) {
    doubt(fmt::format("cells of {:g} mm are coarser than the tolerance of {:g} mm: walls may seem "
                      "off by up to a cell",
                      stock.cell_mm(), request.tolerance_mm),
          fmt::format("--cell {:g} or --tolerance {:g}", request.tolerance_mm, stock.cell_mm()));
  }
  return doubts;
}

/// With the machine around it. What is wrong with that one is said; the program is shown without.
ViewedProgram viewed(const ViewRequest& request, const LoadedProgram& loaded) {
  ViewedProgram shown = viewed_program(loaded, title_of(request.run.session.program.path));
  if (request.design && loaded.player.blank) {
    shown.design = request.design;
    shown.tolerance_mm = request.tolerance_mm;
    print(comparison_doubts(request, *loaded.player.blank), request.run.quiet);
  }
  const bool wanted = !request.ini.empty() || request.machine.kind || request.machine.links;
  if (!wanted || !loaded.player.blank) return shown;
  double longest_mm = 0;
  for (const ProgramTool& tool : loaded.tools) {
    const auto cutter = parse_tool_argument("0=" + tool.shape);
    if (cutter) {
      longest_mm = std::max(longest_mm, drawn_height_mm(*tool_shape_of(cutter->cutter)));
    }
  }
  Diagnostics diagnostics;
  shown.machine = drawn_machine(
      request.machine, request.ini,
      work_room(*loaded.player.track, loaded.player.blank->bounds_mm(), longest_mm), diagnostics);
  print(diagnostics, request.run.quiet);
  return shown;
}

/// Reads, then plays, in the thread beside the window.
class Work {
 public:
  Work(const ViewRequest& request, Kind kind, SceneMailbox& mailbox, CommandQueue& commands,
       std::stop_source& stop)
      : request_(request), kind_(kind), mailbox_(mailbox), commands_(commands), stop_(stop) {}

  int operator()() {
    announce({});
    LoadControl control;
    control.stop = stop_.get_token();
    control.on_progress = [this](const LoadProgress& progress) { announce(progress); };
    Diagnostics diagnostics;
    Outcome outcome = Outcome::kFailed;
    std::unique_ptr<LoadedProgram> loaded = load(request_, kind_, control, diagnostics, outcome);
    print(diagnostics, request_.run.quiet);
    if (!loaded || stop_.stop_requested()) return exit_code(outcome, diagnostics);
    print_faults(*loaded);
    ViewedProgram shown = viewed(request_, *loaded);
    PlayerOptions options = request_.player;
    PlayerView view(std::move(loaded->player), options, std::move(shown), mailbox_, commands_);
    for (ViewerCommand& command : waiting_) commands_.push(std::move(command));
    if (request_.at_line > 0) view.player().seek_line({0, request_.at_line});
    if (request_.at_end) view.player().seek_end();
    view.run(stop_.get_token(), request_.speed);
    return kExitGood;
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// What the window says while there is nothing to be seen yet; and whether it is closed already.
  void announce(const LoadProgress& progress) {
    const auto now = Clock::now();
    if (progress.motions > 0 && now - announced_ < std::chrono::milliseconds(100)) return;
    announced_ = now;
    for (ViewerCommand& command : commands_.take()) {
      if (std::holds_alternative<CloseCommand>(command)) stop_.request_stop();
      // Said once, when the window opens or is looked at in another way; the rest is about a
      // program that is not there yet.
      const bool lasts = std::holds_alternative<ColorCommand>(command) ||
                         std::holds_alternative<DetailCommand>(command) ||
                         std::holds_alternative<SpeedCommand>(command);
      if (lasts) waiting_.push_back(std::move(command));
    }
    auto moment = std::make_shared<Moment>();
    moment->notice = progress.fraction >= 0 ? fmt::format("{:.0f} %", 100 * progress.fraction)
                                            : fmt::format("{} motions", progress.motions);
    moment->notice = "reading: " + moment->notice;
    SceneUpdate update;
    update.moment = std::move(moment);
    mailbox_.publish(std::move(update));
  }

  const ViewRequest& request_;
  Kind kind_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;
  std::stop_source& stop_;
  Clock::time_point announced_{};
  std::vector<ViewerCommand> waiting_;
};

int in_window(const ViewRequest& request, Kind kind, std::stop_source& stop) {
  SceneMailbox mailbox(Window::wake);
  CommandQueue commands;
  WindowOptions options;
  options.is_local = request.local;
  const Result<int> code = work_beside_window(options, mailbox, commands, stop,
                                              Work(request, kind, mailbox, commands, stop));
  if (code) return *code;
  print({fault(code.error())}, false);
  return kExitFailure;
}

/// To the line asked for, or (for a picture) to the end.
bool go_to_place(Player& player, const ViewRequest& request, const std::stop_token& stop) {
  Player::Ticket ticket = 0;
  if (request.at_line > 0) {
    ticket = player.seek_line({0, request.at_line});
  } else if (!request.png.empty()) {
    ticket = player.seek_end();
  } else {
    return true;
  }
  while (!player.wait(ticket, kPatience)) {
    if (stop.stop_requested()) return false;
  }
  return true;
}

int into_files(const ViewRequest& request, Kind kind, const std::stop_source& stop) {
  Diagnostics diagnostics;
  Outcome outcome = Outcome::kFailed;
  LoadControl control;
  control.stop = stop.get_token();
  std::unique_ptr<LoadedProgram> loaded = load(request, kind, control, diagnostics, outcome);
  print(diagnostics, request.run.quiet);
  if (!loaded) return exit_code(outcome, diagnostics);
  print_faults(*loaded);
  const bool whole = loaded->partial_reason.empty();
  ViewedProgram shown = viewed(request, *loaded);
  const std::shared_ptr<const ProgramTrack> track = loaded->player.track;
  PlayerOptions options = request.player;
  options.check_ahead = false;
  Player player(std::move(loaded->player), options);
  Done done = std::monostate{};
  auto renderer = FrameRenderer::create(request.frame, *player.state(), track, std::move(shown));
  if (!renderer) {
    print({fault(renderer.error())}, false);
    return kExitFailure;
  }
  if (!go_to_place(player, request, stop.get_token())) return kExitFailure;
  if (const std::string& refused = player.state()->message; !refused.empty()) {
    print({fault(fmt::format("--at-line {}: {}", request.at_line, refused))}, false);
    return kExitUsage;
  }
  if (!request.png.empty()) {
    const Result<Picture> picture = renderer->draw(player.state());
    done = picture ? write_png(request.png, *picture) : Done(Error{picture.error()});
  } else {
    std::atomic<double> share{0};
    const ProgressBar bar([&] { return share.load(); }, !request.run.quiet);
    const auto frames = write_film(player, *renderer, request.film, stop.get_token(),
                                   [&](double done_share) { share = done_share; });
    if (!frames) done = Error{frames.error()};
    if (frames && !request.run.quiet) {
      fmt::print(
          "{} frames in {}; a film of them:\n  ffmpeg -framerate {:g} -i "
          "{}/frame_%06d.png -pix_fmt yuv420p film.mp4\n",
          *frames, request.film.folder, request.film.fps, request.film.folder);
    }
  }
  if (!done) print({fault(done.error())}, false);
  return done && whole && !stop.stop_requested() ? kExitGood : kExitFailure;
}

int view_log(const ViewArguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics);
  const auto refuse = [&](const char* option, bool given) {
    if (given) reader.fault(option, "is for programs, not for logs");
  };
  refuse("--at-line", !arguments.at_line.empty());
  refuse("--until-line", !arguments.run.until_line.empty());
  refuse("--keyframes", !arguments.keyframes.empty());
  refuse("--full-redraw", arguments.no_local);
  if (has_error(diagnostics)) {
    print(diagnostics, false);
    return kExitUsage;
  }
  LiveArguments live;
  live.config = arguments.config;
  live.sets = arguments.sets;
  live.log = arguments.run.source.program;
  live.source = arguments.run.source;
  live.source.program.clear();
  live.work = arguments.run.work;
  live.speed = arguments.speed;
  live.quiet = arguments.run.quiet;
  return live_command(live, LiveCommand::kReplay);
}

}  // namespace

int show_program(const RunRequest& run, std::stop_source& stop) {
  ViewRequest request;
  request.run = run;
  request.run.quiet = true;  // the dry run has said it
  request.at_end = true;
  return in_window(request, Kind::kProgram, stop);
}

int view_command(const ViewArguments& arguments) {
  Diagnostics diagnostics;
  ViewRequest request = understand_view(arguments, diagnostics);
  if (has_error(diagnostics)) {
    print(diagnostics, false);
    return kExitUsage;
  }
  const Kind kind = kind_of(request.run.session.program.path);
  if (kind == Kind::kLog) {
    if (!request.compare.empty()) {
      print({fault("--compare is for programs and saved workpieces",
                   "kerf replay LOG --state FILE saves what a log leaves")},
            false);
      return kExitUsage;
    }
    if (request.wants_window()) return view_log(arguments);
    print({fault("--png and --frames are for programs and saved workpieces",
                 "kerf replay LOG --png FILE draws what a log leaves")},
          false);
    return kExitUsage;
  }
  OutputPaths places;
  places.png = request.png;
  check_output_places(places, diagnostics);
  if (!request.compare.empty()) request.design = DesignPart::read(request.compare, diagnostics);
  print(diagnostics, request.run.quiet);
  if (has_error(diagnostics)) return kExitFailure;
  std::stop_source stop;
  const StopSignals signals(stop, [] { remove_uncommitted_files(); });
  return request.wants_window() ? in_window(request, kind, stop) : into_files(request, kind, stop);
}

}  // namespace kerf
