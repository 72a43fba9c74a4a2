#include "twin/scene/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/translate.h"
#include "twin/live/live_text.h"
#include "twin/machine/kinematics/work_frame.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/moment_values.h"
#include "twin/scene/program_text.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatchSlice{8};
/// Commands of the user are looked at so often.
constexpr milliseconds kPatience{15};

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

SourceFreshness freshness_of(LiveState state) {
  switch (state) {
    case LiveState::kLive:
      return SourceFreshness::kLive;
    case LiveState::kWaiting:
    case LiveState::kStale:
      return SourceFreshness::kStale;
    case LiveState::kLost:
      return SourceFreshness::kLost;
    case LiveState::kEnded:
      return SourceFreshness::kNone;
  }
  return SourceFreshness::kNone;
}

}  // namespace

std::vector<glm::mat4> machine_poses_at(const MachineModel& machine, const ToolState& place,
                                        const WorkpieceFrame& work, double tool_length_mm) {
  if (!place.turns) return drawn_poses(machine, place.tip_mm, place.abc_deg, tool_length_mm);
  std::array<double, 3> machine_abc_deg = place.abc_deg;
  for (std::size_t i = 0; i < 3; ++i) machine_abc_deg[i] += work.offset_abc_deg[i];
  return drawn_poses(machine, place.tool_pose, machine_abc_deg, tool_length_mm);
}

bool lies_as_built(const MachineModel& machine, const WorkpieceFrame& work) {
  constexpr double kSame_mm = 0.005, kSameTurn = 1e-6;
  const Pose& built = machine.link_from_workpiece;
  const Pose now = link_from_workpiece_of(machine.chain, machine_from_workpiece(work));
  double turned = 0;
  for (int i = 0; i < 3; ++i)
    turned = std::max(turned, glm::length(built.rotation[i] - now.rotation[i]));
  return glm::length(built.origin_mm - now.origin_mm) < kSame_mm && turned < kSameTurn;
}

LiveView::LiveView(LiveViewOptions options, LiveObserver& next, SceneMailbox& mailbox,
                   CommandQueue& commands)
    : options_(std::move(options)),
      next_(next),
      mailbox_(mailbox),
      commands_(commands),
      resolver_(options_.tools, nullptr),
      bodies_(options_.collisions) {
  if (options_.machine)
    bodies_.set_machine(std::make_shared<const SceneMachine>(scene_machine(*options_.machine)));
  publish_start();
  news_.stock = options_.stock;
  thread_ = std::jthread([this](std::stop_token stop) { run(std::move(stop)); });
  if (options_.load_program) {
    loader_ = std::jthread([this](std::stop_token stop) {
      std::unique_ptr<LiveProgram> program = options_.load_program(std::move(stop));
      const std::lock_guard lock(mutex_);
      news_.program = std::move(program);
      arrived_.notify_one();
    });
  }
}

LiveView::~LiveView() {
  loader_.request_stop();
  if (loader_.joinable()) loader_.join();
  thread_.request_stop();
  arrived_.notify_one();
}

void LiveView::on_status(const LiveStatus& status) {
  next_.on_status(status);
  const std::lock_guard lock(mutex_);
  news_.status = status;
  news_.status_at = Clock::now();
  arrived_.notify_one();
}

void LiveView::on_finding(const Finding& finding, const std::vector<std::string>& files) {
  next_.on_finding(finding, files);
  SceneFinding shown = finding_list({finding}, files)->findings.front();
  const std::lock_guard lock(mutex_);
  news_.findings.push_back(std::move(shown));
  if (finding.has_bodies()) news_.collisions.push_back(finding);
  arrived_.notify_one();
}

void LiveView::on_warning(const AheadWarning& warning, const std::vector<std::string>& files) {
  next_.on_warning(warning, files);
  SceneFinding shown = finding_list({warning.finding}, files)->findings.front();
  shown.text = tr("ahead: ") + shown.text;
  if (!shown.inch_text.empty()) shown.inch_text = tr("ahead: ") + shown.inch_text;
  const std::lock_guard lock(mutex_);
  news_.findings.push_back(std::move(shown));
  arrived_.notify_one();
}

