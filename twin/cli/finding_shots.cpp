#include "twin/cli/finding_shots.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <system_error>
#include <utility>

#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/playback/load_program.h"
#include "twin/report/shown_lengths.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/live_view.h"
#include "twin/scene/player_scene.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

constexpr std::chrono::milliseconds kSeekPatience{50};
/// It goes forward alone.
constexpr std::size_t kKeyframe_bytes = std::size_t{1} << 20;

void tell_trouble(Diagnostics& diagnostics, std::string message) {
  Diagnostic d;
  d.message = std::move(message);
  diagnostics.push_back(std::move(d));
}

FindingShot shot_of(const Finding& finding, const std::vector<std::string>& files) {
  FindingShot shot;
  shot.finding = finding;
  if (const std::uint32_t line = finding.source.line; line > 0) {
    const std::filesystem::path file = diagnostic_of(finding, files).file;
    shot.place = fmt::format("{}:{}", file.filename().string(), line);
  }
  std::string message = message_of(finding);
  if (!finding.hint.empty()) message += "; " + finding.hint;
  shot.message = in_unit(message, shown_unit());
  return shot;
}

/// From the tip to the head, as collisions of the machine are looked for: the offset, or the shape.
double checked_length_mm(double offset_mm, const Cutter* cutter) {
  if (offset_mm != 0 || !cutter) return offset_mm;
  return drawn_height_mm(*tool_shape_of(*cutter));
}

/// Makes the renderer when there is something to be drawn.
class Album {
 public:
  Album(const std::string& folder, CollisionWishes wishes,
        std::shared_ptr<const MachineModel> machine, Diagnostics& diagnostics)
      : folder_(folder),
        wishes_(std::move(wishes)),
        machine_(std::move(machine)),
        diagnostics_(diagnostics) {}

  /// `number`: its place in the list, from 1 on. False: no more can be drawn either.
  bool add(const FindingShot& shot, std::size_t number) {
    if (!pictures_) {
      Result<FindingPictures> made = FindingPictures::create(wishes_, machine_);
      if (!made) return refuse(made.error());
      pictures_ = std::make_unique<FindingPictures>(std::move(*made));
    }
    const Result<Picture> picture = pictures_->draw(shot);
    if (!picture) return refuse(picture.error());
    const std::filesystem::path path =
        std::filesystem::path(folder_) / finding_picture_name(number, shot.finding);
    const Done done = write_png(path.string(), *picture);
    return done || refuse(done.error());
  }

 private:
  bool refuse(const std::string& why) {
    tell_trouble(diagnostics_, fmt::format("--finding-png: {}", why));
    return false;
  }

  const std::string& folder_;
  CollisionWishes wishes_;
  std::shared_ptr<const MachineModel> machine_;
  Diagnostics& diagnostics_;
  std::unique_ptr<FindingPictures> pictures_;
};

/// Goes to the findings of a program that is played once more.
class SecondPass {
 public:
  SecondPass(std::unique_ptr<LoadedProgram> loaded, std::shared_ptr<const MachineModel> machine,
             std::stop_token stop)
      : shown_(viewed_program(*loaded, {})),
        resolver_(loaded->player.tools, nullptr),
        player_(std::move(loaded->player), options()),
        stop_(std::move(stop)) {
    shown_.machine = std::move(machine);
  }

  /// False: stopped.
  bool take(FindingShot& shot) {
    const Player::Ticket ticket = player_.seek_time(*shot.finding.time_s);
    while (!player_.wait(ticket, kSeekPatience))
      if (stop_.stop_requested()) return false;
    const std::shared_ptr<const PlayerState> state = player_.state();
    shot.stock = state->stock;
    shot.tool = tool_pose_at(shown_.moves, player_.track(), *state);
    shot.nose_z_mm = state->motion.tool_offset_mm.z;
    shot.cutter = state->cutter;
    // Of a tool that has cut nothing yet the player has no shape.
    if (!shot.cutter) {
      const ResolvedTool& tool = resolver_.mount(state->motion.tool, state->motion.source.line);
      if (tool.cutter) shot.cutter = std::make_shared<const Cutter>(*tool.cutter);
    }
    if (shown_.machine) {
      shot.link_poses = machine_poses_at(shown_, player_.track(), *state,
                                         checked_length_mm(shot.nose_z_mm, shot.cutter.get()));
    }
    return true;
  }

