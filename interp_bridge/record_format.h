// interp_bridge/record_format.h - what kerf-interp writes and kerf reads. Plain constants, no
// header of LinuxCNC. kerf_interp/README.md is the description.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kerf::records {

/// First eight bytes of a stream. Another last digit is another format: the two programs must be of
/// one build.
inline constexpr char kMagic[8] = {'k', 'e', 'r', 'f', 'r', 'e', 'c', '1'};

/// Begins every record; the payload follows. All of it in the byte order of the machine (the stream
/// never leaves it), and every record a multiple of eight bytes.
struct Head {
  std::uint8_t code = 0;    ///< CanonicalName, or a Code below
  std::uint8_t level = 0;   ///< call level of O-words: 0 = the program itself; at most 255
  std::uint16_t count = 0;  ///< doubles of the payload; for text: its bytes, padded to eight
  std::uint32_t line = 0;   ///< 1-based line of the block, 0 = none
};
static_assert(sizeof(Head) == 8);

/// Added to the code of a canonical call whose payload is text (COMMENT, MESSAGE, ..).
inline constexpr std::uint8_t kText = 0x80;

enum Code : std::uint8_t {
  kFile = 0x70,  ///< text: the records that follow are of this file, the `line`th (from 0); empty:
                 ///< one that was named before
  kSpline = 0x71,  ///< order, then x, y, weight of each control point
  kUserM = 0x72,   ///< M100 to M199: its number, P, Q; the machine would run a program of its own
  kWait = 0x73,    ///< M66: input, kind of input, kind of wait, timeout (s)
  kRotary = 0x74,  ///< joint, 1 = locked, 0 = unlocked
  kAt = 0x75,      ///< nothing happened but time: where the interpreter is
  kError = 0x76,   ///< text of the interpreter, at `line`; ends the run
  kEcho = 0x77,    ///< text of the line that kError is about
  kCaller = 0x78,  ///< after kError, innermost first: `line` called; count 1: index of its file
  kProbe = 0x7a,   ///< a probing move is about to begin: 0 to 3 for G38.2 to G38.5, then its end as
                   ///< a STRAIGHT_PROBE has it, nine numbers. kerf-interp waits for an Answer
  kStore = 0x7b,   ///< the block at `line` is about to be run, and may be one of those whose effect
                   ///< shows only later: G28.1, G30.1, G10
  kHere = 0x7c,    ///< the STRAIGHT_TRAVERSE that follows is no move: there the machine stands
  kMode = 0x7d,    ///< with --first-line, before kHere: a ModeGroup, what it began with, what it is
                   ///< now; `line` of the program has made it so, 0: it began so
  kRead = 0x7e,    ///< text: the interpreter has opened this file (`line` 1), or looked for it in
                   ///< vain (0); all of them right before kEnd, with the programs that run
  kHidden = 0x7f,  ///< it has looked where nobody can tell what it saw: the next time may differ
  kEnd = 0x79,     ///< the last record: 1 if the program ended by M2, M30 or %; blocks read
};
constexpr bool is_text(std::uint8_t code) {
  return code >= kText || code == kFile || code == kError || code == kEcho || code == kRead;
}

/// What kerf writes back for each kProbe.
struct Answer {
  enum Kind : std::uint32_t { kUnknown, kMet, kMissed, kAlready };
  std::uint32_t kind = kUnknown;
  std::uint32_t unused = 0;
  double share = 1;  ///< kMet: the part of the move that is run
};
static_assert(sizeof(Answer) == 16);

inline constexpr double kDigitalInput = 1;     ///< kind of input of kWait; 0 = analog
inline constexpr std::size_t kMaxText = 4096;  ///< bytes; longer is cut off
inline constexpr std::size_t kMaxSplinePoints = 10'000;

constexpr std::size_t payload_bytes(const Head& head) {
  return is_text(head.code) ? (head.count + std::size_t{7}) / 8 * 8 : std::size_t{8} * head.count;
}

}  // namespace kerf::records
