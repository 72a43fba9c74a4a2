# cmake -DSOURCE=FOLDER -DOUTPUT=FILE -P kerf_version.cmake: what `git describe` says of the clone, as a macro in FILE, which
# is touched only where that has changed. Empty where SOURCE is no clone: a source package inside of another clone is none.
set(described "")
find_package(Git QUIET)
if(Git_FOUND AND EXISTS "${SOURCE}/.git")
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --tags --match "v*" --always --dirty
    WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define KERF_GIT_VERSION \"${described}\"\n")
