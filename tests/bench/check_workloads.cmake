# cmake -DPROGRAM=kerf_workloads -DFOLDER=DIR -P check_workloads.cmake: writes every workload, compares SHA-256.

set(w2_finish_100k 0ffbbe36cdca65fa7257db3fbc30489bf05273a12500e3dce89aae391691461b)
set(w2_finish_1m c0ad301593a643dd86c573fedf424b48b50f089869f674086e6b220e959233f3)
set(w3_trochoid d5903ceadccf1a04179aee5578217f8abfb94ae0ea849519a21f69e5a47ae1b7)

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${PROGRAM} ${FOLDER} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} ${FOLDER} ended with ${result}")
endif()
foreach(name w2_finish_100k w2_finish_1m w3_trochoid)
  file(SHA256 ${FOLDER}/${name}.ngc found)
  if(NOT found STREQUAL ${name})
    message(SEND_ERROR "${name}.ngc: SHA-256 is ${found}, should be ${${name}}")
  endif()
endforeach()
file(REMOVE_RECURSE ${FOLDER})
