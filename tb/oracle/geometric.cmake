# SPDX-License-Identifier: MIT
deburr_test(geometric_ideal_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_ideal_test.cpp"
  LINK deburr::geometric_frames deburr::ideal)
deburr_test(geometric_quality_test LABELS oracle TIMEOUT 300
  LONG Others[.]AreBetterThanTheFrame
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_quality_test.cpp"
  LINK deburr::geometric_frames)
deburr_test(geometric_morphological_test LABELS oracle TIMEOUT 900
  LONG Joined[.] Outermost[.]MendsHiddenLines
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_morphological_test.cpp"
  LINK deburr::geometric_frames deburr::ideal)
deburr_library(solids LAYER tb SOURCES "${CMAKE_CURRENT_LIST_DIR}/solids.cpp" LINK deburr::scene)
deburr_test(geometric_rules_test LABELS oracle TIMEOUT 900
  LONG LineRules[.] Crossings[.]AreWorthMoreThanAllRules
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_rules_test.cpp"
  LINK deburr::geometric_frames deburr::solids)
