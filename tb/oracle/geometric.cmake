# SPDX-License-Identifier: MIT
deburr_test(geometric_ideal_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_ideal_test.cpp"
  LINK deburr::geometric_frames deburr::ideal)
