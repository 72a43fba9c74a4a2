// twin/cli/finding_shots.h - --finding-png: a picture of each finding, in a folder.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/job/tools.h"
#include "twin/live/live_session.h"
#include "twin/machines/machine_choice.h"
#include "twin/machines/machine_model.h"
#include "twin/program/program_front.h"
#include "twin/report/report.h"
#include "twin/scene/finding_picture.h"

namespace kerf {

/// So many are drawn.
inline constexpr std::size_t kMostFindingPictures = 20;

/// Makes the folder, if there is to be one (`folder` not empty). Faults say why it cannot be
/// written into.
void make_finding_folder(const std::string& folder, Diagnostics& diagnostics);

/// Of a program that has been run, the findings of its report in their order, as far as they have a
/// place. Where there are such it is read and cut a second time, up to the last of them: the
/// workpiece in each picture is that of the finding's time. `machine`, `ini`: see drawn_machine();
/// drawn where its links touch something. `on_picture` gets the share that is
/// done, 0..1. Faults: no OpenGL, a disk that is full.
void write_finding_pictures(const std::string& folder, const SessionOptions& options,
                            const MachineChoice& machine, const std::string& ini,
                            const Report& report, const std::stop_token& stop,
                            const std::function<void(double)>& on_picture,
                            Diagnostics& diagnostics);

/// Beside a machine (of which `machine` is the shape; null: none is drawn): takes the workpiece
/// when a finding is told, some hundredths of a second after it, and passes all on to another
/// observer.
class FindingShots final : public LiveObserver {
 public:
  /// The references must outlive it.
  FindingShots(const LiveSession& session, std::shared_ptr<const MachineModel> machine,
               LiveObserver& next);

  void on_status(const LiveStatus& status) override;
  void on_finding(const Finding& finding, const std::vector<std::string>& files) override;
  void on_warning(const AheadWarning& warning, const std::vector<std::string>& files) override {
    next_.on_warning(warning, files);
  }
  void on_run(const LiveRun& run) override { next_.on_run(run); }
  bool wants_frames() const override { return next_.wants_frames(); }
  std::chrono::milliseconds frame_period() const override { return next_.frame_period(); }
  void on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                std::span<const Vec3> trail, std::span<const CutLabel> labels) override {
    next_.on_frame(stock, cutter, status, trail, labels);
  }

  /// Draws what has been taken.
  void write(const std::string& folder, const CollisionWishes& wishes, Diagnostics& diagnostics);

 private:
  const LiveSession& session_;
  LiveObserver& next_;
  ToolResolver resolver_;
  std::shared_ptr<const MachineModel> machine_;
  ToolState place_;
  WorkpieceFrame work_;
  std::vector<FindingShot> shots_;
};

}  // namespace kerf
