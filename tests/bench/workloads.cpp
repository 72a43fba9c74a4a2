#include "tests/bench/workloads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace kerf {
namespace {

constexpr double kFinishSide_mm = 200.0;

double wavy_surface_mm(double x_mm, double y_mm) {
  return -6 + 3 * std::sin(x_mm / 13.0) * std::cos(y_mm / 17.0) +
         1.5 * std::sin((x_mm + y_mm) / 7.0);
}

/// Rows along X, `step_mm` apart, to and fro, each divided into equal moves so that all rows
/// together have about `moves` of them.
std::string finishing_program(int moves, double step_mm) {
  const int rows = static_cast<int>(kFinishSide_mm / step_mm);
  const int moves_per_row = std::max(2, moves / rows);
  std::string text =
      "G21 G90 G17 G64 P0.01\nT1 M6\nS12000 M3\nG0 Z5\nG0 X0 Y0\n"
      "F3000\n";
  for (int row = 0; row <= rows; ++row) {
    const double y = row * step_mm;
    for (int i = 0; i <= moves_per_row; ++i) {
      const double t = static_cast<double>(i) / moves_per_row;
      const double x = row % 2 == 0 ? kFinishSide_mm * t : kFinishSide_mm * (1 - t);
      fmt::format_to(std::back_inserter(text), "G1 X{:.4f} Y{:.4f} Z{:.4f}\n", x, y,
                     wavy_surface_mm(x, y));
    }
  }
  text += "G0 Z5\nM5\nM2\n";
  return text;
}

std::string finish_100k() { return finishing_program(100'000, 0.5); }
std::string finish_1m() { return finishing_program(1'000'000, 0.2); }

/// Five slots, each in four layers of 4 mm: a full circle of radius 3 about (x + 3, y), then 0.5 mm
/// on.
std::string trochoid() {
  std::string text = "G21 G90 G17 G64 P0.01\nT2 M6\nS9000 M3\nG0 Z5\nF2000\n";
  const auto out = std::back_inserter(text);
  for (int layer = 1; layer <= 4; ++layer) {
    for (int y = 20; y < 90; y += 15) {
      fmt::format_to(out, "G0 X12 Y{}\nG1 Z{} F500\nF2000\n", y, -4 * layer);
      for (double x = 12.0; x < 138;) {
        fmt::format_to(out, "G3 X{:.4f} Y{}.0000 I3 J0\n", x, y);
        x += 0.5;
        fmt::format_to(out, "G1 X{:.4f} Y{}.0000\n", x, y);
      }
      text += "G0 Z5\n";
    }
  }
  text += "M5\nM2\n";
  return text;
}

/// A wavy shaft from a bar of 60 mm: 1000 passes along it and back, then finishing passes of 2000
/// chords each, which come nearer to the contour by what is left over their number. Radii.
std::string lathe() {
  constexpr int kPasses = 1000, kChords = 2000, kFinishing = 48;
  constexpr double kMean = 16, kWave = 2, kPeriod = 40, kNose = 0.4, kPi = std::numbers::pi;
  std::string text = "G21 G90 G18 G8 G94 G64 P0.01\nT1 M6\nG97 S1200 M3\nG0 X40 Z5\nF300\n";
  const auto out = std::back_inserter(text);
  for (int i = 0; i < kPasses; ++i) {
    const double x = 30 - (30 - kMean - kWave - 6) * (i + 1) / kPasses, z = -150 + 0.02 * i;
    fmt::format_to(out, "G0 X{:.4f} Z2\nG1 Z{:.4f}\nG1 X{:.4f} Z{:.4f}\nG0 Z2\n", x, z, x + 0.5,
                   z + 0.5);
  }
  for (int pass = 0; pass < kFinishing; ++pass) {
    const double left = 5.0 * (kFinishing - 1 - pass) / kFinishing;
    text += "G0 X40 Z2\n";
    for (int i = 0; i < kChords - 2; ++i) {
      const double z = 2 - 142.0 * i / (kChords - 3), turn = 2 * kPi * z / kPeriod;
      const double slope = kWave * 2 * kPi / kPeriod * std::cos(turn);
      const double length = std::hypot(slope, 1.0);
      fmt::format_to(out, "G1 X{:.4f} Z{:.4f}\n",
                     kMean + kWave * std::sin(turn) + (kNose + left) / length - kNose,
                     z - (kNose + left) * slope / length - kNose);
    }
    text += "G0 X40\n";
  }
  text += "M5\nM2\n";
  return text;
}

constexpr std::array kWorkloads{
    Workload{"w2_finish_100k", "ball finishing of a wavy surface, 0.5 mm rows, 100k moves",
             "box:0,0,-30:200,200,0", "1=ball:6", finish_100k},
    Workload{"w2_finish_1m", "ball finishing of a wavy surface, 0.2 mm rows, 1M moves",
             "box:0,0,-30:200,200,0", "1=ball:6", finish_1m},
    Workload{"w3_trochoid", "trochoidal slots in four layers, 10k moves, half of them arcs",
             "box:0,0,-20:150,100,0", "2=flat:10", trochoid},
    Workload{"w4_lathe", "a wavy shaft, 1000 passes and 48 finishing passes, 100k moves",
             "cylinder:0,0,-160:0:60", "1=turn:0.4:2:85:30", lathe, true},
};

}  // namespace

std::span<const Workload> workloads() { return kWorkloads; }

}  // namespace kerf
