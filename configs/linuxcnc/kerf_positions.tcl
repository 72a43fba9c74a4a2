# kerf_positions.tcl - the positions of this machine as Modbus registers, by LinuxCNC's own ClassicLadder.
#
# In the INI, as the last of all HAL files (README.md beside this file):
#
#   [HAL]
#   HALFILE = kerf_positions.tcl
#
# It only reads: no pin of the machine is written, no signal of the machine gets another source. A pin that already is in a
# signal is read from that signal; one that is not yet gets a signal named kerf-...
#
# Optional, in the INI:
#   [KERF]
#   JOINTS = 0 1 2           joints of X Y Z; "-" for an axis that the machine has not
#   UM_PER_UNIT = 1000       0.001 mm per unit of a joint: 25400 where joints count inches
#   THREAD = servo-thread
#   PORT = 1502              of Modbus TCP
#   DISPLAY = virtual        where ClassicLadder's window lives: virtual (Xvfb) or desktop (yours, window hidden)

namespace eval kerf {
  variable folder [file normalize [file dirname [info script]]]

  # Which component multiplies, in this order: a realtime component can be loaded only once, and a machine may have some
  # of them already. Columns: component, names, input, output, factor, what else must be set.
  variable multipliers {
    scale {in out gain {}}
    sum2  {in0 out gain0 {gain1 0}}
    mult2 {in0 out in1 {}}
  }
}

proc kerf::fail {text} {
  puts stderr "kerf_positions.tcl: $text"
  exit 1
}

# A value of the INI; `fallback` where it is absent. haltcl has each section as an array.
proc kerf::ini {section item fallback} {
  upvar #0 $section values
  if {[info exists values($item)]} { return [string trim [lindex $values($item) end]] }
  return $fallback
}

# As `ini`, of an item that may hold several words.
proc kerf::ini_text {section item fallback} {
  upvar #0 $section values
  if {[info exists values($item)]} { return [string trim [join $values($item)]] }
  return $fallback
}

proc kerf::has_pin {pin} { return [expr {[lsearch -exact [hal list pin] $pin] >= 0}] }

# The joints of X, Y and Z. With trivkins joint N moves the N-th letter of its coordinates; of other kinematics nothing is
# known here, and the user has to say.
proc kerf::joints {} {
  set given [ini_text KERF JOINTS {}]
  if {$given ne {}} {
    if {![regexp {^([0-9]+|-)\s+([0-9]+|-)\s+([0-9]+|-)$} $given -> x y z]} {
      fail "\[KERF\]JOINTS: \"$given\" found; must be the joints of X Y Z, as in \"0 1 2\" or \"0 - 1\""
    }
    return [list $x $y $z]
  }
  set kinematics [ini_text KINS KINEMATICS trivkins]
  if {![string match trivkins* $kinematics]} {
    fail "kinematics \"$kinematics\": say in the INI which joints are to be served: \[KERF\]JOINTS = 0 1 2"
  }
  set letters [ini_text TRAJ COORDINATES XYZ]
  regexp -nocase {coordinates=(\w+)} $kinematics -> letters
  set letters [string toupper [string map {{ } {}} $letters]]
  foreach letter {X Y Z} {
    set joint [string first $letter $letters]
    lappend joints [expr {$joint < 0 ? "-" : $joint}]
  }
  return $joints
}

# 0.001 mm per unit of a joint. LINEAR_UNITS is mm, inch (also metric, in, imperial), or units per mm.
proc kerf::um_per_unit {} {
  set given [ini KERF UM_PER_UNIT {}]
  if {$given ne {}} {
    if {![string is double -strict $given] || $given <= 0} {
      fail "\[KERF\]UM_PER_UNIT: \"$given\" found; must be above 0: 1000 for mm, 25400 for inches"
    }
    return $given
  }
  set units [string tolower [ini TRAJ LINEAR_UNITS {}]]
  switch -- $units {
    mm - metric { return 1000.0 }
    in - inch - imperial { return 25400.0 }
  }
  if {[string is double -strict $units] && $units > 0} { return [expr {1000.0 / $units}] }
  fail "\[TRAJ\]LINEAR_UNITS: \"$units\" found; give \[KERF\]UM_PER_UNIT = 1000 (mm) or 25400 (inches)"
}

