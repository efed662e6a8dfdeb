# SPDX-License-Identifier: MIT
# Compiler options shared by every target of the project.
option(DEBURR_WERROR "Treat warnings as errors (on in CI)" OFF)
option(DEBURR_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
option(DEBURR_FUZZ "Build the fuzzers (clang with libFuzzer)" OFF)
option(DEBURR_COVERAGE "Build with gcov line coverage" OFF)
option(DEBURR_PROGRAM "Build the command `deburr`; OFF: the libraries alone, and no tests" ON)
option(DEBURR_PYTHON "Build the Python module, where pybind11 and numpy are installed" ON)
set(DEBURR_PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that the module is for")
option(DEBURR_HDL "Build the units of hdl/ (SystemVerilog) with Verilator, beside the model; needs BUILD_TESTING" OFF)
option(BUILD_SHARED_LIBS "Install shared libraries" OFF)
option(DEBURR_UNITY "Compile sources in batches: a third of the time, but no file stands alone" ON)

if(BUILD_SHARED_LIBS)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()

add_library(deburr_options INTERFACE)
target_compile_features(deburr_options INTERFACE cxx_std_20)
# -ffp-contract=off: the same source gives the same double on every machine.
target_compile_options(deburr_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off
  # Clang's -Wconversion includes this warning, GCC's does not.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>
  $<$<BOOL:${DEBURR_WERROR}>:-Werror>)
if(DEBURR_SANITIZE)
  target_compile_options(deburr_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Addresses fixed by the linker: a test program starts in two thirds of the time. LLD links in a third of the time.
  target_link_options(deburr_options INTERFACE -fsanitize=address,undefined
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie> $<$<CXX_COMPILER_ID:Clang>:-fuse-ld=lld>)
  # ctest reads this before it starts a test.
  set(DEBURR_LSAN_OPTIONS "suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp:print_suppressions=0")
  file(WRITE "${PROJECT_BINARY_DIR}/sanitizers.cmake" "set(ENV{LSAN_OPTIONS} \"${DEBURR_LSAN_OPTIONS}\")\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${PROJECT_BINARY_DIR}/sanitizers.cmake")
endif()
if(DEBURR_FUZZ)
  target_compile_options(deburr_options INTERFACE
    -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(deburr_options INTERFACE -fsanitize=address,undefined)
endif()
if(DEBURR_COVERAGE)
  target_compile_options(deburr_options INTERFACE --coverage)
  # tb/base/forked.h calls it if it exists.
  target_link_options(deburr_options INTERFACE --coverage -Wl,--undefined=__gcov_dump)
endif()

# Unit tests run once per build, and code that only starts simulations and shows results takes a small part of a run:
# -O1 compiles in two thirds of the time of -O3, -Og in four fifths of that.
add_library(deburr_light_options INTERFACE)
set(DEBURR_LIGHT_OPTIONS $<$<CONFIG:Release>:-Og>)
target_compile_options(deburr_light_options INTERFACE ${DEBURR_LIGHT_OPTIONS})

# Code that delegates its work to models and environments. With sanitizers -O0 compiles in less than half the time of
# -O1; for a model, and for the random configurations of tool/run, -O0 would quadruple the run time.
add_library(deburr_lightest_options INTERFACE)
target_link_libraries(deburr_lightest_options INTERFACE deburr_light_options)
if(DEBURR_SANITIZE)
  target_compile_options(deburr_lightest_options INTERFACE -O0)
endif()

# GCC collects garbage whenever its heap has doubled, from 128 MiB on. This takes a tenth of its time for a batch of
# tb/; starting at 512 MiB costs up to 0.25 GB more memory. Objects are identical.
target_compile_options(deburr_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()
