# SPDX-License-Identifier: MIT
# FindSystemC: finds Accellera SystemC and defines the target SystemC::systemc.
#
# SystemC encodes the C++ standard it was built for in a symbol name (sc_api_version_2_3_4_cxx201703L). A program
# compiled for another standard links only if SC_CPLUSPLUS is set to the library's value. The value differs between
# packages, so it is probed by linking, and the definition is set on the target.
#
# SystemC 3.0 and later install their own CMake package (SystemCLanguage), which is preferred. SystemC_ROOT, a variable
# of CMake or of the environment, or SYSTEMC_HOME of the environment, is the prefix of the only SystemC that is accepted.
#
# This module is installed with Deburr's CMake package, whose users need the same SC_CPLUSPLUS. If nothing was found,
# SystemC_NOT_FOUND_MESSAGE holds the reason.

# The caller's policies apply here: below 3.8 the probe would be compiled for another standard than the program.
# find_package restores them.
cmake_policy(VERSION 3.16...3.25)

unset(SystemC_NOT_FOUND_MESSAGE)
set(_systemc_oldest 2.3.3)
set(_systemc_help "Install Debian's package libsystemc-dev, or set SystemC_ROOT or SYSTEMC_HOME to an installation of SystemC ${_systemc_oldest} or later, or add the place of a CMake package of SystemC 3.0 to CMAKE_PREFIX_PATH.")

set(_systemc_root "")
foreach(_systemc_given "${SystemC_ROOT}" "$ENV{SystemC_ROOT}" "$ENV{SYSTEMC_HOME}")
  if(NOT _systemc_root)
    set(_systemc_root "${_systemc_given}")
  endif()
endforeach()
set(_systemc_only "")
if(_systemc_root)
  get_filename_component(_systemc_root "${_systemc_root}" ABSOLUTE)
  # What an earlier configuration found elsewhere.
  foreach(_systemc_found SystemCLanguage_DIR SystemC_INCLUDE_DIR SystemC_LIBRARY)
    cmake_path(IS_PREFIX _systemc_root "${${_systemc_found}}" NORMALIZE _systemc_inside)
    if(NOT _systemc_inside)
      unset(${_systemc_found} CACHE)
    endif()
  endforeach()
  set(_systemc_only PATHS "${_systemc_root}" NO_DEFAULT_PATH)
endif()

unset(PC_SystemC_FOUND)
find_package(SystemCLanguage CONFIG QUIET ${_systemc_only})
if(SystemCLanguage_FOUND)
  set(SystemC_VERSION "${SystemCLanguage_VERSION}")
  set(_systemc_place "${SystemCLanguage_DIR}")
  set(_systemc_required SystemCLanguage_DIR SystemC_BASELINE)
  if(TARGET SystemC::systemc)
    set(_systemc_libraries SystemC::systemc)
    set(_systemc_includes "")
  else()
    set(_systemc_libraries "")
    set(SystemC_NOT_FOUND_MESSAGE "The CMake package of SystemC at ${SystemCLanguage_DIR} defines no target SystemC::systemc: install SystemC again, or configure with -DCMAKE_DISABLE_FIND_PACKAGE_SystemCLanguage=ON to do without that package.")
  endif()
else()
  find_package(PkgConfig QUIET)
  if(PkgConfig_FOUND AND NOT _systemc_root)
    pkg_check_modules(PC_SystemC QUIET systemc)
  endif()
  find_path(SystemC_INCLUDE_DIR NAMES systemc tlm
            HINTS ${PC_SystemC_INCLUDEDIR} ${_systemc_only} PATH_SUFFIXES include)
  find_library(SystemC_LIBRARY NAMES systemc
               HINTS ${PC_SystemC_LIBDIR} ${_systemc_only}
               PATH_SUFFIXES lib lib64 lib-linux64 lib/${CMAKE_LIBRARY_ARCHITECTURE})
  set(SystemC_VERSION "")
  if(EXISTS "${SystemC_INCLUDE_DIR}/sysc/kernel/sc_ver.h")
    file(STRINGS "${SystemC_INCLUDE_DIR}/sysc/kernel/sc_ver.h" _systemc_numbers
         REGEX "^#define SC_VERSION_(MAJOR|MINOR|PATCH) +[0-9]+")
    list(TRANSFORM _systemc_numbers REPLACE ".* ([0-9]+).*" "\\1")
    string(JOIN "." SystemC_VERSION ${_systemc_numbers})
  endif()
  set(_systemc_place "${SystemC_LIBRARY}")
  set(_systemc_required SystemC_LIBRARY SystemC_INCLUDE_DIR SystemC_BASELINE)
  set(_systemc_libraries "${SystemC_LIBRARY}")
  set(_systemc_includes "${SystemC_INCLUDE_DIR}")
  if(NOT SystemC_INCLUDE_DIR OR NOT SystemC_LIBRARY)
    set(_systemc_libraries "")
    set(SystemC_NOT_FOUND_MESSAGE "SystemC was not found. ${_systemc_help}")
  endif()
  mark_as_advanced(SystemC_INCLUDE_DIR SystemC_LIBRARY)