# The signal that `pin` is in; empty if it is in none. The last word of its line in the list of pins, behind ==> or <==.
proc kerf::signal_of {pin} {
  foreach line [split [exec halcmd -s show pin $pin] \n] {
    if {[lsearch -exact $line $pin] >= 0 && [regexp {(?:==>|<==)\s+(\S+)} $line -> signal]} { return $signal }
  }
  return {}
}

# `reader` gets the value of `pin`, whether or not a signal takes it elsewhere already.
proc kerf::read_pin {pin reader} {
  if {![has_pin $pin]} { fail "this LinuxCNC has no pin $pin" }
  set signal [signal_of $pin]
  if {$signal eq {}} {
    set signal "kerf-[string map {. -} $pin]"
    hal net $signal $pin
  }
  hal net $signal $reader
}

# `pin` times `factor` into `reader`, by multiplier number `n` of those named in `names`.
proc kerf::read_scaled {pin factor name reader} {
  variable chosen
  lassign $chosen in out gain others
  foreach {parameter value} $others { hal setp $name.$parameter $value }
  hal setp $name.$gain $factor
  read_pin $pin $name.$in
  hal net $name $name.$out $reader
}

proc kerf::load_multipliers {names} {
  variable multipliers
  variable chosen
  set loaded [hal list comp]
  foreach {component pins} $multipliers {
    if {[lsearch -exact $loaded $component] >= 0} { continue }
    hal loadrt $component names=[join $names ,]
    set chosen $pins
    return
  }
  set text "the components [join [dict keys $multipliers] {, }] are all loaded already, and each can be loaded only once; "
  append text "positions cannot be scaled"
  fail $text
}

proc kerf::serve {} {
  variable folder
  if {[lsearch -exact [hal list comp] classicladder_rt] >= 0} {
    fail "this machine runs ClassicLadder already, and it can run only once; README.md says how both go together"
  }
  set thread [ini KERF THREAD servo-thread]
  set port [ini KERF PORT 1502]
  set display [ini KERF DISPLAY virtual]
  set joints [joints]
  set um [um_per_unit]

  set scaled {}
  foreach letter {x y z} joint $joints reader {00 01 02} {
    if {$joint ne "-"} { lappend scaled joint.$joint.pos-fb kerf-um-$letter classicladder.0.floatin-$reader }
  }
  lappend scaled motion.tooloffset.z kerf-um-tool classicladder.0.floatin-03
  foreach {pin name reader} $scaled { lappend names $name }

  # Sizes that hold kerf_positions.clp: register N is word N+1, and requests end below numWords-1.
  set sizes {
    numRungs=4 numBits=20 numWords=40 numTimers=2 numMonostables=2 numCounters=2 numPhysInputs=2 numPhysOutputs=2
    numArithmExpr=20 numSections=2 numSymbols=10 numS32in=2 numS32out=1 numFloatIn=5 numFloatOut=1
  }
  hal loadrt classicladder_rt {*}$sizes
  load_multipliers $names

  foreach {pin name reader} $scaled {
    read_scaled $pin $um $name $reader
    hal addf $name $thread
  }
  read_pin iocontrol.0.tool-number classicladder.0.s32in-00
  read_pin motion.program-line classicladder.0.s32in-01
  if {[has_pin spindle.0.speed-out]} { read_pin spindle.0.speed-out classicladder.0.floatin-04 }
  hal net kerf-scan classicladder.0.s32out-00
  hal setp classicladder.0.hide_gui 1
  # Behind everything else of the thread: positions, tool and line of one register image are of one servo cycle.
  hal addf classicladder.0.refresh $thread

  # Not waited for: the machine must start although its observer cannot.
  hal loadusr [file join $folder kerf_ladder] $display $port
}

# With [HAL]TWOPASS all files are read twice; there is something to connect to only the second time. It also reads a copy in
# another folder of files with lines that end in a backslash: there must be none here.
if {![llength [info procs ::tp::passnumber]] || [::tp::passnumber] != 0} { kerf::serve }
