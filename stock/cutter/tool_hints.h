// stock/cutter/tool_hints.h - tools and blanks that CAM systems and people write into comments.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// One comment of a program: where, its text without parentheses or semicolon, and whether inches
/// were in force there (G20 seen before it and no G21 since; the first G20/G21 of the program
/// counts for comments before it).
struct CommentText {
  std::uint32_t line = 0;
  std::string text;
  bool inches = false;
  /// T word of its own block, outside comments; -1: there is none.
  int block_tool = -1;
  /// Nothing moves between it and an M6, before or behind it; or the program has no M6.
  bool at_change = true;
};

/// A tool that a comment describes.
struct ToolHint {
  /// The number that the comment names, else that of the T word of its own block; -1 without
  /// either: then the next tool to be used after `line` is meant, and of several such hints before
  /// that use the last one counts.
  int tool = 0;
  std::uint32_t line = 0;
  std::string dialect;  ///< "fusion", "cambam", "cutviewer", ... for messages
  std::string shape;    ///< SHAPE text, parse_shape() accepts it
  /// The text gives less than the shape needs: only a diameter (a flat cutter is assumed), a V-bit
  /// without its angle (90 degrees), a bull-nose or tapered cutter without its radius or angle.
  bool shape_guessed = false;
  /// What the text does not give, as a sentence; empty: the kind, or shape_guessed is false.
  std::string guess;
  /// Without a number: running text, or not at a tool change. It may be about another tool.
  bool near = false;
};
/// In the order of the comments, at most the first 10000; a tool that a list repeats with the same
/// shape comes once. Comments longer than 512 characters are passed over.
std::vector<ToolHint> find_tool_hints(std::span<const CommentText> comments);

/// A blank that comments describe: LinuxCNC 2.10's (WORKPIECE,BOX|CYLINDER|TUBE,...) (several add
/// up), CutViewer's (STOCK/BLOCK,...), Lathe EasyStep's (Rohteil ...). SPEC text as --stock takes
/// it, parts joined by " + ".
struct BlankHint {
  std::uint32_t line = 0;
  std::string dialect;  ///< "workpiece" | "cutviewer" | "easystep"
  std::string spec;     ///< parse_blank() accepts it
};
std::optional<BlankHint> find_blank_hint(std::span<const CommentText> comments);

/// Shape from the free text of a tool table remark ("1/16 end mill", "45/60 v-bit", "6 mm straight
/// ball end"), with the table's diameter; nullopt if the text names no kind of cutter.
std::optional<ToolHint> shape_from_remark(int tool, double diameter_mm, std::string_view remark);

}  // namespace kerf
