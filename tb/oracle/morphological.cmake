# SPDX-License-Identifier: MIT
deburr_library(line_fans LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/line_fans.cpp" "${CMAKE_CURRENT_LIST_DIR}/discs.cpp"
  LINK deburr::spec deburr::golden_morphological deburr::ideal
  PRIVATE_LINK fmt::fmt)

deburr_test(morphological_quality_test LABELS oracle
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/morphological_quality_test.cpp"
  LINK deburr::line_fans)
deburr_test(morphological_area_test LABELS oracle
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/morphological_area_test.cpp"
  LINK deburr::line_fans)
