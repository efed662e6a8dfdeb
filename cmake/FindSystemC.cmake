# SPDX-License-Identifier: MIT
# FindSystemC: finds Accellera SystemC and gives the target SystemC::systemc.
#
# SystemC bakes the C++ baseline that it was built for into a symbol name
# (sc_api_version_2_3_4_cxx201703L), and a program compiled for another baseline does not link unless
# SC_CPLUSPLUS is set to the library's. Which baseline that is differs between packages, so it is
# probed by linking, and the definition is put on the imported target.
#
# SystemC 3.0 and later install a CMake package of their own (SystemCLanguage); it is preferred.
#
# It is installed with Deburr's CMake package, whose user needs the same SC_CPLUSPLUS. Why nothing was found
# is in SystemC_NOT_FOUND_MESSAGE.

find_package(SystemCLanguage CONFIG QUIET)
if(SystemCLanguage_FOUND)
  set(SystemC_VERSION "${SystemCLanguage_VERSION}")
  if(NOT TARGET SystemC::systemc)
    message(FATAL_ERROR "SystemCLanguage was found but defines no target SystemC::systemc.")
  endif()
  set(SystemC_FOUND TRUE)
  return()
endif()

find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PC_SystemC QUIET systemc)
endif()
find_path(SystemC_INCLUDE_DIR NAMES systemc tlm
          HINTS ${PC_SystemC_INCLUDEDIR} ENV SYSTEMC_HOME PATH_SUFFIXES include)
find_library(SystemC_LIBRARY NAMES systemc
             HINTS ${PC_SystemC_LIBDIR} ENV SYSTEMC_HOME PATH_SUFFIXES lib lib64 lib-linux64)
set(SystemC_VERSION "${PC_SystemC_VERSION}")

if(SystemC_INCLUDE_DIR AND SystemC_LIBRARY AND NOT DEFINED SystemC_BASELINE)
  include(CheckCXXSourceCompiles)
  set(_probe "#include <systemc>\nint sc_main(int, char**) { return sc_core::sc_delta_count() != 0; }")
  foreach(_baseline native 201703L 201402L 201103L 202002L)
    set(CMAKE_REQUIRED_INCLUDES "${SystemC_INCLUDE_DIR}")
    set(CMAKE_REQUIRED_LIBRARIES "${SystemC_LIBRARY}")
    # Not a flag: with CMAKE_CXX_EXTENSIONS off, CMake would put its own -std= behind it.
    set(CMAKE_CXX_STANDARD 20)
    set(CMAKE_REQUIRED_DEFINITIONS "")
    if(NOT _baseline STREQUAL "native")
      set(CMAKE_REQUIRED_DEFINITIONS "-DSC_CPLUSPLUS=${_baseline}")
    endif()
    set(CMAKE_REQUIRED_QUIET TRUE)
    check_cxx_source_compiles("${_probe}" SystemC_LINKS_AS_CXX_${_baseline})
    if(SystemC_LINKS_AS_CXX_${_baseline})
      set(SystemC_BASELINE "${_baseline}" CACHE INTERNAL "C++ baseline of the SystemC library")
      break()
    endif()
  endforeach()
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
  unset(CMAKE_CXX_STANDARD)
  unset(CMAKE_REQUIRED_DEFINITIONS)
  unset(CMAKE_REQUIRED_QUIET)
endif()

unset(SystemC_NOT_FOUND_MESSAGE)
if(NOT SystemC_INCLUDE_DIR OR NOT SystemC_LIBRARY)
  set(SystemC_NOT_FOUND_MESSAGE "SystemC was not found: install Debian's package libsystemc-dev, or set SYSTEMC_HOME to an installation of SystemC 2.3.3 or later.")
elseif(NOT SystemC_BASELINE)
  set(SystemC_NOT_FOUND_MESSAGE "SystemC was found at ${SystemC_LIBRARY}, but a C++20 program links with it under no baseline of C++11, 14, 17 or 20: rebuild it with -std=c++17 or later (and look at CMakeFiles/CMakeError.log for the linker's words).")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SystemC
  REQUIRED_VARS SystemC_LIBRARY SystemC_INCLUDE_DIR SystemC_BASELINE
  VERSION_VAR SystemC_VERSION
  REASON_FAILURE_MESSAGE "${SystemC_NOT_FOUND_MESSAGE}")

if(SystemC_FOUND AND NOT TARGET SystemC::systemc)
  add_library(SystemC::systemc UNKNOWN IMPORTED)
  set_target_properties(SystemC::systemc PROPERTIES
    IMPORTED_LOCATION "${SystemC_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SystemC_INCLUDE_DIR}")
  if(NOT SystemC_BASELINE STREQUAL "native")
    set_property(TARGET SystemC::systemc APPEND PROPERTY
      INTERFACE_COMPILE_DEFINITIONS "SC_CPLUSPLUS=${SystemC_BASELINE}")
  endif()
endif()
mark_as_advanced(SystemC_INCLUDE_DIR SystemC_LIBRARY)
