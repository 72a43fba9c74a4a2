// twin/serve/shop_broadcast.h - from whoever has a workpiece to the pages that look on.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "twin/scene/patch_feeder.h"
#include "twin/serve/served_scene.h"
#include "twin/serve/shop_state.h"

namespace kerf {

struct ShopBroadcastOptions {
  std::string title, source_name;
  Box blank_mm;
  bool turns = false;
  std::shared_ptr<const StockModel> stock;  ///< a snapshot; null: there is none
};

/// What has changed; what is empty is as it was.
struct ShopNews {
  std::shared_ptr<const StockModel> stock;  ///< a snapshot
  /// Asked each time that the page is told, in the broadcast's thread, until another one comes.
  std::function<ShopMoment(const std::string& tool_name)> moment;
  std::vector<std::string> findings;  ///< more of them: finding_object()
  struct Findings {
    std::vector<std::string> first;
    std::uint64_t total = 0;
  };
  std::optional<Findings> all_findings;  ///< instead of those before
  bool has_tool = false;
  std::shared_ptr<const Cutter> cutter;  ///< where there is one; null: none
};

/// Makes patches and texts of the newest news, kPeriod apart, in a thread of its own, and patches
/// only while somebody looks: whoever tells is not kept waiting, whatever pages do. Pages see the
/// part of a size that fits a tablet: cells much finer than a pixel of one are joined.
class ShopBroadcast {
 public:
  static constexpr std::chrono::milliseconds kPeriod{100};

  /// Pages begin anew. `scene` must outlive it.
  ShopBroadcast(ShopBroadcastOptions options, ServedScene& scene,
                std::function<ShopMoment(const std::string& tool_name)> moment);
  /// What was told last is shown on.
  ~ShopBroadcast();
  ShopBroadcast(const ShopBroadcast&) = delete;
  ShopBroadcast& operator=(const ShopBroadcast&) = delete;

  /// Any thread.
  void tell(ShopNews news);
  /// A page asks: a snapshot is worth its cost.
  bool is_watched() const { return scene_.is_watched(); }

 private:
  using Clock = std::chrono::steady_clock;
  void run(const std::stop_token& stop);
  void take(ShopNews news);
  void make_patches();
  void put_state();
  void put_setup();
  std::vector<ShownLine> code_about(const std::string& path, int line);

  const ShopBroadcastOptions options_;
  ServedScene& scene_;

  std::mutex mutex_;  // of what follows
  std::condition_variable_any arrived_;
  bool has_news_ = false;
  ShopNews news_;

  // of this one's thread
  std::shared_ptr<const StockModel> stock_;
  bool is_followed_ = false;  ///< by the feeder, as it is now
  std::size_t tiles_ = 0;     ///< of what it follows
  PatchFeeder feeder_;
  std::function<ShopMoment(const std::string&)> moment_;
  std::shared_ptr<const Cutter> cutter_;
  std::string tool_name_;
  std::string code_path_;
  std::int64_t code_time_ = 0;
  std::shared_ptr<const ProgramText> code_;
  std::jthread thread_;
};

}  // namespace kerf