/// The shape by the cutter in use, or, as long as none was needed, by what is known of the tool.
void LiveView::note_tool(int tool, const Cutter* cutter, News& news) {
  if (!cutter && tool >= 0) {
    const ResolvedTool& resolved = resolver_.mount(tool, 0);
    if (resolved.cutter) cutter = &*resolved.cutter;
  }
  const std::string spec = cutter ? cutter->spec() : std::string();
  if (spec == shown_spec_) return;
  shown_spec_ = spec;
  news.has_tool = true;
  news.cutter = cutter ? std::make_shared<const Cutter>(*cutter) : nullptr;
}

/// Labels, with the names of their tools.
void LiveView::note_labels(std::span<const CutLabel> labels, News& news) {
  if (labels.size() <= noted_labels_) return;
  for (const CutLabel& label : labels.subspan(noted_labels_)) {
    news.labels.push_back(label);
    if (!noted_tools_.insert(label.tool).second) continue;
    const ResolvedTool& tool = resolver_.mount(label.tool, 0);
    news.tools.push_back({label.tool, tool.cutter ? tool_name_of(*tool.cutter) : std::string()});
  }
  noted_labels_ = labels.size();
}

/// Those that have cut: a look at each label, a millisecond for a million.
void LiveView::note_uses(std::span<const CutLabel> labels, News& news) {
  uses_at_ = Clock::now();
  noted_s_.resize(labels.size(), 0.0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (noted_s_[i] == labels[i].cut_s) continue;
    noted_s_[i] = labels[i].cut_s;
    news.uses.push_back({static_cast<std::uint32_t>(i), labels[i].removed_mm3, labels[i].cut_s});
  }
}

void LiveView::on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                        std::span<const Vec3> trail, std::span<const CutLabel> labels) {
  // So that tiles that were only passed over count as unchanged.
  stock.take_dirty_tiles();
  std::shared_ptr<const StockModel> snapshot = stock.snapshot();
  const std::lock_guard lock(mutex_);
  news_.stock = std::move(snapshot);
  news_.status = status;
  news_.status_at = Clock::now();
  news_.trail.insert(news_.trail.end(), trail.begin(), trail.end());
  note_tool(status.place.tool, cutter, news_);
  note_labels(labels, news_);
  if (Clock::now() - uses_at_ >= LiveColors::kRatePeriod) note_uses(labels, news_);
  arrived_.notify_one();
}

