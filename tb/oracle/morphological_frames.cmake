# SPDX-License-Identifier: MIT
deburr_test(morphological_frames_test LABELS oracle
  LONG MorphologicalFrames[.]DeburrIsBestOnTrackFromOtherSides
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/morphological_frames_test.cpp"
  LINK deburr::golden_morphological deburr::ideal deburr::scene deburr::stimuli deburr::training_frames)
