# Toolchain for a Debian that compiles for arm64 (crossbuild-essential-arm64), with arm64's libraries in a folder of their own:
#     cmake -D CMAKE_TOOLCHAIN_FILE=cmake/arm64.cmake -D KERF_ARM64_ROOT=/arm64 ..
# scripts/check_platforms makes that folder. With qemu-user-static, what was built runs here.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

# CMake reads this file again for each compiler test, which knows no more than what it is told to hand on.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES KERF_ARM64_ROOT)
set(CMAKE_SYSROOT ${KERF_ARM64_ROOT})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L ${KERF_ARM64_ROOT})

# Programs are this computer's, the rest arm64's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${KERF_ARM64_ROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${KERF_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${KERF_ARM64_ROOT}/usr/share/pkgconfig)
