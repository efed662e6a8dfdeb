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
  LONG Configuration[.]LogarithmDecidesTheVerdict
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/filtering_conformance_test.cpp"
  LINK deburr::conformance)
deburr_test(filtering_faults_test LABELS negative
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/filtering_faults_test.cpp"
  LINK deburr::conformance)
deburr_test(anisotropy_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/anisotropy_test.cpp"
  LINK deburr::conformance)
