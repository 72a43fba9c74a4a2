// tests/stock/zmap/mmap/mmap_samples.h - workpieces with undercuts for the tests of the M-map.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stock/zmap/mmap/mmap.h"
#include "tests/stock/stock_samples.h"

namespace kerf::test {

inline std::unique_ptr<MMap> make_mmap(const std::string& blank, double cell, int threads = 1,
                                       ZMapKernel kernel = ZMapKernel::kAuto) {
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell;
  options.threads = threads;
  options.kernel = kernel;
  auto map = MMap::create(options);
  EXPECT_TRUE(map) << map.error();
  return std::move(*map);
}

inline Cutter shape(const std::string& spec) {
  Result<Cutter> cutter = parse_shape(spec);
  EXPECT_TRUE(cutter) << cutter.error();
  return *cutter;
}

/// A closed outline with an upper side: a double cone, as single-point thread mills have.
inline Cutter double_cone() {
  std::vector<ProfilePiece> lower(2), upper(1);
  lower[0].r1 = 1.5;
  lower[1].r0 = 1.5;
  lower[1].r1 = 3;
  lower[1].z1 = 0.8;
  upper[0].r0 = 3;
  upper[0].z0 = 0.8;
  upper[0].r1 = 1;
  upper[0].z1 = 2.2;
  Result<Cutter> cutter = Cutter::from_profile("double cone", lower);
  EXPECT_TRUE(cutter) << cutter.error();
  EXPECT_TRUE(cutter->set_upper_profile(upper));
  return *cutter;
}

inline CutMove helix(const Vec3& center, double radius, double start, double sweep, double dz) {
  CutMove move;
  move.from_mm = center + Vec3(radius * std::cos(start), radius * std::sin(start), 0);
  move.to_mm =
      center + Vec3(radius * std::cos(start + sweep), radius * std::sin(start + sweep), dz);
  move.arc = CutArc{center, Vec3(0, 0, 1), sweep};
  return move;
}

/// Total of what the moves remove.
inline double removed_mm3(StockModel& map, const Cutter& cutter,
                          const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  map.cut(cutter, moves, reports);
  map.finish(reports);
  double sum = 0;
  for (const CutReport& report : reports) sum += report.removed_mm3;
  return sum;
}

/// Moves of all kinds with tools of all kinds over a blank of 24 x 18 x 10 mm.
struct Job {
  Cutter cutter;
  std::vector<CutMove> moves;
};
inline std::vector<Job> random_jobs(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Box room{Vec3(-1, -1, -8), Vec3(25, 19, -1)};
  std::vector<Job> jobs;
  for (const Cutter& cutter : {shape("flat:4"), shape("tslot:7:1.5:3"), shape("ball:5"),
                               shape("lollipop:4:2"), double_cone(), shape("dovetail:6:60:3")}) {
    Job job{cutter, random_path(random, room, cutter.undercuts() ? 14 : 30)};
    if (cutter.undercuts()) {
      CutMove turn = helix(Vec3{24 * unit(random), 18 * unit(random), -2}, 1 + 3 * unit(random),
                           6 * unit(random), 9, -3);
      turn.id = 100;
      job.moves.push_back(turn);
    }
    jobs.push_back(job);
  }
  return jobs;
}

}  // namespace kerf::test
