// twin/serve/player_broadcast.h - a program that is played, for the page.
#pragma once

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "twin/playback/player.h"
#include "twin/scene/player_scene.h"
#include "twin/serve/shop_broadcast.h"

namespace kerf {

/// What of the program the page shows, beside what its player has.
struct PlayedForPage {
  std::string title;
  std::vector<std::string> files;          ///< in the order of SourceRef::file
  MotionMoves moves;                       ///< where the tool is in the workpiece
  std::shared_ptr<const PunchPose> punch;  ///< of a sheet that is punched
  bool turns = false;                      ///< the workpiece does
};
PlayedForPage for_page(const ViewedProgram& shown);

/// Looks at the newest state of a player, and tells of it. The player knows nothing of it, and does
/// not wait: the states are there for whoever reads them.
class PlayerBroadcast {
 public:
  /// `player` and `scene` must outlive it.
  PlayerBroadcast(const Player& player, PlayedForPage played, LengthUnit unit, ServedScene& scene);
  ~PlayerBroadcast();

 private:
  void look(const PlayerState* seen, const std::shared_ptr<const PlayerState>& state);
  ShopMoment moment_of(const PlayerState& state, const std::string& tool_name) const;

  const Player& player_;
  const PlayedForPage played_;
  const LengthUnit unit_;
  std::string noted_spec_;
  std::uint64_t told_stock_ = 0;
  bool has_told_stock_ = false;
  ShopBroadcast broadcast_;
  std::jthread thread_;
};

}  // namespace kerf