void LiveView::end(const StockModel* stock, std::span<const CutLabel> labels,
                   const std::stop_token& stop) {
  const std::stop_callback ends(stop, [this] { thread_.request_stop(); });
  {
    const std::lock_guard lock(mutex_);
    if (stock) news_.stock = stock->snapshot();
    note_labels(labels, news_);
    note_uses(labels, news_);
    arrived_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

void LiveView::tell(std::string notice) {
  const std::lock_guard lock(mutex_);
  news_.notice = std::move(notice);
  arrived_.notify_one();
}

void LiveView::publish_start() {
  SceneUpdate update;
  update.clears = true;
  auto setup = std::make_shared<SceneSetup>();
  setup->title = options_.title;
  setup->bounds_mm = options_.blank_mm;
  setup->blank_outline = options_.blank_outline;
  stand(*setup);
  setup->frames = scene_frames(shown_work_, options_.work_offset);
  update.setup = std::move(setup);
  update.machine = bodies_.drawn_machine();
  update.fixtures = bodies_.scene();
  update.job = options_.job;
  update.moment = moment_now();
  mailbox_.publish(std::move(update));
}

void LiveView::run(std::stop_token stop) {
  while (!stop.stop_requested() && !closed_) {
    News news;
    {
      std::unique_lock lock(mutex_);
      const bool busy =
          (draws_mesh() && feeder_.behind()) || (program_path_ && !program_path_->complete());
      if (!busy) arrived_.wait_for(lock, kPatience);
      news = std::exchange(news_, {});
    }
    for (const ViewerCommand& command : commands_.take()) {
      if (!obey(command)) closed_ = true;
    }
    take_news(news);
    if (auto colors = colors_.take(Clock::now())) update_.colors = std::move(colors);
    draw_modes_.update(stock_, {}, &update_);
    if (draws_mesh()) update_.patches = feeder_.make_until(Clock::now() + kPatchSlice);
    if (program_path_ && !program_path_->complete()) {
      auto chunks = program_path_->next_chunks();
      update_.path.insert(update_.path.end(), chunks.begin(), chunks.end());
    }
    const bool news_to_show = update_.setup || update_.moment || !update_.patches.empty() ||
                              !update_.path.empty() || update_.findings || update_.tool_shape ||
                              update_.colors || update_.picked || update_.program ||
                              update_.draw_mode || update_.heights;
    if (news_to_show) mailbox_.publish(std::exchange(update_, {}));
  }
}

bool LiveView::obey(const ViewerCommand& command) {
  bool goes_on = true;
  const auto set_speed = [&] {
    if (options_.on_speed) options_.on_speed(log_paused_ ? 0.0 : options_.speed);
    update_.moment = moment_now();
  };
  std::visit(
      [&](const auto& c) {
        using Command = std::decay_t<decltype(c)>;
        if constexpr (std::is_same_v<Command, DetailCommand>)
          feeder_.set_detail(c.detail, c.easy_triangles);
        if constexpr (std::is_same_v<Command, ColorCommand>) colors_.choose(c);
        if constexpr (std::is_same_v<Command, DrawModeCommand>) draw_modes_.choose(c.draw_mode);
        if constexpr (std::is_same_v<Command, PickCommand>) update_.picked = who_cut(c.point_mm);
        if constexpr (std::is_same_v<Command, CloseCommand>) {
          goes_on = false;
          if (options_.on_close) options_.on_close();
        }
        if constexpr (std::is_same_v<Command, EntryCommand>) {
          if (options_.on_entry) options_.on_entry(c.line, scene_now());
        }
        if constexpr (std::is_same_v<Command, OpenCommand>) {
          if (options_.on_open) options_.on_open(c.path);
        }
        if constexpr (std::is_same_v<Command, JobCommand>) {
          if (const std::string said = options_.on_job ? options_.on_job(c) : ""; !said.empty())
            tell(said);
        }
        // A machine leads; a log can be held and hurried.
        if (!options_.log) return;
        if constexpr (std::is_same_v<Command, PlayCommand>) {
          log_paused_ = false;
          set_speed();
        }
        if constexpr (std::is_same_v<Command, PauseCommand>) {
          log_paused_ = true;
          set_speed();
        }
        if constexpr (std::is_same_v<Command, SpeedCommand>) {
          options_.speed = c.factor > kMaxSpeed ? std::numeric_limits<double>::infinity()
                                                : std::max(c.factor, kMinSpeed);
          set_speed();
        }
      },
      command);
  return goes_on;
}

LiveScene LiveView::scene_now() const {
  LiveScene now{stock_, status_};
  if (now.status) {
    const std::chrono::duration<double> since = Clock::now() - status_at_;
    now.status->age_s += since.count();
  }
  return now;
}

/// In which way up it is seen.
void LiveView::stand(SceneSetup& setup) const {
  setup.turns = options_.stock && options_.stock->turned();
  if (setup.turns) setup.standing = options_.machine ? Standing::kOnLatheBed : Standing::kInLathe;
}

/// The time is that of the line's first motion in the program, if there is one.
std::shared_ptr<const PickedPoint> LiveView::who_cut(const Vec3& point_mm) const {
  auto picked = std::make_shared<PickedPoint>();
  picked->point_mm = point_mm;
  const std::optional<std::uint32_t> id = stock_ ? stock_->cut_id_at(point_mm) : std::nullopt;
  const CutLabel* const label = id ? colors_.label(*id) : nullptr;
  picked->is_known = stock_ && (stock_->keeps_cut_ids() || !stock_->turned());
  if (!label) return picked;
  picked->tool = label->tool;
  picked->tool_name = colors_.name_of(label->tool);
  picked->file = static_cast<int>(label->source.file);
  picked->line = static_cast<int>(label->source.line);
  const ProgramTrack* const track = program_ ? program_->track.get() : nullptr;
  for (std::size_t i = 0; track && label->source.line > 0 && i < track->size(); ++i) {
    if (track->source(i) != label->source) continue;
    picked->time_s = track->start_s(i);
    break;
  }
  return picked;
}

void LiveView::take_news(News& news) {
  if (news.stock) {
    stock_ = std::move(news.stock);
    feeder_.follow(stock_);
  }
  colors_.add(news.labels, news.tools);
  colors_.update(news.uses);
  if (news.has_tool) {
    cutter_ = std::move(news.cutter);
    tool_name_ = cutter_ ? tool_name_of(*cutter_) : std::string();
    mount_tool();
  }
  for (const Finding& finding : news.collisions) bodies_.add_finding(finding, watched_s());
  if (!news.findings.empty()) {
    findings_.insert(findings_.end(), std::make_move_iterator(news.findings.begin()),
                     std::make_move_iterator(news.findings.end()));
    auto list = std::make_shared<FindingList>();
    list->findings = findings_;
    update_.findings = std::move(list);
  }
  if (news.program) {
    program_ = std::move(news.program);
    show_program(*program_);
  }
  extend_path(news.trail);
  if (news.notice) {
    notice_ = std::move(*news.notice);
    update_.moment = moment_now();
  }
  if (!news.status) return;
  status_ = std::move(news.status);
  status_at_ = news.status_at;
  mount_tool();
  if (status_->work.g5x_mm != shown_work_.g5x_mm || status_->work.g92_mm != shown_work_.g92_mm ||
      status_->work.rotation_deg != shown_work_.rotation_deg) {
    shown_work_ = status_->work;
    auto setup = std::make_shared<SceneSetup>();
    setup->title = options_.title;
    setup->bounds_mm = options_.blank_mm;
    setup->blank_outline = options_.blank_outline;
    stand(*setup);
    setup->frames = scene_frames(shown_work_, options_.work_offset);
    update_.setup = std::move(setup);
  }
  update_.moment = moment_now();
}

void LiveView::mount_tool() {
  auto shape = bodies_.mount(cutter_, status_ ? status_->place.tool_length_mm : 0);
  if (!shape) return;
  tool_length_mm_ = drawn_height_mm(*shape);
  update_.tool_shape = std::move(shape);
}

double LiveView::watched_s() const { return seconds(Clock::now() - started_at_); }

void LiveView::show_program(LiveProgram& program) {
  colors_.set_program_tools(program.tools);
  update_.program = read_program_text(program.files);
  program_path_ = std::make_unique<TrackPath>(program.track);
  update_.path_chunk_count = 0;
  update_.path.clear();
  trail_chunk_.reset();
  auto timeline = std::make_shared<ProgramTimeline>();
  timeline->duration_s = program.track->duration_s();
  update_.timeline = std::move(timeline);
}

/// Where the machine has been, as long as there is no program whose path says where it goes.
void LiveView::extend_path(const std::vector<Vec3>& trail) {
  if (program_ || trail.empty()) return;
  if (!trail_chunk_) trail_chunk_ = std::make_shared<PathChunk>();
  for (const Vec3& point : trail) {
    if (trail_vertices_ >= TrackPath::kMaxVertices) return;
    const PathVertex vertex{glm::vec3(point), PathKind::kFeed};
    trail_chunk_->vertices.push_back(vertex);
    ++trail_vertices_;
    if (trail_chunk_->vertices.size() <= kPathChunkSegments) continue;
    auto next = std::make_shared<PathChunk>();
    next->index = trail_chunk_->index + 1;
    next->vertices.push_back(vertex);
    update_.path.push_back(std::exchange(trail_chunk_, std::move(next)));
  }
  update_.path.push_back(std::make_shared<const PathChunk>(*trail_chunk_));
}

std::shared_ptr<const Moment> LiveView::moment_now() {
  auto moment = std::make_shared<Moment>();
  moment->state = options_.log ? PlayState::kPlaying : PlayState::kFollowing;
  if (options_.log && log_paused_) moment->state = PlayState::kPaused;
  moment->speed = options_.speed;
  moment->source_name = options_.source_name;
  moment->work_offset = options_.work_offset;
  if (!status_ || !status_->place.known) bodies_.set_link_poses({});
  moment->fixture_poses = bodies_.poses();
  if (!status_) {
    if (!options_.log) moment->source = SourceFreshness::kStale;
    moment->notice = notice_.empty() ? tr("waiting for positions") : notice_;
    return moment;
  }
  const LiveStatus& status = *status_;
  const ToolState& place = status.place;
  if (status.state == LiveState::kEnded) moment->state = PlayState::kEnded;
  moment->source = freshness_of(status.state);
  moment->source_age_s = status.age_s + seconds(Clock::now() - status_at_);
  // Off its path, and before it has begun, the program stands where it was: the bar is as long as
  // it.
  moment->time_s = program_ ? place.program_s : status.t_s;
  moment->line = static_cast<int>(place.source.line);
  moment->file = static_cast<int>(place.source.file);
  moment->past_vertices =
      program_path_ ? program_path_->past_vertices(program_->track->place_at(place.program_s))
                    : trail_vertices_;
  moment->tool = std::max(0, place.tool);
  moment->tool_name = tool_name_;
  if (!std::isnan(place.spindle_rpm)) moment->spindle_rpm = place.spindle_rpm;
  moment->removed_mm3 = status.removed_mm3;
  moment->measured_mm_per_min = status.feed_mm_per_min;
  if (status.load) moment->spindle_load = text_of(*status.load);
  if (program_ && place.has_program_place() && !program_->track->empty()) {
    const TrackPosition at = program_->track->place_at(place.program_s);
    set_feed(program_->track->motion(std::min(at.motion, program_->track->size() - 1)),
             moment.get());
  }
  moment->notice = notice_of(status);
  if (moment->notice.empty() || status.state == LiveState::kEnded) {
    moment->notice = notice_.empty() ? moment->notice : notice_;
  }
  if (!place.known) return moment;
  moment->tool_pose = ToolPose{place.tip_mm, place.spindle};
  if (options_.machine) {
    moment->link_poses = machine_poses_at(*options_.machine, place, shown_work_, tool_length_mm_);
    bodies_.set_link_poses(lies_as_built(*options_.machine, shown_work_)
                               ? std::span<const glm::mat4>(moment->link_poses)
                               : std::span<const glm::mat4>());
    moment->fixture_poses = bodies_.poses();
  }
  bodies_.look(*moment->tool_pose, watched_s(), 1, stock_.get(), moment.get());
  has_rotary_ = has_rotary_ || place.abc_deg != std::array<double, 3>{};
  has_slides_ = has_slides_ || place.uvw_mm != Vec3(0);
  const SlidePlace slides{place.uvw_mm + shown_work_.offset_uvw_mm, place.uvw_mm};
  moment->axes =
      axis_readouts(place.machine_mm, place.tip_mm, has_rotary_ ? &place.abc_deg : nullptr,
                    has_slides_ ? &slides : nullptr);
  return moment;
}

}  // namespace kerf
