// tests/twin/playback/tracks.h - programs as tracks, and shops to play them in.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "stock/zmap/zmap.h"
#include "tests/twin/process/motions.h"
#include "twin/motion/motion_geometry.h"
#include "twin/playback/player.h"
#include "twin/playback/program_track.h"
#include "twin/process/cut_stage.h"

namespace kerf::test {

inline std::shared_ptr<const ProgramTrack> track_of(std::span<const Motion> motions) {
  ProgramTrackBuilder builder;
  Timeline timeline(TimelineOptions{}, builder);
  for (const Motion& m : motions) timeline.push(m);
  timeline.finish();
  return builder.build({"part.ngc"}, {});
}

inline std::unique_ptr<ZMap> block_40(double cell_mm = 0.1) {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-10:40,40,0").value();
  options.cell_mm = cell_mm;
  return std::move(ZMap::create(options).value());
}

inline ToolSources two_tools() {
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=ball:6").value()));
  sources.arguments.push_back(std::move(parse_tool_argument("2=bull:4:1").value()));
  return sources;
}

/// Smooth runs, sharp corners, plunges, level circles, arcs in other planes, helices, rapids above
/// and (some: their checks take most of the time) through the block, spindle stops, tool changes,
/// jumps of the tip, an unknown tool.
inline std::vector<Motion> varied_program(unsigned seed, int moves) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-3, 43), depth(-6, 1), small(-0.4, 0.4);
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true);
  Vec3 at{-5, 20, 5};
  Vec3 heading{0.5, 0, 0};
  for (int i = 0; i < moves; ++i) {
    const unsigned kind = random() % 40;
    if (kind < 26) {  // a smooth run
      const double turn = small(random);
      heading = {heading.x * std::cos(turn) - heading.y * std::sin(turn),
                 heading.x * std::sin(turn) + heading.y * std::cos(turn), 0};
      if (at.x < 0 || at.x > 40) heading.x = at.x < 0 ? 0.5 : -0.5;
      if (at.y < 0 || at.y > 40) heading.y = at.y < 0 ? 0.5 : -0.5;
      at += heading;
      at.z = std::clamp(at.z + 0.3 * small(random), -6.0, 0.5);
      program.feed(at);
    } else if (kind < 30) {
      at = {place(random), place(random), depth(random)};
      program.feed(at);
    } else if (kind == 30) {
      at.z = depth(random);
      program.feed(at);
    } else if (kind < 33) {
      const Vec3 center = at + Vec3{2, 0, 0};
      program.arc(at, center, {0, 0, random() % 2 == 0 ? 1.0 : -1.0}, 2 * kPi);
    } else if (kind == 33) {
      const Vec3 center = at + Vec3{0, 1.5, 0};
      at += Vec3{0, 3, kind == 33 && random() % 2 == 0 ? 0.0 : -0.5};
      program.arc(at, center, {0, 0, 1}, kPi);
    } else if (kind == 34) {
      const Vec3 center = at + Vec3{1, 0, 0};
      at += Vec3{2, 0, 0};
      program.arc(at, center, {0, 1, 0}, kPi);
    } else if (kind < 37) {
      const bool through = random() % 16 == 0;
      if (!through) program.traverse({at.x, at.y, 5});
      at = {place(random), place(random), through ? depth(random) : 5.0};
      program.traverse(at);
    } else if (kind == 37) {
      program.spindle(random() % 2 == 0);
    } else if (kind == 38) {
      program.tool(1 + static_cast<int>(random() % 3));  // 3 is not known
    } else {
      at += Vec3{0, 0, 0.25};  // another tool length
      program.at(at);
    }
  }
  program.traverse({at.x, at.y, 20});
  return program.list();
}

/// What a dry run leaves of the first `count` motions.
inline std::string digest_after(std::span<const Motion> motions, std::size_t count,
                                std::vector<Finding>* findings = nullptr) {
  const std::unique_ptr<ZMap> stock = block_40();
  ToolResolver resolver(two_tools(), ZMap::can_cut);
  FindingLog log;
  CutStage stage(*stock, resolver, log, TimelineOptions{});
  stage.take(motions.first(count));
  stage.finish();
  if (findings) *findings = log.kept();
  return stock->digest();
}

/// The same for many numbers of motions, in one run: copies of its workpiece on the way.
inline std::map<std::size_t, std::string> digests_after(std::span<const Motion> motions,
                                                        std::vector<std::size_t> counts) {
  class Steps final : public StepSink {
   public:
    void step(const Motion&, const TimedStep& timed, std::span<const PathPiece>) override {
      list.push_back(timed);
    }
    std::vector<TimedStep> list;
  } steps;
  Timeline timeline(TimelineOptions{}, steps);
  for (const Motion& m : motions) timeline.push(m);
  timeline.finish();
  const std::unique_ptr<ZMap> stock = block_40();
  ToolResolver resolver(two_tools(), ZMap::can_cut);
  FindingLog log;
  CutStage stage(*stock, resolver, log, TimelineOptions{});
  std::sort(counts.begin(), counts.end());
  std::map<std::size_t, std::string> digests;
  std::size_t done = 0;
  for (const std::size_t count : counts) {
    for (; done < count; ++done) stage.take_timed(motions[done], steps.list[done]);
    stage.take({});  // hands over what it has collected
    digests[count] = stock->snapshot()->digest();
  }
  return digests;
}

/// `count` places in a program of `size` motions; its end is one of them.
inline std::vector<std::size_t> random_places(std::mt19937& random, std::size_t size, int count) {
  std::vector<std::size_t> places{size};
  while (static_cast<int>(places.size()) < count) places.push_back(random() % (size + 1));
  std::shuffle(places.begin(), places.end(), random);
  return places;
}

}  // namespace kerf::test
