# SPDX-License-Identifier: MIT
deburr_test(smaa_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/smaa_test.cpp"
  LINK deburr::golden_morphological deburr::ideal deburr::stimuli)
deburr_test(smaa_published_test PROGRAM oracle_smaa_tests LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/smaa_published_test.cpp"
  LINK deburr::golden_morphological deburr::ideal deburr::scene deburr::stimuli)
