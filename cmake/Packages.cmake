# SPDX-License-Identifier: MIT
# What the build needs from elsewhere. A package that is missing is an error that names the section of
# scripts/packages.txt which brings it.

set(DEBURR_PACKAGES_LIST "${CMAKE_CURRENT_LIST_DIR}/../scripts/packages.txt")

# deburr_missing(<what> <Debian package> [<more to do>...]): the configuration ends here.
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

# deburr_find_package(<name> <Debian package> [<argument of find_package>...]): it has to be there.
macro(deburr_find_package name package)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    deburr_missing(${name} ${package} ${${name}_NOT_FOUND_MESSAGE})
  endif()
endmacro()

# deburr_find(<program|path|file|library> <variable> <Debian package> <argument of find_program and its like>...)
macro(deburr_find kind variable package)
  cmake_language(CALL find_${kind} ${variable} ${ARGN})
  if(NOT ${variable})
    deburr_missing(${variable} ${package})
  endif()
endmacro()

# deburr_find_compiler(): before project(), whose own words do not say what brings the compiler.
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

# deburr_missing_module(<what> <Debian package> <consequence>): what a module of the command is made of. The command
# says so when it needs the module; tests need all.
function(deburr_missing_module what package consequence)
  if(BUILD_TESTING)
    deburr_missing(${what} ${package} "Or configure with -DBUILD_TESTING=OFF: then ${consequence}.")
  endif()
  message(STATUS "No ${what} (scripts/install modules): ${consequence}")
endfunction()
