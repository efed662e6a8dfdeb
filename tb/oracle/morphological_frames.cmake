# SPDX-License-Identifier: MIT
deburr_test(morphological_frames_test LABELS oracle
  LONG MorphologicalFrames[.]DeburrIsBestOnTrackFromOtherSides Meshes/DeburrIsBest
       "HeldOut/.*/(building_small_d|vehicle_truck_(purple|yellow)|track_[bst]|grass_5|pavement|road_[ci]|road_straight)"
       "Scenes/.*/(object_1280|road_640|cylinders_512)"
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/morphological_frames_test.cpp"
  LINK deburr::golden_morphological deburr::ideal deburr::scene deburr::stimuli deburr::training_frames)
