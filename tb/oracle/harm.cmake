# SPDX-License-Identifier: MIT
# JPEG files are written with OpenImageIO itself, which has the choice of a quality.
deburr_library(harm LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/harm.cpp" "${CMAKE_CURRENT_LIST_DIR}/harm_frames.cpp"
  LINK deburr::scene
  PRIVATE_LINK deburr::golden_morphological deburr::ideal deburr::stimuli deburr::training_frames
               deburr_openimageio fmt::fmt)
deburr_test(harm_test PROGRAM oracle_harm_tests LABELS oracle TIMEOUT 900
  LONG MorphologicalHarm[.]OfFrames MorphologicalHarm[.]OfTheTextGuardOnFrames
       "MorphologicalHarm[.]OfTheTextGuard$"
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/harm_test.cpp"
  LINK deburr::harm)
