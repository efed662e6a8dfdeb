# SPDX-License-Identifier: MIT
deburr_test(morphological_area_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/morphological_area_test.cpp"
  LINK deburr::line_fans)
