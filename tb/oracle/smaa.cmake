# SPDX-License-Identifier: MIT
deburr_test(smaa_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/smaa_test.cpp"
  LINK deburr::golden_morphological deburr::ideal deburr::stimuli)
