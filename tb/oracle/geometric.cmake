# SPDX-License-Identifier: MIT
deburr_test(geometric_ideal_test LABELS oracle
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/geometric_ideal_test.cpp"
  LINK deburr::geometric_frames deburr::ideal)
deburr_test(geometric_quality_test LABELS oracle TIMEOUT 300
  LONG Others[.]AreBetterThanTheFrame
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/geometric_quality_test.cpp"
  LINK deburr::geometric_frames)
target_compile_definitions(geometric_quality_test
  PRIVATE DEBURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
deburr_test(geometric_morphological_test LABELS oracle TIMEOUT 900
  LONG Joined[.] Outermost[.]WouldMendHiddenLines
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/geometric_morphological_test.cpp"
  LINK deburr::geometric_frames deburr::ideal)
target_compile_definitions(geometric_morphological_test
  PRIVATE DEBURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
