# cmake -D ARCHIVE=FILE -D NM=FILE -P no_write.cmake: fails if the archive can transmit.
execute_process(COMMAND ${NM} --undefined-only ${ARCHIVE}
  OUTPUT_VARIABLE symbols RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR NOT symbols MATCHES "recvmmsg")
  message(FATAL_ERROR "nm says nothing about ${ARCHIVE}")
endif()
if(symbols MATCHES " U (write|writev|pwrite[a-z0-9]*|send|sendto|sendmsg|sendmmsg|sendfile[0-9]*|splice|syscall|io_[a-z_]+)[\n@]")
  message(FATAL_ERROR "${ARCHIVE} calls ${CMAKE_MATCH_1}(): it must not write to a socket")
endif()