 private:
  static PlayerOptions options() {
    PlayerOptions options;
    options.check_ahead = false;
    options.keyframe_bytes = kKeyframe_bytes;
    return options;
  }

  ViewedProgram shown_;
  ToolResolver resolver_;
  Player player_;
  std::stop_token stop_;
};

}  // namespace

void make_finding_folder(const std::string& folder, Diagnostics& diagnostics) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return tell_trouble(diagnostics, fmt::format("--finding-png: {}: {}", folder, error.message()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    tell_trouble(diagnostics, fmt::format("--finding-png: {}: {}", folder, std::strerror(errno)));
}

void write_finding_pictures(const std::string& folder, const SessionOptions& options,
                            const MachineChoice& machine, const std::string& ini,
                            const Report& report, const std::stop_token& stop,
                            const std::function<void(double)>& on_picture,
                            Diagnostics& diagnostics) {
  std::vector<FindingShot> shots;
  for (const Finding& finding : report.findings.kept()) {
    if (!finding.position_mm || !finding.time_s) continue;
    shots.push_back(shot_of(finding, report.program.files));
    if (shots.size() == kMostFindingPictures) break;
  }
  if (shots.empty()) return;
  LoadControl control;
  control.stop = stop;
  Diagnostics said;  // by the run
  Outcome outcome = Outcome::kFailed;
  std::unique_ptr<LoadedProgram> loaded = load_program(options, control, said, outcome);
  if (!loaded) {
    return tell_trouble(diagnostics, tr("--finding-png: the program cannot be read a second time"));
  }
  const std::shared_ptr<const MachineModel> around =
      machine_around(*loaded, machine, ini, diagnostics);
  const CollisionWishes wishes = loaded->player.checks.collisions;  // about the blank there is
  SecondPass pass(std::move(loaded), around, stop);
  Album album(folder, wishes, around, diagnostics);
  std::vector<std::size_t> order(shots.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {},
                           [&shots](std::size_t i) { return shots[i].finding.time_s.value_or(0); });
  std::size_t drawn = 0;
  for (const std::size_t i : order) {
    if (!pass.take(shots[i]) || !album.add(shots[i], i + 1)) return;
    shots[i].stock = nullptr;
    on_picture(static_cast<double>(++drawn) / static_cast<double>(shots.size()));
  }
}

FindingShots::FindingShots(const LiveSession& session, std::shared_ptr<const MachineModel> machine,
                           LiveObserver& next)
    : session_(session),
      next_(next),
      resolver_(session.tool_sources(), nullptr),
      machine_(std::move(machine)) {}

void FindingShots::on_status(const LiveStatus& status) {
  place_ = status.place;
  work_ = status.work;
  next_.on_status(status);
}

void FindingShots::on_finding(const Finding& finding, const std::vector<std::string>& files) {
  next_.on_finding(finding, files);
  if (!finding.position_mm || shots_.size() == kMostFindingPictures) return;
  FindingShot shot = shot_of(finding, files);
  shot.stock = session_.stock()->snapshot();
  shot.tool = {*finding.position_mm, place_.spindle};
  shot.nose_z_mm = place_.tool_length_mm;
  if (finding.tool) {
    const ResolvedTool& tool = resolver_.mount(*finding.tool, 0);
    if (tool.cutter) shot.cutter = std::make_shared<const Cutter>(*tool.cutter);
  }
  if (machine_ && place_.known && lies_as_built(*machine_, work_)) {
    ToolState there = place_;  // the way to it is that of a sample at most
    there.tip_mm = there.tool_pose.origin_mm = *finding.position_mm;
    shot.link_poses = machine_poses_at(*machine_, there, work_,
                                       checked_length_mm(shot.nose_z_mm, shot.cutter.get()));
  }
  shots_.push_back(std::move(shot));
}

void FindingShots::write(const std::string& folder, const CollisionWishes& wishes,
                         Diagnostics& diagnostics) {
  Album album(folder, wishes, machine_, diagnostics);
  for (std::size_t i = 0; i < shots_.size(); ++i)
    if (!album.add(shots_[i], i + 1)) return;
}

}  // namespace kerf
