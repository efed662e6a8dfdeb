# SPDX-License-Identifier: MIT
# Test programs: one per folder and kind, compiled in batches.

# deburr_test(<name> SOURCE <file> LABELS ... LINK ... [PROGRAM <program>]
#             [TIMING regex ...] [LONG regex ...] [TIMEOUT s]):
# a source with GoogleTests. Without sanitizers every TEST is an entry of ctest, `<name>.Suite.Case`, with its own
# process, since SystemC elaborates once per process. With sanitizers a process takes longer to start than most tests,
# so a suite is one entry, `<name>.Suite` (tb/harness/own_simulation.cpp). Tests whose name matches a regex of TIMING
# or LONG also get the label `timing` or `long`; a regex without a match is a build error.
#
# The sources of a folder form one program named after it: rtl_texture_tests for tb/unit/rtl/texture, tool_pages_tests
# for tool/tests/pages. Tests that are not unit tests form a separate program named after their first label:
# harness_negative_tests. PROGRAM sets another name, for example for a source that loads a library the others must not
# load. Each source has its own namespace (tb/unit/house/names_test.py).
function(deburr_test name)
  cmake_parse_arguments(ARG "" "SOURCE;PROGRAM;TIMEOUT" "LABELS;LINK;TIMING;LONG" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(DEBURR_SANITIZE)
    math(EXPR ARG_TIMEOUT "2 * ${ARG_TIMEOUT}")  # a suite of one test may take 90 s
  endif()
  list(GET ARG_LABELS 0 kind)
  if(NOT ARG_PROGRAM)
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY "${PROJECT_SOURCE_DIR}"
               OUTPUT_VARIABLE path)
    set(of_units "${path}")
    string(REGEX REPLACE "^tb/(unit/)?" "" path "${path}")
    string(REGEX REPLACE "^([a-z]+/)tests/" "\\1" path "${path}")
    string(REPLACE "/" "_" path "${path}")
    if(of_units MATCHES "^tb/unit/|/tests/" AND NOT kind STREQUAL "unit")
      string(APPEND path "_${kind}")
    endif()
    set(ARG_PROGRAM "${path}_tests")
  endif()
  set(program ${ARG_PROGRAM})
  if(NOT TARGET ${program})
    # Our main() must be linked before SystemC, whose library has one as well.
    add_executable(${program} $<TARGET_OBJECTS:deburr_test_support>)
    target_link_libraries(${program} PRIVATE GTest::gmock_main)
    cmake_language(EVAL CODE "cmake_language(DEFER CALL deburr_finish_tests ${program})")
  endif()
  cmake_path(ABSOLUTE_PATH ARG_SOURCE NORMALIZE)
  target_sources(${program} PRIVATE "${ARG_SOURCE}")
  target_link_libraries(${program} PRIVATE ${ARG_LINK})

  set(labels ${ARG_LABELS})
  foreach(label timing long)
    string(TOUPPER ${label} regexes)
    if(ARG_${regexes})
      list(APPEND labels ${label})
    endif()
  endforeach()
  foreach(label ${labels})
    add_dependencies(deburr_${label}_tests ${program})
  endforeach()
  foreach(list LABELS TIMING LONG)
    list(TRANSFORM ARG_${list} REPLACE "^.+$" "\"\\0\"" OUTPUT_VARIABLE json_${list})
    list(JOIN json_${list} ", " json_${list})
  endforeach()
  cmake_path(RELATIVE_PATH ARG_SOURCE BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE source)
  set_property(TARGET ${program} APPEND_STRING PROPERTY DEBURR_TESTS
    "{\"name\": \"${name}\", \"source\": \"${source}\", \"labels\": [${json_LABELS}], \
\"timing\": [${json_TIMING}], \"long\": [${json_LONG}], \"timeout\": ${ARG_TIMEOUT}},\n")
  # A program that is not built counts as a failure, under its labels.
  set_property(TARGET ${program} APPEND_STRING PROPERTY DEBURR_NOT_BUILT
    "  add_test(${name}_NOT_BUILT [=[${CMAKE_CURRENT_BINARY_DIR}/${program}]=])
  set_tests_properties(${name}_NOT_BUILT PROPERTIES LABELS \"${labels}\")\n")
  set_property(TARGET ${program} APPEND PROPERTY DEBURR_KINDS ${kind})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_BINARY_DIR BASE_DIRECTORY "${PROJECT_BINARY_DIR}" OUTPUT_VARIABLE folder)
  set_property(GLOBAL APPEND_STRING PROPERTY DEBURR_TEST_PROGRAMS "${name} ${source} ${folder}/${program}\n")
