#include "twin/view/road_feeder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "viewer/csg/convex_profile.h"

namespace kerf {
namespace {

RoadAnswer refusal(DrawRoad road, RoadLimit limit, std::string detail = {}) {
  RoadAnswer answer;
  answer.road = road;
  answer.limit = limit;
  answer.detail = std::move(detail);
  return answer;
}

}  // namespace

void RoadFeeder::choose(DrawRoad road) {
  answer_ = refusal(road, RoadLimit::kNone);
  is_answer_due_ = true;
  heights_of_.reset();
  place_.reset();
  if (road != DrawRoad::kCsg) shown_.moves = {};
}

void RoadFeeder::update(const std::shared_ptr<const StockModel>& stock, const TrackPlace& place,
                        SceneUpdate* update) {
  RoadAnswer answer = answer_;
  if (program_ && program_->is_compared && answer_.road != DrawRoad::kMesh) {
    answer = refusal(answer_.road, RoadLimit::kCompared);
  } else if (answer_.road == DrawRoad::kRaycast) {
    answer = find_heights(stock, update);
  } else if (answer_.road == DrawRoad::kCsg) {
    answer = find_moves(place, update);
  }
  if (answer == answer_ && !is_answer_due_) return;
  answer_ = std::move(answer);
  is_answer_due_ = false;
  update->road = std::make_shared<const RoadAnswer>(answer_);
}

/// Without a workpiece there is nothing to be drawn, by whatever road.
RoadAnswer RoadFeeder::find_heights(const std::shared_ptr<const StockModel>& stock,
                                    SceneUpdate* update) {
  if (stock && stock != heights_of_) {
    update->heights = stock->height_grid();
    if (!update->heights) {
      return refusal(DrawRoad::kRaycast, RoadLimit::kNoHeights, stock->name());
    }
    heights_of_ = stock;
  }
  return refusal(DrawRoad::kRaycast, RoadLimit::kNone);
}

RoadAnswer RoadFeeder::begin_csg() {
  if (!program_) return refusal(DrawRoad::kCsg, RoadLimit::kWatched);
  if (program_->is_tilted) return refusal(DrawRoad::kCsg, RoadLimit::kTilted);
  const std::shared_ptr<const HeightGrid> heights =
      program_->blank ? program_->blank->height_grid() : nullptr;
  if (!heights) {
    return refusal(DrawRoad::kCsg, RoadLimit::kNoBox,
                   program_->blank ? program_->blank->name() : "none");
  }
  if (const std::size_t low = low_cells(*heights); low > 0) {
    return refusal(DrawRoad::kCsg, RoadLimit::kNoBox,
                   fmt::format("{} cells are lower than its top", low));
  }
  shown_.blank_mm = heights->bounds_mm();
  frame_moves_ = std::make_unique<FrameMoves>(program_->track, program_->cuts, shown_.blank_mm);
  for (const CsgTool& tool : frame_moves_->tools()) {
    const auto pieces = convex_pieces(tool.shape.cutter);
    if (!pieces) return refusal(DrawRoad::kCsg, RoadLimit::kTool, pieces.error());
  }
  shown_.tools = std::make_shared<const std::vector<CsgTool>>(frame_moves_->tools());
  return refusal(DrawRoad::kCsg, RoadLimit::kNone);
}

RoadAnswer RoadFeeder::find_moves(const TrackPlace& place, SceneUpdate* update) {
  if (!csg_answer_) csg_answer_ = begin_csg();
  RoadAnswer answer = *csg_answer_;
  if (!answer.is_drawn()) return answer;
  const bool is_same = place_ && std::tie(place_->motion, place_->fraction) ==
                                     std::tie(place.motion, place.fraction);
  if (!is_same) {
    go_to(place);
    update->cut_moves = std::make_shared<const CutMoves>(shown_);
  }
  if (first_motion_ > 0) {
    answer.limit = RoadLimit::kNewest;
    answer.line = static_cast<int>(program_->track->source(first_motion_).line);
  }
  return answer;
}

std::vector<SweptMove> RoadFeeder::moves_of(std::size_t motion) const {
  return frame_moves_->between({motion, 0, 0}, {motion + 1, 0, 0});
}

/// All moves of the motions before this one, or the newest of them.
void RoadFeeder::collect(std::size_t motion, std::size_t most) {
  std::vector<std::vector<SweptMove>> backwards;
  std::size_t count = 0;
  first_motion_ = 0;
  for (std::size_t i = std::min(motion, program_->track->size()); i-- > 0;) {
    std::vector<SweptMove> moves = moves_of(i);
    if (moves.empty()) continue;
    if (count + moves.size() > most) {
      first_motion_ = i + 1;
      break;
    }
    count += moves.size();
    backwards.push_back(std::move(moves));
  }
  shown_.moves.clear();
  for (auto moves = backwards.rbegin(); moves != backwards.rend(); ++moves) {
    shown_.moves.insert(shown_.moves.end(), moves->begin(), moves->end());
  }
  whole_ = shown_.moves.size();
  shown_.left_out = first_motion_;
}

/// Of the motion that is under way the chords of the whole of it are taken as far as they go, so
/// that from one place to the next a move is added or the last one grows, and nothing else.
void RoadFeeder::go_to(const TrackPlace& place) {
  if (!place_ || place.motion < place_->motion) {
    collect(place.motion, kMostMoves);
  } else {
    shown_.moves.resize(whole_);
    for (std::size_t i = place_->motion; i < place.motion && whole_ <= kMostMoves; ++i) {
      const std::vector<SweptMove> moves = moves_of(i);
      shown_.moves.insert(shown_.moves.end(), moves.begin(), moves.end());
      whole_ = shown_.moves.size();
    }
    if (whole_ > kMostMoves) collect(place.motion, kMostMoves / 2);
  }
  place_ = place;
  if (!(place.fraction > 0)) return;
  const std::vector<SweptMove> moves = moves_of(place.motion);
  const double done = place.fraction * static_cast<double>(moves.size());
  const auto chords = static_cast<std::size_t>(done);
  for (std::size_t i = 0; i < std::min(chords + 1, moves.size()); ++i) {
    SweptMove move = moves[i];
    if (i == chords) {
      move.to_mm =
          move.from_mm + (done - static_cast<double>(chords)) * (move.to_mm - move.from_mm);
    }
    shown_.moves.push_back(move);
  }
}

}  // namespace kerf
