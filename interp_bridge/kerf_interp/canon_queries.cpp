// What the interpreter asks, and the three functions through which it would reach the tool table
// that all LinuxCNCs of an account share: ours are found first, so that it is not touched.
#include <canon.hh>
#include <cstdio>

#include "interp_bridge/kerf_interp/recording.h"

using kerf::interp::recording;
using kerf::interp::World;

namespace {

World& world() { return recording().world; }

std::size_t spindle_index(int spindle) {
  return static_cast<std::size_t>(spindle) < World::kSpindles ? static_cast<std::size_t>(spindle)
                                                              : 0;
}

}  // namespace

// ---- Units, modes
// -------------------------------------------------------------------------------------

double GET_EXTERNAL_LENGTH_UNITS() { return world().units_per_mm; }
double GET_EXTERNAL_ANGLE_UNITS() { return 1; }
CANON_UNITS GET_EXTERNAL_LENGTH_UNIT_TYPE() { return world().units; }
CANON_PLANE GET_EXTERNAL_PLANE() { return world().plane; }
CANON_MOTION_MODE GET_EXTERNAL_MOTION_CONTROL_MODE() { return world().motion_mode; }
double GET_EXTERNAL_MOTION_CONTROL_TOLERANCE() {
  return world().motion_tolerance_mm / world().unit_mm();
}
double GET_EXTERNAL_MOTION_CONTROL_NAIVECAM_TOLERANCE() {
  return world().naivecam_tolerance_mm / world().unit_mm();
}
double GET_EXTERNAL_FEED_RATE() { return world().feed_mm_per_min / world().unit_mm(); }
double GET_EXTERNAL_TRAVERSE_RATE() { return 0; }
int GET_EXTERNAL_FLOOD() { return world().flood ? 1 : 0; }
int GET_EXTERNAL_MIST() { return world().mist ? 1 : 0; }
double GET_EXTERNAL_SPEED(int spindle) { return world().spindle_speed[spindle_index(spindle)]; }
CANON_DIRECTION GET_EXTERNAL_SPINDLE(int spindle) {
  return world().spindle_direction[spindle_index(spindle)];
}
int GET_EXTERNAL_FEED_OVERRIDE_ENABLE() { return world().feed_override ? 1 : 0; }
int GET_EXTERNAL_SPINDLE_OVERRIDE_ENABLE(int spindle) {
  return world().speed_override[spindle_index(spindle)] ? 1 : 0;
}
int GET_EXTERNAL_ADAPTIVE_FEED_ENABLE() { return world().adaptive_feed ? 1 : 0; }
int GET_EXTERNAL_FEED_HOLD_ENABLE() { return world().feed_hold ? 1 : 0; }
int GET_EXTERNAL_AXIS_MASK() { return world().axis_mask; }
int GET_EXTERNAL_QUEUE_EMPTY() { return 1; }
int GET_EXTERNAL_OFFSET_APPLIED() { return 0; }
EmcPose GET_EXTERNAL_OFFSETS() { return EmcPose{}; }

void SET_BLOCK_DELETE(bool on) { world().block_delete = on; }
bool GET_BLOCK_DELETE() { return world().block_delete; }
void SET_OPTIONAL_PROGRAM_STOP(bool on) { world().optional_stop = on; }
bool GET_OPTIONAL_PROGRAM_STOP() { return world().optional_stop; }

void SET_PARAMETER_FILE_NAME(const char* name) { world().parameter_file = name; }
void GET_EXTERNAL_PARAMETER_FILE_NAME(char* name, int size) {
  if (size > 0) {
    std::snprintf(name, static_cast<std::size_t>(size), "%s", world().parameter_file.c_str());
  }
}

// ---- Positions
// ------------------------------------------------------------------------------------------

double GET_EXTERNAL_POSITION_X() { return world().position(0); }
double GET_EXTERNAL_POSITION_Y() { return world().position(1); }
double GET_EXTERNAL_POSITION_Z() { return world().position(2); }
double GET_EXTERNAL_POSITION_A() { return world().position(3); }
double GET_EXTERNAL_POSITION_B() { return world().position(4); }
double GET_EXTERNAL_POSITION_C() { return world().position(5); }
double GET_EXTERNAL_POSITION_U() { return world().position(6); }
double GET_EXTERNAL_POSITION_V() { return world().position(7); }
double GET_EXTERNAL_POSITION_W() { return world().position(8); }
double GET_EXTERNAL_PROBE_POSITION_X() { return world().probed(0); }
double GET_EXTERNAL_PROBE_POSITION_Y() { return world().probed(1); }
double GET_EXTERNAL_PROBE_POSITION_Z() { return world().probed(2); }
double GET_EXTERNAL_PROBE_POSITION_A() { return world().probed(3); }
double GET_EXTERNAL_PROBE_POSITION_B() { return world().probed(4); }
double GET_EXTERNAL_PROBE_POSITION_C() { return world().probed(5); }
double GET_EXTERNAL_PROBE_POSITION_U() { return world().probed(6); }
double GET_EXTERNAL_PROBE_POSITION_V() { return world().probed(7); }
double GET_EXTERNAL_PROBE_POSITION_W() { return world().probed(8); }
double GET_EXTERNAL_PROBE_VALUE() { return 0; }
int GET_EXTERNAL_PROBE_TRIPPED_VALUE() { return world().probe_found() ? 1 : 0; }
double GET_EXTERNAL_TOOL_LENGTH_XOFFSET() { return world().tool_offset(0); }
double GET_EXTERNAL_TOOL_LENGTH_YOFFSET() { return world().tool_offset(1); }
double GET_EXTERNAL_TOOL_LENGTH_ZOFFSET() { return world().tool_offset(2); }
double GET_EXTERNAL_TOOL_LENGTH_AOFFSET() { return world().tool_offset(3); }
double GET_EXTERNAL_TOOL_LENGTH_BOFFSET() { return world().tool_offset(4); }
double GET_EXTERNAL_TOOL_LENGTH_COFFSET() { return world().tool_offset(5); }
double GET_EXTERNAL_TOOL_LENGTH_UOFFSET() { return world().tool_offset(6); }
double GET_EXTERNAL_TOOL_LENGTH_VOFFSET() { return world().tool_offset(7); }
double GET_EXTERNAL_TOOL_LENGTH_WOFFSET() { return world().tool_offset(8); }

/// Inputs read as what the program calls their default.
int GET_EXTERNAL_DIGITAL_INPUT(int, int fallback) { return fallback; }
double GET_EXTERNAL_ANALOG_INPUT(int, double fallback) { return fallback; }

// ---- Tools
// ------------------------------------------------------------------------------------------------

int GET_EXTERNAL_TOOL_SLOT() { return world().loaded_row(); }
int GET_EXTERNAL_SELECTED_TOOL_SLOT() { return 0; }
CANON_TOOL_TABLE GET_EXTERNAL_TOOL_TABLE(int index) { return world().row(index); }
int GET_EXTERNAL_TC_FAULT() { return 0; }
int GET_EXTERNAL_TC_REASON() { return 0; }

CANON_TOOL_TABLE tooldata_entry_init();
int tooldata_get(CANON_TOOL_TABLE* tool, int index);
int tooldata_find_index_for_tool(int number);

CANON_TOOL_TABLE tooldata_entry_init() { return kerf::interp::empty_tool(); }
int tooldata_get(CANON_TOOL_TABLE* tool, int index) {
  *tool = world().row(index);
  return 0;  // IDX_OK
}
int tooldata_find_index_for_tool(int number) { return world().row_of_tool(number); }
