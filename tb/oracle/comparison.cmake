# SPDX-License-Identifier: MIT
deburr_library(comparison LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/comparison.cpp"
  LINK deburr::scene
  PRIVATE_LINK deburr::geometric_environment deburr::morphological_environment
               deburr::geometric_frames deburr::ideal fmt::fmt)
add_executable(comparison_page "${CMAKE_CURRENT_LIST_DIR}/comparison_page.cpp")
target_link_libraries(comparison_page PRIVATE deburr::comparison fmt::fmt deburr_options)
# A scene of the table, and the picture; the whole table with the label perf.
add_test(NAME comparison_page.cube_is_current
         COMMAND comparison_page check "${PROJECT_SOURCE_DIR}/docs/measurements/comparison.md" cube)
add_test(NAME comparison_page.picture_is_current
         COMMAND comparison_page compare "${PROJECT_SOURCE_DIR}/docs/images/comparison.png")
set_tests_properties(comparison_page.cube_is_current comparison_page.picture_is_current
                     PROPERTIES LABELS oracle TIMEOUT 600)
add_test(NAME comparison_page.all_is_current
         COMMAND comparison_page check "${PROJECT_SOURCE_DIR}/docs/measurements/comparison.md")
set_tests_properties(comparison_page.all_is_current PROPERTIES LABELS "perf;long" TIMEOUT 1800)
foreach(label oracle perf long)
  add_dependencies(deburr_${label}_tests comparison_page)
endforeach()
