#!/usr/bin/python3
"""make_ladder.py >kerf_positions.clp: the ladder that puts HAL pins into Modbus registers.

ClassicLadder shows its words %W over Modbus, register N as %W(N+1), 16 bits of each; HAL pins are other variables (%IW for
s32, %IF for float, whose fraction is cut off). So each register is one assignment, made in every scan. Run this again to
serve more or other registers, and keep the table of README.md in step.
"""

# Kinds of variables, as a .clp file numbers them.
WORD, S32_IN, S32_OUT, FLOAT_IN = 200, 270, 280, 300

RUNG_ROWS = 6  # rows of a rung; each holds one assignment
RUNG_COLUMNS = 10
LONGEST_EXPRESSION = 49  # characters that ClassicLadder keeps

# First register, its source, how many registers. The inputs are connected by kerf_positions.tcl.
LAYOUT = (
    (0, (FLOAT_IN, 0), 2),  # X, 0.001 mm
    (2, (FLOAT_IN, 1), 2),  # Y
    (4, (FLOAT_IN, 2), 2),  # Z
    (6, (S32_IN, 0), 1),  # tool number
    (7, (S32_IN, 1), 1),  # program line, modulo 65536
    (9, (FLOAT_IN, 3), 2),  # tool offset Z, 0.001 mm
    (11, (FLOAT_IN, 4), 2),  # spindle, rpm
    (13, (S32_IN, 1), 2),  # program line
)
# The scan counter: one up with each scan, the same in both. The one is written after all other registers, the other
# before: where they differ, an answer was made while the ladder was writing, and holds something of two scans.
SCAN_REGISTER, SCAN_BEGUN_REGISTER = 8, 15


def variable(kind, number):
    return f"@{kind}/{number}@"


def register(number):
    return variable(WORD, number + 1)


def assignments():
    """One text for each, in the order in which they are made."""
    yield f"{register(SCAN_BEGUN_REGISTER)}:=({register(SCAN_REGISTER)}+1)&65535"
    # From high registers to low, against the order in which an answer is made: what is new in a mixed answer lies behind
    # what is old, and hardly ever on both sides of SCAN_REGISTER.
    for first, source, count in reversed(LAYOUT):
        value = variable(*source)
        if count == 2:
            # A division cuts off toward zero: without its low word first, a negative number would come out one too high.
            yield f"{register(first + 1)}:=({value}-({value}&65535))/65536"
        yield f"{register(first)}:={value}&65535"
    yield f"{register(SCAN_REGISTER)}:={register(SCAN_BEGUN_REGISTER)}"
    yield f"{variable(S32_OUT, 0)}:={register(SCAN_REGISTER)}"


def row(expression):
    """A line from the left rail to the box of assignment `expression`, which is three columns wide."""
    wire, box_part, box = "9-0-0/0", "99-0-0/0", f"60-0-0/{expression}"
    return " , ".join([wire] * (RUNG_COLUMNS - 3) + [box_part] * 2 + [box])


def rungs(count):
    blank = " , ".join(["0-0-0/0"] * RUNG_COLUMNS)
    total = -(-count // RUNG_ROWS)
    for number in range(total):
        rows = [row(i) for i in range(number * RUNG_ROWS, min((number + 1) * RUNG_ROWS, count))]
        rows += [blank] * (RUNG_ROWS - len(rows))
        after = number + 1 if number + 1 < total else -1
        yield ["#VER=2.0", "#LABEL=", "#COMMENT=", f"#PREVRUNG={number - 1}", f"#NEXTRUNG={after}"] + rows


def files():
    texts = list(assignments())
    for text in texts:
        assert len(text) <= LONGEST_EXPRESSION, text
    last_rung = 0
    for number, lines in enumerate(rungs(len(texts))):
        yield f"rung_{number}.csv", lines
        last_rung = number
    yield "modbusioconf.csv", ["#VER=1.0"]
    yield "com_params.txt", [
        "MODBUS_MASTER_SERIAL_PORT=",
        "MODBUS_MASTER_SERIAL_SPEED=9600",
        "MODBUS_ELEMENT_OFFSET=0",
        "MODBUS_DEBUG_LEVEL=0",
    ]
    yield "timers_iec.csv", ["1,0,0"] * 10
    yield "timers.csv", ["1,0"] * 2
    yield "monostables.csv", ["1,0"] * 2
    yield "counters.csv", ["0"] * 2
    yield "sections.csv", ["#VER=1.0", "#NAME000=positions", f"000,0,-1,0,{last_rung},0"]
    yield "arithmetic_expressions.csv", ["#VER=2.0"] + [f"{i:04d},{text}" for i, text in enumerate(texts)]
    for name in ("ioconf.csv", "sequential.csv", "symbols.csv"):
        yield name, ["#VER=1.0"]


def main():
    print("_FILES_CLASSICLADDER")
    for name, lines in files():
        print(f"_FILE-{name}", *lines, f"_/FILE-{name}", sep="\n")
    print("_/FILES_CLASSICLADDER")


main()
