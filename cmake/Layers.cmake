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
# same size, one translation unit each (option DEBURR_UNITY). A source with flags of its own, and one
# that is generated, stays a translation unit of its own.
function(deburr_batches target)
  if(NOT DEBURR_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  set(generated ${sources})
  list(FILTER generated INCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
  set_source_files_properties(${generated} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  list(FILTER sources EXCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
  list(LENGTH sources count)
  if(count LESS 2)
    return()
  endif()
  math(EXPR batches "(${count} + 11) / 12")
  math(EXPR size "(${count} + ${batches} - 1) / ${batches}")
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
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
    deburr_batches(deburr_${name})
  else()
    add_library(deburr_${name} INTERFACE)
    target_include_directories(deburr_${name} INTERFACE "${root}")
    target_link_libraries(deburr_${name} INTERFACE ${ARG_LINK})
  endif()
  add_library(deburr::${name} ALIAS deburr_${name})
endfunction()

# deburr_test(<name> LABELS ... SOURCES ... LINK ... [TIMING regex ...] [LONG regex ...] [TIMEOUT s]):
# a GoogleTest program. Every TEST becomes a ctest entry of its own and so a process of its own:
# SystemC elaborates once a process. Tests whose name matches a regex of TIMING or LONG have the
# label `timing` or `long` too; a regex that matches none is an error of ctest.
function(deburr_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "LABELS;SOURCES;LINK;TIMING;LONG" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${name} ${ARG_SOURCES} $<TARGET_OBJECTS:deburr_forked_expectations>)
  foreach(label ${ARG_LABELS})
    add_dependencies(deburr_${label}_tests ${name})
  endforeach()
  foreach(label timing long)
    string(TOUPPER ${label} regexes)
    if(ARG_${regexes})
      add_dependencies(deburr_${label}_tests ${name})
    endif()
  endforeach()
  # The main() comes first: SystemC's library has one as well.
  target_link_libraries(${name} PRIVATE GTest::gmock_main ${ARG_LINK} deburr_options)
  if("unit" IN_LIST ARG_LABELS)
    target_link_libraries(${name} PRIVATE deburr_light_options)
  endif()
  # Values of parameters stay out of the names: some are addresses, or bytes of the compiler's choice.
  gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 TEST_LIST ${name}_tests
                       NO_PRETTY_VALUES PROPERTIES TIMEOUT ${ARG_TIMEOUT})
  # gtest_discover_tests() flattens a list in PROPERTIES, so more than one label goes this way.
  set(labels "${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake")
  set(text "if(${name}_tests)
  set_tests_properties(\${${name}_tests} PROPERTIES LABELS \"${ARG_LABELS}\")
")
  foreach(label timing long)
    string(TOUPPER ${label} regexes)
    string(APPEND text "  foreach(regex IN ITEMS ${ARG_${regexes}})
    set(matching \${${name}_tests})
    list(FILTER matching INCLUDE REGEX \"^${name}[.](.*/)?\${regex}\")
    if(NOT matching)
      message(SEND_ERROR \"${name} has no test '\${regex}' for the label ${label}\")
    else()
      set_tests_properties(\${matching} PROPERTIES LABELS \"${ARG_LABELS};${label}\")
    endif()
  endforeach()
")
  endforeach()
  # What is not built fails under its labels, and not under others.
  file(WRITE "${labels}" "${text}else()
  set_tests_properties(${name}_NOT_BUILT PROPERTIES LABELS \"${ARG_LABELS}\")
endif()
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${labels}")
endfunction()

# deburr_noise_for_minutes(<engine>): its register noise with new seeds for two minutes, label fuzz.
function(deburr_noise_for_minutes engine)
  add_test(NAME fuzz_registers_${engine}
           COMMAND rtl_${engine}_register_noise_test --gtest_filter=RegisterNoise.*)
  set_tests_properties(fuzz_registers_${engine} PROPERTIES LABELS fuzz TIMEOUT 600
                       ENVIRONMENT DEBURR_FUZZ_SECONDS=120)
  add_dependencies(deburr_fuzz_tests rtl_${engine}_register_noise_test)
endfunction()
