# SPDX-License-Identifier: MIT
# tb/engines/engines.txt is the only list of engines. This file derives what the build needs from it.

# DEBURR_ENGINES: names of the engines, in order.
set(DEBURR_ENGINE_LIST "${PROJECT_SOURCE_DIR}/tb/engines/engines.txt")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${DEBURR_ENGINE_LIST}")
file(STRINGS "${DEBURR_ENGINE_LIST}" DEBURR_ENGINES REGEX "^[^#]")

# deburr_add_subdirectories_of(<folder> <name>...): adds the subfolders with these names that have a CMakeLists.txt.
function(deburr_add_subdirectories_of folder)
  foreach(name ${ARGN})
    if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${folder}/${name}/CMakeLists.txt")
      add_subdirectory("${folder}/${name}")
    endif()
  endforeach()
endfunction()

# deburr_engines(<library> <name>...): a library that defines engines() (tool/run/engine.h) with these engines in this
# order; a program links one such library. It is an object library, since parts of deburr::app need engines() at any
# position of the linker's command line.
function(deburr_engines library)
  set(declarations "")
  set(calls "")
  set(libraries "")
  foreach(name ${ARGN})
    string(APPEND declarations "std::unique_ptr<Engine> make_${name}_engine();\n")
    string(APPEND calls "  all.push_back(make_${name}_engine());\n")
    list(APPEND libraries deburr::${name}_engine)
  endforeach()
  set(file "${CMAKE_CURRENT_BINARY_DIR}/${library}.cpp")
  file(CONFIGURE OUTPUT "${file}" @ONLY CONTENT [[
// Made by cmake/Engines.cmake.
#include "tool/run/engine.h"

namespace deburr::tool {

@declarations@
std::vector<std::unique_ptr<Engine>> engines() {
  std::vector<std::unique_ptr<Engine>> all;
@calls@  return all;
}

}  // namespace deburr::tool
]])
  add_library(deburr_${library}_list OBJECT "${file}")
  target_link_libraries(deburr_${library}_list PRIVATE deburr::app deburr_options deburr_light_options)
  add_library(deburr_${library} INTERFACE)
  target_link_libraries(deburr_${library} INTERFACE
    $<TARGET_OBJECTS:deburr_${library}_list> deburr::app ${libraries})
  add_library(deburr::${library} ALIAS deburr_${library})
endfunction()