endfunction()

# Runs at the end of a folder, when all its sources are known.
function(deburr_finish_tests program)
  target_link_libraries(${program} PRIVATE deburr_options)
  get_target_property(kinds ${program} DEBURR_KINDS)
  list(REMOVE_DUPLICATES kinds)
  if("unit" IN_LIST kinds)
    target_link_libraries(${program} PRIVATE deburr_lightest_options)
  endif()
  deburr_batches(${program})
  set(stem "${CMAKE_CURRENT_BINARY_DIR}/${program}")
  get_target_property(tests ${program} DEBURR_TESTS)
  string(REGEX REPLACE ",\n$" "\n" tests "${tests}")
  file(CONFIGURE OUTPUT "${stem}.json" CONTENT "[\n${tests}]\n" @ONLY)
  set(discover "${PROJECT_SOURCE_DIR}/cmake/discover_tests.py")
  set_property(TARGET ${program} PROPERTY LINK_DEPENDS "${stem}.json" "${discover}")
  add_custom_command(TARGET ${program} POST_BUILD
    COMMAND "${discover}" "${stem}.json" $<TARGET_FILE:${program}> "${stem}.cmake"
            $<$<BOOL:${DEBURR_SANITIZE}>:--suites>
    COMMAND_EXPAND_LISTS)
  get_target_property(not_built ${program} DEBURR_NOT_BUILT)
  file(CONFIGURE OUTPUT "${stem}_include.cmake" CONTENT
       "if(EXISTS [=[${stem}.cmake]=])\n  include([=[${stem}.cmake]=])\nelse()\n${not_built}endif()\n" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${stem}_include.cmake")
endfunction()

# deburr_list_tests(): writes test_programs.txt, one line `<name> <source> <program>` per test, for scripts that build
# or run tests by name. Call it after all lists of tests.
function(deburr_list_tests)
  get_property(lines GLOBAL PROPERTY DEBURR_TEST_PROGRAMS)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/test_programs.txt" CONTENT "${lines}" @ONLY)
endfunction()

# deburr_script_test(<name> [FILE <stem>] [LABELS ...] [TIMEOUT s] [CLASSES ...] [ENVIRONMENT ...] [ARGUMENTS ...]):
# <name>_test.py (or <stem>_test.py) of this folder; default label system, 300 s. Each class in CLASSES becomes an
# entry of ctest, <name>.Class, so that classes run in parallel.
function(deburr_script_test name)
  cmake_parse_arguments(ARG "" "FILE;TIMEOUT" "LABELS;CLASSES;ENVIRONMENT;ARGUMENTS" ${ARGN})
  foreach(default "FILE ${name}" "TIMEOUT 300" "LABELS system" "CLASSES ,")
    string(REPLACE " " ";" default ${default})
    list(GET default 0 option)
    if(NOT ARG_${option})
      list(GET default 1 ARG_${option})
    endif()
  endforeach()
  list(APPEND ARG_ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
  foreach(class IN LISTS ARG_CLASSES)
    set(entry ${name}.${class})
    if(class STREQUAL ",")
      set(entry ${name})
      set(class "")
    endif()
    add_test(NAME ${entry}
             COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/${ARG_FILE}_test.py" ${ARG_ARGUMENTS} ${class})
    set_tests_properties(${entry} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT}
                         ENVIRONMENT "${ARG_ENVIRONMENT}")
  endforeach()
endfunction()

# deburr_noise_for_minutes(<engine>): register noise with new seeds for two minutes, label fuzz.
function(deburr_noise_for_minutes engine)
  add_test(NAME fuzz_registers_${engine} COMMAND rtl_${engine}_tests --gtest_filter=RegisterNoise.*)
  set_tests_properties(fuzz_registers_${engine} PROPERTIES LABELS fuzz TIMEOUT 600
                       ENVIRONMENT DEBURR_FUZZ_SECONDS=120)
  add_dependencies(deburr_fuzz_tests rtl_${engine}_tests)
endfunction()
