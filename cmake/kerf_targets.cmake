# One place for what every target of kerf shares: warnings, floating-point rules, sanitizers.

find_package(Threads REQUIRED)

# For who works on kerf (the presets for that have it on): another compiler's new warning is no reason not to build.
option(KERF_WERROR "Warnings are errors" OFF)

add_library(kerf_options INTERFACE)
target_compile_options(kerf_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
  "$<$<BOOL:${KERF_WERROR}>:-Werror>"
  # Equal bits on every host: a*b+c is rounded twice unless the source says fma.
  -ffp-contract=off)
# Of std::string's and std::sort's own code, optimised as far as in Release, g++ 12 warns falsely (its bug 105651).
target_compile_options(kerf_options INTERFACE
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release,None>>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")
target_include_directories(kerf_options INTERFACE ${PROJECT_SOURCE_DIR})
target_link_libraries(kerf_options INTERFACE Threads::Threads)
if(KERF_SANITIZE)
  target_compile_options(kerf_options INTERFACE -fsanitize=${KERF_SANITIZE}
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(kerf_options INTERFACE -fsanitize=${KERF_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ warns falsely under its sanitizers (its manual says so): std::regex alone makes a dozen.
    target_compile_options(kerf_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# Linked by what draws: see its source.
add_library(kerf_driver_leaks INTERFACE)
if(KERF_SANITIZE MATCHES "address")
  add_library(kerf_driver_leaks_object STATIC ${CMAKE_CURRENT_LIST_DIR}/driver_leaks.cpp)
  target_link_libraries(kerf_driver_leaks INTERFACE kerf_driver_leaks_object)
  target_link_options(kerf_driver_leaks INTERFACE LINKER:-u,__lsan_is_turned_off)
endif()

# What compiling costs is above all reading headers: those that nearly all sources need are read once for the libraries and
# once for the tests, and a library's sources are compiled some at a time. The preset `plain` does neither: there each source
# has to include what it uses. g++ 12 warns falsely of strings that it inlines from a precompiled header.
option(KERF_QUICK_BUILD "Precompiled headers, and several sources at a time" ON)
if(KERF_QUICK_BUILD)
  file(CONFIGURE OUTPUT kerf_headers.cpp CONTENT "")
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(KERF_FALSE_WARNINGS -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
  # Of a source that is compiled with others, which it takes for a header.
  list(APPEND KERF_FALSE_WARNINGS -Wno-subobject-linkage)
endif()

# kerf_share_headers(name SHARED LINK library OPTIONS ... HEADERS ...): HEADERS are read once, by SHARED, for all that share
# them, with the same OPTIONS.
function(kerf_share_headers name shared)
  cmake_parse_arguments(ARG "" "LINK" "OPTIONS;HEADERS" ${ARGN})
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  if(NOT TARGET ${shared})
    add_library(${shared} OBJECT ${PROJECT_BINARY_DIR}/kerf_headers.cpp)
    target_link_libraries(${shared} PRIVATE kerf_options ${ARG_LINK})
    target_compile_options(${shared} PRIVATE ${ARG_OPTIONS})
    target_precompile_headers(${shared} PRIVATE ${ARG_HEADERS})
  endif()
  target_precompile_headers(${name} REUSE_FROM ${shared})
endfunction()

# kerf_add_library(name SOURCES ... LINK ...): a static library with the project's options.
function(kerf_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC kerf_options ${ARG_LINK})
  if(KERF_QUICK_BUILD)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    kerf_share_headers(${name} kerf_headers LINK fmt::fmt OPTIONS ${KERF_FALSE_WARNINGS} HEADERS
      <algorithm> <array> <chrono> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <string> <string_view>
      <variant> <vector> <fmt/format.h> <glm/common.hpp> <glm/geometric.hpp> <glm/mat4x4.hpp> <glm/matrix.hpp>
      <glm/vec2.hpp> <glm/vec3.hpp> <glm/vec4.hpp>)
  endif()
endfunction()

# kerf_set_kernel_options(SOURCES ... OPTIONS ...): of sources whose speed goes by them. A precompiled header is of no use
# to what is compiled with other options.
function(kerf_set_kernel_options)
  cmake_parse_arguments(ARG "" "" "SOURCES;OPTIONS" ${ARGN})
  set_property(SOURCE ${ARG_SOURCES} APPEND PROPERTY COMPILE_OPTIONS ${ARG_OPTIONS})
  set_property(SOURCE ${ARG_SOURCES} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# Tests are optimised little, and say themselves where they failed: what sanitizers find is mostly in libraries. Some sources
# are compiled at a time.
function(kerf_compile_quickly name)
  if(NOT KERF_QUICK_BUILD)
    return()
  endif()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
  set(options -O1 -g0 ${KERF_FALSE_WARNINGS})
  kerf_share_headers(${name} kerf_test_headers LINK GTest::gtest OPTIONS ${options}
    HEADERS <gtest/gtest.h> <string> <vector>)
endfunction()

# kerf_add_test(name SOURCES ... APART ... LINK ... [ALONE | TIMED]): one gtest executable, each TEST a ctest. Some sources are
# compiled at a time; those of APART each by itself, since they have names of their own that others have as well. ALONE: they
# measure times of processes that give way to others; nothing else is run beside them. TIMED: they mostly wait, and go by a
# clock; of three tests at a time they count as two, and they are begun first (COST), that others have the processor while they
# wait.
function(kerf_add_test name)
  cmake_parse_arguments(ARG "ALONE;TIMED" "" "SOURCES;APART;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES} ${ARG_APART})
  target_link_libraries(${name} PRIVATE kerf_options ${ARG_LINK} GTest::gtest GTest::gtest_main)
  set_source_files_properties(${ARG_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  kerf_compile_quickly(${name})
  set(properties TIMEOUT 300)
  if(ARG_ALONE)
    list(APPEND properties RUN_SERIAL TRUE)
  elseif(ARG_TIMED AND NOT KERF_SANITIZE)
    list(APPEND properties PROCESSORS 2 COST 100)
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
endfunction()
