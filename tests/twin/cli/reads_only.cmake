# kerf holds no call that writes to a device: nothing of libmodbus that writes or answers. It does send: requests to read
# (machine_io/modbus/modbus_tcp_link.cpp, whose function codes are 3 and 4; its tests look at the wire). What sends on a CAN
# socket is looked for in tests/machine_io/can.
#   cmake -D NM=nm -D KERF=path/to/kerf -P reads_only.cmake
execute_process(COMMAND ${NM} -D --undefined-only ${KERF} OUTPUT_VARIABLE imported RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "nm failed")
endif()
if(NOT imported MATCHES "modbus_read_registers")
  message(FATAL_ERROR "kerf does not even read Modbus: this test looks at the wrong file")
endif()
string(REGEX MATCHALL "[ \n](modbus_(write|mask_write|send_raw|reply|receive_from|mapping)[a-z_]*|sendto|sendmsg|sendmmsg)[@\n]" found "${imported}")
if(found)
  message(FATAL_ERROR "kerf imports what could write to a machine: ${found}")
endif()
message("kerf imports nothing that could write to a machine")
