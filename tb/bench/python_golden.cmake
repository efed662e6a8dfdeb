# SPDX-License-Identifier: MIT
# Compares golden models called from Python and from C++ in instructions, which do not depend on other load.
add_executable(python_frames "${CMAKE_CURRENT_LIST_DIR}/python_frames.cpp")
target_link_libraries(python_frames PRIVATE deburr::golden_morphological deburr_options)
if(TARGET deburr_python AND CMAKE_BUILD_TYPE STREQUAL "Release")
  add_test(NAME python_speed COMMAND "${CMAKE_CURRENT_LIST_DIR}/python_golden.py" $<TARGET_FILE:python_frames>
                                     "${PROJECT_BINARY_DIR}/python")
  set_tests_properties(python_speed PROPERTIES LABELS "perf;long" TIMEOUT 1800 SKIP_RETURN_CODE 77)
  add_dependencies(deburr_perf_tests deburr_python)
  add_dependencies(deburr_long_tests deburr_python python_frames)
endif()
