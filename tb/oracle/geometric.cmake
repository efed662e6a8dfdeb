# SPDX-License-Identifier: MIT
deburr_library(solids LAYER tb SOURCES "${CMAKE_CURRENT_LIST_DIR}/solids.cpp" LINK deburr::scene)
deburr_library(views LAYER tb SOURCES "${CMAKE_CURRENT_LIST_DIR}/views.cpp" LINK deburr::scene
               PRIVATE_LINK deburr::solids fmt::fmt)
deburr_test(geometric_ideal_test LABELS oracle
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_ideal_test.cpp"
  LINK deburr::geometric_frames deburr::ideal)
deburr_test(geometric_quality_test LABELS oracle TIMEOUT 300
  LONG Others[.]AreBetterThanTheFrame Goals[.]TheTrackIsKept
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_quality_test.cpp"
  LINK deburr::geometric_frames)
deburr_test(geometric_morphological_test LABELS oracle TIMEOUT 900
  LONG Joined[.] Followers[.] Outermost[.]MendsHiddenLines
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_morphological_test.cpp"
  LINK deburr::geometric_frames deburr::ideal deburr::solids deburr::views)
deburr_test(geometric_rules_test LABELS oracle TIMEOUT 900
  LONG LineRules[.] Crossings[.]AreWorthMoreThanAllRules Presets[.]
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/geometric_rules_test.cpp"
  LINK deburr::geometric_frames deburr::solids deburr::views)
