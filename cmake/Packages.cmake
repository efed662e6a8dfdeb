# SPDX-License-Identifier: MIT
# External packages that the build needs. A missing package is an error that names the section of scripts/packages.txt
# to install.

set(DEBURR_PACKAGES_LIST "${CMAKE_CURRENT_LIST_DIR}/../scripts/packages.txt")

# deburr_missing(<what> <Debian package> [<more to do>...]): stops the configuration with an error.
function(deburr_missing what package)
  set(section "")
  file(STRINGS "${DEBURR_PACKAGES_LIST}" lines)
  foreach(line IN LISTS lines)
    if(line MATCHES "^[[]([a-z]+)")
      set(current ${CMAKE_MATCH_1})
    elseif(line STREQUAL package)
      set(section ${current})
    endif()
  endforeach()
  string(JOIN " " more "" ${ARGN})
  message(FATAL_ERROR "${what} was not found: `scripts/install ${section}` installs Debian's package ${package}.${more}")
endfunction()

# deburr_find_package(<name> <Debian package> [<argument of find_package>...]): a required package.
macro(deburr_find_package name package)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    deburr_missing(${name} ${package} ${${name}_NOT_FOUND_MESSAGE})
  endif()
endmacro()

# deburr_find(<program|path|file|library> <variable> <Debian package> <arguments of find_program and similar>...)
macro(deburr_find kind variable package)
  cmake_language(CALL find_${kind} ${variable} ${ARGN})
  if(NOT ${variable})
    deburr_missing(${variable} ${package})
  endif()
endmacro()

# deburr_find_compiler(): runs before project(), whose own message does not say which package has the compiler.
function(deburr_find_compiler)
  set(names c++ g++ clang++)
  if(CMAKE_CXX_COMPILER)
    set(names ${CMAKE_CXX_COMPILER})
  elseif(DEFINED ENV{CXX})
    return()
  endif()
  find_program(compiler NAMES ${names} NO_CACHE)
  if(NOT compiler)
    if(names MATCHES "^[^;]*clang")
      deburr_missing("The compiler ${names}" clang)
    endif()
    deburr_missing("A compiler of C++ (${names})" g++)
  endif()
endfunction()

# deburr_missing_module(<what> <Debian package> <consequence>): a missing dependency of an optional module of the
# command. The command reports it when it needs the module; the tests need all modules.
function(deburr_missing_module what package consequence)
  if(BUILD_TESTING)
    deburr_missing(${what} ${package} "Or configure with -DBUILD_TESTING=OFF: then ${consequence}.")
  endif()
  message(STATUS "No ${what} (scripts/install modules): ${consequence}")
endfunction()
