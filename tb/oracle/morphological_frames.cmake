# SPDX-License-Identifier: MIT
deburr_test(morphological_frames_test LABELS oracle
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/morphological_frames_test.cpp"
  LINK deburr::golden_morphological deburr::scene deburr::stimuli deburr::share_training)
target_compile_definitions(morphological_frames_test PRIVATE DEBURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