endif()
if(_systemc_root AND NOT SystemCLanguage_FOUND)
  cmake_path(IS_PREFIX _systemc_root "${_systemc_place}" NORMALIZE _systemc_inside)
  if(NOT _systemc_libraries OR NOT _systemc_inside)
    set(_systemc_libraries "")
    set(SystemC_NOT_FOUND_MESSAGE "There is no SystemC in ${_systemc_root} (SystemC_ROOT or SYSTEMC_HOME): it needs lib/cmake/SystemCLanguage, or include/systemc and a library in lib, lib64 or lib-linux64.")
  endif()
endif()
if(_systemc_libraries AND SystemC_VERSION AND SystemC_VERSION VERSION_LESS _systemc_oldest)
  set(_systemc_libraries "")
  set(SystemC_NOT_FOUND_MESSAGE "SystemC ${SystemC_VERSION} at ${_systemc_place} is too old. ${_systemc_help}")
endif()
if(_systemc_libraries AND NOT CMAKE_CXX_COMPILER_LOADED)
  set(_systemc_libraries "")
  set(SystemC_NOT_FOUND_MESSAGE "SystemC needs the language C++, which this project has not: project(... LANGUAGES CXX).")
endif()

# A function, so that its variables do not leak into the calling project.
function(_systemc_probe)
  set(baselines native 201703L 201402L 201103L 202002L)
  set(probed "${_systemc_libraries} ${_systemc_place}")
  if(NOT "${SystemC_PROBED}" STREQUAL probed)  # perhaps another library
    unset(SystemC_BASELINE CACHE)
    foreach(baseline IN LISTS baselines)
      unset(SystemC_LINKS_AS_CXX_${baseline} CACHE)
    endforeach()
  endif()
  if(NOT _systemc_libraries OR SystemC_BASELINE)
    return()
  endif()
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_INCLUDES "${_systemc_includes}")
  set(CMAKE_REQUIRED_LIBRARIES "${_systemc_libraries}")
  # Not a compile option: with CMAKE_CXX_EXTENSIONS off, CMake would append its own -std=.
  set(CMAKE_CXX_STANDARD 20)
  set(CMAKE_REQUIRED_QUIET TRUE)
  foreach(baseline IN LISTS baselines)
    set(CMAKE_REQUIRED_DEFINITIONS "")
    if(NOT baseline STREQUAL "native")
      set(CMAKE_REQUIRED_DEFINITIONS "-DSC_CPLUSPLUS=${baseline}")
    endif()
    check_cxx_source_compiles(
      "#include <systemc>\nint sc_main(int, char**) { return sc_core::sc_delta_count() != 0; }"
      SystemC_LINKS_AS_CXX_${baseline})
    if(SystemC_LINKS_AS_CXX_${baseline})
      set(SystemC_BASELINE "${baseline}" CACHE INTERNAL "C++ baseline of the SystemC library")
      break()
    endif()
  endforeach()
  set(SystemC_PROBED "${probed}" CACHE INTERNAL "The library that SystemC_BASELINE is of")
endfunction()
_systemc_probe()
if(_systemc_libraries AND NOT SystemC_BASELINE)
  set(SystemC_NOT_FOUND_MESSAGE "SystemC was found at ${_systemc_place}, but a C++20 program links with it under no baseline of C++11, 14, 17 or 20: rebuild it with -std=c++17 or later (and look at CMakeFiles/CMakeError.log for the linker's words).")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SystemC
  REQUIRED_VARS ${_systemc_required}
  VERSION_VAR SystemC_VERSION
  REASON_FAILURE_MESSAGE "${SystemC_NOT_FOUND_MESSAGE}")

if(SystemC_FOUND AND NOT TARGET SystemC::systemc)
  add_library(SystemC::systemc UNKNOWN IMPORTED)
  set_target_properties(SystemC::systemc PROPERTIES
    IMPORTED_LOCATION "${SystemC_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SystemC_INCLUDE_DIR}")
endif()
if(SystemC_FOUND AND NOT SystemC_BASELINE STREQUAL "native")
  get_target_property(_systemc_definitions SystemC::systemc INTERFACE_COMPILE_DEFINITIONS)
  if(NOT "SC_CPLUSPLUS=${SystemC_BASELINE}" IN_LIST _systemc_definitions)
    set_property(TARGET SystemC::systemc APPEND PROPERTY
      INTERFACE_COMPILE_DEFINITIONS "SC_CPLUSPLUS=${SystemC_BASELINE}")
  endif()
endif()
