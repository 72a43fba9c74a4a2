// twin/job/turning_row.h - a lathe tool as a row of LinuxCNC's tool table describes it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/free_text.h"
#include "stock/cutter/turning_text.h"

namespace kerf {

/// What a table's D is of such a tool: of a turning tool twice its nose radius, else its width.
double table_diameter_mm(const Cutter& cutter);

/// Of the rows' tools, for texts about them.
std::map<int, TurningFacts> turning_facts(const std::vector<ToolTableRow>& rows);

/// The tool that the remark names (turning_text.h), with the row's Q, I, J and D where it leaves
/// them out. None: it names none.
std::optional<ShapeText> turning_remark_shape(const ToolTableRow& row);

/// Without a remark: a nose of diameter D at orientation Q, flanks along I and J. What is missing
/// or does not fit is guessed: the sentence names the word and what is taken.
///     Q   the corner that I and J lie behind; else 2
///     I J those of LinuxCNC's sample tables for the orientation; both 0 are missing
///     D   a sharp nose
/// A row without Q, I, J whose tool only goes up and down (`drills`), or whose D is wider than a
/// nose is, is a drill. Sources: LinuxCNC 2.9, lib/python/rs274/glcanon.py, configs/sim/lathe.tbl.
ShapeText turning_row_shape(const ToolTableRow& row, bool drills);

}  // namespace kerf
