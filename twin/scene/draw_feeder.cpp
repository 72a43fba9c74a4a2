#include "twin/scene/draw_feeder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/translate.h"
#include "viewer/csg/convex_profile.h"

namespace kerf {
namespace {

DrawAnswer refusal(DrawMode draw_mode, DrawLimit limit, std::string detail = {}) {
  DrawAnswer answer;
  answer.draw_mode = draw_mode;
  answer.limit = limit;
  answer.detail = std::move(detail);
  return answer;
}

}  // namespace

void DrawFeeder::choose(DrawMode draw_mode) {
  answer_ = refusal(draw_mode, DrawLimit::kNone);
  is_answer_due_ = true;
  heights_of_.reset();
  place_.reset();
  if (draw_mode != DrawMode::kCsg) shown_.moves = {};
}

void DrawFeeder::update(const std::shared_ptr<const StockModel>& stock, const TrackPosition& place,
                        SceneUpdate* update) {
  DrawAnswer answer = answer_;
  if (program_ && program_->is_compared && answer_.draw_mode != DrawMode::kMesh) {
    answer = refusal(answer_.draw_mode, DrawLimit::kCompared);
  } else if (answer_.draw_mode == DrawMode::kRaycast) {
    answer = find_heights(stock, update);
  } else if (answer_.draw_mode == DrawMode::kCsg) {
    answer = find_moves(place, update);
  }
  if (answer == answer_ && !is_answer_due_) return;
  answer_ = std::move(answer);
  is_answer_due_ = false;
  update->draw_mode = std::make_shared<const DrawAnswer>(answer_);
}

/// Without a workpiece there is nothing to be drawn, in whatever draw mode.
DrawAnswer DrawFeeder::find_heights(const std::shared_ptr<const StockModel>& stock,
                                    SceneUpdate* update) {
  if (stock && stock != heights_of_) {
    update->heights = stock->height_grid();
    if (!update->heights) {
      return refusal(DrawMode::kRaycast, DrawLimit::kNoHeights, stock->name());
    }
    heights_of_ = stock;
  }
  return refusal(DrawMode::kRaycast, DrawLimit::kNone);
}

DrawAnswer DrawFeeder::begin_csg() {
  if (!program_) return refusal(DrawMode::kCsg, DrawLimit::kWatched);
  if (program_->is_tilted) return refusal(DrawMode::kCsg, DrawLimit::kTilted);
  const std::shared_ptr<const HeightGrid> heights =
      program_->blank ? program_->blank->height_grid() : nullptr;
  if (!heights) {
    return refusal(DrawMode::kCsg, DrawLimit::kNoBox,
                   program_->blank ? program_->blank->name() : "none");
  }
  if (const std::size_t low = low_cells(*heights); low > 0) {
    return refusal(DrawMode::kCsg, DrawLimit::kNoBox, trf("{} cells are lower than its top", low));
  }
  shown_.blank_mm = heights->bounds_mm();
  frame_moves_ = std::make_unique<FrameMoves>(program_->track, program_->cuts, shown_.blank_mm);
  for (const CsgTool& tool : frame_moves_->tools()) {
    const auto pieces = convex_pieces(tool.shape.cutter);
    if (!pieces) return refusal(DrawMode::kCsg, DrawLimit::kTool, pieces.error());
  }
  shown_.tools = std::make_shared<const std::vector<CsgTool>>(frame_moves_->tools());
  return refusal(DrawMode::kCsg, DrawLimit::kNone);
}

DrawAnswer DrawFeeder::find_moves(const TrackPosition& place, SceneUpdate* update) {
  if (!csg_answer_) csg_answer_ = begin_csg();
  DrawAnswer answer = *csg_answer_;
  if (!answer.is_drawn()) return answer;
  const bool is_same = place_ && std::tie(place_->motion, place_->fraction) ==
                                     std::tie(place.motion, place.fraction);
  if (!is_same) {
    go_to(place);
    update->cut_moves = std::make_shared<const CutMoves>(shown_);
  }
  if (first_motion_ > 0) {
    answer.limit = DrawLimit::kNewest;
    answer.line = static_cast<int>(program_->track->source(first_motion_).line);
  }
  return answer;
}

std::vector<SweptMove> DrawFeeder::moves_of(std::size_t motion) const {
  return frame_moves_->between({motion, 0, 0}, {motion + 1, 0, 0});
}

/// All moves of the motions before this one, or the newest of them.
void DrawFeeder::collect(std::size_t motion, std::size_t most) {
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
void DrawFeeder::go_to(const TrackPosition& place) {
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
