#include "twin/serve/player_broadcast.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "base/wait_for_stop.h"
#include "twin/live/live_text.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

/// Oftener than pages are told, so that what they get is new.
constexpr std::chrono::milliseconds kLookPeriod{40};

ShopBroadcastOptions options_of(const PlayedForPage& played, const PlayerState& state) {
  ShopBroadcastOptions options;
  options.title = played.title;
  options.source_name = tr("the program, played");
  options.turns = played.turns;
  options.stock = state.stock;
  if (state.stock) options.blank_mm = state.stock->bounds_mm();
  return options;
}

std::string source_file(const PlayedForPage& played, const Motion& motion) {
  return motion.source.file < played.files.size() ? played.files[motion.source.file]
                                                  : std::string();
}

void set_mode(const PlayerState& state, ShopMoment& moment) {
  const bool is_at_end = state.stop == PlayerStop::kProgramEnd;
  switch (state.mode) {
    case PlayerMode::kPlaying:
    case PlayerMode::kRunning:
      moment.state = "live";
      moment.state_text = tr("playing");
      return;
    case PlayerMode::kSeeking:
      moment.state_text = tr("jumping");
      return;
    case PlayerMode::kPaused:
      moment.state = is_at_end ? "ended" : "waiting";
      moment.state_text = is_at_end ? tr("at the end") : tr("paused");
  }
}

}  // namespace

PlayedForPage for_page(const ViewedProgram& shown) {
  return {shown.title, shown.files, shown.moves, shown.punch, shown.turns};
}

PlayerBroadcast::PlayerBroadcast(const Player& player, PlayedForPage played, LengthUnit unit,
                                 ServedScene& scene)
    : player_(player),
      played_(std::move(played)),
      unit_(unit),
      broadcast_(options_of(played_, *player.state()), scene,
                 [this, state = player.state()](const std::string& tool_name) {
                   return moment_of(*state, tool_name);
                 }) {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    std::shared_ptr<const PlayerState> seen;
    do {
      std::shared_ptr<const PlayerState> state = player_.state();
      look(seen.get(), state);
      seen = std::move(state);
    } while (!wait_for_stop(stop, kLookPeriod));
  });
}

PlayerBroadcast::~PlayerBroadcast() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void PlayerBroadcast::look(const PlayerState* seen,
                           const std::shared_ptr<const PlayerState>& state) {
  // Of a workpiece that nobody looks at the player need keep no second one.
  const bool has_new_stock = state->stock && broadcast_.is_watched() &&
                             !(has_told_stock_ && told_stock_ == state->stock_number);
  if (seen == state.get() && !has_new_stock) return;
  ShopNews news;
  if (has_new_stock) {
    news.stock = state->stock;
    told_stock_ = state->stock_number;
    has_told_stock_ = true;
  }
  if (seen != state.get()) {
    news.moment = [this, state](const std::string& tool_name) {
      return moment_of(*state, tool_name);
    };
  }
  if (state->findings && (seen == nullptr || seen->findings != state->findings)) {
    ShopNews::Findings findings;
    findings.total = state->findings->size();
    const std::size_t count = std::min(state->findings->size(), ServedScene::kMostFindings);
    for (std::size_t i = 0; i < count; ++i) {
      findings.first.push_back(finding_object((*state->findings)[i], played_.files, false, unit_));
    }
    news.all_findings = std::move(findings);
  }
  const std::string spec = state->cutter ? state->cutter->spec() : std::string();
  if (spec != noted_spec_) {
    noted_spec_ = spec;
    news.has_tool = true;
    news.cutter = state->cutter;
  }
  broadcast_.tell(std::move(news));
}

ShopMoment PlayerBroadcast::moment_of(const PlayerState& state,
                                      const std::string& tool_name) const {
  ShopMoment moment;
  set_mode(state, moment);
  moment.notice = in_unit(state.message, unit_);
  const ProgramTrack& track = player_.track();
  if (track.empty()) return moment;
  const Motion& motion = state.motion;
  const auto add = [&](const std::string& name, const std::string& value) {
    moment.rows.emplace_back(name, value);
  };
  moment.file = source_file(played_, motion);
  moment.line = static_cast<int>(motion.source.line);
  add(tr("Program"), line_text(moment.file, moment.line));
  add(tr("Time left"), time_left_text(state.remaining_s));
  add(tr("Time so far"), time_left_text(state.elapsed_s));
  const ToolPose pose = played_.punch ? ToolPose{played_.punch->tip_mm(track, state), Vec3(0, 0, 1)}
                                      : tool_pose_at(played_.moves, track, state);
  if (motion.start_known) {
    moment.tip_mm = pose.tip_mm;
    moment.axis = pose.axis;
    add(tr("Position"), place_text(state.tip_mm, unit_));
  }
  add(tr("Tool"), fmt::format("T{} {}", motion.tool, tool_name));
  if (motion.spindle != SpindleState::kStopped)
    add(tr("Spindle"), fmt::format("{:.0f} rpm", std::abs(motion.spindle_rpm)));
  if (state.mode == PlayerMode::kPlaying && std::isfinite(state.speed))
    add(tr("Speed"), fmt::format("{:.3g}x", state.speed));
  return moment;
}

}  // namespace kerf
