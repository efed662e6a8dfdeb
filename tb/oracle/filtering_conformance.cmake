# SPDX-License-Identifier: MIT
deburr_library(conformance LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/conformance.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/encoded_texture.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/filtering_cases.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/plain_sampler.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/plane.cpp"
  LINK deburr::spec deburr::golden_texture deburr::filtering_criterion
  PRIVATE_LINK fmt::fmt)

deburr_test(filtering_criterion_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/filtering_criterion_test.cpp"
  LINK deburr::conformance)
deburr_test(filtering_conformance_test LABELS oracle TIMEOUT 600  # with sanitizers; 10 s without
  LONG Rules[.]TheLogarithmDecidesTheVerdict
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/filtering_conformance_test.cpp"
  LINK deburr::conformance)
deburr_test(filtering_faults_test LABELS negative
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/filtering_faults_test.cpp"
  LINK deburr::conformance)
deburr_test(anisotropy_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/anisotropy_test.cpp"
  LINK deburr::conformance)

add_executable(conformance_page "${CMAKE_CURRENT_LIST_DIR}/conformance_page.cpp")
target_link_libraries(conformance_page PRIVATE deburr::conformance deburr_options)
add_test(NAME conformance_page.is_current
         COMMAND conformance_page check "${PROJECT_SOURCE_DIR}/docs/measurements/filtering_conformance.md"
                 "${CMAKE_CURRENT_LIST_DIR}/stale_page.md")
set_tests_properties(conformance_page.is_current PROPERTIES LABELS "oracle;long" TIMEOUT 600)
add_dependencies(deburr_oracle_tests conformance_page)
add_dependencies(deburr_long_tests conformance_page)
