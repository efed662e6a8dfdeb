# SPDX-License-Identifier: MIT
# The dependency rule of the house, enforced by include paths.
#
# Every layer folder (spec, golden, rtl_model, tb) is visible to a compiler only through a private
# include root that holds a link to that one folder. A target that does not link deburr::golden has
# no include path on which "golden/..." could be found, so the rule cannot be broken by accident.

# deburr_layer_root(<variable> <layer>): the include root that shows <layer> and nothing else.
function(deburr_layer_root variable layer)
  set(root "${PROJECT_BINARY_DIR}/layers/${layer}")
  file(MAKE_DIRECTORY "${root}")
  if(NOT IS_SYMLINK "${root}/${layer}")
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${layer}" "${root}/${layer}" SYMBOLIC)
  endif()
  set(${variable} "${root}" PARENT_SCOPE)
endfunction()

# deburr_batches(<target>): compiles the sources of a target in batches of at most twelve of about the
# same size, one translation unit each (option DEBURR_UNITY). Sources that are generated and those with
# options of their own, which are set before, stay as they are. Not UNITY_BUILD: its files name sources by
# absolute paths, so that a compiler cache finds nothing that another checkout has left.
function(deburr_batches target)
  if(NOT DEBURR_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(together "")
  foreach(source IN LISTS sources)
    get_source_file_property(options "${source}" COMPILE_OPTIONS)
    cmake_path(ABSOLUTE_PATH source NORMALIZE OUTPUT_VARIABLE path)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${path}" generated)
    if(source MATCHES "[.]cpp$" AND NOT options AND NOT generated)
      list(REMOVE_ITEM sources "${source}")
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY "${PROJECT_SOURCE_DIR}")
      list(APPEND together "${path}")
    endif()
  endforeach()
  list(LENGTH together count)
  if(count LESS 2)
    return()
  endif()
  math(EXPR batches "(${count} + 11) / 12")
  foreach(batch RANGE 1 ${batches})
    math(EXPR first "${count} * (${batch} - 1) / ${batches}")
    math(EXPR size "${count} * ${batch} / ${batches} - ${first}")
    list(SUBLIST together ${first} ${size} includes)
    list(TRANSFORM includes REPLACE "(.+)" "#include \"\\1\"\n")
    list(JOIN includes "" includes)
    set(file "${CMAKE_CURRENT_BINARY_DIR}/${target}_batch_${batch}.cpp")
    file(CONFIGURE OUTPUT "${file}" CONTENT "${includes}" @ONLY)
    list(APPEND sources "${file}")
  endforeach()
  set_property(TARGET ${target} PROPERTY SOURCES ${sources})
  list(GET together 0 first)
  string(REGEX MATCH "[a-z_]+" layer "${first}")
  deburr_layer_root(root ${layer})
  target_include_directories(${target} PRIVATE "${root}")
endfunction()

# deburr_library(<name> LAYER <layer> SOURCES ... LINK ... [NOT_SIMULATED]): a static library of one
# layer; linking it makes its layer's headers visible, and those of what it links publicly. What runs
# beside a simulation, and not in each of its clocks, is NOT_SIMULATED: it is compiled faster.
function(deburr_library name)
  cmake_parse_arguments(ARG "NOT_SIMULATED" "LAYER" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  deburr_layer_root(root ${ARG_LAYER})
  if(ARG_SOURCES)
    add_library(deburr_${name} STATIC ${ARG_SOURCES})
    target_include_directories(deburr_${name} PUBLIC "${root}")
    target_link_libraries(deburr_${name} PUBLIC ${ARG_LINK} PRIVATE deburr_options
                                                                    ${ARG_PRIVATE_LINK})
    if(ARG_NOT_SIMULATED)
      target_link_libraries(deburr_${name} PRIVATE deburr_light_options)
    endif()
    if(ARG_LAYER STREQUAL "rtl_model")
      # GCC inlines less in units that it takes for large: models would be 8 to 15 % slower.
      target_compile_options(deburr_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=large-unit-insns=200000>)
    endif()
    deburr_batches(deburr_${name})
    set_property(GLOBAL APPEND PROPERTY DEBURR_LIBRARIES_OF_${ARG_LAYER} deburr_${name})
  else()
    add_library(deburr_${name} INTERFACE)
    target_include_directories(deburr_${name} INTERFACE "${root}")
    target_link_libraries(deburr_${name} INTERFACE ${ARG_LINK})
  endif()
  add_library(deburr::${name} ALIAS deburr_${name})
endfunction()
