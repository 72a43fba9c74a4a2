// twin/scene/live_view.h - a machine that is watched, or a log, in the window.
#pragma once

#include <condition_variable>
#include <functional>
#include <glm/mat4x4.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "twin/live/live_session.h"
#include "twin/live/tool_state.h"
#include "twin/machines/machine_model.h"
#include "twin/playback/program_track.h"
#include "twin/scene/body_watch.h"
#include "twin/scene/cut_colors.h"
#include "twin/scene/draw_feeder.h"
#include "twin/scene/live_colors.h"
#include "twin/scene/patch_feeder.h"
#include "twin/scene/track_path.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// The program beside the machine, as the window shows it.
struct LiveProgram {
  std::shared_ptr<const ProgramTrack> track;
  std::vector<std::string> files;
  std::vector<NamedTool> tools;
};

/// What a view shows now.
struct LiveScene {
  std::shared_ptr<const StockModel> stock;  ///< null: nothing yet
  std::optional<LiveStatus> status;         ///< its age_s that of now
};

struct LiveViewOptions {
  std::string title;
  std::string source_name;
  std::string work_offset;
  Box blank_mm;
  std::vector<LineSegment> blank_outline;
  std::shared_ptr<const StockModel> stock;  ///< until the first frame; null: nothing is shown
  ToolSources tools;
  std::shared_ptr<const MachineModel> machine;  ///< null: none is drawn
  CollisionWishes collisions;                   ///< fixtures and spindle, as they are checked
  bool log = false;                             ///< may be paused
  double speed = 1;                             ///< of a log
  /// Reads the program for its path, text and times, in a thread of the view; empty: no program.
  /// Null if it cannot be read, which the session reports.
  std::function<std::unique_ptr<LiveProgram>(std::stop_token)> load_program;
  /// The user closed the window, or changed the speed of a log.
  std::function<void()> on_close;
  std::function<void(double)> on_speed;
  /// What can be copied; null: nothing.
  std::shared_ptr<const ViewedJob> job;
  /// Another file was asked for; empty: nothing is opened.
  std::function<void(const std::string&)> on_open;
  /// Blank, tools or fixtures were changed in their fields. What it gives is told (empty: nothing).
  std::function<std::string(const JobCommand&)> on_job;
  /// A start at that line of the program was asked about; empty: nobody answers.
  std::function<void(int line, const LiveScene& now)> on_entry;
};

/// Of a machine, for Moment::link_poses: where it stands while the tool is there. Empty: it cannot
/// stand so.
std::vector<glm::mat4> machine_poses_at(const MachineModel& machine, const ToolState& place,
                                        const WorkpieceFrame& work, double tool_length_mm);
/// The workpiece lies on its link where a machine of machine.links was told that it does: else what
/// stands on links is elsewhere.
bool lies_as_built(const MachineModel& machine, const WorkpieceFrame& work);

/// Takes what LiveSession shows and passes all of it on to another observer. The session's thread
/// pays for a snapshot of the workpiece (microseconds) sixty times a second; patches are made in a
/// thread of the view's.
class LiveView final : public LiveObserver {
 public:
  /// The references must outlive it.
  LiveView(LiveViewOptions options, LiveObserver& next, SceneMailbox& mailbox,
           CommandQueue& commands);
  ~LiveView() override;
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  void on_status(const LiveStatus& status) override;
  void on_finding(const Finding& finding, const std::vector<std::string>& files) override;
  void on_warning(const AheadWarning& warning, const std::vector<std::string>& files) override;
  void on_run(const LiveRun& run) override { next_.on_run(run); }
  bool wants_frames() const override { return true; }
  void on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                std::span<const Vec3> trail, std::span<const CutLabel> labels) override;

  /// Stays in the status line where nothing else is to be said there. From any thread.
  void tell(std::string notice);

  /// Shows the workpiece as it was left, until the window is closed or `stop` is asked for.
  void end(const StockModel* stock, std::span<const CutLabel> labels, const std::stop_token& stop);

 private:
  using Clock = std::chrono::steady_clock;
  /// What the session's thread leaves for the view's.
  struct News {
    std::shared_ptr<const StockModel> stock;
    bool has_tool = false;                 ///< another one than before:
    std::shared_ptr<const Cutter> cutter;  ///< null: none that is known
    std::optional<LiveStatus> status;
    Clock::time_point status_at;
    std::vector<Vec3> trail;
    std::vector<SceneFinding> findings;  ///< those that are new
    std::vector<Finding> collisions;     ///< those that are new, and not ahead
    std::vector<CutLabel> labels;        ///< those that are new
    std::vector<LabelUse> uses;          ///< of labels that have cut since they were told
    std::vector<NamedTool> tools;        ///< that are new among the labels
    std::unique_ptr<LiveProgram> program;
    std::optional<std::string> notice;
  };

  void run(std::stop_token stop);
  bool draws_mesh() const { return draw_modes_.drawn() == DrawMode::kMesh; }
  void publish_start();
  bool obey(const ViewerCommand& command);
  void take_news(News& news);
  void show_program(LiveProgram& program);
  void extend_path(const std::vector<Vec3>& trail);
  void mount_tool();
  double watched_s() const;
  std::shared_ptr<const Moment> moment_now();
  void note_tool(int tool, const Cutter* cutter, News& news);
  void note_labels(std::span<const CutLabel> labels, News& news);
  void note_uses(std::span<const CutLabel> labels, News& news);
  LiveScene scene_now() const;
  void stand(SceneSetup& setup) const;
  std::shared_ptr<const PickedPoint> who_cut(const Vec3& point_mm) const;

  LiveViewOptions options_;
  LiveObserver& next_;
  SceneMailbox& mailbox_;
  CommandQueue& commands_;

  std::mutex mutex_;  // of news_
  std::condition_variable arrived_;
  News news_;
  // of the session's thread
  ToolResolver resolver_;
  std::string shown_spec_;
  std::size_t noted_labels_ = 0;
  std::vector<double> noted_s_;  ///< CutLabel::cut_s, by label
  Clock::time_point uses_at_{};  ///< when they were looked at
  std::set<int> noted_tools_;
  // of the view's thread
  PatchFeeder feeder_;
  DrawFeeder draw_modes_;
  BodyWatch bodies_;
  std::shared_ptr<const Cutter> cutter_;
  std::shared_ptr<const StockModel> stock_;  ///< the newest; null: none yet
  LiveColors colors_;
  std::vector<SceneFinding> findings_;
  std::unique_ptr<LiveProgram> program_;
  std::unique_ptr<TrackPath> program_path_;
  std::shared_ptr<PathChunk> trail_chunk_;
  std::uint64_t trail_vertices_ = 0;
  std::optional<LiveStatus> status_;
  Clock::time_point status_at_;
  std::string tool_name_;
  double tool_length_mm_ = 0;
  WorkpieceFrame shown_work_;
  bool log_paused_ = false;
  std::string notice_;  ///< of tell()
  Clock::time_point started_at_ = Clock::now();
  bool has_rotary_ = false;
  bool has_slides_ = false;
  bool closed_ = false;
  SceneUpdate update_;

  std::jthread loader_;
  std::jthread thread_;
};

}  // namespace kerf
