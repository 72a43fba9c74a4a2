// tests/twin/cli/watched_program.h - a short program for tests of whole commands, and their JSON.
#pragma once

#include <nlohmann/json.hpp>

namespace kerf {

using Json = nlohmann::json;

/// A slot, an arc, a slot back; another tool, a hole. About four seconds.
inline constexpr const char* kWatchedProgram =
    "G21 G90 G94 G17 G64 P0.01\n"
    "T1 M6 S8000 M3\n"
    "G0 X0 Y0 Z2\n"
    "G1 Z-2 F1200\n"
    "G1 X20 F3000\n"
    "G2 X20 Y20 I0 J10\n"
    "G1 X0\n"
    "G0 Z5\n"
    "T2 M6 S3000 M3\n"
    "G0 X10 Y10\n"
    "G1 Z-4 F600\n"
    "G0 Z5\n"
    "M5\n"
    "M2\n";

}  // namespace kerf
