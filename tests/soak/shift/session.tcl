# The last HALFILE of run_shift's LinuxCNC: its positions by Modbus. An X server, which ClassicLadder's window needs, wants its
# folder to be root's or its own.
exec sh -c {mkdir -p /tmp/.X11-unix && mount -t tmpfs -o mode=1777 tmpfs /tmp/.X11-unix}
source [file join [file dirname [info script]] kerf_positions.tcl]
