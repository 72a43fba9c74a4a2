# One place for what every target of kerf shares: warnings, floating-point rules, sanitizers.

find_package(Threads REQUIRED)

add_library(kerf_options INTERFACE)
target_compile_options(kerf_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Werror
  # Equal bits on every host: a*b+c is rounded twice unless the source says fma.
  -ffp-contract=off)
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

# kerf_add_library(name SOURCES ... LINK ...): a static library with the project's options.
function(kerf_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC kerf_options ${ARG_LINK})
endfunction()

# kerf_add_test(name SOURCES ... LINK ...): one gtest executable, each TEST a ctest.
function(kerf_add_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE kerf_options ${ARG_LINK} GTest::gtest GTest::gtest_main)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
